"""The object `mj` of `build(p, mj)`: all verbs of mechanics."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace

from gaitsim.compiler.mechanics.actuators import Actuators
from gaitsim.compiler.mechanics.bodies import Bodies
from gaitsim.compiler.mechanics.contacts import Contacts
from gaitsim.compiler.mechanics.drawings import Drawings
from gaitsim.compiler.mechanics.joints import Joints
from gaitsim.compiler.mechanics.paths import Paths
from gaitsim.compiler.mechanics.places import Frames, Vector
from gaitsim.compiler.mechanics.ports import Ports
from gaitsim.compiler.mechanics.sensors import Sensors
from gaitsim.model import Part


class Mechanics(Bodies, Joints, Paths, Contacts, Actuators, Sensors, Ports, Drawings):
    """The MuJoCo side of one part."""


def numbers_of(part: Part, values: Sequence[float], frames: Frames) -> SimpleNamespace:
    """The `p` of a part's `build`: parameters, options, recorded curves, and points on their bodies."""
    numbers = {name: values[index] for name, index in part.numbers.items()}
    points = {
        name: [
            frames.point(place.frame, _mirrored_point([values[i] for i in place.at], part.mirrored)) for place in places
        ]
        for name, places in part.points.items()
    }
    series = {name: recording.values for name, recording in part.series.items()}
    return SimpleNamespace(**numbers, **part.options, **points, **series)


def beside_frames(part: Part, values: Sequence[float]) -> dict[str, Vector]:
    """The offset of each attachment from its frame, in m. Attachments without an offset are left out."""
    return {
        name: _mirrored_point([values[i] for i in places[0].at], part.mirrored) for name, places in part.places.items()
    }


def _mirrored_point(at: Vector, mirrored: bool) -> Vector:
    return (at[0], -at[1], at[2]) if mirrored else at
