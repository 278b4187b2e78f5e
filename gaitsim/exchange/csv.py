"""Trajectories as CSV: time and every signal, with units in the heading."""

from __future__ import annotations

from pathlib import Path

from gaitsim.exchange.rows import write_table
from gaitsim.simulation.outcome import Trajectory


def write_csv(path: Path, trajectory: Trajectory) -> None:
    """Write `time [s],guide.position [m],...` with exact numbers in SI.

    Raises:
        OSError: The file cannot be written.
    """
    named = [f"{s} [{u}]" for s, u in zip(trajectory.signals, trajectory.units, strict=True)]
    write_table(path, ",".join(["time [s]", *named]) + "\n", trajectory, ",")
