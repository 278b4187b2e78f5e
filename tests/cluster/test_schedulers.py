"""Schedulers and workers that are not there, go away, or are others: exit 5, the place, the next move."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from optimization.searches import Ended, Study

import gaitsim

from .servers import Servers

WORDS = ("--generations", "4", "--set", "simulate.duration=20s", "--set", "simulate.step=0.05ms")


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return Study(tmp_path / "study")


def refused(study: Study, *words: str) -> str:
    """What is said when a search cannot begin; nothing is left behind."""
    ended = study.optimize(*WORDS, "--cluster", *words)
    assert (ended.code, ended.out) == (5, ""), ended.err
    assert study.results == []
    return ended.err


@pytest.mark.parametrize("address", ["foo", "tcp://127.0.0.1", "tcp://a:x", "ftp://127.0.0.1:1", ":80", "a:99999"])
def test_an_address_that_is_none(study: Study, address: str) -> None:
    rule = "the address is not one of a scheduler; write one such as tcp://127.0.0.1:8786."
    assert refused(study, "--scheduler", address) == f"{address}: {rule}\n"


def closed_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


def test_a_closed_port(study: Study) -> None:
    place = f"127.0.0.1:{closed_port()}"
    rule = f"no scheduler answers at {place} (Connection refused); start one (dask scheduler), or correct the address."
    assert refused(study, "--scheduler", f"tcp://{place}") == f"tcp://{place}: {rule}\n"


def test_json_says_it_as_data(study: Study) -> None:
    ended = study.optimize("--cluster", "--scheduler", "foo", "--json")
    assert ended.code == 5
    assert ended.data["status"] == "cluster"
    assert ended.data["errors"][0]["message"].startswith("foo: the address is not one of a scheduler")


def test_tls_without_certificates(study: Study) -> None:
    with listener(b"") as port:
        said = refused(study, "--scheduler", f"tls://127.0.0.1:{port}")
    assert "tls needs a certificate, and none is configured; name its files under distributed.comm.tls" in said


class listener:
    """Something that listens and is not a scheduler."""

    def __init__(self, says: bytes) -> None:
        self.says, self.socket = says, socket.create_server(("127.0.0.1", 0))

    def __enter__(self) -> int:
        threading.Thread(target=self._serve, daemon=True).start()
        return int(self.socket.getsockname()[1])

    def _serve(self) -> None:
        try:
            while True:
                connection, _ = self.socket.accept()
                connection.sendall(self.says)
        except OSError:
            pass

    def __exit__(self, *_: object) -> None:
        self.socket.close()


@pytest.mark.slow
@pytest.mark.parametrize("says", [b"HTTP/1.1 400 Bad Request\r\n\r\n", b""])
def test_something_else_listens(study: Study, says: bytes) -> None:
    with listener(says) as port:
        said = refused(study, "--scheduler", f"tcp://127.0.0.1:{port}")
    assert f"tcp://127.0.0.1:{port}: this is not a Dask scheduler" in said


@pytest.mark.parametrize("text", [None, "{", "{}", "[]", '{"address": 5}', '{"address": "tcp://127.0.0.1:1"}'])
def test_a_scheduler_file(study: Study, text: str | None) -> None:
    path = study.folder / "scheduler.json"
    if text is not None:
        path.write_text(text)
    said = refused(study, "--scheduler-file", "scheduler.json")
    assert said.startswith("scheduler.json: ")
    assert "start" in said or "write one such as" in said


@pytest.mark.slow
def test_a_scheduler_without_workers(study: Study, servers: Servers) -> None:
    said = refused(study, "--scheduler-file", str(servers.file))
    move = f"start some: dask worker {servers.address}"
    assert said == f"{servers.file}: the scheduler has no workers; {move}.\n"


def changed_gaitsim(folder: Path) -> str:
    """A copy of gaitsim with one byte more."""
    shutil.copytree(Path(gaitsim.__file__).parent, folder / "gaitsim", ignore=shutil.ignore_patterns("__pycache__"))
    with (folder / "gaitsim" / "units.py").open("a") as file:
        file.write("\n")
    return str(folder)


def no_gaitsim(folder: Path) -> str:
    folder.mkdir()
    (folder / "sitecustomize.py").write_text("import sys\nsys.modules['gaitsim'] = None\n")
    return str(folder)


@pytest.mark.slow
def test_a_worker_with_another_gaitsim_or_none(study: Study, servers: Servers, tmp_path: Path) -> None:
    servers.worker()
    servers.wait_for_workers(1)
    other = servers.worker("--no-nanny", PYTHONPATH=changed_gaitsim(tmp_path / "other"))
    servers.wait_for_workers(2)
    said = refused(study, "--scheduler-file", str(servers.file))
    assert said.startswith("worker tcp://127.0.0.1:")
    assert f"it has gaitsim {gaitsim.__version__} (" in said
    assert said.endswith("give all workers this environment and start them again.\n")
    os.killpg(other.pid, signal.SIGKILL)
    servers.worker("--no-nanny", PYTHONPATH=no_gaitsim(tmp_path / "none"))
    servers.wait_for_workers(2)
    said = refused(study, "--scheduler-file", str(servers.file))
    assert ": it has no gaitsim, and this process has " in said


@pytest.mark.slow
def test_a_strange_worker_that_comes_late_ends_the_search_and_loses_nothing(
    study: Study, servers: Servers, tmp_path: Path
) -> None:
    servers.worker()
    servers.wait_for_workers(1)
    words = ("--generations", "4", "--set", "simulate.duration=4000s")
    process = study.start("optimize", "spec.yaml", *words, *servers.words)
    study.wait_for(3, process)
    other = servers.worker("--no-nanny", PYTHONPATH=changed_gaitsim(tmp_path / "other"))
    _, err = process.communicate(timeout=120)
    assert "Traceback" not in err
    assert process.returncode == 5, err
    assert "worker tcp://127.0.0.1:" in err and "it has gaitsim" in err
    kept = study.arrived()
    os.killpg(other.pid, signal.SIGKILL)
    assert study.run(*command(err)).code == 0
    assert study.arrived() >= kept >= 3
    assert study.manifest()["status"] == "complete"
    assert len(study.timed()) == len(set(study.timed()))


def command(said: str) -> list[str]:
    """The words of the command that continues."""
    return said.rpartition("To continue: gaitsim ")[2].split()


@pytest.mark.slow
def test_a_scheduler_killed_during_a_search(study: Study, servers: Servers, tmp_path: Path) -> None:
    servers.worker()
    servers.wait_for_workers(1)
    process = study.start("optimize", "spec.yaml", *WORDS, *servers.words)
    study.wait_for(5, process)
    os.killpg(servers.scheduler.pid, signal.SIGKILL)
    out, err = process.communicate(timeout=120)
    ended = Ended(process.returncode, out, err)
    assert ended.code == 5, err
    assert "Traceback" not in err
    assert "the connection to the scheduler is lost" in err and "What was evaluated is saved." in err
    assert study.arrived() >= 5
    assert study.manifest()["status"] == "interrupted"
    again = study.run(*command(err))
    assert again.code == 5, again.err
    assert "no scheduler answers at" in again.err and command(again.err) == command(err)
    assert study.run("optimize", f"results/{study.result.name}", "--resume", "--workers", "0").code == 0
    undisturbed = Study(tmp_path / "undisturbed")
    assert undisturbed.optimize(*WORDS, "--workers", "0").code == 0
    assert study.history() == undisturbed.history()
    assert len(study.timed()) == len(set(study.timed()))


def test_plain_tcp_beyond_this_machine_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    from gaitsim.cluster import connect

    monkeypatch.setattr(connect, "_check_answer", lambda *_: None)
    monkeypatch.setattr(connect, "_GREETING", 0.2)
    for host, warned in (("192.0.2.1", True), ("127.0.0.1", False), ("localhost", False), ("[::1]", False)):
        said: list[str] = []
        with pytest.raises(connect.ClusterError):
            connect.remote_client(f"tcp://{host}:{closed_port()}", None, said.append)
        assert bool(said) == warned
        if warned:
            assert "plain tcp lets anyone who reaches this port run code; use tls:// beyond this machine" in said[0]


@pytest.fixture(autouse=True)
def no_configuration(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Dask as it comes, whatever this machine's user configured."""
    monkeypatch.setenv("DASK_CONFIG", str(tmp_path_factory.mktemp("dask")))
    yield
