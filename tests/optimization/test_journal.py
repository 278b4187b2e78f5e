"""The journal: nothing acknowledged is lost, whatever happens between two of its file operations."""

from __future__ import annotations

import builtins
import json
import math
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from gaitsim.errors import GaitsimError
from gaitsim.optimization.algorithms import CmaEs
from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict
from gaitsim.optimization.history import GenerationsFile
from gaitsim.optimization.journal import DamagedJournal, Journal, evaluations_in
from gaitsim.optimization.problem import Problem, Variable
from gaitsim.optimization.search import Budget, Search
from gaitsim.units import parse_unit

PROBLEM = Problem(tuple(Variable(f"x{i}", parse_unit("1"), -2.0, 3.0, 1.0, 0.5) for i in range(3)))
Found = tuple[Evaluation, float, str]


class Crash(Exception):
    """The process ends here."""


def sphere(candidate: Candidate) -> Evaluation:
    """A cost; a failure here and there."""
    cost = sum(v * v for v in candidate.x)
    failed = candidate.index == 3 and candidate.generation % 2 == 1
    verdict = Verdict("failed" if failed else "completed", "", None if failed else cost, {"cost": cost}, 1.0, 10)
    return Evaluation(candidate, verdict)


class Evaluate:
    """An evaluator that counts, gives results backwards as workers may, and can crash."""

    def __init__(self, crash_after: float = math.inf) -> None:
        self.made: list[Candidate] = []
        self.acknowledged: list[Candidate] = []
        self._crash_after = crash_after

    def __call__(self, candidates: Any) -> Iterator[Found]:
        for candidate in reversed(candidates):
            if len(self.made) >= self._crash_after:
                raise Crash
            self.made.append(candidate)
            yield sphere(candidate), 0.0, "here"
            self.acknowledged.append(candidate)

    def close(self) -> None:
        pass


def search(folder: Path, evaluate: Evaluate, generations: int = 4) -> None:
    folder.mkdir(exist_ok=True)
    if not (folder / "evaluations.jsonl").exists():
        (folder / "evaluations.jsonl").touch()
    journal, rows = Journal(folder), GenerationsFile(folder)
    algorithm = CmaEs(PROBLEM, 1, 5)
    try:
        took, watch = (lambda *_: None), (lambda _: None)
        Search(PROBLEM, algorithm, evaluate, journal, rows, took, watch).run(Budget(generations))
    finally:
        journal.close()
        rows.close()


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("undisturbed")
    evaluate = Evaluate()
    search(folder, evaluate)
    assert len(evaluate.made) == 1 + 4 * 5
    return files(folder)


def places(candidates: list[Candidate]) -> set[tuple[int, int]]:
    return {(c.generation, c.index) for c in candidates}


@pytest.mark.parametrize("crash_after", range(21))
def test_a_search_that_ends_anywhere_goes_on(tmp_path: Path, undisturbed: dict[str, bytes], crash_after: int) -> None:
    first, second = Evaluate(crash_after), Evaluate()
    with pytest.raises(Crash):
        search(tmp_path, first)
    search(tmp_path, second)
    assert files(tmp_path) == undisturbed
    assert not places(first.acknowledged) & places(second.made)


def test_a_journal_is_the_same_in_any_order_of_arrival(tmp_path: Path, undisturbed: dict[str, bytes]) -> None:
    class Forwards(Evaluate):
        def __call__(self, candidates: Any) -> Iterator[Found]:
            return ((sphere(c), 0.0, "here") for c in candidates)

    search(tmp_path, Forwards())
    assert files(tmp_path) == undisturbed


def test_a_longer_budget_continues_as_a_longer_search(tmp_path: Path) -> None:
    search(tmp_path / "long", Evaluate(), 7)
    search(tmp_path / "short", Evaluate(), 3)
    rest = Evaluate()
    search(tmp_path / "short", rest, 7)
    assert files(tmp_path / "long") == files(tmp_path / "short")
    assert {c.generation for c in rest.made} == {4, 5, 6, 7}


def half_way(folder: Path, after: int = 13) -> dict[str, bytes]:
    """A search that ended in the middle of its third generation: two journals with lines."""
    with pytest.raises(Crash):
        search(folder, Evaluate(after))
    found = files(folder)
    assert found["evaluations.jsonl"] and found["arriving.jsonl"]
    return found


@pytest.mark.parametrize("name", ["evaluations.jsonl", "arriving.jsonl"])
def test_a_torn_line_costs_that_line_only(tmp_path: Path, undisturbed: dict[str, bytes], name: str) -> None:
    before = half_way(tmp_path / "x")
    text = before[name]
    begin = text.rfind(b"\n", 0, text.rfind(b"\n", 0, len(text) - 1)) + 1
    for cut in range(begin, len(text)):
        folder = tmp_path / f"cut{cut}"
        folder.mkdir()
        for other, content in before.items():
            (folder / other).write_bytes(content[:cut] if other == name else content)
        known = {json.loads(line)["hash"] for line in text[:cut].split(b"\n")[:-1]}
        assert known <= {json.loads(e.line())["hash"] for e in evaluations_in(folder)}
        journal = Journal(folder)
        assert known <= {json.loads(e.line())["hash"] for e in journal.evaluations}
        journal.close()
        if cut % 40 == 0 or cut > len(text) - 3:
            search(folder, Evaluate())
            assert files(folder) == undisturbed


OPERATIONS: tuple[tuple[Any, str], ...] = (
    (Path, "open"),
    (Path, "replace"),
    (Path, "unlink"),
    (os, "fsync"),
    (builtins, "open"),
)


def crashing(monkeypatch: pytest.MonkeyPatch, after: int) -> Callable[[], int]:
    """Count file operations, and raise instead of the one after `after`; again for all later ones."""
    count = 0

    def counted(plain: Any) -> Any:
        def operation(*arguments: Any, **options: Any) -> Any:
            nonlocal count
            count += 1
            if count > after:
                raise Crash
            return plain(*arguments, **options)

        return operation

    for owner, name in OPERATIONS:
        monkeypatch.setattr(owner, name, counted(getattr(owner, name)))
    return lambda: count


def operations(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, before: dict[str, bytes]) -> int:
    """How many file operations the rest of the search makes."""
    folder = copy(tmp_path / "counting", before)
    with monkeypatch.context() as patch:
        count = crashing(patch, 10**9)
        search(folder, Evaluate())
    return count()


def copy(folder: Path, content: dict[str, bytes]) -> Path:
    folder.mkdir()
    for name, text in content.items():
        (folder / name).write_bytes(text)
    return folder


def test_a_crash_between_any_two_file_operations_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, undisturbed: dict[str, bytes]
) -> None:
    before = half_way(tmp_path / "x")
    acknowledged = {e.candidate for e in evaluations_in(tmp_path / "x")}
    total = operations(tmp_path, monkeypatch, before)
    assert total > 15
    for after in range(total):
        folder, crashed, resumed = copy(tmp_path / str(after), before), Evaluate(), Evaluate()
        with monkeypatch.context() as patch:
            crashing(patch, after)
            with pytest.raises(Crash):
                search(folder, crashed)
        kept = {e.candidate for e in evaluations_in(folder)}
        assert acknowledged | set(crashed.acknowledged) <= kept
        search(folder, resumed)
        assert not places(list(kept)) & places(resumed.made)
        assert files(folder) == undisturbed


def edited(folder: Path, line: int, change: Callable[[dict[str, Any]], Any]) -> None:
    path = folder / "evaluations.jsonl"
    lines = path.read_text().splitlines()
    lines[line - 1] = change(json.loads(lines[line - 1]))
    path.write_text("\n".join(lines) + "\n")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda data: json.dumps(data | {"x": [0.0, 0.0, 0.0]}), "its hash does not fit its vector"),
        (lambda data: json.dumps(data)[:-9], "this line is no evaluation"),
        (lambda data: "", "is missing among later ones"),
        (lambda data: "[]", "this line is no evaluation"),
        (lambda data: json.dumps(data | {"score": "good"}), "this line is no evaluation"),
        (lambda data: json.dumps({k: v for k, v in data.items() if k != "metrics"}), "this line is no evaluation"),
    ],
)
def test_an_edited_line_is_named(tmp_path: Path, change: Any, words: str) -> None:
    half_way(tmp_path)
    edited(tmp_path, 4, change)
    with pytest.raises(DamagedJournal) as told:
        search(tmp_path, Evaluate())
    line = "" if "missing" in words else ":4"
    assert str(told.value).startswith(f"{tmp_path / 'evaluations.jsonl'}{line}: ")
    assert words in str(told.value)


def test_an_edited_vector_with_its_hash_mended_is_noticed(tmp_path: Path) -> None:
    from gaitsim.optimization.problem import hash_of

    x = [0.5, 0.5, 0.5]
    half_way(tmp_path)
    edited(tmp_path, 4, lambda data: json.dumps(data | {"x": x, "hash": hash_of(x)}))
    with pytest.raises(DamagedJournal, match="generation 1, candidate 2 is not the vector that this search asks for"):
        search(tmp_path, Evaluate())


def test_an_edited_score_is_noticed_by_what_follows(tmp_path: Path) -> None:
    half_way(tmp_path)
    edited(tmp_path, 2, lambda data: json.dumps(data | {"score": -100.0}))
    with pytest.raises(DamagedJournal, match="generation 2, candidate 0 is not the vector"):
        search(tmp_path, Evaluate())


def test_a_missing_journal_is_no_new_search(tmp_path: Path) -> None:
    half_way(tmp_path)
    (tmp_path / "evaluations.jsonl").unlink()
    with pytest.raises(GaitsimError, match="this journal is missing"):
        Journal(tmp_path)
