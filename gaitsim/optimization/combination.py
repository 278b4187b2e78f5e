"""One score from the scores of several episodes."""

from __future__ import annotations

import math
from collections.abc import Sequence


def combined(scores: Sequence[float | None], how: str) -> float | None:
    """Combine the scores of a candidate's episodes.

    Args:
        scores: The cost of each episode; None if it has none.
        how: `mean`, `worst`, or `quantile Q`. Quantiles between two costs are interpolated linearly; quantile 1 is the
            worst.

    Returns:
        The score; None if an episode has none, because a candidate that fails in one episode fails.
    """
    costs = sorted(score for score in scores if score is not None)
    if len(costs) < len(scores):
        return None
    if how == "mean":
        return math.fsum(costs) / len(costs)
    share = 1.0 if how == "worst" else float(how.removeprefix("quantile"))
    place = share * (len(costs) - 1)
    low = math.floor(place)
    return costs[low] + (place - low) * (costs[min(low + 1, len(costs) - 1)] - costs[low])
