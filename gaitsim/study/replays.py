"""Replays of opened specs and results, with notices about them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from gaitsim.analysis.replays.replay import Replay, replayed
from gaitsim.results.manifest import changed_versions
from gaitsim.results.store import row_data
from gaitsim.study.opened import Opened
from gaitsim.study.starts import Starts
from gaitsim.study.verify import differences


def replay_of(opened: Opened, path: Path, label: str = "", duration: float | None = None) -> Replay:
    """Run an opened spec or result once more with every signal.

    Notices report other versions, a search that has not ended, and numbers that differ from the record.

    Args:
        opened: The spec or result.
        path: Its path.
        label: Its name in figures.
        duration: In s; that of the spec by default.

    Raises:
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
    """
    model, starts = opened.model(), Starts(opened)
    manifest = dict(opened.manifest)
    made = replayed(
        model,
        path,
        label or (path.name if manifest else path.stem),
        manifest,
        duration=duration,
        prepared=starts.look_at,
    )
    notices = [*opened.notices, *model.notices, *starts.warnings]
    changed = changed_versions(manifest) if manifest else []
    if changed:
        notices.append(f"{path} was made with other versions ({', '.join(changed)})")
    if manifest and manifest["status"] != "complete":
        notices.append(f"{path} is not complete: its search is {manifest['status']}")
    if opened.recorded and duration is None:
        found = differences(opened.recorded, row_data({}, made.outcome))
        if found:
            notices.append(f"the replay of {path} differs from its record: {'; '.join(found[:3])}")
    return replace(made, notices=tuple(notices))
