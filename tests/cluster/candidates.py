"""Candidates of a model with a trap, and what this process finds of the innocent ones."""

from __future__ import annotations

import os
from pathlib import Path

import psutil
from optimization.searches import Study

from gaitsim.cluster.evaluate import Serial, runner_of
from gaitsim.optimization.evaluation import Candidate, Evaluation
from gaitsim.optimization.search import Evaluator
from gaitsim.results.bundle import Bundle
from gaitsim.study.opening import Opening

LEVELS = (0.1, 0.3, 0.9, 0.2, 0.5, 0.65, 0.4, 0.0)
CANDIDATES = [Candidate(1, i, (60.0, 12.0, level)) for i, level in enumerate(LEVELS)]
CULPRIT = CANDIDATES[2]
INNOCENT = [c for c in CANDIDATES if c != CULPRIT]


def bundle(folder: Path, trap: str, duration: str = "200ms") -> Bundle:
    """A model whose trap acts above a level of 0.7."""
    settings = [f"parts.trap.use=trap/{trap}", f"simulate.duration={duration}"]
    opened = Opening(Study(folder).folder / "spec.yaml", tuple(settings), tuned=False).open()
    return opened.bundle([opened.model()])


def evaluated(evaluate: Evaluator, candidates: list[Candidate]) -> dict[Candidate, Evaluation]:
    """Every candidate, once."""
    found = [evaluation for evaluation, _, _ in evaluate(candidates)]
    assert sorted(e.candidate.index for e in found) == sorted(c.index for c in candidates)
    return {evaluation.candidate: evaluation for evaluation in found}


def expected(model: Bundle, candidates: list[Candidate]) -> dict[Candidate, Evaluation]:
    """As this process evaluates them."""
    return evaluated(Serial(runner_of(model, "rapid")), candidates)


def workers() -> list[psutil.Process]:
    """The processes that this one started and that still run; but for Python's own, which stays."""
    found = psutil.Process(os.getpid()).children(recursive=True)
    alive = [process for process in found if process.status() != psutil.STATUS_ZOMBIE]
    return [process for process in alive if "resource_tracker" not in " ".join(process.cmdline())]
