"""Tables of the stages that gaitsim makes itself, and the models for which it does."""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler import stages

# Models with fewer coordinates are as fast with MuJoCo's own stages.
_FEWEST = 13
_SLIDE, _HINGE = int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE)
_JOINT, _TENDON, _SITE = (int(getattr(mujoco.mjtTrn, f"mjTRN_{name}")) for name in ("JOINT", "TENDON", "SITE"))
_FIXED, _AFFINE = int(mujoco.mjtGain.mjGAIN_FIXED), int(mujoco.mjtGain.mjGAIN_AFFINE)


def own_stages(m: Any) -> bool:
    """Whether gaitsim makes the stages of paths, contacts and forces of a MuJoCo model itself.

    It does for larger trees of hinges and slides without constraints, whose tendons run straight from point to point
    and whose actuators are as `compiler/mechanics/actuators.py` makes them.
    """
    implicit = m.opt.integrator == mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    free = m.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    simple = np.isin(m.jnt_type, (_SLIDE, _HINGE)).all() and m.nv == m.njnt and not (m.na or m.nflex or m.nplugin)
    straight = (m.wrap_type == mujoco.mjtWrap.mjWRAP_SITE).all()
    absent = (m.tendon_stiffness, m.tendon_damping, m.tendon_armature, m.jnt_stiffness, m.dof_dampingpoly)
    elastic = any(np.any(array) for array in (*absent, m.body_gravcomp, m.opt.density, m.opt.viscosity, m.opt.wind))
    late = (m.sensor_needstage == mujoco.mjtStage.mjSTAGE_ACC).any()
    if m.nv < _FEWEST or not (implicit and free and simple and straight) or elastic or late:
        return False
    return all(_known(m, i) for i in range(m.nu))


def _known(m: Any, i: int) -> bool:
    """Whether an actuator is one of those that `stages` knows."""
    gear, kind = m.actuator_gear[i], int(m.actuator_trntype[i])
    if kind == _SITE:
        reference = int(m.actuator_trnid[i, 1])
        return reference >= 0 and int(m.body_weldid[m.site_bodyid[reference]]) == 0
    whole = gear[0] == 1 and not gear[1:].any()
    return bool(whole) and (kind == _JOINT or (kind == _TENDON and m.actuator_gaintype[i] == _FIXED))


@dataclass(frozen=True)
class Stages:
    """The arrays of the functions of `stages` by the names of their arguments."""

    arrays: Mapping[str, Any] = field(repr=False)

    @staticmethod
    def of(m: Any, d: Any) -> Stages:
        """Make the tables of a MuJoCo model, beside the arrays of its data.

        Args:
            m: The model, for which `own_stages` holds.
            d: Its data.
        """
        made = _paths(m) | _contacts(m)
        pieces, kinds = len(made["pieces"]), [len(made[name]) for name in ("pulls", "motors", "spheres")]
        low, high = np.where(m.actuator_forcelimited[:, None] > 0, m.actuator_forcerange, (-np.inf, np.inf)).T
        slope = np.where(m.actuator_gaintype == _AFFINE, m.actuator_gainprm[:, 2], 0.0)
        given = {name: getattr(d, name) for name in _OF_DATA}
        made |= {
            "counts": [m.ntendon, pieces, *kinds, m.nv],
            "rows": np.column_stack([m.M_rowadr, m.M_rownnz]),
            "gains": np.column_stack([m.actuator_gainprm[:, 0], slope, low, high]),
            "damping": m.dof_damping,
            "step": [m.opt.timestep],
            "arms": np.zeros(len(made["freedoms"])),
            "mass": given.pop("M"),
            **{name: np.zeros(m.nv) for name in ("total", "acceleration", "row")},
        }
        whole = {name: np.ravel(np.array(made.pop(name), dtype=np.int64)) for name in TABLES}
        return Stages(whole | {name: np.ravel(np.asarray(table, np.float64)) for name, table in (made | given).items()})

    def call(self, stage: str) -> None:
        """Call one function of `stages`."""
        getattr(stages, stage)(*(self.arrays[argument] for argument in arguments(stage)))


# The arguments that are whole numbers.
TABLES = frozenset(
    ("counts", "paths", "pieces", "hinges", "freedoms", "pulls", "motors", "spheres", "pushes", "links", "rows")
)


def arguments(name: str) -> tuple[str, ...]:
    """The arguments of one function of `stages`."""
    return tuple(inspect.signature(getattr(stages, name)).parameters)


_OF_DATA = (
    *("M", "qpos", "qvel", "site_xpos", "xaxis", "xanchor", "cvel", "subtree_com", "ctrl"),
    *("ten_length", "ten_velocity", "actuator_length", "actuator_velocity", "actuator_force"),
    *("qfrc_bias", "qfrc_applied"),
)


def _chain(m: Any, body: int) -> list[tuple[int, int, int]]:
    """What moves a body, from the root on: coordinates of one body, from the first to after the last, that slide (0) or
    turn about one point (1).
    """
    found: list[tuple[int, int, int]] = []
    while body > 0:
        first = int(m.body_jntadr[body])
        joints = range(first, first + int(m.body_jntnum[body]))
        alike = itertools.groupby(joints, lambda j: (int(m.jnt_type[j] == _HINGE), *m.jnt_pos[j]))
        groups = [(key[0], list(members)) for key, members in alike]
        found = [*((members[0], members[-1] + 1, turns) for turns, members in groups), *found]
        body = int(m.body_parentid[body])
    return found


def _paths(m: Any) -> dict[str, Any]:
    """Pieces of paths between bodies, the hinges that turn one end of a piece, and the lengths of the other pieces."""
    paths, pieces = [], []
    hinges: list[tuple[int, ...]] = []
    freedoms: list[int] = []
    fixed: list[float] = []
    for tendon in range(m.ntendon):
        begin, length = len(freedoms), 0.0
        through = m.wrap_objid[m.tendon_adr[tendon] : m.tendon_adr[tendon] + m.tendon_num[tendon]]
        for a, b in itertools.pairwise(int(site) for site in through):
            if m.site_bodyid[a] == m.site_bodyid[b]:
                length += float(np.linalg.norm(m.site_pos[b] - m.site_pos[a]))
                continue
            before = len(hinges)
            for group, moved, sign in _crossed(m, a, b):
                first, last, _ = group
                if first not in freedoms[begin:]:
                    freedoms += range(first, last)
                hinges.append((*group, moved, freedoms.index(first, begin), sign))
            pieces.append((tendon, a, b, before, len(hinges)))
        paths.append((begin, len(freedoms)))
        fixed.append(length)
    return {"paths": paths, "pieces": pieces, "hinges": hinges, "freedoms": freedoms, "fixed_lengths": fixed}


def _crossed(m: Any, a: int, b: int) -> Iterator[tuple[tuple[int, int, int], int, int]]:
    """The coordinates that move one of two sites, that site, and 1 for the second or -1 for the first."""
    before, after = (_chain(m, int(m.site_bodyid[site])) for site in (a, b))
    for chain, other, site, sign in ((before, after, a, -1), (after, before, b, 1)):
        for group in chain:
            if group not in other:
                yield group, site, sign


def _contacts(m: Any) -> dict[str, Any]:
    """Actuators by what they act on: paths, hinges, and places at which forces act along axes of the world."""
    of_kind = {kind: np.flatnonzero(m.actuator_trntype == kind) for kind in (_TENDON, _JOINT, _SITE)}
    spheres, wrenches = [], []
    pushes: list[int] = []
    links: list[tuple[int, int, int]] = []
    for site in sorted({int(m.actuator_trnid[i, 0]) for i in of_kind[_SITE]}):
        body, first, begin = int(m.site_bodyid[site]), len(pushes), len(links)
        links += _chain(m, body)
        for i in of_kind[_SITE]:
            if m.actuator_trnid[i, 0] == site:
                pushes.append(int(i))
                wrenches.append(_wrench(m, m.actuator_gear[i], int(m.actuator_trnid[i, 1])))
        spheres.append((site, body, int(m.body_rootid[body]), first, len(pushes), begin, len(links)))
    return {
        "pulls": [(i, m.actuator_trnid[i, 0]) for i in of_kind[_TENDON]],
        "motors": [(i, m.jnt_dofadr[m.actuator_trnid[i, 0]]) for i in of_kind[_JOINT]],
        **{"spheres": spheres, "pushes": pushes, "wrenches": wrenches, "links": links},
    }


def _wrench(m: Any, gear: Sequence[float], reference: int) -> list[float]:
    """The force and the moment of a push in the world, and the coordinate of its reference along the force."""
    world = mujoco.MjData(m)
    mujoco.mj_kinematics(m, world)
    turned = world.site_xmat[reference].reshape(3, 3) @ np.reshape(gear, (2, 3)).T
    return [*turned[:, 0], *turned[:, 1], float(turned[:, 0] @ world.site_xpos[reference])]
