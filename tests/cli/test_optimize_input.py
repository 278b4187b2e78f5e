"""What cannot be searched or continued: the right exit code, the next move, nothing lost."""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from optimization.searches import SPEC, Ended, Study

from gaitsim.cli.main import main

SMALL = ("--workers", "0", "--set", "simulate.duration=20ms", "--population", "3", "--generations", "2")


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


@pytest.fixture(scope="module")
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


def content(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def lines(files: dict[str, bytes]) -> set[bytes]:
    """Every evaluation, in whichever journal."""
    return {line for name, text in files.items() if name.endswith(".jsonl") for line in text.splitlines()}


def rewritten(path: Path, *changes: tuple[str, str]) -> None:
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)


TUNED = "tune: [20 N m/rad, 200 N m/rad]"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (TUNED, "tune: [200 N m/rad, 20 N m/rad]", "spec.yaml:7:"),
        (TUNED, "tune: [60 N m/rad, 60 N m/rad]", "spec.yaml:7:"),
        ("value: 60 N m/rad", "value: 10 N m/rad", "spec.yaml:7:"),
        (TUNED, f"{TUNED}, spread: 0 N m/rad", "spec.yaml:7:"),
        ("objective: {use: objective/minimize, value: {from: angle}}\n", "", "spec.yaml: this spec has no objective"),
        ("population: 6", "population: 1", "spec.yaml:20:"),
        ("generations: 4", "generations: 0", "spec.yaml:20:"),
        ("generations: 4", "generations: 4, seed: -1", "spec.yaml:20:"),
        ("generations: 4", "generations: 4, algorithm: cmaes", "there is no such algorithm"),
    ],
)
def test_a_spec_that_cannot_be_searched(study: Study, command: Any, old: str, new: str, words: str) -> None:
    assert old in SPEC
    Path("spec.yaml").write_text(SPEC.replace(old, new))
    ended = command("optimize", "spec.yaml", "--workers", "0")
    assert ended.code == (2 if "algorithm" in words else 3), ended.err
    assert words in ended.err
    assert study.results == []


def test_nothing_is_tuned(study: Study, command: Any) -> None:
    settings = ["balance.proportional=60 N m/rad", "balance.derivative=12 N m s/rad", "trap.level=0.4"]
    ended = command("optimize", "spec.yaml", *(word for text in settings for word in ("--set", text)))
    assert (ended.code, study.results) == (3, [])
    assert ended.err.startswith("spec.yaml: nothing is tuned in this spec; give a value bounds, such as gain: {value")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--population", "1"], "--population 1: this is at least 2."),
        (["--generations", "0"], "--generations 0: this is at least 1."),
        (["--seed", "-1"], "--seed -1: this is at least 0."),
        (["--algorithm", "cme"], "--algorithm cme: there is no such algorithm. Did you mean cma?"),
        (["--workers", "-1"], "--workers -1: a number of processes, or 0 for this one."),
        (["--cluster"], "--cluster needs --scheduler tcp://host:port or --scheduler-file FILE."),
        (["--scheduler", "a:1"], "add --cluster."),
        (["--cluster", "--scheduler", "a:1", "--scheduler-file", "f"], "name two places; leave one out."),
        (["--cluster", "--scheduler", "a:1", "--workers", "2"], "leave it out with --cluster."),
        (["--from", "tuned"], "--from tuned: there is no spec.tuned.yaml; make it with optimize --adopt."),
        (["--from", "nowhere"], "--from nowhere: this is no result; write tuned, middle, or a folder"),
        (["--from", "tuned", "--resume"], "--from begins a new search, and --resume continues an old one"),
        (["--smoke", "--resume"], "--smoke begins a new search, and --resume continues an old one"),
        (["--resume", "--generations", "-3"], "--generations -3: this is at least 1."),
    ],
)
def test_a_command_line_that_does_not_fit(study: Study, command: Any, words: list[str], said: str) -> None:
    ended = command("optimize", "spec.yaml", *words)
    assert ended.code == 2, ended.err
    assert said in ended.err
    assert study.results == []


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["spec.yaml", "--resume"], 3, "results: there is no search of spec.yaml to resume; start one without"),
        (["results/gone", "--resume"], 3, "results/gone: there is no such result. See: gaitsim results list"),
        (["spec.yaml", "--from", "results/gone"], 3, "results/gone: there is no such result"),
    ],
)
def test_there_is_nothing_to_go_on_with(command: Any, words: list[str], code: int, said: str) -> None:
    ended = command("optimize", *words, "--json")
    assert ended.code == code
    assert said in ended.err
    assert said in ended.data["errors"][0]["message"]


def test_every_candidate_failed(study: Study, command: Any) -> None:
    words = ("--set", "trap.use=trap/raises", "--set", "trap.level={value: 0.9, tune: [0.8, 1], spread: 0.1}")
    ended = command("optimize", "spec.yaml", *SMALL, *words, "--adopt", "--json")
    assert ended.code == 4
    said = ended.data["errors"][0]["message"]
    name = f"results/{study.result.name}"
    assert said.startswith(f"{name}: every one of 7 candidates failed; ")
    place = "components/trap/raises.py:27"
    assert f"because trap (trap/raises) raised in update at 0 s ({place}): ValueError: too much" in said
    assert said.endswith(f"look at one: gaitsim run {name} --candidate 0:0")
    assert study.manifest()["status"] == "complete"
    assert not Path("spec.tuned.yaml").exists()
    assert command("run", name, "--candidate", "0:0", "--no-save").code == 4
    best = command("run", name, "--no-save")
    assert (best.code, "every candidate failed" in best.err) == (3, True)


def test_adopt_on_a_result(begun: Path, command: Any) -> None:
    before = content(begun)
    ended = command("optimize", str(begun), "--resume", "--generations", "3", "--adopt")
    assert ended.code == 2
    assert ended.err == f"--adopt writes beside a spec, and {begun} is a result; name the spec, with --resume.\n"
    assert content(begun) == before


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "is a result; to continue or to start from it: gaitsim optimize"),
        (["--resume", "--set", "simulate.duration=1s"], "goes on with its own spec and components; leave it out."),
        (["--resume", "--library", "."], "goes on with its own spec and components; leave it out."),
        (["--resume", "--seed", "7"], "--seed 7: this search was begun with 1; leave it out, or start a new search."),
        (["--resume", "--population", "4"], "--population 4: this search was begun with 3;"),
        (["--resume", "--mode", "normal"], "--mode normal: this search was begun in rapid mode; leave it out."),
        (["--resume", "--generations", "1"], "has 2 generations already; ask for more."),
    ],
)
def test_a_result_goes_on_as_it_began(begun: Path, command: Any, words: list[str], said: str) -> None:
    before = content(begun)
    ended = command("optimize", str(begun), *words)
    assert (ended.code, said in ended.err) == (2, True), ended.err
    assert content(begun) == before


def test_a_complete_search_resumed_stays_as_it_is(begun: Path, command: Any) -> None:
    before = content(begun)
    ended = command("optimize", "spec.yaml", *SMALL, "--resume", "--json")
    assert ended.code == 0, ended.err
    assert ended.data["evaluations"] == 7
    assert content(begun) == before


EDITS: dict[str, tuple[str, tuple[str, str]]] = {
    "spec": ("spec.yaml", ("value: 60 N m/rad", "value: 61 N m/rad")),
    "component": ("components/trap/none.py", ("x.count + 1.0", "x.count + 2.0")),
}


@pytest.mark.parametrize("edit", EDITS)
def test_resume_with_an_edited_spec_or_component(begun: Path, command: Any, edit: str) -> None:
    path, change = EDITS[edit]
    rewritten(Path(path), change)
    before = content(begun)
    ended = command("optimize", "spec.yaml", *SMALL, "--resume")
    assert ended.code == 3
    named = "spec.yaml (or its --set)" if edit == "spec" else path
    old = f"continue the old one: gaitsim optimize {begun} --resume"
    rule = f"what {begun} was begun with has changed since: {named}"
    assert ended.err == f"spec.yaml: {rule}; {old}; or start a new search with --from {begun}.\n"
    assert content(begun) == before
    assert command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0").code == 0


def test_resume_with_other_settings(begun: Path, command: Any) -> None:
    ended = command("optimize", "spec.yaml", "--workers", "0", "--set", "simulate.duration=30ms", "--resume")
    assert (ended.code, "has changed since: spec.yaml (or its --set)" in ended.err) == (3, True)


def test_resume_with_other_versions(begun: Path, command: Any) -> None:
    manifest = json.loads((begun / "manifest.json").read_text())
    manifest["versions"] |= {"mujoco": "3.1.0", "cma": "3.0.0"}
    (begun / "manifest.json").write_text(json.dumps(manifest))
    before = content(begun)
    ended = command("optimize", str(begun), "--resume", "--generations", "5")
    assert ended.code == 3
    assert f"{begun}: it was made with other versions (mujoco 3.1.0 -> " in ended.err
    assert "cma 3.0.0 -> " in ended.err
    assert f"install those, or start a new search with --from {begun}." in ended.err
    assert content(begun) == before


def damage_manifest(folder: Path) -> None:
    (folder / "manifest.json").write_text('{"kind": ')


def damage_search(folder: Path) -> None:
    data = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps(data | {"search": {"seed": "x"}}))


def other_seed(folder: Path) -> None:
    data = json.loads((folder / "manifest.json").read_text())
    data["search"]["seed"] = 5
    (folder / "manifest.json").write_text(json.dumps(data))


DAMAGES: dict[str, tuple[Any, str]] = {
    "no manifest": (lambda f: (f / "manifest.json").unlink(), "there is no manifest.json, so this is no result"),
    "manifest garbage": (damage_manifest, "manifest.json: this manifest cannot be read"),
    "manifest is a list": (lambda f: (f / "manifest.json").write_text("[]"), "json: this is [] and no mapping"),
    "search garbage": (damage_search, "what it says about its search cannot be read"),
    "other seed": (other_seed, "generation 1, candidate 0 is not the vector that this search asks for"),
    "no journal": (lambda f: (f / "evaluations.jsonl").unlink(), "evaluations.jsonl: this journal is missing"),
    "no spec": (lambda f: (f / "spec.yaml").unlink(), "spec.yaml: there is no such file; restore it from a copy"),
    "spec edited": (lambda f: rewritten(f / "spec.yaml", ("60", "61")), "spec.yaml was edited after it was made"),
    "component edited": (
        lambda f: rewritten(f / "components/trap/none.py", ("1.0", "2.0")),
        "components/trap/none.py was edited after it was made",
    ),
    "component gone": (lambda f: (f / "components/trap/none.py").unlink(), "none.py was removed after it was made"),
    "component added": (lambda f: (f / "components/trap/x.py").write_text("1"), "components/trap/x.py was added after"),
    "component binary": (
        lambda f: (f / "components/trap/none.py").write_bytes(b"\xff\xfe"),
        "components/trap/none.py: byte 0 (0xff, in line 1) is not UTF-8; restore it from a copy",
    ),
}


@pytest.mark.parametrize("name", DAMAGES)
@pytest.mark.parametrize("how", ["folder", "spec"])
def test_a_damaged_result_is_not_continued(begun: Path, command: Any, name: str, how: str) -> None:
    damage, said = DAMAGES[name]
    damage(begun)
    before = content(begun)
    words = [str(begun), "--generations", "3", "--workers", "0"] if how == "folder" else ["spec.yaml", *SMALL]
    ended = command("optimize", *words, "--resume")
    assert ended.code == 3, ended.err
    nameless = how == "spec" and name in ("no manifest", "manifest garbage", "manifest is a list")
    assert ("there is no search of spec.yaml to resume" if nameless else said) in ended.err
    assert lines(content(begun)) == lines(before)
    shows = command("results", "list", "--json")
    assert shows.code == 0
    assert len(shows.data["results"]) == (0 if name == "no manifest" else 1)


def test_what_others_leave_in_a_result_does_not_matter(begun: Path, command: Any) -> None:
    cache = begun / "components" / "trap" / "__pycache__"
    cache.mkdir()
    (cache / "none.pyc").write_bytes(b"\xff")
    (begun / "components" / ".DS_Store").write_bytes(b"\xff")
    (begun / "notes.txt").write_text("mine")
    assert command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0").code == 0
    assert (begun / "notes.txt").exists()


def test_a_half_made_result_is_none(begun: Path, command: Any) -> None:
    half = begun.with_name(f"{begun.name}.partial")
    shutil.copytree(begun, half)
    (half / "manifest.json").unlink()
    ended = command("optimize", str(half), "--resume")
    assert (ended.code, "one that was never finished being made" in ended.err) == (3, True)
    shutil.copy(begun / "manifest.json", half)
    assert [r["result"] for r in command("results", "list", "--json").data["results"]] == [str(begun)]
    assert command("optimize", "spec.yaml", *SMALL, "--resume").err.startswith(f"resuming {begun}\n")


def held(folder: Path, process: int, host: str = "", began: int | None = None) -> None:
    found = {"host": host or socket.gethostname(), "process": process, "began": began}
    (folder / "lock").write_text(json.dumps(found))


def test_a_locked_result(begun: Path, command: Any) -> None:
    held(begun, os.getppid())
    before = content(begun)
    ended = command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0")
    assert ended.code == 3
    assert f"{begun}/lock: process {os.getppid()} on " in ended.err
    assert "is writing this result; wait for it, or remove this file if that process is gone." in ended.err
    assert content(begun) == before


@pytest.mark.parametrize("garbage", [False, True])
def test_a_lock_of_a_dead_process(begun: Path, command: Any, garbage: bool) -> None:
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    held(begun, dead.pid)
    if garbage:
        (begun / "lock").write_text("")
        os.utime(begun / "lock", (1, 1))
    assert command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0").code == 0
    assert not list(begun.glob("lock*"))


def test_a_lock_whose_number_another_process_has_now(begun: Path, command: Any) -> None:
    held(begun, os.getppid(), began=1)
    assert command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0").code == 0
    assert not list(begun.glob("lock*"))


def test_a_state_is_that_of_who_holds_the_lock(begun: Path, command: Any) -> None:
    def state() -> str:
        (row,) = command("results", "list", "--json").data["results"]
        assert command("results", "show", str(begun), "--json").data["status"] == row["status"]
        return str(row["status"])

    held(begun, os.getppid())
    assert state() == "complete"
    rewritten(begun / "manifest.json", ('"status": "complete"', '"status": "running"'))
    assert state() == "running"
    held(begun, os.getppid(), began=1)
    assert state() == "interrupted"
    held(begun, os.getppid(), host="elsewhere")
    assert state() == "running"  # from here no one can tell
    (begun / "lock").write_text("")
    assert state() == "running"  # it is being written
    os.utime(begun / "lock", (1, 1))
    assert state() == "interrupted"
    (begun / "lock").unlink()
    assert state() == "interrupted"


def test_a_lock_that_is_just_being_written(begun: Path, command: Any) -> None:
    (begun / "lock").write_text("")
    ended = command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0")
    assert (ended.code, "another process began to write this result; try again." in ended.err) == (3, True)


def test_from_where_nothing_matches(begun: Path, command: Any) -> None:
    Path("other.yaml").write_text(SPEC.replace("balance", "control").replace("trap:", "snare:"))
    ended = command("optimize", "other.yaml", "--from", str(begun), "--workers", "0")
    assert ended.code == 2
    known = "balance.proportional, balance.derivative, trap.level"
    assert ended.err == f"--from {begun}: none of its values ({known}) is tuned here.\n"


def test_a_variant_starts_at_the_tuned_values_of_the_spec_that_it_extends(study: Study, command: Any) -> None:
    Path("variant.yaml").write_text("gaitsim: 1\nextends: spec.yaml\n")
    assert command("optimize", "spec.yaml", *SMALL, "--adopt").code == 0
    ended = command("optimize", "variant.yaml", *SMALL, "--from", "tuned")
    assert ended.code == 0, ended.err
    assert "start from spec.tuned.yaml: balance.proportional" in ended.err


@pytest.mark.parametrize(
    ("which", "code", "said"),
    [
        ("0", 2, "write best, a rank such as 3, or GENERATION:INDEX such as 12:4."),
        ("99999", 2, "--candidate 99999: there are 7 candidates with a score."),
        ("7:99", 2, "--candidate 7:99: there is no candidate 7:99; the last is 2:2."),
        ("foo", 2, "write best, a rank such as 3, or GENERATION:INDEX such as 12:4."),
        ("²", 2, "write best, a rank"),
        ("1:²", 2, "write best, a rank"),
        ("-1", 2, "write best, a rank"),
        ("1:0:0", 2, "write best, a rank"),
    ],
)
def test_a_candidate_that_is_none(begun: Path, command: Any, which: str, code: int, said: str) -> None:
    ended = command("run", str(begun), "--candidate", which, "--no-save")
    assert (ended.code, said in ended.err) == (code, True), ended.err


def test_a_candidate_of_a_spec(command: Any) -> None:
    ended = command("run", "spec.yaml", "--candidate", "best")
    assert ended.err == "--candidate best: spec.yaml is a spec; candidates belong to results.\n"
    assert ended.code == 2


def test_results_is_a_file(command: Any) -> None:
    Path("results").write_text("")
    ended = command("optimize", "spec.yaml", *SMALL)
    assert (ended.code, ended.err.startswith("results: the result cannot be saved (")) == (3, True)


FULL = """
import resource, sys
from gaitsim.cli.main import main
resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))
main(sys.argv[1:])
"""


def test_a_smoke_search_is_not_the_one_to_resume(begun: Path, study: Study, command: Any) -> None:
    assert command("optimize", "spec.yaml", "--smoke", *SMALL[:4]).code == 0
    ended = command("optimize", "spec.yaml", "--resume", *SMALL[:4])
    assert ended.code == 0, ended.err
    assert f"resuming {begun}\n" in ended.err
    (smoke,) = (path for path in study.results if path.name != begun.name)
    shutil.rmtree(begun)
    ended = command("optimize", "spec.yaml", "--resume", *SMALL[:4])
    name = f"results/{smoke.name}"
    rule = "results: there is no search of spec.yaml to resume but one by --smoke"
    assert (ended.code, ended.err) == (3, f"{rule}; name it to continue it: gaitsim optimize {name} --resume\n")
    ended = command("optimize", name, "--resume", "--workers", "0", "--generations", "3")
    assert ended.code == 0, ended.err


@pytest.mark.slow
@pytest.mark.parametrize("workers", ["0", "1"])
def test_a_full_disk_during_a_search_loses_nothing(study: Study, workers: str, tmp_path: Path) -> None:
    """Files cannot grow beyond some bytes: as a full disk, in the middle of a line."""
    words = ["optimize", "spec.yaml", *SMALL[2:-1], "30", "--workers", workers]
    command = [sys.executable, "-c", FULL.format(size=12_000), *words]
    ran = subprocess.run(command, cwd=tmp_path, env=study.environment, capture_output=True, text=True)
    assert "Traceback" not in ran.stderr, ran.stderr
    assert ran.returncode == 3
    name = f"results/{study.result.name}"
    rule = f"{name}: the search cannot be written (File too large); make room or rights."
    again = f"gaitsim optimize {name} --resume --workers {workers}"
    assert ran.stderr.endswith(f"{rule} What was evaluated is saved. To continue: {again}\n")
    words = again.split()[1:]
    made = study.timed()
    assert len(made) > 10
    assert study.listed() == "interrupted"
    assert study.run(*words).code == 0
    assert len(study.timed()) == len(set(study.timed())) > len(made)
    other = Study(tmp_path / "other")
    assert other.optimize(*SMALL[2:-1], "30", "--workers", "0").code == 0
    assert study.history() == other.history()


def test_a_folder_that_may_not_be_written(begun: Path, command: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    before = content(begun)
    plain = os.open

    def denied(path: Any, *arguments: Any, **options: Any) -> int:
        if str(path).endswith("lock"):
            raise PermissionError(13, "Permission denied")
        return plain(path, *arguments, **options)

    monkeypatch.setattr(os, "open", denied)
    ended = command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0")
    assert ended.code == 3
    assert f"{begun}: the search cannot be written (Permission denied); make room or rights." in ended.err
    assert content(begun) == before


def test_adopt_where_nothing_may_be_written(study: Study, command: Any) -> None:
    Path("spec.tuned.yaml.partial").mkdir()
    ended = command("optimize", "spec.yaml", *SMALL, "--adopt")
    assert ended.code == 3
    assert "spec.tuned.yaml: the tuned values cannot be written (Is a directory); they are saved in" in ended.err
    assert study.manifest()["status"] == "complete"
