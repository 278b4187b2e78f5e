"""The walker of Song & Geyer (2015) as it is shipped, in the plane and in space."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening
from gaitsim.text.document import MappingNode, parse, plain

from .models import ROOT

SPACE = ROOT / "specs" / "walking_song2015.yaml"
PLANAR = ROOT / "specs" / "walking_song2015_planar.yaml"


def parts(name: str) -> MappingNode:
    path = ROOT / "library" / "leg" / name
    found = parse(path.read_text(encoding="utf-8"), name).entries["parts"]
    assert isinstance(found, MappingNode)
    return found


def walk(step: str, spec: Path = PLANAR) -> dict[str, float]:
    found = Simulator(Opening(spec, ("simulate.step=" + step,)).open().model()).run()
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    return found.metrics


def test_its_muscles_and_sagittal_modules_are_those_of_the_walker_in_space() -> None:
    planar, space = parts("song2015_planar.yaml"), parts("song2015.yaml")
    muscles = [name for name, entry in planar.entries.items() if "muscle/" in str(plain(entry))]
    assert len(muscles) == 9
    for name in (*muscles, "placement", *(each for each in planar.entries if each.endswith("_nerve"))):
        assert {**plain(planar.entries[name]), "lean": None} == {**plain(space.entries[name]), "lean": None}
    ours, theirs = plain(planar.entries["reflexes"]), plain(space.entries["reflexes"])
    assert ours.keys() == theirs.keys()
    assert [word for word in ours if ours[word] != theirs[word]] == ["pitch_rate"]


def test_it_walks_in_the_plane() -> None:
    found = walk("1 ms")
    assert found["fall_time"] == pytest.approx(20) and found["fall_time.fell"] == 0
    assert 1.15 < found["speed"] < 1.35
    assert 0.6 < found["stance_fraction"] < 0.64
    assert found["correlation_hip"] > 0.96 and found["correlation_knee"] > 0.94 and found["correlation_ankle"] > 0.8
    assert max(found["force_peaks_l"], found["force_peaks_r"]) < 1.25
    assert found["step_length.asymmetry"] < 0.02


@pytest.mark.slow
def test_it_walks_in_the_plane_at_half_and_at_twice_its_step() -> None:
    for step in ("0.5 ms", "2 ms"):
        found = walk(step)
        assert found["fall_time.fell"] == 0
        assert found["speed"] == pytest.approx(1.23, abs=0.03)


def test_it_walks_in_space() -> None:
    found = walk("1 ms", SPACE)
    assert found["fall_time"] == pytest.approx(20) and found["fall_time.fell"] == 0
    assert 1.15 < found["speed"] < 1.35
    assert 0.58 < found["stance_fraction"] < 0.62
    assert 0.1 < found["step_width"] < 0.15 and abs(found["drift.distance"]) < 0.5
    assert found["correlation_hip"] > 0.86 and found["correlation_knee"] > 0.95 and found["correlation_ankle"] > 0.86
    assert max(found["force_peaks_l"], found["force_peaks_r"]) < 1.35
    assert found["step_length.asymmetry"] < 0.02


@pytest.mark.slow
def test_it_walks_in_space_at_half_its_step() -> None:
    found = walk("0.5 ms", SPACE)
    assert found["fall_time.fell"] == 0
    assert found["speed"] == pytest.approx(1.3, abs=0.03)
