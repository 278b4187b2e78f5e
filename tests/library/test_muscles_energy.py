"""Energy books of muscles: what the path takes up is in the tendon, or the fiber has it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from components.calls import primitive

from .muscle_rig import SIZES, trial

PENNATE = "    pennation_angle: 25 deg\n"
PENNATE_ONES = ("millard2012", "millard2012_polynomial", "degroote2016")
ELASTIC = ("geyer2003", "geyer2010", *PENNATE_ONES)


def tendon_energy(muscle: str, found: Any, size: Any) -> Any:
    """Elastic energy of the tendon alone at the first and the last instant, in J."""
    ends = [0, -1]
    if muscle.startswith("geyer"):
        return found["muscle.tendon_energy"][ends]
    kind = primitive(f"muscle/{muscle}")
    functions: dict[str, Any] = kind.cls.__dict__["output"].__func__.__globals__
    strains = found["muscle.tendon_strain_now"][ends]
    if muscle == "millard2012_polynomial":
        return size.force * size.tendon * np.array([functions["tendon_energy"](s) for s in strains])
    most = kind.parameters["tendon_strain"].default
    if muscle == "millard2012":
        return size.force * size.tendon * most * np.array([functions["tendon"](s / most)[1] for s in strains])
    stiffness = functions["tendon_stiffness"](most)
    return size.force * size.tendon * (found["muscle.normalized_force"][ends] / stiffness - 0.2 * strains)


@pytest.mark.parametrize("muscle", ELASTIC)
@pytest.mark.parametrize("size", ["SOL", "HFL"])
@pytest.mark.parametrize("name", ["lift", "active ramp"])
def test_work_of_the_path_is_that_of_fiber_and_tendon(muscle: str, size: str, name: str) -> None:
    pennate = muscle in PENNATE_ONES
    found = trial(name, muscle, SIZES[size], 2e-5, PENNATE if pennate else "")
    force = found["muscle.force"]
    along = np.cos(found["muscle.pennation"]) if pennate else 1.0
    # By the length, as the velocity of a ramp jumps; the fiber's is an output of the muscle.
    path = np.trapezoid(force, found["muscle.path.length"])
    fiber = np.trapezoid(force / along * found["muscle.fiber_velocity"], found.times)
    stored = tendon_energy(muscle, found, SIZES[size])
    turnover = np.abs(np.diff(found["muscle.path.length"]) * force[1:]).sum()
    assert turnover > 0.03 * SIZES[size].force * SIZES[size].fiber
    assert path == pytest.approx(fiber + stored[1] - stored[0], abs=1e-3 * turnover)


def test_pennate_work_without_a_tendon_that_yields() -> None:
    found = trial("active ramp", "rigid_tendon", SIZES["VAS"], 1e-4, PENNATE)
    along = np.cos(found["muscle.pennation"])
    fiber = found["muscle.force"] / along * found["muscle.fiber_velocity"]
    assert fiber == pytest.approx(found["muscle.force"] * found["muscle.path.velocity"], abs=1e-6)


def test_passive_fibers_on_a_stiff_tendon_conserve_energy() -> None:
    """Without activation only the parallel spring pulls: a weight bounces on it for ever."""
    off = "    activation_dynamics: {min_excitation: 0}\n"
    size = SIZES["SOL"]
    found = trial("lift", "rigid_tendon", size, 2e-5, off.replace("{", "{{").replace("}", "}}"), excitation=0)
    assert found["muscle.activation"].max() == 0
    mass = 0.3 * size.force / 9.81
    moving = 0.5 * mass * found["guide.velocity"] ** 2
    energy = found["muscle.elastic_energy"] + moving + mass * 9.81 * found["guide.position"]
    assert moving.max() > 1
    assert np.ptp(energy) < 1e-3 * moving.max()


@pytest.mark.parametrize("muscle", ["geyer2010", *PENNATE_ONES])
def test_a_muscle_at_rest_gives_no_energy(muscle: str) -> None:
    """At the least activation fibers only yield, at the declared step too."""
    size, step = SIZES["SOL"], primitive(f"muscle/{muscle}").largest_step
    found = trial("lift", muscle, size, step, excitation=0.01)
    mass = 0.3 * size.force / 9.81
    moving = 0.5 * mass * found["guide.velocity"] ** 2
    energy = found["muscle.elastic_energy"] + moving + mass * 9.81 * found["guide.position"]
    # The least activation may work a little: 1 % of F_max over the whole way.
    assert energy.max() - energy[0] < 0.02 * size.force * np.ptp(found["guide.position"])
    assert energy[-1] < energy[0]
