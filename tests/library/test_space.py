"""Mechanics in space against closed forms: free bodies, pendulums, momenta, spheres that slide."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import ellipk

from gaitsim.simulation.run import Simulator

from .plane import body_of, model_of, played

EXACT = {"STEP": "1 ms", "DURATION": "2 s", "GRAVITY": "0 m/s^2", "INTEGRATOR": "rk4"}

TOP = """
gaitsim: 1
parts:
  top: {use: segment/spatial, mass: 2 kg, inertia_forward: 0.02 kg m^2, inertia_left: 0.02 kg m^2,
    inertia_up: 0.035 kg m^2}
  root: {use: joint/spatial, parent: world, child: top.center, pose: free}
initial:
  root.forward_velocity: 0.3 m/s
  root.left_velocity: -0.2 m/s
  root.upward_velocity: 4 m/s
  root.roll: 20 deg
  root.pitch_velocity: 1 rad/s
  root.yaw_velocity: 4 rad/s
simulate: {duration: DURATION, step: STEP, gravity: GRAVITY, integrator: INTEGRATOR}
"""


def turned(yaw: float, roll: float, pitch: float) -> Rotation:
    """The turn that yaw, roll and pitch of a root make, in this order, each about the axes it finds."""
    return Rotation.from_euler("ZXY", [yaw, roll, pitch])


def test_a_free_top_flies_and_precesses_as_euler_says(tmp_path: Path) -> None:
    found = played(TOP, tmp_path, **{**EXACT, "GRAVITY": "9.81 m/s^2"})
    t = found.times
    assert found["root.x"] == pytest.approx(0.3 * t, abs=1e-9)
    assert found["root.y"] == pytest.approx(-0.2 * t, abs=1e-9)
    assert found["root.z"] == pytest.approx(4 * t - 9.81 / 2 * t**2, abs=1e-9)
    across, along = 0.02, 0.035
    first = turned(0, math.radians(20), 0)
    # Rates of yaw and pitch at the start, as an angular velocity of the world.
    spin = np.array([0, 0, 4.0]) + first.apply([0, 1.0, 0])
    inside = first.inv().apply(spin)
    momentum = first.apply(np.array([across, across, along]) * inside)
    for k in (500, 1000, 1999):
        precession = Rotation.from_rotvec(momentum / across * t[k])
        own = Rotation.from_rotvec([0, 0, -(along - across) / across * inside[2] * t[k]])
        ideal = precession * first * own
        real = turned(*(found[f"root.{name}"][k] for name in ("yaw", "roll", "pitch")))
        assert (ideal.inv() * real).magnitude() < 1e-9


CHAIN = """
gaitsim: 1
parts:
  trunk: {use: segment/spatial, mass: 30 kg, inertia_forward: 1 kg m^2, inertia_left: 0.9 kg m^2,
    inertia_up: 0.4 kg m^2}
  root: {use: joint/spatial, parent: world, child: trunk.center, pose: free}
  leg: {use: segment/spatial, mass: 9 kg, inertia_forward: 0.13 kg m^2, inertia_left: 0.14 kg m^2,
    inertia_up: 0.04 kg m^2, proximal_up: 17 cm, distal_up: -20 cm}
  flexion: {use: joint/spatial_hinge, parent: PLACE, child: leg.proximal, axis_left: -1}
  adduction: {use: joint/spatial_hinge, parent: PLACE, child: leg.proximal, axis_forward: 1}
  rotation: {use: joint/spatial_hinge, parent: PLACE, child: leg.proximal, axis_up: 1}
  foot: {use: segment/spatial, mass: 1 kg, inertia_forward: 0.001 kg m^2, inertia_left: 0.004 kg m^2,
    inertia_up: 0.004 kg m^2}
  subtalar: {use: joint/spatial_hinge, parent: leg.distal, child: foot.center, axis_forward: 0.8, axis_left: 0.1,
    axis_up: -0.6}
  push: {use: perturbation/torque, strength: 3 N m, onset: 0.1 s, duration: 0.2 s, to: adduction.moment}
  energy: {use: sensor/mechanical_energy}
initial:
  root.pitch_velocity: 1 rad/s
  root.yaw_velocity: -2 rad/s
  root.left_velocity: 0.5 m/s
  flexion.angular_velocity: -2 rad/s
  adduction.angular_velocity: 1 rad/s
  rotation.angle: 10 deg
  subtalar.angular_velocity: 3 rad/s
simulate: {duration: 1 s, step: 0.5 ms, gravity: 0 m/s^2, integrator: rk4}
"""
BESIDE = "{on: trunk.center, at: [1 cm, -8 cm, -30 cm]}"


def momenta(physics: Any) -> Any:
    """Linear momentum, and angular momentum about the center of mass."""
    mujoco.mj_forward(physics.model, physics.data)
    mujoco.mj_subtreeVel(physics.model, physics.data)
    mass = physics.model.body_subtreemass[0]
    return np.concatenate([mass * physics.data.subtree_linvel[0], physics.data.subtree_angmom[0]])


def test_a_free_body_of_stacked_hinges_keeps_both_momenta_and_its_energy(tmp_path: Path) -> None:
    simulator = Simulator(model_of(CHAIN, tmp_path, PLACE=BESIDE))
    physics = body_of(simulator)
    physics.pose(simulator.model.values())
    before = momenta(physics)
    found = simulator.run(recorded=True).trajectory
    assert momenta(physics) == pytest.approx(before, abs=1e-8)
    # All energy that comes or goes does so through the torque, which acts for 0.2 s.
    energy = found["energy.total"]
    free = (found.times < 0.0995) | (found.times > 0.3005)
    early, late = energy[free & (found.times < 0.2)], energy[free & (found.times > 0.2)]
    assert np.ptp(early) < 1e-8 and np.ptp(late) < 1e-8
    power = found["push.torque"] * found["adduction.angular_velocity"]
    assert late[0] - early[0] == pytest.approx(np.trapezoid(power, found.times), rel=5e-3)


CONE = """
gaitsim: 1
parts:
  rod: {use: segment/spatial, mass: 3 kg, inertia_forward: 0.2 kg m^2, inertia_left: 0.2 kg m^2,
    inertia_up: 0.01 kg m^2, proximal_up: 50 cm}
  turn: {use: joint/spatial_hinge, parent: world, child: rod.proximal, axis_up: 2}
  swing: {use: joint/spatial_hinge, parent: world, child: rod.proximal, AXIS: 1}
initial: {swing.angle: ANGLE, turn.angular_velocity: RATE}
simulate: {duration: 2 s, step: 1 ms, integrator: rk4}
"""


@pytest.mark.parametrize("axis", ["axis_left", "axis_forward"])
def test_a_conical_pendulum_keeps_its_cone(tmp_path: Path, axis: str) -> None:
    angle, about_pivot = math.radians(40), 0.2 + 3 * 0.25
    rate = math.sqrt(3 * 9.81 * 0.5 / ((about_pivot - 0.01) * math.cos(angle)))
    found = played(CONE, tmp_path, AXIS=axis, ANGLE=f"{angle} rad", RATE=f"{rate} rad/s")
    assert found["swing.angle"] == pytest.approx(np.full(2000, angle), abs=1e-8)
    assert found["turn.angle"] == pytest.approx(rate * found.times, abs=1e-7)


@pytest.mark.parametrize("axis", ["axis_left", "axis_forward"])
def test_a_pendulum_swings_across_as_it_does_forwards(tmp_path: Path, axis: str) -> None:
    found = played(CONE, tmp_path, AXIS=axis, ANGLE="1 rad", RATE="0 rad/s")
    # The exact period of a large swing.
    period = 4 * math.sqrt((0.2 + 3 * 0.25) / (3 * 9.81 * 0.5)) * ellipk(math.sin(0.5) ** 2)
    down = found["swing.angle"]
    crossing = np.flatnonzero((down[:-1] > 0) & (down[1:] <= 0))[0]
    share = down[crossing] / (down[crossing] - down[crossing + 1])
    assert found.times[crossing] + share * 1e-3 == pytest.approx(period / 4, abs=1e-6)


SLIDER = """
gaitsim: 1
parts:
  arm: {use: segment/spatial, mass: 5 kg, inertia_forward: 0.01 kg m^2, inertia_left: 0.01 kg m^2,
    inertia_up: 0.01 kg m^2, proximal_forward: -60 cm}
  lift: {use: joint/vertical, parent: world, child: arm.proximal}
  turn: {use: joint/spatial_hinge, parent: world, child: arm.proximal, axis_up: 1}
  ball: {use: contact/spatial_hunt_crossley, frame: arm.center, static_friction: 0.5, dynamic_friction: 0.5}
  energy: {use: sensor/mechanical_energy}
initial: {lift.position: DEPTH, turn.angular_velocity: 5 rad/s}
simulate: {duration: 0.4 s, step: 0.2 ms}
"""


def test_a_foot_that_slides_in_a_circle_loses_what_friction_takes(tmp_path: Path) -> None:
    depth = (5 * 9.81) ** (2 / 3) / 5503.2
    found = played(SLIDER, tmp_path, DEPTH=f"{0.03 - depth} m")
    # Friction is mu F against the way, whichever way that is: m r^2 + I turns slower by mu m g r.
    slowing = 0.5 * 5 * 9.81 * 0.6 / (5 * 0.36 + 0.01)
    assert found["turn.angular_velocity"] == pytest.approx(5 - slowing * found.times, abs=2e-3)
    way = 0.6 * (found["turn.angle"][-1] - found["turn.angle"][0])
    lost = found["energy.total"][0] - found["energy.total"][-1]
    assert lost == pytest.approx(0.5 * 5 * 9.81 * way, rel=1e-3)
    along = np.hypot(found["ball.friction_force"], found["ball.side_force"])[1:]
    assert along == pytest.approx(0.5 * found["ball.force"][1:], rel=2e-3)


BLOCK = """
gaitsim: 1
parts:
  block: {use: segment/spatial, mass: 60 kg, inertia_forward: 1 kg m^2, inertia_left: 1 kg m^2, inertia_up: 1 kg m^2}
  root: {use: joint/spatial, parent: world, child: block.center}
  ball: {use: contact/CONTACT, sides: [l, r], frame: {on: block.center, at: [-12 cm, -20 cm, -3 cm]},
    terrain: {use: terrain/slope, angle: 0 deg, across: ANGLE}}
  front: {use: contact/CONTACT, frame: {on: block.center, at: [24 cm, 0 cm, -3 cm]}, terrain: {use: terrain/slope,
    angle: 0 deg, across: ANGLE}}
initial: {root.roll: ANGLE}
simulate: {duration: 1.5 s, step: 0.5 ms}
"""
HELD = "spatial_hunt_crossley, radius: 3 cm"


def test_a_block_on_a_slope_across_creeps_down_as_friction_lets_it(tmp_path: Path) -> None:
    slope = math.radians(10)
    found = played(BLOCK, tmp_path, CONTACT=HELD, ANGLE="10 deg")
    # F (v / v_t) (2 mu_s - mu_d) for slow slips: it creeps to the right, downhill, and not forwards.
    ideal = math.tan(slope) * 0.15 / (0.6 + 0.6)
    rate = -(found["root.y"][-1] - found["root.y"][-401]) / 0.2 / math.cos(slope)
    assert rate == pytest.approx(ideal, rel=0.05)
    assert abs(found["root.x"][-1] - found["root.x"][-401]) < 1e-4
    normal = sum(found[f"{name}.force"] for name in ("ball_l", "ball_r", "front"))
    side = sum(found[f"{name}.side_force"] for name in ("ball_l", "ball_r", "front"))
    assert normal[-1] == pytest.approx(60 * 9.81 * math.cos(slope), rel=1e-3)
    assert side[-1] == pytest.approx(60 * 9.81 * math.sin(slope), rel=1e-3)


def test_a_block_on_a_slope_that_is_too_steep_slides_down_across(tmp_path: Path) -> None:
    found = played(BLOCK, tmp_path, CONTACT=f"{HELD}, static_friction: 0.3, dynamic_friction: 0.3", ANGLE="25 deg")
    along = -found["root.left_velocity"] / math.cos(math.radians(25))
    growth = (along[-1] - along[-401]) / 0.2
    assert growth == pytest.approx(9.81 * (math.sin(math.radians(25)) - 0.3 * math.cos(math.radians(25))), rel=0.02)


def test_mujocos_spheres_hold_a_block_on_a_slope_across(tmp_path: Path) -> None:
    slope = math.radians(20)
    found = played(BLOCK, tmp_path, CONTACT="mujoco, radius: 3 cm", ANGLE="20 deg")
    # Its friction is soft: the block creeps, by 1 mm/s.
    assert np.hypot(*(np.ptp(found[f"root.{axis}"][-401:]) for axis in "xy")) < 4e-4
    normal, side, forward = (
        sum(found[f"{name}.{kind}"][-401:].mean() for name in ("ball_l", "ball_r", "front"))
        for kind in ("force", "side_force", "friction_force")
    )
    assert normal == pytest.approx(60 * 9.81 * math.cos(slope), rel=1e-3)
    assert side == pytest.approx(60 * 9.81 * math.sin(slope), rel=1e-3)
    assert forward == pytest.approx(0, abs=0.1)


def test_mujocos_spheres_slide_down_a_slope_across_that_is_too_steep(tmp_path: Path) -> None:
    found = played(BLOCK, tmp_path, CONTACT="mujoco, radius: 3 cm, friction: 0.3", ANGLE="25 deg")
    along = -found["root.left_velocity"] / math.cos(math.radians(25))
    growth = (along[-1] - along[-401]) / 0.2
    assert growth == pytest.approx(9.81 * (math.sin(math.radians(25)) - 0.3 * math.cos(math.radians(25))), rel=0.02)


def test_the_left_side_is_the_mirror_of_the_right_one(tmp_path: Path) -> None:
    text = """
gaitsim: 1
parts:
  arm: {use: segment/spatial, sides: [l, r], mass: 2 kg, inertia_forward: 0.01 kg m^2, inertia_left: 0.02 kg m^2,
    inertia_up: 0.03 kg m^2, proximal_forward: 10 cm, proximal_left: 3 cm, proximal_up: 40 cm}
  first: {use: joint/spatial_hinge, sides: [l, r], parent: {on: world, at: [0 m, -10 cm, 2 m]},
    child: "arm_{side}.proximal", axis_forward: 1, axis_left: 0.2}
  second: {use: joint/spatial_hinge, sides: [l, r], parent: {on: world, at: [0 m, -10 cm, 2 m]},
    child: "arm_{side}.proximal", axis_up: 1, axis_left: 0.4}
  place: {use: sensor/relative_position, sides: [l, r], frame: {on: "arm_{side}.center", at: [0 m, 7 cm, 1 cm]},
    origin: world}
initial: {first.angle: 30 deg, second.angle: 20 deg}
simulate: {duration: 0.5 s, step: 1 ms}
"""
    found = played(text, tmp_path)
    assert np.ptp(found["first_l.angle"]) > 0.5
    for joint in ("first", "second"):
        assert found[f"{joint}_l.angle"] == pytest.approx(found[f"{joint}_r.angle"], abs=1e-12)
    assert found["place_l.x"] == pytest.approx(found["place_r.x"], abs=1e-12)
    assert found["place_l.y"] == pytest.approx(-found["place_r.y"], abs=1e-12)
    assert found["place_l.z"] == pytest.approx(found["place_r.z"], abs=1e-12)
    assert found["place_r.y"][0] != pytest.approx(0, abs=0.01)


def test_a_composite_hands_a_place_on_to_all_hinges_inside(tmp_path: Path) -> None:
    folder = tmp_path / "components" / "leg"
    folder.mkdir(parents=True)
    (folder / "hanging.yaml").write_text("""
about: A leg on two hinges.
attachments: {hip: Where it hangs.}
parts:
  thigh: {use: segment/spatial, mass: 8 kg, inertia_forward: 0.1 kg m^2, inertia_left: 0.1 kg m^2,
    inertia_up: 0.03 kg m^2, proximal_up: 20 cm}
  flexion: {use: joint/spatial_hinge, parent: =hip, child: thigh.proximal, axis_left: -1}
  adduction: {use: joint/spatial_hinge, parent: =hip, child: thigh.proximal, axis_forward: 1}
  center: {use: sensor/relative_position, frame: thigh.center, origin: world}
""")
    text = """
gaitsim: 1
parts:
  leg: {use: leg/hanging, sides: [l, r], hip: {on: world, at: [0 m, -9 cm, 1 m]}}
simulate: {duration: 0.1 s, step: 1 ms}
"""
    found = played(text, tmp_path)
    assert found["leg_r.center.y"][0] == pytest.approx(-0.09)
    assert found["leg_l.center.y"][0] == pytest.approx(0.09)
    assert found["leg_l.center.z"][0] == pytest.approx(0.8)


def test_orientation_is_that_of_the_segment_and_turns_round_on_the_left(tmp_path: Path) -> None:
    sensor = "  way: {use: sensor/spatial_orientation, sides: [l, r], frame: top.center}\n"
    text = TOP.replace("initial:", f"{sensor}initial:\n  root.yaw: 3 rad")
    found = played(text, tmp_path, **EXACT)
    assert np.ptp(found["way_r.yaw"]) > 2 * math.pi  # whole turns and more
    for k in (0, 700, 1500):
        posture = turned(*(found[f"root.{name}"][k] for name in ("yaw", "roll", "pitch")))
        named = Rotation.from_euler("ZYX", [found[f"way_r.{name}"][k] for name in ("yaw", "pitch", "roll")])
        assert (named.inv() * posture).magnitude() < 1e-12
        rates = (found[f"root.{name}_velocity"][k] for name in ("yaw", "roll", "pitch"))
        axes = ([0, 0, 1], turned(found["root.yaw"][k], 0, 0).apply([1, 0, 0]), posture.apply([0, 1, 0]))
        ideal = posture.inv().apply(sum(rate * np.array(axis) for rate, axis in zip(rates, axes, strict=True)))
        real = [found[f"way_r.{name}_velocity"][k] for name in ("roll", "pitch", "yaw")]
        assert real == pytest.approx(ideal, abs=1e-9)
    for name, sign in (("yaw", -1), ("roll", -1), ("pitch", 1)):
        assert found[f"way_l.{name}"] == pytest.approx(sign * found[f"way_r.{name}"], abs=1e-12)
        assert found[f"way_l.{name}_velocity"] == pytest.approx(sign * found[f"way_r.{name}_velocity"], abs=1e-12)
