"""A result as a file for a colleague: the same bytes each time, and nothing that no result holds gets in."""

from __future__ import annotations

import io
import json
import shutil
import stat
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from cli.commands import Said
from cli.commands import gaitsim as run_gaitsim

from gaitsim.distribution import shipped_folder
from gaitsim.results.lock import Lock

from .test_trust import OURS, SPEC, signed

Command = Callable[..., Said]
Entries = list[tuple[str, str]]


@pytest.fixture(autouse=True)
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))


@pytest.fixture
def gaitsim(capsys: pytest.CaptureFixture[str]) -> Command:
    return lambda *words: run_gaitsim(capsys, *words)


@pytest.fixture
def result(gaitsim: Command) -> Path:
    """A run of a model with a component of one's own."""
    brake = Path("components/controller/brake.py")
    brake.parent.mkdir(parents=True)
    brake.write_text(OURS)
    Path("brake.yaml").write_text(SPEC)
    said = gaitsim("run", "brake.yaml", "--mode", "normal", "--json")
    return Path(json.loads(said.out)["result"])


def elsewhere(monkeypatch: pytest.MonkeyPatch, path: Path) -> None:
    """A colleague's machine: another folder, and no memory of what ran."""
    path.mkdir()
    monkeypatch.chdir(path)
    monkeypatch.setenv("GAITSIM_STATE", str(path / "state"))


def test_a_colleague_verifies_it(
    result: Path, gaitsim: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gaitsim("results", "note", str(result), "look at this")
    (result / "figures").mkdir()
    (result / "figures" / "a.png").write_bytes(b"x")
    assert gaitsim("results", "export", str(result)).out == f"{result.name}.zip\n"
    elsewhere(monkeypatch, tmp_path / "colleague")
    said = gaitsim("results", "import", f"../{result.name}.zip")
    assert said.code == 0, said.err
    made = Path("results") / result.name
    lines = [line.split() for line in said.out.splitlines()]
    assert ["components/controller/brake.py", *"not in your libraries".split(), *"not known to this machine".split()] in lines
    assert f"nothing of it was run. Read its code before --trust runs it: {made}/components/controller/brake.py" in said.err
    assert f"next: gaitsim results verify {made} --trust" in said.err
    assert gaitsim("results", "verify", str(made)).code == 3
    verified = gaitsim("results", "verify", str(made), "--trust")
    assert (verified.code, verified.out) == (0, f"{made}: 1 of 1 runs reproduced bit for bit\n")
    assert "look at this" in (made / "README.md").read_text()
    assert not (made / "figures").exists()
    again = gaitsim("results", "import", f"../{result.name}.zip")
    rule = "a result of this name exists already; nothing was changed. Choose another --results."
    assert (again.code, again.err) == (3, f"{made}: {rule}\n")
    assert gaitsim("results", "import", f"../{result.name}.zip", "--results", "other").code == 0


def test_the_same_result_gives_the_same_bytes(result: Path, gaitsim: Command) -> None:
    gaitsim("results", "export", str(result), "--out", "one.zip")
    for path in result.rglob("*"):
        path.touch()
    gaitsim("results", "export", str(result), "--out", "two.zip")
    assert Path("one.zip").read_bytes() == Path("two.zip").read_bytes()
    taken = gaitsim("results", "export", str(result), "--out", "two.zip")
    assert (taken.code, taken.err) == (
        3,
        "two.zip: this exists already and is never overwritten; choose another --out.\n",
    )


def test_what_was_edited_or_is_being_written_is_not_exported(result: Path, gaitsim: Command) -> None:
    manifest = json.loads((result / "manifest.json").read_text())
    (result / "manifest.json").write_text(json.dumps(manifest | {"status": "running"}))
    with Lock(result):
        said = gaitsim("results", "export", str(result))
    assert said.err == f"{result}: its search is running; wait for its end, or stop it and resume it later.\n"
    (result / "components" / "controller" / "brake.py").write_text(OURS + "\n")
    said = gaitsim("results", "export", str(result))
    assert said.code == 3
    assert said.err.startswith(f"{result}: components/controller/brake.py was edited after it was made")
    assert not list(Path().glob("*.zip"))


def test_what_differs_from_ones_own_library_is_told(
    result: Path, gaitsim: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gaitsim("results", "export", str(result), "--out", "r.zip")
    elsewhere(monkeypatch, tmp_path / "colleague")
    mine = Path("components/controller/brake.py")
    mine.parent.mkdir(parents=True)
    mine.write_text(OURS.replace("-1.0", "-2.0"))
    rows = json.loads(gaitsim("results", "import", "../r.zip", "--json").out)["components"]
    brake = next(row for row in rows if row["file"].endswith("brake.py"))
    assert brake == {"file": "components/controller/brake.py", "library": "components", "same": False, "known": False}
    kind = next(row for row in rows if row["file"].endswith("kind.yaml"))
    assert (kind["library"], kind["same"], kind["known"]) == ("shipped", True, True)
    assert (shipped_folder() / "controller" / "kind.yaml").is_file()


def packed(entries: Entries, change: Callable[[zipfile.ZipInfo], None] = lambda info: None) -> None:
    with zipfile.ZipFile("r.zip", "w", zipfile.ZIP_DEFLATED) as file:
        for name, text in entries:
            info = zipfile.ZipInfo(name)
            change(info)
            file.writestr(info, text, zipfile.ZIP_DEFLATED)


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize(
    ("entries", "rule"),
    [
        ([("R/../../evil.py", "")], "'R/../../evil.py' is not a file of a result"),
        ([("../evil.py", "")], "'../evil.py' does not lie in one folder named after the result"),
        ([("/etc/evil.py", "")], "'/etc/evil.py' does not lie in one folder named after the result"),
        ([("R/components/a/../../x.py", "")], "'R/components/a/../../x.py' is not a file of a result"),
        ([("R\\manifest.json", "")], r"'R\\manifest.json' does not lie in one folder named after the result"),
        ([("C:/manifest.json", "")], "'C:/manifest.json' does not lie in one folder named after the result"),
        ([("R/manifest.json", ""), ("S/spec.yaml", "")], "'S/spec.yaml' does not lie in one folder named after the resul"),
        ([("R/manifest.json", ""), ("R/Manifest.json", "")], "'R/Manifest.json' is not a file of a result"),
        ([("R/spec.yaml", ""), ("R/spec.yaml", "")], "'R/spec.yaml' is in it twice"),
        ([("R/lock", "")], "'R/lock' is not a file of a result"),
        ([("R/sitecustomize.py", "")], "'R/sitecustomize.py' is not a file of a result"),
        ([("R.partial/spec.yaml", "")], "'R.partial/spec.yaml' does not lie in one folder named after the result"),
        ([], "it is empty"),
    ],
)
def test_what_no_result_holds_is_refused(entries: Entries, rule: str, gaitsim: Command, tmp_path: Path) -> None:
    packed(entries)
    before = sorted(tmp_path.rglob("*"))
    said = gaitsim("results", "import", "r.zip")
    end = "; nothing was imported. Ask for a file that gaitsim results export made.\n"
    assert said.code == 3
    assert said.err.startswith(f"r.zip: {rule}")
    assert said.err.endswith(end)
    assert sorted(tmp_path.rglob("*")) == before


def test_links_bombs_and_damage_are_refused(
    result: Path, gaitsim: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def link(info: zipfile.ZipInfo) -> None:
        info.external_attr = (stat.S_IFLNK | 0o777) << 16

    packed([("R/spec.yaml", "/etc/passwd")], link)
    assert "'R/spec.yaml' is a link or a special file" in gaitsim("results", "import", "r.zip").err

    packed([("R/evaluations.jsonl", "\0" * 2**21)])
    monkeypatch.setattr("gaitsim.results.packing._MOST_BYTES", 2**20)
    assert "it unpacks to 0.00195 GiB, more than " in gaitsim("results", "import", "r.zip").err

    gaitsim("results", "export", str(result), "--out", "whole.zip")
    whole = Path("whole.zip").read_bytes()
    Path("cut.zip").write_bytes(whole[: len(whole) // 2])
    assert gaitsim("results", "import", "cut.zip").err.startswith("cut.zip: this is not a zip file, or a damaged one (")
    place = whole.index(b"spec.yaml") + 20
    Path("flipped.zip").write_bytes(whole[:place] + bytes([whole[place] ^ 255]) + whole[place + 1 :])
    said = gaitsim("results", "import", "flipped.zip", "--results", "other")
    assert said.err.startswith("flipped.zip: this is not a zip file, or a damaged one (")
    assert list(Path("other").iterdir()) == []
    assert gaitsim("results", "import", "none.zip").code == 3


def test_a_file_whose_components_were_edited_is_refused(result: Path, gaitsim: Command) -> None:
    gaitsim("results", "export", str(result), "--out", "r.zip")
    edited = io.BytesIO()
    with zipfile.ZipFile("r.zip") as old, zipfile.ZipFile(edited, "w") as new:
        for info in old.infolist():
            new.writestr(info, old.read(info) + (b"\n" if info.filename.endswith("brake.py") else b""))
    Path("r.zip").write_bytes(edited.getvalue())
    said = gaitsim("results", "import", "r.zip", "--results", "other")
    assert said.code == 3
    assert said.err.startswith("r.zip: nothing was imported. ")
    assert "components/controller/brake.py was edited after it was made" in said.err
    assert list(Path("other").iterdir()) == []


def test_another_processor_is_told(result: Path, gaitsim: Command) -> None:
    path = result / "manifest.json"
    manifest = json.loads(path.read_text())
    manifest["machine"]["cpu"] = "z80"
    manifest["versions"]["numpy"] = "0.1"
    path.write_text(json.dumps(manifest))
    said = gaitsim("results", "verify", str(result))
    assert said.code == 0
    assert "others than when it was made: numpy 0.1 -> " in said.err
    assert "processor z80 -> " in said.err


def test_how_far_off_a_result_is(result: Path, gaitsim: Command) -> None:
    path = result / "evaluations.jsonl"
    row = json.loads(path.read_text())
    path.write_text(json.dumps(row | {"steps": 3}) + "\n")
    said = gaitsim("results", "verify", str(result))
    assert said.code == 4
    assert "the runs went otherwise, with the versions and the processor that made them; please report" in said.err
    shutil.rmtree(result)


def test_the_signed_result_of_a_stranger_is_one(tmp_path: Path, gaitsim: Command) -> None:
    """What `signed` writes is what the tests of trust rely on; it can be exported too."""
    made = tmp_path / "results" / "R"
    (made / "components" / "controller").mkdir(parents=True)
    (made / "components" / "controller" / "brake.py").write_text(OURS)
    (made / "spec.yaml").write_text(SPEC)
    signed(made)
    assert gaitsim("results", "export", "results/R").code == 0
