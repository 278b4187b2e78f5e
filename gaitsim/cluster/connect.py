"""Connects to workers: all cores of this machine, or a scheduler that already runs."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from gaitsim.errors import ExitCode, GaitsimError

_PATIENCE = 20.0  # seconds until a scheduler must answer, and until it must have workers


class ClusterError(GaitsimError):
    """The workers cannot be reached, or are lost."""

    exit_code = ExitCode.CLUSTER


def local_client(workers: int) -> Any:
    """A client of `workers` processes on this machine, open to this machine only."""
    import dask
    from distributed import Client, LocalCluster

    _quiet()
    dask.config.set({"distributed.scheduler.allowed-failures": 2})
    cluster = LocalCluster(
        n_workers=workers,
        threads_per_worker=1,
        host="127.0.0.1",
        dashboard_address=None,
        silence_logs=logging.CRITICAL,
    )
    return Client(cluster, set_as_default=False)


def remote_client(scheduler: str | None, scheduler_file: Path | None, say: Callable[[str], None]) -> Any:
    """A client of a scheduler that already runs.

    Errors: ClusterError.
    """
    from distributed import Client

    _quiet()
    place = scheduler or str(scheduler_file)
    if scheduler_file is not None and not scheduler_file.is_file():
        raise ClusterError(f"{scheduler_file}: there is no such scheduler file; start dask scheduler --scheduler-file.")
    if scheduler is not None and scheduler.startswith("tcp://") and not _loopback(scheduler):
        say(f"{scheduler}: plain tcp lets anyone who reaches this port run code; use tls:// beyond this machine")
    address = {"scheduler_file": str(scheduler_file)} if scheduler_file else {"address": scheduler}
    try:
        client = Client(**address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        rule = "no scheduler answers there"
        move = "start one (dask scheduler), or check the address"
        raise ClusterError(f"{place}: {rule}; {move}.") from error
    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
    except TimeoutError as error:
        client.close()
        move = f"start some: dask worker {client.scheduler.address}"
        raise ClusterError(f"{place}: the scheduler has no workers; {move}.") from error
    return client


def cores() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _loopback(address: str) -> bool:
    host = address.split("://", 1)[-1].rsplit(":", 1)[0].strip("[]")
    return host in ("localhost", "::1") or host.startswith("127.")


def _quiet() -> None:
    """Workers come and go; what matters is said by us."""
    for name in ("distributed", "distributed.worker", "distributed.nanny", "distributed.core", "distributed.scheduler"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
