"""What tests of gaitsim optimize start from."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from optimization.searches import Ended, Study

from gaitsim.cli.main import main

from .files import SMALL


@pytest.fixture(autouse=True)
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Study:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    return Study(tmp_path)


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Any:
    def run(*words: str) -> Ended:
        with pytest.raises(SystemExit) as ended:
            main(list(words))
        out, err = capsys.readouterr()
        assert "Traceback" not in err, err
        return Ended(int(ended.value.code or 0), out, err)

    return run


@pytest.fixture(scope="session")
def complete(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results folder of a small search, for all to copy."""
    study = Study(tmp_path_factory.mktemp("complete"))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(study.folder)
        patch.setenv("GAITSIM_STATE", str(study.folder / "state"))
        with pytest.raises(SystemExit) as ended:
            main(["optimize", "spec.yaml", *SMALL])
    assert ended.value.code == 0
    return study.folder


@pytest.fixture
def begun(complete: Path, study: Study) -> Path:
    """A small search that is complete."""
    for name in ("results", "state"):
        shutil.copytree(complete / name, study.folder / name)
    return study.result.relative_to(study.folder)
