"""Where muscle paths with declared moment arms cross hinges: each path's moment is followed to the coordinate that
it turns.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import mujoco
import numpy as np

from gaitsim.compiler.mechanics.ties import Tie
from gaitsim.compiler.mjcf import Assembly
from gaitsim.compiler.program import Floats
from gaitsim.model import Model, Part
from gaitsim.simulation.trial import Trial


@dataclass(frozen=True)
class Crossing:
    """A part of a path at one hinge.

    Attributes:
        muscle: The address of the part with an activation that the path belongs to.
        path: The address of the whole path.
        part: The path component whose moment it is.
        hinge: The part with the hinge.
        joint: MuJoCo's name of the hinge.
        neutral: The angle of the hinge in the posture of the model file, in rad.
        share: The share of the moment that turns the coordinate: 1 or -1.
    """

    muscle: str
    path: str
    part: Part
    hinge: Part
    joint: str
    neutral: float
    share: float
    moment: str
    angles: tuple[str, ...]
    trial: Trial = field(repr=False, compare=False)

    def arm(self, angle: float) -> float:
        """The moment arm in m at an angle of the hinge in rad. It is positive where tension increases the angle."""
        return self.share * _slope(self.trial, "tension", self.moment, dict.fromkeys(self.angles, angle))

    def length(self, angle: float) -> float:
        """The length in m of this part of the path at an angle of the hinge in rad."""
        self.trial.put({**dict.fromkeys(self.angles, angle), "tension": 0.0}).call("output", "normal")
        return float(self.trial.y.length)

    def arms(self, angles: Floats) -> tuple[Floats, Floats]:
        """Moment arms and lengths in m over angles in rad."""
        return np.array([self.arm(a) for a in angles]), np.array([self.length(a) for a in angles])


def crossings(model: Model, assembly: Assembly) -> list[Crossing]:
    """Find the muscle paths whose moment acts on a hinge. Other paths, such as those of massless legs, are left out.

    Args:
        model: The model.
        assembly: Its mechanics.
    """
    return list(_Finder(model, assembly).found())


class _Finder:
    """Follows the moment of each path to the coordinate that it turns."""

    def __init__(self, model: Model, assembly: Assembly) -> None:
        self.model, self.assembly, self.values = model, assembly, model.values()
        self.parts = {part.address: part for part in model.parts}
        self.turned = self._hinges(assembly.applies, "qfrc_applied")
        self.coordinates = self._hinges(assembly.reads, "qpos")

    def found(self) -> Iterator[Crossing]:
        """All crossings, in the order of the model."""
        for connection in self.model.connections:
            sender, _, moment = connection.sender.rpartition(".")
            target, _, port = connection.target.rpartition(".")
            muscle = self._muscle(sender) if target in self.turned else ""
            if muscle:
                path = ".".join(sender.split(".")[: muscle.count(".") + 2])
                yield from self._at((muscle, path), self.parts[sender], moment, self.parts[target], port)

    def _hinges(self, ties: Sequence[tuple[int, Tie]], field: str) -> dict[str, list[tuple[str, Tie]]]:
        """For each part, the hinges whose field it reads or writes, with the tie."""
        found: defaultdict[str, list[tuple[str, Tie]]] = defaultdict(list)
        for i, tie in ties:
            if tie.field == field and tie.element is not None:
                joint = self.assembly.model.joint(tie.element.name)
                if joint.type[0] == mujoco.mjtJoint.mjJNT_HINGE:
                    found[self.model.parts[i].address].append((tie.element.name, tie))
        return dict(found)

    def _muscle(self, path: str) -> str:
        """The part with an activation that a path belongs to; empty if there is none, or if the part is not a path."""
        owner = path.rpartition(".")[0] if self.parts[path].type.kind == "path" else ""
        while owner and not (owner in self.parts and "activation" in self.parts[owner].type.outputs):
            owner = owner.rpartition(".")[0]
        return owner

    def _at(self, who: tuple[str, str], path: Part, moment: str, hinge: Part, port: str) -> Iterator[Crossing]:
        """The crossings of a path at the hinges of a part whose input it sends to."""
        for joint, tie in self.turned[hinge.address]:
            coordinate = next((tie.port for name, tie in self.coordinates.get(hinge.address, []) if name == joint), "")
            neutral = float(self.assembly.model.joint(joint).qpos0[0])
            share = tie.sign * self._reaching(hinge, port, tie.port, {coordinate: neutral} if coordinate else {})
            angles = tuple(self._fed(f"{hinge.address}.{coordinate}", path))
            if share:
                yield Crossing(*who, path, hinge, joint, neutral, share, moment, angles, self._trial(path))

    def _fed(self, sender: str, part: Part) -> list[str]:
        """The inputs of a part that a signal is sent to."""
        ends = [c.target.rpartition(".") for c in self.model.connections if c.sender == sender]
        return [port for owner, _, port in ends if owner == part.address]

    def _reaching(self, part: Part, port: str, applied: str, at: Mapping[str, float]) -> float:
        """The share of an input in the moment that the part applies."""
        return float(port == applied) if applied in part.type.inputs else _slope(self._trial(part), port, applied, at)

    def _trial(self, part: Part) -> Trial:
        """A part with the numbers of the model."""
        own = {name: self.values[number] for name, number in part.numbers.items() if name in part.type.parameters}
        return Trial(part.type).put(own | {name: self.values[number] for name, number in part.constants.items()})


def _slope(trial: Trial, port: str, output: str, at: Mapping[str, float]) -> float:
    """The change of an output when an input goes from 0 to 1, in SI."""
    levels = []
    for level in (0.0, 1.0):
        trial.put({**at, port: level}).call("output", "normal")
        levels.append(float(getattr(trial.y, output)))
    return levels[1] - levels[0]
