"""Time in the viewer: it runs in a loop, pauses, steps, and changes its speed."""

from __future__ import annotations

import pytest

from gaitsim.animation.player import DOWN, HOME, LEFT, RIGHT, SPACE, UP, Player


def test_time_runs_at_its_speed_and_begins_anew_at_the_end() -> None:
    player = Player(1.0, 3.0, speed=0.5)
    player.advance(2.0)
    assert player.time == pytest.approx(2.0)
    player.advance(2.5)
    assert player.time == pytest.approx(1.25)


def test_space_pauses_and_goes_on() -> None:
    player = Player(0.0, 2.0)
    player.press(SPACE)
    player.advance(1.0)
    assert (player.paused, player.time) == (True, 0.0)
    player.press(SPACE)
    player.advance(1.0)
    assert player.time == pytest.approx(1.0)


def test_arrows_step_and_pause() -> None:
    player = Player(0.0, 2.0, speed=0.25)
    player.press(RIGHT)
    player.press(RIGHT)
    player.press(LEFT)
    assert player.paused
    assert player.time == pytest.approx(0.25 / 60)


def test_up_and_down_change_the_speed_and_home_goes_to_the_start() -> None:
    player = Player(0.5, 2.0)
    for key in (UP, UP, DOWN):
        player.press(key)
    assert player.speed == 2
    player.advance(0.2)
    player.press(HOME)
    assert player.time == 0.5


def test_a_single_instant_stands_still() -> None:
    player = Player(0.5, 0.5)
    player.advance(1.0)
    assert player.time == 0.5
