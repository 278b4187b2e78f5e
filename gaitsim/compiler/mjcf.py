"""From a model to MuJoCo: parts in the order of the tree of bodies, elements with their place in the spec."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mujoco

from gaitsim.compiler.chains import own_stages
from gaitsim.compiler.mechanics.making import Made
from gaitsim.compiler.mechanics.places import DrawnForce, DrawnLine, Frames, Lift, Point, Relief, Touching, world_frames
from gaitsim.compiler.mechanics.space import check_friction, check_grounds, check_inertias, check_sides
from gaitsim.compiler.mechanics.standing import check_loads
from gaitsim.compiler.mechanics.ties import Tie
from gaitsim.compiler.mechanics.tree import Branch, branches, check_axes
from gaitsim.compiler.mechanics.verbs import Mechanics, beside_frames, numbers_of
from gaitsim.component import Refused
from gaitsim.components.load import function_of, raised
from gaitsim.errors import Fault, InvalidComponent, InvalidSpec
from gaitsim.model import Model, Part

_INTEGRATORS = {
    "euler": mujoco.mjtIntegrator.mjINT_EULER,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "rk4": mujoco.mjtIntegrator.mjINT_RK4,
}

_FUNCTIONS = {
    int(mujoco.mjtIntegrator.mjINT_EULER): "mj_Euler",
    int(mujoco.mjtIntegrator.mjINT_IMPLICIT): "mj_implicit",
    int(mujoco.mjtIntegrator.mjINT_IMPLICITFAST): "mj_implicit",
}
# MuJoCo's arrays of passive forces: springs, dampers, and what carries a body's weight.
_PASSIVE = (
    *("jnt_stiffness", "jnt_stiffnesspoly", "dof_damping", "dof_dampingpoly", "body_gravcomp"),
    *("tendon_stiffness", "tendon_stiffnesspoly", "tendon_damping", "tendon_dampingpoly"),
)

AFTER_VELOCITIES = int(
    mujoco.mjtStage.mjSTAGE_VEL
)  # the stage that mj_step1 has completed when mj_forwardSkip continues


@dataclass(frozen=True)
class Assembly:
    """A MuJoCo model, and the ties between it and the ports of parts as pairs (index of the part, tie).

    Resets are numbers that events set. Constants are numbers that parts read from the compiled model; they are kept in
    MuJoCo's userdata. Drawings are shown beside the bodies in films. Carried are the parts that touch the ground. A
    relief is the height of uneven ground.
    """

    spec: Any
    model: Any
    reads: tuple[tuple[int, Tie], ...]
    applies: tuple[tuple[int, Tie], ...]
    resets: tuple[tuple[int, Tie], ...]
    constants: tuple[float, ...]
    drawings: tuple[tuple[int, DrawnLine | DrawnForce], ...]
    touching: tuple[Touching, ...]
    carried: tuple[int, ...]
    relief: Relief | None
    lifts: tuple[Lift, ...]
    begins: tuple[tuple[str, float, float], ...]

    @property
    def runge_kutta(self) -> bool:
        """Whether MuJoCo uses the integrator rk4."""
        return bool(self.model.opt.integrator == _INTEGRATORS["rk4"])

    @property
    def energy(self) -> bool:
        """Whether MuJoCo computes energies."""
        return bool(self.model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_ENERGY)

    @property
    def integrate(self) -> str:
        """MuJoCo's function that integrates, of models without constraints and sensors; empty for others.

        Such a model needs so few stages of MuJoCo's step that to look for all the others costs a quarter of it.
        """
        m = self.model
        if not m.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONSTRAINT or m.nsensor or self.own_stages:
            return ""
        return _FUNCTIONS.get(int(m.opt.integrator), "")

    @cached_property
    def own_stages(self) -> bool:
        """Whether gaitsim makes stages of MuJoCo's step itself."""
        return own_stages(self.model)

    @property
    def xml(self) -> str:
        """The model as MJCF, which stock MuJoCo loads."""
        return str(self.spec.to_xml())


def assemble(model: Model, values: Sequence[float], dressed: bool = True) -> Assembly:
    """Build and compile the mechanics.

    Args:
        model: The model.
        values: All numbers of the model, in SI.
        dressed: Whether to add what only films show.

    Raises:
        InvalidSpec: The bodies form no tree or MuJoCo refuses an element.
        InvalidComponent: A component's build raises.
    """
    spec = mujoco.MjSpec()
    spec.modelname = model.name
    spec.compiler.degree = False
    spec.option.timestep = model.simulate.step
    spec.option.gravity = [0, 0, -model.simulate.gravity]
    # A state that is not finite is a failed candidate, never a silent reset.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    index = {part.address: i for i, part in enumerate(model.parts)}
    frames = world_frames(spec)
    made = Made()
    check_sides(model, values)

    def build(part: Part, body: Any = None) -> None:
        beside = beside_frames(part, values)
        mechanics = Mechanics(spec, part, frames, made, index[part.address], dressed, body, beside)
        p = numbers_of(part, values, frames)
        try:
            function_of(part.type.cls, "build")(p, mechanics)
        except Refused as error:
            raise InvalidSpec(model.fault(part, f"{error}.")) from error
        except Exception as error:
            raise InvalidComponent(raised(part.type, "build", part.address, error)) from error

    order = branches(model, values)
    for branch in order:
        parent = _end(branch, "parent", values, frames)
        body = parent.body.add_body(name=branch.segment.address, info=str(branch.segment.mark))
        frames.places[branch.segment.address] = Point(body, (0.0, 0.0, 0.0))
        build(branch.segment, body)
        child = _end(branch, "child", values, frames)
        body.pos = [a - b for a, b in zip(parent.position, child.position, strict=True)]
        for joint in branch.joints:
            build(joint)
        check_axes(model, branch, body)
    done = {part.address for branch in order for part in (branch.segment, *branch.joints)}
    for part in model.parts:
        if "build" in part.type.functions and part.address not in done:
            build(part)
    for make in made.later:
        make()
    check_inertias(model, spec, made)
    check_friction(model, spec, made)
    check_grounds(model, made)
    check_loads(model, values, made)
    compiled = _compiled(spec, model)
    spec.option.integrator = compiled.opt.integrator = _integrator(model, compiled)
    compiled.opt.disableflags |= _unused_stages(compiled)
    return Assembly(
        spec,
        compiled,
        tuple(made.reads),
        tuple(made.applies),
        tuple(made.resets),
        tuple(of(compiled) for of in made.constants),
        tuple(made.drawings),
        tuple(made.touching),
        tuple(made.carried),
        next(iter(made.reliefs.values()), None),
        tuple(made.lifts),
        tuple(made.begins),
    )


def _integrator(model: Model, compiled: Any) -> Any:
    """The integrator that the spec chooses; with `automatic`, Euler unless the force of an actuator depends on
    velocity.

    Raises:
        InvalidSpec: It is rk4, and the force of an actuator depends on velocity.
    """
    chosen = model.simulate.integrator
    damped = compiled.actuator_gainprm[:, 2].nonzero()[0]
    guarded = next((part for part in model.parts if part.guarded), None)
    if guarded and chosen not in ("automatic", "rk4"):
        rule = f"its events are located by Runge-Kutta steps, not by integrator: {chosen}; choose automatic"
        raise InvalidSpec(Fault(f"{rule}.", model.place(guarded), guarded.address))
    if (chosen == "rk4" or guarded) and damped.size:
        address = compiled.actuator(int(damped[0])).name.rpartition(".")[0]
        mark = next(model.place(part) for part in model.parts if part.address == address)
        rule = "its velocity terms need an implicit scheme, and integrator: rk4 is explicit; choose automatic."
        if guarded:
            rule = f"its velocity terms need an implicit scheme, and the events of {guarded.address} explicit steps"
            rule += "; use another part for one of them."
        raise InvalidSpec(Fault(rule, mark, address))
    if guarded:  # `events` makes its own steps
        return _INTEGRATORS["euler"]
    if chosen != "automatic":
        return _INTEGRATORS[chosen]
    if not damped.size:
        return _INTEGRATORS["euler"]
    # For a single body MuJoCo keeps a diagonal mass matrix; implicitfast then drops the coupling by damping.
    alone = compiled.body_simple[1:].any()
    return mujoco.mjtIntegrator.mjINT_IMPLICIT if alone else _INTEGRATORS["implicitfast"]


def _unused_stages(compiled: Any) -> int:
    """The stages of a step that would compute nothing: contacts, limits and other constraints, their division among
    bodies that do not touch, and springs and dampers.
    """
    rubs = compiled.dof_frictionloss.any() or compiled.tendon_frictionloss.any()
    stops = compiled.jnt_limited.any() or compiled.tendon_limited.any()
    touches = (compiled.geom_contype[:, None] & compiled.geom_conaffinity).any() or compiled.npair
    used = compiled.neq or rubs or stops or touches
    flags = 0 if used else int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    if not touches:
        flags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    if compiled.ntree <= 1:
        flags |= int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
    if not any(getattr(compiled, name).any() for name in _PASSIVE):
        flags |= int(mujoco.mjtDisableBit.mjDSBL_SPRING) | int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
    return flags


def _end(branch: Branch, name: str, values: Sequence[float], frames: Frames) -> Point:
    """The place of the parent or the child of a branch's joints."""
    joint = branch.joints[0]
    return frames.point(joint.attachments[name], beside_frames(joint, values).get(name, (0, 0, 0)))


_KINDS = {
    "joint": mujoco.mjtObj.mjOBJ_JOINT,
    "tendon": mujoco.mjtObj.mjOBJ_TENDON,
    "actuator": mujoco.mjtObj.mjOBJ_ACTUATOR,
    "sensor": mujoco.mjtObj.mjOBJ_SENSOR,
    "mocap": mujoco.mjtObj.mjOBJ_BODY,
}
# The array of MuJoCo's model with the index of an element's first number; elsewhere it is the element's own.
_FIRST = {
    "qpos": "jnt_qposadr",
    "qvel": "jnt_dofadr",
    "qacc": "jnt_dofadr",
    "qfrc_applied": "jnt_dofadr",
    "sensordata": "sensor_adr",
    "mocap_pos": "body_mocapid",
    "mocap_quat": "body_mocapid",
}
_NUMBERS = {"mocap_pos": 3, "mocap_quat": 4}  # of each element, where the index of its first number is not known


def tie_place(model: Any, tie: Tie) -> int:
    """The index of a tied number in its array of MuJoCo's data.

    Args:
        model: MuJoCo's compiled model.
        tie: The tie.
    """
    if tie.element is None:
        return tie.index
    element = mujoco.mj_name2id(model, _KINDS[tie.element.kind], tie.element.name)
    first = getattr(model, _FIRST[tie.field])[element] if tie.field in _FIRST else element
    return int(first) * _NUMBERS.get(tie.field, 1) + tie.index


def _compiled(spec: Any, model: Model) -> Any:
    """Compile MuJoCo's model. An error of MuJoCo is reported at the part whose place it names (`info`)."""
    try:
        return spec.compile()
    except ValueError as error:
        text = " ".join(str(error).split())
        part = next((part for part in model.parts if text.endswith(f" {part.mark}")), None)
        reason = re.sub(r"[ ,]*Element name .*$", "", text.removeprefix("Error: "))
        reason = re.sub(r"^\w+ '.*?' \(id = \d+\): ", "", reason)
        rule = f"MuJoCo refuses this: {reason}; correct its numbers, or what its component builds."
        raise InvalidSpec(model.fault(part, rule) if part else Fault(rule)) from error
