"""Muscles whose paths are moment arms are drawn, on the side of each joint from which they turn it."""

from __future__ import annotations

from itertools import pairwise

import mujoco
import numpy as np
import pytest

from gaitsim.animation import colours, overlay
from gaitsim.animation.arms import arm_paths
from gaitsim.animation.posture import Posture
from gaitsim.animation.stage import Stage, stage_of
from gaitsim.compiler.mjcf import assemble
from gaitsim.model import Model
from tests.animation.runs import run_of
from tests.simulation.models import ROOT, model, written

WALKER = ROOT / "specs" / "walking_geyer2010.yaml"
# Where people have them: -1 is behind the joint, 1 in front; and the largest arm of Geyer & Herr (2010) in m.
SIDES = {
    ("soleus", "ankle"): (-1, 0.05),
    ("tibialis_anterior", "ankle"): (1, 0.04),
    ("gastrocnemius", "ankle"): (-1, 0.05),
    ("gastrocnemius", "knee"): (-1, 0.05),
    ("vastus", "knee"): (1, 0.06),
    ("hamstrings", "knee"): (-1, 0.05),
    ("hamstrings", "hip"): (-1, 0.08),
    ("gluteus", "hip"): (-1, 0.10),
    ("hip_flexor", "hip"): (1, 0.10),
}
MUSCLES = list(dict.fromkeys(muscle for muscle, _ in SIDES))

LEG = """
gaitsim: 1
parts:
  trunk: {{use: segment/hat_geyer2010}}
  root: {{use: joint/planar, parent: world, child: trunk.hip}}
  thigh: {{use: segment/thigh_geyer2010}}
  hip: {{parent: {parent}, child: thigh.proximal, {hip}}}
  shank: {{use: segment/shank_geyer2010}}
  knee: {{use: joint/hinge, parent: thigh.distal, child: shank.proximal}}
  foot: {{use: segment/foot_geyer2010}}
  ankle: {{use: joint/hinge, parent: shank.distal, child: foot.ankle}}
  muscle:
    use: muscle/geyer2010
    max_isometric_force: 1500 N
    optimal_fiber_length: 11 cm
    tendon_slack_length: 13 cm
    excitation: 0.3
    path: {path}
simulate: {{duration: 0.1 s, step: 0.1 ms}}
"""
ARM = "{{use: path/constant_arm, {joint}, moment_arm: {arm} cm, reference_angle: 0 deg}}"
LIMITED = "use: joint/limited_hinge, lower: -1 rad, upper: 1 rad, stiffness: 9 N m/rad, stop_damping: 1 N m s/rad"
AT_TORQUE = "angle: {from: hip.angle}, angular_velocity: {from: hip.velocity}, to: {moment: hip.torque}"
AT_HINGE = "angle: {{from: {0}.angle}}, angular_velocity: {{from: {0}.velocity}}, to: {{moment: {0}.torque}}"


def leg(hip: str, path: str, parent: str = "trunk.hip") -> Stage:
    return stage_of(written(LEG.format(hip=hip, path=path, parent=parent)))


@pytest.fixture(scope="module")
def walker() -> Model:
    return model(WALKER)


def drawn_arm(stage: Stage, data: mujoco.MjData, path: str, joint: str) -> float:
    """How much a drawn path shortens as a joint's coordinate grows, in m/rad."""
    place, tendon = stage.mechanics.joint(joint).qposadr[0], stage.mechanics.tendon(path).id
    lengths, before = [], float(data.qpos[place])
    for turn in (-1e-5, 1e-5):
        data.qpos[place] = before + turn
        mujoco.mj_fwdPosition(stage.mechanics, data)
        lengths.append(float(data.ten_length[tendon]))
    data.qpos[place] = before
    return (lengths[0] - lengths[1]) / 2e-5


def passed(stage: Stage, path: str, joint: str) -> float:
    """How far forwards of a joint a drawn path passes it, level with it in the neutral posture; in m."""
    data = mujoco.MjData(stage.mechanics)
    mujoco.mj_fwdPosition(stage.mechanics, data)
    tendon = stage.mechanics.tendon(path).id
    first, count = data.ten_wrapadr[tendon], data.ten_wrapnum[tendon]
    away = data.wrap_xpos.reshape(-1, 3)[first : first + count] - data.xanchor[stage.mechanics.joint(joint).id]
    forwards = [np.interp(0, [a[2], b[2]], [a[0], b[0]]) for a, b in pairwise(away[::-1]) if a[2] <= 0 <= b[2]]
    assert len(forwards) == 1
    return float(forwards[0])


@pytest.mark.parametrize("side", ["l", "r"])
@pytest.mark.parametrize(("muscle", "joint"), SIDES)
def test_the_walkers_muscles_are_where_people_have_them(walker: Model, side: str, muscle: str, joint: str) -> None:
    forwards, arm = SIDES[muscle, joint]
    stage = stage_of(walker)
    path, hinge = f"leg_{side}.{muscle}.path", f"leg_{side}.{joint}"
    assert np.sign(passed(stage, path, hinge)) == forwards
    assert abs(drawn_arm(stage, mujoco.MjData(stage.mechanics), path, hinge)) == pytest.approx(arm, rel=0.06)


def test_drawn_paths_turn_joints_as_the_model_does_in_every_posture() -> None:
    """Over a second of walking; they are never nearer to a joint, nor far beyond the largest arm."""
    replay = run_of("walking_geyer2010")
    posture = Posture(stage_of(replay.model), replay.trajectory)
    inner = {("gastrocnemius", "knee"): ".second", ("gastrocnemius", "ankle"): ".first"}
    inner |= {("hamstrings", "knee"): ".second", ("hamstrings", "hip"): ".first"}
    compared = 0
    for row in range(0, len(replay.trajectory.times), 12):
        posture.take(row)
        for (muscle, joint), (_, largest) in SIDES.items():
            for leg in ("leg_l", "leg_r"):
                path = f"{leg}.{muscle}.path"
                force = replay.trajectory[f"{leg}.{muscle}.force"][row]
                if force > 1:
                    arm = replay.trajectory[f"{path}{inner.get((muscle, joint), '')}.moment"][row] / force
                    drawn = drawn_arm(posture.stage, posture.data, path, f"{leg}.{joint}")
                    assert drawn / arm > 0.94, (path, joint, row)
                    assert abs(drawn) < 1.5 * largest, (path, joint, row)
                    compared += 1
    assert compared > 500


def test_the_model_that_is_simulated_stays_as_it_is(walker: Model) -> None:
    before = assemble(walker, walker.values())
    stage = stage_of(walker)
    assert assemble(walker, walker.values()).xml == before.xml
    assert before.model.ntendon == 0
    for field in ("body_mass", "body_inertia", "body_ipos", "body_pos", "jnt_axis", "jnt_pos", "qpos0", "dof_damping"):
        assert np.array_equal(getattr(stage.mechanics, field), getattr(before.model, field)), field


def test_each_muscle_has_a_tendon_with_the_colour_of_its_activation() -> None:
    replay = run_of("walking_geyer2010")
    posture = Posture(stage_of(replay.model), replay.trajectory)
    mechanics = posture.stage.mechanics
    named = [mechanics.tendon(tendon).name for tendon, _ in posture.stage.muscles]
    assert named == [f"leg_{side}.{muscle}.path" for side in "lr" for muscle in MUSCLES]
    assert np.all(mechanics.tendon_rgba[:, 3] == 1)
    row = int(np.argmax(replay.trajectory["leg_l.soleus.activation"]))
    assert replay.trajectory["leg_l.soleus.activation"][row] > 0.3
    posture.take(row)
    overlay.paint_muscles(posture)
    for name in named:
        level = replay.trajectory[f"{name.removesuffix('.path')}.activation"][row]
        shown = mechanics.tendon_rgba[mechanics.tendon(name).id]
        assert shown == pytest.approx([*colours.of_activation(level), 1], abs=1e-6)


def test_muscles_are_outside_of_their_own_leg(walker: Model) -> None:
    stage = stage_of(walker)
    data = mujoco.MjData(stage.mechanics)
    mujoco.mj_fwdPosition(stage.mechanics, data)
    for side, way in (("l", 1), ("r", -1)):
        for place in ("origin", "insertion"):
            assert data.site(f"leg_{side}.vastus.path.{place}").xpos[1] * way == pytest.approx(0.8 * 0.06, rel=1e-3)


@pytest.mark.parametrize(
    ("hip", "reaches", "arm", "forwards"),
    [
        ("use: joint/geyer2010, grows: backwards", "joint: hip", 10, -1),
        ("use: joint/geyer2010, grows: backwards", "joint: hip", -10, 1),
        ("use: joint/geyer2010, grows: forwards", "joint: hip", 10, 1),
        ("use: joint/geyer2010, grows: forwards", "joint: hip", -10, -1),
        ("use: joint/hinge", AT_TORQUE, 10, -1),
        # Its torque reaches the hinge as a part of another output.
        (LIMITED, AT_TORQUE, 10, -1),
    ],
    ids=["extends", "flexes", "extends forwards", "flexes forwards", "hinge", "within limits"],
)
def test_the_side_follows_from_the_moment(hip: str, reaches: str, arm: int, forwards: int) -> None:
    stage = leg(hip, ARM.format(joint=reaches, arm=arm))
    assert stage.muscles == ((0, "muscle.activation"),)
    assert np.sign(passed(stage, "muscle.path", "hip")) == forwards


def test_a_path_over_joints_that_are_not_neighbours_is_not_drawn() -> None:
    inner = [ARM.format(joint=AT_HINGE.format(joint), arm=5) for joint in ("hip", "ankle")]
    path = f"{{use: path/two_joints, first: {inner[0]}, second: {inner[1]}}}"
    assert leg("use: joint/hinge", path).muscles == ()
    neighbours = path.replace("ankle.", "knee.")
    assert leg("use: joint/hinge", neighbours).muscles == ((0, "muscle.activation"),)


def test_a_hinge_on_the_ground_has_no_body_to_run_along() -> None:
    text = LEG.format(hip="use: joint/hinge", path=ARM.format(joint=AT_TORQUE, arm=5), parent="world")
    assert stage_of(written(text)).muscles == ()


def test_a_massless_leg_has_no_hinge() -> None:
    hopper = model(ROOT / "specs" / "hopping_geyer2003.yaml")
    assert arm_paths(hopper, assemble(hopper, hopper.values())) == []
    assert stage_of(hopper).muscles == ()
