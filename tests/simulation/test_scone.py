"""SCONE's planar walker H0918 as it is shipped."""

from __future__ import annotations

import pytest

from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening
from gaitsim.text.document import MappingNode, parse, plain

from .models import ROOT

WALKER = ROOT / "specs" / "walking_scone_h0918.yaml"


def parts(name: str) -> MappingNode:
    path = ROOT / "library" / "leg" / name
    found = parse(path.read_text(encoding="utf-8"), name).entries["parts"]
    assert isinstance(found, MappingNode)
    return found


def walk(step: str) -> dict[str, float]:
    found = Simulator(Opening(WALKER, ("simulate.step=" + step,)).open().model()).run()
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    return found.metrics


def test_its_muscles_are_those_of_the_walker_in_space() -> None:
    planar, space = parts("scone_h0918.yaml"), parts("scone_h1922.yaml")
    muscles = [name for name, entry in planar.entries.items() if "muscle/" in str(plain(entry))]
    assert len(muscles) == 9
    for name in muscles:
        ours, theirs = plain(planar.entries[name]), plain(space.entries[name])
        assert {word: ours[word] for word in ours if word != "metabolics"} == {
            word: theirs[word] for word in theirs if word != "metabolics"
        }


def test_the_published_start() -> None:
    """The right foot carries the weight, which is that of 74.53 kg, and every fiber is at rest."""
    model = Opening(WALKER, ("simulate.duration=0.5 ms",), tuned=False).open().model()
    found = Simulator(model).run(recorded=True).trajectory
    assert found is not None
    assert found["leg_r.heel.weight"][0] == pytest.approx(74.53 * 9.81, rel=1e-4)
    assert found["leg_r.leg_load.load"][0] == pytest.approx(1, abs=0.05)
    assert found["leg_l.leg_load.load"][0] == 0
    assert found["leg_r.reflexes.phase.early_stance"][0] == found["leg_l.reflexes.phase.swing"][0] == 1
    assert found["leg_r.vasti.activation"][0] == pytest.approx(0.4841)
    for signal in found.signals:
        if signal.endswith("normalized_fiber_velocity"):
            assert abs(found[signal][0]) < 1e-6


def test_it_walks() -> None:
    found = walk("0.5 ms")
    assert found["fall_time"] == pytest.approx(20) and found["fall_time.fell"] == 0
    assert 1.0 < found["speed"] < 1.5
    assert 0.56 < found["stance_fraction"] < 0.66
    assert found["correlation_hip"] > 0.9 and found["correlation_knee"] > 0.9 and found["correlation_ankle"] > 0.8
    assert max(found["force_peaks_l"], found["force_peaks_r"]) < 1.4


@pytest.mark.slow
def test_it_walks_the_same_at_half_and_at_twice_its_step() -> None:
    found = {step: walk(step) for step in ("0.25 ms", "0.5 ms", "1 ms")}
    for each in found.values():
        assert each["fall_time.fell"] == 0
        assert each["speed"] == pytest.approx(found["0.5 ms"]["speed"], abs=0.01)
