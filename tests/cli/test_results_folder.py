"""Where results go and where they are looked up: --results, $GAITSIM_RESULTS, or the folder results."""

from __future__ import annotations

import json
from inspect import signature
from pathlib import Path

import pytest

import gaitsim as notebook
from gaitsim.cli.program import whole_program
from gaitsim.distribution import shipped_specs

from .commands import gaitsim

SPEC = str(shipped_specs()["hopping_geyer2003"])
BRIEF = ("--set", "simulate.duration=5 ms")


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GAITSIM_RESULTS", raising=False)


def made_by(capsys: pytest.CaptureFixture[str], *words: str) -> Path:
    """The result of a run."""
    said = gaitsim(capsys, "run", SPEC, *BRIEF, *words, "--json")
    assert said.code == 0, said.err
    return Path(json.loads(said.out)["result"])


def test_an_option_comes_before_the_variable_and_that_before_the_usual_folder(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert made_by(capsys).parent == Path("results")
    monkeypatch.setenv("GAITSIM_RESULTS", "scratch/mine")
    assert made_by(capsys).parent == Path("scratch/mine")
    assert made_by(capsys, "--results", "other").parent == Path("other")
    listed = json.loads(gaitsim(capsys, "results", "list", "--json").out)["results"]
    assert [Path(row["result"]).parent for row in listed] == [Path("scratch/mine")]
    monkeypatch.setenv("GAITSIM_RESULTS", "")
    assert made_by(capsys).parent == Path("results")


def test_a_search_goes_there_and_is_found_there_again(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    brief = ("--results", "scratch", "--workers", "0", "--json")
    hops = ("--set", "simulate.duration=2 s")
    few = ("--population", "4", "--generations", "2")
    begun = gaitsim(capsys, "optimize", SPEC, *hops, *few, *brief)
    folder = Path(json.loads(begun.out)["result"])
    assert folder.parent == Path("scratch") and not Path("results").exists()
    longer = gaitsim(capsys, "optimize", SPEC, *hops, "--resume", "--generations", "3", *brief)
    assert json.loads(longer.out)["result"] == str(folder)
    assert longer.err.startswith(f"resuming {folder}\n")
    monkeypatch.setenv("GAITSIM_RESULTS", "scratch")
    started = gaitsim(capsys, "optimize", SPEC, *hops, "--smoke", "--from", folder.name, "--workers", "0")
    assert f"start from {folder.name}: feedback.gain" in started.err


def test_the_name_of_a_result_is_enough(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    made = made_by(capsys, "--results", "scratch")
    unknown = gaitsim(capsys, "show", made.name)
    assert unknown.code == 3
    for command in ("show", "cite", "check", "run"):
        assert gaitsim(capsys, command, made.name, "--results", "scratch").code == 0
    monkeypatch.setenv("GAITSIM_RESULTS", "scratch")
    assert gaitsim(capsys, "show", made.name).code == 0
    assert notebook.load(made.name).manifest["kind"] == "run"
    # What lies in the current folder is meant first.
    Path(made.name).write_text("", encoding="utf-8")
    assert gaitsim(capsys, "show", made.name).code == 3


def test_a_missing_result_of_such_a_folder_is_told_as_one(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    made = made_by(capsys, "--results", "scratch")
    monkeypatch.setenv("GAITSIM_RESULTS", "scratch")
    said = gaitsim(capsys, "show", "scratch/gone")
    assert said.code == 3
    assert said.err == (
        f"scratch/gone: there is no such result; the last are: {made.name}. See: gaitsim results list\n"
    )


def test_notebooks_know_the_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GAITSIM_RESULTS", "scratch")
    runs = notebook.run(SPEC, {"simulate.duration": "5 ms"})
    assert runs.folder is not None and runs.folder.parent == Path("scratch")
    runs = notebook.run(SPEC, {"simulate.duration": "5 ms"}, results="other")
    assert runs.folder is not None and runs.folder.parent == Path("other")


def test_every_command_about_results_has_the_option() -> None:
    named = ("run", "optimize", "limit", "analyze", "view", "show", "check", "cite", "profile")
    commands = {command.name: command.callback for command in whole_program().registered_commands}
    assert [name for name in named if "results" not in signature(commands[name]).parameters] == []
