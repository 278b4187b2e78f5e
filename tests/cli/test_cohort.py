"""gaitsim cohort: stones in place of people, whose fall is known; bad tables; and what is killed goes on."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import pytest

import gaitsim as notebook
from gaitsim.errors import InvalidSpec
from gaitsim.results.record import Record
from gaitsim.results.rows import read_rows

from .commands import Said, gaitsim

STONE = """
gaitsim: 1
parameters:
  body_height: {unit: m, default: 40 cm, bounds: [1 cm, 3 m], doc: How high it is held.}
  body_mass: {unit: kg, default: 1 kg, bounds: [1 g, 300 kg], doc: Its mass.}
parts:
  stone: {use: segment/point_mass, mass: =body_mass}
  guide: {use: joint/vertical, parent: world, child: stone.center}
initial: {guide.position: =body_height, guide.velocity: {value: 0 m/s, tune: [-1 m/s, 4 m/s], spread: 0.3 m/s}}
measures:
  landed: {use: measure/fall, height: {from: guide.position}, below: 0 m}
  way: {use: measure/range, signal: {from: guide.position}}
objective: {use: objective/maximize, value: {from: landed}}
simulate: {duration: 0.3 s, step: 1 ms}
"""
BODIES = "name,height [m],mass [kg]\nlow,0.3,1\nhigh,0.6,2\ndeep,-1,2\n"
OUTSIDE = '"-1 m" is outside 0.01 to 3 m; choose a value between.'


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("stone.yaml").write_text(STONE, encoding="utf-8")
    Path("bodies.csv").write_text(BODIES, encoding="utf-8")


def cohort(capsys: pytest.CaptureFixture[str], *words: str) -> Said:
    return gaitsim(capsys, "cohort", "stone.yaml", "bodies.csv", "--workers", "0", *words)


def table(folder: Path | str) -> list[dict[str, str]]:
    with Path(folder, "table.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_every_body_with_every_device_into_one_table(capsys: pytest.CaptureFixture[str]) -> None:
    said = cohort(capsys, "--vary", "stone.radius=0.1 m,20 cm", "--metric", "way")
    (folder,) = Path("results").iterdir()
    rows = table(folder)
    assert [(row["body"], row["body_height [m]"], row["body_mass [kg]"], row["stone.radius [m]"]) for row in rows] == [
        (name, height, mass, radius)
        for name, height, mass in (("low", "0.3", "1.0"), ("high", "0.6", "2.0"), ("deep", "-1.0", "2.0"))
        for radius in ("0.1", "0.2")
    ]
    assert [row["ending"] for row in rows] == [*["stopped"] * 2, *["completed"] * 2, *["failed"] * 2]
    fallen = math.sqrt(2 * 0.3 / 9.81)
    assert [float(row["time [s]"]) for row in rows[:3]] == pytest.approx([fallen, fallen, 0.3], abs=2e-3)
    assert (said.code, rows[4]["way [m]"]) == (0, "")
    assert rows[4]["reason"] == f"bodies.csv:4 body_height=-1 m: body_height: {OUTSIDE}"
    assert said.err.startswith(f"warning: {rows[4]['reason']}\n")
    assert f"deep (2 rows from 5) failed: {rows[4]['reason']}\n" in said.err
    assert "3 bodies x 2: 6 rows: 2 completed, 2 failed, 2 stopped; " in said.out
    assert {path.name for path in (folder / "figures").iterdir()} == {"endings.png", "way.png"}
    assert gaitsim(capsys, "results", "verify", str(folder)).code == 0


def test_a_row_that_does_not_complete_is_tuned_for_a_while(capsys: pytest.CaptureFixture[str]) -> None:
    data = json.loads(cohort(capsys, "--retune", "40", "--json").out)
    low, high, deep = data["rows"]
    assert [row["ending"] for row in (low, high, deep)] == ["retuned", "completed", "failed"]
    assert (0 < low["evaluations"] <= 40, high["evaluations"], deep["evaluations"]) == (True, 0, 0)
    assert data["endings"] == {"completed": 1, "failed": 1, "retuned": 1}
    again = json.loads(gaitsim(capsys, "run", data["result"], "--candidate", "1", "--no-save", "--json").out)
    assert (again["status"], again["metrics"]["way"]) == ("completed", low["way [m]"])
    assert gaitsim(capsys, "results", "verify", data["result"]).code == 0
    few = json.loads(cohort(capsys, "--retune", "2", "--seed", "5", "--set", "body_height=3 m", "--json").out)
    assert few["rows"][0]["evaluations"] <= 2


def test_a_row_that_no_search_helps_has_used_its_evaluations(capsys: pytest.CaptureFixture[str]) -> None:
    words = ("--set", "simulate.duration=5 s", "--set", "landed.beyond=1 rad", "--retune", "13", "--json")
    rows = json.loads(cohort(capsys, *words[:2], *words[4:]).out)["rows"]
    assert [(row["ending"], row["evaluations"]) for row in rows[:2]] == [("stopped", 13), ("stopped", 13)]


def files(folder: Path) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in ("evaluations.jsonl", "table.csv", "cohort.json")}


def test_processes_and_what_was_killed_give_the_same_bytes(capsys: pytest.CaptureFixture[str]) -> None:
    words = ("--retune", "40", "--vary", "stone.radius=0.1 m,0.2 m")
    cohort(capsys, *words, "--results", "serial")
    gaitsim(capsys, "cohort", "stone.yaml", "bodies.csv", "--workers", "2", *words, "--results", "parallel")
    (serial,), (parallel,) = (list(Path(name).iterdir()) for name in ("serial", "parallel"))
    complete = files(serial)
    assert files(parallel) == complete
    lines = complete["evaluations.jsonl"].splitlines(keepends=True)
    for kept in (lines[0], lines[3] + lines[1], b"".join(lines[:4]) + lines[4][:50], b"".join(lines)):
        (serial / "evaluations.jsonl").write_bytes(kept)
        manifest = serial / "manifest.json"
        manifest.write_text(manifest.read_text().replace('"complete"', '"running"'))
        (serial / "table.csv").unlink()
        said = gaitsim(capsys, "cohort", str(serial), "--resume", "--workers", "0")
        assert f"resuming {serial}: {kept.count(bytes([10]))} of 6 rows are in it" in said.err
        assert (said.code, files(serial)) == (0, complete)
        assert json.loads(manifest.read_text())["status"] == "complete"


def test_rows_are_kept_as_they_come(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    add, seen = Record.add, []

    def counted(record: Record, *row: Any) -> None:
        add(record, *row)
        seen.append(len(read_rows(next(Path("results").iterdir()))))
        if len(seen) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(Record, "add", counted)
    said = cohort(capsys)
    (folder,) = Path("results").iterdir()
    assert (said.code, seen, len(table(folder))) == (130, [1, 2], 2)
    assert f"interrupted; to continue: gaitsim cohort {folder} --resume --workers 0" in said.err


def test_the_spec_s_own_study_is_crossed_unless_it_is_varied(capsys: pytest.CaptureFixture[str]) -> None:
    Path("stone.yaml").write_text(f"{STONE}study: [{{stone.radius: 1 cm}}, {{stone.radius: 2 cm}}]\n")
    assert len(json.loads(cohort(capsys, "--no-save", "--json").out)["rows"]) == 6
    varied = json.loads(cohort(capsys, "--vary", "stone.radius=3 cm:5 cm:3", "--no-save", "--json").out)
    assert [row["stone.radius [m]"] for row in varied["rows"]][:3] == [0.03, 0.04, 0.05]
    assert len(varied["rows"]) == 9


EXCEL = "\ufeffname;height [cm];mass [kg]\r\nlow;30,5;1\r\n\r\nhigh;60;2,25\r\n"


def test_a_table_of_a_spreadsheet(capsys: pytest.CaptureFixture[str]) -> None:
    Path("bodies.csv").write_bytes(EXCEL.encode())
    rows = json.loads(cohort(capsys, "--no-save", "--json").out)["rows"]
    assert [(row["body"], row["body_height [m]"], row["body_mass [kg]"]) for row in rows] == [
        ("low", 0.305, 1.0),
        ("high", 0.6, 2.25),
    ]


def test_units_may_stand_with_the_values_and_names_may_be_missing(capsys: pytest.CaptureFixture[str]) -> None:
    Path("bodies.csv").write_text("height,stone.radius\n30 cm,1 cm\n0.6 m,2 cm\n")
    rows = json.loads(cohort(capsys, "--no-save", "--json").out)["rows"]
    assert [(row["body"], row["body_height [m]"], row["stone.radius [m]"]) for row in rows] == [
        ("1", 0.3, 0.01),
        ("2", 0.6, 0.02),
    ]


def test_sex_is_the_parameter_female_of_a_spec_that_has_one(capsys: pytest.CaptureFixture[str]) -> None:
    female = '  female: {unit: "1", default: 0, bounds: [0, 1], doc: 1 for a woman.}\nparts:'
    Path("stone.yaml").write_text(
        STONE.replace("parts:", female, 1).replace("mass: =body_mass", "mass: =(1 + female) * body_mass")
    )
    Path("bodies.csv").write_text("name,sex\nann,female\nbob,M\n")
    rows = json.loads(cohort(capsys, "--no-save", "--json").out)["rows"]
    assert [row["female"] for row in rows] == [1, 0]


LACKS = "so no part of its body follows from it; declare it under parameters: and use it as "


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "bodies.csv: this file is empty; write columns such as name,height [m],mass [kg], and rows."),
        (
            "name,height [m]\n",
            "bodies.csv: there is no body below the columns; write a row for each.",
        ),
        (
            "1.8,80\n",
            'bodies.csv:1: "1.8" names no column; the first row names them, such as name,height [m],mass [kg].',
        ),
        (
            "name\nann\n",
            "bodies.csv:1: no column says what differs between bodies; write such as name,height [m],mass [kg].",
        ),
        (
            "height [ft]\n6\n",
            "bodies.csv:1: height: ft is not a unit that is known; write such as height [m], height [cm] or mass [kg].",
        ),
        ("height [m]\n180 qm\n", 'bodies.csv:2: height: "qm" is not a known unit. Did you mean m?'),
        (
            "height\n180\n",
            "bodies.csv:1: height: its numbers have no unit; write it in the first row, such as height [m], "
            "or with each value.",
        ),
        ("height [m],mass [kg]\n1.8\n", "bodies.csv:2: this row has 1 cells, and the first row names 2 columns; "),
        ("height [m],mass [kg]\n1,75,80\n", "bodies.csv:2: this row has 3 cells, and the first row names 2 columns; "),
        ("height [m]\n1.8\n \nx\n", 'bodies.csv:4: height: "x" is not a number; this needs a length, such as "45 cm".'),
        ("height [m],mass [kg]\n1.8,\n", "bodies.csv:2: mass: there is no mass; write it, or leave the row out."),
        (
            "name,height [m]\nann,1.8\nbob,1.7\nann,1.6\n",
            "bodies.csv:2: 2 bodies are called ann (bodies.csv:2, bodies.csv:4); give each its own name.",
        ),
        (
            "height [m],body_height [m]\n1,1\n",
            "bodies.csv:1: height and body_height are one column 2 times; leave one.",
        ),
        (
            "heigth [m]\n1.8\n",
            "bodies.csv:1: heigth: neither a column of bodies (name, height, mass, sex) nor a parameter of this spec. "
            "Did you mean height?",
        ),
        (
            "stone.mas [kg]\n1.8\n",
            "bodies.csv:1: stone.mas: no column of bodies (name, height, mass, sex), and in the spec: "
            "segment/point_mass has no mas. Did you mean mass?",
        ),
        (
            "name,sex\nann,female\n",
            "bodies.csv:1: sex: this spec has one body for both sexes, as it declares no parameter female; ",
        ),
        ('a,"b\n', "bodies.csv: this is not a table of separated values (unexpected end of data); save it as CSV."),
    ],
)
def test_a_table_that_is_wrong_is_refused_before_anything_is_run(
    text: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("bodies.csv").write_text(text)
    said = cohort(capsys)
    assert (said.code, said.out) == (3, "")
    assert message in said.err
    assert not Path("results").exists()


def test_all_that_is_wrong_with_a_table_is_said_at_once(capsys: pytest.CaptureFixture[str]) -> None:
    Path("bodies.csv").write_text("name,height [m]\nann,x\nann,80 kg\n")
    said = cohort(capsys)
    assert said.err.count("bodies.csv:") == 5
    assert 'bodies.csv:3: height: kg is a unit of mass; this needs a length, such as "45 cm".' in said.err


def test_a_spec_without_such_a_body_says_what_to_add(capsys: pytest.CaptureFixture[str]) -> None:
    Path("stone.yaml").write_text(STONE.replace("body_mass", "weight"))
    said = cohort(capsys)
    expected = (
        f"this spec declares no parameter body_mass, {LACKS}specs/walking_geyer2010.yaml does, or leave the column out."
    )
    assert (said.code, said.err) == (3, f"bodies.csv:1: mass: {expected}\n")


def test_bodies_that_all_are_impossible_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    Path("bodies.csv").write_text("name,height [m]\nann,20\nbob,0\n")
    said = cohort(capsys)
    assert (said.code, said.out) == (3, "")
    assert said.err.startswith('bodies.csv:2 body_height=20 m: body_height: "20 m" is outside 0.01 to 3 m')


def test_no_text_in_utf_8(capsys: pytest.CaptureFixture[str]) -> None:
    Path("bodies.csv").write_bytes("name,height [m]\nJörg,1.8\n".encode("latin-1"))
    said = cohort(capsys)
    assert said.err == "bodies.csv: this is not a text in UTF-8; save it as CSV, in a spreadsheet as CSV UTF-8.\n"


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (("stone.yaml",), 2, "there is no table of bodies; name one, such as gaitsim cohort stone.yaml bodies.csv, or"),
        (("stone.yaml", "no.csv"), 2, "no.csv: there is no such file; name a table of bodies with columns such as"),
        (("stone.yaml", "bodies.csv", "--retune", "-1"), 2, "--retune -1: a number of evaluations for each row, or 0"),
        (("stone.yaml", "bodies.csv", "--seed", "-1"), 2, "--seed -1: the smallest value is 0."),
        (
            ("stone.yaml", "bodies.csv", "--metric", "ways"),
            2,
            "--metric ways: there is no such metric. Did you mean way?",
        ),
        (
            ("stone.yaml", "bodies.csv", "--resume"),
            2,
            "bodies.csv begins a new cohort, and --resume continues an old one",
        ),
        (("stone.yaml", "--retune", "5", "--resume"), 2, "--retune begins a new cohort, and --resume continues an old"),
        (("stone.yaml", "--resume"), 2, "--resume: stone.yaml is a spec; name the result folder of the cohort"),
        (
            ("stone.yaml", "bodies.csv", "--vary", "body_mass=1 kg,2 kg"),
            3,
            "bodies.csv: body_mass is a column here and varied as well; leave it out of one of them.",
        ),
        (
            ("stone.yaml", "bodies.csv", "--retune", "5", "--set", "objective=null"),
            3,
            "stone.yaml: this spec has no objective, so no row can be tuned again; leave out --retune.",
        ),
    ],
)
def test_words_that_do_not_fit(
    words: tuple[str, ...], code: int, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    said = gaitsim(capsys, "cohort", *words)
    assert (said.code, said.out) == (code, "")
    assert message in said.err
    assert not Path("results").exists()


def test_another_result_is_no_cohort(capsys: pytest.CaptureFixture[str]) -> None:
    result = json.loads(gaitsim(capsys, "run", "stone.yaml", "--json").out)["result"]
    said = gaitsim(capsys, "cohort", result, "--resume")
    assert (said.code, said.err) == (
        3,
        f"{result}/cohort.json: this is not a result of gaitsim cohort; name one, or restore it from a copy.\n",
    )


def test_a_notebook_has_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    runs = notebook.cohort("stone.yaml", "bodies.csv", vary={"stone.radius": ["1 cm", "2 cm"]}, workers=0)
    found = runs.table()
    assert (len(found), list(found["ending"].unique())) == (6, ["stopped", "completed", "failed"])
    assert runs.folder is not None
    import pandas

    kept = pandas.read_csv(runs.folder / "table.csv")
    assert kept.columns.tolist() == found.columns.tolist()
    assert kept["time [s]"].tolist() == found["time [s]"].tolist()
    assert notebook.cohort(runs.folder, resume=True, workers=0).counts == runs.counts
    with pytest.raises(InvalidSpec):
        Path("bodies.csv").write_text("")
        notebook.cohort("stone.yaml", "bodies.csv")
    assert capsys.readouterr() == ("", "")
