"""The export formats of signals, with one entry each in `FORMATS`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray

    from gaitsim.simulation.outcome import Trajectory


@dataclass(frozen=True)
class Export:
    """The run to export.

    Attributes:
        name: The name of the model.
        trajectory: Its signals in SI.
        dataset: Makes the same as labelled arrays with metadata of the run.
    """

    name: str
    trajectory: Trajectory
    dataset: Callable[[], xarray.Dataset]


@dataclass(frozen=True)
class Format:
    """An export format; `ending` is its name and the ending of its files."""

    ending: str
    description: str
    write: Callable[[Path, Export], None]


def _sto(path: Path, export: Export) -> None:
    from gaitsim.exchange.sto import write_sto

    write_sto(path, export.trajectory, export.name)


def _csv(path: Path, export: Export) -> None:
    from gaitsim.exchange.csv import write_csv

    write_csv(path, export.trajectory)


def _netcdf(path: Path, export: Export) -> None:
    from gaitsim.exchange.labelled import write_netcdf

    write_netcdf(path, export.dataset())


_FORMATS = (Format("sto", "OpenSim storage", _sto), Format("csv", "CSV", _csv), Format("nc", "netCDF", _netcdf))
FORMATS = {format.ending: format for format in _FORMATS}
