"""Search algorithms: their numbers come from the seed alone."""

from __future__ import annotations

import os
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from gaitsim.optimization.algorithms import ALGORITHMS
from gaitsim.optimization.cma_es import CmaEs
from gaitsim.optimization.problem import Problem, Variable, Vector
from gaitsim.units import parse_unit


def problem(count: int, spread: float = 0.2) -> Problem:
    return Problem(tuple(Variable(f"x{i}", parse_unit("1"), 0.0, 1.0, 0.4, spread) for i in range(count)))


def sphere(values: list[float]) -> float:
    return sum((v - 0.7) ** 2 for v in values)


NAMES = sorted(ALGORITHMS)


def asked(
    name: str, seed: int, generations: int = 6, between: Callable[[], object] = lambda: None
) -> list[list[Vector]]:
    tuned = problem(4)
    algorithm = ALGORITHMS[name].make(tuned, seed, None)
    found = []
    for _ in range(generations):
        between()
        vectors = algorithm.ask()
        found.append([vector.copy() for vector in vectors])
        between()
        algorithm.tell(vectors, [sphere(tuned.values(vector)) for vector in vectors])
    return found


@pytest.mark.parametrize("name", NAMES)
def test_a_seed_is_a_search(name: str) -> None:
    assert np.array_equal(asked(name, 1), asked(name, 1))
    assert not np.array_equal(asked(name, 1), asked(name, 2))


@pytest.mark.parametrize("name", NAMES)
def test_numpys_own_generator_has_no_part_in_it(name: str) -> None:
    np.random.seed(5)
    state = np.random.get_state()[1].copy()  # type: ignore[union-attr, index]
    plain = asked(name, 1)
    assert np.array_equal(np.random.get_state()[1], state)  # type: ignore[index]
    assert np.array_equal(asked(name, 1, between=np.random.standard_normal), plain)


def test_pythons_hash_has_no_part_in_it(tmp_path: Path) -> None:
    code = "import test_algorithms as t; print([[[v.tolist() for v in g] for g in t.asked(n, 1)] for n in t.NAMES])"
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    said = {
        subprocess.run(
            [sys.executable, "-c", code],
            cwd=tmp_path,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": path},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "4711")
    }
    assert len(said) == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", sorted(set(ALGORITHMS) - {"cma"}))
@pytest.mark.parametrize("population", [2, 5, 40])
def test_populations_get_better_within_the_bounds(name: str, population: int) -> None:
    """Failures are infinite costs, and are no one's best."""
    tuned = problem(3)
    algorithm = ALGORITHMS[name].make(tuned, 1, population)
    assert algorithm.population == population
    best = []
    for _ in range(60):
        vectors = algorithm.ask()
        assert 1 <= len(vectors) <= population
        values = [tuned.values(vector) for vector in vectors]
        assert all(0 <= v <= 1 for each in values for v in each)
        costs = [np.inf if each[0] > 0.9 else sphere(each) for each in values]
        algorithm.tell(vectors, costs)
        best.append(min(costs))
    assert population < 40 or min(best) < 1e-3


@pytest.mark.parametrize(("count", "size"), [(1, 4), (2, 6), (6, 9), (30, 14)])
def test_the_default_population_is_pycmas(count: int, size: int) -> None:
    algorithm = CmaEs(problem(count), 1, None)
    assert algorithm.population == len(algorithm.ask()) == size


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("spread", [0.01, 0.5, 5.0])
def test_any_spread_finds_the_best_within_the_bounds(count: int, spread: float) -> None:
    tuned = problem(count, spread)
    algorithm = CmaEs(tuned, 1, None)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        while not algorithm.stop():
            vectors = algorithm.ask()
            values = [tuned.values(vector) for vector in vectors]
            assert all(0 <= v <= 1 for each in values for v in each)
            algorithm.tell(vectors, [sphere(each) for each in values])
    assert tuned.values(algorithm.ask()[0]) == pytest.approx([0.7] * count, abs=1e-3)


def test_failures_only_end_a_search_in_words() -> None:
    algorithm = CmaEs(problem(3), 1, None)
    said = []
    for _ in range(2):
        vectors = algorithm.ask()
        algorithm.tell(vectors, [np.inf] * len(vectors))
        said.append(algorithm.stop())
    assert said == [None, "all candidates have the same cost"]
