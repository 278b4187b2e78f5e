"""How far numbers of a spec can go until runs end: many at once, each in its own runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from gaitsim.errors import Fault, Mark, SimulationFailed, Usage, did_you_mean
from gaitsim.model import Model
from gaitsim.optimization.limit import Bracket
from gaitsim.simulation.batch import run_all
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode
from gaitsim.spec.inheritance import override, split_setting
from gaitsim.spec.study import Span, span
from gaitsim.study.keeping import Keeping
from gaitsim.study.listening import Listener
from gaitsim.study.opening import Opening, only_row, started_from
from gaitsim.study.source import Source
from gaitsim.text.document import Mapping as Document
from gaitsim.text.quantity import BadQuantity, quantity_of
from gaitsim.units import parse_unit, with_unit

_FINEST = 1e-6


@dataclass(frozen=True)
class Until:
    """What ends the range of a number: that runs do not complete, or that a metric comes to a value.

    value: in the metric's unit.
    """

    metric: str = ""
    value: float = math.nan
    unit: str = "1"

    def holds(self, outcome: Outcome, at_first: Outcome) -> bool:
        """Whether a run is still as it was at the first end; a failed run never is."""
        if outcome.status == "failed" or not self.metric:
            return outcome.status == "completed"
        side = self._distance(at_first)
        return side * self._distance(outcome) > 0

    def said(self, outcome: Outcome) -> str:
        """How a run ended, in words."""
        if outcome.status == "failed":
            return f"failed: {outcome.reason}"
        if self.metric:
            return f"{self.metric} = {with_unit(f'{outcome.metrics.get(self.metric, math.nan):.5g}', self.unit)}"
        if outcome.status == "stopped":
            return f"{outcome.reason} at {outcome.simulated_seconds:.4g} s"
        return outcome.status

    def _distance(self, outcome: Outcome) -> float:
        return outcome.metrics.get(self.metric, math.nan) - self.value


def until_of(text: str | None, model: Model) -> Until:
    """What `--until METRIC=VALUE` asks for. Errors: Usage."""
    if text is None:
        if not any(part.measure and "stop" in part.type.outputs for part in model.parts):
            rule = "no measure of this spec ends a run"
            raise Usage(f"{rule}; say what does: --until METRIC=VALUE, or add one such as use: measure/fall.")
        return Until()
    metric, value = split_setting(text, "--until")
    if metric not in model.metrics:
        raise Usage(f"--until {text}: {metric} is no metric of this spec. {did_you_mean(metric, model.metrics)}")
    unit = parse_unit(model.metrics[metric])
    try:
        quantity = quantity_of(value, unit.text)
    except BadQuantity as error:
        raise Usage(f"--until {text}: {error}") from error
    return Until(metric, quantity.value / unit.factor, unit.text)


@dataclass(frozen=True)
class Scan:
    """How a range is looked through.

    points: values of the first scan, both ends among them. tolerance: how exactly, in parts of the range.
    """

    points: int = 9
    tolerance: float = 0.01

    def check(self) -> None:
        """Errors: Usage."""
        if self.points < 2:
            raise Usage(f"--points {self.points}: a scan has at least 2 values, the two ends.")
        if not _FINEST <= self.tolerance <= 1:
            rule = f"this is a part of the range, from {_FINEST:g} to 1, such as 0.01"
            raise Usage(f"--tolerance {self.tolerance:g}: {rule}.")


@dataclass
class Limit:
    """One number and its range, with what is known of it."""

    address: str
    span: Span
    bracket: Bracket
    outcomes: dict[float, Outcome] = field(default_factory=dict)

    def at(self, share: float) -> str:
        """The value at a share of the range, as a spec has it."""
        return self.span.at(share)

    @property
    def last(self) -> str:
        """The last value that holds."""
        return self.at(self.bracket.last)

    @property
    def first(self) -> str | None:
        """The first value that does not hold; None if all do."""
        return None if self.bracket.first is None else self.at(self.bracket.first)

    @property
    def beyond(self) -> list[str]:
        """Values that hold although one before them does not."""
        return [self.at(share) for share in self.bracket.beyond]

    @property
    def ending(self) -> Outcome | None:
        """The run at the first value that does not hold."""
        return None if self.bracket.first is None else self.outcomes[self.bracket.first]


Row = tuple[dict[str, str], Outcome]


@dataclass
class Hunt:
    """Limits of several numbers of one document, each varied alone.

    settings: of the document, as a row of a study says them. models, rows: of every run, in order.
    """

    source: Source
    document: Document
    settings: Mapping[str, str]
    limits: Sequence[Limit]
    until: Until
    mode: Mode
    models: list[Model] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)

    def run(self, hear: Callable[[int, int], None]) -> None:
        """Find all limits; `hear` is told how many runs are done, and of how many at most.

        Errors: SimulationFailed if a range does not hold at its first end; InvalidSpec, InvalidComponent.
        """
        most = sum(limit.bracket.most for limit in self.limits)
        while asked := [(limit, share) for limit in self.limits for share in limit.bracket.ask()]:
            models = [self._model(limit, share) for limit, share in asked]
            self.models += models
            for (limit, share), outcome in zip(asked, run_all(models, self.mode), strict=True):
                limit.outcomes[share] = outcome
                limit.bracket.tell(share, self.until.holds(outcome, limit.outcomes[0.0]))
                self.rows.append(({**self.settings, limit.address: limit.at(share)}, outcome))
                hear(len(self.rows), most)
            self._check_begun()
        hear(most, most)

    def kept(self, root: Path | None) -> Keeping:
        """The runs in a result folder below `root`, or nowhere if there is none; what stood in the way is in it."""
        keeping = Keeping(root, self.source, self.models, self.mode)
        for settings, outcome in self.rows:
            keeping.add(settings, outcome)
        keeping.close()
        return keeping

    def _model(self, limit: Limit, share: float) -> Model:
        return self.source.model(override(self.document, limit.address, limit.at(share), "--vary"))

    def _check_begun(self) -> None:
        """Errors: SimulationFailed that names every range without a first value that holds."""
        faults = []
        for limit in self.limits:
            if not limit.bracket.held[0.0]:
                mark = Mark(f"--vary {limit.address}={limit.at(0)}:{limit.at(1)}")
                rule = f"at {limit.at(0)}, where it begins, it does not hold ({self.until.said(limit.outcomes[0.0])})"
                faults.append(Fault(f"{rule}; begin where it does.", mark))
        if faults:
            raise SimulationFailed(faults)


def hunted(
    opening: Opening,
    vary: Sequence[str],
    until: str | None,
    scan: Scan,
    origin: str | None,
    mode: Mode,
    listener: Listener,
) -> Hunt:
    """The limits that are to be found of what is opened; nothing is run yet.

    vary: what goes how far, each as ADDRESS=FROM:TO. until: METRIC=VALUE that ends it, or None for a run that does
    not complete. origin: as of `started_from`. Errors: Usage, InvalidSpec, InvalidComponent, BadResult, Untrusted.
    """
    scan.check()
    limits = [Limit(*span(text), Bracket(scan.points, scan.tolerance)) for text in vary]
    source = opening.source()
    if origin is not None:
        if opening.names_result:
            rule = f"{opening.path} is a result, which has its own values; name a spec, or drop --from"
            raise Usage(f"--from {origin}: {rule}.")
        source, notices = started_from(replace(source, notices=()), opening, origin)
        source = replace(source, notices=tuple(notices))
    row = only_row(source, opening.path)
    model = source.model(row.document)
    for notice in dict.fromkeys([*source.notices, *model.notices]):
        listener.say(notice)
    return Hunt(source, row.document, row.settings, limits, until_of(until, model), mode)
