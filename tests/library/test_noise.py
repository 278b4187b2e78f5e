"""Noise: its random numbers, its distribution, and that one seed gives one run anywhere."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from components.calls import Tables, computed, primitive

from gaitsim.components.find import Library
from gaitsim.components.load import function_of
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
HELPERS: dict[str, Any] = function_of(primitive("sensor/noise").cls, "update").__globals__


def levels(count: int, mode: Mode = "rapid", dt: float = 1e-3, **values: float) -> np.ndarray:
    """The noise in standard deviations, step after step."""
    tables = Tables(primitive("sensor/noise")).put(values)
    found = np.empty(count)
    for i in range(count):
        assert not tables.call("update", mode, dt)
        found[i] = tables.x.level
    return found


def test_the_generator_gives_the_published_numbers() -> None:
    """MRG32k3a from the state 12345, ..., 12345 (L'Ecuyer's reference implementation)."""
    state = np.full(6, 12345.0)
    found = [HELPERS["uniform"](state) for _ in range(5)]
    published = [0.12701112204657714, 0.3185275653967945, 0.3091860155832701, 0.8258468629271136, 0.2216299157820229]
    assert found == pytest.approx(published, rel=1e-14)


def test_the_generator_is_exact_in_doubles() -> None:
    """The same recursion in whole numbers of any size."""
    state = np.array([4294967086.0, 1.0, 4294967085.0, 4294944442.0, 2.0, 4294944441.0])
    first, second = [int(v) for v in state[:3]], [int(v) for v in state[3:]]
    for _ in range(2000):
        HELPERS["uniform"](state)
        first = [*first[1:], (1403580 * first[1] - 810728 * first[0]) % 4294967087]
        second = [*second[1:], (527612 * second[2] - 1370589 * second[0]) % 4294944443]
    assert [int(v) for v in state] == first + second


def test_mixing_permutes() -> None:
    """Seeds that differ give states that differ: cubing permutes the numbers below the prime."""
    prime = int(HELPERS["PRIME"])
    assert prime % 3 == 2 and all(prime % i for i in range(2, int(prime**0.5) + 1))
    found = {HELPERS["mixed"](float(i), 3.0) for i in range(2000)}
    assert len(found) == 2000 and np.std(list(found)) > 0.25 * prime


def test_native_and_plain_numbers_are_the_same_bits() -> None:
    for values in ({"seed": 1.0, "key": 0.0}, {"seed": 67108858.0, "key": 4294967295.0, "correlation_time": 0.0}):
        np.testing.assert_array_equal(levels(1000, "rapid", **values), levels(1000, "normal", **values))


@pytest.mark.parametrize("seed", [0, 1, 2, 12345])
def test_white_noise_is_gaussian(seed: int) -> None:
    found = levels(40_000, seed=seed, key=77.0, correlation_time=0.0)
    assert abs(found.mean()) < 4 / 200
    assert found.std() == pytest.approx(1, abs=4 / 200 / 2**0.5)
    assert abs((found**3).mean()) < 4 * 15**0.5 / 200
    assert (found**4).mean() == pytest.approx(3, abs=4 * 96**0.5 / 200)
    assert np.mean(np.abs(found) < 1) == pytest.approx(0.6826895, abs=4 * 0.4654 / 200)
    for lag in (1, 2, 3, 7):
        assert abs(np.mean(found[lag:] * found[:-lag])) < 4 / 200


@pytest.mark.parametrize("dt", [1e-3, 2.5e-4])
def test_noise_with_memory_does_not_depend_on_the_step(dt: float) -> None:
    """Standard deviation 1, autocorrelation exp(-t / tau), at any step."""
    found = levels(100_000, dt=dt, key=5.0, correlation_time=0.01)
    # Each correlation time holds one number of its own, or so.
    own = 100_000 * dt / 0.02
    assert found.std() == pytest.approx(1, abs=4 / (2 * own) ** 0.5)
    for time in (2e-3, 1e-2, 2e-2):
        lag = round(time / dt)
        correlation = np.mean(found[lag:] * found[:-lag]) / found.var()
        assert correlation == pytest.approx(np.exp(-time / 0.01), abs=4 / own**0.5)


def test_seeds_and_keys_tell_apart() -> None:
    draws = [levels(4000, seed=s, key=k, correlation_time=0.0) for s, k in ((1, 5), (2, 5), (1, 6), (3, 5))]
    together = np.corrcoef(draws)
    assert np.abs(together - np.eye(4)).max() < 4 / 4000**0.5
    # Nor do three seeds in a row add up to nothing.
    assert np.std(draws[0] - 2 * draws[1] + draws[3]) == pytest.approx(6**0.5, rel=0.1)


@modes
def test_constant_and_proportional_noise(mode: Mode) -> None:
    values = {"signal": -3.0, "level": 0.5, "standard_deviation": 0.2}
    assert computed("sensor/noise", mode, **values).noisy == pytest.approx(-2.9)
    assert computed("sensor/noise", mode, proportional=0.1, **values).noisy == pytest.approx(-2.75)
    assert computed("sensor/noise", mode, signal=-3.0, level=2.0).noisy == -3.0


SWINGING = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: rod.proximal}
  seen: {use: sensor/noise, standard_deviation: 2 deg, signal: {from: pivot.angle}}
  heard: {use: sensor/noise, standard_deviation: 2 deg, signal: {from: pivot.angle}}
  balance:
    use: controller/pid
    proportional: 60 N m/rad
    derivative: 12 N m s/rad
    angle: {from: seen.noisy, delay: 20 ms}
    angular_velocity: {from: pivot.velocity, delay: 20 ms}
    to: pivot.torque
simulate: {duration: 1 s, step: 1 ms}
"""


def run(mode: Mode = "rapid", **settings: str) -> Any:
    text = SWINGING
    for name, value in settings.items():
        text = text.replace("seen: {", f"seen: {{{name}: {value}, ")
    model = resolve(parse(text, "spec.yaml"), Library((shipped_folder(),)), "spec")
    outcome = Simulator(model, mode).run(recorded=True)
    assert outcome.status == "completed" and outcome.trajectory is not None, outcome.reason
    return outcome.trajectory


def test_one_seed_one_run() -> None:
    first, again, normal, other = run(), run(), run("normal"), run(seed="2")
    np.testing.assert_array_equal(first.values, again.values)
    np.testing.assert_allclose(first.values, normal.values, rtol=1e-9)
    assert np.abs(first["pivot.angle"] - other["pivot.angle"]).max() > 1e-3


def test_two_parts_with_one_seed_have_noise_of_their_own() -> None:
    found = run()
    seen, heard = (found[f"{name}.noisy"] - found["pivot.angle"] for name in ("seen", "heard"))
    assert seen[0] == heard[0] == 0
    assert np.std(seen) == pytest.approx(np.radians(2), rel=0.3)
    assert abs(np.corrcoef(seen, heard)[0, 1]) < 0.5
    assert found["seen.key"][0] != found["heard.key"][0]
