"""The walkers tuned for five speeds, and the one that changes its speed within a run."""

from __future__ import annotations

import pytest

from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

from .models import ROOT

SPEEDS = (0.8, 1.0, 1.2, 1.4, 1.6)


@pytest.mark.slow
@pytest.mark.parametrize("step", ["2 ms", "1 ms"])
@pytest.mark.parametrize("speed", SPEEDS)
def test_each_walks_at_the_speed_that_is_asked_for(speed: float, step: str) -> None:
    path = ROOT / "specs" / f"walking_at_{str(speed).replace('.', 'p')}.yaml"
    found = Simulator(Opening(path, (f"simulate.step={step}",)).open().model()).run()
    assert found.status == "completed" and found.metrics["fall_time.fell"] == 0
    assert found.metrics["speed"] == pytest.approx(speed, abs=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("step", ["2 ms", "1 ms"])
def test_it_changes_its_speed_within_a_run(step: str) -> None:
    path = ROOT / "specs" / "walking_changing_speed.yaml"
    found = Simulator(Opening(path, (f"simulate.step={step}",)).open().model()).run()
    assert found.status == "completed" and found.metrics["fall_time.fell"] == 0
    assert found.metrics["stride_speed.slowest"] < 0.95 and found.metrics["stride_speed.fastest"] > 1.45
    assert found.metrics["stride_speed.error"] < 0.06
