"""gaitsim limit: how far numbers can go, on a stone whose fall is known; and the walker's perturbations."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import time
from pathlib import Path

import pytest

from gaitsim.results.bundle import read_bundle
from gaitsim.results.manifest import read_manifest
from gaitsim.results.record import Record
from gaitsim.results.rows import read_rows
from gaitsim.simulation.outcome import Outcome

from .commands import Said, gaitsim

# After n steps of semi-implicit Euler the stone has fallen by g dt^2 n (n + 1) / 2.
STONE = """
gaitsim: 1
parts:
  stone: {use: segment/point_mass, mass: 1 kg}
  guide: {use: joint/vertical, parent: world, child: stone.center}
initial: {guide.position: 2 m}
measures:
  landed: {use: measure/fall, height: {from: guide.position}, below: 0 m}
  way: {use: measure/range, signal: {from: guide.position}}
simulate: {duration: 0.5 s, step: 1 ms}
"""
HEIGHT = "initial.guide.position"


@pytest.fixture
def spec(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "stone.yaml"
    path.write_text(STONE, encoding="utf-8")
    return path


def limits(said: Said) -> list[dict[str, object]]:
    assert said.code == 0, said.err
    return list(json.loads(said.out)["limits"])


def number(text: object) -> float:
    return float(str(text).split()[0])


def fallen(steps: int) -> float:
    return 9.81e-6 * steps * (steps + 1) / 2


def test_known_limits_in_both_directions_at_once(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ranges = [f"{HEIGHT}=2 m:0 m", f"{HEIGHT}=130 cm:120 cm", "simulate.duration=0.1 s:1.1 s"]
    words = [word for text in ranges for word in ("--vary", text)]
    lower, nearer, longer = limits(gaitsim(capsys, "limit", str(spec), *words, "--tolerance", "0.001", "--json"))
    for found, scale, exactly in ((lower, 1, 2e-3), (nearer, 0.01, 1e-4)):
        last, first = scale * number(found["last"]), scale * number(found["first"])
        # Below 0 after 498 steps is told in the 499th and ends the run in the 500th, its last.
        assert first < fallen(498) <= last
        assert last - first <= exactly
    # Below 0 after 639 steps ends runs of 641 and more; a duration is rounded to whole steps.
    assert fallen(638) < 2 < fallen(639)
    assert number(longer["last"]) <= 0.6405 <= number(longer["first"]) <= number(longer["last"]) + 1e-3
    assert str(lower["ending"]).startswith("landed at 0.49")
    assert lower["from"] == "2.0 m" and lower["to"] == "0.0 m"


def test_the_table(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "limit", str(spec), "--vary", f"{HEIGHT}=2 m:1 m", "--points", "3", "--tolerance", "0.25")
    title, row = (" ".join(line.split()) for line in said.out.splitlines())
    assert title == "address from to last that holds first that does not how that ends runs"
    assert row == f"{HEIGHT} 2.0 m 1.0 m 1.25 m 1.0 m landed at 0.453 s 4"
    assert said.err.startswith("saved in results/")


def test_a_range_without_a_limit_is_told(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "limit", str(spec), "--vary", f"{HEIGHT}=2 m:4 m", "--no-save")
    assert said.code == 0
    assert said.out.splitlines()[1].split() == [HEIGHT, "2.0", "m", "4.0", "m", "4.0", "m", "-", "-", "9"]
    assert said.err == f"{HEIGHT}: it holds up to 4.0 m; to find a limit, go further.\n"


def test_what_holds_again_is_told(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # Thrown upwards at v, the stone stays within 0.5 m for 0.5 s if g T - sqrt(g) < v < sqrt(g): 1.77 to 3.13 m/s.
    words = ["--vary", "initial.guide.velocity=0 m/s:6 m/s", "--until", "way=0.5 m", "--points", "7", "--no-save"]
    said = gaitsim(capsys, "limit", str(spec), *words)
    told = "beyond its first limit it holds again at 4.0 m/s, 5.0 m/s, 6.0 m/s; there is no one limit."
    assert said.err == f"initial.guide.velocity: {told}\n"
    (found,) = limits(gaitsim(capsys, "limit", str(spec), *words, "--json"))
    assert found["beyond"] == ["4.0 m/s", "5.0 m/s", "6.0 m/s"]
    assert number(found["last"]) == pytest.approx(1.773, abs=0.06)
    assert number(found["last"]) < number(found["first"]) <= number(found["last"]) + 0.06


@pytest.mark.parametrize(("until", "threshold"), [("way=1 m", 451), ("way=100 cm", 451)])
def test_until_a_metric_comes_to_a_value(
    spec: Path, until: str, threshold: int, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["limit", str(spec), "--vary", "simulate.duration=0.1 s:0.6 s", "--until", until, "--tolerance", "0.002"]
    (found,) = limits(gaitsim(capsys, *words, "--json"))
    assert number(found["last"]) <= 1e-3 * threshold + 1e-3 and number(found["first"]) >= 1e-3 * threshold - 1e-3
    assert str(found["ending"]).startswith("way = 1.00")


def test_every_run_is_saved_and_reproduced(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--vary", f"{HEIGHT}=2 m:1 m", "--vary", "stone.mass=1 kg:3 kg", "--points", "3"]
    said = json.loads(gaitsim(capsys, "limit", str(spec), *words, "--json").out)
    rows = read_rows(Path(said["result"]))
    assert len(rows) == sum(len(found["runs"]) for found in said["limits"])
    assert rows[0]["settings"] == {HEIGHT: "2.0 m"} and rows[1]["settings"] == {"stone.mass": "1.0 kg"}
    verified = gaitsim(capsys, "results", "verify", said["result"])
    assert verified.code == 0
    assert f"{len(rows)} of {len(rows)} runs reproduced bit for bit" in verified.out + verified.err


def test_a_result_can_be_looked_through(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = json.loads(gaitsim(capsys, "run", str(spec), "--json").out)["result"]
    (found,) = limits(gaitsim(capsys, "limit", folder, "--vary", f"{HEIGHT}=2 m:1 m", "--no-save", "--json"))
    assert number(found["last"]) == pytest.approx(1.22, abs=0.01)


PUSHED = """
gaitsim: 1
parts:
  stone: {use: segment/point_mass, mass: 1 kg}
  guide: {use: joint/planar, parent: world, child: stone.center}
  push: {use: perturbation/push, frame: stone.center, strength: 0 N, onset: 0.1 s, duration: 0.1 s}
initial: {guide.z: 2 m}
measures:
  way: {use: measure/range, signal: {from: guide.x}}
simulate: {duration: 0.5 s, step: 1 ms}
"""
EVERY_WAY = ("--vary", "push.strength=0 N:20 N", "--over", "push.azimuth=0 deg:300 deg:6", "--until", "way=10 cm")


def test_limits_over_another_number_are_found_at_each_of_its_values(
    spec: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spec.write_text(PUSHED)
    whole = json.loads(gaitsim(capsys, "limit", str(spec), *EVERY_WAY, "--json").out)
    # Half a pulse passes before the impulse F t: the stone goes F t (T - 0.15 s).
    straight = 0.1 / (0.1 * 0.35)
    for found, azimuth in zip(whole["limits"], range(0, 360, 60), strict=True):
        assert found["over"] == {"push.azimuth": f"{azimuth}.0 deg"}
        exact = straight / abs(math.cos(math.radians(azimuth)))
        assert number(found["last"]) <= exact * 1.001 and number(found["first"]) >= exact * 0.999
    folder = Path(whole["result"])
    first, second = folder / "evaluations.jsonl", folder / "manifest.json"
    first.write_bytes(b"".join(first.read_bytes().splitlines(keepends=True)[:20]))
    second.write_text(second.read_text().replace('"complete"', '"running"'))
    assert json.loads(gaitsim(capsys, "limit", str(folder), "--resume", "--json").out) == whole


def test_the_table_of_limits_over_another_number(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--vary", f"{HEIGHT}=2 m:4 m", "--over", "simulate.duration=0.1 s,0.2 s", "--points", "2", "--no-save"]
    said = gaitsim(capsys, "limit", str(spec), *words)
    title, row, _ = (" ".join(line.split()) for line in said.out.splitlines())
    assert title.startswith("simulate.duration address from to last that holds")
    assert row == f"0.1 s {HEIGHT} 2.0 m 4.0 m 4.0 m - - 2"
    assert f"{HEIGHT} at simulate.duration = 0.2 s: it holds up to 4.0 m; to find a limit, go further." in said.err


RANGES = ("--vary", f"{HEIGHT}=2 m:0 m", "--vary", "simulate.duration=0.1 s:1.1 s")


def test_limits_that_were_killed_go_on_where_they_were(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    whole = json.loads(gaitsim(capsys, "limit", str(spec), *RANGES, "--json").out)
    folder = Path(whole["result"])
    journal, manifest = folder / "evaluations.jsonl", folder / "manifest.json"
    complete, lines = journal.read_bytes(), journal.read_bytes().splitlines(keepends=True)
    for kept in (b"".join(lines[:1]), b"".join(lines[:7]), b"".join(lines[:7]) + lines[7][:40], complete):
        journal.write_bytes(kept)
        manifest.write_text(manifest.read_text().replace('"complete"', '"running"'))
        said = gaitsim(capsys, "limit", str(folder), "--resume", "--json")
        assert json.loads(said.out) == whole
        assert f"resuming {folder}: {kept.count(bytes([10]))} runs are in it" in said.err
        assert (journal.read_bytes(), json.loads(manifest.read_text())["status"]) == (complete, "complete")


def test_limits_are_kept_run_by_run(
    spec: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    add, seen = Record.add, []

    def counted(record: Record, settings: dict[str, str], outcome: Outcome) -> None:
        add(record, settings, outcome)
        seen.append(len(read_rows(next(Path("results").iterdir()))))
        if len(seen) == 5:
            raise KeyboardInterrupt

    monkeypatch.setattr(Record, "add", counted)
    said = gaitsim(capsys, "limit", str(spec), *RANGES)
    (folder,) = Path("results").iterdir()
    assert (said.code, seen) == (130, [1, 2, 3, 4, 5])
    assert f"interrupted; to continue: gaitsim limit {folder} --resume" in said.err
    assert json.loads((folder / "manifest.json").read_text())["status"] == "interrupted"


@pytest.mark.slow
def test_a_real_kill_loses_no_run_that_was_kept(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec.write_text(STONE.replace("step: 1 ms", "step: 5 us").replace("duration: 0.5 s", "duration: 4 s"))
    words = ("limit", str(spec), "--vary", "stone.mass=1 kg:3 kg", "--until", "way=1 km", "--points", "40")
    whole = json.loads(gaitsim(capsys, *words, "--json").out)
    process = subprocess.Popen([sys.executable, "-m", "gaitsim.cli.main", *words, "--results", "killed"])
    rows: list[Path] = []
    while not rows or rows[0].read_bytes().count(b"\n") < 5:
        assert process.poll() is None
        time.sleep(0.02)
        rows = list(Path("killed").glob("*[!.partial]/evaluations.jsonl"))
    process.kill()
    process.wait()
    before = rows[0].read_bytes()
    said = gaitsim(capsys, "limit", str(rows[0].parent), "--resume", "--json")
    assert rows[0].read_bytes().startswith(before)
    assert rows[0].read_bytes() == Path(whole["result"], "evaluations.jsonl").read_bytes()
    assert json.loads(said.out)["limits"] == whole["limits"]


def test_a_start_beyond_reason_is_refused(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ground = "ground: {use: contact/spring_damper, frame: stone.center, stiffness: 1 MN/m, damping: 1 kN s/m}"
    spec.write_text(STONE.replace("  guide:", f"  {ground}\n  guide:").replace("position: 2 m", "position: -1 m"))
    said = gaitsim(capsys, "limit", str(spec), "--vary", "stone.mass=1 kg:2 kg")
    assert (said.code, said.out) == (3, "")
    assert "possible is" in said.err
    assert not Path("results").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            (),
            "nothing says what is varied; add a range, such as --vary push.strength='0 N:1000 N', or --resume a "
            "result.",
        ),
        (
            ("--resume",),
            "--resume: stone.yaml is a spec; name the result folder of the limits, such as "
            "results/2026-11-22-walking-3f9c.",
        ),
        (("--resume", "--points", "3"), "--points begins new limits, and --resume continues old ones; leave one out."),
        (("--resume", "--no-save"), "--no-save begins new limits, and --resume continues old ones; leave one out."),
    ],
)
def test_what_is_no_beginning_and_no_going_on(
    spec: Path, words: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    said = gaitsim(capsys, "limit", spec.name, *words)
    assert (said.code, said.err.strip()) == (2, message)


def test_a_run_or_an_edited_result_is_not_resumed(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = json.loads(gaitsim(capsys, "run", str(spec), "--json").out)["result"]
    said = gaitsim(capsys, "limit", run, "--resume")
    assert said.err.strip() == f"{run}: this is not a result of gaitsim limit, so there is nothing to resume."
    folder = Path(json.loads(gaitsim(capsys, "limit", str(spec), *FINE, "--json").out)["result"])
    path = folder / "manifest.json"
    before = path.read_text()
    for old, new in (('"points": 9', '"points": "9"'), ('"points": 9', '"points": 1'), ("=1 kg:2", "=1 kg:")):
        path.write_text(before.replace(old, new))
        said = gaitsim(capsys, "limit", str(folder), "--resume")
        rule = "what it says about its limits cannot be read, so it was edited; restore it from a copy."
        assert (said.code, said.err.strip()) == (3, f"{path}: {rule}")


FINE = ("--vary", "stone.mass=1 kg:2 kg")


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (
            ("--vary", f"{HEIGHT}=-1 m:1 m"),
            4,
            f"--vary {HEIGHT}=-1.0 m:1.0 m: the run fails at the first end, -1.0 m (landed at 0.001 s); "
            "start the range at a value with which it succeeds.",
        ),
        (
            ("--vary", "stone.mass=1 kg"),
            2,
            "--vary stone.mass=1 kg: this is from:to, two values that differ, such as push.strength=0 N:200 N.",
        ),
        (
            ("--vary", "stone.mass=1 kg:2 kg:3"),
            2,
            "--vary stone.mass=1 kg:2 kg:3: this is from:to, two values that differ, such as push.strength=0 N:200 N.",
        ),
        (
            ("--vary", "stone.mass=1 kg:1000 g"),
            2,
            "--vary stone.mass=1 kg:1000 g: this is from:to, two values that differ, such as push.strength=0 N:200 N.",
        ),
        (
            ("--vary", "stone.mass=1 kg:2 s"),
            2,
            "--vary stone.mass=1 kg:2 s: both ends need the same unit, such as 1 ms:5 ms:3.",
        ),
        (
            ("--vary", "stone.mas=1 kg:2 kg"),
            3,
            "--vary stone.mas=1.0 kg: stone: segment/point_mass has no mas. Did you mean mass?",
        ),
        (
            (*FINE, "--until", "wag=3"),
            2,
            "--until wag=3: wag is not a metric of this spec. Did you mean way?",
        ),
        (
            (*FINE, "--until", "way=3"),
            2,
            '--until way=3: 3 has no unit; this needs a length, such as "45 cm" (write "3 m").',
        ),
        (
            (*FINE, "--until", "way=far"),
            2,
            '--until way=far: "far" is not a number; this needs a length, such as "45 cm".',
        ),
        (
            (*FINE, "--set", "landed=null"),
            2,
            "no measure of this spec ends a run; say what does: --until METRIC=VALUE, "
            "or add one such as use: measure/fall.",
        ),
        (
            (*FINE, "--over", "stone.mass=1 kg,2 kg"),
            2,
            "--over stone.mass=1 kg,2 kg: stone.mass is varied already; name what its limit is found over, such as "
            "push.azimuth.",
        ),
        (
            (*FINE, "--over", f"{HEIGHT}=1 m:2 m"),
            2,
            f"--over {HEIGHT}=1 m:2 m: a range is low:high:count, such as gain=1:15:20.",
        ),
        (
            (*FINE, "--over", f"{HEIGHT}=1 m:2 s:3"),
            2,
            f"--over {HEIGHT}=1 m:2 s:3: both ends need the same unit, such as 1 ms:5 ms:3.",
        ),
        (
            (*FINE, "--over", "stone.azimuth=0 deg,30 deg"),
            3,
            "--over stone.azimuth=0 deg: stone: segment/point_mass has no azimuth. Known here: mass, radius.",
        ),
        (
            ("--vary", f"{HEIGHT}=2 m:1 m", "--over", "simulate.duration=0.5 s,1 s"),
            4,
            f"--vary {HEIGHT}=2.0 m:1.0 m at simulate.duration = 1 s: the run fails at the first end, 2.0 m "
            "(landed at 0.64 s); start the range at a value with which it succeeds.",
        ),
        ((*FINE, "--points", "1"), 2, "--points 1: a scan has at least 2 values, the two ends."),
        (
            (*FINE, "--tolerance", "0"),
            2,
            "--tolerance 0: this is a part of the range, from 1e-06 to 1, such as 0.01.",
        ),
        ((*FINE, "--from", "tuned"), 2, "--from tuned: there is no stone.tuned.yaml; make it with optimize --adopt."),
        (
            (*FINE, "--set", "study=[{stone.mass: 1 kg}, {stone.mass: 2 kg}]"),
            2,
            "stone.yaml is a study of 2 runs; take one with --candidate, or drop it: --set study=null.",
        ),
    ],
)
def test_what_is_refused(
    spec: Path, words: tuple[str, ...], code: int, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    said = gaitsim(capsys, "limit", spec.name, *words)
    lines = [line for line in said.err.splitlines() if not line.startswith(("warning: ", "    "))]
    assert (said.code, lines[0], said.out) == (code, message, "")
    kept = [read_manifest(folder)["status"] for folder in Path("results").glob("*")]
    assert kept == (["complete"] if code == 4 else [])  # the first run is kept, although it ends badly


def test_a_variant_starts_at_the_tuned_values_of_its_parent(spec: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec.write_text(STONE.replace("mass: 1 kg", "mass: {value: 1 kg, tune: [0.5 kg, 5 kg]}"), encoding="utf-8")
    Path("stone.tuned.yaml").write_text("result: results/a\nvalues: {stone.mass: 3 kg}\n", encoding="utf-8")
    Path("high.yaml").write_text("gaitsim: 1\nextends: stone.yaml\ninitial: {guide.position: 3 m}\n", encoding="utf-8")
    said = gaitsim(capsys, "limit", "high.yaml", "--vary", f"{HEIGHT}=3 m:1 m", "--json")
    assert "tuned values from stone.tuned.yaml (results/a); --start ignores them" in said.err
    assert read_bundle(Path(json.loads(said.out)["result"]), "high").starts() == {"stone.mass": 3}
    assert "tuned" not in gaitsim(capsys, "run", "high.yaml", "--no-save", "--start").err


@pytest.mark.parametrize("changed", ["{value: 2 kg, tune: [0.5 kg, 5 kg]}", "{value: 1 kg, tune: [0.5 kg, 4 kg]}"])
def test_a_variant_that_tunes_otherwise_starts_anew(
    spec: Path, changed: str, capsys: pytest.CaptureFixture[str]
) -> None:
    spec.write_text(STONE.replace("mass: 1 kg", "mass: {value: 1 kg, tune: [0.5 kg, 5 kg]}"), encoding="utf-8")
    Path("stone.tuned.yaml").write_text("result: results/a\nvalues: {stone.mass: 3 kg}\n", encoding="utf-8")
    Path("other.yaml").write_text(
        f"gaitsim: 1\nextends: stone.yaml\nparts: {{stone: {{mass: {changed}}}}}\n", encoding="utf-8"
    )
    assert "tuned" not in gaitsim(capsys, "run", "other.yaml", "--no-save").err
