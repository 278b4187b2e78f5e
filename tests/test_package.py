"""The package for a stranger: what it needs, what it says of itself, and the wheel in a folder of its own."""

from __future__ import annotations

import ast
import json
import os
import pickle
import re
import shutil
import site
import subprocess
import sys
import tomllib
import zipfile
from importlib import metadata
from pathlib import Path

import pytest
import yaml

import gaitsim
from gaitsim.cluster.evaluate import runner_of
from gaitsim.study.opening import Opening

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PARTS = ("gaitsim", "library", "specs", "pyproject.toml", "README.md", "LICENSE")


def distribution(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def needed(requirement: str) -> str:
    """The distribution of a requirement such as dask[distributed]>=2025.1; empty if it is for an extra."""
    if "extra ==" in requirement:
        return ""
    found = re.match(r"[A-Za-z0-9._-]+", requirement)
    assert found
    return distribution(found[0])


def closure(names: set[str]) -> set[str]:
    """Distributions and all that they need, as far as they are installed here."""
    known: set[str] = set()
    todo = list(names)
    while todo:
        name = todo.pop()
        if name in known:
            continue
        known.add(name)
        try:
            todo += [inner for inner in map(needed, metadata.requires(name) or []) if inner]
        except metadata.PackageNotFoundError:
            continue
    return known


def imported() -> set[str]:
    """Modules from elsewhere that gaitsim imports."""
    found: set[str] = set()
    for path in (ROOT / "gaitsim").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                found |= {alias.name.partition(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                found.add(node.module.partition(".")[0])
    return found - set(sys.stdlib_module_names) - {"gaitsim"}


def test_all_that_is_imported_is_asked_for() -> None:
    asked = {needed(text) for text in PROJECT["dependencies"]} | {"distributed"}
    extras = {needed(text) for text in PROJECT["optional-dependencies"]["populations"]}
    installed = closure(asked | extras)
    homes = metadata.packages_distributions()
    missing = {m for m in imported() if not {distribution(d) for d in homes.get(m, [m])} & installed}
    assert missing == set()


def worker_packages() -> set[str]:
    """What the page on clusters tells to install on a worker."""
    page = (ROOT / "docs" / "how-to" / "cluster.md").read_text(encoding="utf-8")
    (line,) = re.findall(r"^ *pip install (?!--no-deps)(.+)$", page, re.MULTILINE)
    return {needed(word.strip('"')) for word in line.split()}


WORKER = """
import json, pickle, sys
from pathlib import Path

absent = set(json.loads(sys.argv[1]))


class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in absent:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


sys.meta_path.insert(0, Absent())
from gaitsim.cluster.evaluate import runner_of
import gaitsim.cluster.worker

model, values = pickle.loads(Path(sys.argv[2]).read_bytes())
print(json.dumps(runner_of(model, "rapid").verdict(values).metrics))
"""


def test_a_worker_runs_with_the_packages_that_the_page_on_clusters_lists(tmp_path: Path) -> None:
    listed = worker_packages()
    assert listed <= {needed(text) for text in PROJECT["dependencies"]}
    installed = closure(listed | {"distributed"})
    analysis = {"h5netcdf", "h5py", "imageio-ffmpeg", "jinja2", "matplotlib", "pandas", "pillow", "xarray"}
    assert not listed & (analysis | {"rich", "typer", "cma"})
    homes = metadata.packages_distributions()
    present = installed | {"gaitsim"}
    absent = [module for module, found in homes.items() if not {distribution(name) for name in found} & present]
    opened = Opening(ROOT / "specs" / "pendulum_pid.yaml", ("simulate.duration=100 ms",), tuned=False).open()
    model = opened.bundle([opened.model()])
    values = [free.start for free in opened.model().free]
    (tmp_path / "candidate").write_bytes(pickle.dumps((model, values)))
    words = [sys.executable, "-c", WORKER, json.dumps(absent), str(tmp_path / "candidate")]
    ran = subprocess.run(words, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout) == runner_of(model, "rapid").verdict(values).metrics


def test_the_citation_file_tells_of_this_version() -> None:
    told = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors"} <= set(told)
    assert told["version"] == gaitsim.__version__
    assert told["license"] == PROJECT["license"] == "Apache-2.0"
    assert "Apache License" in (ROOT / "LICENSE").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel of a copy of what is packaged."""
    source, made = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("wheel")
    for name in PARTS:
        place = ROOT / name
        if place.is_dir():
            shutil.copytree(place, source / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(place, source / name)
    words = ["wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", str(made), str(source)]
    subprocess.run([sys.executable, "-m", "pip", *words], check=True, stdin=subprocess.DEVNULL)
    (found,) = made.glob("*.whl")
    return found


@pytest.fixture(scope="module")
def stranger(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The gaitsim of an environment that has the wheel, and what it needs from here; not this checkout."""
    home = tmp_path_factory.mktemp("stranger")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(home / "venv")], check=True)
    folder = next((home / "venv" / "lib").glob("python*")) / "site-packages"
    # A .pth in a folder that a .pth names is not read: so the editable gaitsim stays outside.
    (folder / "needed.pth").write_text("\n".join(site.getsitepackages()), encoding="utf-8")
    words = ["install", "--quiet", "--no-deps", "--no-index", "--target", str(folder), str(wheel)]
    subprocess.run([sys.executable, "-m", "pip", *words], check=True, stdin=subprocess.DEVNULL)
    command = home / "gaitsim"
    python = home / "venv" / "bin" / "python"
    command.write_text(f'#!/bin/sh\nexec {python} -m gaitsim.cli.main "$@"\n', encoding="utf-8")
    command.chmod(0o755)
    return command


def asked(command: Path, folder: Path, *words: str) -> str:
    kept = {name: os.environ[name] for name in ("HOME", "PATH", "GAITSIM_CACHE") if name in os.environ}
    ran = subprocess.run([command, *words], cwd=folder, env=kept, capture_output=True, text=True)
    assert ran.returncode == 0, f"{words}: {ran.stdout}\n{ran.stderr}"
    return ran.stdout


def test_the_wheel_has_library_specs_and_licence_and_no_litter(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as packed:
        names = set(packed.namelist())
        about = packed.read(next(n for n in names if n.endswith("/METADATA"))).decode()
    for folder in ("library", "specs"):
        here = {p for p in (ROOT / folder).rglob("*") if p.is_file() and "__pycache__" not in p.parts}
        assert {f"gaitsim/shipped/{p.relative_to(ROOT)}" for p in here} <= names
    assert not [name for name in names if "__pycache__" in name or name.startswith(("tests", "results", "bench"))]
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert "gaitsim/py.typed" in names
    assert "License-Expression: Apache-2.0" in about
    assert "Project-URL" not in about


@pytest.mark.slow
def test_from_the_wheel_to_a_first_result(stranger: Path, tmp_path: Path) -> None:
    assert "shipped" in json.loads(asked(stranger, tmp_path, "library", "show", "muscle/geyer2010", "--json"))["file"]
    asked(stranger, tmp_path, "new", "slope", "--from", "walking_geyer2010_slope")
    assert (tmp_path / "slope" / "walking_geyer2010.tuned.yaml").is_file()
    assert asked(stranger, tmp_path, "archive", "check", "pendulum_pid") == "1 of 1 models do what was recorded\n"
    asked(stranger, tmp_path, "new", "demo")
    demo, spec = tmp_path / "demo", "my_hopping_leg_mass.yaml"
    ran = json.loads(asked(stranger, demo, "run", spec, "--json"))
    assert ran["status"] == "completed" and ran["metrics"]["hop"] > 0.1
    searched = json.loads(asked(stranger, demo, "optimize", spec, "--smoke", "--workers", "1", "--json"))
    assert searched["failed"] == 0
    analyzed = json.loads(asked(stranger, demo, "analyze", searched["result"], "--json"))
    assert (demo / analyzed["report"]).is_file()
    assert asked(stranger, demo, "library", "check", "components") == "1 component: valid\n"
    assert "@software{gaitsim," in asked(stranger, demo, "cite", spec)
