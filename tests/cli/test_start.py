"""A command that simulates imports what simulating needs, and nothing else: it is waited for many times a day."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
import typer.main

from gaitsim.cli.program import program_for, whole_program
from gaitsim.components import contract
from gaitsim.components.find import Library
from gaitsim.study import opened
from gaitsim.study.opening import Opening
from gaitsim.text.document import MappingNode, parse

from .commands import gaitsim

SPECS = Path(__file__).resolve().parents[2] / "specs"
SPEC = SPECS / "hopping_geyer2003.yaml"
UNNEEDED = {
    *("PIL", "cma", "dask", "distributed", "glfw", "h5netcdf", "h5py", "imageio_ffmpeg", "jinja2", "matplotlib"),
    *("numba", "pandas", "pymoo", "rich", "scipy", "xarray"),
}


def test_a_run_imports_nothing_that_it_does_not_need(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert gaitsim(capsys, "run", str(SPEC), "--set", "simulate.duration=1 ms").code == 0  # it is compiled by now
    code = (
        "import sys\n"
        "from gaitsim.cli.main import main\n"
        f"try: main(['run', {str(SPEC)!r}, '--set', 'simulate.duration=1 ms'])\n"
        "except SystemExit as ended: print(ended.code, *sys.modules, file=sys.stderr)"
    )
    ran = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    code_of_exit, *modules = ran.stderr.splitlines()[-1].split()
    assert code_of_exit == "0"
    assert {module.partition(".")[0] for module in modules} & UNNEEDED == set()


@pytest.mark.parametrize(("words", "commands"), [(["run", "x"], ["run"]), (["library", "list"], ["library"])])
def test_one_command_is_built_if_one_is_called(words: list[str], commands: list[str]) -> None:
    assert [*typer.main.get_group(program_for(words)).commands] == commands


@pytest.mark.parametrize("words", [[], ["--help"], ["rnu"]], ids=str)
def test_all_commands_are_built_if_none_is_called(words: list[str]) -> None:
    assert program_for(words) is whole_program()


def test_a_tuned_spec_is_resolved_once(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    names, resolve = [], opened.resolve

    def counted(document: MappingNode, library: object, name: str) -> object:
        names.append(name)
        return resolve(document, library, name)  # type: ignore[arg-type]

    monkeypatch.setattr(opened, "resolve", counted)
    spec = str(SPECS / "walking_geyer2010.yaml")
    assert gaitsim(capsys, "run", spec, "--set", "simulate.duration=10 ms", "--no-save").code == 0
    assert names == ["walking_geyer2010"]


def test_no_folder_is_listed_and_each_kind_is_read_once_for_a_spec_without_faults(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    kinds: list[str] = []

    def parsed(text: str, name: str) -> MappingNode:
        kinds.append(name)
        return parse(text, name)

    contract.read_contract.cache_clear()
    monkeypatch.setattr(contract, "parse_document", parsed)
    monkeypatch.setattr(Library, "references", None)
    assert Opening(SPECS / "walking_geyer2010.yaml").open().model().parts
    assert kinds and len(kinds) == len(set(kinds))
