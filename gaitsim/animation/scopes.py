"""The signals that are shown beside the picture."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from gaitsim.analysis.signals.pattern import matching
from gaitsim.animation.stage import Stage
from gaitsim.model import Model, Signal, recorded_signals

_MOST = 7
_FORCES = 2


def chosen(model: Model, patterns: Sequence[str]) -> list[Signal]:
    """The signals of addresses and patterns in their order, without repetition."""
    found = [signal for pattern in patterns for signal in matching(model, pattern)]
    return list({signal.address: signal for signal in found}.values())


def usual(model: Model, stage: Stage) -> list[Signal]:
    """The default signals: activation and force of a muscle, ground forces, phases of controllers, height, and a
    command.
    """
    known = {signal.address: signal for signal in recorded_signals(model)}
    muscle = next((part.address for part in model.parts if part.type.kind == "muscle"), None)
    wanted = [f"{muscle}.activation", f"{muscle}.force"] if muscle else []
    wanted += [force.up for force in stage.forces if force.up is not None][:_FORCES]
    controllers = [part for part in model.parts if part.type.kind == "controller" and part.type.outputs]
    states = [f"{part.address}.{name}" for part in controllers for name in part.type.states]
    wanted += [address for address in states if address in known and known[address].levels][:_FORCES]
    wanted += _coordinates(stage)
    wanted += [f"{part.address}.{next(iter(part.type.outputs))}" for part in controllers[:1]]
    return [known[address] for address in dict.fromkeys(wanted) if address in known][:_MOST]


def _coordinates(stage: Stage) -> list[str]:
    """The height of a joint, or else the first coordinate."""
    mechanics = stage.mechanics
    vertical = [
        int(mechanics.jnt_qposadr[joint])
        for joint in range(mechanics.njnt)
        if mechanics.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE and np.abs(mechanics.jnt_axis[joint, 2]) > 0.99
    ]
    places = dict(stage.coordinates)
    return [places[place] for place in (vertical or list(places))[:1]]
