"""gaitsim optimize --adopt: the best values beside the spec, unless better ones are there."""

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
    """What became of --adopt: whether the file was written, and words that say so or why not."""

    written: bool
    words: str


def adopted(tuning: Tuning, request: Request, workplace: Workplace, progress: Progress, force: bool) -> Adoption:
    """Write the best values of a search beside its spec, unless the values there have a lower score.

    Raises:
        CannotSave: The folder cannot be written.
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
    """With which the command comes to this search again."""
    return ["--smoke" if request.smoke else "--resume", *request.words, *workplace.words]


def _reason(tuning: Tuning, path: Path, score: float) -> str:
    """Why a file of tuned values should stay; empty if there is none, or it is no better.

    A recorded score may be of another objective or another model, so the values there are simulated anew.
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
