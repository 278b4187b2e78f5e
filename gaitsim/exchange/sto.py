"""Trajectories as OpenSim's storage file (.sto), which its TimeSeriesTable and its plotter read."""

from __future__ import annotations

from pathlib import Path

from gaitsim.exchange.rows import write_table
from gaitsim.simulation.outcome import Trajectory


def write_sto(path: Path, trajectory: Trajectory, name: str) -> None:
    """Write signals under their addresses, with exact numbers in SI (angles in radians).

    The header has a key `unit.ADDRESS` for each column, which OpenSim keeps as metadata.

    Raises:
        OSError: The file cannot be written.
    """
    units = [f"unit.{s}={u}" for s, u in zip(trajectory.signals, trajectory.units, strict=True)]
    head = [
        name,
        "inDegrees=no",
        f"nColumns={len(trajectory.signals) + 1}",
        f"nRows={trajectory.times.size}",
        *units,
        "DataType=double",
        "version=3",
        "endheader",
        "\t".join(["time", *trajectory.signals]),
    ]
    write_table(path, "\n".join(head) + "\n", trajectory, "\t")
