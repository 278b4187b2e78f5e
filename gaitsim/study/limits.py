"""Limits: the values of a spec's numbers at which runs begin to fail. Several numbers are searched at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from gaitsim.errors import Fault, Mark, SimulationFailed, Usage
from gaitsim.model import Model
from gaitsim.optimization.limit import Bracket
from gaitsim.results.manifest import BadResult, changed_versions
from gaitsim.results.rows import outcome_of, read_rows
from gaitsim.results.until import Until, until_of
from gaitsim.simulation.batch import run_all
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode
from gaitsim.spec.inheritance import override
from gaitsim.spec.study import Span, column, span
from gaitsim.study.listening import Listener
from gaitsim.study.opened import Opened
from gaitsim.study.opening import Opening, only_row, started_from
from gaitsim.study.saver import RunSaver
from gaitsim.study.starts import Starts
from gaitsim.text.document import MappingNode

_FINEST = 1e-6


@dataclass(frozen=True)
class Scan:
    """The settings of the search in a range.

    Attributes:
        points: The number of values in the scan, both ends included.
        tolerance: The precision, as a share of the range.
    """

    points: int = 9
    tolerance: float = 0.01

    def check(self) -> None:
        """Check the request before anything runs.

        Raises:
            Usage: The request does not fit.
        """
        if self.points < 2:
            raise Usage(f"--points {self.points}: a scan has at least 2 values, the two ends.")
        if not _FINEST <= self.tolerance <= 1:
            rule = f"this is a part of the range, from {_FINEST:g} to 1, such as 0.01"
            raise Usage(f"--tolerance {self.tolerance:g}: {rule}.")


@dataclass
class Limit:
    """One number, its range, and what is known of it.

    Attributes:
        beside: What is set besides, by address: a value of `--over`.
    """

    address: str
    span: Span
    bracket: Bracket
    beside: Mapping[str, str] = field(default_factory=dict)
    outcomes: dict[float, Outcome] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The address, and what is set besides."""
        return " at ".join([self.address, *(f"{address} = {value}" for address, value in self.beside.items())])

    def at(self, share: float) -> str:
        """The value at a share of the range, as text for a spec."""
        return self.span.at(share)

    @property
    def last(self) -> str:
        """The last value that succeeds."""
        return self.at(self.bracket.last)

    @property
    def first(self) -> str | None:
        """The first value that fails; None if all succeed."""
        return None if self.bracket.first is None else self.at(self.bracket.first)

    @property
    def beyond(self) -> list[str]:
        """The values that succeed although an earlier one fails."""
        return [self.at(share) for share in self.bracket.beyond]

    @property
    def ending(self) -> Outcome | None:
        """The run at the first value that fails."""
        return None if self.bracket.first is None else self.outcomes[self.bracket.first]


Row = tuple[dict[str, str], Outcome]


@dataclass
class LimitRuns:
    """The limits of several numbers of one spec. Each number is varied alone.

    Attributes:
        settings: The settings of the spec, as those of a row of a study.
        rows: The rows of all runs, in order.
        saver: Saves the runs.
        before: The runs of an earlier, interrupted search.
    """

    opened: Opened
    document: MappingNode
    settings: Mapping[str, str]
    limits: Sequence[Limit]
    until: Until
    mode: Mode
    starts: Starts
    saver: RunSaver
    before: list[Row] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)

    def __repr__(self) -> str:
        found = "; ".join(f"{limit.name} holds up to {limit.last}" for limit in self.limits)
        return f"<LimitRuns: {found}; {len(self.rows)} runs; {self.folder or 'not kept'}>"

    def run(self, listener: Listener) -> None:
        """Find all limits, and save each run when it ends.

        An error of saving is in `saver.error`.

        Raises:
            SimulationFailed: A range fails at its first end.
            InvalidSpec: A value in a range is invalid.
            InvalidComponent: A component file breaks the contract.
            KeyboardInterrupt: The runs before are saved.
        """
        report, most = listener.progress("runs"), sum(limit.bracket.most for limit in self.limits)
        try:
            while asked := [(limit, share) for limit in self.limits for share in limit.bracket.ask()]:
                for (limit, share), outcome in zip(asked, self._outcomes(asked, listener), strict=True):
                    limit.outcomes[share] = outcome
                    limit.bracket.tell(share, self.until.holds(outcome, limit.outcomes[0.0]))
                    report(len(self.rows), most)
                self._check_begun()
        except KeyboardInterrupt:
            self.saver.close("interrupted")
            raise
        except SimulationFailed:
            self.saver.close()
            raise
        self.saver.close()
        report(most, most)

    @property
    def over(self) -> list[str]:
        """The address of `--over`, if there is one."""
        return list(self.limits[0].beside)

    @property
    def folder(self) -> Path | None:
        """The result folder; None if the runs were not saved."""
        return self.saver.folder

    def _outcomes(self, asked: Sequence[tuple[Limit, float]], listener: Listener) -> Iterator[Outcome]:
        """The outcomes that are asked for, in order. Those that are known are not run again."""
        settings = [{**self.settings, **limit.beside, limit.address: limit.at(share)} for limit, share in asked]
        known = [self._known(each) for each in settings]
        missing = [pair for pair, found in zip(asked, known, strict=True) if found is None]
        models = [self._model(limit, share) for limit, share in missing]
        outcomes = run_all(models, self.mode, None if self.rows else self.starts.look_at)
        for each, found in zip(settings, known, strict=True):
            outcome = next(outcomes) if found is None else found
            if not self.rows:
                for warning in self.starts.warnings:
                    listener.say(warning)
            self.rows.append((each, outcome))
            if found is None:
                self.saver.add(each, outcome)
            yield outcome

    def _known(self, settings: Mapping[str, str]) -> Outcome | None:
        return next((outcome for each, outcome in self.before if each == settings), None)

    def _model(self, limit: Limit, share: float) -> Model:
        document = _with_settings(self.document, limit.beside)
        return self.opened.model(override(document, limit.address, limit.at(share), "--vary"))

    def _check_begun(self) -> None:
        """Refuse ranges whose first value already fails.

        Raises:
            SimulationFailed: There are some; the error names all of them.
        """
        faults = []
        for limit in self.limits:
            if not limit.bracket.held[0.0]:
                beside = "".join(f" at {address} = {value}" for address, value in limit.beside.items())
                mark = Mark(f"--vary {limit.address}={limit.at(0)}:{limit.at(1)}{beside}")
                rule = f"the run fails at the first end, {limit.at(0)} ({self.until.ending_of(limit.outcomes[0.0])})"
                faults.append(Fault(f"{rule}; start the range at a value with which it succeeds.", mark))
        if faults:
            raise SimulationFailed(faults)


def limit_runs(
    opening: Opening,
    vary: Sequence[str],
    over: str | None,
    until: str | None,
    scan: Scan,
    origin: str | None,
    mode: Mode,
    root: Path | None,
    listener: Listener,
) -> LimitRuns:
    """Prepare a search for limits. Nothing is run yet.

    Args:
        opening: The spec or result.
        vary: The ranges, each as ADDRESS=FROM:TO.
        over: Values of another number, as ADDRESS=VALUES, at each of which all limits are found; None for none.
        until: METRIC=VALUE that ends a range; None for a run that does not complete.
        scan: The settings of the search.
        origin: The start, as for `started_from`.
        mode: Native code ("rapid") or plain Python ("normal").
        root: The folder of results; None saves nothing.
        listener: Receives notices.

    Raises:
        Usage: The request does not fit.
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
    """
    scan.check()
    limits = _limits(vary, over, scan)
    opened = opening.open()
    if origin is not None:
        if opening.names_result:
            rule = f"{opening.path} is a result, which has its own values; name a spec, or drop --from"
            raise Usage(f"--from {origin}: {rule}.")
        opened, notices = started_from(replace(opened, notices=()), opening, origin)
        opened = replace(opened, notices=tuple(notices))
    asked = {"vary": list(vary), "over": over, "until": until, "points": scan.points, "tolerance": scan.tolerance}
    return _limit_runs(opened, opening, limits, asked, mode, root, listener)


def resumed(opening: Opening, listener: Listener) -> LimitRuns:
    """Open the limits of a result to continue them. Its runs are not repeated.

    Raises:
        Usage: The request does not fit.
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
        Locked: Another process writes this result.
        CannotSave: The folder cannot be written.
    """
    if not opening.names_result:
        rule = f"{opening.path} is a spec; name the result folder of the limits"
        raise Usage(f"--resume: {rule}, such as results/2026-11-22-walking-3f9c.")
    if opening.settings or opening.folders or opening.candidate is not None:
        raise Usage(
            f"--resume: {opening.path} continues with its own settings; leave out --set, --library and --candidate."
        )
    opened = opening.open()
    asked, limits = _recorded(opening.path, opened.manifest)
    changed = changed_versions(dict(opened.manifest))
    if changed:
        rule = f"it was made with other versions ({', '.join(changed)}), so it would not continue identically"
        raise BadResult(f"{opening.path}: {rule}; install those, or start again.")
    rows = read_rows(opening.path, incomplete=True)
    mode: Mode = "normal" if opened.manifest["mode"] == "normal" else "rapid"
    runs = _limit_runs(opened, opening, limits, asked, mode, None, listener)
    step = opened.model(runs.document).simulate.step
    runs.before = [({**row["settings"]}, outcome_of(row, step)) for row in rows]
    runs.saver.go_on(opening.path, rows)
    listener.say(f"resuming {opening.path}: {len(rows)} runs are in it")
    return runs


def _recorded(folder: Path, manifest: Mapping[str, Any]) -> tuple[dict[str, Any], list[Limit]]:
    """The request and the limits in a result.

    Raises:
        BadResult: The folder is not a result, or the result is damaged.
        Usage: The request does not fit.
    """
    if "limit" not in manifest:
        raise BadResult(f"{folder}: this is not a result of gaitsim limit, so there is nothing to resume.")
    try:
        asked = _RecordedRequest.model_validate(manifest["limit"])
        scan = Scan(asked.points, asked.tolerance)
        scan.check()
        return asked.model_dump(), _limits(asked.vary, asked.over, scan)
    except (ValidationError, Usage) as error:
        rule = "what it says about its limits cannot be read, so it was edited; restore it from a copy"
        raise BadResult(Fault(f"{rule}.", Mark(str(folder / "manifest.json")))) from error


def _with_settings(document: MappingNode, settings: Mapping[str, str]) -> MappingNode:
    """A document with values of `--over`."""
    for address, value in settings.items():
        document = override(document, address, value, "--over")
    return document


def _limits(vary: Sequence[str], over: str | None, scan: Scan) -> list[Limit]:
    """All limits that are asked for: each range at each value of `over`.

    Raises:
        Usage: A text is not of its form, or one number is in two.
    """
    ranges = [span(text) for text in vary]
    rows: list[dict[str, str]] = [{}]
    if over is not None:
        address, values = column(over, "--over")
        if address in (varied for varied, _ in ranges):
            rule = f"{address} is varied already; name what its limit is found over, such as push.azimuth"
            raise Usage(f"--over {over}: {rule}.")
        rows = [{address: value} for value in values]
    return [Limit(varied, ends, Bracket(scan.points, scan.tolerance), row) for row in rows for varied, ends in ranges]


class _RecordedRequest(BaseModel):
    """The request as the manifest has it."""

    model_config = ConfigDict(extra="forbid", strict=True)

    vary: list[str]
    over: str | None = None
    until: str | None
    points: int
    tolerance: float


def _limit_runs(
    opened: Opened,
    opening: Opening,
    limits: list[Limit],
    asked: dict[str, Any],
    mode: Mode,
    root: Path | None,
    listener: Listener,
) -> LimitRuns:
    """Make the search; unusual starts are reported."""
    row = only_row(opened, opening.path)
    model = opened.model(row.document)
    for notice in dict.fromkeys([*opened.notices, *model.notices]):
        listener.say(notice)
    until = until_of(asked["until"], model)
    over = [_with_settings(row.document, limit.beside) for limit in limits]
    models = [model, *(opened.model(each) for each in over if each is not row.document)]
    saver = RunSaver(root, opened, models, mode, more={"limit": asked})
    return LimitRuns(opened, row.document, row.settings, limits, until, mode, Starts(opened), saver)
