"""Trajectories as labelled arrays with units (xarray), and as netCDF."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.model import Signal
from gaitsim.simulation.outcome import Trajectory
from gaitsim.whole import whole

if TYPE_CHECKING:
    import xarray


def labelled(trajectory: Trajectory, signals: Sequence[Signal], about: Mapping[str, Any]) -> xarray.Dataset:
    """Make a dataset with a variable for each signal, named by its address, over the coordinate `time`.

    Variables have the attributes `units` and `long_name`, which plots of xarray use, and `flag_meanings` with
    `flag_values` for a state with named levels (CF conventions).

    Args:
        trajectory: The values, in SI.
        signals: Their declarations.
        about: Attributes of the dataset.
    """
    import xarray

    variables = {}
    for column, signal in enumerate(signals):
        attributes: dict[str, Any] = {"units": signal.unit, "long_name": signal.doc.rstrip(".") or signal.address}
        if signal.levels:
            attributes |= {"flag_values": list(range(len(signal.levels))), "flag_meanings": " ".join(signal.levels)}
        variables[signal.address] = ("time", trajectory.values[:, column], attributes)
    time = ("time", trajectory.times, {"units": "s", "long_name": "time"})
    return xarray.Dataset(variables, {"time": time}, dict(about))


def write_netcdf(path: Path, data: xarray.Dataset) -> None:
    """Write a dataset as netCDF-4.

    Raises:
        OSError: The file cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole(path) as draft:
        data.to_netcdf(draft, engine="h5netcdf")
