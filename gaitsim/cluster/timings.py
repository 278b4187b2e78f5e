"""timings.csv: the time and the host of each evaluation. They are not part of the journal, which is the same
everywhere.
"""

from __future__ import annotations

from pathlib import Path

from gaitsim.optimization.evaluation import Candidate


class Timings:
    """Appends a line for each evaluation of this session."""

    def __init__(self, folder: Path) -> None:
        path = folder / "timings.csv"
        whole = path.read_bytes().rfind(b"\n") + 1 if path.is_file() else 0
        self._stream = path.open("ab")
        self._stream.truncate(whole)  # a torn last line goes
        if not whole:
            self._stream.write(b"generation,index,seconds,host\n")

    def add(self, candidate: Candidate, seconds: float, where: str) -> None:
        self._stream.write(f"{candidate.generation},{candidate.index},{seconds:.6f},{where}\n".encode())
        self._stream.flush()

    def close(self) -> None:
        self._stream.close()
