"""Exports: headings as other programs read them, and numbers that come back bit for bit."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

from gaitsim.exchange import rows
from gaitsim.exchange.csv import write_csv
from gaitsim.exchange.labelled import labelled, write_netcdf
from gaitsim.exchange.sto import write_sto
from gaitsim.model import Signal
from gaitsim.simulation.outcome import Trajectory

SIGNALS = (
    Signal("leg.knee.angle", "rad", "Angle of the knee."),
    Signal("leg.knee.power", "N m/s", "Power, of a sort."),
    Signal("leg.phase", "1", "What the leg does.", ("swing", "stance")),
)


@pytest.fixture
def trajectory() -> Trajectory:
    """Numbers of every size: the awkward ones first, then chance."""
    values = np.random.default_rng(1).normal(size=(25_000, 3)) * 10.0 ** np.random.default_rng(2).integers(-300, 300)
    values[:4, 0] = [0.1, 1 / 3, -0.0, 5e-324]
    values[:, 2] = np.arange(25_000) % 2
    times = np.round(np.arange(25_000) * 1e-4, 12)
    return Trajectory(times, tuple(s.address for s in SIGNALS), tuple(s.unit for s in SIGNALS), values)


def table(lines: list[str], separator: str) -> np.ndarray:
    return np.array([[float(cell) for cell in line.split(separator)] for line in lines])


def whole(trajectory: Trajectory) -> np.ndarray:
    return np.column_stack([trajectory.times, trajectory.values])


def test_sto(tmp_path: Path, trajectory: Trajectory) -> None:
    path = tmp_path / "exports" / "a.sto"
    write_sto(path, trajectory, "hopping")
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[:11] == [
        "hopping",
        "inDegrees=no",
        "nColumns=4",
        "nRows=25000",
        "unit.leg.knee.angle=rad",
        "unit.leg.knee.power=N m/s",
        "unit.leg.phase=1",
        "DataType=double",
        "version=3",
        "endheader",
        "time\tleg.knee.angle\tleg.knee.power\tleg.phase",
    ]
    assert table(lines[11:], "\t").tobytes() == whole(trajectory).tobytes()


def test_csv(tmp_path: Path, trajectory: Trajectory) -> None:
    path = tmp_path / "a.csv"
    write_csv(path, trajectory)
    head, *lines = path.read_text(encoding="utf-8").splitlines()
    assert head == "time [s],leg.knee.angle [rad],leg.knee.power [N m/s],leg.phase [1]"
    assert table(lines, ",").tobytes() == whole(trajectory).tobytes()


def test_labelled_arrays_and_netcdf(tmp_path: Path, trajectory: Trajectory) -> None:
    path = tmp_path / "a.nc"
    data = labelled(trajectory, SIGNALS, {"title": "hopping", "reason": ""})
    write_netcdf(path, data)
    assert data["leg.knee.angle"].attrs == {"units": "rad", "long_name": "Angle of the knee"}
    assert data["leg.phase"].attrs["flag_meanings"] == "swing stance"
    assert data["leg.phase"].attrs["flag_values"] == [0, 1]
    assert data["time"].attrs == {"units": "s", "long_name": "time"}
    with xarray.open_dataset(path, engine="h5netcdf") as again:
        assert again.attrs == {"title": "hopping", "reason": ""}
        assert again["leg.knee.power"].attrs == data["leg.knee.power"].attrs
        for column, signal in enumerate(SIGNALS):
            assert again[signal.address].to_numpy().tobytes() == trajectory.values[:, column].tobytes()
        assert again["time"].to_numpy().tobytes() == trajectory.times.tobytes()
        assert float(again["leg.phase"].sel(time=0.0003)) == 1.0


def test_a_run_without_an_instant(tmp_path: Path) -> None:
    nothing = Trajectory(np.zeros(0), ("a.b",), ("m",), np.zeros((0, 1)))
    write_sto(tmp_path / "a.sto", nothing, "x")
    assert (tmp_path / "a.sto").read_text().endswith("endheader\ntime\ta.b\n")


@pytest.mark.parametrize("ending", ["sto", "csv", "nc"])
def test_a_full_disk_leaves_nothing(
    ending: str, tmp_path: Path, trajectory: Trajectory, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    path = tmp_path / f"a.{ending}"
    path.write_text("before")
    with pytest.raises(OSError, match="No space left"):
        if ending == "nc":
            monkeypatch.setattr(xarray.Dataset, "to_netcdf", full)
            write_netcdf(path, labelled(trajectory, SIGNALS, {}))
        else:
            monkeypatch.setattr(rows, "_write_rows", full)
            write_csv(path, trajectory) if ending == "csv" else write_sto(path, trajectory, "x")
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]
