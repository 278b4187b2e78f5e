"""The limit of a number: a scan of its range, then bisection between the last value that succeeds and the first that
fails.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field


@dataclass
class Bracket:
    """One range. It proposes shares of the range, from 0 to 1, and takes the result of each run.

    Attributes:
        points: The number of values in the scan, both ends included.
        tolerance: The largest distance between the last share that succeeds and the first that fails.
    """

    points: int
    tolerance: float
    held: dict[float, bool] = field(default_factory=dict)

    @property
    def most(self) -> int:
        """The largest number of shares that are tried."""
        return self.points + max(0, math.ceil(-math.log2((self.points - 1) * self.tolerance)))

    def ask(self) -> list[float]:
        """The shares to try next, in any order; none at the end."""
        if 0.0 not in self.held:
            return [0.0]
        if not self.held[0.0]:
            return []
        scan = [i / (self.points - 1) for i in range(1, self.points)]
        if scan[-1] not in self.held:
            return scan
        if self.first is None or self.first - self.last <= self.tolerance:
            return []
        return [(self.last + self.first) / 2]

    def tell(self, share: float, holds: bool) -> None:
        """Store whether a share succeeds."""
        self.held[share] = holds

    @property
    def first(self) -> float | None:
        """The first share that fails; None if all succeed."""
        return min((share for share, holds in self.held.items() if not holds), default=None)

    @property
    def last(self) -> float:
        """The last share that succeeds before the first that fails.

        Raises:
            ValueError: There is none.
        """
        first = self.first
        return max(share for share, holds in self.held.items() if holds and (first is None or share < first))

    @property
    def beyond(self) -> list[float]:
        """The shares that succeed although a smaller one fails."""
        first = self.first
        return sorted(share for share, holds in self.held.items() if holds and first is not None and share > first)
