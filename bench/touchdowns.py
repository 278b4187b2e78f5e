"""What a walk in space is like shortly after each touchdown, in seven numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from gaitsim.simulation.outcome import Trajectory

# Differences of the seven numbers that are alike in size: rad, rad, rad, m/s, m, s, m/s.
SCALES = np.array([0.12, 0.06, 0.08, 0.1, 0.04, 0.05, 0.12])
SHORTEST = 0.5  # s: between touchdowns of one foot
LATER = 0.1  # s: from a touchdown to the instant that is looked at


def touchdowns(found: Trajectory) -> Any:
    """Yaw, roll and pitch of the pelvis, lateral velocity of the center of mass, its distance to the side of the new
    foot, duration of the step, and speed. Lateral numbers are mirrored on the left.

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
            aside = found["center.left"][j] - found[f"leg_{leg}.heel.side_position"][j]
            turned = [sign * found[f"root.{name}"][j] for name in ("yaw", "roll")]
            moved = [sign * found["center.left_velocity"][j], sign * aside]
            rows.append([times[k], *turned, found["root.pitch"][j], *moved, 0.0, found["center.forward_velocity"][j]])
    table = np.array(sorted(rows)).reshape(-1, 8)
    table[:, 6] = np.diff(table[:, 0], prepend=np.nan)
    return table[:, 1:]
