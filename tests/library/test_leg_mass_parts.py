"""The parts of a leg with mass: segments, stops, restrictor, wrapped path."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from components.calls import computed

from gaitsim.components.find import Library, library_folders
from gaitsim.errors import GaitsimError
from gaitsim.model import Model
from gaitsim.simulation.moment_arms import moment_arms
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
LEG = """
gaitsim: 1
parts:
  trunk: {use: segment/hat}
  thigh: {use: segment/thigh}
  shank: {use: segment/shank}
  foot: {use: segment/foot}
  guide: {use: joint/vertical, parent: world, child: trunk.hip}
  hip: {use: joint/hinge, parent: trunk.hip, child: thigh.proximal}
  knee:
    use: joint/limited_hinge
    parent: thigh.distal
    child: shank.proximal
    lower: 5 deg
    upper: 140 deg
    stiffness: 2000 N m/rad
  ankle: {use: joint/hinge, parent: shank.distal, child: foot.proximal}
simulate: {duration: 1 s, step: 1 ms}
"""


def made(text: str, folder: Path) -> Model:
    path = folder / "spec.yaml"
    path.write_text(text, encoding="utf-8")
    return resolve(read_spec(path), Library(library_folders(path)), "spec")


def body_of(simulator: Simulator) -> Any:
    return simulator._loop.physics


# Winter's table at 80 kg and 1.8 m: mass, length, center of mass from the proximal end, gyration.
WINTER = {
    "trunk": (0.678, 0.288, 0.626, 0.496, (0, 0, 1)),
    "thigh": (0.100, 0.245, 0.433, 0.323, (0, 0, -1)),
    "shank": (0.0465, 0.246, 0.433, 0.302, (0, 0, -1)),
    "foot": (0.0145, 0.152, 0.500, 0.475, (1, 0, 0)),
}


def test_segments_have_the_masses_of_the_table(tmp_path: Path) -> None:
    mechanics = body_of(Simulator(made(LEG, tmp_path))).model
    for name, (mass, length, center, gyration, direction) in WINTER.items():
        body = mechanics.body(f"{name}.rod")
        assert body.mass[0] == pytest.approx(mass * 80, rel=1e-12)
        assert body.ipos == pytest.approx(np.array(direction) * center * length * 1.8, abs=1e-12)
        assert body.inertia.max() == pytest.approx(mass * 80 * (gyration * length * 1.8) ** 2, rel=1e-9)
    # One leg and all above it; both legs would make the whole body.
    total = mechanics.body_subtreemass[0]
    assert 2 * total - 0.678 * 80 == pytest.approx(80, rel=1e-12)
    assert mechanics.body("shank.rod").pos == pytest.approx([0, 0, -0.245 * 1.8])
    assert mechanics.body("foot.rod").pos == pytest.approx([0, 0, -0.246 * 1.8])


def test_lengths_add_up_to_the_height_of_the_hip() -> None:
    trunk, thigh, shank = (WINTER[name][1] for name in ("trunk", "thigh", "shank"))
    assert 0.039 + shank + thigh == pytest.approx(0.530)
    assert 0.530 + trunk == pytest.approx(0.818)


STOP = {"lower": 0.1, "upper": 2.0, "stiffness": 1000.0, "stop_damping": 10.0}


@modes
@pytest.mark.parametrize(
    ("angle", "velocity", "stop"),
    [
        (1.0, 5.0, 0.0),
        (0.05, 0.0, 50.0),
        (0.05, -2.0, 70.0),  # going in: the damper helps
        (0.05, 4.0, 10.0),
        (0.05, 9.0, 0.0),  # going out fast: it never holds back
        (2.1, 0.0, -100.0),
        (2.1, 3.0, -130.0),
        (2.1, -30.0, 0.0),
    ],
)
def test_stops_push_and_never_pull(angle: float, velocity: float, stop: float, mode: str) -> None:
    now = computed("joint/limited_hinge", mode, **STOP, angle=angle, velocity=velocity, torque=3.0)
    assert now.stop == pytest.approx(stop, abs=1e-9)
    assert now.total == pytest.approx(stop + 3, abs=1e-9)
    depth = max(0.1 - angle, angle - 2.0, 0)
    assert now.stop_energy == pytest.approx(500 * depth**2, abs=1e-12)


def test_stops_take_energy_and_give_none() -> None:
    angles = np.linspace(-0.2, 0.1, 41)
    for angle in angles:
        for velocity in (-5.0, -0.1, 0.1, 5.0):
            now = computed("joint/limited_hinge", **STOP, angle=angle, velocity=velocity)
            released = -1000 * min(0.0, angle - 0.1) * velocity  # power of the spring alone
            assert now.stop * velocity <= released + 1e-12


RESTRICTED = LEG.replace(
    "simulate:",
    """  restrictor: {use: constraint/vertical, line: trunk.hip, point: foot.proximal}
initial: {guide.position: 2 m, knee.angle: 60 deg}
simulate:""",
)


def test_a_restrictor_keeps_the_ankle_below_the_hip_and_weighs_nothing(tmp_path: Path) -> None:
    simulator, without = Simulator(made(RESTRICTED, tmp_path)), Simulator(made(LEG, tmp_path))
    assert body_of(simulator).model.nbody == body_of(without).model.nbody
    assert body_of(simulator).model.body_subtreemass[0] == body_of(without).model.body_subtreemass[0]
    assert body_of(simulator).data.ne == 1
    trajectory = simulator.run(recorded=True).trajectory
    assert trajectory is not None
    # A free fall of the knee from 60 deg through a full bend.
    assert np.ptp(trajectory["knee.angle"]) >= 0
    assert np.abs(trajectory["restrictor.deviation"]).max() < 1e-6
    assert trajectory["restrictor.deviation"][0] == pytest.approx(0, abs=1e-12)
    assert trajectory["restrictor.energy"][0] == pytest.approx(0, abs=1e-12)


EXTENSOR = """  extensor:
    use: muscle/geyer2010
    max_isometric_force: 1 kN
    optimal_fiber_length: 10 cm
    tendon_slack_length: 40 cm
    path: PATH
"""
WRAPPED = """
      use: path/wrapped
      origin: [{on: thigh.distal, at: [4.5 cm, 0 m, 38 cm]}]
      center: [{on: thigh.distal, at: [0 m, 0 m, 0 m]}]
      side: [{on: thigh.distal, at: [SIDE]}]
      radius: 4 cm
      insertion: [{on: shank, at: [4.5 cm, 0 m, -8 cm]}]"""
# Two points, 4 cm in front, 30 cm above and 7 cm below: the arm is gone 38 deg from straight.
STRAIGHT = """
      use: path/sites
      points: [{on: thigh.distal, at: [4 cm, 0 m, 30 cm]}, {on: shank, at: [4 cm, 0 m, -7 cm]}]"""


def with_path(path: str, **words: str) -> str:
    for word, text in words.items():
        path = path.replace(word, text)
    return LEG.replace("simulate:", EXTENSOR.replace("PATH", path) + "simulate:")


def test_a_wrapped_path_has_the_radius_as_its_arm(tmp_path: Path) -> None:
    (arm,) = moment_arms(made(with_path(WRAPPED, SIDE="7 cm, 0 m, -7 cm"), tmp_path))
    assert (arm.path.address, arm.hinge.address, arm.limited) == ("extensor.path", "knee", True)
    assert np.degrees(arm.angles[[0, -1]]) == pytest.approx([5, 140])
    bent = arm.angles > math.radians(15)
    assert arm.arms[bent] == pytest.approx(-0.04, abs=1e-6)
    assert arm.turns == () and arm.jumps == ()


def test_a_path_slips_off_if_its_side_is_too_far_up(tmp_path: Path) -> None:
    (arm,) = moment_arms(made(with_path(WRAPPED, SIDE="7 cm, 0 m, 0 m"), tmp_path))
    assert np.degrees(arm.turns) == pytest.approx([119], abs=1)
    assert np.degrees(arm.jumps) == pytest.approx([119], abs=1)


def test_a_straight_extensor_turns_into_a_flexor(tmp_path: Path) -> None:
    (arm,) = moment_arms(made(with_path(STRAIGHT), tmp_path))
    assert np.degrees(arm.turns) == pytest.approx([180 - 142], abs=1)
    assert arm.jumps == ()


def test_a_wrap_has_one_center(tmp_path: Path) -> None:
    two = "{on: thigh.distal, at: [7 cm, 0 m, -7 cm]}"
    text = with_path(WRAPPED, SIDE="7 cm, 0 m, -7 cm").replace(f"side: [{two}]", f"side: [{two}, {two}]")
    with pytest.raises(GaitsimError, match="center and side are lists of one point each"):
        Simulator(made(text, tmp_path))
