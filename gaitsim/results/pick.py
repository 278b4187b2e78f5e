"""Candidates of a result: the best, by rank, or by their place in the search."""

from __future__ import annotations

from pathlib import Path

from gaitsim.errors import Usage, command
from gaitsim.optimization.evaluation import Evaluation
from gaitsim.optimization.journal import evaluations_in
from gaitsim.results.manifest import BadResult


def pick(folder: Path, which: str) -> Evaluation:
    """Find a candidate.

    Args:
        folder: The result of a search.
        which: `best`, `RANK` (1 is the best) or `GENERATION:INDEX`.

    Raises:
        BadResult: The search has no evaluations.
        Usage: There is no such candidate.
    """
    found = evaluations_in(folder)
    if not found:
        again = command("optimize", folder, "--resume")
        raise BadResult(f"{folder}: nothing was evaluated yet; continue it with: {again}")
    ranked = sorted((e for e in found if not e.failed), key=lambda e: e.cost)
    generation, colon, index = which.partition(":")
    if colon and generation.isdecimal() and index.isdecimal():
        for evaluation in found:
            place = evaluation.candidate
            if (place.generation, place.index) == (int(generation), int(index)):
                return evaluation
        last = found[-1].candidate
        rule = f"there is no candidate {which}; the last is {last.generation}:{last.index}"
        raise Usage(f"--candidate {which}: {rule}.")
    rank = 1 if which == "best" else int(which) if which.isdecimal() else 0
    if rank < 1:
        raise Usage(f"--candidate {which}: write best, a rank such as 3, or GENERATION:INDEX such as 12:4.")
    if not ranked:
        raise BadResult(f"{folder}: every candidate failed, so none is best; pick one with --candidate 1:0.")
    if rank > len(ranked):
        raise Usage(f"--candidate {which}: there are {len(ranked)} candidates with a score.")
    return ranked[rank - 1]
