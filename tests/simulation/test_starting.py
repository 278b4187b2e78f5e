"""How a run starts: what is unusual is warned of, what cannot be meant is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.cli.main import main
from gaitsim.simulation.run import Simulator
from gaitsim.simulation.starting import StartFindings, start_findings
from gaitsim.spec.study import variants
from gaitsim.study.opening import Opening
from simulation.models import ROOT, SPECS, model, written

MOVE = "change initial:, or the numbers of this part."


def findings(spec: str, *settings: tuple[str, str]) -> StartFindings:
    return start_findings(Simulator(model(ROOT / "specs" / f"{spec}.yaml", settings)))


@pytest.mark.parametrize("spec", SPECS, ids=lambda path: path.stem)
def test_no_shipped_spec_starts_unusually(spec: Path) -> None:
    opened = Opening(spec).open()
    # In normal mode, which needs no native code of each spec; both modes agree (test_modes_agree.py).
    simulator = Simulator(opened.model(variants(opened.document, [])[0].document), "normal")
    assert start_findings(simulator) == StartFindings()


@pytest.mark.parametrize(
    ("spec", "setting", "value", "address", "said"),
    [
        (
            "walking_geyer2010",
            "initial.leg_l.knee.angle",
            "190 deg",
            "leg_l.knee.angle",
            "190 deg, usual is 180.7 deg (upper + 0.1) at most",
        ),
        (
            "hopping_leg_mass",
            "extensor.tendon_slack_length",
            "60 cm",
            "extensor.path_length",
            "0.4881 m, usual is 0.63 m (tendon_slack_length + 0.3 * optimal_fiber_length) at least",
        ),
        (
            "hopping_geyer2003",
            "extensor.tendon_slack_length",
            "30 cm",
            "extensor.normalized_fiber_length",
            "1.625, usual is 1.6 at most",
        ),
        ("pendulum_pid", "initial.pivot.angle", "400 deg", "pivot.angle", "400 deg, usual is 361 deg at most"),
    ],
)
def test_what_is_unusual_is_warned_of(spec: str, setting: str, value: str, address: str, said: str) -> None:
    found = findings(spec, (setting, value))
    assert found.impossible == ()
    (fault,) = found.unusual
    assert (fault.address, fault.message) == (address, f"at the start this is {said}; {MOVE}")


@pytest.mark.parametrize(
    ("spec", "setting", "value", "expected"),
    [
        (
            "walking_geyer2010",
            "initial.leg_l.knee.angle",
            "40 rad",
            {
                "leg_l.knee.angle": "2292 deg, usual is 180.7 deg (upper + 0.1) at most, "
                "possible is 265 deg (upper + pi / 2) at most",
                "leg_l.knee.stop_energy": "1.173e+04 J, usual is 5 J at most, possible is 1000 J at most",
            },
        ),
        (
            "hopping_leg_mass",
            "extensor.tendon_slack_length",
            "10 cm",
            {
                "extensor.normalized_force": "23.06, usual is 1.5 at most, possible is 10 at most",
                "extensor.normalized_fiber_length": "3.689, usual is 1.6 at most, possible is 2.5 at most",
            },
        ),
    ],
)
def test_what_is_beyond_reason_is_refused(spec: str, setting: str, value: str, expected: dict[str, str]) -> None:
    found = findings(spec, (setting, value))
    told = {fault.address: fault.message for fault in found.impossible}
    assert told == {address: f"at the start this is {said}; {MOVE}" for address, said in expected.items()}


@pytest.mark.parametrize(
    ("spec", "address", "value", "said", "move"),
    [
        (
            "hopping_leg_mass",
            "guide.position",
            "0.4 m",
            "ground.height: at the start this is -0.4305 m",
            "raise guide.position in initial: by 0.4305 m to 0.8305 m.",
        ),
        (
            "walking_scone_h0918",
            "root.z",
            "0.4 m",
            "leg_r.heel.height: at the start this is ",
            "or remove it, so that root starts on the ground; with load: 1, root starts where the ground carries the "
            "body weight.",
        ),
    ],
)
def test_feet_in_the_ground_are_told_once_with_the_coordinate_to_raise(
    spec: str, address: str, value: str, said: str, move: str
) -> None:
    found = findings(spec, (f"initial.{address}", value))
    (fault,) = found.impossible
    assert found.unusual == ()
    assert f"{fault.address}: {fault.message}".startswith(said)
    assert fault.message.endswith(move)


def test_the_height_that_is_told_puts_the_feet_on_the_ground() -> None:
    (fault,) = findings("hopping_leg_mass", ("initial.guide.position", "0.4 m")).impossible
    told = fault.message.rpartition(" to ")[2].removesuffix(".")
    assert findings("hopping_leg_mass", ("initial.guide.position", told)) == StartFindings()


def test_a_start_that_is_a_fall_already_is_warned_of() -> None:
    found = findings("walking_geyer2010", ("initial.root.pitch", "80 deg"))
    assert found.impossible == ()
    (fault,) = (fault for fault in found.unusual if fault.address == "fall_time")
    assert fault.message == "this ends the run as it begins; change initial:, or the numbers of this part."


PULSE = """gaitsim: 1
parts:
  rod: {{use: segment/rod, mass: 2 kg, length: 1 m}}
  pivot: {{use: joint/hinge, parent: world, child: rod.proximal}}
  clock: {{use: controller/clock}}
  push: {{use: perturbation/torque, strength: 1 N m, to: pivot.torque, {numbers}}}
simulate: {{duration: 0.1 s, step: 1 ms}}
"""


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ("onset: 0 s, duration: 10 ms", ""),
        (
            "onset: 0.1 s, duration: 10 ms",
            "push.onset: the pulse begins at 0.1 s and the run ends at 0.1 s, so it never acts; write an earlier onset "
            "or a longer simulate.duration.",
        ),
        (
            "onset: 0 s, duration: 0 s",
            "push.duration: the pulse takes 0 s, so it never acts; write a longer one, such as 100 ms.",
        ),
        (
            "onset: 0 s, duration: 10 ms, event_number: 2",
            "push.event_number: the pulse follows event 2, but event is connected to nothing, so it never acts; write "
            "event: {from: part.output}, or remove event_number.",
        ),
        ("onset: 9 s, duration: 10 ms, event_number: 2, event: {from: clock.signal}", ""),
    ],
)
def test_a_pulse_that_never_acts_is_warned_of(numbers: str, said: str) -> None:
    found = start_findings(Simulator(written(PULSE.format(numbers=numbers)), "normal"))
    assert [f"{fault.address}: {fault.message}" for fault in found.unusual] == ([said] if said else [])


def test_a_component_gets_the_check_by_declaring() -> None:
    text = """
parts:
  rod: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot:
    {use: joint/limited_hinge, parent: world, child: rod.proximal, lower: -10 deg, upper: 20 deg, stiffness: 1 N m/rad}
  relay: {use: controller/ranged, signal: {from: pivot.angle}, highest: 0.2, to: pivot.torque}
initial: {pivot.angle: 30 deg}
simulate: {duration: 0.1 s, step: 1 ms}
"""
    found = start_findings(Simulator(written(f"gaitsim: 1{text}")))
    assert [f"{fault.address}: {fault.message}" for fault in found.unusual] == [
        f"pivot.angle: at the start this is 30 deg, usual is 25.73 deg (upper + 0.1) at most; {MOVE}",
        f"relay.signal: at the start this is 30 deg, usual is 11.46 deg (highest) at most; {MOVE}",
    ]


@pytest.mark.parametrize("command", ["check", "run", "optimize"])
@pytest.mark.parametrize("wrong", [False, True])
def test_each_command_says_it(
    command: str, wrong: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = ROOT / "specs" / "hopping_leg_mass.yaml"
    setting = f"extensor.tendon_slack_length={'10 cm' if wrong else '{value: 60 cm, tune: [38 cm, 62 cm]}'}"
    words = [command, str(spec), "--set", setting, "--set", "simulate.duration=10 ms"]
    words += ["--smoke", "--workers", "0"] if command == "optimize" else []
    words += ["--start", "--no-save"] if command == "run" else []
    with pytest.raises(SystemExit) as ended:
        main(words)
    err = capsys.readouterr().err
    assert (ended.value.code == 3) is wrong
    said = "extensor.normalized_force: at the start this is 23.06" if wrong else "extensor.path_length: at the start"
    assert said in err
    assert ("warning: " in err) is not wrong


EPISODES = """gaitsim: 1
extends: hopping_leg_mass.yaml
optimize: {episodes: [{knee_angle: 40 deg}, {knee_angle: 40 rad}]}
"""


@pytest.mark.parametrize(
    "words",
    [
        ("analyze", "hopping_leg_mass.yaml", "--set", "initial.knee.angle=40 rad", "--only"),
        (
            "limit",
            "hopping_leg_mass.yaml",
            "--set",
            "initial.knee.angle=40 rad",
            "--vary",
            "mass=80 kg:90 kg",
        ),
        ("optimize", "episodes.yaml", "--smoke", "--workers", "0"),
    ],
)
def test_each_command_that_simulates_refuses_what_cannot_be_meant(
    words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("hopping_leg_mass.yaml").write_text((ROOT / "specs" / "hopping_leg_mass.yaml").read_text())
    Path("episodes.yaml").write_text(EPISODES)
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    assert ended.value.code == 3
    assert "knee.angle: at the start this is 2292 deg" in capsys.readouterr().err
    assert not Path("results").exists()
