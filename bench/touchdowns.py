"""What a walk in space is like shortly after each touchdown, in six numbers that do not depend on its heading."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gaitsim.simulation.outcome import Trajectory

# Differences of the six numbers that are alike in size: rad, rad, m/s, m, s, m/s.
SCALES = np.array([0.06, 0.08, 0.1, 0.04, 0.05, 0.12])
SHORTEST = 0.5  # s: between touchdowns of one foot
LATER = 0.1  # s: from a touchdown to the instant that is looked at


def touchdowns(found: Trajectory) -> Any:
    """Roll and pitch of the pelvis, lateral velocity of the center of mass, its distance to the side of the new foot,
    duration of the step, and speed. Forwards is where the pelvis faces. Lateral numbers are mirrored on the left.

    Returns:
        A row for each touchdown. The duration of the first step is nan.
    """
    times, rows = found.times, []
    later = round(LATER / (times[1] - times[0]))
    for leg, sign in (("l", -1), ("r", 1)):
        loaded, before = found[f"leg_{leg}.ground.load"] > 0.1, -1.0
        for k in np.flatnonzero(loaded[1:] & ~loaded[:-1]) + 1:
            if times[k] - before < SHORTEST:
                continue
            before, j = times[k], min(k + later, len(times) - 1)
            cosine, sine = math.cos(found["root.yaw"][j]), math.sin(found["root.yaw"][j])
            forward, left = found["center.forward_velocity"][j], found["center.left_velocity"][j]
            ahead = found["center.forward"][j] - found[f"leg_{leg}.heel.position"][j]
            aside = found["center.left"][j] - found[f"leg_{leg}.heel.side_position"][j]
            turned = [sign * found["root.roll"][j], found["root.pitch"][j]]
            moved = [sign * (cosine * left - sine * forward), sign * (cosine * aside - sine * ahead)]
            rows.append([times[k], *turned, *moved, 0.0, cosine * forward + sine * left])
    table = np.array(sorted(rows)).reshape(-1, 7)
    table[:, 5] = np.diff(table[:, 0], prepend=np.nan)
    return table[:, 1:]
