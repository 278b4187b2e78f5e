from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from gaitsim.analysis.muscles.figures import Muscle, muscle_figures, muscles, net_work, work_done
from gaitsim.analysis.muscles.overview import overview_figures
from tests.analysis.replays import command, cut, of_spec
from tests.analysis.walking import walk
from tests.simulation.models import ROOT, model


def test_the_work_of_an_ellipse_is_its_area() -> None:
    angle = np.linspace(0, 2 * np.pi, 2001)
    length, force = 0.5 + 0.03 * np.cos(angle), 1000 + 400 * np.sin(angle)
    # It shortens while the force is high: the work is given out.
    assert net_work(force, length) == pytest.approx(np.pi * 0.03 * 400, rel=1e-5)
    assert net_work(force[::-1], length[::-1]) == pytest.approx(-np.pi * 0.03 * 400, rel=1e-5)


def test_a_loop_that_is_open_is_closed_by_a_straight_line() -> None:
    force, length = np.array([0.0, 10.0, 10.0]), np.array([1.0, 1.0, 0.8])
    # A triangle of 10 N and 0.2 m.
    assert net_work(force, length) == pytest.approx(0.5 * 10 * 0.2)
    assert work_done(force, length)[-1] == pytest.approx(10 * 0.2)


def test_a_spring_gives_back_what_it_took() -> None:
    length = 0.4 + 0.02 * np.sin(np.linspace(0, 6 * np.pi, 3001))
    force = 5000 * (length - 0.38)
    assert net_work(force, length) == pytest.approx(0, abs=1e-9)


def test_work_of_nothing_and_of_one_instant_is_none() -> None:
    for count in (0, 1):
        assert net_work(np.ones(count), np.ones(count)) == 0
        assert work_done(np.ones(count), np.ones(count)).tolist() == [0.0] * count


def test_the_contractile_element_is_free_of_what_the_springs_hold() -> None:
    stretch = np.linspace(0, 0.02, 1001)
    force = 4e4 * stretch
    zero = np.zeros_like(stretch)
    only_springs = Muscle("m", force, zero, 0.1, 0.5 + stretch, zero, zero, 2e4 * stretch**2)
    # The whole unit took 8 J, and the springs hold them.
    assert work_done(force, only_springs.path_length)[-1] == pytest.approx(-8)
    assert only_springs.contractile_work == pytest.approx(zero, abs=1e-9)


def test_the_muscle_of_the_hopper() -> None:
    replay = of_spec("hopping_geyer2003", [("simulate.duration", "5 s")])
    (muscle,) = muscles(replay)
    assert muscle.optimal_fiber_length == 0.1
    # What the path takes from the fiber: F = F_SE = F_CE.
    direct = work_done(muscle.force, muscle.fiber_length)
    assert muscle.contractile_work[-1] == pytest.approx(direct[-1], abs=0.05)
    # The stimulation is the reflex's, and the activation follows it once it is limited to 1.
    assert muscle.stimulation == pytest.approx(replay.trajectory["feedback.stimulation"])
    assert muscle.stimulation.max() > 2 > 1 >= muscle.activation.max()


def test_each_muscle_has_two_figures_and_every_axis_a_unit() -> None:
    drawings = muscle_figures(of_spec("hopping_leg_mass"))
    assert [d.name for d in drawings] == ["muscle_extensor", "work_loop_extensor"]
    for drawing in drawings:
        for axes in drawing.figure.axes:
            assert axes.get_ylabel().endswith(")")
            assert axes.lines
        assert drawing.figure.axes[-1].get_xlabel().endswith(")")
    assert "Grey: stance" in drawings[0].caption
    assert "net work" in drawings[1].figure.axes[0].get_title(loc="left")


def test_a_steady_hop_costs_the_massless_leg_no_work() -> None:
    # Nothing in this model takes energy, so a hop that repeats itself needs none.
    replay = of_spec("hopping_geyer2003")
    (muscle,) = muscles(replay.between(*last_hop(replay)))
    assert net_work(muscle.force, muscle.path_length) == pytest.approx(0, abs=0.05)
    assert np.ptp(muscle.contractile_work) > 100


def last_hop(replay):  # type: ignore[no-untyped-def]
    from gaitsim.analysis.replays.cycles import last_cycles

    span = last_cycles(replay, 1)
    assert span is not None
    return span


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_a_run_of_a_few_instants(count: int) -> None:
    replay = cut(of_spec("hopping_leg_mass", [("simulate.duration", "0.1 s")]), count)
    assert len(muscle_figures(replay)) == (0 if count < 2 else 2)


def test_one_muscle_is_drawn_if_asked_for(tmp_path: Path) -> None:
    spec, folder = str(ROOT / "specs" / "hopping_leg_mass.yaml"), str(tmp_path)
    words = ("--set", "simulate.duration=1 s", "--only", "--plot", "ext*r", "--folder", folder)
    assert command("analyze", spec, *words) == 0
    made = {path.name for path in (tmp_path / "figures").iterdir()}
    assert made == {"muscle_extensor.png", "work_loop_extensor.png"}


@pytest.mark.parametrize("width", [6.0, 3.9])  # inches: on a page, and on a telephone
def test_excitations_have_one_legend_that_leaves_the_panels_their_room(width: float) -> None:
    runner = model(ROOT / "specs" / "running_wang2012.yaml")
    figure = next(d.figure for d in overview_figures(walk({}, runner)) if d.name == "excitations_l")
    figure.set_size_inches(width, figure.get_figheight())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.draw_without_rendering()
    (legend,) = figure.legends
    assert legend.get_window_extent().x0 > 0
    looks = {}
    for axes in figure.axes:
        assert axes.get_legend() is None
        assert axes.get_position().width > 0.3
        looks |= {str(line.get_label()): (line.get_color(), line.get_linestyle()) for line in axes.lines}
    texts = [text.get_text() for text in legend.get_texts()]
    shown = [(line.get_color(), line.get_linestyle()) for line in legend.get_lines()]
    assert dict(zip(texts, shown, strict=True)) == looks
    assert {"force", "swing bias", "initiation command"} < looks.keys()


def test_a_model_without_muscles_has_no_such_figures() -> None:
    assert muscle_figures(of_spec("pendulum_pid")) == []
