"""MAT files: vectors, matrices, cells and structures of them, of every version."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.measurement.readers.content import Content, from_arrays

#: Objects that hold channels; other ones, such as strings, are left out.
_TABLES = ("table", "timetable", "")
_DEEPEST = 8


def content(path: Path) -> Content:
    """Channels of a MAT file."""
    with open(path, "rb") as file:
        head = file.read(128)
    if head.startswith(b"MATLAB 7.3"):
        from tribodyn.measurement.readers.binary import hdf5  # which refuses tables as we do

        return hdf5(path)
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabOpaque

    held = loadmat(path, squeeze_me=True, struct_as_record=True)
    named: dict[str, Any] = {}
    for name, value in held.items():
        if isinstance(value, MatlabOpaque) or name == "None":
            kinds = value["s2"].reshape(-1).tolist() if value.dtype.names else [""]
            refuse_table(kinds[0], path)
        elif not name.startswith("__"):
            named |= dict(_flat(name, value))
    return from_arrays(named, path)


def refuse_table(kind: Any, path: Path) -> None:
    """Tell what to do with a table or timetable of MATLAB; other objects hold no channel."""
    told = kind.decode("ascii", "replace") if isinstance(kind, bytes) else str(kind)
    if told not in _TABLES:
        return
    raise InputError(
        Problem(
            "holds a table, timetable or other object of MATLAB",
            str(path),
            "MATLAB keeps how these are written to itself",
            'In MATLAB: s = table2struct(T, "ToScalar", true); save("s.mat", "-struct", "s")',
        )
    )


def _flat(name: str, value: Any, depth: int = 0) -> Iterator[tuple[str, Any]]:
    """Structures as names with points, items of arrays of them and of cells by their number."""
    kind = getattr(value, "dtype", np.dtype(float))
    fields = kind.names
    if not (fields or kind.kind == "O") or depth > _DEEPEST:
        yield name, value
        return
    for number, item in enumerate(np.asarray(value).reshape(-1), 1):
        if fields:
            place = name if value.size == 1 else f"{name}({number})"
            for each in fields:
                yield from _flat(f"{place}.{each}", item[each], depth + 1)
        else:
            yield from _flat(f"{name}{{{number}}}", item, depth + 1)
