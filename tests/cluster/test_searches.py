"""The same search on a scheduler's workers, whatever happens to them."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from optimization.searches import Study

from .servers import Servers, children

WORDS = ("--generations", "4", "--set", "simulate.duration=20s", "--set", "simulate.step=0.05ms")


@pytest.fixture(scope="module")
def serial(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    study = Study(tmp_path_factory.mktemp("serial"))
    assert study.optimize(*WORDS, "--workers", "0").code == 0
    return study.history()


@pytest.mark.parametrize("trap", ["raises", "infinite"])
def test_failures_are_told_in_the_same_words_by_workers(tmp_path: Path, trap: str) -> None:
    words = ("--generations", "2", "--set", f"parts.trap.use=trap/{trap}")
    here, there = Study(tmp_path / "here"), Study(tmp_path / "there")
    assert here.optimize(*words, "--workers", "0").code == 0
    assert there.optimize(*words, "--workers", "2").code == 0
    assert here.history() == there.history()
    assert b'"status": "failed", "reason": "trap (trap/' in here.history()[0]


@pytest.mark.slow
@pytest.mark.parametrize("trap", ["none", "raises", "infinite"])
def test_a_scheduler_in_other_folders_gives_the_same(tmp_path: Path, shared: Servers, trap: str) -> None:
    words = ("--generations", "2", "--set", f"parts.trap.use=trap/{trap}")
    here, there, by_address = (Study(tmp_path / name) for name in ("here", "there", "by_address"))
    assert here.optimize(*words, "--workers", "0").code == 0
    assert there.optimize(*words, *shared.words).code == 0
    assert by_address.optimize(*words, "--cluster", "--scheduler", shared.address).code == 0
    assert here.history() == there.history() == by_address.history()


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_with_a_cluster(
    tmp_path: Path, serial: tuple[bytes, bytes], shared: Servers, number: signal.Signals
) -> None:
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", *WORDS, *shared.words, start_new_session=True)
    study.wait_for(4, process)
    os.killpg(process.pid, number)
    _, err = process.communicate(timeout=30)
    assert process.returncode == 130
    command = f"gaitsim optimize results/{study.result.name} --resume --cluster --scheduler-file {shared.file}"
    assert err.endswith(f"To continue: {command}\n")
    assert "Traceback" not in err
    assert study.run(*command.split()[1:]).code == 0
    assert study.history() == serial
    assert len(study.timed()) == len(set(study.timed()))


@pytest.mark.slow
@pytest.mark.parametrize("nanny", ["--nanny", "--no-nanny"])
def test_a_killed_worker_of_a_scheduler_changes_nothing(
    tmp_path: Path, serial: tuple[bytes, bytes], servers: Servers, nanny: str
) -> None:
    first = servers.worker(nanny)
    servers.worker(nanny)
    servers.wait_for_workers(2)
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", *WORDS, *servers.words)
    study.wait_for(5, process)
    os.kill(max(children(first.pid)) if nanny == "--nanny" else first.pid, signal.SIGKILL)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert study.history() == serial
    assert len(study.timed()) == len(set(study.timed()))


@pytest.mark.slow
def test_a_worker_that_comes_late_helps(tmp_path: Path, serial: tuple[bytes, bytes], servers: Servers) -> None:
    servers.worker()
    servers.wait_for_workers(1)
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", *WORDS, *servers.words)
    study.wait_for(3, process)
    servers.worker()
    _, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert study.history() == serial
