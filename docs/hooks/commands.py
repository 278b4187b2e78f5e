"""The reference of the command line, from the declarations of its commands."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from typing import Any

import typer.main
from parts_of_text import Page, code, escaped, table

from gaitsim.cli.program import whole_program

_HEAD = """\
# Commands

Every command has `--help`. Data go to standard output and messages to standard error; with `--json`, standard output
is one JSON document. `gaitsim --install-completion` installs completion for your shell.

| exit code | meaning |
|---|---|
| 0 | success |
| 1 | a bug in gaitsim |
| 2 | wrong usage of the command |
| 3 | an invalid spec, component or result |
| 4 | the simulation failed |
| 5 | the cluster cannot be reached |
| 130 | interrupted by Ctrl-C or SIGTERM; a search has saved everything |
"""


def page() -> Page:
    """Every command with its arguments and options."""
    texts = [
        _HEAD,
        *(_text(words, command) for words, command in _commands(typer.main.get_command(whole_program()), ())),
    ]
    return Page("reference/commands.md", "\n".join(texts))


def _commands(group: Any, words: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from _commands(command, (*words, name))
        else:
            yield (*words, name), command


def _text(words: tuple[str, ...], command: Any) -> str:
    """The part of the page that is about one command."""
    arguments = [p for p in command.params if p.param_type_name == "argument"]
    options = [p for p in command.params if p.param_type_name == "option" and not getattr(p, "hidden", False)]
    usage = " ".join(["gaitsim", *words, "[OPTIONS]", *(p.metavar or p.name.upper() for p in arguments)])
    prose, examples = _split(inspect.cleandoc(command.help or ""))
    parts = [f"## gaitsim {' '.join(words)}", prose, f"```text\n{usage}\n```"]
    if examples:
        parts.append("```sh\n" + "\n".join(examples) + "\n```")
    context = command.make_context(command.name, [], resilient_parsing=True)
    records = [p.get_help_record(context) for p in (*arguments, *options)]
    rows = [[code(record[0]), escaped(record[1])] for record in records if record]
    parts.append(table(["argument or option", "meaning"], rows))
    return "\n\n".join(parts)


def _split(text: str) -> tuple[str, list[str]]:
    """The prose of a help text as Markdown, and its examples."""
    pieces = [" ".join(piece.split()).removeprefix("Example: ") for piece in text.split("\n\n")]
    examples = [piece for piece in pieces if piece.startswith("gaitsim ")]
    prose = [escaped(piece) for piece in pieces if piece != "Examples:" and piece not in examples]
    return "\n\n".join(prose), examples
