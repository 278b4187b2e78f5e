"""Every unit through every border: a component that declares them all, in a spec that writes them in others."""

from __future__ import annotations

import csv
import io
import random
from dataclasses import dataclass
from pathlib import Path

import pytest

from gaitsim.model import Model
from gaitsim.optimization.history import parameters_csv
from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.results.listing import parameter_rows
from gaitsim.results.tuned import problem_of, read_tuned, write_tuned
from gaitsim.simulation.run import Simulator
from gaitsim.text.document import parse
from gaitsim.spec.resolve import resolve
from gaitsim.units import known_units, parse_unit, with_unit

COMPOUND = ("N/cm", "kN/mm", "cm^2", "1/min", "deg/s", "N m/deg", "J/(kg m)", "%/s", "1/deg", "g/cm^3", "1")
UNITS = (*known_units(), *COMPOUND)
CHANCE = random.Random(3)


@dataclass(frozen=True)
class Said:
    """A number of the spec: the unit it is declared in, the one it is written in, its value and its bounds."""

    declared: str
    written: str
    value: float
    low: float
    high: float
    default: float

    def text(self, number: float) -> str:
        return with_unit(repr(number), self.written)

    def declared_number(self, number: float) -> float:
        return number * parse_unit(self.written).factor / parse_unit(self.declared).factor


def said(unit: str) -> Said:
    others = [u for u in UNITS if parse_unit(u).dimension == parse_unit(unit).dimension]
    value = float(f"{CHANCE.uniform(1, 90):.3g}")
    bounds = (float(f"{share * value:.3g}") for share in (0.1, 3))
    return Said(unit, CHANCE.choice(others), value, *bounds, default=CHANCE.choice([0.1, 0.7, 3, 15, 23]))


ALL = [said(unit) for unit in UNITS]


def component() -> str:
    lines, body = [], []
    for i, one in enumerate(ALL):
        lines += [
            f'    tuned{i} = Parameter("{one.declared}", "A number.")',
            f'    kept{i} = Parameter("{one.declared}", "A number.", default={one.default})',
            f'    free{i} = Input("{one.declared}", "A signal.", default={one.default})',
            f'    set{i} = Input("{one.declared}", "A signal.")',
            *(f'    {name}{i} = Output("{one.declared}", "A signal.")' for name in ("of_tuned", "of_free", "of_set")),
        ]
        body += [f"y.of_tuned{i} = p.tuned{i}", f"y.of_free{i} = u.free{i}", f"y.of_set{i} = u.set{i}"]
    head = "from gaitsim.component import Component, Input, Output, Parameter\n\n\nclass One(Component):\n"
    function = "\n    @staticmethod\n    def output(p, u, x, y):\n        "
    return f'{head}    """All units."""\n\n' + "\n".join(lines) + "\n" + function + "\n        ".join(body) + "\n"


def spec() -> str:
    lines, measures = [], []
    for i, one in enumerate(ALL):
        value, low, high = (one.text(number) for number in (one.value, one.low, one.high))
        lines += [f"    tuned{i}: {{value: {value}, tune: [{low}, {high}]}}", f"    set{i}: {value}"]
        for name in ("of_tuned", "of_free", "of_set"):
            measures.append(f"  {name}{i}: {{use: measure/range, signal: {{from: odd.{name}{i}}}}}")
    bodies = "  rod: {use: segment/rod, mass: 2 kg, length: 1 m}\n  pivot: {use: joint/hinge, parent: world, child: rod.proximal}"
    parts = f"gaitsim: 1\nparts:\n{bodies}\n  odd:\n    use: odd/one\n" + "\n".join(lines)
    return f"{parts}\nmeasures:\n" + "\n".join(measures) + "\nsimulate: {duration: 5 ms, step: 1 ms}\n"


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Model:
    folder = tmp_path_factory.mktemp("units")
    for kind in ("odd", "measure"):
        (folder / kind).mkdir()
    (folder / "odd" / "one.py").write_text(component())
    return resolve(parse(spec(), "spec.yaml"), Library((folder, shipped_folder())), "spec")


def near(number: float) -> object:
    return pytest.approx(number, rel=1e-14, abs=0)


def test_shown_numbers(model: Model) -> None:
    rows = {row["address"]: row for row in parameter_rows(model)}
    for i, one in enumerate(ALL):
        row, low_and_high = rows[f"odd.tuned{i}"], [one.low, one.high]
        assert (row["unit"], row["tune_unit"], rows[f"odd.kept{i}"]["value"]) == (
            one.declared,
            one.declared,
            one.default,
        )
        assert row["value"] == near(one.declared_number(one.value))
        assert row["tune"] == [near(one.declared_number(number)) for number in low_and_high]
        if one.declared == one.written:
            assert (row["value"], row["tune"]) == (one.value, low_and_high)


def test_metrics_and_signals(model: Model) -> None:
    outcome = Simulator(model, "normal").run(recorded=True)
    assert outcome.status == "completed" and outcome.trajectory is not None, outcome.reason
    record = outcome.trajectory
    for i, one in enumerate(ALL):
        units = [model.metrics[f"{name}{i}.high"] for name in ("of_tuned", "of_set", "of_free")]
        found = [outcome.metrics[f"{name}{i}.high"] for name in ("of_tuned", "of_set", "of_free")]
        assert units == 3 * [one.declared]
        assert found == [near(one.declared_number(n)) for n in (one.value, one.value)] + [near(one.default)]
        unit = parse_unit(record.units[record.signals.index(f"odd.of_tuned{i}")])
        assert (unit.factor, unit.dimension) == (1, parse_unit(one.declared).dimension)
        assert record[f"odd.of_tuned{i}"][0] == parse_unit(one.written).to_si(one.value)
        assert record[f"odd.of_set{i}"][0] == record[f"odd.of_tuned{i}"][0]


def test_tuned_values_and_their_table(model: Model, tmp_path: Path) -> None:
    units = {free.address: free.unit for free in model.free}
    for _ in range(20):
        values = {free.address: CHANCE.uniform(free.low, free.high) for free in model.free}
        path = write_tuned(tmp_path / "spec.yaml", "results/one", 1.0, values, units)
        again = read_tuned(path, model.free).values
        assert again == values
        started = model.started_at(again)
        assert (started.start, started.notices) == ([*values.values()], model.notices)
    table = list(csv.DictReader(io.StringIO(parameters_csv(problem_of(model), [*values.values()], []))))
    assert [row["unit"] for row in table] == [one.declared for one in ALL]
    for row in table:
        assert parse_unit(row["unit"]).to_si(float(row["best"])) == near(values[row["address"]])
