"""What a step costs, as a ratio to a bare mj_step loop in C on the same MuJoCo model."""

from __future__ import annotations

import math
import os
import shutil
import statistics
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import mujoco
from rows import Report, Section

from gaitsim.components.find import Library, library_folders
from gaitsim.model import Model
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

HERE = Path(__file__).resolve().parent
HOPPERS, WALKERS = ("hopping_geyer2003", "hopping_leg_mass"), ("walking_geyer2010", "walking_geyer2010_mujoco_contact")
SPECS = ("pendulum_pid", *HOPPERS, *WALKERS)
PAIRS, SECONDS = 5, 0.3
NORMAL_STEPS = 1000
STEPS = Section(
    "One step",
    {"rapid": "ns", "bare": "ns", "rapid/bare": "1", "lowest": "1", "highest": "1", "normal/rapid": "1", "speed": "1"},
    f"Medians of {PAIRS} alternating pairs of at least {SECONDS} s, with the lowest and highest ratio of a pair. A "
    "rapid run counts whole: posing, steps, metrics. The bare loop is C that calls `mj_step` on the same MJCF from its "
    "reference pose without muscles and control. Normal mode is compared with rapid mode on the first "
    f"{NORMAL_STEPS:,} steps. Speed is simulated time over wall time.",
)


def read(name: str) -> Model:
    """The model of a shipped spec."""
    path = HERE.parent / "specs" / f"{name}.yaml"
    return resolve(read_spec(path, []), Library(library_folders(path)), name)


def ratios(first: Callable[[], float], second: Callable[[], float]) -> list[tuple[float, float]]:
    """Both sides in pairs; which one begins alternates."""
    found = []
    for pair in range(PAIRS):
        if pair % 2:
            b = second()
            a = first()
        else:
            a = first()
            b = second()
        found.append((a, b))
    return found


def per_step(simulator: Simulator, repeats: int = 1) -> float:
    """Nanoseconds per step of whole runs."""
    outcomes = [simulator.run() for _ in range(repeats)]
    return 1e9 * sum(o.wall_seconds for o in outcomes) / sum(o.steps for o in outcomes)


def repeats_of(simulator: Simulator) -> int:
    """How many runs fill one side of a pair."""
    return max(1, math.ceil(SECONDS / simulator.run().wall_seconds))


def bare_loop() -> tuple[Path | None, str]:
    """The C program, built against what mujoco's wheel brings; or None and the reason."""
    names = [os.environ.get("CC", ""), "cc", "gcc", "clang"]
    compiler = next((name for name in names if name and shutil.which(name)), None)
    if compiler is None:
        return None, "No C compiler (cc, gcc, clang): there is no bare mj_step loop to compare with."
    build = HERE / "build"
    build.mkdir(exist_ok=True)
    folder, program = Path(mujoco.__file__).parent, build / "bare_loop"
    library = next(folder.glob("libmujoco.*"))
    options = ["-O2", f"-I{folder / 'include'}", f"-Wl,-rpath,{folder}", "-o", str(program)]
    command = [compiler, str(HERE / "bare_loop.c"), str(library), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        return None, f"bare_loop.c did not compile, so there is nothing to compare with:\n{done.stderr}"
    return program, ""


def steps(report: Report) -> Iterator[str]:
    """Rows of the shipped specs; yields what could not be measured."""
    report.begin(STEPS)
    program, reason = bare_loop()
    if reason:
        yield reason
    for name in SPECS:
        if report.has_time(name):
            yield from _row(report, name, program)


def _row(report: Report, name: str, program: Path | None) -> Iterator[str]:
    model = read(name)
    rapid = Simulator(model)
    first = rapid.run()  # compiled and loaded by now
    if first.status == "failed":
        yield f"{name} failed: {first.reason}"
        return
    repeats = repeats_of(rapid)
    if program:
        xml = program.with_name(f"{name}.xml")
        xml.write_text(rapid.xml, encoding="utf-8")
        command = [str(program), str(xml), str(first.steps), str(repeats)]
        pairs = ratios(lambda: per_step(rapid, repeats), lambda: float(subprocess.check_output(command)))
        found = [a / b for a, b in pairs]
        values = {"rapid": statistics.median(a for a, _ in pairs), "bare": statistics.median(b for _, b in pairs)}
        values |= {"rapid/bare": statistics.median(found), "lowest": min(found), "highest": max(found)}
    else:
        values = {"rapid": statistics.median(per_step(rapid, repeats) for _ in range(PAIRS))}
    duration = min(first.steps, NORMAL_STEPS) * model.simulate.step
    short = replace(model, simulate=replace(model.simulate, duration=duration))
    values["normal/rapid"] = per_step(Simulator(short, "normal")) / per_step(Simulator(short), 10)
    values["speed"] = 1e9 * model.simulate.step / values["rapid"]
    report.add(name, values)
