"""Connections to a running Dask scheduler."""

from __future__ import annotations

import asyncio
import json
import logging
import re
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

from gaitsim.cluster.unreachable import ClusterError

_TIMEOUT = 15.0  # seconds until a scheduler must answer, and until it must have workers
_GREETING = 5.0  # seconds until one that listens must show that it is a scheduler
_ADDRESS = re.compile(r"(?:(?P<scheme>tcp|tls)://)?(?P<host>\[[0-9a-fA-F:.]+\]|[^\s:/\[\]]+):(?P<port>\d{1,5})")


def remote_client(scheduler: str | None, scheduler_file: Path | None, say: Callable[[str], None]) -> Any:
    """Connect to a scheduler.

    Args:
        scheduler: Its address, such as tcp://127.0.0.1:8786.
        scheduler_file: A file that it wrote, instead of the address.
        say: Receives lines for the user.

    Returns:
        The Dask client.

    Raises:
        ClusterError: The scheduler cannot be reached, or has no workers.
    """
    from distributed import Client

    _quiet()
    place = f"{scheduler_file}" if scheduler_file is not None else f"{scheduler}"
    address = _address_in(scheduler_file) if scheduler_file is not None else f"{scheduler}"
    scheme, host, port = _parts(address, place)
    _check_answer(host, port, place)
    if scheme == "tcp" and not _loopback(host):
        say(f"{address}: plain tcp lets anyone who reaches this port run code; use tls:// beyond this machine")
    address = f"{scheme}://{host}:{port}"
    _check_protocol(address, place)
    client = Client(address, timeout=_TIMEOUT, set_as_default=False)
    try:
        client.wait_for_workers(1, timeout=_TIMEOUT)
    except (OSError, TimeoutError) as error:
        client.close()
        raise ClusterError(f"{place}: the scheduler has no workers; start some: dask worker {address}.") from error
    return client


def _address_in(file: Path) -> str:
    """Read the address in a scheduler file.

    Raises:
        ClusterError: The file cannot be read.
    """
    move = f"start a scheduler that writes it: dask scheduler --scheduler-file {file}"
    if not file.is_file():
        raise ClusterError(f"{file}: there is no such scheduler file; {move}.")
    try:
        return str(json.loads(file.read_text(encoding="utf-8"))["address"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ClusterError(f"{file}: this is not a scheduler file; {move}.") from error


def _parts(address: str, place: str) -> tuple[str, str, int]:
    """Split an address into scheme, host and port.

    Raises:
        ClusterError: It is not an address.
    """
    found = _ADDRESS.fullmatch(address)
    if found is None or not 0 < int(found["port"]) < 65536:
        named = "" if place == address else f" {address}"
        rule = f"the address{named} is not one of a scheduler"
        raise ClusterError(f"{place}: {rule}; write one such as tcp://127.0.0.1:8786.")
    return found["scheme"] or "tcp", found["host"], int(found["port"])


def _check_answer(host: str, port: int, place: str) -> None:
    """Check that something listens at an address. Dask itself would try again for a long time.

    Raises:
        ClusterError: Nothing listens.
    """
    try:
        socket.create_connection((host.strip("[]"), port), timeout=_TIMEOUT).close()
    except OSError as error:
        reason = error.strerror or str(error)
        move = "start one (dask scheduler), or correct the address"
        raise ClusterError(f"{place}: no scheduler answers at {host}:{port} ({reason}); {move}.") from error


def _check_protocol(address: str, place: str) -> None:
    """Check that a Dask scheduler listens. A Dask client may wait forever for anything else.

    Raises:
        ClusterError: Something else listens.
    """
    from distributed import Security
    from distributed.comm import connect

    options = Security().get_connection_args("client")
    if address.startswith("tls:") and options.get("ssl_context") is None:
        move = "name its files under distributed.comm.tls in Dask's configuration"
        raise ClusterError(f"{place}: tls needs a certificate, and none is configured; {move}.")

    async def greet() -> None:
        comm = await asyncio.wait_for(connect(address, timeout=_GREETING, **options), 2 * _GREETING)
        await comm.close()

    try:
        asyncio.run(greet())
    except Exception as error:  # an answer of another program can make any reader fail
        rule = "this is not a Dask scheduler, or one of another version"
        raise ClusterError(f"{place}: {rule}; start one: dask scheduler.") from error


def _loopback(host: str) -> bool:
    return host in ("localhost", "[::1]") or host.startswith("127.")


def _quiet() -> None:
    """Silence Dask's log. Workers that come and go are reported by gaitsim."""
    for name in ("distributed", *logging.root.manager.loggerDict):
        if name.partition(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
