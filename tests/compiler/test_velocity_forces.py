"""Actuators whose force depends on velocity, the integrator they ask for, and the ground."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

from gaitsim.compiler.mjcf import Assembly, assemble
from gaitsim.components.find import Library, library_folders
from gaitsim.spec.resolve import read_spec, resolve

SPEC = """
gaitsim: 1
parts:
  block: {use: segment/point_mass, mass: 80 kg}
  root: {use: joint/planar, parent: world, child: block.center}
  ground: {use: contact/CONTACT, frame: block.center, terrain: TERRAIN}
simulate: {duration: 1 s, step: 1 ms, integrator: SCHEME}
"""
EULER, IMPLICIT = mujoco.mjtIntegrator.mjINT_EULER, mujoco.mjtIntegrator.mjINT_IMPLICIT
FAST = mujoco.mjtIntegrator.mjINT_IMPLICITFAST


def assembled(folder: Path, contact: str, terrain: str = "{use: terrain/flat}", scheme: str = "automatic") -> Assembly:
    path = folder / "spec.yaml"
    text = SPEC.replace("CONTACT", contact).replace("TERRAIN", terrain).replace("SCHEME", scheme)
    path.write_text(text, encoding="utf-8")
    model = resolve(read_spec(path), Library(library_folders(path)), "spec")
    return assemble(model, model.values())


@pytest.mark.parametrize(
    ("contact", "scheme", "integrator"),
    [
        ("mujoco", "automatic", EULER),
        ("geyer2010", "automatic", IMPLICIT),
        ("geyer2010", "euler", EULER),
        ("mujoco", "implicitfast", FAST),
    ],
)
def test_the_integrator_follows_the_parts_unless_it_is_said(
    tmp_path: Path, contact: str, scheme: str, integrator: int
) -> None:
    assert assembled(tmp_path, contact, scheme=scheme).model.opt.integrator == integrator


def test_bodies_in_a_chain_take_the_fast_integrator(tmp_path: Path) -> None:
    second = "arm: {use: segment/rod, mass: 1 kg, length: 1 m}"
    hinge = "hinge: {use: joint/geyer2010, parent: block.center, child: arm.proximal, grows: forwards}"
    made = assembled(tmp_path, "geyer2010", f"{{use: terrain/flat}}}}\n  {second}\n  {hinge[:-1]}")
    assert made.model.opt.integrator == FAST
    assert not made.model.body_simple[1:].any()


def test_the_force_is_the_control_times_a_line_in_the_velocity(tmp_path: Path) -> None:
    model = assembled(tmp_path, "geyer2010").model
    data = mujoco.MjData(model)
    normal, brake = (model.actuator(f"ground.{name}").id for name in ("normal", "brake"))
    for upward, force in {0.0: 100.0, -0.03: 200.0, 0.015: 50.0, 0.03: 0.0, 1.0: 0.0}.items():
        data.qvel[:] = [0.5, upward, 0]
        data.ctrl[[normal, brake]] = [100, 40]
        mujoco.mj_forward(model, data)
        assert data.actuator_force[normal] == pytest.approx(force, abs=1e-9)
        assert data.actuator_force[brake] == pytest.approx(-20)


def test_reach_moves_where_a_force_acts(tmp_path: Path) -> None:
    model = assembled(tmp_path, "hunt_crossley, radius: 0.2 m").model
    data = mujoco.MjData(model)
    data.qvel[:] = [1, 0, 3]  # rolling forwards: the lowest point slips by v - omega r
    mujoco.mj_forward(model, data)
    brake = model.actuator("ground.brake").id
    assert data.actuator_velocity[brake] == pytest.approx(1 - 3 * 0.2)
    data.ctrl[brake] = 10
    mujoco.mj_forward(model, data)
    force = -10 * 0.4
    assert data.qfrc_actuator == pytest.approx([force, 0, -0.2 * force])


def test_the_ground_is_a_plane_or_treads(tmp_path: Path) -> None:
    def ground(terrain: str) -> list[mujoco.MjsGeom]:
        geoms = assembled(tmp_path, "mujoco", terrain).spec.geoms
        return [geom for geom in geoms if geom.name.startswith("world.ground")]

    (flat,) = ground("{use: terrain/flat}")
    assert flat.type == mujoco.mjtGeom.mjGEOM_PLANE and list(flat.quat) == [1, 0, 0, 0]
    (slope,) = ground("{use: terrain/slope, angle: 10 deg}")
    normal = np.zeros(3)
    mujoco.mju_rotVecQuat(normal, np.array([0, 0, 1.0]), np.array(slope.quat))
    assert normal == pytest.approx([-np.sin(np.radians(10)), 0, np.cos(np.radians(10))])
    treads = ground("{use: terrain/steps, first: 1 m, rise: 5 cm, run: 0.4 m, count: 2}")
    tops = [(geom.pos[0] - geom.size[0], geom.pos[2] + geom.size[2]) for geom in treads]
    assert tops == [(-1000, 0), (pytest.approx(1), pytest.approx(0.05)), (pytest.approx(1.4), pytest.approx(0.1))]
    ends = [geom.pos[0] + geom.size[0] for geom in treads]
    assert ends == [pytest.approx(1), pytest.approx(1.4), 1000]
