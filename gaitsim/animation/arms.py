"""Muscles whose paths are declared moment arms without places: which hinges they turn, in which direction, at which
distance.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from gaitsim.compiler.mjcf import Assembly
from gaitsim.model import Model
from gaitsim.simulation.crossings import crossings

_SEARCHED = np.linspace(-1.0, 1.0, 41)  # rad: the range around the neutral posture in which the largest arm is searched
_NOTHING = 1e-6  # m


@dataclass(frozen=True)
class Arm:
    """A path at one hinge: the name of the joint, the largest moment arm near the neutral posture, and the length
    there, in m.

    The arm is positive where tension increases MuJoCo's coordinate of the joint.
    """

    joint: str
    arm: float
    length: float


@dataclass(frozen=True)
class ArmPath:
    """The whole path of a muscle: its address, the signal of the muscle's activation, and its arms at hinges."""

    address: str
    activation: str
    mirrored: bool
    arms: tuple[Arm, ...]


def arm_paths(model: Model, assembly: Assembly) -> list[ArmPath]:
    """The muscle paths whose moment acts on a hinge. Other paths, such as those of massless legs, are left out."""
    found: defaultdict[tuple[str, str], list[Arm]] = defaultdict(list)
    for crossing in crossings(model, assembly):
        largest = max((crossing.arm(crossing.neutral + turn) for turn in _SEARCHED), key=abs)
        if abs(largest) > _NOTHING:
            arm = Arm(crossing.joint, largest, crossing.length(crossing.neutral))
            found[crossing.muscle, crossing.path].append(arm)
    parts = {part.address: part for part in model.parts}
    return [
        ArmPath(path, f"{muscle}.activation", parts[muscle].mirrored, tuple(arms))
        for (muscle, path), arms in found.items()
    ]
