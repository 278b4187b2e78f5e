"""The recorded curves that are shipped, and how components get them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from components.calls import FOLDER, Tables, metrics, primitive

from gaitsim.components.bibliography import read_bibliography
from gaitsim.components.find import Library
from gaitsim.components.table import Table, load_table, resampled
from gaitsim.distribution import shipped_folder
from gaitsim.errors import InvalidSpec
from gaitsim.results.bundle import bundled
from gaitsim.results.citation import citations
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

CYCLE = np.linspace(0, 1, 101)
BUMP = np.interp(CYCLE, [0, 0.25, 0.5, 0.75, 1], [0.0, 1.0, 0.2, 2.0, 0.0])


def read_table(path: Path, shown: str) -> Table:
    return load_table(path, shown, path.read_text(encoding="utf-8"))


def table(name: str) -> Table:
    return read_table(FOLDER / "norms" / f"{name}.csv", name)


def peak(column: str, low: float = 0, high: float = 100) -> tuple[float, float]:
    """The highest value between two percentages, in degrees, and where it is."""
    angles = table("fukuchi2018_walking")
    inside = (angles.over >= low / 100) & (angles.over <= high / 100)
    at = int(np.argmax(np.where(inside, angles.columns[column], -np.inf)))
    return math.degrees(angles.columns[column][at]), 100 * angles.over[at]


def test_the_shipped_angles_are_those_of_the_literature() -> None:
    # Bands of healthy walking at 1.2 to 1.3 m/s: loading 13 to 22, swing peak 60 to 66 at 71 to 74 %.
    assert peak("knee_flexion", 0, 40) == (pytest.approx(17.9), pytest.approx(14))
    assert peak("knee_flexion") == (pytest.approx(62.4), pytest.approx(74))
    assert peak("hip_flexion") == (pytest.approx(34.4), pytest.approx(90))
    assert peak("ankle_dorsiflexion") == (pytest.approx(11.7), pytest.approx(44))


def test_the_shipped_moments_are_those_of_the_literature() -> None:
    moments = table("fukuchi2018_walking_moments")
    ankle = moments.columns["ankle_plantarflexion_moment"]
    assert (np.max(ankle), int(np.argmax(ankle))) == (pytest.approx(1.54, abs=0.01), 48)
    assert moments.units["ankle_plantarflexion_moment"] == "N m/kg"


@pytest.mark.parametrize("path", sorted((FOLDER / "norms").glob("*.csv")), ids=lambda path: path.stem)
def test_every_table_says_whose_it_is(path: Path) -> None:
    found = read_table(path, path.name)
    assert found.recorded_by in read_bibliography([FOLDER])
    assert "licence: CC BY 4.0" in found.about


def test_resampling_is_straight_between_points() -> None:
    over = np.array([0.0, 0.5, 1.0])
    assert resampled(over, np.array([0.0, 1.0, 4.0]), 5) == (0, 0.5, 1, 2.5, 4)


def _even(low: int, high: int, step: int = 2) -> str:
    return "cycle [%],knee [deg]\n" + "".join(f"{at},{at / 2}\n" for at in range(low, high + 1, step))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("# only words\n", "bad.csv: a table has a row of names with units, such as cycle [%],knee_flexion [deg], "),
        (
            "cycle [%],knee\n0,1\n1,2\n",
            'bad.csv:1: "knee" is not a name with a unit; write such as knee_flexion [deg].',
        ),
        ("cycle [%],knee [dog]\n0,1\n1,2\n", 'bad.csv:1: "dog" is not a known unit; write such as knee_flexion [deg].'),
        ("cycle [%]\n0\n1\n", "bad.csv:1: there is one column; a curve needs another beside it."),
        (
            "cycle [%],knee [deg],knee [rad]\n0,1,1\n1,1,1\n",
            "bad.csv:1: 2 columns are named knee; give each a name of its own.",
        ),
        (
            "time [s],knee [deg]\n0,1\n1,2\n",
            "bad.csv:1: time is in s; the first column says where in the cycle a row lies, as a share: "
            "write such as cycle [%], 0 to 100.",
        ),
        ("cycle [%],knee [deg]\n0,1\n1\n", "bad.csv:3: this row has 1 numbers, and there are 2 names."),
        (
            "cycle [%],knee [deg]\n0,1\n1,x\n2,nan\n3,\n",
            'bad.csv:3: "x" is not a number; write such as 12.5, or remove the row.\n'
            'bad.csv:4: "nan" is not a number; write such as 12.5, or remove the row.\n'
            "bad.csv:5: a number is missing; write such as 12.5, or remove the row.",
        ),
        (
            "cycle [%],knee [deg]\n0,1\n4,1\n2,2\n2,3\n",
            "bad.csv:4: cycle is 2 % after 4 %; put the rows in order, one cycle only.\n"
            "bad.csv:5: cycle is 2 %, as in line 4; keep one of the two rows.",
        ),
        (
            _even(0, 58),
            "bad.csv:31: the rows cover 0 % to 58 % of the cycle, and a curve covers 0 to 100 %; "
            "add the rows that are missing. gaitsim does not extrapolate.",
        ),
        (
            _even(0, 20) + _even(40, 100).partition("\n")[2],
            "bad.csv:13: no row lies between 20 % and 40 % of the cycle; "
            "add some, as a recorded curve has one each 10 % or closer.",
        ),
        (_even(0, 102), "bad.csv:53: cycle is 102 %, and a cycle goes from 0 to 100 %; check unit and rows."),
        (
            _even(0, 10).replace("[%]", "[1]"),
            "bad.csv:3: no row lies between 0 % and 200 % of the cycle; "
            "add some, as a recorded curve has one each 10 % or closer.",
        ),
    ],
)
def test_a_table_with_a_mistake_says_where(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises(InvalidSpec) as raised:
        read_table(tmp_path / "bad.csv", "bad.csv")
    assert str(raised.value).startswith(said)


def test_a_table_without_its_last_row_ends_where_it_begins(tmp_path: Path) -> None:
    (tmp_path / "open.csv").write_text(_even(0, 98))
    curve = read_table(tmp_path / "open.csv", "open.csv").curve("knee", 101)
    assert [math.degrees(curve[at]) for at in (0, 58, 98, 99, 100)] == pytest.approx([0, 29, 49, 24.5, 0])


@pytest.mark.parametrize("separator", [";", "\t"])
def test_a_table_of_a_spreadsheet_is_the_same_table(separator: str, tmp_path: Path) -> None:
    shipped = (FOLDER / "norms" / "fukuchi2018_walking.csv").read_text(encoding="utf-8")
    words, head, rows = shipped.partition("cycle")
    written = words + (head + rows).replace(",", separator).replace(".", ",") + 6 * separator + "\n"
    (tmp_path / "excel.csv").write_text(written.replace("\n", "\r\n"), encoding="utf-8-sig", newline="")
    found, expected = read_table(tmp_path / "excel.csv", "excel.csv"), table("fukuchi2018_walking")
    assert (found.recorded_by, found.units) == (expected.recorded_by, expected.units)
    assert [list(found.columns[name]) for name in found.units] == [list(expected.columns[n]) for n in expected.units]


@pytest.mark.parametrize("dt", [0.01, 0.001])  # at 1 ms a stride has more steps than there is room for
@pytest.mark.parametrize("late", [0.0, 0.05])
def test_gait_curve_of_the_same_shape(dt: float, late: float) -> None:
    times = np.arange(round(12 / dt)) * dt
    phase = np.mod(times + 1e-9, 1.2) / 1.2
    angle = 0.3 + 2 * np.interp(phase, CYCLE, BUMP)
    stance = np.mod(times - late + 1e-9, 1.2) < 0.7
    signals = {"signal": angle, "stance": stance.astype(float)}
    found = metrics("measure/gait_curve", signals, dt, curve=BUMP, delay=late, zero=0.3)
    assert found["value"] == pytest.approx(1, abs=1e-4)
    assert found["highest"] == pytest.approx(4, abs=0.06)
    assert found["highest_at"] == pytest.approx(0.75, abs=0.011)
    assert (found["lowest"], found["reach"]) == (pytest.approx(0, abs=0.03), pytest.approx(4, abs=0.08))
    # It is twice the curve: the difference is the curve itself.
    assert found["error"] == pytest.approx(math.sqrt(np.mean(BUMP**2)), abs=0.01)
    assert found["shape_error"] == pytest.approx(np.std(BUMP), abs=0.01)
    turned = metrics("measure/gait_curve", signals, dt, curve=BUMP, delay=late, direction=-1.0)
    assert turned["value"] == pytest.approx(-1, abs=1e-4)
    # Without its lateness the same curve would lie beside the recorded one.
    if late:
        assert metrics("measure/gait_curve", signals, dt, curve=BUMP)["value"] < 0.95


def test_gait_curve_is_the_mean_over_strides_that_count() -> None:
    times = np.arange(1000) * 0.01
    # A stride a second: 1 + the curve, then 3 + the curve, and so on; the first two do not count.
    angle = 1 + 2 * np.mod(np.floor(times + 1e-9), 2) + np.interp(np.mod(times + 1e-9, 1), CYCLE, BUMP)
    stance = (np.mod(times + 1e-9, 1) < 0.6).astype(float)
    found = metrics("measure/gait_curve", {"signal": angle, "stance": stance}, 0.01, curve=BUMP, settle=2.0)
    # Seven whole strides from 2 s to 9 s: four at 1 and three at 3.
    assert found["error"] == pytest.approx((4 * 1 + 3 * 3) / 7, abs=0.02)
    assert found["shape_error"] == pytest.approx(0, abs=0.1)
    none = metrics("measure/gait_curve", {"signal": angle, "stance": stance}, 0.01, curve=BUMP, settle=9.0)
    assert all(math.isnan(value) for value in none.values())


def test_gait_curve_reports_where_in_percent() -> None:
    assert primitive("measure/gait_curve").metrics["highest_at"].unit == "%"


def test_a_constant_signal_has_no_correlation() -> None:
    stance = (np.mod(np.arange(1000) * 0.01 + 1e-9, 1) < 0.6).astype(float)
    found = metrics("measure/gait_curve", {"signal": [1.0] * 1000, "stance": stance}, 0.01, curve=BUMP)
    assert math.isnan(found["value"]) and found["reach"] == 0


SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
initial: {pivot.angle: 90 deg}
measures:
  stance: {use: measure/stance, load: 1}
  knee:
    use: measure/gait_curve
    curve: norms/fukuchi2018_walking.knee_flexion
    signal: {from: pivot.angle}
    stance: {from: stance.in_stance}
    delay: {from: stance.delay}
simulate: {duration: 0.1 s, step: 1 ms}
"""


def test_a_spec_names_a_column_or_writes_a_list() -> None:
    library = Library((shipped_folder(),))
    model = resolve(parse(SPEC, "spec.yaml"), library, "spec")
    (knee,) = [part for part in model.parts if part.address == "knee"]
    values = knee.series["curve"].values
    assert len(values) == 101
    assert math.degrees(values[74]) == pytest.approx(62.4)
    assert math.degrees(values[73]) == pytest.approx((61.9 + 62.4) / 2)
    text = SPEC.replace("norms/fukuchi2018_walking.knee_flexion", "[0 deg, 90 deg, 0 deg]")
    (knee,) = [p for p in resolve(parse(text, "spec.yaml"), library, "spec").parts if p.address == "knee"]
    assert knee.series["curve"].values[25] == pytest.approx(math.pi / 4)
    assert Simulator(model).run().status == Simulator(model, "normal").run().status == "completed"


def test_a_result_takes_its_recorded_curves_along_and_cites_them(tmp_path: Path) -> None:
    library = Library((shipped_folder(),))
    document = parse(SPEC, "spec.yaml")
    model = resolve(document, library, "spec")
    bundle = bundled(document, "spec", library, {}, [model])
    assert "components/norms/fukuchi2018_walking.csv" in bundle.files
    bundle.write(tmp_path)
    again = resolve(document, Library((tmp_path / "components",)), "spec")
    assert [part.series for part in again.parts] == [part.series for part in model.parts]
    cited = [entry.key for entry in citations(model, read_bibliography([FOLDER])).entries]
    assert "fukuchi2018" in cited


@pytest.mark.parametrize(
    ("curve", "said"),
    [
        (
            "3",
            "knee.curve: curve is a recorded curve; write a column of a table, such as "
            "norms/fukuchi2018_walking.knee_flexion, or a list such as [0.5, 0.5].",
        ),
        ("norms/fukuchi.knee", "knee.curve: there is no table norms/fukuchi. Did you mean norms/fukuchi2018_walking?"),
        (
            "norms/fukuchi2018_walking_moments.knee",
            "knee.curve: norms/fukuchi2018_walking_moments has no column knee; choose "
            "norms/fukuchi2018_walking_moments.hip_extension_moment, "
            "norms/fukuchi2018_walking_moments.knee_extension_moment, "
            "norms/fukuchi2018_walking_moments.ankle_plantarflexion_moment, "
            "norms/fukuchi2018_walking_moments.ankle_plantarflexion_moment_sd.",
        ),
        ("[1 deg]", "knee.curve: a curve has two numbers or more, at equal distances."),
        ("[1 deg, often]", 'knee.curve.1: "often" is not a number'),
    ],
)
def test_a_bad_curve_is_told_with_its_place(curve: str, said: str) -> None:
    text = SPEC.replace("norms/fukuchi2018_walking.knee_flexion", curve)
    with pytest.raises(InvalidSpec) as raised:
        resolve(parse(text, "spec.yaml"), Library((shipped_folder(),)), "spec")
    (fault,) = raised.value.faults
    assert f"{fault.address}: {fault.message}".startswith(said)
    assert fault.mark is not None and fault.mark.line == 10


def test_a_series_is_read_alike_in_native_code_and_in_python(tmp_path: Path) -> None:
    (tmp_path / "controller").mkdir()
    (tmp_path / "controller" / "profile.py").write_text(_PROFILE)
    library = Library((tmp_path, shipped_folder()))
    kind = library.find("controller/profile")
    for mode in ("rapid", "normal"):
        tables = Tables(kind).put({"curve": np.arange(5.0), "phase": 0.3})  # type: ignore[arg-type]
        assert not tables.call("output", mode)  # type: ignore[arg-type]
        assert tables.y.value == 2 * math.pi
    with pytest.raises(InvalidSpec, match=r"is a value in N m/kg \[N m/kg\] but curve takes an angle \[rad\]"):
        text = SPEC.replace("parts:\n", "parts:\n  own: {use: controller/profile, curve: NORM, phase: 0}\n")
        moment = "norms/fukuchi2018_walking_moments.hip_extension_moment"
        resolve(parse(text.replace("NORM", moment), "spec.yaml"), library, "spec")


_PROFILE = '''\
import math

from gaitsim.component import Component, Input, Output, Series


class Profile(Component):
    """Gives what was recorded."""

    curve = Series("rad", "What was recorded.", size=5)
    phase = Input("1", "Where in the cycle.")
    value = Output("rad", "The recorded angle there.")

    @staticmethod
    def output(p, u, x, y):
        y.value = p.curve[int(math.ceil(4 * u.phase))] * math.pi
'''
