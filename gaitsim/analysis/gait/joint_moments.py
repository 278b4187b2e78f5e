"""Net joint moments and joint powers, from recorded signals."""

from __future__ import annotations

import numpy as np

from gaitsim.analysis.gait.legs import Leg, side_of
from gaitsim.analysis.replays.cycles import Floats, arriving
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Model, Part
from gaitsim.units import parse_unit

STOPS = ("stop_moment", "stop")


def joint_moment(replay: Replay, joint: str) -> Floats | None:
    """The net moment in N m about a joint, positive where it increases the angle: of muscles, other senders, stops,
    and damping.

    Returns:
        A value for each instant; None if the joint is not a hinge, or if muscles of its side act through tendons whose
        moments are not recorded.
    """
    part = _joint(replay.model, joint)
    if part is None or hidden_paths(replay.model, side_of(joint)):
        return None
    total = sum((arriving(replay, f"{joint}.{name}") for name in _moments(part)), np.zeros(len(replay.times)))
    for name in STOPS:
        if name in part.type.outputs:
            total = total + replay.trajectory[f"{joint}.{name}"]
    if "damping" in part.numbers:
        total = total - replay.model.values()[part.numbers["damping"]] * _velocity(replay, part)
    return total


def joint_power(replay: Replay, joint: str) -> Floats | None:
    """The power in W of a joint's moment. It is positive where it accelerates the segments; None if the moment is."""
    moment, part = joint_moment(replay, joint), _joint(replay.model, joint)
    return None if moment is None or part is None else moment * _velocity(replay, part)


def joint_work(replay: Replay, leg: Leg, joint: str) -> tuple[Floats, Floats] | None:
    """The positive and the negative work of a joint in J, in each stride of a leg; None if the power is."""
    power = joint_power(replay, joint)
    if power is None:
        return None
    return leg.integral(np.maximum(power, 0)), leg.integral(np.minimum(power, 0))


def hidden_paths(model: Model, side: str) -> list[str]:
    """The paths of a side that report no moment, because MuJoCo's tendons pull the bodies."""
    paths = [p for p in model.parts if p.type.kind == "path" and side_of(p.address) == side]
    told = [p.address for p in paths if any(parse_unit(output.unit).si == "N m" for output in p.type.outputs.values())]
    return [p.address for p in paths if not any(t == p.address or t.startswith(f"{p.address}.") for t in told)]


def _joint(model: Model, address: str) -> Part | None:
    """A part with one moment and one angular velocity, and no sliding."""
    part = next((p for p in model.parts if p.address == address and p.type.kind == "joint"), None)
    if part is None or any(parse_unit(output.unit).si == "m" for output in part.type.outputs.values()):
        return None
    return part if len(_moments(part)) == 1 and len(_velocities(part)) == 1 else None


def _moments(part: Part) -> list[str]:
    return [name for name, port in part.type.inputs.items() if parse_unit(port.unit).si == "N m"]


def _velocities(part: Part) -> list[str]:
    return [name for name, port in part.type.outputs.items() if parse_unit(port.unit).si == "rad/s"]


def _velocity(replay: Replay, part: Part) -> Floats:
    return replay.trajectory[f"{part.address}.{_velocities(part)[0]}"]
