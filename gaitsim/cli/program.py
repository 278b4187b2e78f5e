"""The commands and their options. The module of a command is imported when that command is called."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from importlib import import_module
from typing import Annotated

import typer

from gaitsim import __version__
from gaitsim.cli import console

# Each name is that of a module, and of the command or the group of commands in it.
COMMANDS = (
    *("run", "optimize", "limit", "cohort", "cycle", "analyze", "view", "profile"),
    *("check", "show", "cite", "new", "projects", "schema"),
)
GROUPS = ("library", "archive", "results")


def program_for(arguments: Sequence[str]) -> typer.Typer:
    """The program for a command line. It has only the command that is called, because Typer would build all others
    too.

    Args:
        arguments: The words after `gaitsim`. If the first is not a command, the program has all commands.
    """
    name = arguments[0] if arguments else ""
    if name in COMMANDS:
        return _program([name], [])
    return _program([], [name]) if name in GROUPS else whole_program()


@cache
def whole_program() -> typer.Typer:
    """The program with all commands."""
    return _program(COMMANDS, GROUPS)


def _program(commands: Sequence[str], groups: Sequence[str]) -> typer.Typer:
    """Make the program with some commands and groups of commands."""
    made = typer.Typer(
        help="Simulate, tune and analyze neuromuscular models of gait.",
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    made.callback()(_main)
    for name in commands:
        made.command(name)(getattr(import_module(f"gaitsim.cli.{name}"), name))
    for name in groups:
        made.add_typer(import_module(f"gaitsim.cli.{name}").app, name=name)
    return made


def _version(wanted: bool) -> None:
    if wanted:
        console.give(__version__)
        raise typer.Exit


def _main(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass
