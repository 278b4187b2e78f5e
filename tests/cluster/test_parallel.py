"""Candidates that kill or hang their workers, and innocent ones beside them."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from optimization.searches import Study

from gaitsim.cli.source import source_of_spec
from gaitsim.cluster import connect
from gaitsim.cluster.connect import ClusterError
from gaitsim.cluster.evaluate import Bench, Serial
from gaitsim.cluster.parallel import Parallel, Patience
from gaitsim.optimization.evaluation import Candidate, Evaluation
from gaitsim.results.bundle import Bundle
from gaitsim.results.episodes import Episodes
from gaitsim.simulation.run import Simulator

from .servers import Servers

pytestmark = pytest.mark.slow
LEVELS = (0.1, 0.3, 0.9, 0.2, 0.5, 0.65, 0.4, 0.0)
CANDIDATES = [Candidate(1, i, (60.0, 12.0, level)) for i, level in enumerate(LEVELS)]
INNOCENT = [c for c in CANDIDATES if c.x[2] < 0.7]


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return Study(tmp_path / "study")


def bundle(study: Study, trap: str) -> Bundle:
    settings = [f"parts.trap.use=trap/{trap}", "simulate.duration=200ms"]
    source = source_of_spec(study.folder / "spec.yaml", settings, None, tuned=False)
    return source.bundle([source.model()])


@pytest.fixture
def local() -> Iterator[Any]:
    client = connect.local_client(2)
    yield client
    cluster = client.cluster
    client.close()
    cluster.close()


def evaluated(evaluate: Parallel, candidates: list[Candidate]) -> dict[Candidate, Evaluation]:
    found = {evaluation.candidate: evaluation for evaluation, _, _ in evaluate(candidates)}
    assert set(found) == set(candidates)
    return found


def expected(study: Study) -> dict[Candidate, Evaluation]:
    """The innocent ones, as this process evaluates them."""
    settings = ["simulate.duration=200ms"]
    model = source_of_spec(study.folder / "spec.yaml", settings, None, tuned=False).model()
    serial = Serial(Bench(Episodes((Simulator(model),)), study.folder))
    return {evaluation.candidate: evaluation for evaluation, _, _ in serial(INNOCENT)}


def test_a_candidate_that_kills_its_workers(study: Study, local: Any) -> None:
    evaluate = Parallel(local, bundle(study, "kills"), "rapid")
    evaluated(evaluate, INNOCENT * 1)  # now times are known, and chunks have several candidates
    found = evaluated(evaluate, CANDIDATES * 1)
    culprit = found.pop(CANDIDATES[2])
    assert (culprit.verdict.status, culprit.failed) == ("killed", True)
    assert culprit.verdict.reason == "this candidate killed every worker that tried it"
    assert {c: e.cost for c, e in found.items()} == {c: e.cost for c, e in expected(study).items()}
    assert evaluated(evaluate, INNOCENT[:2])


@pytest.mark.parametrize("nanny", ["local", "--no-nanny"])
def test_a_candidate_that_hangs(study: Study, nanny: str, request: pytest.FixtureRequest) -> None:
    client = request.getfixturevalue("local") if nanny == "local" else remote(request.getfixturevalue("servers"), nanny)
    evaluate = Parallel(client, bundle(study, "hangs"), "rapid", Patience(first=30.0, least=1.5, times=20.0))
    evaluated(evaluate, INNOCENT)
    began = time.monotonic()
    found = evaluated(evaluate, CANDIDATES)
    assert time.monotonic() - began < 40
    culprit = found.pop(CANDIDATES[2])
    assert (culprit.verdict.status, culprit.failed) == ("timeout", True)
    assert {c: e.cost for c, e in found.items()} == {c: e.cost for c, e in expected(study).items()}
    assert {c: e.cost for c, e in evaluated(evaluate, INNOCENT).items()} == {c: e.cost for c, e in found.items()}
    evaluate.close()


def remote(servers: Servers, *words: str) -> Any:
    servers.worker(*words)
    servers.worker(*words)
    servers.wait_for_workers(2)
    return connect.remote_client(None, servers.file, lambda text: None)


def test_a_search_with_a_trap_goes_on(study: Study) -> None:
    """The command marks the culprits, and resumes without trying them again."""
    words = ("--set", "parts.trap.use=trap/kills", "--set", "simulate.duration=200ms", "--workers", "2")
    ended = study.optimize(*words, "--generations", "1", "--seed", "2", "--json")
    assert ended.code == 0, ended.err
    assert ended.data["failed"] == study.history()[0].count(b'"status": "killed"') >= 1
    again = study.optimize(*words, "--generations", "1", "--resume", "--json")
    assert again.code == 0, again.err
    assert again.data["failed"] == ended.data["failed"]
    assert study.run("results", "verify", f"results/{study.result.name}", "--all").code == 0


def test_all_workers_gone(study: Study, servers: Servers) -> None:
    client = remote(servers, "--no-nanny")
    made = bundle(study, "none")
    evaluate = Parallel(client, made, "rapid", Patience(workers=2.0))
    evaluated(evaluate, CANDIDATES)
    for process in servers.processes[1:]:
        os.killpg(process.pid, signal.SIGKILL)
    with pytest.raises(ClusterError) as told:
        list(evaluate(CANDIDATES))
    move = f"start some: dask worker {servers.address}."
    assert str(told.value) == f"{servers.address}: all workers are gone; {move}"
    evaluate.close()


def test_a_model_is_taken_from_the_workers_again(study: Study, local: Any) -> None:
    first = Parallel(local, bundle(study, "none"), "rapid")
    second = Parallel(local, bundle(study, "none"), "rapid")
    names = local.run_on_scheduler(lambda dask_scheduler: list(dask_scheduler.worker_plugins))
    assert len([name for name in names if name.startswith("gaitsim")]) == 2
    local.unregister_worker_plugin(first._plugin.name)
    local.restart_workers(list(local.nthreads()))
    assert evaluated(second, INNOCENT)


def test_the_order_of_candidates_changes_no_number(study: Study) -> None:
    model = source_of_spec(study.folder / "spec.yaml", None, None, tuned=False).model()
    serial = Serial(Bench(Episodes((Simulator(model),)), study.folder))
    forwards = {e.candidate: e.line() for e, _, _ in serial(CANDIDATES)}
    assert forwards == {e.candidate: e.line() for e, _, _ in serial(CANDIDATES[::-1])}
