"""Curves of a component whose units are not SI's."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.components.find import Library
from gaitsim.components.primitive import Primitive
from gaitsim.simulation.curves import graphs

_BENT = '''\
from gaitsim.component import Component, Curve, Input, Output, Parameter


def turned(share, bend):
    return share * bend


class Bent(Component):
    """An angle, in degrees."""

    bend = Parameter("deg", "An angle.", bounds=(0, 90))
    share = Input("%", "A share.")
    angle = Output("deg", "The share of the angle.")
    of_function = Curve("turned", "share", (0, 1), "As a function.", at={"bend": 20}, unit="deg")
    of_output = Curve("angle", "share", (0, 100), "As an output.", at={"bend": 20})

    @staticmethod
    def output(p, u, x, y):
        y.angle = turned(u.share, p.bend)
'''


@pytest.mark.parametrize("name", ["of_function", "of_output"])
def test_values_are_read_in_the_units_that_are_declared(name: str, tmp_path: Path) -> None:
    (tmp_path / "odd").mkdir()
    (tmp_path / "odd" / "bent.py").write_text(_BENT)
    bent = Library((tmp_path,)).find("odd/bent")
    assert isinstance(bent, Primitive)
    graph = next(one for one in graphs(bent) if one.name == name)
    assert graph.up.unit == "deg"
    assert graph.lines[0].y[-1] == pytest.approx(20)
