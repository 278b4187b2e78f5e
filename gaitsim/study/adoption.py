"""`gaitsim optimize --adopt`: writes the best values beside the spec, unless better ones are there."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.cluster.episodes import bundle_episodes
from gaitsim.errors import InvalidSpec
from gaitsim.results.store import CannotSave
from gaitsim.results.tuned import read_tuned, tuned_path, write_tuned

if TYPE_CHECKING:
    from gaitsim.optimization.search import Progress
    from gaitsim.study.searches import Request
    from gaitsim.study.tuning import Tuning
    from gaitsim.study.workplace import Workplace


@dataclass(frozen=True)
class Adoption:
    """The outcome of --adopt: whether the file was written, and a message about it."""

    written: bool
    message: str


def adopted(tuning: Tuning, request: Request, workplace: Workplace, progress: Progress, force: bool) -> Adoption:
    """Write the best values of a search beside its spec, unless the values there have a lower score.

    Args:
        tuning: The search.
        request: What was asked of it.
        workplace: Where it was evaluated.
        progress: Its final state.
        force: Whether to replace values that score better.

    Raises:
        CannotSave: The file cannot be written.
    """
    best = progress.best
    assert best is not None and best.verdict.score is not None
    spec = request.opening.path
    path, score = tuned_path(spec), best.verdict.score
    reason = "" if force else _reason(tuning, path, score)
    if reason:
        again = shlex.join(["gaitsim", "optimize", str(spec), *_options(request, workplace), "--adopt", "--force"])
        return Adoption(False, f"{path} is kept: {reason}. To replace it: {again}")
    values = dict(zip((f.address for f in tuning.model.free), best.candidate.x, strict=True))
    units = {f.address: f.unit for f in tuning.model.free}
    try:
        return Adoption(True, f"wrote {write_tuned(spec, str(tuning.folder), score, values, units)}")
    except OSError as error:
        reason = error.strerror or str(error)
        rule = f"the tuned values cannot be written ({reason}); they are saved in {tuning.folder}"
        raise CannotSave(f"{path}: {rule}.") from error


def _options(request: Request, workplace: Workplace) -> list[str]:
    """The options with which the command finds this search again."""
    return ["--smoke" if request.smoke else "--resume", *request.arguments, *workplace.arguments]


def _reason(tuning: Tuning, path: Path, score: float) -> str:
    """Why a file of tuned values is kept; empty if there is none, or if it is not better.

    The recorded score may belong to another objective or model, so the values in the file are simulated again.
    """
    if not path.exists():
        return ""
    try:
        values = read_tuned(path, tuning.model.free).values
    except InvalidSpec as error:
        return f"its values cannot be compared, as {error.faults[0].message.rstrip('.')}"
    x = tuning.model.started_at(values).start
    there = bundle_episodes(tuning.bundle, tuning.mode).verdict(x).score
    if there is None or there >= score:
        return ""
    return f"its values score {there:.6g} here, and the best of this search {score:.6g} (lower is better)"
