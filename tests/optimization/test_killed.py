"""A real search in a real process: killed, interrupted, resumed; on this process and on workers."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from .searches import Ended, Study

GENERATIONS = ("--generations", "8", "--set", "simulate.duration=8s", "--set", "simulate.step=0.2ms")


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    study = Study(tmp_path_factory.mktemp("undisturbed"))
    ended = study.optimize(*GENERATIONS, "--workers", "0")
    assert ended.code == 0, ended.err
    assert len(study.timed()) == 1 + 8 * 6
    return study.history()


def below(process: subprocess.Popen[str]) -> list[psutil.Process]:
    return psutil.Process(process.pid).children(recursive=True)


def test_two_workers_give_what_one_process_gives(tmp_path: Path, undisturbed: tuple[bytes, bytes]) -> None:
    study = Study(tmp_path)
    ended = study.optimize(*GENERATIONS, "--workers", "2", "--json")
    assert ended.code == 0, ended.err
    assert study.history() == undisturbed
    assert ended.data["evaluations"] == 49
    assert {path.name for path in tmp_path.iterdir()} == {"components", "results", "spec.yaml", "state"}


def test_a_search_survives_the_death_of_its_workers_and_of_itself(
    tmp_path: Path, undisturbed: tuple[bytes, bytes]
) -> None:
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", *GENERATIONS, "--workers", "2", start_new_session=True)
    study.wait_for(3, process)
    before = below(process)
    assert len(before) == 2
    before[0].kill()
    study.wait_for(20, process)
    workers = below(process)
    assert len(workers) == 2 and before[0] not in workers
    assert study.listed() == "running"
    process.kill()
    process.communicate()
    assert psutil.wait_procs(workers, timeout=5)[1] == []
    assert study.manifest()["status"] == "running"  # it had no time to say another thing
    assert study.listed() == "interrupted"
    acknowledged = study.arrived()
    assert 20 <= acknowledged < 49
    ended = study.run("optimize", "spec.yaml", *GENERATIONS, "--resume", "--workers", "2")
    assert ended.code == 0, ended.err
    assert study.history() == undisturbed
    assert len(study.timed()) == len(set(study.timed()))
    assert study.listed() == study.manifest()["status"] == "complete"


@pytest.mark.slow
@pytest.mark.parametrize("workers", ["0", "2"])
def test_killed_three_times_it_is_the_same_search(
    tmp_path: Path, undisturbed: tuple[bytes, bytes], workers: str
) -> None:
    study, chance = Study(tmp_path), random.Random(f"killed {workers}")
    words = ["optimize", "spec.yaml", *GENERATIONS, "--workers", workers]
    for kill in range(3):
        process = study.start(*words, start_new_session=True)
        study.wait_for(1 + chance.randrange(8) + 14 * kill, process)
        time.sleep(chance.random() * 0.05)
        os.kill(process.pid, signal.SIGKILL)
        process.communicate()
        words = ["optimize", str(study.result.relative_to(tmp_path)), "--resume", "--workers", workers]
    acknowledged = study.arrived()
    assert 20 < acknowledged < 49
    ended = study.run(*words)
    assert ended.code == 0, ended.err
    assert study.history() == undisturbed
    assert len(study.timed()) == len(set(study.timed()))
    assert study.manifest()["status"] == "complete"


def interrupted(process: subprocess.Popen[str], number: signal.Signals = signal.SIGINT) -> Ended:
    """As by Ctrl-C at a terminal, or by a job queue: every process of the group hears it."""
    began = time.monotonic()
    os.killpg(process.pid, number)
    out, err = process.communicate(timeout=30)
    assert time.monotonic() - began < 15
    assert "Traceback" not in err, err
    return Ended(process.returncode, out, err)


@pytest.mark.parametrize(
    ("number", "workers"),
    [
        (signal.SIGINT, "2"),
        pytest.param(signal.SIGTERM, "2", marks=pytest.mark.slow),
        (signal.SIGTERM, "0"),
    ],
)
def test_a_signal_saves_and_says_how_to_go_on(
    tmp_path: Path, undisturbed: tuple[bytes, bytes], number: signal.Signals, workers: str
) -> None:
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", *GENERATIONS, "--workers", workers, start_new_session=True)
    study.wait_for(10, process)
    workers_of = below(process)
    ended = interrupted(process, number)
    command = f"gaitsim optimize results/{study.result.name} --resume --workers {workers}"
    assert (ended.code, ended.out) == (130, "")
    assert ended.err.endswith(f"interrupted; everything is saved. To continue: {command}\n")
    assert not any(worker.is_running() for worker in workers_of)
    assert study.manifest()["status"] == study.listed() == "interrupted"
    assert not (study.result / "lock").exists()
    ended = study.run(*command.split()[1:])
    assert ended.code == 0, ended.err
    assert study.history() == undisturbed
    assert len(study.timed()) == len(set(study.timed()))


_SLOW_TO_END = """\
import time
from gaitsim.cli.interrupts import interrupt_once

with interrupt_once():
    try:
        print("ready", flush=True)
        time.sleep(60)
    except KeyboardInterrupt:
        print("ending", flush=True)
        time.sleep(60)
"""


@pytest.mark.parametrize("numbers", [(signal.SIGINT, signal.SIGINT), (signal.SIGTERM, signal.SIGINT)])
def test_the_second_signal_ends_at_once_and_quietly(numbers: tuple[signal.Signals, ...]) -> None:
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    process = subprocess.Popen([sys.executable, "-c", _SLOW_TO_END], text=True, **pipes)
    assert process.stdout is not None
    for number, said in zip(numbers, ("ready\n", "ending\n"), strict=True):
        assert process.stdout.readline() == said
        process.send_signal(number)
    began = time.monotonic()
    assert process.communicate(timeout=10) == ("", "")
    assert (process.returncode, time.monotonic() - began < 2) == (130, True)


@pytest.mark.parametrize("workers", ["0", "1"])
def test_control_c_reaches_a_run_of_days(tmp_path: Path, workers: str) -> None:
    study = Study(tmp_path)
    words = ("--set", "simulate.duration=100000s", "--workers", workers, "--json")
    process = study.start("optimize", "spec.yaml", *words, start_new_session=True)
    study.wait_to_run(process)
    ended = interrupted(process)
    assert ended.code == 130
    assert ended.data == {
        "status": "interrupted",
        "result": f"results/{study.result.name}",
        "continue": f"gaitsim optimize results/{study.result.name} --resume --workers {workers}",
    }


@pytest.mark.slow
@pytest.mark.parametrize("vary", [(), ("--vary", "trap.level=0.9,0.95,0.99")])
def test_control_c_reaches_a_component_that_hangs(tmp_path: Path, vary: tuple[str, ...]) -> None:
    study = Study(tmp_path)
    words = ("--set", "parts.trap.use=trap/hangs", "--set", "parts.trap.level=0.9", "--no-save", *vary)
    process = study.start("run", "spec.yaml", *words, start_new_session=True)
    time.sleep(6)
    assert process.poll() is None
    assert interrupted(process).code == 130


def test_a_longer_search_continues_a_shorter_one(tmp_path: Path, undisturbed: tuple[bytes, bytes]) -> None:
    study = Study(tmp_path)
    assert study.optimize(*GENERATIONS[2:], "--generations", "3", "--workers", "0").code == 0
    ended = study.optimize(*GENERATIONS, "--resume", "--workers", "2")
    assert ended.code == 0, ended.err
    assert f"resuming results/{study.result.name}" in ended.err
    assert study.history() == undisturbed
    assert len(study.timed()) == len(set(study.timed())) == 49
    assert study.manifest()["search"]["generations"] == 8


def test_a_trap_is_marked_and_not_tried_again(tmp_path: Path) -> None:
    """The command marks the culprits, says how many there are of each kind, and goes on without them."""
    study = Study(tmp_path)
    words = ("--set", "parts.trap.use=trap/kills", "--set", "simulate.duration=200ms", "--workers", "2", "--seed", "2")
    ended = study.run_apart("optimize", "spec.yaml", *words, "--generations", "1", "--json")
    assert ended.code == 0, ended.err
    count = study.history()[0].count(b'"status": "killed"')
    assert ended.data["failed"] == count >= 1
    lines = [json.loads(line) for line in study.history()[0].splitlines()]
    first = next(line for line in lines if line["status"] == "killed")
    reason = "this candidate killed every worker that tried it"
    place = f"{first['generation']}:{first['index']}"
    assert ended.data["failures"] == [{"count": count, "status": "killed", "reason": reason, "candidate": place}]
    again = study.optimize(*words, "--generations", "1", "--resume")
    assert again.code == 0, again.err
    look = f"gaitsim run results/{study.result.name} --candidate {place}"
    assert f"{count} failed: {reason}; see such as: {look}\n" in again.out
    assert study.run("results", "verify", f"results/{study.result.name}", "--all").code == 0
