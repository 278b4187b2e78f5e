"""An evaluated candidate, and its line in the journal."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from gaitsim.optimization.problem import hash_of

_DIGEST = ', "digest": "'
_DIGEST_AT_END = re.compile(_DIGEST.encode() + rb'[0-9a-f]{16}"}')


@dataclass(frozen=True)
class Candidate:
    """A vector to evaluate, and its place in the search. Generation 0 is the start."""

    generation: int
    index: int
    x: tuple[float, ...]

    @property
    def name(self) -> str:
        """The name for `--candidate`, such as 12:4."""
        return f"{self.generation}:{self.index}"


@dataclass(frozen=True)
class Verdict:
    """The result of an evaluation. Its status is that of a run, or `killed` or `timeout`.

    With several episodes, seconds and steps are sums, metrics are those of the first episode, and `episodes` has
    status, score and steps of each.
    """

    status: str
    reason: str
    score: float | None
    metrics: Mapping[str, float | None]
    simulated_seconds: float
    steps: int
    episodes: tuple[Mapping[str, Any], ...] = ()


@dataclass(frozen=True)
class Evaluation:
    """A candidate and its verdict. Times and hosts are stored elsewhere, so that histories can be compared."""

    candidate: Candidate
    verdict: Verdict

    @property
    def cost(self) -> float:
        """The score; infinite if there is none."""
        return math.inf if self.verdict.score is None else self.verdict.score

    @property
    def failed(self) -> bool:
        return self.verdict.score is None

    def line(self) -> str:
        """One line of JSON, the same for the same numbers. It ends with a digest of all that precedes it."""
        place = self.candidate
        head: dict[str, Any] = {"run": 0, "generation": place.generation, "index": place.index, "x": list(place.x)}
        found = dict(vars(self.verdict))
        if not self.verdict.episodes:
            del found["episodes"]
        text = json.dumps(head | found, allow_nan=False)[:-1]
        return f'{text}{_DIGEST}{_digest(text.encode())}"}}'


_Count = Annotated[int, Field(ge=0, le=2**53)]


class _Line(BaseModel):
    """The fields of a line."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    run: Literal[0]
    generation: _Count
    index: _Count
    x: tuple[FiniteFloat, ...]
    status: str
    reason: str
    score: FiniteFloat | None
    metrics: dict[str, FiniteFloat | None]
    simulated_seconds: FiniteFloat
    steps: _Count
    episodes: tuple[dict[str, Any], ...] = ()
    digest: str | None = None
    hash: str | None = None  # of journals begun before lines had a digest; it covers x only


def evaluation_of(line: bytes) -> Evaluation:
    """Read a line of the journal.

    Raises:
        ValueError: The line is not an evaluation, or it was changed; the text says how.
    """
    try:
        found = _Line.model_validate_json(line)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(str(word) for word in first["loc"])
        raise ValueError(f"{place + ': ' if place else ''}{first['msg'][0].lower()}{first['msg'][1:]}") from error
    if found.hash is None:
        text, _, _ = line.rpartition(_DIGEST.encode())
        if line != text + f'{_DIGEST}{_digest(text)}"}}'.encode():
            raise ValueError("it does not fit its digest")
    elif found.hash != hash_of(found.x):
        raise ValueError("its hash does not fit its vector")
    verdict = Verdict(
        found.status,
        found.reason,
        found.score,
        found.metrics,
        found.simulated_seconds,
        found.steps,
        found.episodes,
    )
    return Evaluation(Candidate(found.generation, found.index, found.x), verdict)


def is_whole(line: bytes) -> bool:
    """Whether a line ends with a digest. Lines of old journals do not."""
    return _DIGEST_AT_END.search(line) is not None


def _digest(text: bytes) -> str:
    return hashlib.sha256(text).hexdigest()[:16]
