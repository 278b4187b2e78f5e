"""The journal of a search: every evaluation, safe the moment it arrives, ordered once its generation is whole.

`evaluations.jsonl` holds whole generations in order, so histories can be compared byte for byte;
`arriving.jsonl` the present generation in the order of arrival. After a crash both are read, and a
torn last line is cut.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from gaitsim.errors import Fault, GaitsimError, Mark
from gaitsim.optimization.evaluation import Candidate, Evaluation, evaluation_of
from gaitsim.optimization.problem import hash_of

_MOVE = "restore it from a copy, or start a new search with --from"


class DamagedJournal(GaitsimError):
    """A journal that was edited, or that another program wrote."""


class Journal:
    """The journal of one result folder, open for writing; it knows what it held before."""

    def __init__(self, folder: Path) -> None:
        self._whole, self._arriving = folder / "evaluations.jsonl", folder / "arriving.jsonl"
        whole = list(_read_whole(folder))
        self._known = {_place(evaluation): evaluation for evaluation in [*whole, *read(self._arriving)]}
        # Whether the last generation is whole is known to the search only, so it arrives anew.
        # First it is safe there, then it is cut here: a crash between the two loses nothing.
        last = max((e.candidate.generation for e in whole), default=0)
        ordered = [e for e in self.evaluations if e.candidate.generation < last]
        _replace(self._arriving, [e for e in self.evaluations if e.candidate.generation >= last])
        _replace(self._whole, ordered)
        self._written = ordered[-1].candidate.generation if ordered else -1
        self._stream: IO[str] | None = None

    @property
    def evaluations(self) -> list[Evaluation]:
        """All evaluations known, in the order of the search."""
        return [self._known[place] for place in sorted(self._known)]

    def known(self, candidate: Candidate) -> Evaluation | None:
        """The evaluation of a candidate that was made before.

        Errors: DamagedJournal if it was of another vector, or is gone.
        """
        found = self._known.get((candidate.generation, candidate.index))
        place = f"generation {candidate.generation}, candidate {candidate.index}"
        if found is None and candidate.generation <= self._written:
            rule = f"{place} is missing among later ones, so the file was edited or damaged"
            raise DamagedJournal(Fault(f"{rule}; {_MOVE}.", Mark(str(self._whole))))
        if found is not None and hash_of(found.candidate.x) != hash_of(candidate.x):
            rule = f"{place} is not the vector that this search asks for, so it was edited or begun with other versions"
            raise DamagedJournal(Fault(f"{rule}; {_MOVE}.", Mark(str(self._whole))))
        return found

    def arrived(self, evaluation: Evaluation) -> None:
        """Keep one evaluation, now."""
        if self._stream is None:
            self._stream = self._arriving.open("a", encoding="utf-8")
        self._stream.write(evaluation.line() + "\n")
        self._stream.flush()
        self._known[_place(evaluation)] = evaluation

    def close_generation(self, generation: int, evaluations: list[Evaluation]) -> None:
        """Move a whole generation into the ordered journal, and make sure that it is on the disk."""
        if generation <= self._written:
            return
        with self._whole.open("a", encoding="utf-8") as file:
            file.writelines(evaluation.line() + "\n" for evaluation in evaluations)
            file.flush()
            os.fsync(file.fileno())
        self._written = generation
        self.close()
        # After a crash, the generation after this one may have begun to arrive already.
        later = [e for e in self.evaluations if e.candidate.generation > generation]
        if later:
            _replace(self._arriving, later)
        else:
            self._arriving.unlink(missing_ok=True)

    def close(self) -> None:
        if self._stream is not None:
            self._stream.close()
            self._stream = None


def read(path: Path) -> Iterator[Evaluation]:
    """The evaluations in a journal; a torn last line is passed over.

    Errors: DamagedJournal with the line.
    """
    if not path.is_file():
        return
    text = path.read_text(encoding="utf-8", errors="replace")
    lines = text.split("\n")
    for number, line in enumerate(lines, start=1):
        if not line:
            continue
        try:
            data = json.loads(line)
            evaluation = evaluation_of(data)
            if hash_of(evaluation.candidate.x) != data["hash"]:
                raise ValueError("its hash does not fit its vector")
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            if number == len(lines):
                return
            rule = f"this line is no evaluation ({error}); the file was edited or damaged"
            raise DamagedJournal(Fault(f"{rule}; {_MOVE}.", Mark(str(path), number))) from error
        yield evaluation


def evaluations_in(folder: Path) -> list[Evaluation]:
    """Everything that the journal of a folder holds, in the order of the search; changes nothing.

    Errors: DamagedJournal.
    """
    found = [*_read_whole(folder), *read(folder / "arriving.jsonl")]
    known = {_place(evaluation): evaluation for evaluation in found}
    return [known[place] for place in sorted(known)]


def _read_whole(folder: Path) -> Iterator[Evaluation]:
    """The ordered journal, which is made with its folder: without it, a search would begin anew unasked."""
    path = folder / "evaluations.jsonl"
    if not path.is_file():
        raise DamagedJournal(Fault(f"this journal is missing; {_MOVE}.", Mark(str(path))))
    return read(path)


def _place(evaluation: Evaluation) -> tuple[int, int]:
    return evaluation.candidate.generation, evaluation.candidate.index


def _replace(path: Path, evaluations: list[Evaluation]) -> None:
    """Write a journal whole: what stood there stays until the new one is on the disk."""
    draft = path.with_name(f"{path.name}.partial")
    with draft.open("w", encoding="utf-8") as file:
        file.writelines(evaluation.line() + "\n" for evaluation in evaluations)
        file.flush()
        os.fsync(file.fileno())
    draft.replace(path)
