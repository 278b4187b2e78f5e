"""The functions of a notebook do what the commands do, with values in place of text and errors in place of exits."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from cli.commands import gaitsim as command

import gaitsim
from gaitsim.errors import GaitsimError, Usage
from gaitsim.results.store import CannotSave
from gaitsim.study.notebook import opening

STONE = """
gaitsim: 1
parts:
  stone: {use: segment/point_mass, mass: 1 kg}
  guide: {use: joint/vertical, parent: world, child: stone.center}
initial: {guide.position: {value: 40 cm, tune: [20 cm, 60 cm]}}
measures:
  landed: {use: measure/fall, height: {from: guide.position}, below: 0 m}
  way: {use: measure/range, signal: {from: guide.position}}
objective: {use: objective/maximize, value: {from: landed}}
simulate: {duration: 0.3 s, step: 1 ms}
"""
HEIGHT = "initial.guide.position"


@pytest.fixture
def spec(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "stone.yaml"
    path.write_text(STONE, encoding="utf-8")
    return path


@pytest.fixture(autouse=True)
def nothing_is_printed(capsys: pytest.CaptureFixture[str]) -> Iterator[None]:
    yield
    assert capsys.readouterr() == ("", "")


def test_a_run_gives_what_the_command_prints(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = command(capsys, "run", str(spec), "--set", "simulate.duration=0.2 s", "--no-save", "--json")
    made = gaitsim.run(spec, {"simulate.duration": "0.2 s"}, out="stone.csv", every="10 ms")
    assert dict(made.outcomes[0].metrics) == json.loads(said.out)["metrics"]
    assert made.single and not made.failed and made.unsaved is None
    assert made.folder is not None
    assert gaitsim.load(made.folder).metrics == dict(made.outcomes[0].metrics)
    rows = Path("stone.csv").read_text().splitlines()[1:4]
    assert [row.partition(",")[0] for row in rows] == ["0.0", "0.01", "0.02"]


def test_numbers_and_words_are_set_as_a_spec_has_them() -> None:
    settings = opening("x.yaml", {"a.b": 1e-7, "c": True, "d": None, "e": "2 m", "f": [1, 2]}).settings
    assert settings == ("a.b=1e-07", "c=true", "d=null", "e=2 m", "f=[1, 2]")


def test_a_study_is_a_table(spec: Path) -> None:
    made = gaitsim.run(spec, vary={HEIGHT: ["1 m", "2 m"]}, save=False)
    table = made.table()
    assert list(table[HEIGHT]) == ["1 m", "2 m"]
    assert list(table["status"]) == ["completed", "completed"]
    assert table["way"][1] == made.outcomes[0].metrics["way"] > 0
    assert made.folder is None and not Path("results").exists()


def test_draws_are_those_of_their_seed(spec: Path) -> None:
    first, again, other = (gaitsim.run(spec, draws=2, seed=seed, save=False) for seed in (3, 3, 4))
    starts = [[model.start for model in made.simulated] for made in (first, again, other)]
    assert starts[0] == starts[1] != starts[2]


def test_a_limit_is_a_value(spec: Path) -> None:
    ranges = {"simulate.gravity": "1 m/s^2:100 m/s^2"}
    hunt = gaitsim.limit(spec, ranges, {HEIGHT: "2 m"}, tolerance=0.1, points=3, save=False)
    (limit,) = hunt.limits
    # After n steps it has fallen by g dt^2 n (n + 1) / 2: by 2 m at the last instant, n = 299, with 44.6 m/s^2.
    assert limit.first is not None
    assert float(limit.last.split()[0]) < 44.6 < float(limit.first.split()[0])


def test_a_search_is_that_of_the_command(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = gaitsim.optimize(spec, smoke=True, seed=1, workers=0, adopt=True)
    said = command(capsys, "optimize", str(spec), "--smoke", "--seed", "1", "--workers", "0", "--json")
    told = json.loads(said.out)
    assert (found.score, found.progress.evaluations) == (told["best_score"], told["evaluations"])
    journals = [Path(folder) / "evaluations.jsonl" for folder in (found.folder, told["result"])]
    assert journals[0].read_bytes() == journals[1].read_bytes()
    assert found.adoption is not None and found.adoption.written
    best = gaitsim.load(found.folder)
    assert found.values == dict(best.parameters()["value"])
    more = gaitsim.optimize(found.folder, resume=True, generations=3, workers=0)
    assert more.folder == found.folder and more.progress.generation == 3


def test_signals_are_looked_at_and_written(spec: Path) -> None:
    found = gaitsim.analyze(spec, only=True, export="sto", folder="looked")
    assert [path.name for path in found.products.exports] == ["stone.sto"]
    assert found.products.faults == [] and found.products.figures == []
    assert found.replays[0].trajectory["guide.position"][0] == 0.4


def test_a_sound_spec_has_models_and_no_warnings(spec: Path) -> None:
    found = gaitsim.check(spec)
    assert [free.address for free in found.models[0].free] == [HEIGHT]
    assert list(found.warnings) == list(found.convergence) == []


CALLS = [gaitsim.run, gaitsim.check, gaitsim.analyze, gaitsim.optimize]


@pytest.mark.parametrize("call", CALLS, ids=lambda call: call.__name__)
def test_a_mistake_is_an_error_with_its_words(call: Callable[..., object], spec: Path) -> None:
    with pytest.raises(GaitsimError) as raised:
        call(spec, set={"stone.mass": "1 m"})
    assert "stone.mass: m is a unit of length; this needs a mass" in str(raised.value)


def test_what_cannot_be_asked_is_refused(spec: Path) -> None:
    with pytest.raises(Usage, match=r"--candidate 2: .* is a spec; candidates belong to results\."):
        gaitsim.run(spec, candidate="2")
    with pytest.raises(Usage, match="--points 1: a scan has at least 2 values"):
        gaitsim.limit(spec, {HEIGHT: "1 m:2 m"}, points=1)
    with pytest.raises(Usage, match="--force needs --adopt"):
        gaitsim.optimize(spec, force=True)
    with pytest.raises(TypeError, match="plots"):
        gaitsim.analyze(spec, plots="*")
    with pytest.raises(AttributeError, match="module 'gaitsim' has no attribute 'runs'"):
        _ = gaitsim.runs  # type: ignore[attr-defined]
    Path("results").write_text("")
    with pytest.raises(CannotSave, match="results: this is a file"):
        gaitsim.run(spec)


def test_what_comes_back_is_shown_in_a_line(spec: Path) -> None:
    made = gaitsim.run(spec, vary={HEIGHT: ["30 cm", "1 km"]}, save=False)
    hunt = gaitsim.limit(spec, {"simulate.duration": "0.1 s:0.5 s"}, points=3, save=False)
    search = gaitsim.optimize(spec, smoke=True, workers=0)
    shown = [repr(each) for each in (made, made.models[0], hunt, search, gaitsim.check(spec))]
    assert shown[:2] == ["<Runs of stone: 1 stopped, 1 completed; not kept>", "<Model stone: 4 parts, 0 tuned>"]
    assert shown[2].startswith("<LimitRuns: simulate.duration holds up to 0.")
    assert "best score" in shown[3] and str(search.folder) in shown[3]
    assert all(len(each) < 200 for each in shown)


def test_a_doubtful_start_is_logged(spec: Path, caplog: pytest.LogCaptureFixture) -> None:
    guide = "  guide: {use: joint/vertical, parent: world, child: stone.center}\n"
    ground = "  ground: {use: contact/spring_damper, frame: stone.center, stiffness: 1 N/m, damping: 0 N s/m}\n"
    text = STONE.replace(guide, guide + ground)
    spec.write_text(text.replace("{value: 40 cm, tune: [20 cm, 60 cm]}", "-10 cm"), encoding="utf-8")
    made = gaitsim.run(spec, save=False)
    below, over = made.warnings
    assert "ground.height" in below and "landed: this ends the run as it begins" in over
    assert [f"gaitsim: {each}" for each in (*made.notices, *made.warnings)] == caplog.messages


def test_limits_go_on_as_the_command_does(spec: Path) -> None:
    ranges = {"simulate.gravity": "1 m/s^2:100 m/s^2"}
    hunt = gaitsim.limit(spec, ranges, {HEIGHT: "2 m"}, tolerance=0.1, points=3)
    assert hunt.folder is not None
    again = gaitsim.limit(hunt.folder, resume=True)
    assert [limit.last for limit in again.limits] == [limit.last for limit in hunt.limits]
    with pytest.raises(Usage, match="--until begins new limits, and --resume continues old ones"):
        gaitsim.limit(hunt.folder, resume=True, until="way=1")
    with pytest.raises(Usage, match="nothing says what is varied"):
        gaitsim.limit(spec)


def test_results_are_compared_and_exchanged(spec: Path) -> None:
    first, second = (gaitsim.run(spec, {"simulate.duration": time}) for time in ("0.2 s", "0.1 s"))
    assert first.folder is not None and second.folder is not None
    compared = gaitsim.compare(first.folder, second.folder, figures=False)
    assert [(change.where, change.first, change.second) for change in compared.changes] == [
        ("duration", "0.2 s", "0.1 s")
    ]
    assert {pair.name for pair in compared.metrics} >= {"way"} and not compared.products.figures
    file = gaitsim.export_result(second.folder, "second.zip")
    mine = gaitsim.import_result(file, results="others")
    assert mine.folder == Path("others") / second.folder.name
    assert all(copy.same for copy in mine.copies) and "no unknown code" in repr(mine)
    assert gaitsim.load(mine.folder).metrics == dict(second.outcomes[0].metrics)
    with pytest.raises(GaitsimError):
        gaitsim.import_result(file, results="others")


def test_what_is_drawn_of_a_spec_goes_to_the_results(spec: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wanted = {"only": True, "export": "csv"}
    assert gaitsim.analyze(spec, **wanted).products.folder == Path("analysis/stone")
    assert gaitsim.analyze(spec, results="scratch", **wanted).products.folder == Path("scratch/analysis/stone")
    monkeypatch.setenv("GAITSIM_RESULTS", "disk")
    assert gaitsim.analyze(spec, **wanted).products.folder == Path("disk/analysis/stone")
    assert not Path("results").exists()
