"""Limits as a command or a notebook asks for them: begun, or continued from a result."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.errors import Usage
from gaitsim.study.limits import LimitRuns, Scan, limit_runs, resumed

if TYPE_CHECKING:
    from gaitsim.simulation.run import Mode
    from gaitsim.study.listening import Listener
    from gaitsim.study.opening import Opening


def new_or_resumed(
    opening: Opening,
    asked: Mapping[str, Any],
    resume: bool,
    root: Path | None,
    listener: Listener,
) -> LimitRuns:
    """Begin new limits, or continue those that a result began.

    Args:
        opening: The spec, or the result that is continued.
        asked: The words vary, over, until, tolerance, points, mode and from, as of `hunted`; None for each that is not
            given.
        resume: Whether limits are continued.
        root: Where a new result goes; None keeps nothing.
        listener: Hears what a reader should know.

    Raises:
        Usage: A word is given with `resume`, or `vary` is missing without it.
        GaitsimError: As of `hunted` and of `resumed`.
    """
    if resume:
        option = next((name for name, value in asked.items() if value is not None), "no-save" if root is None else None)
        if option:
            raise Usage(f"--{option} begins new limits, and --resume continues old ones; leave one out.")
        return resumed(opening, listener)
    if not asked["vary"]:
        rule = "nothing says what is varied; add a range, such as --vary push.strength='0 N:1000 N'"
        raise Usage(f"{rule}, or --resume a result.")
    scan = Scan(**{name: asked[name] for name in ("points", "tolerance") if asked[name] is not None})
    mode: Mode = "normal" if asked["mode"] == "normal" else "rapid"
    return limit_runs(opening, asked["vary"], asked["over"], asked["until"], scan, asked["from"], mode, root, listener)
