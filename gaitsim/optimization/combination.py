"""One score from the scores of several episodes."""

from __future__ import annotations

import math
from collections.abc import Sequence


def combined(scores: Sequence[float | None], how: str) -> float | None:
    """The score of a candidate: `mean`, `worst`, or `quantile Q` of its episodes' costs.

    None if an episode has none: a candidate that fails anywhere has failed. A quantile between two
    costs lies on the straight line between them; quantile 1 is the worst.
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
