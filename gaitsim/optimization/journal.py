"""The journal of a search: every evaluation is stored when it arrives, and put in order when its generation is
complete.

`evaluations.jsonl` has complete generations in order, so that histories can be compared byte for byte. `arriving.jsonl`
has the present generation in the order of arrival. After a crash both are read, and an incomplete last line is cut off.
No more than one generation is held in memory.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO

from gaitsim.errors import Fault, GaitsimError, Mark
from gaitsim.optimization.evaluation import Candidate, Evaluation, evaluation_of, is_whole
from gaitsim.whole import flush_to_disk, whole

_MOVE = "restore it from a copy, or start a new search with --from"
_WHOLE, _ARRIVING = "evaluations.jsonl", "arriving.jsonl"


class DamagedJournal(GaitsimError):
    """A journal was edited, or another program wrote it."""


class Journal:
    """The journal of one result folder, open for writing. Evaluations of earlier sessions are read from it."""

    def __init__(self, folder: Path) -> None:
        self._whole, self._arriving = folder / _WHOLE, folder / _ARRIVING
        # Only the search knows whether the last generation is complete, so it moves to the arriving ones.
        # It is written there before it is removed here, so that a crash between the two loses nothing.
        begin, self._written, last = _last_generation(self._whole)
        later = [e for e in _read(self._arriving) if e.candidate.generation > self._written]
        self._arrived = {_place(evaluation): evaluation for evaluation in [*last, *later]}
        _replace(self._arriving, [self._arrived[place] for place in sorted(self._arrived)])
        _cut(self._whole, begin)
        self._before = _read(self._whole)
        self._next = next(self._before, None)
        self._stream: IO[str] | None = None

    def known(self, candidates: Sequence[Candidate]) -> dict[int, Evaluation]:
        """The evaluations of a generation's candidates that the journal has already.

        Generations must be asked for in their order.

        Args:
            candidates: The candidates of the generation.

        Returns:
            Evaluations by the index of the candidate.

        Raises:
            DamagedJournal: One belongs to another vector, or is missing.
        """
        generation = candidates[0].generation
        found = {i: e for (number, i), e in self._arrived.items() if number == generation}
        while self._next is not None and self._next.candidate.generation == generation:
            found[self._next.candidate.index] = self._next
            self._next = next(self._before, None)
        for candidate in candidates:
            place = f"generation {generation}, candidate {candidate.index}"
            evaluation = found.get(candidate.index)
            if evaluation is None and generation <= self._written:
                raise self._damaged(f"{place} is missing among later ones, so the file was edited or damaged")
            if evaluation is not None and evaluation.candidate != candidate:
                rule = "is not the vector that this search asks for"
                raise self._damaged(f"{place} {rule}; it was edited, or the search was started with other versions")
        return found

    def arrived(self, evaluation: Evaluation) -> None:
        """Store one evaluation at once."""
        if self._stream is None:
            self._stream = self._arriving.open("a", encoding="utf-8")
        self._stream.write(evaluation.line() + "\n")
        self._stream.flush()
        self._arrived[_place(evaluation)] = evaluation

    def close_generation(self, evaluations: Sequence[Evaluation]) -> None:
        """Move a complete generation into the ordered journal, and flush it to the disk."""
        generation = evaluations[0].candidate.generation
        if generation <= self._written:
            return
        with self._whole.open("a", encoding="utf-8") as file:
            _write(file, evaluations)
        self._written = generation
        self.close()
        # After a crash, the generation after this one may have begun to arrive already.
        self._arrived = {place: e for place, e in self._arrived.items() if place[0] > generation}
        if self._arrived:
            _replace(self._arriving, self._arrived.values())
        else:
            self._arriving.unlink(missing_ok=True)

    def close(self) -> None:
        if self._stream is not None:
            self._stream.close()
            self._stream = None

    def _damaged(self, rule: str) -> DamagedJournal:
        return DamagedJournal(Fault(f"{rule}; {_MOVE}.", Mark(str(self._whole))))


def evaluations_in(folder: Path) -> list[Evaluation]:
    """All evaluations in the journal of a folder, in the order of the search. Nothing is changed.

    Raises:
        DamagedJournal: A line was changed.
    """
    found = {_place(evaluation): evaluation for evaluation in read(folder)}
    return [found[place] for place in sorted(found)]


def read(folder: Path) -> Iterator[Evaluation]:
    """The evaluations of a folder one by one: complete generations, then what arrived of the present one.

    Raises:
        DamagedJournal: A line was changed.
    """
    yield from _read(_made(folder / _WHOLE))
    yield from _read(folder / _ARRIVING)


def old_form_notices(folder: Path) -> list[str]:
    """A notice for journals of old versions, whose lines have a hash of the vector only."""
    path = folder / _WHOLE
    first = path.open("rb").readline() if path.is_file() else b""
    if not first or is_whole(first):
        return []
    return [f"{path}: begun by an older gaitsim, so damage to its scores and metrics would not be noticed"]


def _read(path: Path) -> Iterator[Evaluation]:
    return (evaluation for _, evaluation in _placed(path))


def _placed(path: Path) -> Iterator[tuple[int, Evaluation]]:
    """The offset of each line, and its evaluation. An incomplete last line is skipped.

    Raises:
        DamagedJournal: A line was changed.
    """
    if not path.is_file():
        return
    begin = 0
    with path.open("rb") as file:
        for number, line in enumerate(file, start=1):
            text = line.removesuffix(b"\n")
            try:
                yield begin, evaluation_of(text)
            except ValueError as error:
                if _torn(line):
                    return
                rule = f"this line is not an evaluation ({error}); the file was edited or damaged"
                raise DamagedJournal(Fault(f"{rule}; {_MOVE}.", Mark(str(path), number))) from error
            begin += len(line)


def _torn(line: bytes) -> bool:
    """Whether the end of a line is missing, as after a crash. Damage would leave its digest or its newline."""
    return not line.endswith(b"\n") and not is_whole(line)


def _last_generation(path: Path) -> tuple[int, int, list[Evaluation]]:
    """The offset of the last generation in the ordered journal, the number of the one before, and its evaluations."""
    cut, before, last = 0, -1, list[Evaluation]()
    for begin, evaluation in _placed(_made(path)):
        if last and evaluation.candidate.generation != last[-1].candidate.generation:
            cut, before, last = begin, last[-1].candidate.generation, []
        last.append(evaluation)
    return cut, before, last


def _made(path: Path) -> Path:
    """The path of the ordered journal. It is created with its folder; a missing one means damage, not a new search."""
    if not path.is_file():
        raise DamagedJournal(Fault(f"this journal is missing; {_MOVE}.", Mark(str(path))))
    return path


def _place(evaluation: Evaluation) -> tuple[int, int]:
    return evaluation.candidate.generation, evaluation.candidate.index


def _replace(path: Path, evaluations: Iterable[Evaluation]) -> None:
    """Write a journal completely. The old one stays until the new one is on the disk."""
    with whole(path) as draft, draft.open("w", encoding="utf-8") as file:
        _write(file, evaluations)


def _cut(path: Path, size: int) -> None:
    """Shorten a file, and flush it to the disk."""
    with path.open("r+b") as file:
        file.truncate(size)
        flush_to_disk(file)


def _write(file: IO[str], evaluations: Iterable[Evaluation]) -> None:
    file.writelines(evaluation.line() + "\n" for evaluation in evaluations)
    flush_to_disk(file)
