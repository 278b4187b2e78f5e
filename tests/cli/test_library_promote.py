"""gaitsim library promote: a prototype joins the lab's library with docs, sources, bounds and a test of its physics."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from gaitsim.distribution import shipped_folder, shipped_specs

from .commands import Said, gaitsim

CURVE = "return math.exp(math.log(0.05) * abs((length - 1) / width) ** 3)"
PHYSICS = """

def test_its_outputs_are_numbers() -> None:
    made = trial()
    made.call("output")
    assert all(np.isfinite(made.arrays[3]))
"""


@pytest.fixture
def alice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Path:
    """A lab, and in it a project with a controller of its own, its test, and a spec that uses it; the project."""
    monkeypatch.delenv("GAITSIM_RESULTS", raising=False)
    project = tmp_path / "projects" / "alice"
    project.mkdir(parents=True)
    Path(tmp_path / "library").mkdir()
    Path(tmp_path / "lab.yaml").write_text("gaitsim: 1\n", encoding="utf-8")
    Path(project / "project.yaml").write_text("gaitsim: 1\nproject: alice\n", encoding="utf-8")
    monkeypatch.chdir(project)
    text = shipped_specs()["hopping_geyer2003"].read_text(encoding="utf-8")
    text = text.replace("duration: 20 s", "duration: 2 s").replace("controller/muscle_feedback", "controller/mine")
    Path("hopper.yaml").write_text(text, encoding="utf-8")
    assert gaitsim(capsys, "library", "new", "controller", "mine", "--like", "controller/muscle_feedback").code == 0
    test = Path("tests/test_mine.py")
    test.write_text(test.read_text(encoding="utf-8") + PHYSICS, encoding="utf-8")
    return project


def promote(capsys: pytest.CaptureFixture[str], *words: str) -> Said:
    return gaitsim(capsys, "library", "promote", *words)


def test_it_moves_with_its_test_and_serves_the_project_from_there(
    alice: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = json.loads(gaitsim(capsys, "run", "hopper.yaml", "--no-save", "--json").out)["metrics"]
    said = promote(capsys, "controller/mine", "--json")
    assert said.code == 0, said.err
    lab = alice.parents[1]
    kept = json.loads(said.out)["files"]
    assert kept == [str(lab / "library/controller/mine.py"), str(lab / "tests/library/test_mine.py")]
    assert 'Path(__file__).parents[2] / "library"' in Path(kept[1]).read_text(encoding="utf-8")
    assert not Path("components/controller/mine.py").exists() and not Path("tests/test_mine.py").exists()
    after = json.loads(gaitsim(capsys, "run", "hopper.yaml", "--no-save", "--json").out)["metrics"]
    assert after == before
    again = promote(capsys, "controller/mine")
    assert again.code == 2
    assert again.err.startswith("controller/mine: components has no such component. ")


@pytest.mark.slow
def test_a_library_that_the_project_does_not_look_into_gets_a_copy(
    alice: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = promote(capsys, "controller/mine", "--to", "../../shared/library")
    assert said.code == 0, said.err
    assert said.err.endswith("components keeps its copy, because its specs do not look into ../../shared/library\n")
    assert Path("components/controller/mine.py").is_file()
    assert Path("../../shared/library/controller/mine.py").is_file()


def lack_of(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """Why it is not promoted; nothing has changed."""
    said = promote(capsys, "controller/mine", *words)
    assert said.code == 3
    assert list(Path("../../library").rglob("*.py")) == [] and Path("components/controller/mine.py").is_file()
    return said.err


def test_without_docs_sources_or_bounds_it_stays(alice: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = Path("components/controller/mine.py")
    text = path.read_text(encoding="utf-8")
    assert 'source="geyer2003"' in text
    path.write_text(text.replace('source="geyer2003"', 'source="nobody1999"', 1), encoding="utf-8")
    assert "components/controller/mine.py:" in (told := lack_of(capsys))
    assert "the source nobody1999 is in no references.bib." in told
    # A source of the project goes along.
    bibtex = "@article{nobody1999,\n  author = {Nobody},\n  title = {Nothing},\n  year = {1999}\n}\n"
    Path("components/references.bib").write_text(bibtex, encoding="utf-8")
    assert promote(capsys, "controller/mine").code == 0
    assert Path("../../library/references.bib").read_text(encoding="utf-8") == bibtex


def test_without_a_test_of_its_physics_it_stays(alice: Path, capsys: pytest.CaptureFixture[str]) -> None:
    test = Path("tests/test_mine.py")
    text = test.read_text(encoding="utf-8")
    test.write_text(text.removesuffix(PHYSICS), encoding="utf-8")
    assert lack_of(capsys) == (
        "tests/test_mine.py: these are only the tests that gaitsim library new writes; add one of the physics, such as "
        "a force that the paper has for a length.\n"
    )
    test.write_text(text.replace("all(np.isfinite(made.arrays[3]))", "made.y.excitation == 2"), encoding="utf-8")
    told = lack_of(capsys)
    assert told.startswith("tests/test_mine.py: this test does not pass beside the library, so nothing was promoted; ")
    assert "test_its_outputs_are_numbers" in told
    test.write_text('"""controller/mine"""\n\n\ndef test_nothing() -> None:\n    assert True\n', encoding="utf-8")
    assert "this test calls nothing" in lack_of(capsys)
    test.write_text(text.replace("controller/mine", "controller/yours"), encoding="utf-8")
    assert "this test does not name controller/mine" in lack_of(capsys)
    test.unlink()
    assert lack_of(capsys) == (
        "tests/test_mine.py: there is no test of controller/mine; write it here, or name it: --test FILE. "
        "gaitsim library new writes the beginning of one.\n"
    )


def test_one_that_is_there_is_replaced_only_if_its_users_stay_what_they_are(
    alice: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    muscle = Path("components/muscle/geyer2003.py")
    muscle.parent.mkdir()
    text = (shipped_folder() / "muscle" / "geyer2003.py").read_text(encoding="utf-8")
    muscle.write_text(text.replace(CURVE, CURVE.replace("return ", "return 1.01 * ")), encoding="utf-8")
    old = Path("tests/test_mine.py").read_text(encoding="utf-8")
    test = old.replace("controller/mine", "muscle/geyer2003")
    Path("tests/test_geyer2003.py").write_text(test, encoding="utf-8")
    lab = alice.parents[1]
    users = lab / "specs"
    users.mkdir()
    shutil.move("hopper.yaml", users / "hopper.yaml")
    text = (users / "hopper.yaml").read_text(encoding="utf-8")
    (users / "hopper.yaml").write_text(text.replace("controller/mine", "controller/muscle_feedback"), encoding="utf-8")
    assert gaitsim(capsys, "archive", "record", str(users)).code == 0
    words = ("muscle/geyer2003", str(users))
    said = promote(capsys, *words)
    assert said.code == 2
    assert said.err.startswith("muscle/geyer2003 exists already (")
    assert said.err.endswith("; choose another name, or use --replace, which runs all its users first.\n")
    said = promote(capsys, *words, "--replace")
    assert said.code == 4
    assert "muscle/geyer2003: 1 of its users would not do what was recorded: " in said.err
    assert "apex_height" in said.out and muscle.is_file() and not (lab / "library/muscle").exists()
    said = promote(capsys, *words, "--replace", "--force")
    assert said.code == 0, said.err
    assert (lab / "library/muscle/geyer2003.py").is_file() and not muscle.exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["controller/other"], "controller/other: components has no such component. Here are: controller/mine.\n"),
        (["controller/mine", "--to", "components"], "--to components: the component exists already; name another"),
    ],
)
def test_what_cannot_be_promoted_is_told(
    alice: Path, words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    found = promote(capsys, *words)
    assert found.code == 2
    assert found.err.startswith(said)


def test_without_a_lab_a_library_must_be_named(alice: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (alice.parents[1] / "lab.yaml").unlink()
    found = promote(capsys, "controller/mine")
    assert (found.code, found.err) == (
        2,
        "there is no lab here, whose library it could go to; name a library: --to FOLDER.\n",
    )
