"""Bad input: every folder here is one mistake, with the exact words and the exit code it gets.

A folder holds `spec.yaml` and what else the case needs, `expected.txt` (the exit code, then what
stands on stderr), and maybe `command`: one command a line, each of which must say the same.
After a message was changed on purpose: GAITSIM_WRITE_MESSAGES=1 pytest tests/messages, and read the diff.
"""

from __future__ import annotations

import os
import shlex
import shutil
from pathlib import Path

import pytest
from gaitsim.cli.main import main
from gaitsim.distribution import shipped_folder

HERE = Path(__file__).parent
DEFAULT = "gaitsim check spec.yaml"


def commands(case: Path) -> list[str]:
    own = case / "command"
    return own.read_text(encoding="utf-8").splitlines() if own.exists() else [DEFAULT]


CASES = [
    pytest.param(folder, command, id=f"{folder.name}-{i}" if i else folder.name)
    for folder in sorted(path for path in HERE.iterdir() if (path / "spec.yaml").exists())
    for i, command in enumerate(commands(folder))
]


def files_in(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() if p.is_file() else b"" for p in folder.rglob("*")}


@pytest.mark.parametrize(("case", "command"), CASES)
def test_a_mistake_is_told_in_these_words(
    case: Path, command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "study"
    shutil.copytree(case, place, ignore=shutil.ignore_patterns("expected.txt", "command"))
    before = files_in(place)
    monkeypatch.chdir(place)
    with pytest.raises(SystemExit) as ended:
        main(shlex.split(command)[1:])
    out, err = capsys.readouterr()
    said = f"exit {int(ended.value.code or 0)}\n{err}".replace(str(shipped_folder()), "library")
    expected = case / "expected.txt"
    if os.environ.get("GAITSIM_WRITE_MESSAGES") and command == commands(case)[0]:
        expected.write_text(said, encoding="utf-8")
    assert said == expected.read_text(encoding="utf-8")
    assert "Traceback" not in err
    assert out == ""
    assert files_in(place) == before
