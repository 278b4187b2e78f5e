"""Ports: outputs that read numbers of MuJoCo, and inputs that are written to MuJoCo."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import mujoco

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.ties import Element, Tie, tied


class Ports(Making):
    """Verbs that connect ports with numbers of MuJoCo's data."""

    def read(self, port: str, element: Element, field_name: str, index: int = 0) -> None:
        """Let an output be a number of MuJoCo's data: qpos, ten_length, actuator_velocity, sensordata ..."""
        self.made.reads.append((self.index, tied(port, element, field_name, index)))

    def read_energy(self, potential: str, kinetic: str) -> None:
        """Let two outputs be MuJoCo's potential and kinetic energy, in J."""
        self.spec.option.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
        ties = (Tie(potential, None, "energy", 0), Tie(kinetic, None, "energy", 1))
        self.made.reads += [(self.index, tie) for tie in ties]

    def read_weight(self, port: str) -> None:
        """Let an output be the weight of all moving bodies, in N."""
        self._read_constant(port, lambda model: -float(model.opt.gravity[2] * model.body_subtreemass[0]))

    def read_key(self, port: str) -> None:
        """Let an output be an integer below 2^32 that follows from the part's address.

        Two parts with the same seed draw different random numbers if they use it as a key.
        """
        key = float(zlib.crc32(self.part.address.encode()))
        self._read_constant(port, lambda model: key)

    def read_side(self, port: str) -> None:
        """Let an output be -1 for a part of the left side, which is mirrored, and 1 for any other."""
        side = -1.0 if self.part.mirrored else 1.0
        self._read_constant(port, lambda model: side)

    def apply(self, port: str, element: Element, field_name: str, index: int = 0, sign: float = 1.0) -> None:
        """Write an input or output into MuJoCo's data: qfrc_applied of a joint, ctrl of an actuator, mocap_pos ..."""
        self.made.applies.append((self.index, tied(port, element, field_name, index, sign)))

    def reset(self, port: str, when: str, joint: Element, field_name: str) -> None:
        """Set qpos or qvel of a joint to an input or output, at events at which the port `when` is 1."""
        made = tied(port, joint, field_name, 0)
        if field_name not in ("qpos", "qvel"):
            raise ValueError(f"an event sets no {field_name}; name qpos or qvel of a joint")
        self.made.resets.append((self.index, replace(made, when=when)))

    def _read_constant(self, port: str, of: Callable[[Any], float]) -> None:
        place = max(self.spec.nuserdata, 0)
        self.spec.nuserdata = place + 1
        self.made.reads.append((self.index, Tie(port, None, "userdata", place)))
        self.made.constants.append(of)
