"""SCONE's walker H1922 in space, from its published values: what it begins with, and that both sides are one leg."""

from __future__ import annotations

import numpy as np
import pytest

from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

from .models import ROOT, model

SPEC = ROOT / "specs" / "walking_scone_h1922.yaml"


def test_it_takes_its_first_step_from_the_published_values() -> None:
    found = Simulator(model(SPEC, [("simulate.duration", "0.6 s")])).run(recorded=True).trajectory
    assert found is not None
    assert found["leg_r.ground.load"][0] == pytest.approx(1, abs=1e-6)  # the right foot carries one body weight
    landed = np.flatnonzero(found["leg_l.ground.load"] > 0.1)
    assert 0.3 < found.times[landed[0]] < 0.6
    assert found["root.x"][landed[0]] > 0.3
    assert np.max(np.abs(found["root.roll"][: landed[0]])) < 0.25


def test_two_mirrored_starts_are_two_mirrored_walks() -> None:
    walks = []
    for side, sign in (("r", 1), ("l", -1)):
        other = {"r": "l", "l": "r"}[side]
        settings = {f"initial.root.{name}": f"{sign * value} rad" for name, value in (("yaw", 0.02), ("roll", 0.07))}
        joints = {"hip_flexion": (0.31, 0.24), "hip_adduction": (0.02, -0.03), "knee": (-0.28, -1.07)}
        joints |= {"hip_rotation": (0.05, -0.02), "ankle": (0.17, -0.42)}
        for joint, (near, far) in joints.items():
            settings[f"initial.leg_{side}.{joint}.angle"] = f"{near} rad"
            settings[f"initial.leg_{other}.{joint}.angle"] = f"{far} rad"
        for name in ("bending", "rotation"):
            settings[f"initial.lumbar_{name}.angle"] = f"{0.03 * sign} rad"
        for joint in ("hip_flexion", "knee", "ankle"):
            for leg in "lr":
                settings[f"initial.leg_{leg}.{joint}.angular_velocity"] = "0.2 rad/s"
        settings["simulate.duration"] = "0.3 s"
        walks.append(Simulator(model(SPEC, settings.items())).run(recorded=True).trajectory)
    right, left = walks
    for signal, sign in (("root.x", 1), ("root.z", 1), ("root.y", -1), ("root.roll", -1), ("root.yaw", -1)):
        assert left[signal] == pytest.approx(sign * right[signal], abs=1e-7)
    for signal in ("hip_adduction.angle", "gluteus_medius.activation", "ground.medial_load", "knee.angle"):
        assert left[f"leg_l.{signal}"] == pytest.approx(right[f"leg_r.{signal}"], abs=1e-6)


def test_knees_and_ankles_yield_to_the_side_as_much_as_their_stops_let_them() -> None:
    found = Simulator(model(SPEC, [("simulate.duration", "0.4 s")])).run(recorded=True).trajectory
    assert found is not None
    for joint in ("knee_varus", "knee_twist", "ankle_inversion", "ankle_twist"):
        angle = found[f"leg_r.{joint}.angle"]
        assert np.radians(0.5) < np.max(np.abs(angle)) < np.radians(10)
        assert found[f"leg_r.{joint}.stop_moment"] == pytest.approx(-500 * angle, abs=1e-9)


@pytest.mark.parametrize("step", ["0.5 ms", pytest.param("0.25 ms", marks=pytest.mark.slow)])
def test_the_tuned_values_walk(step: str) -> None:
    found = Simulator(Opening(SPEC, (f"simulate.step={step}",)).open().model()).run()
    assert found.status == "completed" and found.simulated_seconds == pytest.approx(20)
    assert found.metrics["fall_time.fell"] == 0 and 1.0 < found.metrics["speed"] < 1.5
    assert 0.56 < found.metrics["stance_fraction"] < 0.66
    assert 0.07 < found.metrics["step_width"] < 0.18
    assert found.metrics["correlation_hip"] > 0.9 and found.metrics["correlation_knee"] > 0.9
