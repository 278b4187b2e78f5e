"""Work that paths make: a moment times the turning of its joint is not always the force times the shortening."""

from __future__ import annotations

import numpy as np

from gaitsim.analysis.gait.legs import side_of
from gaitsim.analysis.replays.cycles import Floats, arriving
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Model, Part

_NEEDED = {"tension", "angular_velocity"}


def created_power(replay: Replay, side: str = "") -> Floats:
    """Power in W that joints get from paths beyond what muscle-tendon units give, of all sides or of one.

    0 where force times length and moment times angle agree. A path whose pennation factor scales its length and
    not its moment, as in Geyer & Herr (2010), makes work, or takes it.
    """
    found = np.zeros(len(replay.times))
    for path in _around_joints(replay.model):
        if side_of(path.address).startswith(side):
            found += _created(replay, path.address)
    return found


def _around_joints(model: Model) -> list[Part]:
    """Paths that tell their moment and their lengthening velocity."""
    paths = (part for part in model.parts if part.type.kind == "path")
    return [p for p in paths if p.type.inputs.keys() >= _NEEDED and p.type.outputs.keys() >= {"moment", "velocity"}]


def _created(replay: Replay, path: str) -> Floats:
    signal = replay.trajectory
    at_joint = signal[f"{path}.moment"] * arriving(replay, f"{path}.angular_velocity")
    of_muscle = -signal[f"{path}.velocity"] * arriving(replay, f"{path}.tension")
    return np.asarray(at_joint - of_muscle, dtype=np.float64)
