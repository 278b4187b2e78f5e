"""cohort.json: the rows of a cohort (bodies times devices), and how rows that do not complete are tuned."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from gaitsim.errors import Fault, Mark
from gaitsim.results.bundle import COHORT, BadResult, Bundle
from gaitsim.spec.inheritance import override
from gaitsim.text.document import MappingNode


@dataclass(frozen=True)
class Row:
    """One body with one device.

    Attributes:
        body: Its name.
        settings: The settings of the spec, as text by address.
        place: Where the body is written.
    """

    body: str
    settings: dict[str, str]
    place: str

    def document(self, spec: MappingNode) -> MappingNode:
        """The spec of this row.

        Raises:
            InvalidSpec: A setting does not fit; the place is that of the body.
            Usage: A setting is not of the form address=value.
        """
        for address, text in self.settings.items():
            spec = override(spec, address, text, self.place)
        return spec


@dataclass(frozen=True)
class Cohort:
    """All rows in order, the number of evaluations to tune a row again (0 for none), and the seed of each search."""

    rows: tuple[Row, ...]
    retune: int
    seed: int

    def text(self) -> str:
        """The text of cohort.json."""
        return json.dumps(asdict(self), indent=1, ensure_ascii=False) + "\n"


def cohort_of(bundle: Bundle) -> Cohort:
    """The cohort of a bundle.

    Raises:
        BadResult: It cannot be read.
    """
    try:
        found = _Cohort.model_validate_json(bundle.files[COHORT])
    except (KeyError, ValidationError) as error:
        rule = "this is not a result of gaitsim cohort" if isinstance(error, KeyError) else "its rows cannot be read"
        raise BadResult(Fault(f"{rule}; name one, or restore it from a copy.", Mark(str(bundle.folder / COHORT)))) from error
    return Cohort(tuple(Row(row.body, row.settings, row.place) for row in found.rows), found.retune, found.seed)


class _Row(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)

    body: str
    settings: dict[str, str]
    place: str


class _Cohort(BaseModel):
    """The fields of the file."""

    model_config = ConfigDict(extra="forbid", strict=True)

    rows: list[_Row]
    retune: int = Field(ge=0)
    seed: int = Field(ge=0)
