"""A trajectory as CSV: time and every signal, each with its unit in the heading."""

from __future__ import annotations

from pathlib import Path

from gaitsim.exchange.rows import write_table
from gaitsim.simulation.outcome import Trajectory


def write_csv(path: Path, trajectory: Trajectory) -> None:
    """Write `time [s],guide.position [m],...`; numbers in SI, exactly.

    Raises:
        OSError: The file cannot be read or written.
    """
    named = [f"{s} [{u}]" for s, u in zip(trajectory.signals, trajectory.units, strict=True)]
    write_table(path, ",".join(["time [s]", *named]) + "\n", trajectory, ",")
