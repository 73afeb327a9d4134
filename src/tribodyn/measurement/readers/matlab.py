"""MAT files: vectors, matrices and structures of them, of every version."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.measurement.readers.content import Content, from_arrays


def content(path: Path) -> Content:
    """Channels of a MAT file."""
    with open(path, "rb") as file:
        head = file.read(128)
    if head.startswith(b"MATLAB 7.3"):
        from tribodyn.measurement.readers.binary import (
            hdf5,  # which reads plain arrays by this module
        )

        return hdf5(path)
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabOpaque

    held = loadmat(path, squeeze_me=True, struct_as_record=True)
    named = {name: value for name, value in held.items() if not name.startswith("__")}
    if any(isinstance(value, MatlabOpaque) for value in held.values()) or "None" in named:
        raise InputError(
            Problem(
                "holds a table, timetable or other object of MATLAB",
                str(path),
                "MATLAB keeps how these are written to itself",
                'In MATLAB: s = table2struct(T, "ToScalar", true); save("s.mat", "-struct", "s")',
            )
        )
    return from_arrays(_flat(named), path)


def _flat(named: dict[str, Any], before: str = "", depth: int = 0) -> dict[str, Any]:
    """Structures as names with points."""
    found: dict[str, Any] = {}
    for name, value in named.items():
        fields = getattr(getattr(value, "dtype", None), "names", None)
        if fields and np.ndim(value) == 0 and depth < 8:
            inner = {each: value[each].item() for each in fields}
            found |= _flat(inner, f"{before}{name}.", depth + 1)
        else:
            found[before + name] = value
    return found
