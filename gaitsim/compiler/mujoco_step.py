"""Both halves of MuJoCo's step in LLVM IR. `simulation/physics.py` does the same in plain Python and should be read
first.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Any

from llvmlite import ir

from gaitsim.compiler.chains import arguments
from gaitsim.compiler.mjcf import AFTER_VELOCITIES
from gaitsim.compiler.native import STAGE_OF
from gaitsim.compiler.stage_code import ADDRESSES, native_name
from gaitsim.compiler.writer import INTEGER, NOTHING, POINTER, SHORT, Writer

if TYPE_CHECKING:
    from gaitsim.compiler.functions import Functions

# What `mj_step1` and `mj_step2` call in a model without constraints and sensors, besides energies and the integrator.
_POSITIONS = ("mj_kinematics", "mj_comPos", "mj_tendon", "mj_makeM", "mj_factorM", "mj_transmission")
_FORCES = ("mj_fwdActuation", "mj_fwdAcceleration", "mj_fwdConstraint")


@dataclass(frozen=True)
class MujocoStep:
    """Emits the calls of MuJoCo's functions, and of gaitsim's own stages where the plan has them."""

    of: Functions

    def look(self, f: Writer) -> None:
        """Emit the first half: everything that follows from positions and velocities."""
        if self.of.plan.integrate:
            self._calls(f, *_POSITIONS, *(["mj_energyPos"] if self.of.plan.energy else []))
            self._calls(f, "mj_fwdVelocity", *(["mj_energyVel"] if self.of.plan.energy else []))
            return
        if not self.of.plan.own_stages:
            self._call(f, "mj_step1")
            return
        self._calls(f, "mj_kinematics", "mj_comPos", "mj_makeM", "mj_comVel")
        self._own(f, "look_at_paths")
        self._own(f, "look_at_contacts")
        self._call(f, "mj_rne", SHORT(0), self._address(f, "qfrc_bias"))
        self._calls(f, "mj_subtreeVel", "mj_sensorPos", "mj_sensorVel")
        if self.of.plan.energy:
            self._calls(f, "mj_energyPos", "mj_energyVel")

    def advance(self, f: Writer) -> None:
        """Emit the second half: forces, accelerations, and the next instant."""
        if self.of.plan.runge_kutta:
            self._call(f, "mj_forwardSkip", SHORT(AFTER_VELOCITIES), SHORT(0))
            self._call(f, "mj_RungeKutta", SHORT(4))
        elif self.of.plan.integrate:
            self._calls(f, *_FORCES, self.of.plan.integrate)
        elif not self.of.plan.own_stages:
            self._call(f, "mj_step2")
        else:
            self._own(f, "load_joints")
            self._own(f, "load_contacts")
            self._call(f, "mj_factorM")
            self._call(f, "mj_solveM", self._address(f, "acceleration"), self._address(f, "total"), SHORT(1))
            self._own(f, "advance")

    def _calls(self, f: Writer, *names: str) -> None:
        for stage, group in groupby(names, STAGE_OF.__getitem__):
            with self.of._timed(f, stage):
                for name in group:
                    self._emit(f, name)

    def _call(self, f: Writer, name: str, *given: Any) -> None:
        with self.of._timed(f, STAGE_OF[name]):
            self._emit(f, name, *given)

    def _emit(self, f: Writer, name: str, *given: Any) -> None:
        kinds = [POINTER, POINTER, *(each.type for each in given)]
        f.builder.call(self.of._external(name, NOTHING, kinds), [f.model, f.data, *given])

    def _own(self, f: Writer, stage: str) -> None:
        b, given = f.builder, [self._address(f, name) for name in arguments(stage)]
        function = self.of._external(native_name(stage), SHORT, [POINTER] * (len(given) + 2))
        with b.goto_entry_block():
            result, raised = b.alloca(INTEGER), b.alloca(POINTER)
            b.store(ir.Constant(POINTER, None), raised)
        with self.of._timed(f, "own stages"):
            b.call(function, [result, raised, *given])

    def _address(self, f: Writer, name: str) -> Any:
        return f.load(f.stages, ADDRESSES.index(name), POINTER)
