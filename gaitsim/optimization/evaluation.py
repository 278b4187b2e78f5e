"""One evaluated candidate: a line of the journal."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from gaitsim.optimization.problem import hash_of


@dataclass(frozen=True)
class Candidate:
    """A vector to be evaluated, and its place in the search. Generation 0 is the start."""

    generation: int
    index: int
    x: tuple[float, ...]


@dataclass(frozen=True)
class Verdict:
    """What an evaluation found: status as of a run, or `killed` or `timeout`.

    With several episodes: seconds and steps of all together, metrics of the first, and of each its
    status, score and steps.
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
    """A candidate and its verdict. Times and machines are kept elsewhere, so that histories compare."""

    candidate: Candidate
    verdict: Verdict

    @property
    def cost(self) -> float:
        """The score, infinite where there is none."""
        return math.inf if self.verdict.score is None else self.verdict.score

    @property
    def failed(self) -> bool:
        return self.verdict.score is None

    def line(self) -> str:
        """One line of JSON, the same for the same numbers."""
        place = self.candidate
        head: dict[str, Any] = {
            "run": 0,
            "generation": place.generation,
            "index": place.index,
            "hash": hash_of(place.x),
            "x": list(place.x),
        }
        found = asdict(self.verdict)
        if not self.verdict.episodes:
            del found["episodes"]
        return json.dumps(head | found, allow_nan=False)


def evaluation_of(data: Mapping[str, Any]) -> Evaluation:
    """The evaluation that a line of the journal holds. Errors: KeyError, TypeError."""
    candidate = Candidate(int(data["generation"]), int(data["index"]), tuple(float(v) for v in data["x"]))
    verdict = Verdict(
        str(data["status"]),
        str(data["reason"]),
        None if data["score"] is None else float(data["score"]),
        dict(data["metrics"]),
        float(data["simulated_seconds"]),
        int(data["steps"]),
        tuple(dict(episode) for episode in data.get("episodes", ())),
    )
    return Evaluation(candidate, verdict)
