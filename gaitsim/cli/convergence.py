"""gaitsim check --convergence: a table of the changes with a half and a quarter of the step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gaitsim.cli import console

if TYPE_CHECKING:
    from gaitsim.analysis.models.step_convergence import StepConvergence


def give(found: StepConvergence, tolerance: float) -> None:
    """Print the table to stdout, and to stderr how many metrics change more than the tolerance."""
    columns = ["metric", "unit", *(f"at {_milliseconds(step)}" for step in found.steps)]
    rows = [
        (
            change.name,
            change.unit,
            *(console.formatted(value) for value in change.values),
            "-" if change.relative is None else f"{100 * change.relative:.3g} %",
            console.formatted(change.ratio),
            console.formatted(change.order),
            change.flag(tolerance) and "<",
        )
        for change in found.changes
    ]
    console.give_table([*columns, "change", "ratio", "order", ""], rows)
    flagged = [change.name for change in found.changes if change.flag(tolerance)]
    if flagged:
        limit = f"more than {100 * tolerance:g} %"
        console.say(f"a quarter of the step changes {limit}, or has no value: {', '.join(flagged)}")


def data(found: StepConvergence, tolerance: float) -> dict[str, Any]:
    """The table for --json."""
    return {
        "steps": list(found.steps),
        "status": [outcome.status for outcome in found.outcomes],
        "tolerance": tolerance,
        "metrics": {
            change.name: {
                "unit": change.unit,
                "values": change.values,
                "relative": change.relative,
                "ratio": change.ratio,
                "order": change.order,
                "flag": change.flag(tolerance) or None,
            }
            for change in found.changes
        },
    }


def _milliseconds(step: float) -> str:
    return f"{1e3 * step:.4g} ms"
