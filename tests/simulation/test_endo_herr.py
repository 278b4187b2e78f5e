"""The quasi-passive walker of the Endo-Herr type as it is shipped, at its tuned values."""

from __future__ import annotations

import pytest

from gaitsim.optimization.draws import Draws
from gaitsim.optimization.problem import Problem, Variable
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

from .models import ROOT

WALKER = ROOT / "specs" / "walking_endo_herr.yaml"
CLUTCHES = ("vastus", "gastrocnemius", "hamstrings", "rectus_femoris", "biceps_femoris")


@pytest.mark.parametrize("step", ["0.5 ms", "0.25 ms"])
def test_it_walks_at_its_step_and_at_half_of_it(step: str) -> None:
    model = Opening(WALKER, ("simulate.step=" + step,)).open().model()
    found = Simulator(model).run()
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    walk = found.metrics
    assert walk["fall_time"] == pytest.approx(20) and walk["fall_time.fell"] == 0
    assert 1.2 < walk["speed"] < 1.4
    assert 0.58 < walk["stance_fraction"] < 0.66
    assert walk["correlation_hip"] > 0.95
    # Three aims are missed, as the page says: correlations of 0.9 and 0.8, and 60 N m on the knee's stop.
    assert walk["correlation_knee"] > 0.8 and walk["correlation_ankle"] > 0.63
    assert max(walk["knee_stop_l.peak"], walk["knee_stop_r.peak"]) < 100
    assert 2.5 < walk["cost_of_transport"] < 4
    for side in "lr":
        assert walk[f"force_peaks_{side}.two_peaks"] == 1 and walk[f"force_peaks_{side}"] < 1.4
        clutches = [walk[f"work_{unit}_{side}"] for unit in CLUTCHES]
        assert max(clutches) < 0.005 and sum(clutches) < -5
        assert walk[f"work_tibialis_anterior_{side}"] < 0
        assert walk[f"work_soleus_{side}"] > 0 and walk[f"work_gluteus_{side}"] > 0


@pytest.mark.parametrize("step", ["1 ms", "0.5 ms"])
def test_with_dampers_knee_and_ankle_are_near_to_people_and_the_stop_is_never_reached(step: str) -> None:
    spec = ROOT / "specs" / "walking_endo_herr_damper.yaml"
    walk = Simulator(Opening(spec, ("simulate.step=" + step,)).open().model()).run().metrics
    assert walk["fall_time"] == pytest.approx(20) and 1.2 < walk["speed"] < 1.4
    # One aim is missed, as the page says: a correlation of 0.9 at the hip.
    assert walk["correlation_hip"] > 0.87 and walk["correlation_knee"] > 0.9 and walk["correlation_ankle"] > 0.85
    for side in "lr":
        assert walk[f"knee_stop_{side}.peak"] < 1 and walk[f"force_peaks_{side}.first"] < 1.2
        assert sum(walk[f"work_{unit}_{side}"] for unit in CLUTCHES) < 0
        assert min(walk[f"work_{unit}_{side}"] for unit in ("soleus", "gluteus", "hip_flexor")) > 1


@pytest.mark.slow
def test_with_dampers_most_draws_of_one_percent_walk() -> None:
    model = Opening(ROOT / "specs" / "walking_endo_herr_damper.yaml").open().model()
    variables = tuple(Variable(f.address, f.unit, f.low, f.high, f.start, f.spread) for f in model.free)
    simulator, walked = Simulator(model), 0
    for drawn in Draws(10, 0.01, 1).values(Problem(variables)):
        walked += simulator.run(list(drawn.values())).metrics["fall_time.fell"] == 0
    assert walked >= 7


@pytest.mark.parametrize(
    ("unit", "cost"),
    [
        ("biceps_femoris", 2.36),
        ("rectus_femoris", 2.51),
        ("hamstrings", 2.45),
        ("gastrocnemius", 2.45),
        ("vastus", 2.67),
    ],
)
def test_with_a_muscle_instead_of_one_clutch_it_walks_and_the_vastus_costs_most(unit: str, cost: float) -> None:
    """With dampers; the walker with all clutches walks for 2.39 J/(kg m)."""
    walk = Simulator(Opening(ROOT / "specs" / f"walking_endo_herr_{unit}.yaml").open().model()).run().metrics
    assert walk["fall_time"] == pytest.approx(20)
    assert walk["cost_of_transport"] == pytest.approx(cost, abs=0.05)
    assert walk["correlation_knee"] > 0.92 and walk["correlation_ankle"] > 0.8
    assert max(walk["knee_stop_l.peak"], walk["knee_stop_r.peak"]) < 1


@pytest.mark.parametrize("step", ["2 ms", "1 ms"])
def test_with_muscles_instead_of_three_clutches_steps_are_short_and_quick(step: str) -> None:
    spec = ROOT / "specs" / "walking_endo_herr_muscles.yaml"
    walk = Simulator(Opening(spec, ("simulate.duration=20 s", "simulate.step=" + step)).open().model()).run().metrics
    assert walk["fall_time"] == pytest.approx(20)
    assert 105 < walk["cadence"] < 113 and 0.7 < walk["step_length"] < 0.76
    assert walk["correlation_knee"] > 0.95 and walk["correlation_ankle"] > 0.76
    assert walk["cost_of_transport"] == pytest.approx(2.93, abs=0.05)
    for side in "lr":
        assert walk[f"work_vastus_{side}"] < -2
        assert walk[f"work_gastrocnemius_{side}"] > 1 and walk[f"work_hamstrings_{side}"] > 1
