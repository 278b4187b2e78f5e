"""Every muscle model on the leg-mass hopper, each by one line and tuned by one command: `make muscles`.

`python bench/muscle_models.py [--generations N] [--population N] [--workers N] [--out FILE.csv]`

The line is `--set extensor.use=muscle/NAME`, the command `gaitsim optimize`. Heights are mean apexes of the last
hops above standing, without and with tuning; the work is what the fiber gives and what it takes in one hop; the wall
time is that of one simulation of 6 s, the least of five. Results are kept nowhere: the searches run in a
temporary folder.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

SPEC = Path(__file__).resolve().parents[1] / "specs" / "hopping_leg_mass.yaml"
REPEATS = 5


@dataclass(frozen=True)
class Row:
    """What one muscle model does on the hopper."""

    muscle: str
    start_height_m: float
    tuned_height_m: float
    hops: float
    work_given_per_hop_J: float
    work_taken_per_hop_J: float
    evaluations: int
    failed: int
    simulation_s: float
    search_s: float


def tuned(muscle: str, arguments: Sequence[str]) -> Row:
    """Tune the hopper with one muscle, in a temporary folder, and look at the best candidate."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "gaitsim.cli.main", "optimize", str(SPEC), "--set", f"extensor.use={muscle}"]
        ran = subprocess.run(
            [*command, *arguments, "--json"], cwd=folder, stdout=subprocess.PIPE, text=True, check=True
        )
        search = json.loads(ran.stdout)
        simulator = Simulator(Opening(Path(folder) / search["result"]).open().model())
    before = Simulator(Opening(SPEC, (f"extensor.use={muscle}",), tuned=False).open().model()).run()
    after = simulator.run(recorded=True)
    given, taken = work_per_hop(after)
    return Row(
        muscle,
        before.metrics.get("hop", float("nan")),
        after.metrics.get("hop", float("nan")),
        after.metrics.get("hop.hops", float("nan")),
        given,
        taken,
        search["evaluations"],
        search["failed"],
        min(simulator.run().wall_seconds for _ in range(REPEATS)),
        search["wall_seconds"],
    )


def work_per_hop(outcome: Outcome) -> tuple[float, float]:
    """What the fiber gives and takes in one hop, in J: its force times its shortening velocity."""
    made = outcome.trajectory
    if made is None or not outcome.metrics.get("hop.hops"):
        return float("nan"), float("nan")
    power = -made["extensor.fiber_force"] * made["extensor.fiber_velocity"]
    hops = outcome.metrics["hop.hops"]
    given, taken = (float(np.trapezoid(np.maximum(0, sign * power), made.times)) / hops for sign in (1, -1))
    return given, taken


def show(rows: Sequence[Row]) -> None:
    """The table, for people."""
    names = [field.name for field in fields(Row)]
    table = Table(title=f"{SPEC.stem}: muscle models", title_justify="left", box=None)
    for name in names:
        table.add_column(name.replace("_", " "), justify="left" if name == "muscle" else "right")
    for row in rows:
        values = asdict(row)
        table.add_row(*(v if isinstance(v, str) else f"{v:.4g}" for v in (values[name] for name in names)))
    Console(width=None if sys.stdout.isatty() else 180).print(table)


def main() -> None:
    asked = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    asked.add_argument("--generations", type=int)
    asked.add_argument("--population", type=int)
    asked.add_argument("--workers", type=int, default=os.cpu_count())
    asked.add_argument("--out", type=Path, help="also write the table to this CSV file")
    options = asked.parse_args()
    given = {name: getattr(options, name) for name in ("generations", "population", "workers")}
    arguments = [word for name, value in given.items() if value is not None for word in (f"--{name}", str(value))]
    rows = [tuned(muscle, arguments) for muscle in Library((shipped_folder(),)).references("muscle")]
    show(rows)
    if options.out:
        with options.out.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, [field.name for field in fields(Row)])
            writer.writeheader()
            writer.writerows(asdict(row) for row in rows)


if __name__ == "__main__":
    main()
