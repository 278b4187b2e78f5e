"""The mechanics in MuJoCo, and as the file that stock MuJoCo loads."""

from __future__ import annotations

import ctypes
import inspect
from pathlib import Path

import mujoco
import numpy as np
import pytest
from simulation.models import HOPPER, OWN, SPECS, model, written

from gaitsim.compiler.mechanics.verbs import Mechanics
from gaitsim.compiler.mjcf import assemble
from gaitsim.components.checks.build import VERBS
from gaitsim.errors import InvalidSpec
from gaitsim.simulation.run import Simulator

FILES = [*SPECS, *sorted(OWN.glob("*.yaml"))]
BODIES = """\
gaitsim: 1
parts:
  upper: {use: segment/rod, mass: 2 kg, length: 1 m}
  lower: {use: segment/rod, mass: 1 kg, length: 0.5 m}
  top: {use: joint/hinge, parent: world, child: upper.proximal}
  bottom: {use: joint/hinge, parent: upper.distal, child: lower.proximal}
simulate: {duration: 10 ms, step: 1 ms}
"""


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_exported_file_is_the_same_mechanics(path) -> None:
    simulator = Simulator(model(path), "normal")  # both modes have the same mechanics; this one compiles nothing
    ours = simulator._loop.physics.model
    stock = mujoco.MjModel.from_xml_string(simulator.xml)
    for name in ("nq", "nv", "nu", "nbody", "ntendon"):
        assert getattr(stock, name) == getattr(ours, name), name
    # The file keeps six digits.
    for name in ("body_mass", "body_inertia", "body_ipos", "body_pos", "dof_damping", "site_pos"):
        np.testing.assert_allclose(getattr(stock, name), getattr(ours, name), rtol=1e-5, atol=1e-9, err_msg=name)
    assert stock.opt.timestep == pytest.approx(ours.opt.timestep)
    assert stock.opt.integrator == ours.opt.integrator
    np.testing.assert_array_equal(stock.opt.gravity, [0, 0, -simulator.model.simulate.gravity])
    chance = np.random.default_rng(1)
    for _ in range(5):
        pose = chance.uniform(-0.5, 0.5, ours.nq)
        lengths = []
        for each in (stock, ours):
            data = mujoco.MjData(each)
            data.qpos[:] = pose
            mujoco.mj_forward(each, data)
            lengths.append(data.ten_length.copy())
        np.testing.assert_allclose(*lengths, rtol=1e-5)


def test_bodies_by_hand() -> None:
    made = Simulator(written(BODIES))._loop.physics.model
    assert list(made.body_mass) == [0, 2, 1]
    upper = made.body("upper")
    transverse, along = 2 * 1 / 12, 0.5 * 2 * 0.04**2
    np.testing.assert_allclose(upper.inertia, [transverse, transverse, along], rtol=1e-12)
    np.testing.assert_allclose(upper.ipos, [0, 0, -0.5])
    np.testing.assert_allclose(made.body("lower").pos, [0, 0, -1])
    data = mujoco.MjData(made)
    data.qpos[:] = [np.pi / 2, 0]  # a positive angle turns a hanging child backwards
    mujoco.mj_forward(made, data)
    np.testing.assert_allclose(data.body("lower").xpos, [-1, 0, 0], atol=1e-12)


def test_the_hopper_s_leg_spans_from_the_ground_to_the_hip() -> None:
    body = Simulator(model(HOPPER))._loop.physics
    assert list(body.model.body_mass) == [0, 80]
    assert body.data.ten_length[0] == pytest.approx(1.04)
    assert body.model.ntendon == 1


def test_a_candidate_s_numbers_reach_the_mechanics() -> None:
    made = model(OWN / "tuned_rod.yaml")
    ours = assemble(made, made.values([3.0, 0.8, 0.25, 10.0])).model
    rod = ours.body("rod")
    assert rod.mass[0] == 3
    np.testing.assert_allclose(rod.inertia[:2], 3 * (0.25 * 0.8) ** 2, rtol=1e-12)
    np.testing.assert_allclose(rod.ipos, [0, 0, -0.4])


def test_what_mujoco_refuses_is_named_by_its_line_in_the_spec() -> None:
    # An axis that is longer than zero, but too short for MuJoCo.
    tiny = "{use: joint/spatial_hinge, parent: world, child: upper.proximal, axis_left: 1e-20}"
    text = f"gaitsim: 1\nparts:\n  upper: {{use: segment/rod, mass: 2 kg, length: 1 m}}\n  pivot: {tiny}\n"
    with pytest.raises(InvalidSpec) as caught:
        Simulator(written(f"{text}simulate: {{duration: 0.1 s, step: 1 ms}}\n"))
    assert str(caught.value).startswith("spec.yaml:4:3: pivot: MuJoCo refuses this: axis too small in joint")


def test_inertias_that_no_body_has_are_refused() -> None:
    # Thicker than long.
    with pytest.raises(InvalidSpec) as caught:
        Simulator(written(BODIES, [("upper.thickness", "0.9 m")]))
    assert str(caught.value).startswith(
        "spec.yaml:3:3: upper: a moment of inertia is at most the sum of the two others, and 0.81 kg m^2 is above"
    )


@pytest.mark.parametrize(
    ("old", "new", "place", "message"),
    [
        (
            "  bottom: {use: joint/hinge, parent: upper.distal, child: lower.proximal}\n",
            "",
            "spec.yaml:4:3: lower",
            "no joint has this segment as its child; add one with child: lower.proximal.",
        ),
        (
            "parent: upper.distal, child: lower.proximal",
            "parent: lower.distal, child: upper.distal",
            "spec.yaml:6:3: bottom",
            "upper is the child of top and, at another place, of bottom; "
            "a segment is the child of one joint, or of several with the same parent and child.",
        ),
        (
            "parent: world",
            "parent: lower.distal",
            "spec.yaml:5:3: top",
            "joints connect these segments in a loop: upper, lower; connect one of them to world.",
        ),
    ],
    ids=["none", "two", "ring"],
)
def test_bodies_form_a_tree(old: str, new: str, place: str, message: str) -> None:
    assert old in BODIES
    with pytest.raises(InvalidSpec) as caught:
        Simulator(written(BODIES.replace(old, new)))
    assert f"{place}: {message}" in str(caught.value)


def test_what_is_only_to_be_looked_at_is_exported_and_not_simulated() -> None:
    simulator = Simulator(written(BODIES))
    assert simulator._loop.physics.model.ngeom == 0
    assert mujoco.MjModel.from_xml_string(simulator.xml).ngeom == 2


OTHER = """\
  other: {use: segment/rod, mass: 1 kg, length: 0.5 m}
  side: {use: joint/hinge, parent: world, child: other.proximal}
"""


@pytest.mark.parametrize(
    ("more", "used"),
    [
        ("", set()),
        ("  tip: {use: contact/mujoco, frame: lower.distal}\n", {"CONSTRAINT", "CONTACT"}),
        ("  line: {use: constraint/vertical, line: world, point: lower.distal, moved_mass: 1 kg}\n", {"CONSTRAINT"}),
        ("  tip: {use: contact/geyer2010, frame: lower.distal}\n", set()),
        (OTHER, {"ISLAND"}),
        (OTHER.replace("world,", "world, damping: 1 N m s/rad,"), {"ISLAND", "SPRING", "DAMPER"}),
    ],
    ids=["bodies", "contact", "equality", "explicit contact", "two trees", "damper"],
)
def test_a_stage_is_passed_over_only_where_it_computes_nothing(more: str, used: set[str]) -> None:
    spec = written(BODIES.replace("simulate:", f"{more}simulate:"))
    made = assemble(spec, spec.values(), dressed=False).model
    stages = {"CONSTRAINT", "CONTACT", "ISLAND", "SPRING", "DAMPER"}
    off = {name for name in stages if made.opt.disableflags & mujoco.mjtDisableBit.__members__[f"mjDSBL_{name}"]}
    assert stages - off == used


@pytest.mark.parametrize(
    "name",
    [
        *("hopping_geyer2003", "hopping_leg_mass", "hopping_raibert", "pendulum_pid"),
        *("walking_geyer2010", "walking_geyer2010_mujoco_contact", "walking_song2015"),
    ],
)
def test_what_is_passed_over_changes_no_bit(name: str) -> None:
    ended = []
    chosen = model(HOPPER.parent / f"{name}.yaml")
    for flags in (None, int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)):
        made = assemble(chosen, chosen.values(), dressed=False).model
        made.opt.disableflags = made.opt.disableflags if flags is None else flags
        data = mujoco.MjData(made)
        data.warning.number[:] = 1  # or the first warning of a model that falls is written to a file
        data.qpos[:] += np.linspace(0.1, 0.3, made.nq)
        data.qvel[:] = np.linspace(-1, 1, made.nv)
        data.ctrl[:] = 0.01
        mujoco.mj_step(made, data, 100)
        ended.append([data.qpos.tobytes(), data.qvel.tobytes(), data.qacc.tobytes()])
        assert np.isfinite(data.qacc).all()
    assert ended[0] == ended[1]


def test_nothing_reads_the_clock_in_a_step() -> None:
    Simulator(written(BODIES))
    library = ctypes.CDLL(str(next(Path(mujoco.__file__).parent.glob("libmujoco.*"))))
    assert ctypes.c_void_p.in_dll(library, "mjcb_time").value is None


@pytest.mark.parametrize("verb", sorted(VERBS))
def test_names_that_a_verb_takes_are_checked_before_it_runs(verb: str) -> None:
    """The table of the checks counts as many leading names as the verb has; annotations are texts there."""
    count, _, _ = VERBS[verb]
    _, *arguments = inspect.signature(getattr(Mechanics, verb)).parameters.values()
    assert [argument.annotation for argument in arguments[:count]] == ["str"] * count


@pytest.mark.parametrize(
    ("name", "integrate"),
    [
        ("hopping_geyer2003", "mj_Euler"),
        ("hopping_leg_mass", ""),  # has an equality
        ("walking_geyer2010", ""),  # has sensors
        ("running_slip", "mj_Euler"),
    ],
)
def test_stages_are_called_one_by_one_where_few_are_needed(name: str, integrate: str) -> None:
    chosen = model(HOPPER.parent / f"{name}.yaml")
    assert assemble(chosen, chosen.values(), dressed=False).integrate == integrate
