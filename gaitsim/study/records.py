"""Records of models in the archive: records/NAME.yaml beside the spec, written by `gaitsim archive record`."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from gaitsim.components.find import display_path
from gaitsim.components.load import digest_of
from gaitsim.errors import Fault, GaitsimError, Mark, command
from gaitsim.text.document import dump, parse, plain, text_of
from gaitsim.whole import write_whole

FOLDER = "records"
FORMAT = 1
OR = " or "  # between the ways in which a run may end, where rounding decides that
STEPS, SCORE = "steps", "score"
SHORT = 12  # letters of a digest
_ABOUT = "Written by gaitsim archive record; not by hand."
_DIGEST = re.compile(r"^digest: (\w+)\n\Z", re.MULTILINE)


class BadRecord(GaitsimError):
    """A record is missing, damaged or edited."""


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Value(_Model):
    """A recorded number in its unit, with a tolerance.

    Attributes:
        value: None if there was none.
        tolerance: None for a number that rounding decides, which is not compared.
    """

    value: float | None
    unit: str = "1"
    tolerance: float | None

    def holds(self, now: float | None) -> bool:
        """Whether a number agrees with the recorded one within the tolerance."""
        if self.tolerance is None:
            return True
        if self.value is None or now is None:
            return self.value is now
        return abs(now - self.value) <= self.tolerance


class Row(_Model):
    """One run: its settings, how it ended, and its numbers: steps, score and metrics.

    Attributes:
        status: The status; several, such as "completed or stopped", if rounding decides.
    """

    settings: dict[str, str] = {}
    status: str
    numbers: dict[str, Value]


class MadeFrom(_Model):
    """The first letters of the digests of everything that a record was made from."""

    spec: str
    tuned: str | None
    components: dict[str, str]


class Recorded(_Model):
    """A record: what the model was made from, and its runs."""

    about: str = _ABOUT
    format: int = FORMAT
    made_from: MadeFrom
    runs: list[Row]


@dataclass(frozen=True)
class Difference:
    """A difference from the record."""

    run: str
    metric: str
    unit: str
    recorded: float | str | None
    now: float | str | None
    tolerance: float | None = None

    @property
    def change(self) -> float | None:
        """The relative change; None for a text and for a recorded 0."""
        if isinstance(self.recorded, float) and isinstance(self.now, float) and self.recorded:
            return self.now / self.recorded - 1
        return None


def record_path(spec: Path) -> Path:
    """The path of a spec's record."""
    return spec.parent / FOLDER / f"{spec.stem}.yaml"


def record_text(recorded: Recorded) -> str:
    """A record as text that ends with its digest. The same record gives the same bytes."""
    text = dump(recorded.model_dump())
    return f"{text}digest: {digest_of(text)[:SHORT]}\n"


def write_record(spec: Path, recorded: Recorded) -> Path:
    """Write the record of a spec.

    Returns:
        The path of the record.

    Raises:
        OSError: The file cannot be read or written.
    """
    path = record_path(spec)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, record_text(recorded))
    return path


def read_record(spec: Path) -> Recorded:
    """Read the record of a spec.

    Raises:
        BadRecord: There is none, or if it is not as the command wrote it.
    """
    path, again = record_path(spec), command("archive", "record", spec.stem if spec.is_absolute() else spec)
    if not path.is_file():
        raise BadRecord(Fault(f"there is no record of this model; write it with: {again}", Mark(display_path(path))))
    text = text_of(path, display_path(path), "record")
    found = _DIGEST.search(text)
    body = text[: found.start()] if found else text
    if found is None or digest_of(body)[:SHORT] != found[1]:
        rule = "this record was damaged or edited; restore it from a copy, or write it again with"
        raise BadRecord(Fault(f"{rule}: {again}", Mark(display_path(path))))
    try:
        return Recorded.model_validate(plain(parse(body, display_path(path))))
    except ValidationError as error:
        place = ".".join(map(str, error.errors()[0]["loc"]))
        rule = f"this record is of another format ({place}: {error.errors()[0]['msg']}); write it again with"
        raise BadRecord(Fault(f"{rule}: {again}", Mark(display_path(path)))) from error


def run_words(settings: Mapping[str, str]) -> str:
    """The settings of a run in words; empty for the spec without changes."""
    return ", ".join(f"{address} = {value}" for address, value in settings.items())


def differences(before: Sequence[Row], now: Sequence[Row]) -> Iterator[Difference]:
    """The differences of runs from a record. Of `now`, the tolerances do not count."""
    settings = [[row.settings for row in rows] for rows in (before, now)]
    if settings[0] != settings[1]:
        old_runs, new_runs = ("; ".join(run_words(each) or "as it is" for each in rows) for rows in settings)
        yield Difference("", "runs", "", old_runs, new_runs)
        return
    for old, new in zip(before, now, strict=True):
        run = run_words(old.settings)
        if new.status not in old.status.split(OR):
            yield Difference(run, "status", "", old.status, new.status)
        for name in dict.fromkeys([*old.numbers, *new.numbers]):
            yield from _of_number(run, name, old.numbers.get(name), new.numbers.get(name))


def _of_number(run: str, name: str, old: Value | None, new: Value | None) -> Iterator[Difference]:
    if old is None or new is None:
        yield Difference(run, name, "", "there" if old else "not there", "there" if new else "not there")
    elif old.unit != new.unit:
        yield Difference(run, f"unit of {name}", "", old.unit, new.unit)
    elif not old.holds(new.value):
        yield Difference(run, name, old.unit, old.value, new.value, old.tolerance)


def updated(before: Recorded, now: Recorded) -> Recorded:
    """A new record. Numbers that still agree with the record before keep its values.

    A record therefore does not drift with many small changes, and another machine does not rewrite it.
    """
    known = {run_words(row.settings): row.numbers for row in before.runs}
    rows = []
    for row in now.runs:
        old = known.get(run_words(row.settings), {})
        held = {
            n: old[n] for n, v in row.numbers.items() if n in old and old[n].unit == v.unit and old[n].holds(v.value)
        }
        rows.append(row.model_copy(update={"numbers": row.numbers | held}))
    return now.model_copy(update={"runs": rows})


def finite(number: float | None) -> float | None:
    """A number for a record: None if it is not finite."""
    return None if number is None or not math.isfinite(number) else float(number)
