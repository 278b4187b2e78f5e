"""gaitsim analyze: what it makes of results and specs, and what it says where something cannot be made."""

from __future__ import annotations

import csv
import errno
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from optimization.searches import signed

import gaitsim
from gaitsim.errors import GaitsimError
from gaitsim.exchange import rows
from gaitsim.results.bundle import read_bundle

from .commands import Said
from .commands import gaitsim as command

SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
  brake:
    use: controller/brake
    damping: {value: 0.2 N m s/rad, tune: [0 N m s/rad, 5 N m s/rad]}
    angle: {from: pivot.angle}
    velocity: {from: pivot.velocity}
    to: pivot.torque
  energy: {use: sensor/mechanical_energy}
initial: {pivot.angle: 30 deg}
measures:
  swing: {use: measure/range, signal: {from: pivot.angle}}
objective: {use: objective/minimize, value: {from: swing}}
simulate: {duration: 6 s, step: 1 ms}
optimize: {population: 4, generations: 2, seed: 1}
"""
BRAKE = '''\
from gaitsim.component import Component, Input, Output, Parameter


class Brake(Component):
    """Damps, and breaks below a limit."""

    damping = Parameter("N m s/rad", "Torque per velocity.", bounds=(0, 10))
    limit = Parameter("rad", "Below this angle it breaks.", default=-100)
    angle = Input("rad", "An angle.")
    velocity = Input("rad/s", "Its velocity.")
    torque = Output("N m", "Torque against the velocity.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = -p.damping * u.velocity
        if u.angle < p.limit:
            raise ValueError("it broke")
'''
Run = Callable[..., Said]


@pytest.fixture(autouse=True)
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    (tmp_path / "components/controller").mkdir(parents=True)
    (tmp_path / "components/controller/brake.py").write_text(BRAKE)
    (tmp_path / "spec.yaml").write_text(SPEC)
    return tmp_path


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """One command; of analyze without a video, whose pictures have their own tests."""

    def ran(*words: str) -> Said:
        said = command(capsys, *words)
        assert "Traceback" not in said.err, said.err
        return said

    return ran


@pytest.fixture
def tuned(run: Run) -> Path:
    """The result of a search of nine evaluations."""
    assert run("optimize", "spec.yaml", "--workers", "0").code == 0
    (folder,) = Path("results").iterdir()
    return folder


@pytest.fixture
def swung(run: Run) -> Path:
    """The result of a run."""
    assert run("run", "spec.yaml").code == 0
    (folder,) = Path("results").iterdir()
    return folder


def files(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.slow
def test_a_result_gets_figures_and_a_report_and_still_verifies(tuned: Path, run: Run) -> None:
    before = files(tuned)
    said = run("analyze", str(tuned), "--no-video", "--json")
    data = json.loads(said.out)
    assert said.code == 0
    expected = {"measures", "gait", "norms", "figures", "video", "report", "exports", "notices", "status", "score"}
    assert expected <= {*data}
    assert (data["status"], data["video"], data["exports"]) == ("completed", None, [])
    assert data["report"] == str(tuned / "report.html")
    made = files(tuned) - before
    assert made == {"report.html", *(f"figures/{Path(path).name}" for path in data["figures"])}
    assert len(data["figures"]) >= 4
    best = min((json.loads(line) for line in (tuned / "evaluations.jsonl").open()), key=lambda line: line["score"])
    assert (data["score"], data["measures"]) == (best["score"], best["metrics"])
    verified = run("results", "verify", str(tuned))
    assert (verified.code, verified.out) == (0, f"{tuned}: 9 of 9 runs reproduced bit for bit\n")
    assert run("results", "list").out.count("results/") == 1
    assert run("optimize", str(tuned), "--resume", "--workers", "0", "--generations", "3").code == 0


def test_measures_and_files_are_the_data_and_words_are_talk(swung: Path, run: Run) -> None:
    said = run("analyze", str(swung), "--only", "--plot", "pivot.angle", "--export", "csv")
    *table, figures, export = said.out.splitlines()
    assert table[0].split() == ["measure", "value", "unit"]
    assert table[1].split()[0::2] == ["swing", "rad"]
    assert figures == f"1 figure in {swung / 'figures'}"
    assert export == str(swung / "exports" / f"{swung.name}.csv")
    assert (said.code, said.err) == (0, "")


def test_a_spec_goes_below_analysis(run: Run) -> None:
    said = run("analyze", "spec.yaml", "--only", "--plot", "*", "--format", "svg", "--format", "pdf")
    assert said.code == 0
    assert files(Path("analysis")) == {"spec/figures/all.svg", "spec/figures/all.pdf"}
    assert not Path("results").exists()


def test_exports_have_the_same_numbers(swung: Path, run: Run) -> None:
    window = ("--from-time", "1 s", "--to-time", "1500 ms", "--every", "2 ms")
    words = ("--export", "sto", "--export", "csv", "--export", "nc", *window)
    data = json.loads(run("analyze", str(swung), "--only", *words, "--folder", "out", "--json").out)
    sto, comma, net = (Path(path) for path in data["exports"])
    lines = sto.read_text().splitlines()
    begin = lines.index("endheader") + 1
    mine = np.array([[float(cell) for cell in line.split("\t")] for line in lines[begin + 1 :]])
    with comma.open() as file:
        head, *cells = list(csv.reader(file))
    assert head[:3] == ["time [s]", "pivot.angle [rad]", "pivot.velocity [rad/s]"]
    assert np.array(cells, dtype=float).tobytes() == mine.tobytes()
    assert mine.shape == (251, len(head))
    assert (mine[0, 0], mine[-1, 0]) == (1.0, 1.5)
    import xarray

    with xarray.open_dataset(net, engine="h5netcdf") as signals:
        assert signals["pivot.angle"].to_numpy().tobytes() == mine[:, 1].tobytes()
        assert signals["pivot.angle"].attrs["units"] == "rad"
    whole = gaitsim.load(swung).trajectory()["pivot.angle"].sel(time=slice(1, 1.5))[::2]
    assert whole.to_numpy().tobytes() == mine[:, 1].tobytes()


@pytest.mark.slow
def test_candidates_of_one_result_are_overlaid(tuned: Path, run: Run) -> None:
    words = ("--candidate", "best", "--candidate", "0:0", "--plot", "pivot.angle", "--no-video")
    said = run("analyze", str(tuned), *words, "--json")
    data = json.loads(said.out)
    assert said.code == 0
    assert [one["label"] for one in data["results"]] == [f"{tuned.name} best", f"{tuned.name} 0:0"]
    assert data["report"] == str(tuned / "comparison" / "report.html")
    names = {Path(path).stem for path in data["figures"]}
    assert {"pivot.angle", "motion", "control"} <= names
    assert any(name.startswith(f"{tuned.name}_0_0.") for name in names)
    assert said.err.splitlines()[1] == f"candidate 0:0 of {tuned}"


def test_the_runs_of_a_study(run: Run) -> None:
    run("run", "spec.yaml", "--vary", "brake.damping=0 N m s/rad,2 N m s/rad,1 N m s/rad")
    (folder,) = Path("results").iterdir()
    said = run("analyze", str(folder), "--only", "--plot", "pivot.angle", "--json")
    assert said.err == f"run 2 of 3 of {folder}: brake.damping = 2 N m s/rad\n"
    recorded = [json.loads(line) for line in (folder / "evaluations.jsonl").open()]
    assert json.loads(said.out)["measures"] == recorded[1]["metrics"]
    third = run("analyze", str(folder), "--only", "--plot", "pivot.angle", "--candidate", "3", "--json")
    assert json.loads(third.out)["measures"] == recorded[2]["metrics"]
    refused = run("analyze", str(folder), "--candidate", "4")
    rule = f"{folder} has the runs 1 to 3; write best, or the number of one."
    assert (refused.code, refused.err) == (2, f"--candidate 4: {rule}\n")


def test_a_word_that_names_nothing_costs_only_its_own_figure(swung: Path, run: Run) -> None:
    words = ("--plot", "pivot.angel", "--plot", "pivot.angle", "--plot", "knee*", "--return-map", "swing")
    said = run("analyze", str(swung), "--only", *words, "--json")
    data = json.loads(said.out)
    assert said.code == 2
    assert said.err.splitlines() == [
        "pivot.angel: there is no such signal; the nearest are pivot.angle, pivot.velocity, pivot.torque.",
        "knee*: no signal of spec matches this; signals are such as "
        "pivot.angle, pivot.velocity, brake.torque, energy.potential, energy.kinetic.",
    ]
    assert [Path(path).name for path in data["figures"]] == ["pivot.angle.png", "swing.return_map.png"]
    assert [fault["message"] for fault in data["errors"]] == said.err.splitlines()


def test_a_run_that_breaks_is_looked_at_up_to_there(run: Run) -> None:
    words = ("--set", "brake.limit=-20 deg", "--only", "--plot", "pivot.angle")
    said = run("analyze", "spec.yaml", *words, "--json")
    data = json.loads(said.out)
    assert (said.code, data["status"], len(data["figures"])) == (0, "failed", 1)
    assert said.err == f"spec: failed: {data['reason']}\n"
    assert data["reason"].startswith("brake (controller/brake) raised in output at 0.6")


def test_a_run_that_breaks_at_once(run: Run) -> None:
    said = run("analyze", "spec.yaml", "--set", "brake.limit=40 deg", "--json")
    assert said.code == 4
    assert said.err.startswith("spec: nothing to analyze; the run failed: brake (controller/brake) raised in ")
    assert json.loads(said.out)["status"] == "failed"


@pytest.mark.parametrize(
    ("words", "filmed"),
    [
        ((), True),
        (("--no-video",), False),
        (("--only",), False),
        (("--only", "--video"), True),
        (("--only", "--gif"), True),
    ],
)
def test_when_there_is_a_film(
    words: tuple[str, ...], filmed: bool, swung: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    from gaitsim.animation import video

    films: list[Path] = []
    monkeypatch.setattr(video, "record", lambda *said, **_: films.append(said[1]) or said[1])
    run("analyze", str(swung), "--plot", "pivot.angle", *words)
    assert bool(films) == filmed


def test_a_machine_without_opengl(swung: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    from gaitsim.animation import NoOpenGL, video

    def nothing(*_: Any, **__: Any) -> Path:
        raise NoOpenGL("no video: install the system package libosmesa6.")

    monkeypatch.setattr(video, "record", nothing)
    said = run("analyze", str(swung), "--json")
    data = json.loads(said.out)
    assert said.code == 0
    assert "no video: install the system package libosmesa6." in said.err.splitlines()
    assert (data["video"], len(data["figures"]) > 1, Path(data["report"]).is_file()) == (None, True, True)
    assert "no video: install the system package libosmesa6." in data["notices"]
    assert "libosmesa6" in Path(data["report"]).read_text(encoding="utf-8")


def test_a_full_disk_is_said_and_the_rest_is_made(swung: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(rows, "_write_rows", full)
    said = run("analyze", str(swung), "--only", "--export", "sto", "--export", "nc", "--plot", "pivot.angle", "--json")
    data = json.loads(said.out)
    rule = f"the export {swung.name}.sto cannot be written (No space left on device); free some space."
    assert (said.code, said.err) == (3, f"{swung}: {rule}\n")
    assert [Path(path).suffix for path in [*data["figures"], *data["exports"]]] == [".png", ".nc"]
    assert not list(swung.rglob("*.partial"))


def test_a_folder_that_cannot_be(swung: Path, run: Run) -> None:
    said = run("analyze", str(swung), "--folder", "spec.yaml/here")
    rule = "nothing can be written here (Not a directory); choose another --folder."
    assert (said.code, said.err) == (3, f"spec.yaml/here: {rule}\n")


def test_a_result_of_another_version_goes_on_with_a_word(swung: Path, run: Run) -> None:
    path = swung / "manifest.json"
    path.write_text(path.read_text().replace(f'"gaitsim": "{gaitsim.__version__}"', '"gaitsim": "0.0.1"'))
    said = run("analyze", str(swung), "--only", "--plot", "pivot.angle")
    change = f"gaitsim 0.0.1 -> {gaitsim.__version__}"
    assert (said.code, said.err) == (0, f"{swung} was made with other versions ({change})\n")


def test_a_record_that_the_replay_does_not_give(swung: Path, run: Run) -> None:
    path = swung / "evaluations.jsonl"
    row = json.loads(path.read_text())
    path.write_text(json.dumps(row | {"steps": 5}) + "\n")
    said = run("analyze", str(swung), "--only", "--plot", "pivot.angle")
    assert (said.code, said.err) == (0, f"the replay of {swung} differs from its record: steps: 5 -> 6000\n")
    assert run("analyze", str(swung), "--only", "--set", "simulate.duration=1 s", "--plot", "pivot.angle").err == ""


def test_a_search_that_has_not_ended(tuned: Path, run: Run) -> None:
    path = tuned / "manifest.json"
    path.write_text(path.read_text().replace('"status": "complete"', '"status": "interrupted"'))
    said = run("analyze", str(tuned), "--only", "--plot", "pivot.angle")
    assert said.code == 0
    assert said.err.splitlines()[1] == f"{tuned} is not complete: its search is interrupted"


def test_a_candidate_that_a_search_had_to_end(tuned: Path, run: Run) -> None:
    path = tuned / "evaluations.jsonl"
    first, *rest = path.read_text().splitlines(keepends=True)
    ended = signed(first, status="timeout", reason="no answer in 5 s", score=None, metrics={})
    path.write_text("".join([ended, *rest]))
    said = run("analyze", str(tuned), "--only", "--plot", "pivot.angle", "--candidate", "0:0")
    rule = "which the search had to end (no answer in 5 s); Ctrl-C ends it here"
    assert (said.code, said.err) == (0, f"candidate 0:0 of {tuned}, {rule}\n")


def damaged(folder: Path) -> None:
    (folder / "spec.yaml").write_text("gaitsim: 1\n")


def without_manifest(folder: Path) -> None:
    (folder / "manifest.json").unlink()


def strange(folder: Path) -> None:
    component = folder / "components/controller/brake.py"
    component.write_text(component.read_text() + "# a word more\n")
    manifest = json.loads((folder / "manifest.json").read_text())
    manifest["digest"] = read_bundle(folder, manifest["name"]).digest
    (folder / "manifest.json").write_text(json.dumps(manifest))


BAD = {
    damaged: "{0}: spec.yaml was edited after it was made, so it would not re-run as it was; "
    "restore them, or copy the folder's spec.yaml and run that.",
    without_manifest: "{0}: there is no manifest.json, so this is not a result, or one that was never finished being "
    "made; name another, or see: gaitsim results list",
    strange: "{0}: running it would run code that this machine does not know: {0}/components/controller/brake.py; "
    "read these files, then use --trust.",
    shutil.rmtree: "{0}: there is no such result. See: gaitsim results list",
}


@pytest.mark.parametrize("harm", BAD, ids=lambda harm: harm.__name__)
def test_results_that_are_none(harm: Callable[[Path], None], swung: Path, run: Run) -> None:
    harm(swung)
    said = run("analyze", str(swung), "--only", "--plot", "pivot.angle")
    assert (said.code, said.err) == (3, BAD[harm].format(swung) + "\n")
    beside = run("analyze", "spec.yaml", str(swung), "--only", "--plot", "pivot.angle", "--json")
    assert (beside.code, beside.err) == (3, BAD[harm].format(swung) + "\n")
    assert len(json.loads(beside.out)["figures"]) == 1
    if harm is strange:
        assert run("analyze", str(swung), "--trust", "--only", "--plot", "pivot.angle").code == 0
        with pytest.raises(GaitsimError, match="code that this machine does not know"):
            gaitsim.load(swung).trajectory()
        assert gaitsim.load(swung, trust=True).trajectory().sizes == {"time": 6000}
    else:
        with pytest.raises(GaitsimError):
            gaitsim.load(swung)


USAGE = {
    ("--against", "pivot.angle"): "--against pivot.angle: name what is drawn against it, such as --plot '*.force'.",
    ("--from-time", "2 kg"): "--from-time 2 kg: write a time, such as '2 s' or '300 ms'.",
    ("--every", "50 %"): "--every 50 %: write a time, such as '2 s' or '300 ms'.",
    ("--from-time", "0,5 s"): (
        '--from-time 0,5 s: "0,5 s" is not a quantity here: numbers have a point, no comma; write "0.5 s".'
    ),
    ("--every", "soon"): "--every soon: write a time, such as '2 s' or '300 ms'.",
    ("--to-time", "late"): "--to-time late: write a time, such as '2 s' or '300 ms'.",
    ("--from-time", "9"): "spec: nothing to analyze from 9 s; the run goes from 0 s to 5.999 s.",
    ("--candidate", "2"): "--candidate 2: spec.yaml is a spec; candidates belong to results.",
}


@pytest.mark.parametrize("words", USAGE)
def test_what_does_not_fit(words: tuple[str, ...], run: Run) -> None:
    said = run("analyze", "spec.yaml", "--only", *words)
    assert (said.code, said.out, said.err) == (2, "", USAGE[words] + "\n")
