from __future__ import annotations

import numpy as np
import pytest

from gaitsim.analysis.hopping.figures import ApexPairs, Hops, dropped, hopping_figures, hops_of
from gaitsim.analysis.replays.replay import Replay
from tests.analysis.replays import cut, of_spec, of_text

GEYER = {0.05: 0.1208, 0.09: 0.1417, 0.13: 0.1552, 0.163: 0.16299, 0.2: 0.1699, 0.3: 0.1833}


@pytest.fixture(scope="module")
def hopper() -> Replay:
    return of_spec("hopping_geyer2003", [("simulate.duration", "10 s")])


def hops(heights: list[float], airborne: list[int], least: float = 0) -> Hops:
    return Hops("apex", "hip", np.array(heights), np.array(airborne, dtype=float), 0, least, None)


def test_apexes_are_the_highest_points_of_flights() -> None:
    assert hops([3, 2, 1, 0, 1, 2, 3, 2, 1], [1, 1, 0, 0, 0, 1, 1, 1, 0]).apexes == [0, 6]


def test_a_flight_that_the_run_cuts_on_its_way_up_has_no_apex() -> None:
    assert hops([3, 2, 1, 0, 1, 2, 3], [1, 1, 0, 0, 0, 1, 1]).apexes == [0]
    assert hops([3, 2, 1, 0, 1, 2, 3, 2.5], [1, 1, 0, 0, 0, 1, 1, 1]).apexes == [0, 6]


def test_a_bounce_lower_than_the_least_hop_is_none() -> None:
    heights = [3, 1, 0, 1, 1.1, 1, 0, 1, 3, 1]
    airborne = [1, 0, 0, 1, 1, 0, 0, 1, 1, 0]
    assert hops(heights, airborne).apexes == [0, 4, 8]
    assert hops(heights, airborne, least=0.5).apexes == [0, 8]


def test_who_stays_on_the_ground_has_no_apex() -> None:
    assert hops([1, 2, 1], [0, 0, 0]).apexes == []
    assert hops([], []).apexes == []
    assert hops([1, 2, 1], [0, 0, 0]).touchdown is None


def test_the_apexes_are_those_of_the_measure(hopper: Replay) -> None:
    found = hops_of(hopper)
    assert found is not None
    metrics = hopper.outcome.metrics
    assert len(found.apexes) == metrics["apex_height.hops"] + 1  # and the start
    assert found.heights[found.apexes[-3:]].mean() == pytest.approx(metrics["apex_height"], abs=1e-12)
    assert found.coordinate == "guide.position"
    assert found.touchdown == pytest.approx(0, abs=2e-4)


def test_the_apexes_of_the_leg_with_mass_are_those_of_its_measure() -> None:
    replay = of_spec("hopping_leg_mass")
    found = hops_of(replay)
    assert found is not None
    metrics = replay.outcome.metrics
    apexes = [at for at in found.apexes if at < len(found.heights) - 1]
    assert metrics["hop.hops"] <= len(apexes) <= metrics["hop.hops"] + 2
    assert found.heights[apexes].max() == pytest.approx(metrics["hop.apex_height"], abs=0.1)


def test_the_return_map_is_that_of_an_independent_solution(hopper: Replay) -> None:
    found = dropped(hopper, 40)
    assert found is not None
    assert np.isfinite(found.after).all()
    for before, after in GEYER.items():
        assert np.interp(before, found.before, found.after) == pytest.approx(after, abs=1e-3)
    (point,) = found.fixed_points
    assert point.value == pytest.approx(0.16298, abs=5e-4)
    assert point.slope == pytest.approx(0.207, abs=0.02)


def test_the_map_of_many_starts_holds_the_hops_of_one_run() -> None:
    replay = of_spec("hopping_geyer2003", [("simulate.duration", "4 s")])
    found, own = dropped(replay, 30), hops_of(replay)
    assert found is not None and own is not None
    heights = own.heights[own.apexes]
    assert np.interp(heights[:-1], found.before, found.after) == pytest.approx(heights[1:], abs=1e-3)


def test_fixed_points_of_a_line_and_of_lost_starts() -> None:
    before = np.array([0.1, 0.2, 0.3, 0.4])
    (point,) = ApexPairs(before, 0.5 * before + 0.125).fixed_points
    assert (point.value, point.slope) == (pytest.approx(0.25), pytest.approx(0.5))
    assert ApexPairs(before, np.full(4, np.nan)).fixed_points == []
    assert ApexPairs(before, before + 1).fixed_points == []


def test_the_figures_of_a_hopper(hopper: Replay) -> None:
    drawings = {d.name: d for d in hopping_figures(hopper)}
    assert list(drawings) == ["return_map", "apex_heights", "ground_force"]
    (axes,) = drawings["return_map"].figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("apex height (m)", "next apex height (m)")
    assert axes.get_xlim() == axes.get_ylim()
    labels = axes.get_legend_handles_labels()[1]
    assert labels == ["one hop after each start", "stable fixed point", "hops of this run", "reference"]
    assert "The stable fixed point is at 0.163 m" in drawings["return_map"].caption.replace("0.1629", "0.163")
    assert "leg 3496 N" in drawings["ground_force"].caption


def test_reference_values_of_another_gain_are_not_drawn() -> None:
    replay = of_spec("hopping_geyer2003", [("simulate.duration", "4 s"), ("feedback.gain", "10")])
    (axes,) = hopping_figures(replay)[0].figure.axes
    assert "reference" not in axes.get_legend_handles_labels()[1]


def test_a_hopper_that_collapses_still_has_figures() -> None:
    replay = of_spec("hopping_geyer2003", [("feedback.gain", "1")])
    assert replay.outcome.status == "stopped"
    drawings = hopping_figures(replay)
    assert [d.name for d in drawings] == ["apex_heights", "ground_force"]


def test_what_does_not_hop_has_no_such_figures() -> None:
    assert hopping_figures(of_spec("pendulum_pid")) == []


def test_a_height_that_no_initial_value_sets_is_not_dropped_again() -> None:
    text = """
gaitsim: 1
parts:
  ball: {use: segment/point_mass, mass: 2 kg}
  guide: {use: joint/vertical, parent: world, child: ball.center}
  ground: {use: contact/spring_damper, frame: ball.center, stiffness: 20 kN/m, damping: 10 N s/m}
initial: {guide.velocity: 2 m/s}
measures:
  hop: {use: measure/hop_height, height: {from: ground.height}, contact: {from: ground.in_contact}}
simulate: {duration: 1 s, step: 0.1 ms}
"""
    replay = of_text(text)
    assert dropped(replay) is None
    found = {d.name: d for d in hopping_figures(replay)}
    assert "Dots" not in found["return_map"].caption


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_a_run_of_a_few_instants(hopper: Replay, count: int) -> None:
    names = [d.name for d in hopping_figures(cut(hopper, count))]
    assert ("ground_force" in names) == (count >= 2)
