"""Sensors of segments and of the whole body against kinematics by hand."""

from __future__ import annotations

import numpy as np
import pytest
from components.calls import computed

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.outcome import Trajectory
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])

TWO_RODS = """
gaitsim: 1
parts:
  thigh: {use: segment/rod, mass: 3 kg, length: 0.5 m}
  shank: {use: segment/rod, mass: 2 kg, length: 0.4 m}
  trunk: {use: segment/rod, mass: 1 kg, length: 0.3 m, direction: up}
  hip: {use: joint/hinge, parent: world, child: thigh.proximal}
  knee: {use: joint/hinge, parent: thigh.distal, child: shank.proximal}
  waist: {use: joint/hinge, parent: thigh.proximal, child: trunk.proximal}
  lean: {use: sensor/orientation, frame: trunk.proximal}
  leg: {use: sensor/orientation, frame: shank.distal}
  body: {use: sensor/center_of_mass}
  foot: {use: sensor/relative_position, frame: shank.distal, origin: trunk.distal}
  motion: {use: sensor/relative_motion, frame: shank.distal, origin: trunk.distal}
initial:
  hip.angle: 20 deg
  knee.angle: 30 deg
  waist.angle: 10 deg
  knee.velocity: 15 rad/s
  waist.velocity: -25 rad/s
simulate: {duration: 1.5 s, step: 0.5 ms}
"""


def trajectory(text: str, mode: Mode = "rapid") -> Trajectory:
    model = resolve(parse(text, "spec.yaml"), Library((shipped_folder(),)), "spec")
    outcome = Simulator(model, mode).run(recorded=True)
    assert outcome.status == "completed" and outcome.trajectory is not None, outcome.reason
    return outcome.trajectory


@pytest.fixture(scope="module")
def moved() -> Trajectory:
    return trajectory(TWO_RODS)


def place(angle: np.ndarray, length: float) -> np.ndarray:
    """Where the end of a hanging rod is that is turned by an angle about the y axis."""
    return np.array([-np.sin(angle), np.zeros_like(angle), -np.cos(angle)]) * length


def test_pitch_is_the_sum_of_the_hinges_and_goes_on_through_whole_turns(moved: Trajectory) -> None:
    shank, trunk = moved["hip.angle"] + moved["knee.angle"], moved["hip.angle"] + moved["waist.angle"]
    np.testing.assert_allclose(moved["leg.pitch"], shank, atol=1e-9)
    np.testing.assert_allclose(moved["lean.pitch"], trunk, atol=1e-9)
    assert np.ptp(trunk) > 3 * np.pi
    np.testing.assert_allclose(moved["leg.rate"], moved["hip.velocity"] + moved["knee.velocity"], atol=1e-9)
    np.testing.assert_allclose(moved["lean.rate"], moved["hip.velocity"] + moved["waist.velocity"], atol=1e-9)


def test_a_trunk_that_leans_forwards_has_a_positive_pitch(moved: Trajectory) -> None:
    assert moved["lean.pitch"][0] == pytest.approx(np.radians(30))
    # The trunk's upper end is in front of the hip then, and the foot behind it.
    assert moved["lean.ahead"][0] == pytest.approx(0.5)
    assert moved["foot.forward"][0] < 0


def test_center_of_mass(moved: Trajectory) -> None:
    thigh, shank, trunk = (moved[name] for name in ("hip.angle", "leg.pitch", "lean.pitch"))
    masses = 3 * place(thigh, 0.25) + 2 * (place(thigh, 0.5) + place(shank, 0.2)) - place(trunk, 0.15)
    found = np.array([moved[f"body.{name}"] for name in ("forward", "left", "height")])
    np.testing.assert_allclose(found, masses / 6, atol=1e-9)
    for name, rate in (("forward", "forward_velocity"), ("left", "left_velocity"), ("height", "upward_velocity")):
        slope = np.gradient(moved[f"body.{name}"], 5e-4)[1:-1]
        np.testing.assert_allclose(moved[f"body.{rate}"][1:-1], slope, atol=5e-3)


def test_relative_position(moved: Trajectory) -> None:
    thigh, shank, trunk = (moved[name] for name in ("hip.angle", "leg.pitch", "lean.pitch"))
    foot = place(thigh, 0.5) + place(shank, 0.4) + place(trunk, 0.3)
    found = np.array([moved[f"foot.{name}"] for name in ("forward", "left", "up")])
    np.testing.assert_allclose(found, foot, atol=1e-9)


def test_both_modes_read_the_same(moved: Trajectory) -> None:
    short = TWO_RODS.replace("1.5 s", "0.2 s")
    normal = trajectory(short, "normal")
    np.testing.assert_allclose(normal.values, moved.values[: len(normal.values)], rtol=1e-9, atol=1e-12)


@modes
def test_load(mode: Mode) -> None:
    assert computed("sensor/load", mode, loads=0.7).load == 0.7


def test_loads_of_a_leg_add_up() -> None:
    """A rod on two springs at its ends: each bears a half, together they bear all."""
    text = """
gaitsim: 1
parts:
  plank: {use: segment/rod, mass: 10 kg, length: 1 m, direction: forward}
  root: {use: joint/planar, parent: world, child: plank.center}
  front:
    {use: contact/spring_damper, frame: plank.distal, stiffness: 50 kN/m, damping: 1 kN s/m, to: {load: leg.loads}}
  back:
    {use: contact/spring_damper, frame: plank.proximal, stiffness: 50 kN/m, damping: 1 kN s/m, to: {load: leg.loads}}
  leg: {use: sensor/load}
simulate: {duration: 1 s, step: 0.5 ms}
"""
    found = trajectory(text)
    np.testing.assert_allclose(found["leg.load"], found["front.load"] + found["back.load"])
    assert found["leg.load"][-1] == pytest.approx(1, abs=1e-6)
    assert found["front.load"][-1] == pytest.approx(0.5, abs=1e-6)


def test_relative_motion_is_the_distance_and_the_rate_of_the_place(moved: Trajectory) -> None:
    np.testing.assert_allclose(moved["motion.forward"], moved["foot.forward"], atol=1e-12)
    rate = np.gradient(moved["foot.x"], moved.times)
    np.testing.assert_allclose(moved["motion.forward_velocity"][1:-1], rate[1:-1], atol=2e-2)
    np.testing.assert_allclose(moved["motion.medial_velocity"], 0, atol=1e-12)
