"""The impaired walkers at their tuned values: all walk for the 10 or 20 s for which they were tuned."""

from __future__ import annotations

import pytest

from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

from .models import ROOT

SLOWER = {
    "weak_plantarflexors": 0.9,
    "plantarflexor_contracture": 1.14,
    "weak_hips": 0.81,
    "calf_hyperreflexia": 1.2,
    "on_heels": 0.71,
    "spastic_quadriceps": 1.08,
    "stiff_knee": 1.19,
}


@pytest.mark.parametrize("cause", SLOWER)
def test_each_walks_and_more_slowly_than_the_healthy_one(cause: str) -> None:
    found = Simulator(Opening(ROOT / "specs" / f"walking_{cause}.yaml").open().model()).run()
    assert found.status == "completed" and found.metrics["fall_time.fell"] == 0
    assert found.metrics["speed"] == pytest.approx(SLOWER[cause], abs=0.05)


@pytest.mark.parametrize("step", ["2 ms", "1 ms"])
def test_stiff_knees_hardly_bend_in_swing(step: str) -> None:
    spec = ROOT / "specs" / "walking_stiff_knee.yaml"
    found = Simulator(Opening(spec, ("simulate.step=" + step,)).open().model()).run().metrics
    assert found["fall_time"] == pytest.approx(20)
    assert 40 < found["peak_knee_flexion.largest"] < 49


def test_the_healthy_one_is_the_walker() -> None:
    found = Simulator(Opening(ROOT / "specs" / "walking_impaired.yaml").open().model()).run()
    assert found.metrics["speed"] == pytest.approx(1.31, abs=0.03)
