"""Workers of this machine: what they find, and what one costs that dies, hangs, or loses its driver."""

from __future__ import annotations

import faulthandler
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil
import pytest

from gaitsim.cluster.local import Local
from gaitsim.cluster.time_limits import TimeLimits
from gaitsim.results.bundle import Bundle

from .candidates import CANDIDATES, CULPRIT, INNOCENT, bundle, evaluated, expected, workers


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Bundle]:
    return {trap: bundle(tmp_path_factory.mktemp(trap), trap) for trap in ("none", "kills", "hangs")}


@contextmanager
def local(model: Bundle, count: int = 2, time_limits: TimeLimits | None = None) -> Iterator[Local]:
    evaluate = Local(model, "rapid", count, time_limits)
    try:
        yield evaluate
    finally:
        evaluate.close()
        assert workers() == []


@pytest.mark.parametrize("count", [1, 2, 5])
def test_they_find_what_this_process_finds(models: dict[str, Bundle], count: int) -> None:
    with local(models["none"], count) as evaluate:
        for _ in range(3):
            assert evaluated(evaluate, CANDIDATES) == expected(models["none"], CANDIDATES)
        assert evaluated(evaluate, []) == {}


@pytest.mark.slow
def test_workers_that_begin_anew_find_the_same(models: dict[str, Bundle]) -> None:
    """As on systems where a process cannot be copied."""
    evaluate = Local(models["none"], "rapid", 2, method="spawn")
    try:
        assert evaluated(evaluate, CANDIDATES) == expected(models["none"], CANDIDATES)
    finally:
        evaluate.close()


@pytest.fixture
def silent_deaths() -> Iterator[None]:
    """Without what pytest prints of a process that dies."""
    faulthandler.disable()
    yield
    faulthandler.enable()


@pytest.mark.usefixtures("silent_deaths")
def test_a_candidate_that_kills_its_workers_is_named_and_costs_no_other(models: dict[str, Bundle]) -> None:
    with local(models["kills"]) as evaluate:
        evaluated(evaluate, INNOCENT)  # now the times are known, and workers have several at once
        found = evaluated(evaluate, CANDIDATES)
        culprit = found.pop(CULPRIT)
        assert (culprit.verdict.status, culprit.failed) == ("killed", True)
        assert culprit.verdict.reason == "this candidate killed every worker that tried it"
        assert found == expected(models["kills"], INNOCENT)
        assert len(workers()) == 2
        assert evaluated(evaluate, INNOCENT) == found


def test_a_candidate_that_hangs_is_ended_and_costs_no_other(models: dict[str, Bundle]) -> None:
    with local(models["hangs"], time_limits=TimeLimits(first=30.0, least=0.3, times=1.0)) as evaluate:
        evaluated(evaluate, INNOCENT)
        began = time.monotonic()
        found = evaluated(evaluate, CANDIDATES)
        assert 0.6 <= time.monotonic() - began < 20
        culprit = found.pop(CULPRIT)
        assert (culprit.verdict.status, culprit.failed) == ("timeout", True)
        assert culprit.verdict.reason == "this candidate was not done after many times what the others took"
        assert found == expected(models["hangs"], INNOCENT)
        assert evaluated(evaluate, INNOCENT) == found


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_a_worker_killed_from_outside_is_replaced_and_nothing_is_lost(
    models: dict[str, Bundle], number: signal.Signals
) -> None:
    with local(models["none"]) as evaluate:
        before = evaluated(evaluate, CANDIDATES)
        for victim in workers():
            os.kill(victim.pid, number)  # while it waits
        while workers():
            time.sleep(0.01)
        assert evaluated(evaluate, CANDIDATES) == before
        answers = evaluate(CANDIDATES * 1)
        os.kill(workers()[0].pid, number)  # while it works
        assert {e.candidate: e for e, _, _ in answers} == before
        assert len(workers()) == 2


def test_ctrl_c_is_heard_by_the_driver_alone(models: dict[str, Bundle]) -> None:
    with local(models["none"]) as evaluate:
        before = workers()
        for worker in before:
            worker.send_signal(signal.SIGINT)
        evaluated(evaluate, CANDIDATES)
        assert workers() == before


def test_closing_ends_a_worker_that_hangs(models: dict[str, Bundle]) -> None:
    evaluate = Local(models["hangs"], "rapid", 1)
    answers = evaluate([CULPRIT])
    closed = threading.Event()
    time.sleep(0.2)
    evaluate.close()
    closed.set()
    assert workers() == []
    del answers


def test_no_socket_of_a_network_is_opened(models: dict[str, Bundle]) -> None:
    before = psutil.Process().net_connections(kind="inet")
    with local(models["none"]) as evaluate:
        evaluated(evaluate, CANDIDATES)
        everyone = [psutil.Process(), *workers()]
        assert len(everyone) == 3
        for process in everyone:
            assert process.net_connections(kind="all") == [c for c in process.net_connections("inet") if c in before]


def test_a_bug_in_a_worker_is_told_with_its_traceback(
    models: dict[str, Bundle], monkeypatch: pytest.MonkeyPatch
) -> None:
    from gaitsim.cluster.evaluate import EpisodeRunner

    def broken(self: EpisodeRunner, x: object) -> None:
        raise AssertionError("not thought of")

    monkeypatch.setattr(EpisodeRunner, "verdict", broken)
    with local(models["none"]) as evaluate, pytest.raises(RuntimeError) as told:
        evaluated(evaluate, CANDIDATES)
    assert str(told.value).startswith("in a worker:\nTraceback")
    assert str(told.value).endswith("AssertionError: not thought of\n")


_DRIVER = """\
import sys
from pathlib import Path
from cluster.candidates import CANDIDATES, CULPRIT, bundle, workers
from gaitsim.cluster.local import Local

evaluate = Local(bundle(Path(sys.argv[1]), "hangs"), "rapid", 2)
answers = evaluate([CULPRIT, CULPRIT])
print(*(worker.pid for worker in workers()), flush=True)
next(answers)
"""


def test_a_driver_killed_leaves_no_worker(tmp_path: Path) -> None:
    """Not even one that is in native code and does not come back."""
    path = os.pathsep.join([str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    driver = subprocess.Popen(
        [sys.executable, "-c", _DRIVER, str(tmp_path)],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
    )
    assert driver.stdout is not None
    found = [psutil.Process(int(number)) for number in driver.stdout.readline().split()]
    assert len(found) == 2
    time.sleep(0.3)
    driver.kill()
    driver.communicate()
    gone, alive = psutil.wait_procs(found, timeout=5)
    assert (len(gone), alive) == (2, [])
