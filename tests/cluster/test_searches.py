"""The same search everywhere, whatever happens to the workers."""

from __future__ import annotations

import http.client
import os
import signal
import time
import urllib.request
from contextlib import suppress
from pathlib import Path
from typing import Any

import psutil
import pytest
from optimization.searches import Study

from .servers import Servers, children

pytestmark = pytest.mark.slow
WORDS = ("--generations", "4", "--set", "simulate.duration=20s")


@pytest.fixture(scope="module")
def serial(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    study = Study(tmp_path_factory.mktemp("serial"))
    assert study.optimize(*WORDS, "--workers", "0").code == 0
    return study.history()


def test_two_workers_give_what_one_process_gives(tmp_path: Path, serial: tuple[bytes, bytes]) -> None:
    study = Study(tmp_path)
    ended = study.optimize(*WORDS, "--workers", "2", "--json")
    assert ended.code == 0, ended.err
    assert study.history() == serial
    assert ended.data["evaluations"] == 25
    assert {path.name for path in tmp_path.iterdir()} == {"components", "results", "spec.yaml", "state"}


def test_a_scheduler_in_other_folders_gives_the_same(
    tmp_path: Path, serial: tuple[bytes, bytes], shared: Servers
) -> None:
    study = Study(tmp_path)
    ended = study.optimize(*WORDS, *shared.words)
    assert ended.code == 0, ended.err
    assert study.history() == serial
    by_address = Study(tmp_path / "again")
    ended = by_address.optimize(*WORDS, "--cluster", "--scheduler", shared.address)
    assert ended.code == 0, ended.err
    assert by_address.history() == serial


@pytest.mark.parametrize("trap", ["raises", "infinite"])
def test_failures_are_told_in_the_same_words_everywhere(tmp_path: Path, shared: Servers, trap: str) -> None:
    words = ("--generations", "2", "--set", f"parts.trap.use=trap/{trap}")
    here, there = Study(tmp_path / "here"), Study(tmp_path / "there")
    assert here.optimize(*words, "--workers", "0").code == 0
    assert there.optimize(*words, *shared.words).code == 0
    assert here.history() == there.history()
    assert b'"status": "failed", "reason": "trap (trap/' in here.history()[0]


def test_control_c_with_a_cluster(tmp_path: Path, serial: tuple[bytes, bytes], shared: Servers) -> None:
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", *WORDS, *shared.words, start_new_session=True)
    study.wait_for(4, process)
    os.killpg(process.pid, signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert process.returncode == 130
    command = f"gaitsim optimize results/{study.result.name} --resume --cluster --scheduler-file {shared.file}"
    assert err.endswith(f"To continue: {command}\n")
    assert study.run(*command.split()[1:]).code == 0
    assert study.history() == serial
    assert len(study.timed()) == len(set(study.timed()))


def worker_of_this_search(process: Any) -> int:
    """A Dask worker below a search: the youngest process of its tree."""
    found = [p for p in children(process.pid) if "multiprocessing.spawn" in " ".join(psutil.Process(p).cmdline())]
    return max(found)


def test_a_killed_local_worker_changes_nothing(tmp_path: Path, serial: tuple[bytes, bytes]) -> None:
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", *WORDS, "--workers", "2")
    study.wait_for(5, process)
    os.kill(worker_of_this_search(process), signal.SIGKILL)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert study.history() == serial
    assert len(study.timed()) == len(set(study.timed()))


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


def test_a_worker_that_comes_late_helps(tmp_path: Path, serial: tuple[bytes, bytes], servers: Servers) -> None:
    servers.worker()
    servers.wait_for_workers(1)
    study = Study(tmp_path)
    words = ("--generations", "4", "--set", "simulate.duration=20s")
    process = study.start("optimize", "spec.yaml", *words, *servers.words)
    study.wait_for(3, process)
    servers.worker()
    _, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert study.history() == serial


def test_this_machine_only(tmp_path: Path) -> None:
    """Workers of ours listen to this machine alone, and nothing else listens."""
    study = Study(tmp_path)
    process = study.start("optimize", "spec.yaml", "--set", "simulate.duration=2000s", "--workers", "1")
    while not study.results or len(children(process.pid)) < 2:
        time.sleep(0.2)
        assert process.poll() is None
    time.sleep(3)
    everyone = [psutil.Process(p) for p in (process.pid, *children(process.pid))]
    listening = [c.laddr for p in everyone for c in p.net_connections() if c.status == psutil.CONN_LISTEN]
    assert listening and {address.ip for address in listening} == {"127.0.0.1"}
    assert 8787 not in {address.port for address in listening}
    for port in {address.port for address in listening}:
        page = f"http://127.0.0.1:{port}/status"
        with suppress(OSError, http.client.HTTPException), urllib.request.urlopen(page, timeout=1) as found:
            raise AssertionError(found.read())
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=30)
    assert process.returncode == 130
    time.sleep(1)
    assert not [p for p in everyone[1:] if p.is_running() and p.status() != psutil.STATUS_ZOMBIE]
