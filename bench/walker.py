"""What the walker takes: `python bench/walker.py contacts|seeds|middle|swaps`, or `make walker` for all of them.

contacts  the published gains and pose on each contact model, at 1, 0.5 and 0.25 ms: no tuning.
seeds     `gaitsim optimize specs/walking_geyer2010.yaml --seed N` from the published gains: evaluations, generations
          and wall time to the first walk of 10 s, of the whole run, and of the whole run at 1.2 to 1.4 m/s.
middle    the same from the middle of all bounds (`--from middle`).
swaps     another muscle model for all 14, another contact for all four points, by one `--set`: the archived values
          as they are, and tuned again from there (`--from tuned`) over 10 s; what is shown is 20 s.

Searches run in a temporary folder, on all cores; those for a first walk end when it is seen.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

SPEC = Path(__file__).resolve().parents[1] / "specs" / "walking_geyer2010.yaml"
CONTACTS = ("hunt_crossley", "geyer2010", "yielding_sole", "mujoco")
STEPS = ("1 ms", "0.5 ms", "0.25 ms")
SOFT = "use_for.contact.depth=5 mm"  # two points of one foot: together as deep as one of 1 cm
SWAPS: Mapping[str, tuple[str, ...]] = {
    "contact/geyer2010": ("use_for.contact.use=contact/geyer2010",),
    "contact/yielding_sole": ("use_for.contact.use=contact/yielding_sole", SOFT),
    "contact/mujoco": ("use_for.contact.use=contact/mujoco",),
    "muscle/millard2012": ("use_for.muscle.use=muscle/millard2012",),
    "muscle/degroote2016": ("use_for.muscle.use=muscle/degroote2016",),
    "muscle/rigid_tendon": ("use_for.muscle.use=muscle/rigid_tendon",),
    "muscle/geyer2003": ("use_for.muscle.use=muscle/geyer2003", "simulate.step=0.1 ms"),
}
SHOWN = {
    "fall_time": "walks, s",
    "speed": "m/s",
    "stance_fraction": "stance",
    "force_peaks_r": "peak, BW",
    "peak_knee_flexion": "knee, deg",
    "cost_of_transport": "J/(kg m)",
    "correlation_hip": "r hip",
    "correlation_knee": "r knee",
    "correlation_ankle": "r ankle",
}


@dataclass(frozen=True)
class Seen:
    """When something was first seen in a search."""

    evaluations: int
    generations: int
    seconds: float


Goal = Callable[[Mapping[str, Any]], bool]


def walks(seconds: float, low: float = 0.6, high: float = 10.0) -> Goal:
    """Whether a candidate stays up for so long while it gets on, and does not stand or crawl."""

    def reached(metrics: Mapping[str, Any]) -> bool:
        long, speed = metrics.get("fall_time") or 0.0, metrics.get("speed") or 0.0
        return long >= seconds - 1e-6 and low <= speed <= high

    return reached


GOALS = {"10 s": walks(10), "20 s": walks(20), "20 s at 1.2 to 1.4 m/s": walks(20, 1.2, 1.4)}


def said(metrics: Mapping[str, Any]) -> list[str]:
    """The cells of a table for one walk."""
    values = (metrics.get(name, math.nan) for name in SHOWN)
    return ["-" if math.isnan(value) else f"{value:.3g}" for value in values]


def contacts(_: argparse.Namespace, console: Console) -> None:
    """Published gains and pose on each contact, at each step."""
    table = Table("contact", "step", *SHOWN.values(), title="Published gains and pose, not tuned")
    for contact in CONTACTS:
        for step in STEPS:
            used = [f"use_for.contact.use=contact/{contact}", f"simulate.step={step}"]
            used += [SOFT] if contact == "yielding_sole" else []
            found = Simulator(Opening(SPEC, tuple(used), tuned=False).open().model()).run()
            table.add_row(contact, step, *said(found.metrics))
    console.print(table)


def journal(folder: Path, search: subprocess.Popen[str]) -> Iterator[dict[str, Any]]:
    """The evaluations of a search, in order, generation by generation as they are written; ends with the search."""
    read, over = 0, False
    while not over:
        over = search.poll() is not None
        for path in folder.glob("results/*/evaluations.jsonl"):
            lines = [line for line in path.read_text().splitlines() if line.endswith("}")]
            yield from (json.loads(line) for line in lines[read:])
            read = len(lines)
        time.sleep(0.05)


def first_walks(arguments: Sequence[str]) -> dict[str, Seen | None]:
    """Run a search until every goal is reached, or to its end."""
    found: dict[str, Seen | None] = dict.fromkeys(GOALS)
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "gaitsim.cli.main", "optimize", str(SPEC), *arguments]
        began = time.perf_counter()
        with subprocess.Popen(
            command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, text=True
        ) as search:
            for count, row in enumerate(journal(Path(folder), search), 1):
                for name in (n for n, seen in found.items() if seen is None and GOALS[n](row["metrics"])):
                    found[name] = Seen(count, row["generation"], time.perf_counter() - began)
                if all(found.values()):
                    search.terminate()
                    break
    return found


def searches(options: argparse.Namespace, console: Console, title: str, *more: str) -> None:
    """First walks of several seeds, and their medians."""
    table = Table("seed", *GOALS, title=f"{title}: evaluations / generations / seconds of wall time")
    every = []
    for seed in range(1, options.seeds + 1):
        found = first_walks(["--seed", str(seed), "--generations", str(options.generations), *more])
        every.append(found)
        cells = ("-" if s is None else f"{s.evaluations} / {s.generations} / {s.seconds:.1f}" for s in found.values())
        table.add_row(str(seed), *cells)
    middle = (
        statistics.median([s.seconds if s else float("inf") for s in each])
        for each in zip(*(found.values() for found in every), strict=True)
    )
    table.add_row("median, s", *(f"{m:.1f}" for m in middle))
    console.print(table)


def seeds(options: argparse.Namespace, console: Console) -> None:
    """From the published gains and pose."""
    searches(options, console, "From the published gains")


def middle(options: argparse.Namespace, console: Console) -> None:
    """From the middle of all bounds, with spreads three times as wide."""
    searches(options, console, "From the middle of all bounds", "--from", "middle", "--set", "optimize.spread_factor=3")


def swaps(options: argparse.Namespace, console: Console) -> None:
    """Another model for one kind of part: the archived values, and values tuned again from them."""
    table = Table("swap", "evaluations", *SHOWN.values(), title="Archived values with another model, then tuned again")
    for name, settings in SWAPS.items():
        before = Simulator(Opening(SPEC, tuple(settings)).open().model()).run()
        table.add_row(name, "0", *said(before.metrics))
        with tempfile.TemporaryDirectory() as folder:
            evaluations, after = retuned(settings, options, options.keep or folder)
        table.add_row("" if after else "no candidate runs", str(evaluations), *said(after))
    console.print(table)


def retuned(settings: Sequence[str], options: argparse.Namespace, folder: str) -> tuple[int, Mapping[str, Any]]:
    """Evaluations of a search over 10 s of walking, and what its best candidate does in 20 s; nothing if all fail."""
    used = [*settings, "simulate.duration=10 s", f"optimize.spread_factor={options.spread_factor}"]
    command = [sys.executable, "-m", "gaitsim.cli.main", "optimize", str(SPEC), "--from", "tuned", "--json"]
    command += ["--generations", str(options.generations), *(word for setting in used for word in ("--set", setting))]
    ran = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True, check=False)
    search = json.loads(ran.stdout)
    if ran.returncode:
        return search.get("evaluations", 0), {}
    opened = Opening(Path(folder) / search["result"], ("simulate.duration=20 s",)).open()
    return search["evaluations"], Simulator(opened.model()).run().metrics


TABLES = {"contacts": contacts, "seeds": seeds, "middle": middle, "swaps": swaps}


def main() -> None:
    """Print the tables that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", default=list(TABLES), choices=TABLES)
    parser.add_argument("--seeds", type=int, default=10, help="of seeds and middle, from 1 on")
    parser.add_argument("--generations", type=int, default=60, help="of each search, at most")
    parser.add_argument("--spread-factor", type=float, default=1.0, help="of swaps")
    parser.add_argument("--keep", metavar="FOLDER", help="where results of swaps are kept; unless given, nowhere")
    options = parser.parse_args()
    for name in options.tables:
        TABLES[name](options, Console(width=150))


if __name__ == "__main__":
    main()
