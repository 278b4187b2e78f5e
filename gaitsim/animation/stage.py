"""The model of a film: the same bodies and joints, with light, ground and colours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from gaitsim.animation.arms import arm_paths
from gaitsim.animation.errors import CannotAnimate
from gaitsim.animation.relief import add_relief
from gaitsim.animation.routes import Drawer
from gaitsim.compiler.mechanics.ground import GROUND
from gaitsim.compiler.mechanics.places import DrawnForce, DrawnLine, Point
from gaitsim.compiler.mjcf import Assembly, assemble, tie_place
from gaitsim.errors import Fault
from gaitsim.model import Model

TILE = 0.5  # m, side of the ground's pattern
_FLESH = (0.88, 0.70, 0.55, 0.32)  # transparent, because paths of muscles run inside
_FAR_FLESH = (0.55, 0.50, 0.48, 0.32)  # of the left side, which is behind the right one
_BONE = (0.84, 0.81, 0.74, 1)
_FAR_BONE = (0.66, 0.64, 0.62, 1)
_THIN = 0.3  # of a limb's radius: its bone
_MASSLESS = {"mass": 0, "contype": 0, "conaffinity": 0}
_WRAP = (0.55, 0.55, 0.55, 0.5)
_TENDON = 0.013  # m, radius of a muscle's path
_TRACK = (-40.0, 0.9)  # m, from behind the camera to the far side of the ground
_ROUGH = (-2.5, 0.9)  # m, of uneven ground


@dataclass(frozen=True)
class Spot:
    """A place on a body, and the signals that move it forwards and upwards: pairs (signal, factor), in m."""

    body: int
    position: tuple[float, float, float]
    forward: tuple[str, float] | None = None
    up: tuple[str, float] | None = None


@dataclass(frozen=True)
class Line:
    """A line through spots; radius in m."""

    spots: tuple[Spot, ...]
    radius: float


@dataclass(frozen=True)
class Force:
    """A force on a spot: its signals in N forwards, upwards and to the left, and the part that it belongs to.

    Attributes:
        axes: The directions forwards, to the left and upwards there, in the world.
    """

    part: str
    spot: Spot
    forward: str | None
    up: str | None
    left: str | None
    axes: tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class Stage:
    """MuJoCo's model of a film, and the signals that it shows.

    Attributes:
        coordinates: Pairs of an index in qpos and a signal.
        muscles: Pairs of a tendon and the signal of its activation.
    """

    mechanics: Any
    coordinates: tuple[tuple[int, str], ...]
    muscles: tuple[tuple[int, str], ...]
    lines: tuple[Line, ...]
    forces: tuple[Force, ...]


def stage_of(model: Model, wide: bool = False) -> Stage:
    """Make the stage of a model at its starts.

    Args:
        model: The model.
        wide: Whether to show ground on both sides of the path.

    Raises:
        CannotAnimate: A joint's coordinate is in no output.
        InvalidSpec: The spec breaks a rule.
        SimulationFailed: The candidate fails.
    """
    assembly = assemble(model, model.values())
    spec = assembly.spec
    lines, forces = _drawings(model, assembly)
    _paint_bodies(model, spec)
    muscles = _muscles(model, assembly)
    _paint_tendons(spec, {name for name, _ in muscles})
    _add_surroundings(spec, ground=bool(forces), wide=wide)
    if assembly.relief is not None and forces:
        near, far = _ROUGH if not wide else (_ROUGH[0], -_ROUGH[0])
        add_relief(spec, assembly.relief, model.simulate.duration, near, far)
    mechanics = spec.compile()
    return Stage(
        mechanics,
        _coordinates(model, assembly, mechanics),
        tuple((mechanics.tendon(name).id, signal) for name, signal in muscles),
        tuple(lines),
        tuple(forces),
    )


def _coordinates(model: Model, assembly: Assembly, mechanics: Any) -> tuple[tuple[int, str], ...]:
    """The signal of each coordinate."""
    found = {
        tie_place(mechanics, tie): f"{model.parts[i].address}.{tie.port}"
        for i, tie in assembly.reads
        if tie.field == "qpos"
    }
    for joint in range(mechanics.njnt):
        first = int(mechanics.jnt_qposadr[joint])
        after = int(mechanics.jnt_qposadr[joint + 1]) if joint + 1 < mechanics.njnt else int(mechanics.nq)
        if not set(range(first, after)) <= set(found):
            address = str(mechanics.joint(joint).name)
            part = next((p for p in model.parts if address == p.address or address.startswith(f"{p.address}.")), None)
            rule = "no output reports this joint's coordinate, so its motion was not recorded"
            move = 'declare an output and mj.read("angle", joint, "qpos") in its component\'s build'
            raise CannotAnimate(Fault(f"{rule}; {move}.", model.place(part) if part else None, address))
    return tuple(sorted(found.items()))


def _muscles(model: Model, assembly: Assembly) -> list[tuple[str, str]]:
    """The tendons of muscles and the signals of their colours; the owner of the path has an activation.

    Paths that are declared by moment arms get their tendons here.
    """
    outputs = {part.address: part.type.outputs for part in model.parts}
    found = []
    for i, tie in assembly.reads:
        owner = model.parts[i].address.rpartition(".")[0]
        if tie.field == "ten_length" and tie.element and "activation" in outputs.get(owner, {}):
            found.append((tie.element.name, f"{owner}.activation"))
    places = {name for name, _ in found}
    drawer = Drawer(assembly.spec, assembly.model)
    paths = [path for path in arm_paths(model, assembly) if path.address not in places and drawer.draw(path)]
    return found + [(path.address, path.activation) for path in paths]


def _drawings(model: Model, assembly: Assembly) -> tuple[list[Line], list[Force]]:
    lines, forces = [], []
    for i, drawing in assembly.drawings:
        part = model.parts[i].address

        def signal(port: str | None, part: str = part) -> str | None:
            return f"{part}.{port}" if port is not None else None

        def way(one: tuple[str, float] | None, part: str = part) -> tuple[str, float] | None:
            return (f"{part}.{one[0]}", one[1]) if one is not None else None

        match drawing:
            case DrawnLine():
                spots = tuple(_spot(m.place, assembly, way(m.forward), way(m.up)) for m in drawing.points)
                lines.append(Line(spots, drawing.radius))
            case DrawnForce():
                spot = _spot(drawing.place, assembly)
                axes = _axes(assembly, drawing.surface)
                ways = (signal(drawing.forward), signal(drawing.up), signal(drawing.left))
                forces.append(Force(part, spot, *ways, axes))
    return lines, forces


def _axes(assembly: Assembly, surface: str) -> tuple[tuple[float, ...], ...]:
    """The directions forwards, to the left and upwards on a surface of the world."""
    turn = np.eye(3).ravel()
    if surface:
        mujoco.mju_quat2Mat(turn, assembly.model.site(surface).quat)
    columns = turn.reshape(3, 3).T
    return tuple(tuple(column) for column in columns)


def _spot(
    place: Point,
    assembly: Assembly,
    forward: tuple[str, float] | None = None,
    up: tuple[str, float] | None = None,
) -> Spot:
    return Spot(assembly.model.body(place.body.name).id, place.position, forward, up)


def _paint_bodies(model: Model, spec: Any) -> None:
    """Colour limbs like flesh with a bone inside, and other shapes like bone; the left side is darker."""
    mirrored = {part.address: part.mirrored for part in model.parts}
    for body in spec.bodies:
        for geom in list(body.geoms):
            if geom.name.endswith(".cylinder"):
                geom.rgba = _WRAP
            elif body.name in mirrored:
                bone, flesh = (_FAR_BONE, _FAR_FLESH) if mirrored[body.name] else (_BONE, _FLESH)
                limb = geom.type == mujoco.mjtGeom.mjGEOM_CAPSULE
                geom.rgba = flesh if limb else bone
                if limb:
                    shape = {"type": geom.type, "pos": geom.pos, "quat": geom.quat, "fromto": geom.fromto}
                    size = [_THIN * geom.size[0], *geom.size[1:]]
                    body.add_geom(**shape, size=size, rgba=bone, **_MASSLESS)


def _paint_tendons(spec: Any, muscles: set[str]) -> None:
    """Show the paths of muscles, and hide tendons that only measure or close a loop."""
    for tendon in spec.tendons:
        tendon.width = _TENDON
        tendon.rgba = (0, 0, 0, 1 if tendon.name in muscles else 0)


def _add_surroundings(spec: Any, ground: bool, wide: bool) -> None:
    """Add light, a plain background and, if something touches it, the ground as a tiled track."""
    # Near and far ends of what is seen, in m; MuJoCo counts them in sizes of the model, steps and all.
    spec.stat.extent, spec.visual.map.znear, spec.visual.map.zfar = 1.0, 0.05, 200.0
    spec.visual.headlight.ambient = (0.45, 0.45, 0.45)
    spec.visual.headlight.diffuse = (0.45, 0.45, 0.45)
    spec.visual.headlight.specular = (0.1, 0.1, 0.1)
    sky = {"rgb1": (0.97, 0.98, 1.0), "rgb2": (0.80, 0.86, 0.92), "width": 64, "height": 64 * 6}
    spec.add_texture(
        name="gaitsim.sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT, **sky
    )
    sun = spec.worldbody.add_light(pos=(0, -2, 6), dir=(0, 0.3, -1), type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
    # On a processor a shadow costs as much as the rest of the picture.
    sun.castshadow = False
    if not ground:
        return
    spec.add_texture(
        name="gaitsim.tiles",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=(0.80, 0.83, 0.86),
        rgb2=(0.66, 0.70, 0.74),
        width=128,
        height=128,
    )
    tiles = spec.add_material(name="gaitsim.tiles", texuniform=True, texrepeat=(0.5 / TILE, 0.5 / TILE))
    tiles.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "gaitsim.tiles"
    grounds = [geom for geom in spec.geoms if geom.name.startswith(GROUND)]
    if not grounds:
        grounds = [spec.worldbody.add_geom(name=GROUND, type=mujoco.mjtGeom.mjGEOM_PLANE, contype=0, conaffinity=0)]
    near, far = _TRACK if not wide else (_TRACK[0], -_TRACK[0])
    for geom in grounds:
        length = 0 if geom.type == mujoco.mjtGeom.mjGEOM_PLANE else geom.size[0]  # 0 is without end
        geom.size = (length, (far - near) / 2, max(0.1, geom.size[2]))
        geom.pos = (geom.pos[0], (near + far) / 2, geom.pos[2])
        geom.material = "gaitsim.tiles"
