"""`gaitsim.cohort`: one spec with many bodies and many devices, for notebooks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.folders import results_folder
from gaitsim.study.listening import LogListener
from gaitsim.study.notebook import File, Settings, opening, ranges

if TYPE_CHECKING:
    from gaitsim.simulation.run import Mode
    from gaitsim.study.cohorts import CohortRuns


def cohort(
    path: File,
    bodies: File | None = None,
    set: Settings | None = None,
    *,
    vary: Mapping[str, str | Sequence[Any]] | None = None,
    retune: int = 0,
    metrics: Sequence[str] = (),
    seed: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    scheduler_file: File | None = None,
    mode: Mode = "rapid",
    resume: bool = False,
    save: bool = True,
    results: File | None = None,
    start: bool = False,
    trust: bool = False,
    library: Sequence[File] = (),
) -> CohortRuns:
    """Run a spec for each body of a table and each value of a device.

    Args:
        path: A spec; with `resume` the result folder of a cohort.
        bodies: A CSV file with a row for each body; not used with `resume`.
        set: Values by address, for all rows.
        vary: Values for every body, by address: a list, or a range such as "0 N m/rad:240 N m/rad:5".
        retune: The number of evaluations to tune a row that does not complete.
        metrics: The metrics to draw.
        seed: The seed of each search; None for that of the spec.
        workers: The number of processes; 0 uses this process, None all cores.
        scheduler: The address of a Dask scheduler to use instead, such as "tcp://127.0.0.1:8786".
        scheduler_file: A file written by the scheduler.
        mode: "rapid" or "normal".
        resume: Whether to continue a result.
        save: Whether to save a result folder.
        results: The folder of results, in which names are looked up too; None for $GAITSIM_RESULTS, or else results.
        start: Whether to ignore tuned values beside the spec.
        trust: Whether to run components of a result that this machine does not know.
        library: Folders of more components.

    Returns:
        The rows: `table()` (also `table.csv` in `folder`), `counts` of how they ended, `found` by row.
    """
    from gaitsim.errors import Usage
    from gaitsim.study.cohorts import CohortRequest, cohort_runs, resumed_cohort
    from gaitsim.study.workplace import Workplace

    opened = opening(path, set, library, start, trust, results=results)
    file = None if scheduler_file is None else Path(scheduler_file)
    workplace = Workplace(workers, scheduler is not None or file is not None, scheduler, file)
    workplace.check()
    if resume:
        runs = resumed_cohort(opened)
    elif bodies is None:
        raise Usage("there is no table of bodies; name one, or resume a result.")
    else:
        root = results_folder(None if results is None else Path(results)) if save else None
        asked = CohortRequest(Path(bodies), ranges(vary), retune, seed, metrics)
        runs = cohort_runs(opened, asked, mode, root)
    runs.run(workplace, LogListener())
    if runs.saver.error:
        raise runs.saver.error
    return runs
