"""Help: an example for each command, quickly; and the shell's completion."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Iterator

import pytest
import typer.main

from gaitsim.cli.program import whole_program

from .commands import gaitsim


def commands(group: object = None, words: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """The words of every command that does something."""
    group = group or typer.main.get_command(whole_program())
    inner = getattr(group, "commands", None)
    if inner is None:
        yield words
        return
    for name, command in inner.items():
        yield from commands(command, (*words, name))


ALL = list(commands())


def test_the_commands_are_found() -> None:
    assert {("run",), ("optimize",), ("cite",), ("new",), ("library", "check"), ("results", "list")} <= set(ALL)


@pytest.mark.parametrize("words", ALL, ids=" ".join)
def test_every_command_has_an_example_that_is_one(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, *words, "--help")
    assert said.code == 0
    assert "Example" in said.out
    text = " ".join(said.out.split())
    line = text[text.index("Example") :].partition(":")[2].strip()
    assert line.startswith(f"gaitsim {' '.join(words)}"), "an example begins with the command itself"
    assert shlex.split(line.split(" Options")[0])


@pytest.mark.parametrize("words", [(), ("library",), ("archive",), ("results",)], ids=" ".join)
def test_the_list_of_commands_has_whole_sentences(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    listed = gaitsim(capsys, *words, "--help").out.partition("Commands:")[2].strip().splitlines()
    assert listed and [line for line in listed if not line.endswith(".") or line.endswith("...")] == []


HEAVY = ("numpy", "mujoco", "numba", "matplotlib", "distributed", "pydantic", "xarray", "rich")


@pytest.mark.parametrize("words", [(), ("run",), ("library", "show")], ids=" ".join)
def test_nothing_heavy_is_imported_for_help(words: tuple[str, ...]) -> None:
    """So that help comes at once, in 0.3 s."""
    code = (
        "import sys, gaitsim.cli.main as m\n"
        f"try: m.main({[*words, '--help']})\n"
        "except SystemExit: print(*sys.modules, file=sys.stderr)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    own = {"pydantic"} if words else set()  # typer itself reads a command's options with it
    assert not (set(HEAVY) - own) & set(ran.stderr.split())


def completed(line: str) -> list[str]:
    """What bash is offered after a line."""
    asked = {"_GAITSIM_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(len(line.split(" ")) - 1)}
    ran = subprocess.run(
        [sys.executable, "-m", "gaitsim.cli.main"], env=os.environ | asked, capture_output=True, text=True, check=False
    )
    return ran.stdout.split()


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("gaitsim opt", ["optimize"]),
        ("gaitsim library sh", ["show"]),
        ("gaitsim library show muscle/geyer", ["muscle/geyer2003", "muscle/geyer2010"]),
        ("gaitsim library new mus", ["muscle"]),
        ("gaitsim new demo --from hopping_geyer2003", ["hopping_geyer2003", "hopping_geyer2003_length"]),
        ("gaitsim check --conv", ["--convergence"]),
    ],
)
def test_the_shell_completes(line: str, offered: list[str]) -> None:
    assert completed(line) == offered


def test_completion_can_be_installed() -> None:
    ran = subprocess.run(
        [sys.executable, "-m", "gaitsim.cli.main", "--show-completion", "bash"],
        capture_output=True,
        text=True,
        env={**os.environ, "_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"},
    )
    assert "_GAITSIM_COMPLETE=complete_bash" in ran.stdout
    assert "-o default" in ran.stdout  # paths, where nothing of ours is offered


@pytest.mark.parametrize("words", [(), ("library",), ("archive",), ("results",)], ids=" ".join)
def test_a_name_without_a_command_prints_its_help(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, *words)
    assert said == gaitsim(capsys, *words, "--help")
    assert said.out.startswith(f"Usage: {' '.join(('gaitsim', *words))}")
