"""A number stands beside its own unit, at every border; and text that is read again gives the same bits."""

from __future__ import annotations

import csv
import json
import math
import random
from pathlib import Path
from typing import Any

import pytest
from optimization.searches import Ended
from results.foreign import BOUNDS, SAID, make

import gaitsim
from gaitsim.analysis.report.facts import tuned_table
from gaitsim.cli.main import main
from gaitsim.units import known_units, parse_quantity, parse_unit

SEARCH = ("--workers", "0", "--smoke", "--seed", "1")
COMPOUND = ("1", "*", "N/cm", "kN/mm", "cm^2", "1/min", "deg/s", "N m/deg", "J/(kg m)", "%/s", "1/deg", "g/cm^3", "1/%")


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Any:
    """Commands in a folder with the spec."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    make(tmp_path)

    def run(*words: str) -> Ended:
        with pytest.raises(SystemExit) as ended:
            main(list(words))
        out, err = capsys.readouterr()
        assert "Traceback" not in err, err
        return Ended(int(ended.value.code or 0), out, err)

    return run


@pytest.fixture
def searched(command: Any) -> Path:
    """A search whose best values were adopted."""
    ended = command("optimize", "spec.yaml", *SEARCH, "--adopt", "--json")
    assert ended.code == 0, ended.err
    return Path(ended.data["result"])


def best_of(folder: Path) -> dict[str, float]:
    """The best vector of a search, in SI, by address."""
    lines = [json.loads(line) for line in (folder / "evaluations.jsonl").read_text().splitlines()]
    return dict(zip(BOUNDS, min(lines, key=lambda line: line["score"])["x"], strict=True))


def cells(out: str, first: str) -> list[str]:
    """The row of a printed table."""
    return next(line.split() for line in out.splitlines() if line.split()[:1] == [first])


@pytest.mark.parametrize("text", [*known_units(), *COMPOUND])
def test_text_of_a_value_reads_back_bit_for_bit(text: str) -> None:
    unit, chance = parse_unit(text), random.Random(text)
    assert (parse_unit(unit.si).factor, parse_unit(unit.si).dimension) == (1.0, unit.dimension)
    values = [math.ldexp(chance.uniform(-2, 2), chance.randint(-40, 40)) for _ in range(400)]
    for value in (*values, 0.0, -0.0, 5e-324, 1e308):
        quantity = parse_quantity(unit.exactly(value))
        assert quantity is not None
        assert (quantity.value.hex(), quantity.unit.dimension) == (value.hex(), unit.dimension)


@pytest.mark.parametrize("text", known_units())
def test_a_number_that_was_written_comes_back_as_it_was(text: str) -> None:
    unit, chance = parse_unit(text), random.Random(text)
    for _ in range(200):
        number = float(f"{chance.uniform(-500, 500):.{chance.randint(1, 12)}g}")
        assert unit.of(unit.to_si(number)) == number


def test_si_units_by_name() -> None:
    names = {"MPa": "Pa", "N/cm": "N/m", "g/cm^3": "kg/m^3", "deg/s": "rad/s", "%": "1", "1/min": "1/s", "kN": "N"}
    assert {text: parse_unit(text).si for text in names} == names


def test_parameters_are_shown_in_their_own_units(command: Any) -> None:
    out = command("show", "spec.yaml", "--parameters").out
    rows = {row["address"]: row for row in command("show", "spec.yaml", "--parameters", "--json").data["parameters"]}
    for address, (number, unit, _) in SAID.items():
        assert cells(out, address)[1:3] == [f"{number:g}", unit]
        assert (rows[address]["value"], rows[address]["unit"]) == (number, unit)
    for address, bounds in BOUNDS.items():
        assert (rows[address]["tune"], rows[address]["tune_unit"]) == ([*bounds], SAID[address][1])
    assert rows["odd.tension"]["spread"] == 0.05


def test_the_model_has_si_from_text_and_from_declarations_alike(command: Any) -> None:
    from gaitsim.study.opening import Opening

    model = Opening(Path("spec.yaml"), tuned=False).open().model()
    values = dict(zip((n.address for n in model.numbers), model.values(), strict=True))
    assert {address: values[address] for address in SAID} == {a: value for a, (_, _, value) in SAID.items()}
    declared = Opening(Path("spec.yaml"), ("odd.delay={tune: [1 ms, 20 ms]}",), tuned=False).open().model()
    assert next(free.start for free in declared.free if free.address == "odd.delay") == 0.015


def test_a_search_writes_each_number_beside_its_unit(searched: Path, command: Any) -> None:
    best = best_of(searched)
    table = command("results", "show", str(searched)).out
    with (searched / "parameters.csv").open() as file:
        rows = {row["address"]: row for row in csv.DictReader(file)}
    frame = gaitsim.load(searched).parameters()
    for address, (low, high) in BOUNDS.items():
        start, unit, _ = SAID[address]
        number = parse_unit(unit).of(best[address])
        assert (rows[address]["unit"], float(rows[address]["best"])) == (unit, number)
        assert [float(rows[address][name]) for name in ("low", "high", "start")] == [low, high, start]
        assert frame.loc[address].tolist() == [number, unit, low, high]
        assert cells(table, address) == [
            address,
            unit,
            *(f"{n:.5g}" for n in (low, high, start, number)),
            *[*_mean(rows[address])],
        ]
    kept = {row["address"]: row for row in _yaml(searched / "model.yaml")["parameters"]}
    assert (kept["odd.angle"]["value"], kept["odd.angle"]["unit"], kept["odd.angle"]["tune"]) == (20, "deg", [5, 40])


def _mean(row: dict[str, str]) -> list[str]:
    return [f"{float(row[name]):.5g}" for name in ("mean", "std")]


def _yaml(path: Path) -> Any:
    from gaitsim.text.document import plain, read

    return plain(read(path))


def test_the_table_of_a_search(command: Any) -> None:
    ended = command("optimize", "spec.yaml", *SEARCH)
    (folder,) = Path("results").iterdir()
    best = parse_unit("deg").of(best_of(folder)["odd.angle"])
    assert ended.out.splitlines()[0].split() == ["tuned", "best", "unit", "bounds"]
    assert cells(ended.out, "odd.angle") == ["odd.angle", f"{best:.5g}", "deg", "[5,", "40]"]


def test_adopted_values_are_the_same_doubles(searched: Path, command: Any) -> None:
    from gaitsim.results.tuned import read_tuned

    best = best_of(searched)
    assert read_tuned(Path("spec.tuned.yaml"), ()).values == best
    again = command("run", "spec.yaml", "--no-save", "--json")
    assert again.data["score"] == best["odd.angle"]
    assert "outside" not in again.err
    assert again.data["metrics"]["told"] == best["odd.angle"] / parse_unit("deg").factor


def test_tuned_values_written_before_units_were_right_are_si(command: Any) -> None:
    about = "Written by gaitsim optimize --adopt; not by hand. Values in SI."
    values = "{odd.angle: 0.0885 deg, odd.share: 0.3, odd.tension: 260000.0 MPa}"
    Path("spec.tuned.yaml").write_text(f"about: {about}\nresult: results/old\nscore: 1.0\nvalues: {values}\n")
    rows = {row["address"]: row for row in command("show", "spec.yaml", "--parameters", "--json").data["parameters"]}
    assert rows["odd.angle"]["value"] == parse_unit("deg").of(0.0885)
    assert (rows["odd.share"]["value"], rows["odd.tension"]["value"]) == (30, 0.26)


def test_a_table_written_before_units_were_right_is_si(searched: Path, command: Any) -> None:
    manifest = json.loads((searched / "manifest.json").read_text())
    assert manifest.pop("format") == 2
    (searched / "manifest.json").write_text(json.dumps(manifest))
    row = "odd.angle,deg,0.08726646259971647,0.6981317007977318,0.3490658503988659,0.1,0.2,0.2,0.0"
    head = (searched / "parameters.csv").read_text().splitlines()[0]
    (searched / "parameters.csv").write_text(f"{head}\n{row}\n")
    assert cells(command("results", "show", str(searched)).out, "odd.angle")[1:6] == ["deg", "5", "40", "20", "11.459"]


def test_a_report_has_each_number_in_its_unit(searched: Path) -> None:
    table = tuned_table(gaitsim.load(searched).replay())
    assert table is not None
    rows = {row[0]: row for row in table.rows}
    number = f"{parse_unit('deg').of(best_of(searched)['odd.angle']):.5g}"
    assert rows["odd.angle"][:7] == ("odd.angle", number, "deg", "5", "40", "20", number)
    assert rows["odd.share"][2:5] == ("%", "10", "90")


def test_signals_are_in_si_and_say_so(searched: Path) -> None:
    best = gaitsim.load(searched)
    signals = best.trajectory()
    assert signals["odd.turned"].attrs["units"] == "rad"
    assert float(signals["odd.turned"].max()) == best_of(searched)["odd.angle"]
    assert f"odd.angle = {parse_unit('deg').exactly(best_of(searched)['odd.angle'])}," in signals.attrs["parameters"]


def test_a_tuned_value_outside_its_bounds_is_told(searched: Path, command: Any) -> None:
    ended = command(
        "run", "spec.yaml", "--no-save", "--json", "--set", "odd.angle={value: 30 deg, tune: [25 deg, 40 deg]}"
    )
    was = parse_unit("deg").shown(best_of(searched)["odd.angle"])
    rule = f"{was} from spec.tuned.yaml is outside 25 to 40 deg, so it starts at 25 deg; widen tune, or tune it again."
    assert f"warning: odd.angle: {rule}\n" in ended.err
    assert ended.data["metrics"]["told"] == pytest.approx(25)


def test_a_tuned_value_of_another_dimension_is_refused(command: Any) -> None:
    Path("spec.tuned.yaml").write_text("format: 2\nresult: results/old\nscore: 1.0\nvalues: {odd.angle: 3 kg}\n")
    ended = command("run", "spec.yaml", "--no-save")
    assert ended.code == 3
    assert ended.err.splitlines()[0] == (
        'spec.tuned.yaml:4:21: odd.angle: kg is a unit of mass; this needs an angle, such as "1 deg".'
    )


def test_bounds_of_two_dimensions_are_refused_where_the_unit_is_open(command: Any) -> None:
    ended = command("check", "spec.yaml", "--set", "odd.any_of={value: 1 s, tune: [1 s, 2 kg]}")
    assert ended.code == 3
    assert 'odd.any_of: kg is a unit of mass; this needs a time, such as "20 ms".' in ended.err


def test_a_table_of_runs_names_the_units_of_its_columns(command: Any) -> None:
    ended = command("run", "spec.yaml", "--vary", "odd.angle=20 deg,0.2 rad", "--no-save")
    heads, first, second = (line.split() for line in ended.out.splitlines()[:3])
    assert heads == ["odd.angle", "status", "seen", "[deg]", "told", "[deg]"]
    assert first == ["20", "deg", "completed", "20", "20"]
    assert second == ["0.2", "rad", "completed", *2 * [f"{math.degrees(0.2):.5g}"]]
    data = command("run", "spec.yaml", "--no-save", "--json").data
    assert (data["units"]["told"], data["units"]["told.cost"]) == ("deg", "rad")
    assert data["metrics"]["told"] == pytest.approx(20) and data["metrics"]["told.cost"] == SAID["odd.angle"][2]
    kept = command("run", "spec.yaml", "--json").data["result"]
    assert "told 20 deg, told.cost 0.34907 rad" in (Path(kept) / "README.md").read_text()


def test_a_limit_is_told_with_its_unit(command: Any) -> None:
    ended = command(
        "limit", "spec.yaml", "--vary", "odd.angle=5 deg:35 deg", "--until", "told=0.35 rad", "--points", "3"
    )
    row = next(line for line in ended.out.splitlines() if line.split()[:1] == ["odd.angle"])
    assert "20.0 deg         20.234375 deg        told = 20.234 deg" in row


def test_draws_keep_values_in_si_and_metrics_in_their_units(command: Any) -> None:
    ended = command("run", "spec.yaml", "--draws", "2", "--json")
    for row in ended.data["rows"]:
        assert row["metrics"]["told"] == row["values"]["odd.angle"] / parse_unit("deg").factor
    assert ended.data["summary"]["told"]["unit"] == "deg"
    assert command("results", "verify", ended.data["result"]).code == 0
    again = command("run", ended.data["result"], "--candidate", "2", "--no-save", "--json")
    assert again.data["metrics"] == ended.data["rows"][1]["metrics"]


def test_a_tuned_value_that_is_tuned_no_more_is_told(searched: Path, command: Any) -> None:
    ended = command("run", "spec.yaml", "--no-save", "--json", "--set", "odd.angle=30 deg")
    rule = "--start ignores them; not tuned here, so without effect: odd.angle"
    assert f"tuned values from spec.tuned.yaml ({searched}); {rule}\n" in ended.err
    assert ended.data["metrics"]["told"] == pytest.approx(30)
