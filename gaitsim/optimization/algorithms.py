"""Search algorithms by name, each from a library, behind ask and tell: one entry each in `ALGORITHMS`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from gaitsim.errors import Usage

if TYPE_CHECKING:
    from gaitsim.optimization.problem import Problem, Vector


class Algorithm(Protocol):
    """Asks for vectors (divided by spreads), is told their costs, and says in words when it stops."""

    @property
    def population(self) -> int:
        """Candidates a generation."""

    def ask(self) -> list[Vector]: ...

    def tell(self, vectors: Sequence[Vector], costs: Sequence[float]) -> None: ...

    def stop(self) -> str | None: ...


@dataclass(frozen=True)
class Entry:
    """An algorithm that a spec or `--algorithm` can name.

    Attributes:
        factory: Makes it of a problem, a seed and the candidates a generation (None: its own choice).
        citations: What a paper cites that used it: keys of library/references.bib.
        extra: The extra of gaitsim that its library is in; empty if it is always installed.
    """

    name: str
    factory: Callable[[Problem, int, int | None], Algorithm]
    citations: tuple[str, ...]
    extra: str = ""

    def make(self, problem: Problem, seed: int, population: int | None) -> Algorithm:
        """The algorithm at its start.

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
    """One of pymoo's algorithms by the name of its class."""

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
