"""Pixels: muscles by their activation, arrows by their force, on a picture drawn without a display."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from gaitsim.animation import colours
from gaitsim.animation.camera import Views, follow
from gaitsim.animation.canvas import Canvas
from gaitsim.animation.posture import Posture
from gaitsim.animation.stage import stage_of
from tests.animation.runs import run_of

SIZE = 400


@pytest.fixture(scope="module")
def scene() -> Iterator[tuple[Canvas, Views]]:
    replay = run_of("hopping_leg_mass")
    posture = Posture(stage_of(replay.model), replay.trajectory)
    rows = np.array([0, len(replay.trajectory.times) - 1])
    views = follow(posture, rows, 1.0, 1.0)
    with Canvas(posture, SIZE, SIZE) as canvas:
        yield canvas, views


def drawn(scene: tuple[Canvas, Views], row: int, **signals: float) -> NDArray[np.int64]:
    """The picture of an instant, at which some signals are replaced."""
    canvas, views = scene
    posture, whole = canvas.posture, canvas.posture.trajectory
    values = whole.values.copy()
    for signal, value in signals.items():
        values[row, whole.signals.index(signal.replace("__", "."))] = value
    posture.trajectory = replace(whole, values=values)
    try:
        posture.take(row)
        return canvas.picture(replace(views, newtons=5000.0), 0).astype(np.int64)
    finally:
        posture.trajectory = whole


def test_activation_is_blue_at_rest_and_red_at_its_most() -> None:
    rest, half, most = (colours.of_activation(level) for level in (0, 0.5, 1))
    assert rest.argmax() == 2 and most.argmax() == 0
    assert rest[2] > 3 * rest[0] / 2 and most[0] > 5 * most[2]
    assert rest[0] < half[0] < most[0] and rest[2] > half[2] > most[2]
    assert (colours.of_activation(1.7) == most).all() and (colours.of_activation(-1) == rest).all()


def test_a_path_is_coloured_by_the_activation_of_its_muscle(scene: tuple[Canvas, Views]) -> None:
    rest = drawn(scene, 0, extensor__activation=0.0)
    most = drawn(scene, 0, extensor__activation=1.0)
    changed = np.abs(rest - most).sum(axis=2) > 60
    assert 100 < changed.sum() < 0.03 * SIZE**2
    red, green, blue = most[changed].mean(axis=0) - rest[changed].mean(axis=0)
    assert red > 60 and blue < -60 and abs(green) < red
    # Nothing but the path changes: it lies on the right leg, in the middle third of the picture.
    columns = np.flatnonzero(changed.any(axis=0))
    assert columns.min() > SIZE / 3 and columns.max() < 2 * SIZE / 3


def test_an_arrow_is_as_long_as_its_force(scene: tuple[Canvas, Views]) -> None:
    none = drawn(scene, 0, ground__force=0.0)
    metre = scene[1].pixels_of_a_metre(SIZE)
    for force in (1000.0, 2000.0):
        rows = np.flatnonzero((np.abs(drawn(scene, 0, ground__force=force) - none).sum(axis=2) > 40).any(axis=1))
        assert np.ptp(rows) == pytest.approx(force / 5000 * metre, rel=0.1)


def test_the_body_moves_and_the_ground_has_a_pattern(scene: tuple[Canvas, Views]) -> None:
    first, last = drawn(scene, 0), drawn(scene, 500)
    assert (np.abs(first - last).sum(axis=2) > 60).sum() > 500
    ground = first[-12, :, 1]
    assert np.ptp(ground) > 15
