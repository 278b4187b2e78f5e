"""A result that is continued: as it began, or not at all, and nothing is lost."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from optimization.searches import Study

from .files import SMALL, content, rewritten


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
        (["--resume", "--seed", "7"], "--seed 7: this search was started with 1; leave it out, or start a new search."),
        (["--resume", "--population", "4"], "--population 4: this search was started with 3;"),
        (["--resume", "--mode", "normal"], "--mode normal: this search was started in rapid mode; leave it out."),
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
    rule = f"what {begun} was started with has changed since: {named}"
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


def test_a_variant_starts_at_the_tuned_values_of_the_spec_that_it_extends(study: Study, command: Any) -> None:
    Path("variant.yaml").write_text("gaitsim: 1\nextends: spec.yaml\n")
    assert command("optimize", "spec.yaml", *SMALL, "--adopt").code == 0
    ended = command("optimize", "variant.yaml", *SMALL, "--from", "tuned")
    assert ended.code == 0, ended.err
    assert "start from spec.tuned.yaml: balance.proportional" in ended.err


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


FULL = """
import resource, sys
from gaitsim.cli.main import main
resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))
main(sys.argv[1:])
"""


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
