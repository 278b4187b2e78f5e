"""Muscles whose path is a moment arm and has no places: which hinges they turn, which way, and how far from them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from gaitsim.compiler.mjcf import Assembly
from gaitsim.compiler.ties import Tie
from gaitsim.model import Model, Part
from gaitsim.simulation.trial import Trial

_SEARCHED = np.linspace(-1.0, 1.0, 41)  # rad from the neutral posture: where the largest arm is looked for
_NOTHING = 1e-6  # m


@dataclass(frozen=True)
class Arm:
    """A path at one hinge: the joint's name, the largest arm near the neutral posture, and the length there, in m.

    The arm is positive where tension makes MuJoCo's coordinate of the joint grow.
    """

    joint: str
    arm: float
    length: float


@dataclass(frozen=True)
class ArmPath:
    """The whole path of a muscle: its address, the signal of the muscle's activation, and what it crosses."""

    address: str
    activation: str
    mirrored: bool
    arms: tuple[Arm, ...]


def arm_paths(model: Model, assembly: Assembly) -> list[ArmPath]:
    """Paths of muscles whose moment reaches a hinge; others, such as those of massless legs, are left out."""
    return _Finder(model, assembly).found()


class _Finder:
    """Follows each path's moment to the coordinate that it turns."""

    def __init__(self, model: Model, assembly: Assembly) -> None:
        self.model, self.assembly, self.values = model, assembly, model.values()
        self.parts = {part.address: part for part in model.parts}
        self.turned = self._hinges(assembly.applies, "qfrc_applied")
        self.told = self._hinges(assembly.reads, "qpos")

    def found(self) -> list[ArmPath]:
        """Each muscle's path, in the order of the model."""
        arms: defaultdict[tuple[str, str], list[Arm]] = defaultdict(list)
        for connection in self.model.connections:
            source, _, moment = connection.source.rpartition(".")
            target, _, port = connection.target.rpartition(".")
            muscle = self._muscle(source) if target in self.turned else ""
            if muscle:
                path = ".".join(source.split(".")[: muscle.count(".") + 2])
                arms[muscle, path] += self._arms(self.parts[source], moment, self.parts[target], port)
        return [
            ArmPath(path, f"{muscle}.activation", self.parts[muscle].mirrored, tuple(each))
            for (muscle, path), each in arms.items()
            if each
        ]

    def _hinges(self, ties: Sequence[tuple[int, Tie]], field: str) -> dict[str, list[tuple[str, Tie]]]:
        """Of each part: hinges of which it has such a field, and how."""
        found: defaultdict[str, list[tuple[str, Tie]]] = defaultdict(list)
        for i, tie in ties:
            if tie.field == field and tie.element is not None:
                joint = self.assembly.model.joint(tie.element.name)
                if joint.type[0] == mujoco.mjtJoint.mjJNT_HINGE:
                    found[self.model.parts[i].address].append((tie.element.name, tie))
        return dict(found)

    def _muscle(self, path: str) -> str:
        """The part with an activation that a path is in; empty for none, and for what is no path."""
        owner = path.rpartition(".")[0] if self.parts[path].type.kind == "path" else ""
        while owner and not (owner in self.parts and "activation" in self.parts[owner].type.outputs):
            owner = owner.rpartition(".")[0]
        return owner

    def _arms(self, path: Part, moment: str, hinge: Part, port: str) -> list[Arm]:
        """What an output of a path does by an input of a hinge's part: at one joint, or nowhere."""
        found = []
        for joint, tie in self.turned[hinge.address]:
            coordinate = next((told.port for name, told in self.told.get(hinge.address, []) if name == joint), "")
            neutral = float(self.assembly.model.joint(joint).qpos0[0])
            share = tie.sign * self._reaching(hinge, port, tie.port, {coordinate: neutral} if coordinate else {})
            angles = self._fed(f"{hinge.address}.{coordinate}", path)
            trial = self._trial(path)
            arms = [
                share * _slope(trial, "tension", moment, dict.fromkeys(angles, neutral + turn)) for turn in _SEARCHED
            ]
            largest = max(arms, key=abs)
            if abs(largest) > _NOTHING:
                trial.put(dict.fromkeys(angles, neutral)).call("output", "normal")
                found.append(Arm(joint, largest, float(trial.y.length)))
        return found

    def _fed(self, source: str, part: Part) -> list[str]:
        """The inputs of a part that a signal goes to."""
        ends = [c.target.rpartition(".") for c in self.model.connections if c.source == source]
        return [port for owner, _, port in ends if owner == part.address]

    def _reaching(self, part: Part, port: str, applied: str, at: Mapping[str, float]) -> float:
        """How much of an input is in what the part applies: the input itself, or an output with it."""
        return float(port == applied) if applied in part.type.inputs else _slope(self._trial(part), port, applied, at)

    def _trial(self, part: Part) -> Trial:
        """A part at its own numbers."""
        own = {name: self.values[number] for name, number in part.numbers.items() if name in part.type.parameters}
        return Trial(part.type).put(own | {name: self.values[number] for name, number in part.constants.items()})


def _slope(trial: Trial, port: str, output: str, at: Mapping[str, float]) -> float:
    """How much an output grows with an input from 0 to 1, in SI."""
    levels = []
    for level in (0.0, 1.0):
        trial.put({**at, port: level}).call("output", "normal")
        levels.append(float(getattr(trial.y, output)))
    return levels[1] - levels[0]
