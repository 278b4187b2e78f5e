"""Rough ground: heights by hand, what a ball feels on it, where a model stands, and the same in both modes."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from components.calls import computed

from gaitsim.simulation.run import Mode, Simulator

from .plane import model_of, played

GROUND = {"amplitude": 0.05, "cell": 0.4, "first": -100.0, "seed": 3.0}
PLACES = [(0.13, 0.0), (-3.31, 0.27), (17.05, -2.2), (2e4, 1e4)]


def at(position: float, side_position: float, mode: Mode = "rapid", **changed: float) -> Any:
    return computed("terrain/rough", mode, **{**GROUND, **changed}, position=position, side_position=side_position)


@pytest.mark.parametrize(("position", "side_position"), PLACES)
def test_the_height_and_how_it_grows(position: float, side_position: float) -> None:
    here, step = at(position, side_position), 1e-6
    assert abs(here.height) <= 0.05
    forward = at(position + step, side_position).height - at(position - step, side_position).height
    left = at(position, side_position + step).height - at(position, side_position - step).height
    assert here.gradient == pytest.approx(forward / (2 * step), abs=1e-5)
    assert here.side_gradient == pytest.approx(left / (2 * step), abs=1e-5)
    assert here.slope == pytest.approx(math.atan(here.gradient))
    plain = at(position, side_position, "normal")
    assert (plain.height, plain.gradient, plain.side_gradient) == (here.height, here.gradient, here.side_gradient)


def test_corners_are_level_and_their_heights_uniform_and_independent() -> None:
    corners = np.array([[at(0.4 * i, 0.4 * j - 0.1).height for j in range(40)] for i in range(40)]) / 0.05
    assert np.std(corners) == pytest.approx(1 / math.sqrt(3), rel=0.05)
    assert abs(corners.mean()) < 0.05
    for ahead, beside in ((1, 0), (0, 1), (1, 1), (2, 0)):
        other = np.roll(corners, (-ahead, -beside), axis=(0, 1))
        assert abs(np.corrcoef(corners.ravel(), other.ravel())[0, 1]) < 0.08
    corner = at(0.8, 0.3)
    assert corner.gradient == pytest.approx(0, abs=1e-12) and corner.side_gradient == pytest.approx(0, abs=1e-12)


def test_a_seed_is_one_ground_and_before_the_first_place_it_is_level() -> None:
    heights = [[at(0.1 + 0.4 * i, 0.1, seed=float(seed)).height for i in range(30)] for seed in range(5)]
    correlations = np.corrcoef(heights) - np.eye(5)
    assert np.abs(correlations).max() < 0.6
    level = at(0.7, 0.3, first=1.3)
    assert (level.height, level.gradient, level.side_gradient) == (0, 0, 0)
    assert at(1.5, 0.3, first=1.3).height != 0


ROUGH = "{use: terrain/rough, amplitude: 4 cm, cell: 60 cm, first: -100 m, seed: 2}"
BALL = """
gaitsim: 1
use_for: {terrain: GROUND}
parts:
  ball: {use: segment/PLACED}
  root: {use: joint/JOINT, parent: world, child: ball.center}
  ground: {use: contact/CONTACT}
  energy: {use: sensor/mechanical_energy}
initial: {root.forward_velocity: 1.5 m/s}
simulate: {duration: 2 s, step: 0.1 ms}
"""
SPACE = {
    "PLACED": "spatial, mass: 10 kg, inertia_forward: 1 kg m^2, inertia_left: 1 kg m^2, inertia_up: 1 kg m^2",
    "JOINT": "spatial",
    "CONTACT": "spatial_hunt_crossley, frame: ball.center, dissipation: 0 s/m, static_friction: 0, dynamic_friction: 0",
}
PLANE = {
    "PLACED": "rod, mass: 10 kg, length: 1 m, center_of_mass: 0, radius_of_gyration: 0.5",
    "JOINT": "planar",
}
SMOOTH = "dissipation: 0 s/m, static_friction: 0, dynamic_friction: 0"
SPHERE = f"hunt_crossley, frame: ball.center, {SMOOTH}, viscous_friction: 0 s/m"
COLLIDED = {**SPACE, "CONTACT": "mujoco, frame: ball.center, radius: 10 cm"}
POINT = "spring_damper, frame: ball.center, stiffness: 50 kN/m, damping: 0 N s/m"


@pytest.mark.parametrize("words", [SPACE, {**PLANE, "CONTACT": SPHERE}, {**PLANE, "CONTACT": POINT}])
def test_a_ball_that_slides_over_bumps_keeps_its_energy(words: dict[str, str], tmp_path: Path) -> None:
    found = played(BALL, tmp_path, GROUND=ROUGH, **words)
    speed = found["root.forward_velocity"]
    # 4 cm of height are 0.4 J/kg, so that the speed changes much; the bumps give and take it.
    assert np.ptp(speed) > 0.1
    total = found["energy.total"] + found["ground.energy"]
    assert np.ptp(total) < 0.02 * np.ptp(found["energy.kinetic"])
    if words is SPACE:
        assert np.ptp(found["root.y"]) > 0.01
    lost = found["ground.friction_force"] * speed
    rise = np.trapezoid(lost, found.times)
    assert rise == pytest.approx(5 * (speed[-1] ** 2 - speed[0] ** 2), rel=0.03)


def test_a_ball_of_mujoco_rolls_over_bumps(tmp_path: Path) -> None:
    """The forces that it reports are those that change its momentum, and it stays on the ground."""
    found = played(BALL.replace("0.1 ms", "1 ms"), tmp_path, GROUND=ROUGH, **COLLIDED)
    for velocity, force, weight in (
        ("root.forward_velocity", "ground.friction_force", 0.0),
        ("root.left_velocity", "ground.side_force", 0.0),
        ("root.upward_velocity", "ground.force", 98.1),
    ):
        # A force is one step old: it is the one over the step before.
        changes = 10 * np.diff(found[velocity])
        assert np.ptp(found[velocity]) > 0.03
        assert changes == pytest.approx(1e-3 * (found[force][1:] - weight), abs=1e-5)
    assert np.ptp(found["ground.terrain.height"]) > 0.03
    assert np.abs(found["ground.height"][500:]).max() < 2e-3


def test_a_ball_of_mujoco_without_friction_keeps_its_energy(tmp_path: Path) -> None:
    found = played(BALL, tmp_path, GROUND=ROUGH, **SPACE | {"CONTACT": f"{COLLIDED['CONTACT']}, friction: 0"})
    later = found.times > 0.1
    total = found["energy.total"][later]
    assert np.ptp(total) < 0.05 * np.ptp(found["energy.kinetic"][later])


@pytest.mark.parametrize("contact", ["geyer2010, frame: ball.center", SPHERE, POINT, COLLIDED["CONTACT"]])
def test_a_model_begins_on_the_ground_below_it(contact: str, tmp_path: Path) -> None:
    text = BALL.replace("root.forward_velocity: 1.5 m/s", "root.x: 3.3 m")
    model = model_of(text, tmp_path, GROUND=ROUGH, **PLANE, CONTACT=contact)
    signals = Simulator(model).first_instant()
    # A contact of the plane does not know that the ground also leans to the side, which raises a sphere by less.
    assert signals["ground.height"] == pytest.approx(0, abs=1e-6)
    assert abs(signals["ground.terrain.height"]) > 1e-3


def test_a_point_sticks_on_a_bump_and_feels_its_tilt(tmp_path: Path) -> None:
    text = BALL.replace("root.forward_velocity: 1.5 m/s", "root.x: 3.3 m").replace("0.1 ms", "1 ms")
    found = played(text, tmp_path, GROUND=ROUGH, **PLANE, CONTACT="geyer2010, frame: ball.center")
    rise = found["ground.terrain.gradient"][-1]
    assert abs(rise) > 0.03
    assert found["ground.force"][-1] == pytest.approx(98.1, rel=1e-3)
    # At rest nothing moves along the mean ground: friction holds what the tilt pushes.
    assert found["ground.friction_force"][-1] == pytest.approx(0, abs=0.05)
    assert found["ground.shear_spring"][-1] == pytest.approx(rise * 98.1, rel=0.01)
    assert found["ground.sticks"][-1] == 1


@pytest.mark.parametrize("words", [SPACE, COLLIDED])
def test_both_modes_make_the_same_run_on_it(words: dict[str, str], tmp_path: Path) -> None:
    text = BALL.replace("2 s", "0.1 s").replace("0.1 ms", "1 ms")
    model = model_of(text, tmp_path, GROUND=ROUGH, **words)
    rapid, normal = (Simulator(model, mode=mode).run(recorded=True).trajectory for mode in ("rapid", "normal"))
    assert rapid is not None and normal is not None
    assert rapid.values.tobytes() == normal.values.tobytes()


def test_level_ground_gets_no_actuators_for_a_tilt(tmp_path: Path) -> None:
    counts = []
    for ground in ("terrain/flat", ROUGH):
        simulator = Simulator(model_of(BALL, tmp_path, GROUND=ground, **SPACE))
        simulator.first_instant()
        counts.append(simulator._loop.physics.model.nu)
    assert counts == [3, 5]
