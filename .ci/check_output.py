"""Check what `tribodyn run` has written: every file is there, every figure is finite."""

import json
import math
import sys
from pathlib import Path

FILES = ("case.toml", "summary.json", "mesh.nc", "response.nc", "report.html")
FIGURES = (
    "mesh_frequency",
    "mean_mesh_force",
    "rms_mesh_force",
    "mean_dynamic_transmission_error",
    "rms_acceleration_loa_pinion",
    "mean_friction_coefficient",
    "steady_state_error",
)


def main(folder: Path) -> int:
    """Return 0 when the output is whole.

    Parameters
    ----------
    folder : Path
        Output directory of a run.

    Returns
    -------
    int
        Exit code.
    """
    faults = [f"{name} is missing" for name in FILES if not (folder / name).is_file()]
    summary = {} if faults else json.loads((folder / "summary.json").read_text("utf-8"))
    faults += [f"summary has no {name}" for name in FIGURES if name not in summary]
    for name, value in summary.items():
        if isinstance(value, float) and not math.isfinite(value):
            faults.append(f"{name} = {value}")
    page = "" if faults else (folder / "report.html").read_text("utf-8")
    if not faults and not page.lstrip().lower().startswith("<!doctype html"):
        faults.append("report.html is no HTML page")
    for name in FIGURES:
        print(f"{name:40} {summary.get(name)}")
    for fault in faults:
        print(f"FAULT: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
