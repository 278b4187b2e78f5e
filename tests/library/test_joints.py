"""Joints: the planar root, and hinges with the dissipative stops and the angles of Geyer & Herr (2010)."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from components.calls import computed, primitive

from gaitsim.errors import GaitsimError
from gaitsim.simulation.run import Mode, Simulator

from .plane import body_of, model_of, played

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
DEGREE = math.pi / 180

LEG = """
gaitsim: 1
parts:
  trunk: {use: segment/hat_geyer2010}
  root: {use: joint/planar, parent: world, child: trunk.hip}
  thigh: {use: segment/thigh_geyer2010}
  shank: {use: segment/shank_geyer2010}
  foot: {use: segment/foot_geyer2010}
  hip:
    {use: joint/geyer2010, parent: trunk.hip, child: thigh.proximal, neutral: 180 deg, grows: backwards, upper: 230 deg}
  knee:
    {use: joint/geyer2010, parent: thigh.distal, child: shank.proximal, neutral: 180 deg, grows: forwards,
     upper: 175 deg}
  ankle:
    {use: joint/geyer2010, parent: shank.distal, child: foot.ankle, neutral: 90 deg, grows: backwards, lower: 70 deg,
     upper: 130 deg}
  ball: {use: contact/spring_damper, frame: foot.ball, stiffness: 1 kN/m, damping: 0 N s/m}
initial:
  root.x: 0.5 m
  root.z: 2 m
  root.pitch: 10 deg
  root.forward_velocity: 1.3 m/s
  root.upward_velocity: -0.2 m/s
  root.pitch_velocity: 1 rad/s
  hip.angle: 150 deg
  knee.angle: 160 deg
  ankle.angle: 100 deg
simulate: {duration: 0.1 s, step: 0.1 ms, gravity: 0 m/s^2}
"""


def test_a_planar_root_takes_places_and_velocities(tmp_path: Path) -> None:
    found = played(LEG, tmp_path)
    for name, value in {
        "x": 0.5,
        "z": 2.0,
        "pitch": 10 * DEGREE,
        "forward_velocity": 1.3,
        "upward_velocity": -0.2,
        "pitch_velocity": 1.0,
    }.items():
        assert found[f"root.{name}"][0] == pytest.approx(value, abs=1e-12), name


def test_the_papers_angles_are_those_of_the_paper(tmp_path: Path) -> None:
    body = body_of(Simulator(model_of(LEG, tmp_path)))

    def direction(name: str) -> float:
        """Where a segment's own downward axis points: 0 is down, forwards counts positive, in degrees."""
        turned = body.data.body(f"{name}.body").xmat.reshape(3, 3) @ np.array([0, 0, -1.0])
        return math.degrees(math.atan2(turned[0], -turned[2]))

    trunk, thigh, shank, foot = (direction(name) for name in ("trunk", "thigh", "shank", "foot"))
    # Leaning forwards takes the trunk's downward axis backwards.
    assert trunk == pytest.approx(-10)
    # Hip below 180 deg: flexed, the thigh in front of the trunk's line. Knee: the shank behind the
    # thigh's line. Ankle above 90 deg: plantarflexed, the toes further down.
    assert thigh - trunk == pytest.approx(180 - 150)
    assert shank - thigh == pytest.approx(-(180 - 160))
    assert foot - shank == pytest.approx(-(100 - 90))
    ankle = np.array([0.5, 2.0]) + sum(
        0.5 * np.array([math.sin(angle * DEGREE), -math.cos(angle * DEGREE)]) for angle in (thigh, shank)
    )
    ball = ankle + 0.16 * np.array([math.cos(foot * DEGREE), math.sin(foot * DEGREE)])
    assert body.data.site("ball.place").xpos[[0, 2]] == pytest.approx(ball, abs=1e-12)


def test_a_moment_makes_its_angle_grow(tmp_path: Path) -> None:
    for joint in ("hip", "knee", "ankle"):
        push = "  push: {use: controller/pid, proportional: 0 N m/rad, integral: 1 N m/(rad s), setpoint: 1 rad,\n"
        push += f"    angle: 0 rad, angular_velocity: 0 rad/s, to: {joint}.moment}}\n"
        found = played(LEG.replace("initial:", f"{push}initial:").replace("1.3 m/s", "0 m/s"), tmp_path)
        free = played(LEG.replace("1.3 m/s", "0 m/s"), tmp_path)
        assert found[f"{joint}.angle"][-1] > free[f"{joint}.angle"][-1] + 1e-6, joint


STOPS = {"lower": 70 * DEGREE, "upper": 130 * DEGREE}


@modes
@pytest.mark.parametrize(
    ("angle", "velocity", "moment"),
    [
        (100, 50, 0.0),
        (135, 0, -1.5),  # c = 0.3 N m/deg
        (135, 1, -3.0),  # going in at w doubles it
        (135, 99, -150.0),
        (135, -0.5, -0.75),
        (135, -1, 0.0),
        (135, -30, 0.0),  # never pulls
        (66, 0, 1.2),
        (66, -2, 3.6),
        (66, 0.5, 0.6),
        (66, 5, 0.0),
    ],
)
def test_the_law_of_the_stops(angle: float, velocity: float, moment: float, mode: Mode) -> None:
    now = computed("joint/geyer2010", mode, **STOPS, angle=angle * DEGREE, angular_velocity=velocity * DEGREE)
    assert now.stop_moment == pytest.approx(moment, abs=1e-9)
    depth = max(70 - angle, angle - 130, 0) * DEGREE
    assert now.stop_energy == pytest.approx(0.5 * 0.3 / DEGREE * depth**2, rel=1e-12)
    stiffness = primitive("joint/geyer2010").parameters["stiffness"].default
    assert stiffness is not None and stiffness / DEGREE == pytest.approx(17.19, abs=0.005)


THROWN = """
gaitsim: 1
parts:
  foot: {use: segment/foot_geyer2010}
  ankle:
    {use: joint/geyer2010, parent: world, child: foot.ankle, neutral: 90 deg, grows: backwards, lower: 70 deg,
     upper: 130 deg}
initial: {ankle.angle: ANGLE, ankle.angular_velocity: SPEED}
simulate: {duration: 50 ms, step: STEP, gravity: 0 m/s^2, integrator: SCHEME}
"""


def thrown(folder: Path, angle: float, speed: float, step: str, scheme: str = "automatic") -> tuple[float, float]:
    """The largest angle and the fastest return of a foot thrown into its stop, in degrees."""
    found = played(THROWN, folder, ANGLE=f"{angle} deg", SPEED=f"{speed} rad/s", STEP=step, SCHEME=scheme)
    return float(np.degrees(found["ankle.angle"].max())), float(np.degrees(-found["ankle.angular_velocity"].min()))


@pytest.mark.parametrize("speed", [2, 10])
@pytest.mark.parametrize("angle", [129, 131, 135])
def test_a_stop_is_right_at_its_largest_step(tmp_path: Path, angle: float, speed: float) -> None:
    largest = f"{1e3 * primitive('joint/geyer2010').largest_step:g} ms"
    exact, slow = thrown(tmp_path, angle, speed, "0.01 ms")
    assert slow <= 1.0 + 1e-6
    for step, bound in ((largest, 0.3), ("1 ms", 0.15)):
        deepest, fastest = thrown(tmp_path, angle, speed, step)
        assert fastest <= 1.0 + 1e-6
        assert deepest == pytest.approx(exact, abs=bound)


def test_an_explicit_stop_throws_a_light_foot_back(tmp_path: Path) -> None:
    # Why the automatic choice is the implicit one: 2 rad/s are 115 deg/s.
    assert thrown(tmp_path, 135, 2, "0.25 ms", "euler")[1] > 300
    assert thrown(tmp_path, 131, 10, "0.5 ms", "euler")[1] > 300


def test_stops_are_in_order(tmp_path: Path) -> None:
    text = THROWN.replace("lower: 70 deg", "lower: 140 deg")
    with pytest.raises(GaitsimError, match="is not below upper"):
        Simulator(model_of(text, tmp_path, ANGLE="90 deg", SPEED="0 rad/s", STEP="1 ms", SCHEME="automatic"))
