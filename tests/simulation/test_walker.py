"""The walker of Geyer & Herr (2010) as it is shipped, at its tuned values."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.cli.source import source_of_spec
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator

from .models import ROOT

WALKER = ROOT / "specs" / "walking_geyer2010.yaml"


def run(spec: Path, *settings: str, tuned: bool = True) -> Outcome:
    return Simulator(source_of_spec(spec, list(settings), None, tuned=tuned).model()).run()


@pytest.mark.parametrize("step", ["0.5 ms", "0.25 ms"])
def test_the_published_gains_walk_untuned(step: str) -> None:
    found = run(WALKER, "simulate.step=" + step, tuned=False)
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    walk = found.metrics
    assert walk["fall_time"] == pytest.approx(20) and walk["fall_time.fell"] == 0
    assert walk["speed"] == pytest.approx(1.16, abs=0.02)
    # A step is what the body goes on in the time of a step.
    assert walk["step_length"] == pytest.approx(walk["speed"] * walk["cadence.step_time"], rel=0.02)
    assert walk["correlation_hip"] > 0.9 and walk["correlation_knee"] > 0.9


def test_its_perturbed_variant_without_perturbation_is_the_same_walk() -> None:
    plain, perturbed = run(WALKER), run(ROOT / "specs" / "walking_geyer2010_perturbed.yaml")
    same = set(plain.metrics) & set(perturbed.metrics)
    assert "speed" in same
    assert {n: perturbed.metrics[n] for n in same} == pytest.approx({n: plain.metrics[n] for n in same}, nan_ok=True)
