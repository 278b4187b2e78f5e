"""The walker of Geyer & Herr (2010) as it is shipped, at its tuned values."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import pytest

from gaitsim.optimization.draws import Draws
from gaitsim.results.tuned import problem_of, read_tuned, tuned_path
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

from .models import ROOT

WALKER = ROOT / "specs" / "walking_geyer2010.yaml"


@cache
def run(spec: Path, *settings: str, tuned: bool = True) -> Outcome:
    return Simulator(Opening(spec, tuple(settings), tuned=tuned).open().model()).run()


@pytest.mark.parametrize("settings", [(), ("simulate.step=1 ms",)], ids=["its step", "half of it"])
def test_it_walks_out_of_the_box_at_its_step_and_at_half_of_it(settings: tuple[str, ...]) -> None:
    found = run(WALKER, *settings)
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    walk = found.metrics
    assert walk["fall_time"] == pytest.approx(20) and walk["fall_time.fell"] == 0
    assert 1.2 < walk["speed"] < 1.4
    assert 0.58 < walk["stance_fraction"] < 0.66
    # A step is what the body goes on in the time of a step.
    assert walk["step_length"] == pytest.approx(walk["speed"] * walk["cadence.step_time"], rel=0.02)
    for side in "lr":
        assert walk[f"force_peaks_{side}.two_peaks"] == 1 and walk[f"force_peaks_{side}"] < 1.4
    assert walk["correlation_hip"] > 0.9 and walk["correlation_knee"] > 0.9 and walk["correlation_ankle"] > 0.8
    assert 50 < walk["peak_knee_flexion"] < 75
    assert 2.5 < walk["cost_of_transport"] < 5


def test_the_result_that_produced_its_values_is_in_the_repository() -> None:
    model = Opening(WALKER).open().model()
    tuned = read_tuned(tuned_path(WALKER), model.free)
    rows = [json.loads(line) for line in (ROOT / tuned.result / "evaluations.jsonl").read_text().splitlines()]
    best = min(rows, key=lambda row: row["score"])
    assert best["x"] == list(tuned.values.values())
    assert Simulator(model).run().score == pytest.approx(best["score"], rel=1e-3)


def test_its_step_is_right_within_one_percent() -> None:
    """Speed, stance, steps, peaks, correlations and cost differ by less than that from those at a quarter of it."""
    coarse, fine = run(WALKER).metrics, run(WALKER, "simulate.step=0.5 ms").metrics
    peaks = [f"force_peaks_{side}{which}" for side in "lr" for which in ("", ".first", ".second")]
    names = ["speed", "stance_fraction", "cadence", "step_length", "peak_knee_flexion", "cost_of_transport", *peaks]
    names += ["correlation_hip", "correlation_knee", "correlation_ankle"]
    assert {n: coarse[n] for n in names} == {n: pytest.approx(fine[n], rel=0.01) for n in names}


@pytest.mark.slow
def test_it_walks_with_every_tuned_number_changed_by_up_to_one_percent() -> None:
    model = Opening(WALKER).open().model()
    draws = Draws(10, 0.01, seed=1).values(problem_of(model))
    found = [Simulator(model.started_at(values)).run().status for values in draws]
    assert found.count("completed") >= 9


@pytest.mark.parametrize("step", ["0.25 ms", "0.125 ms"])
def test_the_published_gains_walk_untuned(step: str) -> None:
    found = run(WALKER, "simulate.step=" + step, tuned=False)
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    walk = found.metrics
    assert walk["fall_time"] == pytest.approx(20) and walk["fall_time.fell"] == 0
    assert walk["speed"] == pytest.approx(1.16, abs=0.02)
    # A step is what the body goes on in the time of a step.
    assert walk["step_length"] == pytest.approx(walk["speed"] * walk["cadence.step_time"], rel=0.02)
    assert walk["correlation_hip"] > 0.9 and walk["correlation_knee"] > 0.9


@pytest.mark.slow
@pytest.mark.parametrize("variant", ["published_contact", "millard2012", "gains2006", "effort"])
def test_a_variant_walks_with_the_values_beside_it(variant: str) -> None:
    found = run(ROOT / "specs" / f"walking_geyer2010_{variant}.yaml")
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    assert 1.2 < found.metrics["speed"] < 1.4


@pytest.mark.slow
@pytest.mark.parametrize("variant", ["slope", "steps", "pushes"])
def test_it_bears_a_slope_steps_and_a_push(variant: str) -> None:
    found = run(ROOT / "specs" / f"walking_geyer2010_{variant}.yaml")
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    assert found.metrics["speed"] > 0.6


def test_its_perturbed_variant_without_perturbation_is_the_same_walk() -> None:
    plain, perturbed = run(WALKER), run(ROOT / "specs" / "walking_geyer2010_perturbed.yaml")
    same = set(plain.metrics) & set(perturbed.metrics)
    assert "speed" in same
    assert {n: perturbed.metrics[n] for n in same} == pytest.approx({n: plain.metrics[n] for n in same}, nan_ok=True)
