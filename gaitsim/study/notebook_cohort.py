"""`gaitsim.cohort`: one spec over many bodies and many devices, for a notebook."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.folders import results_folder
from gaitsim.study.listening import Logged
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
        bodies: A CSV file with a row for each body; none with `resume`.
        set: Values by address, for all rows.
        vary: Values for every body, by address: a list, or a range such as "0 N m/rad:240 N m/rad:5".
        retune: Evaluations that a row may take to be tuned again if it does not complete.
        metrics: What is drawn.
        seed: Of each search; None for the spec's.
        workers: Processes of this machine; 0 for this one, None for all cores.
        scheduler: A Dask scheduler to use instead, such as "tcp://127.0.0.1:8786".
        scheduler_file: A file that it wrote.
        mode: rapid or normal.
        resume: Continue what a result began.
        save: Whether a result folder is kept.
        results: Where result folders go, and names are looked up; None for $GAITSIM_RESULTS, or else results.
        start: Ignore tuned values beside the spec.
        trust: Run components of a result that this machine does not know.
        library: More folders of components.

    Returns:
        The rows: `table()` (also `table.csv` in `folder`), `counts` of how they ended, `found` by row.

    Raises:
        GaitsimError: The spec, the table or an argument is wrong, nothing can be kept, or a cluster cannot be reached.
    """
    from gaitsim.errors import Usage
    from gaitsim.study.cohorts import Asked, cohort_runs, resumed_cohort
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
        asked = Asked(Path(bodies), ranges(vary), retune, seed, metrics)
        runs = cohort_runs(opened, asked, mode, root)
    runs.run(workplace, Logged())
    if runs.keeping.error:
        raise runs.keeping.error
    return runs
