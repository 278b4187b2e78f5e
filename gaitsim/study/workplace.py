"""Where candidates are evaluated: in this process, in processes of this machine, or on the workers of a scheduler."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from gaitsim.cluster.time_limits import TimeLimits
from gaitsim.errors import Usage
from gaitsim.optimization.search import Evaluator
from gaitsim.results.bundle import Bundle
from gaitsim.simulation.run import Mode


@dataclass(frozen=True)
class Workplace:
    """The options --workers, --cluster, --scheduler and --scheduler-file."""

    workers: int | None
    cluster: bool
    scheduler: str | None
    scheduler_file: Path | None

    def check(self) -> None:
        """Check that the options fit together.

        Raises:
            Usage: The request does not fit.
        """
        if not self.cluster and (self.scheduler is not None or self.scheduler_file is not None):
            raise Usage("--scheduler and --scheduler-file say where a cluster is; add --cluster.")
        if self.cluster and not (self.scheduler or self.scheduler_file):
            raise Usage("--cluster needs --scheduler tcp://host:port or --scheduler-file FILE.")
        if self.scheduler is not None and self.scheduler_file is not None:
            raise Usage("--scheduler and --scheduler-file name two places; leave one out.")
        if self.cluster and self.workers is not None:
            raise Usage("--workers starts processes here; leave it out with --cluster.")
        if self.workers is not None and self.workers < 0:
            raise Usage(f"--workers {self.workers}: a number of processes, or 0 for this one.")

    @property
    def arguments(self) -> list[str]:
        """The options that describe this workplace."""
        named = {"--workers": self.workers, "--scheduler": self.scheduler, "--scheduler-file": self.scheduler_file}
        options = [word for option, value in named.items() if value is not None for word in (option, str(value))]
        return ["--cluster", *options] if self.cluster else options

    def evaluator(self, task: Task, say: Callable[[str], None]) -> Evaluator:
        """Make the evaluator of a bundle's candidates.

        Raises:
            ClusterError: The cluster fails or cannot be reached.
        """
        backend = next(backend for backend in BACKENDS if backend.asked(self))
        return backend.make(self, task, say)


@dataclass(frozen=True)
class Task:
    """What is evaluated: candidates of a bundle, in a mode, with a time limit for each."""

    bundle: Bundle
    mode: Mode
    time_limits: TimeLimits = field(default_factory=TimeLimits)


@dataclass(frozen=True)
class Backend:
    """A way to evaluate candidates: whether a workplace asks for it, and how to make its evaluator."""

    asked: Callable[[Workplace], bool]
    make: Callable[[Workplace, Task, Callable[[str], None]], Evaluator]


def _dask(place: Workplace, task: Task, say: Callable[[str], None]) -> Evaluator:
    from gaitsim.cluster.connect import remote_client
    from gaitsim.cluster.parallel import Parallel

    client = remote_client(place.scheduler, place.scheduler_file, say)
    return Parallel(client, task.bundle, task.mode, task.time_limits)


def _this_process(_: Workplace, task: Task, __: Callable[[str], None]) -> Evaluator:
    from gaitsim.cluster.evaluate import Serial, runner_of

    return Serial(runner_of(task.bundle, task.mode))


def _processes(place: Workplace, task: Task, _: Callable[[str], None]) -> Evaluator:
    from gaitsim.cluster.local import Local
    from gaitsim.simulation.threads import cores

    return Local(task.bundle, task.mode, place.workers or cores(), task.time_limits)


BACKENDS = (  # the first one that applies is used
    Backend(lambda place: place.cluster, _dask),
    Backend(lambda place: place.workers == 0, _this_process),
    Backend(lambda _: True, _processes),
)
