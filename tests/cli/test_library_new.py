"""gaitsim library new: a component that works as it is, and its test."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder

from .commands import gaitsim

KINDS = sorted(path.parent.name for path in shipped_folder().glob("*/kind.yaml"))


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_a_beginning_that_passes_the_check(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "library", "new", kind, "my_part")
    assert said.code == 0
    assert said.out == f"components/{kind}/my_part.py\ntests/test_my_part.py\n"
    checked = gaitsim(capsys, "library", "check", "components")
    assert (checked.code, checked.err) == (0, "")


@pytest.mark.slow
def test_the_test_that_is_written_passes() -> None:
    for kind, name in (("muscle", "my_muscle"), ("measure", "my_measure"), ("segment", "my_segment")):
        subprocess.run([sys.executable, "-m", "gaitsim.cli.main", "library", "new", kind, name], check=True)
    ran = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests"], capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stdout
    assert "9 passed" in ran.stdout


def test_a_copy_is_the_other_one_under_its_own_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert gaitsim(capsys, "library", "new", "muscle", "my_muscle", "--like", "muscle/geyer2010").code == 0
    mine, theirs = Path("components/muscle/my_muscle.py"), shipped_folder() / "muscle" / "geyer2010.py"
    assert mine.read_text() == theirs.read_text().replace("class Geyer2010(", "class MyMuscle(")
    assert gaitsim(capsys, "library", "new", "segment", "my_thigh", "--like", "segment/thigh").code == 0
    assert Path("components/segment/my_thigh.yaml").is_file()


def test_nothing_is_written_over(capsys: pytest.CaptureFixture[str]) -> None:
    Path("tests").mkdir()
    Path("tests/test_my_muscle.py").write_text("mine")
    said = gaitsim(capsys, "library", "new", "muscle", "my_muscle")
    assert said.code == 3
    assert said.err.startswith("tests/test_my_muscle.py: this exists already and is never overwritten")
    assert Path("tests/test_my_muscle.py").read_text() == "mine"
    assert not Path("components").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["muscl", "mine"], "there is no kind muscl. Did you mean muscle? Or, for a kind of your own, write"),
        (
            ["muscle", "Mine"],
            "Mine is not a name for a component; write small letters, digits and _, such as my_muscle.",
        ),
        (["muscle", "kind"], "kind is not a name for a component"),
        (["muscle", "class"], "class is not a name for a component"),
        (["muscle", "geyer2010"], "muscle/geyer2010 exists already ("),
        (["muscle", "mine", "--like", "path/sites"], "--like path/sites: this is not a muscle; choose one of muscle/"),
    ],
)
def test_what_cannot_be_made_is_told(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = gaitsim(capsys, "library", "new", *words)
    assert found.code == 2
    assert found.err.startswith(said)
    assert not Path("components").exists()


def test_skeletons_are_no_components_of_the_library() -> None:
    library = Library((shipped_folder(),))
    assert not [reference for reference in library.references() if "skeleton" in reference]
