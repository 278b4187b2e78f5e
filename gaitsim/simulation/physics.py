"""MuJoCo's model and data for one program. They are rebuilt when a candidate changes the mechanics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.chains import Stages
from gaitsim.compiler.mjcf import AFTER_VELOCITIES, Assembly, assemble, tie_place
from gaitsim.compiler.program import Program
from gaitsim.errors import Fault, InvalidSpec
from gaitsim.simulation.failure import of_mechanics, of_runaway
from gaitsim.simulation.initial_height import stand
from gaitsim.simulation.initial_load import Ground
from gaitsim.simulation.projection import close_loops

# A joint that is faster than both has diverged. People's joints and limbs stay below 100 rad/s and 100 m/s, and the
# shipped models below 43 rad/s and 0.022 rad in a step.
_FASTEST = 100.0  # rad/s or m/s
_FARTHEST = 0.1  # rad or m in one step


@dataclass
class Physics:
    """The mechanics of one program, posed for each candidate.

    Attributes:
        native: Whether parts that are needed for a pose are computed in native code; see `simulation/initial_load.py`.
    """

    program: Program
    native: bool = False
    _built_for: tuple[float, ...] | None = None
    _assembly: Assembly | None = field(default=None, repr=False)
    _ground: Ground | None = field(default=None, repr=False)
    data: Any = None
    stages: Stages | None = field(default=None, repr=False)

    @property
    def assembly(self) -> Assembly:
        assert self._assembly is not None
        return self._assembly

    @property
    def model(self) -> Any:
        return self.assembly.model

    @property
    def ground(self) -> Ground:
        """What the ground carries at the start."""
        if self._ground is None:
            self._ground = Ground(self.program, self.assembly, self.data, self.native)
        return self._ground

    @cached_property
    def _mechanical(self) -> tuple[int, ...]:
        """The numbers from which the MuJoCo model is made."""
        found: list[int] = []
        for part in self.program.model.parts:
            if "build" in part.type.functions:
                found += part.numbers.values()
                found += part.coordinates
        return tuple(found)

    def pose(self, values: Sequence[float]) -> None:
        """Build the model if needed, reset MuJoCo's state, set the initial coordinates, and close loops.

        Args:
            values: All numbers of the model, in SI.

        Raises:
            SimulationFailed: No pose has these coordinates and closed loops.
            InvalidSpec: No height has the load with which a joint is to start.
        """
        key = tuple(values[i] for i in self._mechanical)
        if self._assembly is None or key != self._built_for:
            self._assembly = assemble(self.program.model, values, dressed=False)
            self._built_for = key
            self.data = mujoco.MjData(self.model)
            self.stages = Stages.of(self.model, self.data) if self._assembly.own_stages else None
            self._ground = None
        mujoco.mj_resetData(self.model, self.data)
        # MuJoCo would print and log a warning the first time; the loops make their own checks.
        self.data.warning.number[:] = 1
        self.data.userdata[:] = self.assembly.constants
        given: dict[str, list[int]] = {"qpos": [], "qvel": []}
        for name, position, velocity in self.assembly.begins:
            joint = self.model.joint(name)
            for array, place, value in (("qpos", joint.qposadr[0], position), ("qvel", joint.dofadr[0], velocity)):
                getattr(self.data, array)[place] = value
                given[array].append(int(place))
        for address, number in self.program.model.initial.items():
            if address in self._coordinates:
                array, place = self._coordinates[address]
                getattr(self.data, array)[place] = values[number]
                given[array].append(place)
        close_loops(self.model, self.data, given["qpos"], given["qvel"])
        for lift in self.assembly.lifts:
            place = int(self.model.joint(lift.joint).qposadr[0])
            if place not in given["qpos"]:
                stand(self.model, self.data, place, self.assembly.touching, self.assembly.relief)
                if lift.load > 0:
                    self.ground.carry(lift, values, self.initial_states(values))
        mujoco.mj_forward(self.model, self.data)

    def look(self) -> None:
        """The first half of MuJoCo's step: everything that follows from positions and velocities."""
        m, d = self.model, self.data
        if self.stages is None:
            mujoco.mj_step1(m, d)
            return
        mujoco.mj_kinematics(m, d)
        mujoco.mj_comPos(m, d)
        mujoco.mj_makeM(m, d)
        mujoco.mj_comVel(m, d)
        self.stages.call("look_at_paths")
        self.stages.call("look_at_contacts")
        mujoco.mj_rne(m, d, 0, d.qfrc_bias)
        mujoco.mj_subtreeVel(m, d)
        mujoco.mj_sensorPos(m, d)
        mujoco.mj_sensorVel(m, d)
        if self.assembly.energy:
            mujoco.mj_energyPos(m, d)
            mujoco.mj_energyVel(m, d)

    def advance(self) -> None:
        """The second half of MuJoCo's step: forces, accelerations, and the next instant."""
        m, d = self.model, self.data
        if self.assembly.runge_kutta:
            mujoco.mj_forwardSkip(m, d, AFTER_VELOCITIES, 0)
            mujoco.mj_RungeKutta(m, d, 4)
        elif self.stages is None:
            mujoco.mj_step2(m, d)
        else:
            self.stages.call("load_joints")
            self.stages.call("load_contacts")
            mujoco.mj_factorM(m, d)
            solved, total = (self.stages.arrays[name].reshape(1, -1) for name in ("acceleration", "total"))
            mujoco.mj_solveM(m, d, solved, total)
            self.stages.call("advance")

    @cached_property
    def _coordinates(self) -> dict[str, tuple[str, int]]:
        """The outputs that are joint coordinates: array and index by address."""
        parts = self.program.model.parts
        return {
            f"{parts[i].address}.{tie.port}": (tie.field, tie_place(self.model, tie))
            for i, tie in self.assembly.reads
            if tie.field in ("qpos", "qvel")
        }

    def check_initial(self) -> None:
        """Check that every initial value belongs to a joint coordinate or a state.

        Raises:
            InvalidSpec: One belongs to a computed output.
        """
        self.pose(self.program.model.values())
        for address, number in self.program.model.initial.items():
            part, name = self.program.port(address)
            if address not in self._coordinates and name not in self.program.model.parts[part].type.states:
                mark = self.program.model.numbers[number].mark
                rule = f"{address} is computed, so it has no initial value; set a joint's coordinate or a state."
                raise InvalidSpec(Fault(rule, mark, "initial"))

    @cached_property
    def appliers(self) -> tuple[int, ...]:
        """The parts with an input that is written to MuJoCo. It must be that of the same instant."""
        parts = self.program.model.parts
        return tuple(sorted({i for i, tie in self.assembly.applies if tie.port in parts[i].type.inputs}))

    def initial_states(self, values: Sequence[float]) -> dict[int, float]:
        """The initial values of states, by index in the table."""
        found = {}
        for address, number in self.program.model.initial.items():
            if address not in self._coordinates:
                found[self.program.states.place(*self.program.port(address))] = values[number]
        return found

    @property
    def fastest(self) -> float:
        """The largest joint velocity that a run may have, in rad/s or m/s."""
        return max(_FASTEST, _FARTHEST / self.program.model.simulate.step)

    def divergence(self, step: int) -> str | None:
        """Check whether the mechanics diverged.

        A joint that is faster than any limb and covers much of its range in one step is not resolved: its numbers are
        finite but meaningless.

        Returns:
            The message that names the joints; None if nothing diverged.
        """
        if not (np.all(np.isfinite(self.data.qpos)) and np.all(np.isfinite(self.data.qvel))):
            wrong = [
                address
                for address, (array, place) in self._coordinates.items()
                if not np.isfinite(getattr(self.data, array)[place])
            ]
            return of_mechanics(self.program, wrong, step)
        speeds = np.abs(self.data.qvel)
        if not speeds.size or speeds.max() <= self.fastest:
            return None
        joint = self.model.joint(int(self.model.dof_jntid[speeds.argmax()]))
        unit = "rad" if joint.type[0] == mujoco.mjtJoint.mjJNT_HINGE else "m"
        return of_runaway(self.program, joint.name, float(speeds.max()), unit, step)

    def array(self, name: str) -> Any:
        """One of MuJoCo's arrays as a flat numpy view."""
        return np.ravel(getattr(self.data, name))
