"""Initial poses whose feet are in the ground: which coordinate to raise, and by how much."""

from __future__ import annotations

import math
from functools import cached_property

import mujoco

from gaitsim.compiler.mechanics.ties import Tie
from gaitsim.compiler.mjcf import tie_place
from gaitsim.errors import Mark
from gaitsim.model import Model
from gaitsim.simulation.initial_height import heights
from gaitsim.simulation.physics import Physics

_UPRIGHT = 1 - 1e-6  # upward component of the axis of a vertical joint


class Sunk:
    """A model that may start with its lowest contact below the ground."""

    def __init__(self, model: Model, physics: Physics) -> None:
        """Look at a posed model.

        Args:
            model: The model.
            physics: Its mechanics in the initial pose.
        """
        self.model, self.physics = model, physics
        assembly = physics.assembly
        gaps = heights(physics.model, physics.data, assembly.touching, assembly.relief)
        self.height = min(gaps, default=math.nan)
        self.contacts = set(assembly.carried) if self.height < 0 else set()
        self.lift = self._lift(assembly.touching[gaps.index(self.height)].body) if self.contacts else None

    @cached_property
    def move(self) -> str:
        """What to do; empty if no coordinate raises the model."""
        if self.lift is None:
            return ""
        part, tie = self.lift
        root, address = self.model.parts[part].address, self._address
        stands = any(lift.part == part for lift in self.physics.assembly.lifts)
        raised = float(self.physics.data.qpos[tie_place(self.physics.model, tie)]) - self.height
        if address not in self.model.initial:
            return f"lower load of {root}" if stands else f"write initial: {{{address}: {raised:.4g} m}}"
        rule = f"raise {address} in initial: by {-self.height:.4g} m to {raised:.4g} m"
        if stands:
            rule += f", or remove it, so that {root} starts on the ground; with load: 1, {root} starts where the ground"
            rule += " carries the body weight"
        return rule

    @property
    def mark(self) -> Mark | None:
        """The place of the initial value of that coordinate; None if there is none."""
        index = None if self.lift is None else self.model.initial.get(self._address)
        return None if index is None else self.model.numbers[index].mark

    @property
    def _address(self) -> str:
        assert self.lift is not None
        part, tie = self.lift
        return f"{self.model.parts[part].address}.{tie.port}"

    def _lift(self, body: str) -> tuple[int, Tie] | None:
        """The coordinate of the lowest vertical slide in the chain to a body, with the index of its part."""
        mechanics, above = self.physics.model, self.physics.model.body(body).id
        reads = self.physics.assembly.reads
        ties = {tie_place(mechanics, tie): (part, tie) for part, tie in reads if tie.field == "qpos"}
        found = None
        while above:
            first = int(mechanics.body_jntadr[above])
            for joint in range(first + int(mechanics.body_jntnum[above]) - 1, first - 1, -1):
                upright = self.physics.data.xaxis[joint][2] > _UPRIGHT
                if upright and mechanics.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE:
                    found = ties.get(int(mechanics.jnt_qposadr[joint]), found)
            above = int(mechanics.body_parentid[above])
        return found
