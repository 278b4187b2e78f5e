"""gaitsim results list, note and remove; and what a result remembers of the repository of its spec."""

from __future__ import annotations

import json
import subprocess
from io import StringIO
from pathlib import Path

import pytest

from gaitsim.distribution import shipped_specs
from gaitsim.results.lock import Lock

from .commands import Said, gaitsim

Capture = pytest.CaptureFixture[str]
BRIEF = ("--mode", "normal", "--set", "simulate.duration=20 ms", "--json")


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    for number, (key, value) in enumerate({"user.name": "Alice", "user.email": "a@b"}.items()):
        monkeypatch.setenv(f"GIT_CONFIG_KEY_{number}", key)
        monkeypatch.setenv(f"GIT_CONFIG_VALUE_{number}", value)
    monkeypatch.setenv("GIT_CONFIG_COUNT", "2")


def ran(capsys: Capture, spec: str = "hopping_geyer2003") -> Path:
    path = spec if spec.endswith(".yaml") else str(shipped_specs()[spec])
    return Path(json.loads(gaitsim(capsys, "run", path, *BRIEF).out)["result"])


def edited(folder: Path, **more: object) -> None:
    path = folder / "manifest.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | more))


def listed(capsys: Capture, *words: str) -> list[str]:
    said = gaitsim(capsys, "results", "list", "--json", *words)
    assert said.code == 0, said.err
    return [Path(row["result"]).name for row in json.loads(said.out)["results"]]


def test_results_are_filtered_and_sorted(capsys: Capture) -> None:
    one, two, three = ran(capsys), ran(capsys), ran(capsys, "hopping_leg_mass")
    edited(one, kind="optimize", best_score=-1.0, evaluations=7, created="2026-01-01T10:00:00+00:00")
    edited(two, kind="optimize", best_score=-2.0, evaluations=3, created="2026-02-01T10:00:00+00:00", status="stopped")
    gaitsim(capsys, "results", "note", str(three), "the good one")
    assert listed(capsys) == [one.name, two.name, three.name]
    assert listed(capsys, "--sort", "score") == [two.name, one.name, three.name]
    assert listed(capsys, "--sort", "evaluations") == [two.name, one.name, three.name]
    assert listed(capsys, "--name", "hopping_leg*") == [three.name]
    assert listed(capsys, "--kind", "optimize") == [one.name, two.name]
    assert listed(capsys, "--status", "complete", "--kind", "optimize") == [one.name]
    assert listed(capsys, "--since", "2026-01-02") == [two.name, three.name]
    assert listed(capsys, "--uses", "muscle/geyer2010") == [three.name]
    assert listed(capsys, "--noted", "GOOD") == [three.name]
    assert "Alice <a@b>: the good one" in gaitsim(capsys, "results", "list").out


def test_a_search_that_has_not_ended_is_listed_with_its_last_whole_generation(capsys: Capture) -> None:
    folder = ran(capsys)
    path = folder / "manifest.json"
    manifest = {k: v for k, v in json.loads(path.read_text()).items() if k not in ("best_score", "evaluations")}
    path.write_text(json.dumps(manifest | {"kind": "optimize", "status": "interrupted"}))
    head = "generation,evaluations,best,generation_best,median,spread,failed\n"
    for rows, found in (
        ("", (None, None)),
        ("0,1,-0.1,-0.1,-0.1,0.0,0\n1,9,-0.25,-0.2,-0.1,0.1,2\n", (-0.25, 9)),
        ("0,1,-0.1,-0.1,-0.1,0.0,0\n1,9,-0.2", (-0.1, 1)),
    ):
        (folder / "generations.csv").write_text(head + rows)
        (row,) = json.loads(gaitsim(capsys, "results", "list", "--json").out)["results"]
        assert (row["best_score"], row["evaluations"]) == found


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--kind", "walk"], "--kind walk: write run or optimize."),
        (["--status", "dead"], "--status dead: write complete or interrupted or running or damaged."),
        (["--since", "monday"], "--since monday: this is not a day; write one such as 2026-11-22."),
        (["--uses", "geyer2003"], "--uses geyer2003: write a component as KIND/NAME, such as muscle/geyer2003."),
    ],
)
def test_a_filter_that_fits_nothing_is_told(words: list[str], said: str, capsys: Capture) -> None:
    found = gaitsim(capsys, "results", "list", *words)
    assert (found.code, found.err) == (2, f"{said}\n")


def test_notes_are_kept_and_change_no_digest(capsys: Capture) -> None:
    folder = ran(capsys)
    for words in (["first"], ["second,", "of", "two words\nand two lines"]):
        assert gaitsim(capsys, "results", "note", str(folder), *words).code == 0
    notes = (folder / "README.md").read_text().partition("## Notes")[2]
    assert notes.index("Alice <a@b>: first") < notes.index("second, of two words\n  and two lines")
    assert "second, of two words" in gaitsim(capsys, "results", "show", str(folder)).out
    assert gaitsim(capsys, "results", "verify", str(folder)).code == 0
    assert gaitsim(capsys, "results", "note", str(folder), " ").err == "this note is empty; write some words.\n"
    assert gaitsim(capsys, "results", "note", "results/nosuch", "x").code == 3


def test_results_are_removed_by_those_who_say_yes(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    folder, other = ran(capsys), ran(capsys)

    def asked(answer: str) -> Said:
        terminal = StringIO(f"{answer}\n")
        monkeypatch.setattr(terminal, "isatty", lambda: True)
        monkeypatch.setattr("sys.stdin", terminal)
        return gaitsim(capsys, "results", "remove", str(folder))

    said = gaitsim(capsys, "results", "remove", str(folder), str(other))
    rule = f"nothing was removed: no one can be asked here; to remove {folder}, {other}, add --yes."
    assert (said.code, said.err) == (2, f"{rule}\n")
    assert "nothing was removed" in asked("n").err
    assert folder.is_dir()
    # All names are looked at before one is removed.
    assert gaitsim(capsys, "results", "remove", str(folder), "results/nosuch", "--yes").code == 3
    assert folder.is_dir()
    assert asked("y").code == 0
    assert [path.name for path in Path("results").iterdir()] == [other.name]


def test_what_is_running_or_no_result_is_not_removed(capsys: Capture) -> None:
    folder = ran(capsys)
    with Lock(folder):
        lock = json.loads((folder / "lock").read_text())
        (folder / "lock").write_text(json.dumps(lock | {"process": 1, "began": None}))
        said = gaitsim(capsys, "results", "remove", str(folder), "--yes")
        assert said.code == 3
        assert "process 1 on " in said.err
        assert "is writing this result; wait for it" in said.err
    assert folder.is_dir()
    Path("results/link").symlink_to(folder.absolute())
    said = gaitsim(capsys, "results", "remove", "results/link", "--yes")
    assert said.err == f"results/link: this is a link to {folder.resolve()}; remove that, or the link by hand.\n"
    Path("precious").mkdir()
    assert gaitsim(capsys, "results", "remove", "precious", "--yes").code == 3
    assert Path("precious").is_dir()


def test_how_far_off_a_result_is(capsys: Capture) -> None:
    folder = ran(capsys)
    path = folder / "evaluations.jsonl"
    row = json.loads(path.read_text())
    name = next(name for name, value in row["metrics"].items() if value)
    row["metrics"][name] *= 1.001
    path.write_text(json.dumps(row) + "\n")
    said = gaitsim(capsys, "results", "verify", str(folder))
    assert said.code == 4
    assert said.out.startswith(f"run 0: {name}: ")
    assert "numbers differ by up to 1.0e-03 of their value, with the versions and the processor that made" in said.err


def test_a_result_remembers_the_repository_of_its_spec(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the command is given elsewhere."""

    def git(*words: str) -> str:
        ran = subprocess.run(["git", "-C", "lab", *words], check=True, capture_output=True, text=True)
        return ran.stdout.strip()

    Path("lab").mkdir()
    git("init")
    spec = Path("lab/hop.yaml")
    spec.write_text(shipped_specs()["hopping_geyer2003"].read_text(encoding="utf-8"))
    git("add", "-A")
    git("commit", "-m", "the hopper")
    clean = ran(capsys, str(spec))
    commit = json.loads((clean / "manifest.json").read_text())["commit"]
    assert commit == {"hash": git("rev-parse", "HEAD"), "dirty": False}
    assert not (clean / "changes.diff").exists()
    spec.write_text(spec.read_text(encoding="utf-8").replace("80 kg", "81 kg"))
    Path("lab/new.txt").write_text("x")
    dirty = ran(capsys, str(spec))
    assert json.loads((dirty / "manifest.json").read_text())["commit"]["dirty"]
    found = (dirty / "changes.diff").read_text()
    assert found.startswith("#  M hop.yaml\n# ?? new.txt\ndiff --git a/hop.yaml")
    assert "81 kg" in found
    assert "changes.diff" in gaitsim(capsys, "results", "show", str(dirty)).out
    # The patch leads from the commit to what was run.
    git("checkout", "hop.yaml")
    patch = (dirty / "changes.diff").absolute()
    git("apply", str(patch))
    assert "81 kg" in spec.read_text(encoding="utf-8")
    monkeypatch.setattr("gaitsim.results.provenance._LARGEST", 100)
    large = (ran(capsys, str(spec)) / "changes.diff").read_text()
    assert "# a patch of 0.0 MiB is left out; the most that is kept is " in large
