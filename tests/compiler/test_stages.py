"""The stages of MuJoCo's step that gaitsim makes itself agree with MuJoCo's own, and are left out where they cannot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from gaitsim.compiler.chains import own_stages
from gaitsim.simulation.physics import Physics
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

SPECS = Path(__file__).parents[2] / "specs"
SEEN = ("ten_length", "ten_velocity", "actuator_velocity", "sensordata", "qfrc_bias")
CHAIN = """
<mujoco>
  <option integrator="implicitfast"><flag constraint="disable"/></option>
  <worldbody>
    <site name="origin"/>
    <body>{bodies}</body>
  </worldbody>
  <tendon><spatial name="path"><site site="low"/><site site="high"/></spatial></tendon>
  <actuator>
    <motor name="pull" tendon="path"/>
    <general name="brake" joint="j3" gaintype="affine" gainprm="0 0 -1"/>
    <general name="push" site="high" refsite="origin" gear="0 0 1 0.1 0 0"/>
  </actuator>
</mujoco>
"""


def in_stance(name: str) -> Physics:
    """The mechanics of a walker after some steps, with a foot on the ground and forces in its muscles."""
    simulator = Simulator(Opening(SPECS / f"{name}.yaml", ("simulate.duration=0.3 s",)).open().model())
    simulator.run()
    return simulator._loop.physics  # type: ignore[no-any-return]


@pytest.mark.parametrize("name", ["walking_scone_h1922", "walking_song2015"])
def test_a_step_is_that_of_mujoco(name: str) -> None:
    physics = in_stance(name)
    m, d = physics.model, physics.data
    other = mujoco.MjData(m)
    for field in ("qpos", "qvel", "ctrl", "qfrc_applied"):
        getattr(other, field)[:] = getattr(d, field)
    assert physics.stages is not None
    assert np.count_nonzero(d.ctrl[m.actuator_trntype == mujoco.mjtTrn.mjTRN_SITE]) >= 3
    for _ in range(5):
        physics.look()
        mujoco.mj_step1(m, other)
        for field in SEEN:
            mine, theirs = np.ravel(getattr(d, field)), np.ravel(getattr(other, field))
            np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-12 * max(1.0, np.abs(theirs).max(initial=0)))
        physics.advance()
        mujoco.mj_step2(m, other)
        np.testing.assert_allclose(d.qvel, other.qvel, rtol=0, atol=1e-11)
        np.testing.assert_allclose(d.actuator_force, other.actuator_force, rtol=0, atol=1e-9)


def test_a_force_at_its_limit_is_not_damped() -> None:
    physics = in_stance("walking_song2015")
    m, d = physics.model, physics.data
    other = mujoco.MjData(m)
    m.actuator_forcelimited[:], m.actuator_forcerange[:] = True, (-20, 20)
    physics = replace(physics, stages=type(physics.stages).of(m, d))
    for field in ("qpos", "qvel", "ctrl", "qfrc_applied"):
        getattr(other, field)[:] = getattr(d, field)
    physics.look()
    physics.advance()
    mujoco.mj_step(m, other)
    assert np.count_nonzero(np.abs(d.actuator_force) == 20) >= 3
    np.testing.assert_allclose(d.qvel, other.qvel, rtol=0, atol=1e-11)


def chain(edit: Callable[[Any], object] = lambda spec: None, joints: int = 13) -> Any:
    """A chain of hinges with a path, a brake and a push, edited."""
    bodies = ""
    for i in range(joints):
        site = {0: '<site name="low" pos="0 0.1 0"/>', joints - 1: '<site name="high" pos="0.1 0 0"/>'}.get(i, "")
        axis = " ".join(str(int(i % 3 == k)) for k in range(3))
        bodies += f'<body><joint name="j{i}" axis="{axis}"/><geom size="0.1"/>{site}'
    spec = mujoco.MjSpec.from_string(CHAIN.format(bodies=bodies + "</body>" * joints))
    edit(spec)
    return spec.compile()


def test_larger_trees_have_stages_of_their_own() -> None:
    assert own_stages(chain())
    assert not own_stages(chain(joints=12))


EDITS: dict[str, Callable[[Any], object]] = {
    "another integrator": lambda spec: setattr(spec.option, "integrator", mujoco.mjtIntegrator.mjINT_EULER),
    "constraints": lambda spec: setattr(spec.option, "disableflags", 0),
    "a ball": lambda spec: setattr(spec.joint("j4"), "type", mujoco.mjtJoint.mjJNT_BALL),
    "a spring at a joint": lambda spec: setattr(spec.joint("j4"), "stiffness", [1, 0, 0]),
    "an elastic path": lambda spec: setattr(spec.tendon("path"), "stiffness", [1, 0, 0]),
    "a damped path": lambda spec: setattr(spec.actuator("pull"), "gaintype", mujoco.mjtGain.mjGAIN_AFFINE),
    "a geared motor": lambda spec: setattr(spec.actuator("brake"), "gear", [2, 0, 0, 0, 0, 0]),
    "a push against a segment": lambda spec: setattr(spec.actuator("push"), "refsite", "low"),
    "air": lambda spec: setattr(spec.option, "density", 1.2),
    "a sensor of accelerations": lambda spec: spec.add_sensor(
        name="felt", type=mujoco.mjtSensor.mjSENS_ACCELEROMETER, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="high"
    ),
}


@pytest.mark.parametrize("edit", EDITS.values(), ids=EDITS)
def test_what_they_do_not_know_is_left_to_mujoco(edit: Callable[[Any], object]) -> None:
    assert not own_stages(chain(edit))
