"""Results in notebooks: the record, and signals as labelled arrays."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.analysis.replays.replay import Replay, dataset
from gaitsim.model import Model
from gaitsim.optimization.history import GENERATIONS
from gaitsim.results.manifest import BadResult, read_manifest, result_named
from gaitsim.study.opened import Opened, open_result
from gaitsim.study.replays import replay_of

if TYPE_CHECKING:
    import pandas
    import xarray


@dataclass(frozen=True)
class Result:
    """A result folder and one of its candidates. Nothing is run before it is needed.

    >>> best = gaitsim.load("results/2026-11-22-hopping-3f9c")
    >>> best.metrics["apex_height"]
    >>> best.parameters()
    >>> signals = best.trajectory()
    >>> signals["extensor.force"].sel(time=slice(1, 2)).plot()

    Attributes:
        folder: The result folder.
        candidate: best, a rank or GENERATION:INDEX of a search; best or the number of a run of a study.
        trust: Whether to run components that this machine does not know.
    """

    folder: Path
    candidate: str = "best"
    trust: bool = False

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """Status, versions, machine, commit, command, and search.

        Raises:
            BadResult: The folder is not a result, or the result is damaged.
        """
        return read_manifest(self.folder)

    @cached_property
    def opened(self) -> Opened:
        """The spec, the components and the starts of the candidate.

        Raises:
            BadResult: The folder is not a result, or the result is damaged.
            Untrusted: The result has components that this machine does not trust.
            Usage: The request does not fit.
        """
        return open_result(self.folder, (), self.trust, self.candidate)

    @cached_property
    def model(self) -> Model:
        """The resolved model, started at the candidate. Raises the errors of `opened`."""
        return self.opened.model()

    @property
    def metrics(self) -> dict[str, float]:
        """The recorded metrics of the candidate, in the units of `model.metrics`; nan for a missing one."""
        recorded = self.opened.recorded.get("metrics", {})
        return {name: math.nan if value is None else float(value) for name, value in recorded.items()}

    @property
    def score(self) -> float:
        """The recorded cost of the candidate; nan if there is none."""
        score = self.opened.recorded.get("score")
        return math.nan if score is None else float(score)

    def parameters(self) -> pandas.DataFrame:
        """The tuned numbers by address: the value of the candidate, the unit, and the bounds of the search in that
        unit.
        """
        import pandas

        rows = {}
        for free in self.model.free:
            value, low, high = (free.unit.of(number) for number in (free.start, free.low, free.high))
            rows[free.address] = {"value": value, "unit": free.unit.text, "low": low, "high": high}
        frame = pandas.DataFrame.from_dict(rows, orient="index", columns=["value", "unit", "low", "high"])
        return frame.rename_axis("address")

    def history(self) -> pandas.DataFrame:
        """A row for each generation of a search: evaluations, scores (costs), failed candidates.

        Raises:
            BadResult: A run, or a search without a whole generation.
        """
        import pandas

        path = self.folder / GENERATIONS
        if self.manifest["kind"] != "optimize":
            raise BadResult(f"{self.folder}: this is the result of a run; only a search has a history.")
        try:
            with path.open(encoding="utf-8", newline="") as file:
                rows = [{name: _number(text) for name, text in row.items()} for row in csv.DictReader(file)]
            return pandas.DataFrame(rows).set_index("generation")
        except (OSError, ValueError, KeyError) as error:
            raise BadResult(f"{path}: this cannot be read ({error}); continue the search with --resume.") from error

    def replay(self, duration: float | None = None) -> Replay:
        """Run the candidate once more with every signal.

        A run that fails is a Replay up to its failure. Raises the errors of `opened`, and InvalidComponent.

        Args:
            duration: In seconds; that of the spec by default.
        """
        return replay_of(self.opened, self.folder, duration=duration)

    def trajectory(self, duration: float | None = None) -> xarray.Dataset:
        """Every output and state of the candidate's run, as labelled arrays over `time` in seconds.

        Each variable has the address of the signal as its name, and the attributes `units` and `long_name`. Numbers are
        in SI. The dataset has the attributes status, reason, notices and origin. Raises the errors of `replay`.

        Args:
            duration: In seconds; that of the spec by default.
        """
        return dataset(self.replay(duration))


def _number(text: str) -> float | int:
    """The number in a cell; nan if the cell is empty."""
    return int(text) if text.isdecimal() else float(text or math.nan)


def load(folder: str | Path, candidate: str = "best", trust: bool = False) -> Result:
    """Load a result.

    Args:
        folder: Its folder, or its name in the usual folder of results.
        candidate: best, a rank or GENERATION:INDEX of a search; best or the number of a run of a study.
        trust: Whether to run components that this machine does not know.

    Raises:
        BadResult: It is none, or is damaged.
    """
    made = Result(result_named(Path(folder)), str(candidate), trust)
    _ = made.manifest
    return made
