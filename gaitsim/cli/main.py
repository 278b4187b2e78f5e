"""The command line: `gaitsim run | optimize | analyze | check | show | schema | library | archive | results`."""

from __future__ import annotations

import atexit
import gc
import io
import os
import sys
import traceback

from gaitsim.cli import console
from gaitsim.cli.interrupts import interrupt_once
from gaitsim.errors import ExitCode, GaitsimError, Usage

# A run makes 100,000 objects that stay to its end, most of them at imports. To look for garbage among them, as
# Python does every 700 objects and once more at the end, would take a sixth of the time of the command.
_GARBAGE = 200_000


def main(arguments: list[str] | None = None) -> None:
    """Run one command. The exit code says which kind of failure occurred."""
    gc.set_threshold(_GARBAGE)
    atexit.register(gc.freeze)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "1")  # or it looks for some in all installed packages
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # more wait busily for large matrices, which there are not
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # a file name can contain any bytes
    try:
        with interrupt_once():
            code = _ran(sys.argv[1:] if arguments is None else arguments)
    except BrokenPipeError:
        # The reader of our output (such as head) has ended.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = ExitCode.OK
    sys.exit(code if isinstance(code, int) else ExitCode.OK)


def _ran(arguments: list[str]) -> object:
    """Run a command.

    Returns:
        Its return value, or the exit code of its failure.
    """
    try:
        from gaitsim.cli.program import GROUPS, program_for

        _check_encoding(arguments)
        _check_command(arguments)
        if not arguments or (len(arguments) == 1 and arguments[0] in GROUPS):
            arguments = [*arguments, "--help"]
        return program_for(arguments)(args=arguments, prog_name="gaitsim", standalone_mode=False)
    except GaitsimError as error:
        console.say_error(error)
        if "--json" in arguments:
            console.give_json(console.error_data(error))
        return error.exit_code
    except KeyboardInterrupt:
        console.say("interrupted")
        return ExitCode.INTERRUPTED
    except BrokenPipeError:
        raise
    except Exception as error:
        return _other(error)


def _check_encoding(arguments: list[str]) -> None:
    """Refuse command lines that cannot be used.

    Raises:
        Usage: A word is not text, or the current folder was removed.
    """
    for word in arguments:
        try:
            word.encode("utf-8")
        except UnicodeEncodeError as error:
            text = word.encode("utf-8", "backslashreplace").decode("utf-8")
            raise Usage(f"{text}: this name is not UTF-8, so no text can hold it; rename the file.") from error
    try:
        os.getcwd()  # noqa: PTH109 (only asked whether it is there)
    except FileNotFoundError as error:
        raise Usage("the current folder no longer exists; change to another one.") from error


# What other programs call a command.
_OTHER_NAMES = {
    **dict.fromkeys(("animate", "export", "film", "plot", "report", "video"), "analyze"),
    **dict.fromkeys(("fit", "train", "tune"), "optimize"),
    **dict.fromkeys(("simulate", "sim"), "run"),
    **dict.fromkeys(("validate", "lint"), "check"),
    **dict.fromkeys(("init", "create"), "new"),
    "list": "results list",
    "compare": "results compare",
    "verify": "results verify",
}


def _check_command(arguments: list[str]) -> None:
    """Refuse a command that has another name here.

    Raises:
        Usage: It has.
    """
    word = arguments[0] if arguments else ""
    if word in _OTHER_NAMES:
        here = _OTHER_NAMES[word]
        raise Usage(f"{word}: there is no such command; here it is gaitsim {here}, see gaitsim {here} --help.")


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
