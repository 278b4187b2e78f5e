"""At its declared largest step each muscle is within 2 % of F_max of what it does at 5 us."""

from __future__ import annotations

import pytest
from parts.calls import primitive

from .muscle_rig import MUSCLES, SIZES, TRIALS, largest_error

LIMIT = 0.02


@pytest.mark.parametrize("muscle", MUSCLES)
def test_it_is_right_at_its_declared_step(muscle: str) -> None:
    step = primitive(f"muscle/{muscle}").largest_step
    # The stiffest tendon, at an activation at which the fiber yields: the hardest of all.
    assert largest_error("passive ramp", muscle, SIZES["HFL"], step) < LIMIT
    assert largest_error("isometric", muscle, SIZES["HFL"], step) < LIMIT


@pytest.mark.slow
@pytest.mark.parametrize("muscle", MUSCLES)
def test_it_is_right_at_its_declared_step_in_every_trial(muscle: str) -> None:
    step = primitive(f"muscle/{muscle}").largest_step
    errors = {(trial, size): largest_error(trial, muscle, SIZES[size], step) for trial in TRIALS for size in SIZES}
    assert {which: error for which, error in errors.items() if error >= LIMIT} == {}


@pytest.mark.slow
@pytest.mark.parametrize("muscle", MUSCLES)
def test_it_is_wrong_at_four_times_that_step(muscle: str) -> None:
    step = 4 * primitive(f"muscle/{muscle}").largest_step
    errors = [largest_error(trial, muscle, SIZES[size], step) for trial in TRIALS for size in SIZES]
    assert max(errors) > LIMIT
