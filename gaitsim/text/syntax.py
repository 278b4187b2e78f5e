"""Messages for errors in the YAML itself."""

from __future__ import annotations

import re

import yaml

NO_ANCHORS = "a spec has no anchors (&), aliases (*) or merge keys (<<); write extends: or a composite."
DEPTH_LIMIT = 100
TOO_DEEP = f"this is nested more than {DEPTH_LIMIT} levels deep; put an inner part into a composite of its own."
ONE_DOCUMENT = "one file holds one spec: put the second into a file of its own."
_BRACED = re.compile(r"[^\s,\[\]{}:]*\{[^\s{}]*\}[^\s,\[\]{}]*")


def explained(error: yaml.MarkedYAMLError, lines: list[str]) -> tuple[str, int, int]:
    """Explain an error of the YAML parser.

    Args:
        error: The error.
        lines: The text.

    Returns:
        The message, the line and the column, both from 0.
    """
    at = error.problem_mark or error.context_mark
    start = error.context_mark or at
    if at is None or start is None:
        return f"this is not YAML: {error.problem}.", 0, 0
    problem, context = error.problem or "", error.context or ""
    here, opened = (at.line, at.column), (start.line, start.column)
    line = lines[at.line] if at.line < len(lines) else ""
    before, letter = line[: at.column], line[at.column : at.column + 1]
    opener = lines[start.line][start.column : start.column + 1] if start.line < len(lines) else ""
    if letter == "\t" and not before.strip():
        return "YAML is not indented with tabs; write spaces.", *here
    if "maximum nesting depth" in problem:  # libyaml's own limit, which may apply before ours
        return TOO_DEEP, *here
    if "cannot start any token" in problem:
        return f"a text may not begin with {letter}; put the whole text in quotes.", *here
    if "unexpected end of stream" in problem:
        return f"this quote is never closed; write {opener} where the text ends.", *opened
    if "a flow " in context and "expected ','" in problem:
        closer = "]" if "sequence" in context else "}"
        begin = max(0, at.column - 200)  # a longer word is not a name with a side
        column, near = at.column - begin, line[begin : at.column + 200]
        word = next((w[0] for w in _BRACED.finditer(near) if w.start() < column < w.end()), "")
        if letter == "{" and word:
            return f'between braces a text with {{ or }} needs quotes; write "{word}".', *here
        if not "".join([line[at.column :], *lines[at.line + 1 :]]).strip():
            return f"this {opener} is never closed; write the missing {closer}.", *opened
        if at.line != start.line:
            rule = f"this {opener} is not closed before line {at.line + 1}"
            return f"{rule}; write the missing {closer} or comma.", *opened
        return f"something is missing before this; write a comma or {closer}.", *here
    if "node content" in problem:
        if letter and letter in ",]}":
            return f"no value stands before this {letter}; write one, or remove it.", *here
        return "the text ends where a value should stand; close what is open: ] or }.", *here
    if "mapping values" in problem:
        if ": " in before:
            return 'a second ": " in one line; put the text after the first in quotes.', *here
        rule = "this key cannot be nested below the line above, which has a value or lacks its colon"
        return f'{rule}; align the two, or write "key: value" there.', *here
    if "could not find expected ':'" in problem:
        return 'a key without a colon; write "key: value".', *opened
    if "document start" in problem:
        if any(text.startswith("...") for text in lines[: at.line]):
            return f"a second document begins here; {ONE_DOCUMENT}", *here
        return "this is indented less than the first key; align the two.", *here
    if "entries are not allowed" in problem:
        return "a list item (-) cannot begin here; begin it on a line of its own.", *here
    if "collection" in context or "'-' indicator" in problem:
        return "a key cannot be among list items; indent it, or begin it with a dash.", *here
    if "block mapping" in context:
        if before.strip():
            return "the value ended before this; remove it, or put the whole in quotes.", *here
        if letter == "-":
            return "a list item (-) cannot be among keys; indent it below its key.", *here
        return "this fits the indentation of no line above; align it with its neighbours.", *here
    if "tag" in context or "tag" in problem:
        return "a spec may not have tags (!); remove it, or put the text in quotes.", *opened
    if "alias" in context or "anchor" in context:
        return NO_ANCHORS, *opened
    if "escape" in problem:
        return "an unknown escape; write two backslashes for one, or single quotes.", *here
    return f"this is not YAML ({problem}); compare it with the lines above.", *here
