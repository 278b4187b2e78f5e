"""A range is scanned, then halved where it ends first; what holds beyond is not forgotten."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from gaitsim.optimization.limit import Bracket


def found(holds: Callable[[float], bool], points: int = 5, tolerance: float = 0.01) -> Bracket:
    bracket = Bracket(points, tolerance)
    while asked := bracket.ask():
        for share in asked:
            bracket.tell(share, holds(share))
    assert len(bracket.held) <= bracket.most
    return bracket


@pytest.mark.parametrize("threshold", [0.001, 0.25, 0.3333, 0.5, 0.99, 1.0])
@pytest.mark.parametrize("points", [2, 5, 9])
def test_a_threshold_is_found_within_the_tolerance(threshold: float, points: int) -> None:
    bracket = found(lambda share: share < threshold, points)
    assert bracket.first is not None
    assert bracket.last < threshold <= bracket.first
    assert bracket.first - bracket.last <= 0.01
    assert bracket.beyond == []


def test_the_first_end_is_tried_before_all_else() -> None:
    bracket = Bracket(5, 0.01)
    assert bracket.ask() == [0]
    bracket.tell(0, False)
    assert bracket.ask() == []


def test_a_range_that_holds_has_no_limit() -> None:
    bracket = found(lambda share: True)
    assert bracket.first is None
    assert bracket.last == 1
    assert sorted(bracket.held) == [0, 0.25, 0.5, 0.75, 1]


def test_the_first_of_several_limits_is_found_and_the_others_are_told() -> None:
    bracket = found(lambda share: not 0.4 <= share < 0.6 and share < 0.9)
    assert bracket.first is not None
    assert bracket.last < 0.4 <= bracket.first < 0.41
    assert bracket.beyond == [0.75]


def test_the_runs_at_most() -> None:
    assert Bracket(9, 0.01).most == 9 + 4
    assert Bracket(2, 0.25).most == 2 + 2
    assert Bracket(11, 0.5).most == 11
