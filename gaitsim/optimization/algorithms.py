"""Search algorithms by name, with one entry each in `ALGORITHMS`. All have the interface ask and tell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from gaitsim.errors import Usage

if TYPE_CHECKING:
    from gaitsim.optimization.problem import Problem, Vector


class Algorithm(Protocol):
    """A search algorithm. It proposes vectors (divided by spreads), receives their costs, and may stop with a
    reason.
    """

    @property
    def population(self) -> int:
        """The number of candidates per generation."""

    def ask(self) -> list[Vector]: ...

    def tell(self, vectors: Sequence[Vector], costs: Sequence[float]) -> None: ...

    def stop(self) -> str | None: ...


@dataclass(frozen=True)
class Entry:
    """An algorithm that a spec or `--algorithm` can name.

    Attributes:
        factory: Makes the algorithm from a problem, a seed and the number of candidates per generation (None: its own
            default).
        citations: Keys of library/references.bib that a paper should cite.
        extra: The extra of gaitsim with its library; empty if the library is always installed.
    """

    name: str
    factory: Callable[[Problem, int, int | None], Algorithm]
    citations: tuple[str, ...]
    extra: str = ""

    def make(self, problem: Problem, seed: int, population: int | None) -> Algorithm:
        """Make the algorithm at its start.

        Args:
            problem: The problem.
            seed: The seed.
            population: The number of candidates per generation; None for the algorithm's default.

        Raises:
            Usage: Its library is not installed.
        """
        try:
            return self.factory(problem, seed, population)
        except ImportError as error:
            library = (error.name or self.extra).partition(".")[0]
            rule = f"--algorithm {self.name}: needs {library}, which is not installed"
            raise Usage(f"{rule}; install it: pip install 'gaitsim[{self.extra}]'.") from error


def _cma_es(problem: Problem, seed: int, population: int | None) -> Algorithm:
    from gaitsim.optimization.cma_es import CmaEs

    return CmaEs(problem, seed, population)


def _pymoo(kind: str) -> Callable[[Problem, int, int | None], Algorithm]:
    """The factory of one of pymoo's algorithms, given the name of its class."""

    def factory(problem: Problem, seed: int, population: int | None) -> Algorithm:
        from gaitsim.optimization.populations import Pymoo

        return Pymoo(kind, problem, seed, population)

    return factory


_ENTRIES = (
    Entry("cma", _cma_es, ("hansen2001", "hansen2019")),
    Entry("ga", _pymoo("GA"), ("blank2020",), "populations"),
    Entry("pso", _pymoo("PSO"), ("kennedy1995", "blank2020"), "populations"),
    Entry("de", _pymoo("DE"), ("storn1997", "blank2020"), "populations"),
)
ALGORITHMS = {entry.name: entry for entry in _ENTRIES}
DEFAULT = _ENTRIES[0].name
