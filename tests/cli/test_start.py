"""A command that simulates imports what simulating needs, and nothing else: it is waited for many times a day."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from .commands import gaitsim

SPEC = Path(__file__).resolve().parents[2] / "specs" / "hopping_geyer2003.yaml"
UNNEEDED = {
    *("PIL", "cma", "dask", "distributed", "glfw", "h5netcdf", "h5py", "imageio_ffmpeg", "jinja2", "matplotlib"),
    *("numba", "pandas", "pymoo", "scipy", "xarray"),
}


def test_a_run_imports_nothing_that_it_does_not_need(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert gaitsim(capsys, "run", str(SPEC), "--set", "simulate.duration=1 ms").code == 0  # it is compiled by now
    code = (
        "import sys\n"
        "from gaitsim.cli.main import main\n"
        f"try: main(['run', {str(SPEC)!r}, '--set', 'simulate.duration=1 ms'])\n"
        "except SystemExit as ended: print(ended.code, *sys.modules, file=sys.stderr)"
    )
    ran = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    code_of_exit, *modules = ran.stderr.splitlines()[-1].split()
    assert code_of_exit == "0"
    assert {module.partition(".")[0] for module in modules} & UNNEEDED == set()
