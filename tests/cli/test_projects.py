"""gaitsim new project, gaitsim projects, and which library serves a part: in a lab made by the test."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from gaitsim.distribution import shipped_folder, shipped_specs

from .commands import Said, gaitsim

Capture = pytest.CaptureFixture[str]
BRIEF = ("--mode", "normal", "--set", "simulate.duration=20 ms", "--json")


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    folder = tmp_path / "lab"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


def ran(capsys: Capture, spec: str) -> dict[str, object]:
    said = gaitsim(capsys, "run", spec, *BRIEF)
    assert said.code == 0, said.err
    return dict(json.loads(said.out))


def begun(capsys: Capture, name: str, *words: str) -> Said:
    said = gaitsim(capsys, "new", "project", name, *words)
    assert said.code == 0, said.err
    return said


def use_own(spec: Path, component: str) -> None:
    """The muscle's feedback, replaced by a component."""
    text = spec.read_text(encoding="utf-8")
    spec.write_text(f"{text}parts:\n  feedback: {{use: {component}}}\n", encoding="utf-8")


def test_a_project_has_the_result_it_came_from(lab: Path, capsys: Capture) -> None:
    before = ran(capsys, str(shipped_specs()["hopping_leg_mass"]))
    result = Path(str(before["result"]))
    begun(capsys, "alice", "--from", str(result))
    folder = lab / "projects" / "alice"
    assert (folder / "hopping_leg_mass.yaml").read_text() == (result / "spec.yaml").read_text()
    assert {path.name for path in folder.iterdir()} == {
        *("alice.yaml", "alice.tuned.yaml", "hopping_leg_mass.yaml", "hopping_leg_mass.tuned.yaml"),
        *("project.yaml", "README.md", ".gitignore", "components"),
    }
    after = ran(capsys, "projects/alice/alice.yaml")
    assert after["metrics"] == before["metrics"]
    readme = (folder / "README.md").read_text(encoding="utf-8")
    assert f"from `{result.name}`" in readme
    assert f"gaitsim results compare ../../{result} results/RESULT" in readme


def test_the_author_is_whom_git_knows(lab: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    for number, (key, value) in enumerate({"user.name": "Alice", "user.email": "alice@lab.org"}.items()):
        monkeypatch.setenv(f"GIT_CONFIG_KEY_{number}", key)
        monkeypatch.setenv(f"GIT_CONFIG_VALUE_{number}", value)
    monkeypatch.setenv("GIT_CONFIG_COUNT", "2")
    begun(capsys, "alice")
    rows = json.loads(gaitsim(capsys, "projects", "--json").out)["projects"]
    assert [(row["name"], row["author"], row["from"]) for row in rows] == [
        ("alice", "Alice <alice@lab.org>", "hopping_leg_mass")
    ]
    assert Path(rows[0]["spec"]) == lab / "projects" / "alice" / "alice.yaml"


def test_projects_are_found_from_anywhere_below_the_lab(
    lab: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun(capsys, "alice")
    monkeypatch.chdir(lab / "projects" / "alice" / "components")
    begun(capsys, "bob")
    assert [path.name for path in sorted((lab / "projects").iterdir())] == ["alice", "bob"]
    listed = gaitsim(capsys, "projects").out
    assert "../../bob/bob.yaml" in listed
    assert "../alice.yaml" in listed
    monkeypatch.chdir(lab.parent)
    said = gaitsim(capsys, "projects")
    assert (said.code, said.err) == (
        2,
        "no folder above this one has a lab.yaml, so this is not a lab; gaitsim new project NAME makes one.\n",
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["project", "alice"], "alice: {lab}/projects/alice exists already, started by "),
        (["project", "ALICE"], "ALICE: {lab}/projects/alice exists already, started by "),
        (
            ["project", "taken"],
            "taken: {lab}/projects/taken exists already; nothing was changed. Choose another name.",
        ),
        (["project", "../x"], "../x: a project's name is that of its folder and its spec: letters, digits, _ and -, a"),
        (
            ["project", "new", "--from", "nosuch"],
            "--from nosuch: this is neither a result, nor a spec, nor a shipped model",
        ),
        (["one", "two"], "two: one folder is made at a time; write gaitsim new FOLDER, or gaitsim new project NAME."),
    ],
)
def test_what_cannot_be_a_project_is_told(words: list[str], said: str, lab: Path, capsys: Capture) -> None:
    begun(capsys, "alice")
    (lab / "projects" / "taken").mkdir()
    before = sorted(lab.rglob("*"))
    found = gaitsim(capsys, "new", *words)
    assert found.code == 2
    assert found.err.startswith(said.format(lab=lab))
    assert sorted(lab.rglob("*")) == before


def test_which_library_serves_each_part(lab: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    begun(capsys, "alice")
    inner = Path("muscle/geyer2010.py")
    (lab / "library" / inner.parent).mkdir(parents=True)
    (lab / "library" / inner).write_text((shipped_folder() / inner).read_text(encoding="utf-8") + "\n# ours\n")
    monkeypatch.chdir(lab / "projects" / "alice")
    assert gaitsim(capsys, "library", "new", "controller", "my_reflex").code == 0
    use_own(Path("alice.yaml"), "controller/my_reflex")
    rows = json.loads(gaitsim(capsys, "show", "alice.yaml", "--json").out)["tree"]
    serves = {row["address"]: row["library"] for row in rows}
    assert (serves["feedback"], serves["extensor"], serves["ground"]) == ("project", "lab", "shipped")
    tree = gaitsim(capsys, "show", "alice.yaml").out
    assert any(line.split() == ["feedback", "controller/my_reflex", "project"] for line in tree.splitlines())
    result = str(ran(capsys, "alice.yaml")["result"])
    rows = json.loads(gaitsim(capsys, "show", result, "--json").out)["tree"]
    assert {row["library"] for row in rows} == {"result"}
    # A spec further down in the project has its components too.
    Path("studies").mkdir()
    Path("studies/deeper.yaml").write_text("gaitsim: 1\nextends: ../alice.yaml\n", encoding="utf-8")
    rows = json.loads(gaitsim(capsys, "show", "studies/deeper.yaml", "--json").out)["tree"]
    assert next(row["library"] for row in rows if row["address"] == "feedback") == "project"


def test_a_project_copies_what_no_library_has(lab: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    begun(capsys, "bob")
    monkeypatch.chdir("projects/bob")
    assert gaitsim(capsys, "library", "new", "controller", "my_reflex").code == 0
    use_own(Path("bob.yaml"), "controller/my_reflex")
    before = ran(capsys, "bob.yaml")
    said = begun(capsys, "alice", "--from", str(before["result"]))
    assert "components/controller/my_reflex.py is a copy, because no library has it" in said.err
    monkeypatch.chdir(lab)
    assert ran(capsys, "projects/alice/alice.yaml")["metrics"] == before["metrics"]
    # Of a spec of one's own likewise, with the comments in it.
    begun(capsys, "carol", "--from", "projects/bob/hopping_leg_mass.yaml")
    copied = Path("projects/carol/hopping_leg_mass.yaml").read_text(encoding="utf-8")
    assert copied == Path("projects/bob/hopping_leg_mass.yaml").read_text(encoding="utf-8")


def test_a_project_has_the_whole_search_and_the_whole_study(lab: Path, capsys: Capture) -> None:
    spec = lab / "hop.yaml"
    text = shipped_specs()["hopping_geyer2003"].read_text(encoding="utf-8").partition("optimize:")[0]
    text = text.replace("value: {from: apex_height}", "value: {from: upright}")  # a score without a hop
    more = "optimize: {episodes: [{body.mass: 70 kg}, {body.mass: 80 kg}], population: 4, generations: 1}\n"
    spec.write_text(f"{text}{more}study: [{{body.mass: 60 kg}}, {{body.mass: 90 kg}}]\n", encoding="utf-8")
    begun(capsys, "alice", "--from", "hop.yaml")
    assert Path("projects/alice/hop.yaml").read_text(encoding="utf-8") == spec.read_text(encoding="utf-8")
    words = ("--mode", "normal", "--set", "simulate.duration=20 ms", "--set", "study=null", "--workers", "0", "--json")
    found = json.loads(gaitsim(capsys, "optimize", "hop.yaml", *words).out)
    begun(capsys, "bob", "--from", found["result"])
    copied = Path("projects/bob/hop.yaml").read_text(encoding="utf-8")
    assert copied == (Path(found["result"]) / "spec.yaml").read_text(encoding="utf-8")
    assert "episodes" in copied


def test_two_people_begin_at_once_and_their_work_merges(
    lab: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def git(*words: str) -> None:
        told = ["-c", "user.name=A", "-c", "user.email=a@b", "-c", "init.defaultBranch=main"]
        subprocess.run(["git", *told, *words], check=True, capture_output=True)

    git("init")
    git("commit", "--allow-empty", "-m", "an empty lab")
    for name in ("alice", "bob"):
        git("checkout", "-b", name, "main")
        begun(capsys, name)
        git("add", "-A")
        git("commit", "-m", name)
    git("merge", "alice")
    rows = json.loads(gaitsim(capsys, "projects", "--json").out)["projects"]
    assert [row["name"] for row in rows] == ["alice", "bob"]
