"""A scheduler for a test."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from .servers import Servers


@pytest.fixture
def servers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Servers]:
    found = Servers(tmp_path_factory.mktemp("servers"))
    yield found
    found.end()


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Servers]:
    """One with two workers, which no test disturbs."""
    found = Servers(tmp_path_factory.mktemp("shared"))
    found.worker()
    found.worker()
    found.wait_for_workers(2)
    yield found
    found.end()
