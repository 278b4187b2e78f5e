"""One command of gaitsim in this process: its exit code and what it says."""

from __future__ import annotations

from typing import NamedTuple

import pytest

from gaitsim.cli.main import main


class Said(NamedTuple):
    """The exit code, stdout and stderr."""

    code: int
    out: str
    err: str


def gaitsim(capsys: pytest.CaptureFixture[str], *words: str) -> Said:
    """Run a command."""
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    code = ended.value.code
    assert isinstance(code, int)
    return Said(code, *capsys.readouterr())
