from __future__ import annotations

import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from gaitsim.analysis.searches.convergence import (
    TunedParameter,
    convergence_figures,
    scores_of,
    tuned_figures,
    tuned_in,
)
from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict
from gaitsim.optimization.journal import DamagedJournal, evaluations_in
from tests.analysis.replays import command, of_result, of_spec
from tests.simulation.models import ROOT


def evaluation(generation: int, index: int, score: float | None) -> Evaluation:
    status = "failed" if score is None else "completed"
    return Evaluation(Candidate(generation, index, (1.0,)), Verdict(status, "", score, {}, 1, 1))


@pytest.fixture(scope="module")
def search(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The result of a small search."""
    folder = tmp_path_factory.mktemp("search")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        spec = str(ROOT / "specs" / "hopping_leg_mass.yaml")
        words = [spec, "--set", "simulate.duration=0.5 s", "--smoke", "--workers", "0", "--seed", "3"]
        assert command("optimize", *words) == 0
    return next((folder / "results").iterdir())


def test_the_summary_of_generations() -> None:
    scores = scores_of(
        [evaluation(0, 0, 5), *(evaluation(1, i, s) for i, s in enumerate([4.0, 8.0, 6.0, None])), evaluation(2, 0, 7)]
    )
    assert scores.generations == (0, 1, 2)
    assert scores.failed == 1
    assert scores.summary(0.5).tolist() == [5, 6, 7]
    assert scores.summary(0.25).tolist() == [5, 5, 7]
    assert scores.best_so_far.tolist() == [5, 4, 4]
    assert scores.deviation.tolist() == pytest.approx([0, np.std([4, 8, 6]), 0])


def test_a_generation_that_failed_as_a_whole_leaves_a_gap() -> None:
    scores = scores_of([evaluation(0, 0, None), evaluation(1, 0, 2)])
    assert math.isnan(scores.best_so_far[0]) and scores.best_so_far[1] == 2
    assert math.isnan(scores.summary(0.5)[0])


def test_the_place_between_bounds() -> None:
    tuned = TunedParameter("gain", "1", 2, 6, 3, 5, 5, 0.5)
    assert [tuned.share(value) for value in (2, 3, 6)] == [0, 0.25, 1]


def test_the_figures_of_a_search(search: Path) -> None:
    replay = of_result(search)
    generations, evaluations = convergence_figures(replay)
    (bounds,) = tuned_figures(replay)
    assert f"{len(evaluations_in(search))} candidates" in evaluations.caption
    assert [axes.get_ylabel() for axes in generations.figure.axes] == ["score (–)", "standard deviation (–)"]
    assert generations.figure.axes[1].get_xlabel() == "generation (–)"
    texts = [text.get_text() for text in bounds.figure.axes[0].texts]
    assert "extensor.max_isometric_force" in texts
    assert {"18000 N", "26000 N", "0.08 m", "0.12 m"} <= set(texts)
    assert len(tuned_in(search, {})) == 6


def test_best_is_what_the_search_said(search: Path) -> None:
    scores = scores_of(evaluations_in(search))
    assert scores.best_so_far[-1] == of_result(search).manifest["best_score"]


def test_one_run_and_a_spec_are_no_search() -> None:
    replay = of_spec("pendulum_pid")
    assert convergence_figures(replay) == tuned_figures(replay) == []


def test_a_damaged_journal_is_said_and_the_bounds_are_drawn(search: Path, tmp_path: Path) -> None:
    from dataclasses import replace

    folder = tmp_path / "copy"
    shutil.copytree(search, folder)
    journal = folder / "evaluations.jsonl"
    journal.write_text(journal.read_text().replace('"generation": 1', '"generation": x', 1))
    replay = replace(of_result(search), path=folder)
    with pytest.raises(DamagedJournal, match=r"evaluations\.jsonl"):
        convergence_figures(replay)
    assert len(tuned_figures(replay)) == 1


def test_a_table_of_parameters_that_is_torn_or_missing(search: Path, tmp_path: Path) -> None:
    lines = (search / "parameters.csv").read_text().splitlines()
    (tmp_path / "parameters.csv").write_text("\n".join([*lines[:3], lines[3][:20]]))
    known = ["extensor.max_isometric_force", "extensor.optimal_fiber_length"]
    assert [row.address for row in tuned_in(tmp_path, {"format": 2})] == known
    (tmp_path / "parameters.csv").unlink()
    assert tuned_in(tmp_path, {"format": 2}) == []
