"""A real search in a real process: killed, interrupted, resumed; on this process and on workers."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import time
from pathlib import Path

import pytest

from .searches import Ended, Study

pytestmark = pytest.mark.slow
GENERATIONS = ("--generations", "8", "--set", "simulate.duration=8s")


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    study = Study(tmp_path_factory.mktemp("undisturbed"))
    ended = study.optimize(*GENERATIONS, "--workers", "0")
    assert ended.code == 0, ended.err
    assert len(study.timed()) == 1 + 8 * 6
    return study.history()


def resumed(study: Study, *words: str) -> Ended:
    return study.run("optimize", str(study.result.relative_to(study.folder)), "--resume", *words)


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


def interrupted(process: subprocess.Popen[str]) -> Ended:
    """As by Ctrl-C at a terminal: every process of the group hears it."""
    began = time.monotonic()
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert time.monotonic() - began < 15
    assert "Traceback" not in err, err
    return Ended(process.returncode, out, err)


@pytest.mark.parametrize("workers", ["0", "2"])
def test_control_c_saves_and_says_how_to_go_on(
    tmp_path: Path, undisturbed: tuple[bytes, bytes], workers: str
) -> None:
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", *GENERATIONS, "--workers", workers, start_new_session=True)
    study.wait_for(10, process)
    ended = interrupted(process)
    command = f"gaitsim optimize results/{study.result.name} --resume --workers {workers}"
    assert (ended.code, ended.out) == (130, "")
    assert ended.err.endswith(f"interrupted; everything is saved. To continue: {command}\n")
    assert study.manifest()["status"] == "interrupted"
    assert not (study.result / "lock").exists()
    ended = study.run(*command.split()[1:])
    assert ended.code == 0, ended.err
    assert study.history() == undisturbed
    assert len(study.timed()) == len(set(study.timed()))


def test_control_c_reaches_a_run_of_days(tmp_path: Path) -> None:
    study = Study(tmp_path)
    words = ("--set", "simulate.duration=100000s", "--workers", "0", "--json")
    process = study.start("optimize", "spec.yaml", *words, start_new_session=True)
    while not study.results:
        time.sleep(0.05)
    time.sleep(1.0)
    ended = interrupted(process)
    assert ended.code == 130
    assert ended.data == {
        "status": "interrupted",
        "result": f"results/{study.result.name}",
        "continue": f"gaitsim optimize results/{study.result.name} --resume --workers 0",
    }


def test_control_c_reaches_a_component_that_hangs(tmp_path: Path) -> None:
    study = Study(tmp_path)
    words = ("--set", "parts.trap.use=trap/hangs", "--set", "parts.trap.level=0.9", "--no-save")
    process = study.start("run", "spec.yaml", *words, start_new_session=True)
    time.sleep(4)
    assert process.poll() is None
    assert interrupted(process).code == 130


def test_a_longer_search_continues_a_shorter_one(tmp_path: Path, undisturbed: tuple[bytes, bytes]) -> None:
    study = Study(tmp_path)
    assert study.optimize(*GENERATIONS[2:], "--generations", "3", "--workers", "0").code == 0
    ended = study.optimize(*GENERATIONS, "--resume", "--workers", "0")
    assert ended.code == 0, ended.err
    assert f"resuming results/{study.result.name}" in ended.err
    assert study.history() == undisturbed
    assert len(study.timed()) == len(set(study.timed())) == 49
    assert study.manifest()["search"]["generations"] == 8
