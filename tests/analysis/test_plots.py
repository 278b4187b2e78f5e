"""Figures of any signal: what stands on their axes, who is in their legends, what is left out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gaitsim.analysis.drawings import style
from gaitsim.analysis.drawings.drawing import Drawing, save
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.signals import plots
from gaitsim.analysis.signals.motion import motion_figures
from gaitsim.analysis.signals.pattern import NoSuchSignal
from gaitsim.analysis.signals.return_map_figure import TooFewEvents, return_map
from gaitsim.analysis.signals.selection import runs_without

from .swinging import replay


@pytest.fixture(scope="module")
def swing() -> Replay:
    return replay(label="free")


@pytest.fixture(scope="module")
def braked() -> Replay:
    return replay(("brake.derivative", "1 N m s/rad"), label="braked")


@pytest.fixture(scope="module")
def broken() -> Replay:
    return replay(("watch.limit", "-20 deg"), label="broken")


def axes_of(drawing: Drawing) -> list[Any]:
    return list(drawing.figure.axes)


def drawn(drawing: Drawing) -> list[tuple[str, list[str]]]:
    """Of each panel the name of its side, and of its lines."""
    return [(axes.get_ylabel(), [str(line.get_label()) for line in axes.get_lines()]) for axes in axes_of(drawing)]


def heading(drawing: Drawing) -> str:
    return str(drawing.figure.get_suptitle())


def test_one_run_signals_of_one_unit_share_a_panel(swing: Replay) -> None:
    (drawing,) = plots.against_time([swing], "[pb]*.*[ey]")
    assert drawn(drawing) == [
        ("pivot.angle\n(rad)", ["pivot.angle"]),
        ("pivot.velocity\n(rad/s)", ["pivot.velocity"]),
        ("brake.torque\n(N·m)", ["brake.torque"]),
    ]
    assert [axes.get_xlabel() for axes in axes_of(drawing)] == ["", "", "time (s)"]
    (drawing,) = plots.against_time([swing], "*.[at][nu]*")
    assert drawn(drawing) == [("angle\n(rad)", ["pivot.angle", "watch.turned"])]
    assert [text.get_text() for text in axes_of(drawing)[0].get_legend().get_texts()] == ["pivot.angle", "watch.turned"]


def test_many_signals_are_several_figures(swing: Replay) -> None:
    found = plots.against_time([swing], "*")
    assert [drawing.name for drawing in found] == ["all", "all_2"]
    assert [drawing.title for drawing in found] == ["* against time (1 of 2)", "* against time (2 of 2)"]
    assert drawn(found[1]) == [("watch.side\n(–)", ["watch.side"])]


def test_named_levels_stand_on_the_axis(swing: Replay) -> None:
    (drawing,) = plots.against_time([swing], "watch.side")
    (axes,) = axes_of(drawing)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["left", "right"]
    assert axes.get_lines()[0].get_drawstyle() == "steps-post"


def test_captions_explain_with_the_words_of_the_declarations(swing: Replay) -> None:
    (drawing,) = plots.against_time([swing], "brake.*")
    assert drawing.caption == (
        "brake.torque (N·m): Torque that reduces the error. brake.accumulated (rad·s): Integral of the error."
    )
    assert heading(drawing) == "brake.* against time, free"


def test_several_runs_have_a_panel_for_each_signal(swing: Replay, braked: Replay) -> None:
    (drawing,) = plots.against_time([swing, braked], "pivot.*")
    lines = ["free", "braked"]
    assert drawn(drawing) == [("pivot.angle\n(rad)", lines), ("pivot.velocity\n(rad/s)", lines)]
    assert [text.get_text() for text in drawing.figure.legends[0].get_texts()] == lines
    first, second = axes_of(drawing)[0].get_lines()
    assert first.get_color() != second.get_color()


def test_a_run_that_broke_is_drawn_up_to_there_with_its_reason(swing: Replay, broken: Replay) -> None:
    (drawing,) = plots.against_time([swing, broken], "pivot.angle")
    (axes,) = axes_of(drawing)
    whole, part, cross = axes.get_lines()
    assert whole.get_xdata()[-1] == 7.999
    assert part.get_xdata()[-1] == cross.get_xdata()[-1] == 0.643
    assert cross.get_marker() == "x"
    assert "broken failed: watch (controller/side) raised in output at 0.644 s" in heading(drawing).replace("\n", " ")
    assert drawing.caption.endswith("ValueError: it broke.")


def test_an_input_is_what_its_senders_sent(swing: Replay) -> None:
    (drawing,) = plots.against_time([swing.between(0, 1)], "pivot.torque")
    (line,) = axes_of(drawing)[0].get_lines()
    np.testing.assert_array_equal(line.get_ydata(), swing.trajectory["brake.torque"][:1001])


def test_a_long_line_keeps_its_extremes(swing: Replay) -> None:
    (drawing,) = plots.against_time([swing], "pivot.angle")
    (line,) = axes_of(drawing)[0].get_lines()
    angle = swing.trajectory["pivot.angle"]
    assert len(line.get_ydata()) < 2500 < len(angle)
    assert (line.get_ydata().min(), line.get_ydata().max()) == (angle.min(), angle.max())


def test_against_another_signal(swing: Replay) -> None:
    (drawing,) = plots.against_signal([swing], "pivot.velocity", "pivot.angle")
    (axes,) = axes_of(drawing)
    assert (drawing.name, axes.get_xlabel()) == ("pivot.velocity.against.pivot.angle", "pivot.angle (rad)")
    loop, first = axes.get_lines()
    np.testing.assert_array_equal(loop.get_xdata(), swing.trajectory["pivot.angle"])
    np.testing.assert_array_equal(loop.get_ydata(), swing.trajectory["pivot.velocity"])
    assert (first.get_xdata()[0], first.get_marker()) == (swing.trajectory["pivot.angle"][0], "o")


def test_against_must_be_one_other_signal(swing: Replay) -> None:
    with pytest.raises(NoSuchSignal) as error:
        plots.against_signal([swing], "brake.torque", "pivot.*")
    assert str(error.value) == "pivot.*: this must be one signal, and it matches 2; write one address."
    with pytest.raises(NoSuchSignal) as error:
        plots.against_signal([swing], "pivot.angle", "pivot.angle")
    rule = "this is the signal that it would be drawn against; name another."
    assert str(error.value) == f"pivot.angle: {rule}"


def test_the_return_map_of_a_damped_swing(swing: Replay, braked: Replay) -> None:
    stiffer = replay(("brake.proportional", "2 N m/rad"), label="stiffer")
    drawing = return_map([swing, braked, stiffer], "pivot.angle")
    (axes,) = axes_of(drawing)
    assert axes.get_xlabel() == "pivot.angle, maximum n (rad)"
    assert axes.get_ylabel() == "pivot.angle, maximum n + 1 (rad)"
    assert axes.get_xlim() == axes.get_ylim()
    labels = [text.get_text() for text in drawing.figure.legends[0].get_texts()]
    assert labels == ["free", "stiffer", "diagonal"]
    assert "braked: too few maxima (2)" in drawing.caption
    now, after = axes.get_lines()[0].get_data()
    np.testing.assert_array_equal(now[1:], after[:-1])
    # A linear damper: angles shrink by exp(-d T / (2 I)), with I = m l^2 / 3 and T of a thin rod.
    period = 2 * np.pi * np.sqrt(2 / (3 * 9.81))
    assert after[-1] / now[-1] == pytest.approx(np.exp(-0.2 * period / (2 * 2 / 3)), rel=0.01)


def test_a_measure_stands_for_what_it_watches(swing: Replay) -> None:
    drawing = return_map([swing], "swing")
    assert (drawing.name, drawing.title) == ("swing.return_map", "return map of pivot.angle")


def test_too_few_events_for_a_return_map(swing: Replay) -> None:
    with pytest.raises(TooFewEvents) as error:
        return_map([swing.between(0, 3)], "pivot.angle")
    assert str(error.value) == (
        "pivot.angle: a return map needs 3 maxima of pivot.angle, and free has 1; simulate longer, such as "
        "--set 'simulate.duration=20 s', or name another signal."
    )
    assert error.value.exit_code == 2


def test_a_signal_that_one_run_lacks_is_drawn_of_the_others(swing: Replay) -> None:
    other = replay(("parts.watch", "null"), label="blind")
    (drawing,) = plots.against_time([swing, other], "watch.turned")
    assert drawn(drawing) == [("watch.turned\n(rad)", ["free"])]
    assert drawing.caption.endswith("blind has no such signal.")
    assert runs_without([swing, other], "watch.turned") == ["blind"]
    with pytest.raises(NoSuchSignal, match=r"^watch\.turned: there is no such signal; "):
        plots.against_time([other], "watch.turned")


def test_the_overview_of_any_model(swing: Replay, braked: Replay) -> None:
    motion, control = plots.signal_overlays([swing, braked])[:2]
    assert [name for name, _ in drawn(motion)] == ["pivot.angle\n(rad)"]
    assert (motion.name, control.name) == ("motion", "control")


def test_rounding_errors_are_not_magnified() -> None:
    still = replay(("initial.pivot.angle", "0 deg"))
    (drawing,) = plots.against_time([still], "pivot.angle")
    (overview, *_) = motion_figures(still)
    for axes in (drawing.figure.axes[0], overview.figure.axes[0]):
        assert axes.get_ylim() == pytest.approx((-1, 1))


def test_figures_are_written_whole_or_not_at_all(swing: Replay, tmp_path: Path) -> None:
    found = plots.against_time([swing], "pivot.*")
    paths = save(found, tmp_path / "new" / "figures", ("png", "svg", "pdf"))
    assert [path.name for path in paths] == ["pivot.all.png", "pivot.all.svg", "pivot.all.pdf"]
    assert [path.read_bytes()[:4] for path in paths] == [b"\x89PNG", b"<?xm", b"%PDF"]
    assert sorted(path.name for path in paths) == sorted(p.name for p in (tmp_path / "new/figures").iterdir())


def test_units_are_read_as_they_are_written_in_papers() -> None:
    assert style.labelled("torque", "N m/rad") == "torque (N·m/rad)"
    assert style.labelled("acceleration", "m/s^2") == "acceleration (m/s²)"
    assert style.labelled("gain", "1") == "gain (–)"
    assert [style.quantity(unit) for unit in ("N m", "J", "m", "1", "rad/s")] == [
        "moment",
        "energy",
        "length",
        "value",
        "angular velocity",
    ]


def test_lines_differ_beyond_the_palette() -> None:
    looks = [tuple(style.look(number).values()) for number in range(28)]
    assert len(set(looks)) == 28
