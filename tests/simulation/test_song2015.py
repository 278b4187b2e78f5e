"""The walker of Song & Geyer (2015) as it is shipped, in the plane and in space."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening
from gaitsim.text.document import MappingNode, parse, plain

from .models import ROOT, model

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


def test_two_mirrored_starts_are_two_mirrored_walks() -> None:
    walks = []
    for side, sign in (("r", 1), ("l", -1)):
        other = {"r": "l", "l": "r"}[side]
        settings = {
            "simulate.duration": "0.5 s",
            "initial.root.left_velocity": f"{0.1 * sign} m/s",
            "initial.root.roll": f"{2 * sign} deg",
            f"initial.leg_{side}.phase.phase": "1",
            f"initial.leg_{other}.phase.phase": "0",
        }
        for joint, (near, far) in {"hip": (194, 157), "knee": (178, 170), "ankle": (88, 95)}.items():
            settings |= {f"initial.leg_{side}.{joint}.angle": f"{near} deg"}
            settings |= {f"initial.leg_{other}.{joint}.angle": f"{far} deg"}
        for leg, angle in ((side, 1), (other, -3)):
            settings[f"initial.leg_{leg}.hip_abduction.angle"] = f"{angle} deg"
        walks.append(Simulator(model(SPACE, settings.items())).run(recorded=True).trajectory)
    right, left = walks
    assert np.ptp(right["root.y"]) > 0.01 and right["leg_l.lateral_ball.force"].max() > 100
    for signal, sign in (("root.x", 1), ("root.z", 1), ("root.y", -1), ("root.roll", -1), ("root.yaw", -1)):
        assert left[signal] == pytest.approx(sign * right[signal], abs=1e-7)
    for signal in ("hip_abduction.angle", "hip_abductor.activation", "ground.medial_load", "knee.angle"):
        assert left[f"leg_l.{signal}"] == pytest.approx(right[f"leg_r.{signal}"], abs=1e-6)
