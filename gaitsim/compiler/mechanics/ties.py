"""Ports that are tied to numbers of MuJoCo's data."""

from __future__ import annotations

from dataclasses import dataclass

from gaitsim.errors import did_you_mean, with_article


@dataclass(frozen=True)
class Element:
    """A named element of the MuJoCo model: a joint, tendon, actuator, sensor, or a body that is placed (mocap)."""

    kind: str
    name: str


# What MuJoCo's data holds of each kind of element.
_FIELDS = {
    "joint": ("qpos", "qvel", "qacc", "qfrc_applied"),
    "tendon": ("ten_length", "ten_velocity"),
    "actuator": ("ctrl", "actuator_length", "actuator_velocity", "actuator_force"),
    "sensor": ("sensordata",),
    "mocap": ("mocap_pos", "mocap_quat"),
}


@dataclass(frozen=True)
class Tie:
    """A port that is tied to one number of MuJoCo's data, such as qpos of a joint.

    Attributes:
        when: For a number that is written at events, the port that is 1 at these events.
    """

    port: str
    element: Element | None
    field: str
    index: int = 0
    sign: float = 1.0
    when: str = ""


def tied(port: str, element: Element, field_name: str, index: int, sign: float = 1.0) -> Tie:
    """Tie a port to a number of an element.

    Raises:
        ValueError: The element has no such number.
    """
    known = _FIELDS.get(element.kind, ())
    if field_name not in known:
        raise ValueError(f"{with_article(element.kind)} has no {field_name}. {did_you_mean(field_name, known)}")
    return Tie(port, element, field_name, index, sign)
