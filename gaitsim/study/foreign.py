"""Files of other programs given instead of a spec: what they are, and what to do."""

from __future__ import annotations

from pathlib import Path

from gaitsim.errors import Fault, InvalidSpec, Mark

_BEGIN = "write the model as a spec: gaitsim new FOLDER makes one to begin with"
_TABLE = (
    "gaitsim simulates specs; to compare with recorded curves, put them into a table such as "
    "library/norms/fukuchi2018_walking.csv and name it in measure/gait_curve"
)
_FORMATS = {
    ".osim": ("an OpenSim model", _BEGIN),
    ".xml": ("XML, such as a model of MuJoCo or OpenSim", _BEGIN),
    ".mjcf": ("a MuJoCo model", _BEGIN),
    ".urdf": ("a robot description", _BEGIN),
    ".hfd": ("a Hyfydy model", _BEGIN),
    ".scone": ("a SCONE scenario", _BEGIN),
    ".par": ("a set of SCONE parameters", "set values in a spec, or with --set"),
    ".sto": ("an OpenSim storage file: results over time", _TABLE),
    ".mot": ("an OpenSim motion file: coordinates or forces over time", _TABLE),
    ".trc": ("a file of marker positions over time", _TABLE),
    ".c3d": ("a file of motion capture", _TABLE),
    ".csv": ("a table of numbers", _TABLE),
    ".nc": ("a netCDF file of numbers", _TABLE),
}


def refuse_foreign(path: Path) -> None:
    """Refuse a file of another program where a spec is needed.

    Raises:
        InvalidSpec: The name of the file ends like those of a known other format.
    """
    known = _FORMATS.get(path.suffix.lower())
    if known is not None and path.is_file():
        what, move = known
        raise InvalidSpec(Fault(f"this is {what}, and a spec is a YAML file; {move}.", Mark(str(path))))
