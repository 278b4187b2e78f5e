"""What cannot be searched: the right exit code, the next move, nothing written."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from optimization.searches import SPEC, Study

from .files import SMALL

TUNED = "tune: [20 N m/rad, 200 N m/rad]"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (TUNED, "tune: [200 N m/rad, 20 N m/rad]", "spec.yaml:7:"),
        (TUNED, "tune: [60 N m/rad, 60 N m/rad]", "spec.yaml:7:"),
        ("value: 60 N m/rad", "value: 10 N m/rad", "spec.yaml:7:"),
        (TUNED, f"{TUNED}, spread: 0 N m/rad", "spec.yaml:7:"),
        ("objective: {use: objective/minimize, value: {from: angle}}\n", "", "spec.yaml: this spec has no objective"),
        ("population: 6", "population: 1", "spec.yaml:20:"),
        ("generations: 4", "generations: 0", "spec.yaml:20:"),
        ("generations: 4", "generations: 4, seed: -1", "spec.yaml:20:"),
        ("generations: 4", "generations: 4, algorithm: cmaes", "there is no such algorithm"),
    ],
)
def test_a_spec_that_cannot_be_searched(study: Study, command: Any, old: str, new: str, words: str) -> None:
    assert old in SPEC
    Path("spec.yaml").write_text(SPEC.replace(old, new))
    ended = command("optimize", "spec.yaml", "--workers", "0")
    assert ended.code == (2 if "algorithm" in words else 3), ended.err
    assert words in ended.err
    assert study.results == []


def test_nothing_is_tuned(study: Study, command: Any) -> None:
    settings = ["balance.proportional=60 N m/rad", "balance.derivative=12 N m s/rad", "trap.level=0.4"]
    ended = command("optimize", "spec.yaml", *(word for text in settings for word in ("--set", text)))
    assert (ended.code, study.results) == (3, [])
    assert ended.err.startswith("spec.yaml: nothing is tuned in this spec; give a value bounds, such as gain: {value")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--population", "1"], "--population 1: the smallest value is 2."),
        (["--generations", "0"], "--generations 0: the smallest value is 1."),
        (["--seed", "-1"], "--seed -1: the smallest value is 0."),
        (["--algorithm", "cme"], "--algorithm cme: there is no such algorithm. Did you mean cma?"),
        (["--workers", "-1"], "--workers -1: a number of processes, or 0 for this one."),
        (["--cluster"], "--cluster needs --scheduler tcp://host:port or --scheduler-file FILE."),
        (["--scheduler", "a:1"], "add --cluster."),
        (["--cluster", "--scheduler", "a:1", "--scheduler-file", "f"], "name two places; leave one out."),
        (["--cluster", "--scheduler", "a:1", "--workers", "2"], "leave it out with --cluster."),
        (["--from", "tuned"], "--from tuned: there is no spec.tuned.yaml; make it with optimize --adopt."),
        (["--from", "nowhere"], "--from nowhere: this is not a result; write tuned, middle, or a folder"),
        (["--from", "tuned", "--resume"], "--from begins a new search, and --resume continues an old one"),
        (["--smoke", "--resume"], "--smoke begins a new search, and --resume continues an old one"),
        (["--resume", "--generations", "-3"], "--generations -3: the smallest value is 1."),
    ],
)
def test_a_command_line_that_does_not_fit(study: Study, command: Any, words: list[str], said: str) -> None:
    ended = command("optimize", "spec.yaml", *words)
    assert ended.code == 2, ended.err
    assert said in ended.err
    assert study.results == []


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["spec.yaml", "--resume"], 3, "results: there is no search of spec.yaml to resume; start one without"),
        (["results/gone", "--resume"], 3, "results/gone: there is no such result. See: gaitsim results list"),
        (["spec.yaml", "--from", "results/gone"], 3, "results/gone: there is no such result"),
    ],
)
def test_there_is_nothing_to_go_on_with(command: Any, words: list[str], code: int, said: str) -> None:
    ended = command("optimize", *words, "--json")
    assert ended.code == code
    assert said in ended.err
    assert said in ended.data["errors"][0]["message"]


def test_every_candidate_failed(study: Study, command: Any) -> None:
    words = ("--set", "trap.use=trap/raises", "--set", "trap.level={value: 0.9, tune: [0.8, 1], spread: 0.1}")
    ended = command("optimize", "spec.yaml", *SMALL, *words, "--adopt", "--json")
    assert ended.code == 4
    said = ended.data["errors"][0]["message"]
    name = f"results/{study.result.name}"
    assert said.startswith(f"{name}: every one of 7 candidates failed; ")
    place = "components/trap/raises.py:27"
    assert f"because trap (trap/raises) raised in update at 0 s ({place}): ValueError: too much" in said
    assert said.endswith(f"look at one: gaitsim run {name} --candidate 0:0")
    assert study.manifest()["status"] == "complete"
    assert not Path("spec.tuned.yaml").exists()
    assert command("run", name, "--candidate", "0:0", "--no-save").code == 4
    best = command("run", name, "--no-save")
    assert (best.code, "every candidate failed" in best.err) == (3, True)


def test_from_where_nothing_matches(begun: Path, command: Any) -> None:
    Path("other.yaml").write_text(SPEC.replace("balance", "control").replace("trap:", "snare:"))
    ended = command("optimize", "other.yaml", "--from", str(begun), "--workers", "0")
    assert ended.code == 2
    known = "balance.proportional, balance.derivative, trap.level"
    assert ended.err == f"--from {begun}: none of its values ({known}) is tuned here.\n"


@pytest.mark.parametrize(
    ("which", "code", "said"),
    [
        ("0", 2, "write best, a rank such as 3, or GENERATION:INDEX such as 12:4."),
        ("99999", 2, "--candidate 99999: there are 7 candidates with a score."),
        ("7:99", 2, "--candidate 7:99: there is no candidate 7:99; the last is 2:2."),
        ("foo", 2, "write best, a rank such as 3, or GENERATION:INDEX such as 12:4."),
        ("²", 2, "write best, a rank"),
        ("1:²", 2, "write best, a rank"),
        ("-1", 2, "write best, a rank"),
        ("1:0:0", 2, "write best, a rank"),
    ],
)
def test_a_candidate_that_is_none(begun: Path, command: Any, which: str, code: int, said: str) -> None:
    ended = command("run", str(begun), "--candidate", which, "--no-save")
    assert (ended.code, said in ended.err) == (code, True), ended.err


def test_a_candidate_of_a_spec(command: Any) -> None:
    ended = command("run", "spec.yaml", "--candidate", "best")
    assert ended.err == "--candidate best: spec.yaml is a spec; candidates belong to results.\n"
    assert ended.code == 2


def test_results_is_a_file(command: Any) -> None:
    Path("results").write_text("")
    ended = command("optimize", "spec.yaml", *SMALL)
    assert (ended.code, ended.err.startswith("results: the result cannot be saved (")) == (3, True)


def test_adopt_where_nothing_may_be_written(study: Study, command: Any) -> None:
    Path("spec.tuned.yaml.partial").mkdir()
    ended = command("optimize", "spec.yaml", *SMALL, "--adopt")
    assert ended.code == 3
    assert "spec.tuned.yaml: the tuned values cannot be written (Is a directory); they are saved in" in ended.err
    assert study.manifest()["status"] == "complete"
