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


def test_it_walks_out_of_the_box() -> None:
    found = run(WALKER)
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    walk = found.metrics
    assert walk["fall_time"] == pytest.approx(20) and walk["fall_time.fell"] == 0
    assert 1.2 < walk["speed"] < 1.4
    assert 0.58 < walk["stance_fraction"] < 0.66
    # A step is what the body goes on in the time of a step.
    assert walk["step_length"] == pytest.approx(walk["speed"] * walk["cadence.step_time"], rel=0.02)
    assert walk["force_peaks_l.two_peaks"] > 0.9 and walk["force_peaks_r.two_peaks"] > 0.9
    assert walk["correlation_hip"] > 0.9 and walk["correlation_knee"] > 0.9 and walk["correlation_ankle"] > 0.8
    assert 2.5 < walk["cost_of_transport"] < 5


def test_the_published_gains_untuned_fall_at_once() -> None:
    found = run(WALKER, tuned=False)
    assert found.status == "stopped" and found.reason == "fall_time"
    assert found.metrics["fall_time"] < 1


def test_its_perturbed_variant_without_perturbation_is_the_same_walk() -> None:
    plain, perturbed = run(WALKER), run(ROOT / "specs" / "walking_geyer2010_perturbed.yaml")
    same = set(plain.metrics) & set(perturbed.metrics)
    assert "speed" in same
    assert {n: perturbed.metrics[n] for n in same} == pytest.approx({n: plain.metrics[n] for n in same}, nan_ok=True)
