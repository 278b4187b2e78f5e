"""The journal: nothing acknowledged is lost, whatever happens between two of its file operations."""

from __future__ import annotations

import builtins
import json
import math
import os
import random
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from gaitsim.errors import GaitsimError
from gaitsim.optimization.cma_es import CmaEs
from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict, evaluation_of
from gaitsim.optimization.history import GenerationsFile
from gaitsim.optimization.journal import DamagedJournal, Journal, evaluations_in, old_form_notices
from gaitsim.optimization.problem import Problem, Variable, hash_of
from gaitsim.optimization.search import Search
from gaitsim.units import parse_unit

from .searches import signed

PROBLEM = Problem(tuple(Variable(f"x{i}", parse_unit("1"), -2.0, 3.0, 1.0, 0.5) for i in range(3)))
TimedEvaluation = tuple[Evaluation, float, str]


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

    def __call__(self, candidates: Any) -> Iterator[TimedEvaluation]:
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
        Search(PROBLEM, algorithm, evaluate, journal, rows, took, watch).run(generations)
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
        def __call__(self, candidates: Any) -> Iterator[TimedEvaluation]:
            return ((sphere(c), 0.0, "here") for c in candidates)

    search(tmp_path, Forwards())
    assert files(tmp_path) == undisturbed


def test_the_start_is_evaluated_together_with_the_first_generation(tmp_path: Path) -> None:
    """Alone it would leave all workers but one idle, and the first generation does not depend on it."""
    calls: list[set[int]] = []

    class Watched(Evaluate):
        def __call__(self, candidates: Any) -> Iterator[TimedEvaluation]:
            calls.append({candidate.generation for candidate in candidates})
            return super().__call__(candidates)

    search(tmp_path, Watched())
    assert calls == [{0, 1}, {2}, {3}, {4}]


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
        known = {line.decode() for line in text[:cut].split(b"\n")[:-1]}
        assert known <= {e.line() for e in evaluations_in(folder)}
        if cut % 8 == 0 or cut > len(text) - 3:
            Journal(folder).close()
            assert known <= {e.line() for e in evaluations_in(folder)}
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


def edited(folder: Path, line: int, change: Callable[[str], str]) -> None:
    path = folder / "evaluations.jsonl"
    lines = path.read_text().splitlines(keepends=True)
    lines[line - 1] = change(lines[line - 1])
    path.write_text("".join(lines))


def aged(line: str, **changes: Any) -> str:
    """A line as gaitsim wrote it before it had a digest."""
    data = json.loads(line) | changes
    del data["digest"]
    x = data.pop("x")
    head = {name: data.pop(name) for name in ("run", "generation", "index")}
    return json.dumps(head | {"hash": hash_of(x), "x": x} | data) + "\n"


DEEP: dict[str, Any] = {}
for _ in range(900):
    DEEP = {"a": DEEP}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda line: line.replace('"score": ', '"score": 1'), "it does not fit its digest"),
        (lambda line: line.replace(', "index"', ',  "index"'), "it does not fit its digest"),
        (lambda line: line.replace('"digest": "', '"digest": "0'), "it does not fit its digest"),
        (lambda line: line[:-9] + "\n", "invalid JSON: EOF while parsing a string at line 1 column"),
        (lambda line: "\n", "invalid JSON: EOF while parsing a value at line 1 column 0"),
        (lambda line: "[]\n", "input should be an object"),
        (lambda line: signed(line, score="good"), "score: input should be a valid number"),
        (lambda line: signed(line, score=math.nan), "score: input should be a finite number"),
        (lambda line: signed(line, x=[math.inf]), "x.0: input should be a finite number"),
        (lambda line: signed(line, score=10**400), "score: input should be a finite number"),
        (lambda line: signed(line, steps=10**30), "steps: input should be less than or equal to 9007199254740992"),
        (lambda line: line.replace('"index": ', '"index": 1' + 5000 * "0"), "invalid JSON: number out of range"),
        (lambda line: signed(line, index=-1), "index: input should be greater than or equal to 0"),
        (lambda line: signed(line, generation=1.5), "generation: input should be a valid integer"),
        (lambda line: signed(line, metrics=DEEP), "invalid JSON: recursion limit exceeded at line 1 column"),
        (lambda line: signed(line, mood="good"), "mood: extra inputs are not permitted"),
        (lambda line: aged(line, score=math.nan), "score: input should be a finite number"),
        (lambda line: aged(line).replace('"x": [', '"x": [1'), "its hash does not fit its vector"),
    ],
)
def test_an_edited_line_is_named(tmp_path: Path, change: Any, words: str) -> None:
    half_way(tmp_path)
    edited(tmp_path, 4, change)
    for use in (lambda: search(tmp_path, Evaluate()), lambda: evaluations_in(tmp_path)):
        with pytest.raises(DamagedJournal) as told:
            use()
        said = str(told.value)
        assert said.startswith(f"{tmp_path / 'evaluations.jsonl'}:4: this line is not an evaluation ({words}")
        rule = "); the file was edited or damaged"
        assert said.endswith(f"{rule}; restore it from a copy, or start a new search with --from.")


def test_every_flipped_bit_of_a_line_is_noticed(tmp_path: Path) -> None:
    half_way(tmp_path)
    line = (tmp_path / "evaluations.jsonl").read_bytes().splitlines()[3]
    for place in range(len(line)):
        for bit in range(8):
            flipped = bytearray(line)
            flipped[place] ^= 1 << bit
            with pytest.raises(ValueError):
                evaluation_of(bytes(flipped))


@pytest.mark.parametrize("name", ["evaluations.jsonl", "arriving.jsonl"])
def test_every_flipped_bit_of_a_newline_is_noticed(tmp_path: Path, name: str) -> None:
    text = half_way(tmp_path)[name]
    for place in (i for i, byte in enumerate(text) if byte == ord("\n")):
        for bit in range(8):
            flipped = bytearray(text)
            flipped[place] ^= 1 << bit
            (tmp_path / name).write_bytes(flipped)
            with pytest.raises(DamagedJournal):
                evaluations_in(tmp_path)


def test_a_missing_line_is_noticed(tmp_path: Path) -> None:
    half_way(tmp_path)
    edited(tmp_path, 4, lambda line: "")
    with pytest.raises(DamagedJournal, match="generation 1, candidate 2 is missing among later ones"):
        search(tmp_path, Evaluate())


def test_a_vector_of_another_search_is_noticed(tmp_path: Path) -> None:
    half_way(tmp_path)
    edited(tmp_path, 4, lambda line: signed(line, x=[0.5, 0.5, 0.5]))
    with pytest.raises(DamagedJournal, match="generation 1, candidate 2 is not the vector that this search asks for"):
        search(tmp_path, Evaluate())


def test_a_score_of_another_search_is_noticed_by_what_follows(tmp_path: Path) -> None:
    half_way(tmp_path)
    edited(tmp_path, 2, lambda line: signed(line, score=-100.0))
    with pytest.raises(DamagedJournal, match="generation 2, candidate 0 is not the vector"):
        search(tmp_path, Evaluate())


def test_a_journal_of_old_form_goes_on_and_says_what_it_cannot_notice(
    tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    half_way(tmp_path)
    assert old_form_notices(tmp_path) == []
    for name in ("evaluations.jsonl", "arriving.jsonl"):
        path = tmp_path / name
        path.write_text("".join(aged(line) for line in path.read_text().splitlines()))
    place = tmp_path / "evaluations.jsonl"
    rule = "begun by an older gaitsim, so damage to its scores and metrics would not be noticed"
    assert old_form_notices(tmp_path) == [f"{place}: {rule}"]
    search(tmp_path, Evaluate())
    assert [e.line().encode() for e in evaluations_in(tmp_path)] == undisturbed["evaluations.jsonl"].splitlines()
    assert b'"hash"' in place.read_bytes().splitlines()[3]  # what was whole stays as it was written


def test_numbers_come_back_to_the_last_bit() -> None:
    chance = random.Random(1)
    found = [struct.unpack("<d", chance.randbytes(8))[0] for _ in range(3000)]
    numbers = tuple(v for v in found if math.isfinite(v))
    verdict = Verdict("completed", 'ä \\ "', numbers[0], {"a": numbers[1], "b": None}, 1.0, 10)
    evaluation = Evaluation(Candidate(1, 2, numbers), verdict)
    assert evaluation_of(evaluation.line().encode()) == evaluation


def test_a_missing_journal_is_no_new_search(tmp_path: Path) -> None:
    half_way(tmp_path)
    (tmp_path / "evaluations.jsonl").unlink()
    with pytest.raises(GaitsimError, match="this journal is missing"):
        Journal(tmp_path)
