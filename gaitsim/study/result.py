"""A result in a notebook: its record, and its signals as labelled arrays."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.analysis.replays.replay import Replay, dataset
from gaitsim.model import Model
from gaitsim.results.manifest import BadResult, read_manifest, result_named
from gaitsim.study.opened import Opened, open_result
from gaitsim.study.replays import replay_of

if TYPE_CHECKING:
    import pandas
    import xarray


@dataclass(frozen=True)
class Result:
    """A result folder and one of its candidates; nothing is run before something is asked for.

    >>> best = gaitsim.load("results/2026-11-22-hopping-3f9c") >>> best.metrics["apex_height"] >>> best.parameters() >>>
    signals = best.trajectory() >>> signals["extensor.force"].sel(time=slice(1, 2)).plot()

    Attributes:
        candidate: Best, a rank, or GENERATION:INDEX of a search; of a study best, or the number of a run.
        trust: Run components that this machine does not know.
    """

    folder: Path
    candidate: str = "best"
    trust: bool = False

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """Status, versions, machine, commit, command, search.

        Raises:
            BadResult: The folder is not a result, or the result is damaged.
        """
        return read_manifest(self.folder)

    @cached_property
    def opened(self) -> Opened:
        """Spec, components and starts of the candidate.

        Raises:
            BadResult: The folder is not a result, or the result is damaged.
            Untrusted: The result has components that this machine does not trust.
            Usage: The request does not fit.
        """
        return open_result(self.folder, (), self.trust, self.candidate)

    @cached_property
    def model(self) -> Model:
        """The resolved model, started at the candidate. Errors: as `source`, InvalidSpec."""
        return self.opened.model()

    @property
    def metrics(self) -> dict[str, float]:
        """The candidate's metrics as they were recorded, in the units of `model.metrics`; nan for none."""
        recorded = self.opened.recorded.get("metrics", {})
        return {name: math.nan if value is None else float(value) for name, value in recorded.items()}

    @property
    def score(self) -> float:
        """The candidate's cost as it was recorded; nan for none."""
        score = self.opened.recorded.get("score")
        return math.nan if score is None else float(score)

    def parameters(self) -> pandas.DataFrame:
        """The tuned numbers by address: value of the candidate, its unit, and the bounds of the search in that unit."""
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

        path = self.folder / "generations.csv"
        if self.manifest["kind"] != "optimize":
            raise BadResult(f"{self.folder}: this is the result of a run; only a search has a history.")
        try:
            with path.open(encoding="utf-8", newline="") as file:
                rows = [{name: _number(text) for name, text in row.items()} for row in csv.DictReader(file)]
            return pandas.DataFrame(rows).set_index("generation")
        except (OSError, ValueError, KeyError) as error:
            raise BadResult(f"{path}: this cannot be read ({error}); continue the search with --resume.") from error

    def replay(self, duration: float | None = None) -> Replay:
        """The candidate run once more with every signal; `duration` in seconds, if not the spec's.

        Errors: as `model`, InvalidComponent. A run that fails is a Replay up to its failure.
        """
        return replay_of(self.opened, self.folder, duration=duration)

    def trajectory(self, duration: float | None = None) -> xarray.Dataset:
        """Every output and state of the candidate's run as labelled arrays over `time` in seconds.

        Each variable has the signal's address as its name, and `units` and `long_name` as attributes;
        numbers are SI. Attributes of the whole: status, reason, notices, origin.
        Errors: as `replay`.
        """
        return dataset(self.replay(duration))


def _number(text: str) -> float | int:
    """A cell of a table; nan if it is empty.

    Raises:
        ValueError: The expression has no value.
    """
    return int(text) if text.isdecimal() else float(text or math.nan)


def load(folder: str | Path, candidate: str = "best", trust: bool = False) -> Result:
    """A result by its folder, or by its name in the usual one.

    Raises:
        BadResult: It is none, or is damaged.
    """
    made = Result(result_named(Path(folder)), str(candidate), trust)
    _ = made.manifest
    return made
