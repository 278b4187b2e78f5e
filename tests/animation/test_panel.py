"""Scopes are in step: bright up to the cursor and faint behind it, with the value at the cursor beside them."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gaitsim.analysis.signals.pattern import NoSuchSignal
from gaitsim.animation.panel import Panel, _value_text
from gaitsim.animation.scopes import chosen, usual
from gaitsim.animation.stage import stage_of
from gaitsim.model import Signal
from gaitsim.simulation.outcome import Trajectory
from tests.animation.runs import run_of

LEVEL = Signal("motor.phase", "1", "Phase.", ("swing", "stance"))
FORCE = Signal("motor.force", "N", "Force.")


def panel(seconds: float, begin: float = 0.0) -> Panel:
    """Two scopes of a motion that lasts some seconds, 100 instants a second."""
    times = np.arange(0, seconds + 0.005, 0.01)
    values = np.stack([np.floor(times) % 2, 1000 * np.sin(times)], axis=1)
    trajectory = Trajectory(times, ("motor.phase", "motor.force"), ("1", "N"), values)
    return Panel(trajectory, [LEVEL, FORCE], 700, 400, begin, float(times[-1]))


def cursor(pixels: NDArray[np.uint8]) -> float:
    """The column of the cursor."""
    wide = pixels.astype(int)
    red = (wide[..., 0] > 190) & (wide[..., 1] < 60) & (wide[..., 2] < 60)
    columns = np.flatnonzero(red.sum(axis=0) > 200)
    assert len(columns) in (1, 2)
    return float(columns[0])


def ink(pixels: NDArray[np.uint8]) -> float:
    """How much colour there is, far from grey."""
    wide = pixels.astype(int)
    return float((wide.max(axis=2) - wide.min(axis=2)).mean())


def test_the_cursor_moves_evenly_with_time() -> None:
    scopes = panel(4.0)
    columns = [cursor(scopes.picture(row)) for row in (0, 100, 200, 300, 400)]
    steps = np.diff(columns)
    assert np.ptp(steps) <= 1
    assert steps[0] > 80


def test_a_trace_is_bright_up_to_the_cursor_and_faint_behind_it() -> None:
    scopes = panel(4.0)
    none, half, whole = (scopes.picture(row) for row in (0, 200, 400))
    middle = int(cursor(half))
    left, right = slice(120, middle - 5), slice(middle + 10, 560)
    assert (half[:, left] == whole[:, left]).all()
    assert (half[:, right] == none[:, right]).all()
    assert ink(whole[:, left]) > 2 * ink(none[:, left])


def test_a_long_motion_is_shown_in_pages() -> None:
    scopes = panel(10.0)
    before, after = scopes.picture(499), scopes.picture(501)
    assert cursor(before) > cursor(after) + 300
    assert len(scopes._pages) == 1


def test_values_have_as_many_decimals_as_can_be_told_apart_and_states_have_names() -> None:
    assert _value_text(FORCE, 1234.5678, 3000.0) == "1235 N"
    assert _value_text(FORCE, -0.12345, 0.5) == "−0.123 N"
    assert _value_text(Signal("a", "1", ""), 0.5, 1.0) == "0.50"
    assert _value_text(FORCE, 2.0, 0.0) == "2.000 N"
    assert _value_text(LEVEL, 1.0, 1.0) == "stance"
    assert _value_text(FORCE, -1e-16, 0.0) == "0.000 N"
    assert _value_text(FORCE, 4.23456e-8, 6e-7) == "4.23e−08 N"


def small_signals(unit: str, *signals: NDArray[np.float64]) -> Panel:
    """A scope of each signal, over 4 s."""
    names = tuple(f"a.signal_{number}" for number in range(len(signals)))
    trajectory = Trajectory(np.linspace(0, 4, 401), names, (unit,) * len(names), np.stack(signals, axis=1))
    return Panel(trajectory, [Signal(name, unit, "A signal.") for name in names], 740, 400, 0.0, 4.0)


def test_rounding_errors_are_not_magnified() -> None:
    wave = np.sin(np.linspace(0, 4, 401))
    panel = small_signals("N", 0 * wave, 1e-15 * wave, 40 + 1e-6 * wave, 3e-7 * wave)
    zero, noise, constant, small = panel._axes(Figure(), 0.0, 4.0)
    assert zero.get_ylim() == (-1, 1)
    assert noise.get_ylim() == pytest.approx((-1, 1))
    assert constant.get_ylim() == pytest.approx((20, 60), rel=1e-6)
    assert np.ptp(small.get_ylim()) < 1e-6


def test_a_power_of_ten_covers_no_title() -> None:
    wave = np.sin(np.linspace(0, 4, 401))
    figure = Figure()
    FigureCanvasAgg(figure)
    for axes in small_signals("N", 3e-7 * wave, 4e7 * wave)._axes(figure, 0.0, 4.0):
        figure.draw_without_rendering()
        exponent = axes.yaxis.get_offset_text()
        assert exponent.get_text()
        assert exponent.get_window_extent().x1 <= axes.get_window_extent().x0 + 1


def test_numbers_with_long_units_stay_in_the_picture() -> None:
    picture = small_signals("N m/rad", 3e-7 * np.sin(np.linspace(0, 4, 401))).picture(200)
    assert (picture[:, -5:] == 255).all()


def test_long_names_of_levels_stay_in_the_picture() -> None:
    times = np.linspace(0, 1, 11)
    trajectory = Trajectory(times, ("gait.phase",), ("1",), np.zeros((11, 1)))
    signal = Signal("gait.phase", "1", "Phase.", ("early_stance_of_a_leg", "swing"))
    picture = Panel(trajectory, [signal], 700, 300, 0.0, 1.0).picture(5)
    assert (picture[:, :5] == 255).all() and (picture[:, -5:] == 255).all()
    assert (picture < 255).any(axis=2).sum() > 1000


def test_the_number_beside_a_scope_changes() -> None:
    scopes = panel(4.0)
    first, last = (scopes.picture(row)[:, 590:] for row in (0, 157))
    assert (first != last).any()


def test_usual_scopes_of_the_hoppers() -> None:
    hopper, leg = run_of("hopping_geyer2003").model, run_of("hopping_leg_mass").model
    assert [signal.address for signal in usual(hopper, stage_of(hopper))] == [
        "extensor.activation",
        "extensor.force",
        "leg.force",
        "guide.position",
        "feedback.stimulation",
    ]
    assert "ground.force" in [signal.address for signal in usual(leg, stage_of(leg))]


def test_scopes_by_pattern_and_by_a_wrong_name() -> None:
    model = run_of("hopping_geyer2003").model
    assert [s.address for s in chosen(model, ["leg.force", "leg.*ce", "guide.position"])] == [
        "leg.force",
        "leg.in_stance",
        "guide.position",
    ]
    with pytest.raises(NoSuchSignal, match=r"extensor\.force"):
        chosen(model, ["extensor.forc"])


def test_the_cursor_leaves_titles_alone_on_the_first_frame() -> None:
    """It stands at the left end then, where the titles begin, and the first frame is the poster."""
    scopes = panel(4.0)
    pixels = scopes.picture(0).astype(int)
    red = (pixels[..., 0] > 190) & (pixels[..., 1] < 60) & (pixels[..., 2] < 60)
    rows = np.flatnonzero(red[:, int(cursor(scopes.picture(0)))])
    first, second = scopes._page(0.0).spans
    assert set(rows) == set(range(*first)) | set(range(*second))
    assert second[0] - first[1] > 10
