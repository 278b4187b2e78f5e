"""Several episodes for each candidate: one score of many, wherever and whenever they ran."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from gaitsim.model import Model
from gaitsim.optimization.combination import combined
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.study import episodes
from gaitsim.study import searches
from gaitsim.text.document import parse

from .searches import SPEC, Ended, Study

_EPISODES = """\
optimize:
  population: 4
  generations: 3
  combine: COMBINE
  episodes:
    - initial.pivot.angle: 170 deg
    - {initial.pivot.angle: 160 deg, parts.pendulum.mass: 3 kg}
    - parts.balance.angle.delay: 30 ms
"""


def written(folder: Path, combine: str = "mean", trap: str = "none") -> Study:
    study = Study(folder)
    head = (
        SPEC.partition("optimize:")[0].replace("trap/none", f"trap/{trap}").replace("duration: 2 s", "duration: 0.3 s")
    )
    (folder / "spec.yaml").write_text(head + _EPISODES.replace("COMBINE", combine))
    return study


def lines(study: Study) -> list[dict[str, object]]:
    return [json.loads(line) for line in (study.result / "evaluations.jsonl").read_text().splitlines()]


@pytest.mark.parametrize(
    ("how", "scores", "score"),
    [
        ("mean", [1.0, 2.0, 6.0], 3.0),
        ("worst", [1.0, 6.0, 2.0], 6.0),
        ("quantile 0", [3.0, 1.0, 2.0], 1.0),
        ("quantile 0.5", [3.0, 1.0, 2.0], 2.0),
        ("quantile 0.75", [4.0, 1.0, 2.0], 3.0),
        ("quantile 1", [4.0, 1.0, 2.0], 4.0),
        ("mean", [1.0, None], None),
        ("worst", [None, 1.0], None),
        ("quantile 0.5", [1.0, 2.0, None], None),
        ("quantile 0.3", [5.0], 5.0),
    ],
)
def test_how_scores_become_one(how: str, scores: list[float | None], score: float | None) -> None:
    assert combined(scores, how) == score


def test_quantiles_are_those_of_the_field() -> None:
    scores = list(np.random.default_rng(1).normal(size=17))
    for share in (0.1, 0.33, 0.9):
        assert combined(scores, f"quantile {share}") == pytest.approx(np.quantile(scores, share), rel=1e-12)
        assert combined(scores[::-1], f"quantile {share}") == combined(scores, f"quantile {share}")


def test_an_episode_is_a_row_of_overrides() -> None:
    rows = episodes(
        parse(SPEC.replace("optimize: {", "optimize: {episodes: [{pendulum.mass: 3 kg}, {}], "), "spec.yaml")
    )
    assert [row.settings for row in rows] == [{"pendulum.mass": "3 kg"}, {}]
    assert len(episodes(parse(SPEC, "spec.yaml"))) == 1


@pytest.mark.parametrize(("combine", "of"), [("mean", np.mean), ("worst", np.max)])
def test_a_search_scores_every_episode(tmp_path: Path, combine: str, of: object) -> None:
    study = written(tmp_path, combine)
    assert study.optimize("--workers", "0").code == 0
    alone = [
        study.run("run", "spec.yaml", "--no-save", "--json", *settings).data["score"]
        for settings in (
            ("--set", "initial.pivot.angle=170 deg"),
            ("--set", "initial.pivot.angle=160 deg", "--set", "pendulum.mass=3 kg"),
            ("--set", "balance.angle.delay=30 ms"),
        )
    ]
    first = lines(study)[0]  # the start of the search, which is what `run` uses
    assert [episode["score"] for episode in first["episodes"]] == alone  # type: ignore[attr-defined]
    assert first["score"] == pytest.approx(of(alone))  # type: ignore[operator]
    assert len(set(alone)) == 3
    assert first["steps"] == 900 and first["simulated_seconds"] == pytest.approx(0.9)
    assert first["metrics"]["angle"] == alone[0]  # type: ignore[index]


@pytest.mark.slow
@pytest.mark.parametrize(("text", "count"), [(_EPISODES, 1 + 3), ("optimize: {population: 2}\n", 1)], ids=["3", "none"])
def test_a_search_looks_at_its_model_and_at_each_episode_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, count: int
) -> None:
    made, prepared = [], searches.Simulator

    def counted(model: Model, mode: Mode) -> Simulator:
        made.append(model)
        return prepared(model, mode)

    monkeypatch.setattr(searches, "Simulator", counted)
    study = written(tmp_path)
    spec = (tmp_path / "spec.yaml").read_text().partition("optimize:")[0] + text.replace("COMBINE", "mean")
    (tmp_path / "spec.yaml").write_text(spec)
    assert study.optimize("--workers", "0", "--generations", "1").code == 0
    assert len(made) == count


def test_workers_find_the_same_and_a_result_verifies(tmp_path: Path) -> None:
    serial, parallel = written(tmp_path / "a"), written(tmp_path / "b")
    assert serial.optimize("--workers", "0").code == 0
    assert parallel.optimize("--workers", "2").code == 0
    assert serial.history() == parallel.history()
    checked = parallel.run("results", "verify", str(parallel.result), "--all")
    assert checked.code == 0
    assert "13 of 13 runs reproduced bit for bit" in checked.out


@pytest.mark.slow
def test_a_search_with_episodes_resumes_bit_for_bit(tmp_path: Path) -> None:
    whole, cut = written(tmp_path / "a"), written(tmp_path / "b")
    assert whole.optimize("--workers", "0").code == 0
    assert cut.optimize("--workers", "0", "--generations", "1").code == 0
    assert cut.optimize("--workers", "0", "--resume", "--generations", "3").code == 0
    assert whole.history() == cut.history()
    # From the folder alone, without the spec and the components that it was begun with.
    result = cut.result
    (cut.folder / "spec.yaml").unlink()
    shutil.rmtree(cut.folder / "components")
    assert cut.run("optimize", str(result), "--resume", "--generations", "4", "--workers", "0").code == 0
    assert len(lines(cut)) == 17


def test_a_candidate_is_shown_in_its_first_episode(tmp_path: Path) -> None:
    study = written(tmp_path, "quantile 0.9")
    assert study.optimize("--workers", "0", "--generations", "1").code == 0
    start = lines(study)[0]
    scores = [episode["score"] for episode in start["episodes"]]  # type: ignore[attr-defined]
    shown = study.run("run", str(study.result), "--candidate", "0:0", "--json", "--no-save")
    assert shown.data["score"] == scores[0]
    said = ", ".join(f"{score:.5g}" for score in scores)
    assert shown.err.splitlines()[0] == (
        f"candidate 0:0 of {study.result}, episode 1 of 3: initial.pivot.angle = 170 deg (the episodes' scores are "
        f"{said}; the candidate's is their quantile 0.9); for another one, --set its values"
    )
    other = study.run(
        "run", str(study.result), "--candidate", "0:0", "--json", "--no-save", "--set", "balance.angle.delay=30 ms"
    )
    assert other.data["score"] == scores[2]


def test_a_candidate_that_fails_in_one_episode_has_failed(tmp_path: Path) -> None:
    study = written(tmp_path, trap="raises")
    text = (study.folder / "spec.yaml").read_text()
    text = text.replace("level: {value: 0.4, tune: [0, 1], spread: 0.3}", "level: 0.4")
    (study.folder / "spec.yaml").write_text(text.replace("parts.balance.angle.delay: 30 ms", "trap.level: 0.9"))
    ended = study.optimize("--workers", "0", "--generations", "1")
    assert ended.code == 4
    assert "every one of 5 candidates failed; 5 because episode 3: trap (trap/raises) raised in update" in ended.err
    first = lines(study)[0]
    assert (first["status"], first["score"]) == ("failed", None)
    assert [e["status"] for e in first["episodes"]] == ["completed", "completed", "failed"]  # type: ignore[attr-defined]


_PROPORTIONAL = "balance.proportional"


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        (
            "optimize.combine=best",
            'optimize.combine: "best" is not a way to combine scores; '
            "write mean, worst, or such as quantile 0.9 (from 0 to 1).",
        ),
        (
            "optimize.combine=quantile 1.5",
            'optimize.combine: "quantile 1.5" is not a way to combine scores; '
            "write mean, worst, or such as quantile 0.9 (from 0 to 1).",
        ),
        (
            "optimize.combine=[mean]",
            "optimize.combine: this is not a way to combine scores; "
            "write mean, worst, or such as quantile 0.9 (from 0 to 1).",
        ),
        (
            "optimize.episodes=3",
            "optimize.episodes: this needs a list; write episodes: [{noise.seed: 1}, {noise.seed: 2}].",
        ),
        ("optimize.episodes=[3]", "optimize.episodes.0: this needs a mapping of names."),
        (
            f"optimize.episodes=[{{}}, {{{_PROPORTIONAL}: 70 N m/rad}}]",
            f"optimize.episodes.1: this episode takes {_PROPORTIONAL} from what is tuned; "
            "an episode sets numbers that no search changes.",
        ),
        (
            "optimize.episodes=[{balance.limit: {value: 40 N m, tune: [1 N m, 90 N m]}}]",
            "optimize.episodes.0: this episode adds balance.limit to what is tuned; "
            "an episode sets numbers that no search changes.",
        ),
        (
            f"optimize.episodes=[{{{_PROPORTIONAL}: {{value: 70 N m/rad, tune: [20 N m/rad, 200 N m/rad]}}}}]",
            f"optimize.episodes.0: this episode moves the bounds or the start of {_PROPORTIONAL}; "
            "an episode sets numbers that no search changes.",
        ),
        (
            "optimize.episodes=[{balance.propotional: 3}]",
            "balance: controller/pid has no propotional. Did you mean proportional?",
        ),
        ("optimize.episode=[{a: 1}]", "optimize has no key episode. Did you mean episodes?"),
    ],
)
def test_bad_episodes_are_told_before_anything_runs(tmp_path: Path, setting: str, said: str) -> None:
    study = written(tmp_path)
    ended: Ended = study.optimize("--workers", "0", "--set", setting)
    assert ended.code == 3
    assert ended.err.strip() == f"--set {setting}: {said}"
    assert not (study.folder / "results").exists()


def test_check_looks_at_every_episode(tmp_path: Path) -> None:
    study = written(tmp_path)
    assert study.run("check", "spec.yaml").code == 0
    ended = study.run("check", "spec.yaml", "--set", "optimize.episodes=[{pendulum.mass: 3 s}]")
    assert ended.code == 3
    assert 'pendulum.mass: s is a unit of time; this needs a mass, such as "80 kg".' in ended.err
