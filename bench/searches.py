"""What workers cost and gain: one process and two workers, in turn, on evaluations of 10 and 100 ms."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import psutil
from rows import Report, Section

from gaitsim.cluster.evaluate import Serial, runner_of
from gaitsim.cluster.local import Local
from gaitsim.optimization.evaluation import Candidate
from gaitsim.optimization.search import Evaluator
from gaitsim.results.bundle import Bundle
from gaitsim.study.opening import Opening

SPEC = Path(__file__).resolve().parents[1] / "specs" / "pendulum_pid.yaml"
WORKERS = 2
GENERATIONS = 5
PAIRS = 3
ROWS = ((0.01, 16), (0.01, 64), (0.1, 16))
COLUMNS = {
    "serial": "ms",
    "worker": "ms",
    "speed-up": "1",
    "idle": "ms",
    "cost": "ms",
    "memory": "MB",
}
ABOUT = (
    f"Per evaluation, in one process and on {WORKERS} workers, which take turns ({GENERATIONS} generations, medians of "
    f"{PAIRS} pairs). The pendulum is simulated for as long as takes the time that is named; all candidates are the "
    "same, so that none waits for a longer one. Idle: what the workers' time, waits included, exceeds that of their "
    "evaluations by. Cost: processor time, of driver and workers together, beyond that of the one process. Memory: "
    "what a worker has for itself alone."
)


@dataclass(frozen=True)
class Measured:
    """Some generations: wall time, processor time of all processes, and the mean seconds of an evaluation."""

    wall: float
    processor: float
    seconds: float
    evaluations: int


def searches(report: Report) -> list[str]:
    """The table of workers."""
    report.begin(Section("Workers", COLUMNS, ABOUT))
    for seconds, population in ROWS:
        name = f"{1e3 * seconds:g} ms, population {population}"
        if report.has_time(name):
            report.add(name, _row(seconds, population))
    return []


def _row(seconds: float, population: int) -> dict[str, float]:
    bundle = _bundle(_duration(seconds))
    serial, local = Serial(runner_of(bundle, "rapid")), Local(bundle, "rapid", WORKERS)
    try:
        measured(local, population)  # how long an evaluation takes is learned
        pairs = [(measured(serial, population), measured(local, population)) for _ in range(PAIRS)]
        memory = max(_own_memory(worker) for worker in psutil.Process().children())
    finally:
        local.close()

    def median(of: Callable[[Measured, Measured], float]) -> float:
        return statistics.median(of(one, two) for one, two in pairs)

    return {
        "serial": median(lambda one, two: 1e3 * one.seconds),
        "worker": median(lambda one, two: 1e3 * two.seconds),
        "speed-up": median(lambda one, two: one.wall / two.wall),
        "idle": median(lambda one, two: 1e3 * (WORKERS * two.wall / two.evaluations - two.seconds)),
        "cost": median(lambda one, two: 1e3 * (two.processor - one.processor) / two.evaluations),
        "memory": memory / 1e6,
    }


def measured(evaluate: Evaluator, population: int) -> Measured:
    """Generations one after the other, as a search makes them."""
    seconds: list[float] = []
    processes = [psutil.Process(), *psutil.Process().children()]
    before, began = sum(map(_processor, processes)), time.perf_counter()
    for generation in range(GENERATIONS):
        candidates = [Candidate(generation, i, (60.0, 12.0)) for i in range(population)]
        seconds += [took for _, took, _ in evaluate(candidates)]
    wall = time.perf_counter() - began
    return Measured(wall, sum(map(_processor, processes)) - before, statistics.mean(seconds), len(seconds))


def _processor(process: psutil.Process) -> float:
    times = process.cpu_times()
    return float(times.user + times.system)


def _own_memory(process: psutil.Process) -> float:
    return float(process.memory_full_info().uss)


def _bundle(duration: float) -> Bundle:
    opened = Opening(SPEC, (f"simulate.duration={duration!r} s",), tuned=False).open()
    return opened.bundle([opened.model()])


def _duration(seconds: float) -> float:
    """How long to simulate, so that it takes so many seconds."""
    probe = 20.0
    (simulator,) = runner_of(_bundle(probe), "rapid").episodes.simulators
    took = statistics.median(simulator.run().wall_seconds for _ in range(5))
    return round(probe * seconds / took, 3)
