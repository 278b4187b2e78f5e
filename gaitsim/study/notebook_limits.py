"""What a notebook finds of a model: how far numbers can go, and its periodic gait."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.errors import Usage
from gaitsim.folders import results_folder
from gaitsim.study.listening import LogListener
from gaitsim.study.notebook import File, Settings, opening

if TYPE_CHECKING:
    from gaitsim.simulation.run import Mode
    from gaitsim.study.cycles import Cycle
    from gaitsim.study.limits import LimitRuns


def limit(
    path: File,
    vary: Mapping[str, str] | None = None,
    set: Settings | None = None,
    *,
    over: Mapping[str, str] | None = None,
    resume: bool = False,
    until: str | None = None,
    tolerance: float | None = None,
    points: int | None = None,
    mode: Mode | None = None,
    save: bool = True,
    results: File | None = None,
    origin: str | None = None,
    candidate: str | None = None,
    start: bool = False,
    trust: bool = False,
    library: Sequence[File] = (),
) -> LimitRuns:
    """Find how far numbers can be varied before a run fails, each number alone.

    Args:
        path: A spec, or a result folder.
        vary: Ranges by address; the first end must succeed: `{"push.strength": "0 N:1000 N"}`.
        set: Values by address.
        over: Values of one other number, at each of which the limits are found: `{"push.azimuth": "0 deg:330 deg:12"}`.
        resume: Whether to continue the limits that the result at `path` began; leave out all that it says itself.
        until: METRIC=VALUE that ends a range; None for a run that does not complete.
        tolerance: The precision, as a share of the range; None for 0.01.
        points: The number of values in the scan, both ends included; None for 9.
        mode: "rapid" or "normal"; None for rapid.
        save: Whether to save a result folder.
        results: The folder of results, in which names are looked up too; None for $GAITSIM_RESULTS, or else results.
        origin: A result whose best values are the start, as for `--from`.
        candidate: The candidate of a result.
        start: Whether to ignore tuned values beside the spec.
        trust: Whether to run components of a result that this machine does not know.
        library: Folders of more components.

    Returns:
        The limits: `limits`, each with `address`, `beside` (the value of `over`), `last` (succeeds), `first` (fails;
            None if all succeed) and `beyond`; `rows` has every run.
    """
    from gaitsim.study.new_limits import new_or_resumed

    opened = opening(path, set, library, start, trust, candidate, results)
    ranges = [f"{address}={ends}" for address, ends in vary.items()] if vary is not None else None
    at = [f"{address}={values}" for address, values in (over or {}).items()]
    if len(at) > 1:
        raise Usage(f"over={dict(over or {})}: limits are found over one number; give one of them to set.")
    asked = {
        "vary": ranges,
        "over": at[0] if at else None,
        "until": until,
        "tolerance": tolerance,
        "points": points,
        "mode": mode,
        "from": origin,
    }
    root = results_folder(None if results is None else Path(results)) if save else None
    runs = new_or_resumed(opened, asked, resume, root, LogListener())
    runs.run(LogListener())
    if runs.saver.error:
        raise runs.saver.error
    return runs


def cycle(
    path: File,
    set: Settings | None = None,
    *,
    mode: Mode = "rapid",
    results: File | None = None,
    candidate: str | None = None,
    start: bool = False,
    trust: bool = False,
    library: Sequence[File] = (),
) -> Cycle:
    """Find the periodic gait of a model near its start, and the eigenvalues of its return map.

    Args:
        path: A spec, or a result folder.
        set: Values by address.
        mode: "rapid" or "normal".
        results: The folder in which names of results are looked up; None for $GAITSIM_RESULTS, or else results.
        candidate: The candidate of a result.
        start: Whether to ignore tuned values beside the spec.
        trust: Whether to run components of a result that this machine does not know.
        library: Folders of more components.

    Returns:
        The gait: `start`, `period`, `metrics`, `eigenvalues`, `slopes` and `stable`.
    """
    from gaitsim.study.cycles import cycle as found

    log = LogListener()
    return found(opening(path, set, library, start, trust, candidate, results), mode, log, log.progress(""))
