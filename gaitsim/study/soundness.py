"""The check of a spec: its models, their starts, moment arms, and convergence over steps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from collections.abc import Mapping as Map
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gaitsim.analysis.models.moment_arms import warnings
from gaitsim.cluster.episodes import episode_models
from gaitsim.components.bibliography import keys_of, read_bibliography, unknown_key
from gaitsim.errors import Fault
from gaitsim.simulation.moment_arms import moment_arms
from gaitsim.simulation.run import Simulator
from gaitsim.spec.study import variants
from gaitsim.study.known import Compared, compared
from gaitsim.study.records import BadRecord, Value, read_record
from gaitsim.study.starts import Starts

if TYPE_CHECKING:
    from gaitsim.analysis.models.step_convergence import StepConvergence
    from gaitsim.components.find import Library
    from gaitsim.model import Model
    from gaitsim.simulation.moment_arms import MomentArm
    from gaitsim.spec.study import Variant
    from gaitsim.study.listening import Listener
    from gaitsim.study.opening import Opening


@dataclass(frozen=True)
class Soundness:
    """What a check found in a valid spec.

    Attributes:
        rows, models: Those of its study; one without a study.
        notices: Notices for the user.
        warnings: Unusual findings.
        arms: The moment arm of each path about each hinge.
        known: Values that it should reproduce, with those of its record.
        convergence: For each model, the changes with a half and a quarter of the step.
    """

    rows: Sequence[Variant]
    models: Sequence[Model]
    notices: Sequence[str]
    warnings: Sequence[Fault]
    arms: Sequence[MomentArm]
    known: Sequence[Compared]
    convergence: Sequence[StepConvergence]

    def __repr__(self) -> str:
        return f"<Soundness of {self.models[0]}: {len(self.warnings)} warnings, {len(self.notices)} notices>"


def checked(opening: Opening, convergence: bool, listener: Listener) -> Soundness:
    """Resolve and compile a spec or result.

    Args:
        opening: The spec or result.
        convergence: Whether to simulate it at its step, a half and a quarter.
        listener: Receives notices.

    Raises:
        InvalidSpec: With all faults.
        InvalidComponent: A component file breaks the contract.
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
        Usage: The request does not fit.
    """
    opened = opening.open()
    rows = variants(opened.document, [])
    models = [opened.model(row.document) for row in rows]
    starts = Starts(opened)
    for each in (*models, *episode_models(opened.document, opened.library, opened.name)):
        starts.look_at(Simulator(each))
    notices = [*opened.notices, *models[0].notices]
    for notice in notices:
        listener.say(notice)
    arms = moment_arms(models[0])
    unusual = [*starts.unusual, *warnings(models[0], arms), *_unknown_sources(models[0], opened.library)]
    for one in unusual:
        listener.say(f"warning: {one}")
    with listener.waiting("simulating"):
        found = _convergence_of(models, listener) if convergence else []
    return Soundness(rows, models, notices, unusual, arms, compared(models[0].reproduces, _recorded(opening)), found)


def _unknown_sources(model: Model, library: Library) -> Iterator[Fault]:
    """Sources of known values that are not in the bibliography."""
    keys = set(read_bibliography(library.folders)) if model.reproduces else set()
    for known in model.reproduces:
        for key in keys_of(known.source):
            if key not in keys:
                yield Fault(unknown_key(key, keys), known.mark, "reproduces")


def _recorded(opening: Opening) -> Map[str, Value]:
    """The recorded numbers of the first run; none for a result, for a spec with settings, and without a record."""
    if opening.names_result or opening.settings:
        return {}
    try:
        return read_record(opening.path).runs[0].numbers
    except BadRecord:
        return {}


def _convergence_of(models: Sequence[Model], listener: Listener) -> list[StepConvergence]:
    """The convergence of each model over its step, a half and a quarter. Failed runs are reported."""
    from gaitsim.analysis.models.step_convergence import step_convergence

    found = []
    for model in models:
        found.append(step_convergence(model))
        for step, outcome in zip(found[-1].steps, found[-1].outcomes, strict=True):
            if outcome.status == "failed":
                listener.say(f"at a step of {_milliseconds(step)}: failed: {outcome.reason}")
    return found


def _milliseconds(step: float) -> str:
    return f"{1e3 * step:.4g} ms"
