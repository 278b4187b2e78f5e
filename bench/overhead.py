"""What workers cost and gain: `python bench/overhead.py`.

Speed-up of two workers over one process at 100 ms a candidate, and the overhead of an evaluation,
(workers x wall - sum of evaluation times) / N, at 10 and 100 ms. The pendulum is simulated for as
long as takes that time here; the candidates are all the same, so that none waits for a longer one.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from gaitsim.cli.source import source_of_spec
from gaitsim.cluster import connect
from gaitsim.cluster.evaluate import Serial, bench_of
from gaitsim.cluster.parallel import Parallel
from gaitsim.optimization.evaluation import Candidate
from gaitsim.results.bundle import Bundle

SPEC = Path(__file__).resolve().parents[1] / "specs" / "pendulum_pid.yaml"
WORKERS = 2
GENERATIONS = 5
REPEATS = 3


@dataclass(frozen=True)
class Measured:
    """Some generations: wall time, and the seconds that each evaluation took."""

    wall: float
    seconds: Sequence[float]

    def overhead(self, workers: int) -> float:
        return (workers * self.wall - sum(self.seconds)) / len(self.seconds)


def bundle_of(duration: float) -> Bundle:
    source = source_of_spec(SPEC, [f"simulate.duration={duration!r} s"], None, tuned=False)
    return source.bundle([source.model()])


def duration_of(seconds: float) -> float:
    """How long to simulate, so that it takes so many seconds."""
    probe = 20.0
    simulator = bench_of(bundle_of(probe), "rapid").simulator
    took = statistics.median(simulator.run().wall_seconds for _ in range(5))
    return round(probe * seconds / took, 3)


def measured(evaluate: Any, population: int) -> Measured:
    """Generations one after the other, as a search makes them."""
    seconds: list[float] = []
    began = time.perf_counter()
    for generation in range(GENERATIONS):
        candidates = [Candidate(generation, i, (60.0, 12.0)) for i in range(population)]
        seconds += [took for _, took, _ in evaluate(candidates)]
    return Measured(time.perf_counter() - began, seconds)


def rows(client: Any, seconds: float, population: int) -> list[tuple[str, ...]]:
    """One process and workers, in turn, so that what else this machine does touches both."""
    bundle = bundle_of(duration_of(seconds))
    serial, parallel = Serial(bench_of(bundle, "rapid")), Parallel(client, bundle, "rapid")
    measured(parallel, population)  # compiled, and the size of tasks is learned
    pairs = [(measured(serial, population), measured(parallel, population)) for _ in range(REPEATS)]
    found = []
    for one, two in pairs:
        mean = 1e3 * statistics.mean(two.seconds)
        numbers = (1e3 * statistics.mean(one.seconds), mean, one.wall / two.wall, 1e3 * two.overhead(WORKERS))
        found.append((f"{seconds * 1e3:g} ms", str(population), *(f"{number:.2f}" for number in numbers)))
    return found


def main() -> None:
    title = f"{WORKERS} workers, {GENERATIONS} generations, {REPEATS} times"
    table = Table(title=title, title_justify="left", box=None)
    columns = ("asked", "population", "serial ms", "worker ms", f"speed-up of {WORKERS}", "overhead ms/evaluation")
    for column in columns:
        table.add_column(column, justify="right")
    client = connect.local_client(WORKERS)
    try:
        for seconds, population in ((0.01, 16), (0.01, 64), (0.1, 16)):
            for row in rows(client, seconds, population):
                table.add_row(*row)
    finally:
        cluster = client.cluster
        client.close()
        cluster.close()
    Console().print(table)


if __name__ == "__main__":
    main()
