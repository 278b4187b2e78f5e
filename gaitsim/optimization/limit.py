"""How far a number can go before something ends: a scan of its range, then bisection where it ends first."""

from __future__ import annotations

import math
from dataclasses import dataclass, field


@dataclass
class Bracket:
    """One range, asked at shares of the way from 0 to 1 and told at which of them it holds.

    Attributes:
        points: Of the scan, both ends among them.
        tolerance: How near the last share that holds must come to the first that does not.
    """

    points: int
    tolerance: float
    held: dict[float, bool] = field(default_factory=dict)

    @property
    def most(self) -> int:
        """How many shares are tried at most."""
        return self.points + max(0, math.ceil(-math.log2((self.points - 1) * self.tolerance)))

    def ask(self) -> list[float]:
        """The shares to try next, in any order; none when all is known."""
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
        """What was found at a share."""
        self.held[share] = holds

    @property
    def first(self) -> float | None:
        """The first share that does not hold; None if all do."""
        return min((share for share, holds in self.held.items() if not holds), default=None)

    @property
    def last(self) -> float:
        """The last share that holds before the first that does not.

        Raises:
            ValueError: There is none.
        """
        first = self.first
        return max(share for share, holds in self.held.items() if holds and (first is None or share < first))

    @property
    def beyond(self) -> list[float]:
        """Shares that hold although one before them does not."""
        first = self.first
        return sorted(share for share, holds in self.held.items() if holds and first is not None and share > first)
