"""What a step costs, as a ratio to a bare mj_step loop in C on the same MuJoCo model.

`make bench` runs it for every spec. What is compared runs in alternating pairs within one run, and
medians are printed: ratios hold on a busy machine, times only roughly.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import mujoco
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from gaitsim.errors import GaitsimError
from gaitsim.parts.find import Library, library_folders
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

HERE = Path(__file__).resolve().parent
BUILD = HERE / "build"
PAIRS, NORMAL_PAIRS, STARTS = 9, 3, 5
# Each side of a pair runs at least this long, by repetition.
SECONDS = 0.3
# A whole run in plain Python can take minutes: both modes are compared on its beginning.
NORMAL_STEPS = 3000


@dataclass(frozen=True)
class Cost:
    """Nanoseconds per step of both sides, and the median, lowest and highest ratio of the pairs."""

    first: float
    second: float
    ratio: float
    low: float
    high: float


def cost_of(first: Callable[[], float], second: Callable[[], float], pairs: int) -> Cost:
    """Both sides in pairs; which one begins alternates."""
    found: list[tuple[float, float]] = []
    for pair in range(pairs):
        if pair % 2:
            b = second()
            a = first()
        else:
            a = first()
            b = second()
        found.append((a, b))
    ratios = [a / b for a, b in found]
    a, b = (statistics.median(side) for side in zip(*found, strict=True))
    return Cost(a, b, statistics.median(ratios), min(ratios), max(ratios))


def bare_loop() -> tuple[Path | None, str]:
    """The C program, built against what mujoco's wheel brings; or None and the reason."""
    names = [os.environ.get("CC", ""), "cc", "gcc", "clang"]
    compiler = next((name for name in names if name and shutil.which(name)), None)
    if compiler is None:
        return None, "No C compiler (cc, gcc, clang): there is no bare mj_step loop to compare with."
    folder = Path(mujoco.__file__).parent
    library = next(folder.glob("libmujoco.*"))
    program = BUILD / "bare_loop"
    options = ["-O2", f"-I{folder / 'include'}", f"-Wl,-rpath,{folder}", "-o", str(program)]
    command = [compiler, str(HERE / "bare_loop.c"), str(library), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        return None, f"bare_loop.c did not compile, so there is nothing to compare with:\n{done.stderr}"
    return program, ""


def per_step(simulator: Simulator, repeats: int) -> float:
    """Nanoseconds per step of whole runs: posing, tables, steps and metrics."""
    outcomes = [simulator.run() for _ in range(repeats)]
    return 1e9 * sum(o.wall_seconds for o in outcomes) / sum(o.steps for o in outcomes)


def repeats_of(simulator: Simulator) -> int:
    """How many runs fill one side of a pair."""
    return max(1, math.ceil(SECONDS / simulator.run().wall_seconds))


def steps_row(path: Path, program: Path | None) -> list[str]:
    """What a step of one spec costs: rapid against C, normal against rapid."""
    model = resolve(read_spec(path, []), Library(library_folders(path)), path.stem)
    rapid = Simulator(model)
    first = rapid.run()  # loads the kernels
    if first.status == "failed":
        return [path.stem, f"failed: {first.reason}"]
    repeats = repeats_of(rapid)
    row = [path.stem, f"{first.steps:,}"]
    if program:
        xml = BUILD / f"{path.stem}.xml"
        xml.write_text(rapid.xml, encoding="utf-8")
        command = [str(program), str(xml), str(first.steps), str(repeats)]

        def bare() -> float:
            return float(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)

        cost = cost_of(lambda: per_step(rapid, repeats), bare, PAIRS)
        row += [f"{cost.first:,.0f} ns", f"{cost.second:,.0f} ns"]
        row += [f"{cost.ratio:.2f}", f"{cost.low:.2f}-{cost.high:.2f}"]
    else:
        row += [f"{statistics.median(per_step(rapid, repeats) for _ in range(PAIRS)):,.0f} ns", "", "", ""]
    duration = min(first.steps, NORMAL_STEPS) * model.simulate.step
    short = replace(model, simulate=replace(model.simulate, duration=duration))
    normal, beginning = Simulator(short, "normal"), Simulator(short)
    repeats = repeats_of(beginning)
    cost = cost_of(lambda: per_step(normal, 1), lambda: per_step(beginning, repeats), NORMAL_PAIRS)
    return [*row, f"{cost.first / 1000:,.0f} µs", f"{cost.ratio:.0f}"]


def start_row(path: Path) -> list[str]:
    """Seconds before the first step, with everything compiled and with nothing."""
    with tempfile.TemporaryDirectory() as empty:
        # The loop itself is cached by numba, beside its source unless told otherwise.
        environment = os.environ | {"GAITSIM_CACHE": empty, "NUMBA_CACHE_DIR": f"{empty}/numba"}
        command = [sys.executable, str(HERE / "prepare.py"), str(path)]

        def start() -> list[float]:
            done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True)
            return [float(seconds) for seconds in json.loads(done.stdout)]

        cold = start()
        warm = [statistics.median(stage) for stage in zip(*(start() for _ in range(STARTS)), strict=True)]
    return [path.stem, *(f"{seconds:.2f} s" for seconds in (*warm, warm[1] + warm[2], cold[2]))]


def main() -> None:
    """Print both tables for every spec that has not been tuned from another."""
    console = Console(width=120)
    BUILD.mkdir(exist_ok=True)
    program, reason = bare_loop()
    steps = Table(title="One step", title_justify="left", box=SIMPLE_HEAD)
    columns = ["steps", "rapid", "bare loop", "rapid/bare", "range", "normal", "normal/rapid"]
    starts = Table(title="Before the first step", title_justify="left", box=SIMPLE_HEAD)
    stages = ["import", "resolve, warm", "prepare, warm", "both, warm", "prepare, cold"]
    for table, names in ((steps, columns), (starts, stages)):
        table.add_column("spec", no_wrap=True)
        for name in names:
            table.add_column(name, justify="right", no_wrap=True)
    broken: list[str] = []
    for path in sorted((HERE.parent / "specs").glob("*.yaml")):
        if path.name.endswith(".tuned.yaml"):
            continue
        try:
            steps.add_row(*steps_row(path, program))
            starts.add_row(*start_row(path))
        except GaitsimError as error:
            broken.append(f"{path.name} is left out: {error}")
    console.print(steps)
    if program:
        console.print(
            f"Medians of {PAIRS} alternating pairs; range: their lowest and highest ratio. The bare loop\n"
            "steps the same MJCF from its reference pose without muscles, control or virtual legs: the\n"
            "hopper falls for ever, and a model with ground contact meets other contacts."
        )
    console.print(
        "A rapid run counts whole: posing, steps, metrics. Normal against rapid: the first "
        f"{NORMAL_STEPS:,} steps, {NORMAL_PAIRS} pairs."
    )
    console.print(starts)
    console.print(
        f"Medians of {STARTS} new processes; prepare includes a run of one step. Cold: nothing compiled\n"
        "before, neither the components (GAITSIM_CACHE) nor the loop (NUMBA_CACHE_DIR)."
    )
    for line in filter(None, [reason, *broken]):
        console.print(line, markup=False, highlight=False)


if __name__ == "__main__":
    main()
