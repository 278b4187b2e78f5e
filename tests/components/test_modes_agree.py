"""A component's native kernel and its plain Python give the same numbers, finite or not."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from gaitsim.component import Parameter
from gaitsim.components.primitive import Primitive
from gaitsim.units import parse_unit

from .calls import FILES, Tables, primitive, reference_of, stages

# Found by the text, so that a broken file fails its own tests and no others.
_STAGE = re.compile(r"^    def (start|output|update)\(", re.MULTILINE)
CALLED = [reference_of(f) for f in FILES if f.suffix == ".py" and _STAGE.search(f.read_text(encoding="utf-8"))]
WILD = (0.0, -0.0, -3.0, 1e-308, 1e200, -1e200, math.inf, -math.inf, math.nan)

every_component = pytest.mark.parametrize("reference", CALLED)


def drawn(parameter: Parameter, chance: np.random.Generator) -> float:
    """A value within the bounds; without bounds one around the default."""
    low, high = parameter.bounds or (-math.inf, math.inf)
    if parameter.default:
        value = parameter.default * chance.uniform(0.5, 1.5)
    elif math.isinf(low) or math.isinf(high):
        value = chance.uniform(-2, 2)
    elif low > 0:
        value = math.exp(chance.uniform(math.log(low), math.log(high)))
    else:
        value = low + (high - low) * chance.uniform() ** 3
    return min(max(value, low), high) * parse_unit(parameter.unit).factor


def filled(kind: Primitive, chance: np.random.Generator, wild: float = 0.0) -> Tables:
    """Tables with random values; a share `wild` of parameters and inputs is far out of range."""
    tables = Tables(kind)
    p, u, x, y = tables.arrays
    for i, parameter in enumerate(kind.parameters.values()):
        p[i] = drawn(parameter, chance)
    for table in (u, y):
        signals = np.where(chance.uniform(size=table.size) < 0.5, 1.0, 0.3)
        table[:] = chance.uniform(-1, 2, table.size) * signals
        gates = chance.uniform(size=table.size) < 0.3
        table[gates] = chance.integers(0, 2, int(gates.sum()))
    x[:] = chance.uniform(0, 3, x.size)
    for table in (p, u):
        hit = chance.uniform(size=table.size) < wild
        table[hit] = chance.choice(WILD, int(hit.sum()))
    return tables


def agree(kind: Primitive, before: Tables, dt: float) -> np.ndarray:
    """Assert that all functions give the same in both modes; the tables after them."""
    rapid, normal = before.copy(), before.copy()
    for stage in stages(kind):
        raised = {rapid.call(stage, "rapid", dt), normal.call(stage, "normal", dt)}
        assert len(raised) == 1, f"only one mode raises in {stage} from {before.views}"
        for mine, theirs in zip(rapid.arrays, normal.arrays, strict=True):
            if mine.tobytes() != theirs.tobytes():  # as a rule they are the same bits
                np.testing.assert_allclose(mine, theirs, rtol=1e-12, atol=0, err_msg=f"{stage} from {before.views}")
    return np.concatenate([rapid.arrays[2], rapid.arrays[3]])


@every_component
def test_within_the_bounds(reference: str) -> None:
    kind = primitive(reference)
    assert stages(kind)
    for seed in range(40):
        chance = np.random.default_rng([seed, 1])
        agree(kind, filled(kind, chance), dt=float(chance.choice([1e-4, 1e-3])))


@every_component
def test_out_of_the_domain(reference: str) -> None:
    kind = primitive(reference)
    seen = []
    for seed in range(120):
        chance = np.random.default_rng([seed, 2])
        seen.append(agree(kind, filled(kind, chance, wild=0.3), dt=1e-3))
    if reference in ("leg/virtual_two_segment", "muscle/geyer2003"):
        assert np.any(np.isnan(seen)) and np.any(np.isinf(seen)) and np.any(np.isfinite(seen))


@pytest.mark.parametrize(
    ("reference", "values", "output", "value"),
    [
        # Longer than straight: the square root and the arc sine have no value.
        (
            "leg/virtual_two_segment",
            {"segment_length": 0.4, "landing_length": 1.2, "length": 1.0},
            "knee_angle",
            math.nan,
        ),
        # Exactly straight: a moment divided by zero.
        (
            "leg/virtual_two_segment",
            {"segment_length": 0.5, "landing_length": 1.2, "length": 1.0, "knee_moment": 3.0},
            "force",
            math.inf,
        ),
        # No activation: a force divided by nothing.
        (
            "muscle/geyer2003",
            {
                "max_isometric_force": 1000.0,
                "optimal_fiber_length": 0.1,
                "tendon_slack_length": 0.4,
                "path_length": 0.505,
                "length": 0.1,
            },
            "fiber_velocity",
            math.inf,
        ),
    ],
)
def test_known_ends_of_the_domain(reference: str, values: dict[str, float], output: str, value: float) -> None:
    kind = primitive(reference)
    for mode in ("rapid", "normal"):
        tables = Tables(kind).put(values)
        assert not tables.call("output", mode)
        np.testing.assert_equal(getattr(tables.y, output), value)
