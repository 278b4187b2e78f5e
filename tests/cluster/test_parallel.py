"""Workers of Dask: what they find, and what one costs that dies, hangs, or goes away."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from gaitsim.cluster import connect
from gaitsim.cluster.parallel import Parallel
from gaitsim.cluster.time_limits import TimeLimits
from gaitsim.cluster.unreachable import ClusterError

from .candidates import CANDIDATES, CULPRIT, INNOCENT, bundle, evaluated, expected
from .servers import Servers


@pytest.fixture(scope="module")
def within() -> Iterator[Any]:
    """A scheduler and a worker within this process: the same code, without the seconds of a start."""
    from distributed import Client, LocalCluster

    options = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": "127.0.0.1:0"}
    scheduler = {"dashboard": False}
    with LocalCluster(**options, scheduler_kwargs=scheduler) as cluster, Client(cluster) as client:
        yield client


def remote(servers: Servers, *words: str) -> Any:
    servers.worker(*words)
    servers.worker(*words)
    servers.wait_for_workers(2)
    return connect.remote_client(None, servers.file, lambda text: None)


def test_they_find_what_this_process_finds(within: Any, tmp_path: Path) -> None:
    model = bundle(tmp_path, "none")
    evaluate = Parallel(within, model, "rapid")
    for _ in range(3):
        assert evaluated(evaluate, CANDIDATES) == expected(model, CANDIDATES)
    assert evaluated(evaluate, []) == {}


def test_each_search_gives_the_workers_its_own_model(within: Any, tmp_path: Path) -> None:
    first, second = (Parallel(within, bundle(tmp_path, "none"), "rapid") for _ in range(2))
    names = within.run_on_scheduler(lambda dask_scheduler: list(dask_scheduler.worker_plugins))
    assert {first._plugin.name, second._plugin.name} <= set(names)
    within.unregister_worker_plugin(first._plugin.name)
    assert evaluated(second, INNOCENT)


def test_the_order_of_candidates_changes_no_number(tmp_path: Path) -> None:
    model = bundle(tmp_path, "none")
    assert expected(model, CANDIDATES) == expected(model, CANDIDATES[::-1])


@pytest.mark.slow
def test_a_candidate_that_kills_its_workers(tmp_path: Path, servers: Servers) -> None:
    model = bundle(tmp_path, "kills")
    evaluate = Parallel(remote(servers, "--nanny"), model, "rapid")
    evaluated(evaluate, INNOCENT)  # now times are known, and chunks have several candidates
    found = evaluated(evaluate, CANDIDATES)
    culprit = found.pop(CULPRIT)
    assert (culprit.verdict.status, culprit.failed) == ("killed", True)
    assert culprit.verdict.reason == "this candidate killed every worker that tried it"
    assert found == expected(model, INNOCENT)
    assert evaluated(evaluate, INNOCENT[:2])
    evaluate.close()


@pytest.mark.slow
@pytest.mark.parametrize("nanny", ["--nanny", "--no-nanny"])
def test_a_candidate_that_hangs(tmp_path: Path, servers: Servers, nanny: str) -> None:
    model = bundle(tmp_path, "hangs")
    evaluate = Parallel(remote(servers, nanny), model, "rapid", TimeLimits(first=30.0, least=1.5, times=20.0))
    evaluated(evaluate, INNOCENT)
    began = time.monotonic()
    found = evaluated(evaluate, CANDIDATES)
    assert time.monotonic() - began < 40
    culprit = found.pop(CULPRIT)
    assert (culprit.verdict.status, culprit.failed) == ("timeout", True)
    assert found == expected(model, INNOCENT)
    assert evaluated(evaluate, INNOCENT) == found
    evaluate.close()


@pytest.mark.slow
def test_all_workers_gone(tmp_path: Path, servers: Servers) -> None:
    client = remote(servers, "--no-nanny")
    evaluate = Parallel(client, bundle(tmp_path, "none"), "rapid", TimeLimits(workers=2.0))
    evaluated(evaluate, CANDIDATES)
    for process in servers.processes[1:]:
        os.killpg(process.pid, signal.SIGKILL)
    with pytest.raises(ClusterError) as told:
        list(evaluate(CANDIDATES))
    move = f"start some: dask worker {servers.address}."
    assert str(told.value) == f"{servers.address}: all workers are gone; {move}"
    evaluate.close()


@pytest.mark.slow
def test_a_restarted_worker_is_given_the_model_again(tmp_path: Path, servers: Servers) -> None:
    client = remote(servers, "--nanny")
    evaluate = Parallel(client, bundle(tmp_path, "none"), "rapid")
    client.restart_workers(list(client.nthreads()))
    assert evaluated(evaluate, INNOCENT)
    evaluate.close()
