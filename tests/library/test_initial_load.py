"""The height at the start follows from the load on the ground: in the plane and in space."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gaitsim.distribution import shipped_folder
from gaitsim.errors import InvalidSpec, SimulationFailed
from gaitsim.simulation.run import Simulator

from .plane import body_of, model_of, played

WEIGHT = 60 * 9.81
# A block on a contact before and one behind its center.
PLANE = """
gaitsim: 1
use_for: {terrain: TERRAIN}
parts:
  block: {use: segment/rod, mass: 60 kg, length: 1 m, center_of_mass: 0.5, radius_of_gyration: 0.3}
  root: {use: joint/planar, parent: world, child: block.center, load: LOAD}
  heel: {use: contact/CONTACT, frame: {on: block.center, at: [-10 cm, 0 m, 0 m]}}
  toe: {use: contact/CONTACT, frame: {on: block.center, at: [12 cm, 0 m, 0 m]}}
initial: {root.x: 0.3 m, root.pitch: PITCH, root.upward_velocity: SPEED, root.pitch_velocity: RATE}
simulate: {duration: 10 ms, step: 1 ms}
"""
SPACE = """
gaitsim: 1
use_for: {terrain: TERRAIN}
parts:
  block: {use: segment/spatial, mass: 60 kg, inertia_forward: 1 kg m^2, inertia_left: 1 kg m^2, inertia_up: 1 kg m^2}
  root: {use: joint/spatial, parent: world, child: block.center, load: LOAD}
  heel: {use: contact/CONTACT, frame: {on: block.center, at: [-10 cm, 0 m, 0 m]}}
  big_toe: {use: contact/CONTACT, frame: {on: block.center, at: [12 cm, 4 cm, 0 m]}}
  little_toe: {use: contact/CONTACT, frame: {on: block.center, at: [10 cm, -4 cm, 0 m]}}
initial:
  root.x: 0.3 m
  root.pitch: PITCH
  root.roll: 3 deg
  root.upward_velocity: SPEED
  root.pitch_velocity: RATE
  root.roll_velocity: 10 deg/s
simulate: {duration: 10 ms, step: 1 ms}
"""
FLAT = {"TERRAIN": "terrain/flat", "LOAD": 1, "PITCH": "0 deg", "SPEED": "0 m/s", "RATE": "0 rad/s"}


def first_loads(found: Any) -> float:
    return float(sum(found[name][0] for name in found.signals if name.endswith(".load")))


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"LOAD": 0.2},
        {"PITCH": "4 deg"},
        {"PITCH": "-20 deg", "SPEED": "-0.3 m/s"},
        {"SPEED": "0.01 m/s", "RATE": "0.05 rad/s"},
        {"TERRAIN": "{use: terrain/slope, angle: 4 deg}"},
        {"TERRAIN": "{use: terrain/rough, seed: 3}", "PITCH": "2 deg"},
    ],
    ids=str,
)
@pytest.mark.parametrize(
    ("text", "contact"),
    [
        (PLANE, "hunt_crossley"),
        (PLANE, "hunt_crossley, smooth: 1"),
        (PLANE, "geyer2010"),
        (SPACE, "spatial_hunt_crossley"),
        (SPACE, "spatial_geyer2010"),
    ],
)
def test_the_ground_carries_the_load_at_the_first_instant(
    tmp_path: Path, text: str, contact: str, change: dict[str, Any]
) -> None:
    words = {**FLAT, "CONTACT": contact, **change}
    assert first_loads(played(text, tmp_path, **words)) == pytest.approx(words["LOAD"], rel=2e-8)


def test_the_depth_is_that_of_the_law(tmp_path: Path) -> None:
    text = SPACE.replace("  big_toe:", "  # big_toe:").replace("  little_toe:", "  # little_toe:")
    found = played(text, tmp_path, **{**FLAT, "CONTACT": "spatial_hunt_crossley", "SPEED": "-0.2 m/s"})
    rate = found["heel.velocity"][0]
    assert rate < -0.19
    depth = (WEIGHT / (1 - 1.5 * rate)) ** (2 / 3) / 5503.2
    assert found["heel.height"][0] == pytest.approx(-depth, abs=1e-9)
    assert found["root.upward_velocity"][0] == -0.2


@pytest.mark.parametrize(("text", "contact"), [(PLANE, "hunt_crossley"), (SPACE, "spatial_geyer2010")])
def test_both_modes_begin_with_the_same_bits(tmp_path: Path, text: str, contact: str) -> None:
    model = model_of(text, tmp_path, **{**FLAT, "CONTACT": contact, "PITCH": "1 deg", "SPEED": "-0.1 m/s"})
    rapid, normal = (Simulator(model, mode).run(recorded=True).trajectory for mode in ("rapid", "normal"))
    assert rapid is not None and normal is not None
    assert rapid.values.tobytes() == normal.values.tobytes()


def test_the_height_belongs_to_a_candidate_and_not_to_those_before_it(tmp_path: Path) -> None:
    pitch, speed = "{value: 1 deg, tune: [-5 deg, 5 deg]}", "{value: 0 m/s, tune: [-1 m/s, 1 m/s]}"
    words = {**FLAT, "CONTACT": "spatial_hunt_crossley", "PITCH": pitch, "SPEED": speed}
    model = model_of(SPACE, tmp_path, **words)
    used = Simulator(model)
    heights = []
    for candidate in ([0.02, 0.0], [0.05, -0.4], [-0.03, 0.3], [0.02, 0.0]):
        found = used.run(candidate, recorded=True).trajectory
        fresh = Simulator(model).run(candidate, recorded=True).trajectory
        assert found is not None and fresh is not None
        assert found.values.tobytes() == fresh.values.tobytes()
        assert first_loads(found) == pytest.approx(1, rel=2e-8)
        heights.append(found["root.z"][0])
    assert heights[3] == heights[0] and len(set(heights)) == 3
    # Every contact moves up too fast for any force.
    assert "25.6 cm below the first touch it carries 0" in used.run([0.0, 1.0]).reason


def test_a_tuned_load_is_that_of_the_candidate(tmp_path: Path) -> None:
    words = {**FLAT, "CONTACT": "hunt_crossley", "LOAD": "{value: 1, tune: [0, 2]}"}
    simulator = Simulator(model_of(PLANE, tmp_path, **words))
    for load in (0.0, 0.5, 2.0):
        found = simulator.run([load], recorded=True).trajectory
        assert found is not None
        assert first_loads(found) == pytest.approx(load, rel=2e-8)
        if load == 0:
            assert found["heel.height"][0] == pytest.approx(0, abs=1e-15)


def test_other_positions_and_all_velocities_stay(tmp_path: Path) -> None:
    words = {**FLAT, "CONTACT": "hunt_crossley", "PITCH": "3 deg", "SPEED": "-0.2 m/s", "RATE": "0.4 rad/s"}
    free, loaded = (body_of(Simulator(model_of(PLANE, tmp_path, **{**words, "LOAD": load}))) for load in (0, 1))
    assert np.flatnonzero(free.data.qpos != loaded.data.qpos).tolist() == [1]
    assert free.data.qvel.tobytes() == loaded.data.qvel.tobytes()
    assert 1e-3 < free.data.qpos[1] - loaded.data.qpos[1] < 2e-2


def test_a_force_that_begins_with_a_jump_may_have_no_height(tmp_path: Path) -> None:
    words = {**FLAT, "CONTACT": "spring_damper, stiffness: 60 kN/m, damping: 1 kN s/m"}
    assert first_loads(played(PLANE, tmp_path, **{**words, "SPEED": "-0.1 m/s"})) == pytest.approx(1, rel=2e-8)
    # Two dampers of 1 kN s/m at 1 m/s push with 2 kN at the first touch already.
    with pytest.raises(InvalidSpec, match=r"0 cm below the first touch it carries 3\.4;"):
        Simulator(model_of(PLANE, tmp_path, **{**words, "SPEED": "-1 m/s"}))


@pytest.mark.parametrize("mode", ["rapid", "normal"])
def test_a_contact_that_raises_says_why(tmp_path: Path, mode: Any) -> None:
    own = tmp_path / "components" / "contact" / "own.py"
    own.parent.mkdir(parents=True)
    shipped = shipped_folder() / "contact" / "spring_damper.py"
    line = "        y.force = y.in_contact"
    own.write_text(
        shipped.read_text().replace(
            line, f'        if y.in_contact > 0.5:\n            raise ValueError("deep")\n{line}'
        )
    )
    words = {**FLAT, "CONTACT": "own, stiffness: 60 kN/m, damping: 0 N s/m"}
    with pytest.raises(SimulationFailed, match=r"raised in output at 0 s \(.*own.py:\d+\): ValueError: deep"):
        Simulator(model_of(PLANE, tmp_path, **words), mode)
