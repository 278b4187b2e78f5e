"""Net joint moments and joint powers, from recorded signals."""

from __future__ import annotations

import numpy as np

from gaitsim.analysis.gait.legs import Leg
from gaitsim.analysis.replays.cycles import Floats, arriving
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Model, Part
from gaitsim.simulation.tendon_arms import tendon_arms
from gaitsim.units import parse_unit

STOPS = ("stop_moment", "stop")


def joint_moment(replay: Replay, joint: str) -> Floats | None:
    """The net moment in N m about a joint, positive where it increases the angle: of muscles, other senders, stops,
    and damping.

    Paths through points report no moment; theirs is computed from their moment arms at each instant.

    Returns:
        A value for each instant; None if the joint is not a hinge.
    """
    part = _joint(replay.model, joint)
    if part is None:
        return None
    total = sum((arriving(replay, f"{joint}.{name}") for name in _moments(part)), pulled(replay, joint))
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


def pulled(replay: Replay, joint: str) -> Floats:
    """The moment in N m of all paths through points about a hinge, positive where it increases the angle."""
    arms = tendon_arms(replay.model, replay.trajectory, joint)
    return sum((arm * _tension(replay, path) for path, arm in arms.items()), np.zeros(len(replay.times)))


def _tension(replay: Replay, path: str) -> Floats:
    part = next(part for part in replay.model.parts if part.address == path)
    name = next(name for name, port in part.type.inputs.items() if parse_unit(port.unit).si == "N")
    return arriving(replay, f"{path}.{name}")


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
