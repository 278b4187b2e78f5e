"""The camera goes with the motion, not with its bounces, and all that moves stays in the picture."""

from __future__ import annotations

import numpy as np
import pytest

from gaitsim.animation.camera import _smooth, follow
from gaitsim.animation.caption import room_for
from gaitsim.animation.posture import Posture, rows_at
from gaitsim.animation.stage import stage_of
from tests.animation.runs import run_of


def test_a_straight_way_stays_what_it_is_and_bounces_vanish() -> None:
    times = np.arange(0, 4, 0.02)
    straight = np.stack([1.3 * times, 0 * times, 0.9 + 0 * times], axis=1)
    bouncing = straight.copy()
    bouncing[:, 2] += 0.1 * np.sin(2 * np.pi * 2 * times)
    assert _smooth(straight, 0.02) == pytest.approx(straight, abs=1e-9)
    assert _smooth(bouncing, 0.02)[60:-60] == pytest.approx(straight[60:-60], abs=1e-3)


def test_a_hopper_is_seen_whole_by_a_camera_that_stands_still() -> None:
    replay = run_of("hopping_leg_mass")
    posture = Posture(stage_of(replay.model), replay.trajectory)
    rows = rows_at(replay.trajectory, np.arange(0, 1, 0.05))
    views = follow(posture, rows, 0.05, 0.75)
    assert np.ptp(views.points[:, 2]) == 0
    for k, row in enumerate(rows):
        posture.take(int(row))
        low, high = posture.extent
        assert high[2] < views.points[k, 2] + 0.75 * views.half_height
        assert low[2] > views.points[k, 2] - views.half_height
        assert max(abs(low[0]), abs(high[0])) < 0.75 * views.half_height


def test_the_scale_of_arrows_is_a_round_number_and_leaves_room() -> None:
    replay = run_of("hopping_leg_mass")
    posture = Posture(stage_of(replay.model), replay.trajectory)
    rows = rows_at(replay.trajectory, np.arange(0, 1, 0.05))
    views = follow(posture, rows, 0.05, 0.75)
    assert views.newtons in (1e3, 2e3, 5e3, 1e4, 2e4)
    assert np.max(replay.trajectory["ground.force"][rows]) / views.newtons < 0.6


def test_a_small_picture_keeps_its_words_off_the_body() -> None:
    replay = run_of("hopping_leg_mass")
    posture = Posture(stage_of(replay.model), replay.trajectory)
    rows = rows_at(replay.trajectory, np.arange(0, 1, 0.1))
    above, below = room_for(200, 200, 2)
    views = follow(posture, rows, 0.1, 1.0, (above, below))
    posture.take(int(rows[0]))
    extents = []
    for row in rows:
        posture.take(int(row))
        extents.append([end[2] for end in posture.extent])
    lowest, highest = np.min(extents), np.max(extents)
    bottom, top = (views.points[0, 2] + way * views.half_height for way in (-1, 1))
    assert below > 0.15
    assert min(lowest, 0) - bottom > 0.95 * below * (top - bottom)
    assert top - highest > 0.95 * above * (top - bottom)


@pytest.mark.parametrize("view", ["side", "behind", "oblique"])
def test_a_body_that_moves_in_space_stays_in_the_picture_from_wherever_it_is_seen(view: str) -> None:
    replay = run_of("walking_scone_h1922", 0.15)
    posture = Posture(stage_of(replay.model, wide=view != "side"), replay.trajectory)
    rows = rows_at(replay.trajectory, np.arange(0, 0.15, 0.05))
    views = follow(posture, rows, 0.05, 0.75, view=view)
    azimuth = np.radians(views.camera(0).azimuth)
    right = np.array([np.sin(azimuth), -np.cos(azimuth), 0])
    assert views.camera(0).elevation < 0
    for k, row in enumerate(rows):
        posture.take(int(row))
        low, high = posture.extent
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        aside = (corners - views.points[k]) @ right
        assert np.max(np.abs(aside)) < 0.75 * views.half_height
        assert np.max(np.abs(corners[:, 2] - views.points[k, 2])) < views.half_height
