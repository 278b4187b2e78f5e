"""gaitsim archive: records are written by a command, hold on other machines, and tell what has changed."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from gaitsim.components.bibliography import keys_of, read_bibliography
from gaitsim.distribution import shipped_folder, shipped_specs
from gaitsim.study.records import Value, read_record, record_path
from gaitsim.text.document import plain, read

from .commands import Said, gaitsim

QUICK = ("hopping_geyer2003", "hopping_leg_mass", "pendulum_pid")
SPEC = Path("hopper.yaml")
CURVE = "return math.exp(math.log(0.05) * abs((length - 1) / width) ** 3)"


@pytest.fixture
def hopper(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the published hopper, brief, and its muscle as a component of its own."""
    monkeypatch.chdir(tmp_path)
    text = shipped_specs()["hopping_geyer2003"].read_text(encoding="utf-8")
    SPEC.write_text(text.replace("duration: 20 s", "duration: 2 s"), encoding="utf-8")
    muscle = Path("components/muscle/geyer2003.py")
    muscle.parent.mkdir(parents=True)
    shutil.copy(shipped_folder() / "muscle" / "geyer2003.py", muscle)
    return muscle


def check(capsys: pytest.CaptureFixture[str], *words: str) -> Said:
    said = gaitsim(capsys, "archive", "check", *words)
    return Said(said.code, " ".join(said.out.split()), said.err)


def test_models_that_run_briefly_do_what_was_recorded(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "archive", "check", *QUICK)
    assert (said.code, said.out) == (0, "3 of 3 models do what was recorded\n"), said.out + said.err


@pytest.mark.parametrize("name", shipped_specs())
def test_every_shipped_spec_has_a_record(name: str) -> None:
    found = record_path(shipped_specs()[name]).is_file()
    assert found, f"no record of {name}; write it with: gaitsim archive record {name}"


def test_the_list_says_what_models_are_and_what_they_did(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "archive", "list", *QUICK, "--json")
    hopper = next(m for m in json.loads(said.out)["models"] if m["name"] == "hopping_geyer2003")
    assert hopper["about"].startswith("Hopping by positive force feedback")
    assert hopper["papers"] == ["geyer2003"]
    value, unit = hopper["metrics"]["apex_height"]
    assert (round(value, 3), unit) == (0.163, "m")
    told = " ".join(gaitsim(capsys, "archive", "list", *QUICK).out.split())
    assert "hopping_geyer2003 Hopping by positive force feedback" in told and "apex_height 0.16298 m" in told


KNOWN = """\
reproduces:
  - {what: Height, metric: apex_height, value: 16 cm, tolerance: 5 cm, source: geyer2003}
  - {what: Force, metric: peak_force, value: 3 kN, tolerance: 1 N, source: "geyer2003: made up"}
  - {what: Frequency, metric: hopping_frequency, value: 1.4 Hz, source: "definition: made up"}
"""


def test_known_values_stand_beside_those_of_the_model(hopper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = SPEC.read_text(encoding="utf-8")
    SPEC.write_text(text[: text.index("reproduces:")] + KNOWN, encoding="utf-8")
    unknown = json.loads(gaitsim(capsys, "archive", "list", str(SPEC), "--json").out)["models"][0]["reproduces"]
    assert [(row["known"], row["model"], row["holds"]) for row in unknown] == [
        (16, None, None),
        (3, None, None),
        (1.4, None, None),
    ]
    gaitsim(capsys, "archive", "record", str(SPEC))
    recorded = read_record(SPEC).runs[0].numbers
    height, force = recorded["apex_height"].value, recorded["peak_force"].value
    assert height is not None and force is not None
    (model,) = json.loads(gaitsim(capsys, "archive", "list", str(SPEC), "--json").out)["models"]
    first, second, third = model["reproduces"]
    assert (first["unit"], first["source"], first["holds"]) == ("cm", "geyer2003", True)
    assert first["model"] == pytest.approx(100 * height) and first["difference"] == pytest.approx(100 * height - 16)
    assert second["model"] == pytest.approx(force / 1000) and second["holds"] is False
    assert third["holds"] is None and third["share"] == pytest.approx(third["model"] / 1.4 - 1)
    said = " ".join(gaitsim(capsys, "archive", "list", str(SPEC)).out.split())
    assert "1 of 2 within tolerance, differs by up to" in said
    assert f"hopper.yaml Height apex_height 16 cm {100 * height:.9g} cm" in said
    checked = gaitsim(capsys, "check", str(SPEC))
    assert f"{100 * height:.9g} cm" in checked.out
    # With settings it is another model than the recorded one.
    other = json.loads(gaitsim(capsys, "check", str(SPEC), "--set", "feedback.gain=3", "--json").out)
    assert [row["model"] for row in other["reproduces"]] == [None, None, None]


def test_what_a_parent_reproduces_a_spec_need_not(hopper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("child.yaml").write_text("gaitsim: 1\nextends: hopper.yaml\n", encoding="utf-8")
    assert json.loads(gaitsim(capsys, "check", "child.yaml", "--json").out)["reproduces"] == []


def test_a_source_that_no_bibliography_has_is_told(hopper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = SPEC.read_text(encoding="utf-8")
    SPEC.write_text(text[: text.index("reproduces:")] + KNOWN.replace("geyer2003}", "geyer2033}"), encoding="utf-8")
    said = gaitsim(capsys, "check", str(SPEC))
    place = f"hopper.yaml:{1 + text[: text.index('reproduces:')].count(chr(10)) + 1}:5"
    words = "reproduces: the source geyer2033 is in no references.bib. Did you mean geyer2003?"
    assert said.code == 0 and f"warning: {place}: {words}" in said.err


@pytest.mark.parametrize("name", shipped_specs())
def test_sources_of_known_values_are_in_the_bibliography(name: str) -> None:
    keys = read_bibliography((shipped_folder(),))
    rows = plain(read(shipped_specs()[name])).get("reproduces", [])
    assert [key for row in rows for key in keys_of(row["source"]) if key not in keys] == []


@pytest.mark.slow
def test_all_models_do_what_was_recorded(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "archive", "check")
    assert said.code == 0, said.out + said.err


def test_a_record_is_the_same_text_each_time_and_written_once(hopper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record = Path("records/hopper.yaml")
    assert gaitsim(capsys, "archive", "record", str(SPEC)).out == "records/hopper.yaml: new\n"
    text = record.read_text(encoding="utf-8")
    assert gaitsim(capsys, "archive", "record", ".").out == "records/hopper.yaml: unchanged\n"
    record.unlink()
    gaitsim(capsys, "archive", "record", str(SPEC))
    assert record.read_text(encoding="utf-8") == text
    (run,) = read_record(SPEC).runs
    assert run.status == "completed"
    apex = run.numbers["apex_height"]
    assert apex.value is not None and apex.tolerance is not None and apex.unit == "m"
    assert 1e-6 * apex.value <= apex.tolerance < 1e-3 * apex.value
    assert check(capsys, str(SPEC)) == (0, "1 of 1 models do what was recorded", "")


def test_one_per_cent_of_a_muscles_curve_is_noticed(hopper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gaitsim(capsys, "archive", "record", str(SPEC))
    text = hopper.read_text(encoding="utf-8")
    assert CURVE in text
    hopper.write_text(text.replace(CURVE, CURVE.replace("return ", "return 1.01 * ")), encoding="utf-8")
    said = check(capsys, str(SPEC))
    assert said.code == 4
    assert said.out.startswith("model run metric recorded now unit change tolerance hopper.yaml score ")
    assert "hopper.yaml apex_height 0.1" in said.out and said.out.endswith("0 of 1 models do what was recorded")
    told, move = said.err.splitlines()
    assert told.startswith("hopper.yaml: changed since it was recorded: muscle/geyer2003 ")
    assert move == "if this is meant: gaitsim archive record hopper.yaml"
    found = json.loads(gaitsim(capsys, "archive", "check", str(SPEC), "--json").out)
    differs = {each["metric"]: each for each in found["models"][0]["differs"]}
    assert 1e-4 < abs(differs["apex_height"]["change"]) < 0.1
    # Meant, it is recorded; what still holds stays as it was.
    before = read_record(SPEC)
    assert gaitsim(capsys, "archive", "record", str(SPEC)).out.startswith("records/hopper.yaml: changed\n")
    after = read_record(SPEC)
    assert before.runs[0].numbers["apex_height"] != after.runs[0].numbers["apex_height"]
    assert before.runs[0].numbers["steps"] == after.runs[0].numbers["steps"]
    assert check(capsys, str(SPEC)).code == 0


def test_a_changed_text_that_changes_no_number_is_no_drift(hopper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gaitsim(capsys, "archive", "record", str(SPEC))
    hopper.write_text(hopper.read_text(encoding="utf-8") + "\n# Read twice.\n", encoding="utf-8")
    assert check(capsys, str(SPEC)) == (0, "1 of 1 models do what was recorded", "")


def test_a_record_that_is_missing_or_was_edited_costs_only_its_model(
    hopper: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy(SPEC, "other.yaml")
    shutil.copy(SPEC, "broken.yaml")
    gaitsim(capsys, "archive", "record", ".")
    Path("records/other.yaml").unlink()
    record = Path("records/broken.yaml")
    record.write_text(record.read_text(encoding="utf-8").replace("status: completed", "status: stopped"))
    said = check(capsys, ".")
    assert (said.code, said.out) == (4, "1 of 3 models do what was recorded")
    assert said.err == (
        "records/broken.yaml: this record was damaged or edited; restore it from a copy, or write it again with: "
        "gaitsim archive record broken.yaml\n"
        "records/other.yaml: there is no record of this model; write it with: gaitsim archive record other.yaml\n"
    )
    assert gaitsim(capsys, "archive", "record", ".").out == (
        "records/broken.yaml: new\nrecords/hopper.yaml: unchanged\nrecords/other.yaml: new\n"
    )


def test_a_model_that_cannot_run_costs_only_itself(hopper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("wrong.yaml").write_text("gaitsim: 1\nextends: hopper.yaml\nsimulate: {step: 1 kg}\n", encoding="utf-8")
    said = gaitsim(capsys, "archive", "record", ".")
    assert (said.code, said.out) == (4, "records/hopper.yaml: new\n")
    assert said.err.startswith("wrong.yaml:3:18: simulate.step: kg is a unit of mass")
    assert not Path("records/wrong.yaml").exists()


def test_runs_of_a_study_are_recorded_each(hopper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = "gaitsim: 1\nextends: hopper.yaml\nstudy: [{feedback.gain: 2}, {feedback.gain: 3}]\n"
    Path("gains.yaml").write_text(study, encoding="utf-8")
    gaitsim(capsys, "archive", "record", "gains.yaml")
    assert [run.settings for run in read_record(Path("gains.yaml")).runs] == [
        {"feedback.gain": "2"},
        {"feedback.gain": "3"},
    ]
    Path("gains.yaml").write_text(study.replace("gain: 3", "gain: 4"), encoding="utf-8")
    said = check(capsys, "gains.yaml")
    assert said.code == 4
    assert "gains.yaml runs feedback.gain = 2; feedback.gain = 3 feedback.gain = 2; feedback.gain = 4" in said.out
    assert "gains.yaml: changed since it was recorded: the spec" in said.err


@pytest.mark.parametrize(
    ("word", "said"),
    [
        (
            "hoping_geyer2003",
            "hoping_geyer2003: this is neither a shipped spec, nor a .yaml file, nor a folder. Did you mean",
        ),
        ("components", "components: there is no spec in this folder; name one that has some.\n"),
    ],
)
def test_what_is_no_spec_is_told(hopper: Path, word: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = check(capsys, word)
    assert found.code == 2
    assert found.err.startswith(said)


def test_a_number_holds_within_its_tolerance() -> None:
    assert Value(value=1.0, tolerance=0.1).holds(1.05) and not Value(value=1.0, tolerance=0.1).holds(1.2)
    assert not Value(value=1.0, tolerance=0.1).holds(None) and not Value(value=None, tolerance=0.0).holds(1.0)
    assert Value(value=None, tolerance=0.0).holds(None) and Value(value=1.0, tolerance=None).holds(None)
