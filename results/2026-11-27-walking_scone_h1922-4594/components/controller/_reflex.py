"""Declarations and functions that reflexes share: the clamp and the gate of their stimulation."""

from gaitsim.component import Parameter

LOWER = Parameter(
    "1",
    "Least stimulation before the gate.",
    default=-1e6,
    bounds=(-1e6, 1e6),
    source="definition: unclamped; the muscle clips the sum",
)
UPPER = Parameter(
    "1",
    "Largest stimulation before the gate.",
    default=1e6,
    bounds=(-1e6, 1e6),
    source="definition: unclamped; the muscle clips the sum",
)


def gated(wanted, gate, lower, upper):
    """Stimulation, clamped to [lower, upper] and multiplied by the gate."""
    return gate * max(lower, min(upper, wanted))
