"""The command line: `gaitsim run | optimize | analyze | check | show | schema | library | archive | results`."""

from __future__ import annotations

import gc
import io
import os
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any

import typer

from gaitsim import __version__
from gaitsim.cli import (
    analyze,
    archive,
    check,
    cite,
    cohort,
    console,
    cycle,
    library,
    library_promote,
    library_uses,
    limit,
    new,
    optimize,
    profile,
    projects,
    results,
    run,
    schema,
    show,
    view,
)
from gaitsim.cli.interrupts import heard_once
from gaitsim.errors import ExitCode, GaitsimError, Usage

library.app.command("used-by")(library_uses.used_by)
library.app.command("test")(library_uses.test)
library.app.command("promote")(library_promote.promote)
library.app.command("history")(library_uses.history)

# Allocations before a garbage collection. Imported objects stay, so the default of 700 wastes time.
_GARBAGE = 20_000

COMMANDS: dict[str, Callable[..., Any]] = {
    "run": run.run,
    "optimize": optimize.optimize,
    "limit": limit.limit,
    "cohort": cohort.cohort,
    "cycle": cycle.cycle,
    "analyze": analyze.analyze,
    "view": view.view,
    "profile": profile.profile,
    "check": check.check,
    "show": show.show,
    "cite": cite.cite,
    "new": new.new,
    "projects": projects.projects,
    "schema": schema.schema,
}
GROUPS: dict[str, typer.Typer] = {"library": library.app, "archive": archive.app, "results": results.app}


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


def _program(commands: Mapping[str, Callable[..., Any]], groups: Mapping[str, typer.Typer]) -> typer.Typer:
    """Make the program with some commands and groups of commands."""
    made = typer.Typer(
        help="Simulate, tune and analyze neuromuscular models of gait.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    made.callback()(_main)
    for name, command in commands.items():
        made.command(name)(command)
    for name, group in groups.items():
        made.add_typer(group, name=name)
    return made


app = _program(COMMANDS, GROUPS)


def program_for(words: Sequence[str]) -> typer.Typer:
    """The program for a command line. It has only the command that is called, because Typer would build all others
    too.

    Args:
        words: The words after `gaitsim`. If the first is not a command, the program has all commands.
    """
    name = words[0] if words else ""
    if name in COMMANDS:
        return _program({name: COMMANDS[name]}, {})
    return _program({}, {name: GROUPS[name]}) if name in GROUPS else app


def main(arguments: list[str] | None = None) -> None:
    """Run one command. The exit code says which kind of failure occurred."""
    gc.set_threshold(_GARBAGE)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # a file name can contain any bytes
    try:
        with heard_once():
            code = _ran(sys.argv[1:] if arguments is None else arguments)
    except BrokenPipeError:
        # The reader of our output (such as head) has ended.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = ExitCode.OK
    sys.exit(code if isinstance(code, int) else ExitCode.OK)


def _ran(words: list[str]) -> object:
    """Run a command.

    Returns:
        Its return value, or the exit code of its failure.
    """
    try:
        _check_words(words)
        return program_for(words)(args=words, prog_name="gaitsim", standalone_mode=False)
    except GaitsimError as error:
        console.say_error(error)
        if "--json" in words:
            console.give_json(console.error_data(error))
        return error.exit_code
    except KeyboardInterrupt:
        console.say("interrupted")
        return ExitCode.INTERRUPTED
    except BrokenPipeError:
        raise
    except Exception as error:
        return _other(error)


def _check_words(words: list[str]) -> None:
    """Refuse command lines that cannot be used.

    Raises:
        Usage: A word is not text, or the current folder was removed.
    """
    for word in words:
        try:
            word.encode("utf-8")
        except UnicodeEncodeError as error:
            shown = word.encode("utf-8", "backslashreplace").decode("utf-8")
            raise Usage(f"{shown}: this name is not UTF-8, so no text can hold it; rename the file.") from error
    try:
        os.getcwd()  # noqa: PTH109 (only asked whether it is there)
    except FileNotFoundError as error:
        raise Usage("the current folder is not there any more; change to one that is.") from error


def _other(error: Exception) -> int:
    """The exit code of errors of the command-line library. All others are bugs of gaitsim."""
    if hasattr(error, "format_message") and hasattr(error, "exit_code"):
        # Typer repeats the messages of pydantic with this prefix.
        console.say(f"gaitsim: {error.format_message().replace('Value error, ', '')}")
        context = getattr(error, "ctx", None)
        command = context.command_path if context is not None else "gaitsim"
        console.say(f"Try '{command} --help'.")
        return ExitCode.USAGE
    console.say("".join(traceback.format_exception(error)))
    console.say("This is a bug of gaitsim; please report it with the lines above.")
    return ExitCode.BUG


if __name__ == "__main__":
    main()
