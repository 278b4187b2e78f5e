"""gaitsim projects: list the projects of a lab."""

from __future__ import annotations

import os
from pathlib import Path

from gaitsim.cli import console
from gaitsim.cli.options import Json


def projects(json: Json = False) -> None:
    """List the projects of the lab, from anywhere below it.

    Example: gaitsim projects
    """
    from gaitsim.study.projects import project_data
    from gaitsim.study.projects import projects as found

    rows = [project_data(project) for project in found(Path.cwd())]
    if json:
        console.give_json({"projects": rows})
        return
    columns = ["project", "author", "date", "from", "spec"]
    console.give_table(
        columns, [(r["name"], r["author"], r["date"], r["from"], os.path.relpath(r["spec"])) for r in rows]
    )
