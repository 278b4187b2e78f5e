"""cohort.json: the rows of a cohort, bodies crossed with devices, and how a row that does not complete is tuned."""

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

    body: its name. settings: what is set in the spec, as text by address. place: where the body is written.
    """

    body: str
    settings: dict[str, str]
    place: str

    def document(self, spec: MappingNode) -> MappingNode:
        """The spec of this row. Errors: InvalidSpec, Usage, at the place where the body is written."""
        for address, text in self.settings.items():
            spec = override(spec, address, text, self.place)
        return spec


@dataclass(frozen=True)
class Cohort:
    """All rows in order; evaluations that a row may take to be tuned again (0 for none); the seed of each search."""

    rows: tuple[Row, ...]
    retune: int
    seed: int

    def text(self) -> str:
        """As a bundle has it."""
        return json.dumps(asdict(self), indent=1, ensure_ascii=False) + "\n"


def cohort_of(bundle: Bundle) -> Cohort:
    """The cohort that a bundle holds. Errors: BadResult."""
    try:
        found = _Cohort.model_validate_json(bundle.files[COHORT])
    except (KeyError, ValidationError) as error:
        rule = "this is no result of gaitsim cohort" if isinstance(error, KeyError) else "its rows cannot be read"
        raise BadResult(Fault(f"{rule}; name one, or restore it from a copy.", Mark(str(bundle.folder / COHORT)))) from error
    return Cohort(tuple(Row(row.body, row.settings, row.place) for row in found.rows), found.retune, found.seed)


class _Row(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)

    body: str
    settings: dict[str, str]
    place: str


class _Cohort(BaseModel):
    """What the file holds, to the letter."""

    model_config = ConfigDict(extra="forbid", strict=True)

    rows: list[_Row]
    retune: int = Field(ge=0)
    seed: int = Field(ge=0)
