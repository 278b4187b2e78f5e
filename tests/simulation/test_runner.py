"""The runner after Wang et al. (2012) as it is shipped, at its tuned values."""

from __future__ import annotations

import pytest

from gaitsim.analysis.gait.comparison import matched_moments, runs
from gaitsim.analysis.gait.figures import gait_figures
from gaitsim.analysis.gait.legs import two_legs
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening
from gaitsim.study.replays import replay_of

from .models import ROOT

RUNNER = ROOT / "specs" / "running_wang2012.yaml"


@pytest.mark.parametrize("step", ["0.5 ms", "0.25 ms"])
def test_it_runs_with_a_flight_in_every_step(step: str) -> None:
    found = Simulator(Opening(RUNNER, ("simulate.step=" + step,)).open().model()).run()
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(10)
    run = found.metrics
    assert run["fall_time.fell"] == 0
    assert 2 < run["speed"] < 3
    assert run["flight"] == 1 and run["flight.least"] > 0.03
    assert run["stance_fraction"] < 0.5 and run["stance_fraction.double_support"] == 0
    for side in "lr":
        assert 2 < run[f"force_peaks_{side}"] < 3


@pytest.mark.slow
@pytest.mark.parametrize("step", ["0.5 ms", "0.25 ms"])
def test_it_walks_while_asked_to_lean_back_and_runs_once_asked_to_lean_forward(step: str) -> None:
    """The change of the target begins at 8.3 s."""
    spec = ROOT / "specs" / "running_wang2012_transition.yaml"
    settings = ("simulate.step=" + step, "simulate.duration=8.3 s")
    early = [f"measures.{name}.settle=4 s" for name in ("speed", "stance_fraction", "flight")]
    walk = Simulator(Opening(spec, (*settings, *early)).open().model()).run().metrics
    assert walk["flight"] == 0 and walk["stance_fraction.double_support"] > 0.15
    assert walk["speed"] == pytest.approx(1.56, abs=0.03)
    run = Simulator(Opening(spec, settings[:1]).open().model()).run().metrics
    assert run["fall_time"] == pytest.approx(30)
    assert run["flight"] == 1 and run["stance_fraction.double_support"] == 0
    assert run["speed"] == pytest.approx(2.2, abs=0.06)


def test_nothing_that_is_known_of_walkers_stands_beside_a_runner() -> None:
    replay = replay_of(Opening(RUNNER).open(), RUNNER, duration=4)
    legs = two_legs(replay)
    assert legs is not None
    assert runs(replay) and not matched_moments(replay, legs)
    captions = {drawing.name: drawing.caption for drawing in gait_figures(replay)}
    assert "gait_moments" not in captions
    assert "natural speed" not in captions["gait_forces"]
    assert "Bovi" not in captions["gait_activations"]
    assert "fukuchi2017" in captions["gait_angles"] or "Fukuchi" in captions["gait_angles"]
