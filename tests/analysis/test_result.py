"""gaitsim.load: a result in a notebook."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import gaitsim
from gaitsim.cli.main import main
from gaitsim.results.manifest import BadResult

from .swinging import COMPONENTS, SPEC


@pytest.fixture
def result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The result of a search of nine evaluations."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    Path("spec.yaml").write_text(SPEC)
    Path("components").symlink_to(COMPONENTS)
    words = ["--workers", "0", "--population", "4", "--generations", "2", "--seed", "1"]
    with pytest.raises(SystemExit) as ended:
        main(["optimize", "spec.yaml", *words, "--set", "simulate.duration=1 s"])
    assert ended.value.code == 0
    (folder,) = Path("results").iterdir()
    return folder


def test_the_record_of_the_best_and_of_any_other(result: Path) -> None:
    lines = [json.loads(line) for line in (result / "evaluations.jsonl").read_text().splitlines()]
    ranked = sorted(lines, key=lambda line: line["score"])
    best, second = gaitsim.load(str(result)), gaitsim.load(result, candidate="2")
    assert (best.score, best.metrics) == (ranked[0]["score"], ranked[0]["metrics"])
    assert (second.score, second.metrics) == (ranked[1]["score"], ranked[1]["metrics"])
    frame = best.parameters()
    assert list(frame.index) == ["brake.derivative"]
    assert frame.loc["brake.derivative"].tolist() == [ranked[0]["x"][0], "N m s/rad", 0.0, 5.0]
    history = best.history()
    assert list(history.index) == [0, 1, 2]
    assert history["best"].iloc[-1] == ranked[0]["score"]


def test_the_trajectory_is_labelled_and_gives_the_metrics_again(result: Path) -> None:
    best = gaitsim.load(result)
    signals = best.trajectory()
    angle = signals["pivot.angle"]
    assert angle.attrs == {"units": "rad", "long_name": "Angle from the posture in which the two frames are aligned"}
    assert signals["time"].attrs["units"] == "s"
    assert float(angle.max() - angle.min()) == best.metrics["swing"]
    assert signals.attrs["status"] == "completed"
    assert signals.attrs["parameters"].startswith("brake.derivative = ")
    assert best.trajectory(duration=0.2).sizes == {"time": 200}
    np.testing.assert_array_equal(best.trajectory()["brake.torque"], signals["brake.torque"])


def test_what_is_no_search_has_no_history(result: Path) -> None:
    with pytest.raises(SystemExit):
        main(["run", "spec.yaml"])
    (run,) = (path for path in Path("results").iterdir() if path != result)
    loaded = gaitsim.load(run)
    assert loaded.parameters()["value"].tolist() == [0.2]
    with pytest.raises(BadResult) as error:
        loaded.history()
    assert str(error.value) == f"{run}: this is the result of a run; only a search has a history."
    (result / "generations.csv").write_text("")
    with pytest.raises(BadResult, match=r"generations\.csv: this cannot be read"):
        gaitsim.load(result).history()


def test_the_package_imports_at_once() -> None:
    text = "import sys, gaitsim; print(sorted({'numpy', 'xarray', 'mujoco', 'numba'} & {*sys.modules}))"
    ran = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert ran.stdout == "[]\n"
