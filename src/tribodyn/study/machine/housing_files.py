"""Matrices of a housing from files: NumPy archives, Matrix Market and Nastran punch files."""

from __future__ import annotations

import io
import re
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.machine import Housing
from tribodyn.study.case.values import KeyedProblems, Plain
from tribodyn.study.machine.read_parts import built, is_faulty
from tribodyn.types import Array
from tribodyn.validated_files import read_bytes

if TYPE_CHECKING:
    from tribodyn.study.case.case_data import BaseCase

Kind = TypeVar("Kind", bound="BaseCase")
_MATRICES = {"stiffness": "K", "mass": "M", "damping": "C"}
#: Before the names of the files of the housing in the folder of a result.
HOUSING = "housing-"
#: Rows of a matrix in a file, at most.
_MOST = 10_000
#: Units of length, mass and time of punch files, and how many of the length a metre has.
_UNITS = {"m-kg-s": 1.0, "mm-t-s": 1e3}
_NODES = "Write [housing.nodes] with six coordinate numbers a node, counted from 0, -1 at rest"


def read_housing(table: Any, problems: KeyedProblems) -> Housing | None:
    """Housing of the ``[housing]`` table; None without one."""
    if table is None:
        return None
    nodes = table.nodes or {}
    if not isinstance(nodes, Mapping):
        problem = Problem("housing.nodes is not a table", "", "", _NODES)
        problems.append(("housing.nodes", problem))
    if is_faulty("housing", problems):
        return None
    try:
        matrices, stored_nodes = _read_files(table)
    except InputError as error:
        problems += [(f"housing.{problem.where}", problem) for problem in error.problems]
        return None
    nodes = {n: v.value if isinstance(v, Plain) else v for n, v in nodes.items()} or stored_nodes
    if not nodes:
        problems.append(("housing", Problem("the housing has no named nodes", "", "", _NODES)))
        return None
    part: Housing | None = built("housing", lambda: Housing(**matrices, nodes=nodes), problems)
    return part


def _read_files(table: Any) -> tuple[dict[str, Array], dict[str, list[int]]]:
    """Matrices by name, and the nodes of a NumPy archive."""
    if table.matrices is not None:
        kind = "a NumPy archive with K and M, or a Nastran punch file with DMIG entries"
        archive = _read("matrices", table.matrices, kind, _archive)
        if isinstance(archive, PunchFile):
            return _of_punch_file(archive, table.units)
        _refuse_units(table.units)
        missing = [name for name in ("K", "M") if name not in archive]
        if missing:
            why, remedy = f"It has: {', '.join(archive)}", "Save it by numpy.savez(K=.., M=..)"
            raise InputError(f"the file has no {missing[0]}", "matrices", why, remedy)
        matrices = {k: archive[n] for k, n in _MATRICES.items() if n in archive}
        names = [str(name) for name in archive.get("nodes", ())]
        return matrices, {name: list(range(6 * i, 6 * i + 6)) for i, name in enumerate(names)}
    _refuse_units(table.units)
    files = {name: getattr(table, f"{name}_file") for name in _MATRICES}
    paths = {name: path for name, path in files.items() if path is not None}
    absent = [name for name in ("stiffness", "mass") if name not in paths]
    if absent:
        why = "A housing has a stiffness and a mass matrix"
        remedy = 'Give matrices = "housing.npz", or stiffness_file and mass_file'
        raise InputError(f"{absent[0]}_file is missing", f"{absent[0]}_file", why, remedy)
    return {
        name: _read(f"{name}_file", path, "a Matrix Market file", _market)
        for name, path in paths.items()
    }, {}


def _read(key: str, path: str, kind: str, load: Callable[[io.BytesIO], Any]) -> Any:
    """Content of a regular file of limited size."""
    try:
        return load(io.BytesIO(read_bytes(path, "housing")))
    except Exception as error:  # readers of damaged files raise errors of many types
        what = f"{Path(path).name} cannot be read: {error}"
        raise InputError(what, key, f"It is {kind}", "Write the file again") from None


def _refuse_units(units: str | None) -> None:
    if units is not None:
        why, remedy = "Matrices of other files are in SI: N/m, N, N*m, kg", "Remove it"
        raise InputError(f'units = "{units}" has no effect here', "units", why, remedy)


def _of_punch_file(
    punched: PunchFile, units: str | None
) -> tuple[dict[str, Array], dict[str, list[int]]]:
    """Matrices in SI, and the six coordinates of each grid point, named by its number."""
    if units is None:
        why, remedy = "A punch file does not state its units", f"Write one of {', '.join(_UNITS)}"
        raise InputError("units is missing", "units", why, remedy)
    matrices, points = {}, punched.points()
    for name, letter in (("stiffness", "K"), ("mass", "M"), ("damping", "B")):
        named = [each for each in punched.matrices if each == f"{letter}AAX"]
        named = named or [n for n in punched.matrices if n[0] == letter and n[:2] != "K4"]
        if len(named) == 1:
            matrices[name] = punched.matrix(named[0], points)
        elif named or name != "damping":
            what = f"the file has {len(named) or 'no'} DMIG matrices of the {name}"
            why = f"Its matrices: {', '.join(punched.matrices) or 'none'}"
            remedy = f"Write one whose name begins with {letter}, such as {letter}AAX"
            raise InputError(what, "matrices", why, remedy)
    # the energy is the same with lengths in metres; coordinate 0 is a generalized one
    along = np.array([_UNITS[units] if 1 <= c <= 3 else 1.0 for _, c in points])
    scale = np.outer(along, along) / _UNITS[units]
    nodes: dict[str, list[int]] = {}
    for row, (point, component) in enumerate(points):
        if component:
            nodes.setdefault(str(point), [-1] * 6)[component - 1] = row
    return {name: matrix * scale for name, matrix in matrices.items()}, nodes


class PunchFile:
    """DMIG entries of a Nastran file: values by name and by both points and components."""

    # Entries have eight fields of 8 characters, four of 16 (``DMIG*``), or fields between commas:
    # NAME, column, component, a blank, then row, component, value, imaginary part. Source: entry
    # DMIG in the reference guides of Autodesk Nastran 2025 and Altair OptiStruct 2021.

    def __init__(self, text: str) -> None:
        self.matrices: dict[str, dict[tuple[tuple[int, int], tuple[int, int]], float]] = {}
        self.symmetric: dict[str, bool] = {}
        entry: list[str] | None = None
        for line in (*text.splitlines(), "END"):
            if not line.strip() or line.startswith("$"):
                continue
            head, *fields = _fields(line)
            if head in ("", "*") or head.startswith(("+", "*")):
                if entry is not None:
                    entry += fields
                continue
            if entry is not None:
                self._add(entry)
            entry = fields if head.rstrip("*") == "DMIG" else None

    def _add(self, fields: list[str]) -> None:
        name, column, component, kind, *entries = *fields, "", "", ""
        if column == "0":
            form, kind = int(component or 0), kind or "2"
            if form not in (1, 6) or kind not in ("1", "2"):
                raise ValueError(f"{name} is not a real square or symmetric matrix")
            self.matrices[name], self.symmetric[name] = {}, form == 6
            return
        if name not in self.matrices:
            raise ValueError(f"{name} has no header")
        at = int(column), int(component or 0)
        for row, its_component, value, _ in zip(*(entries[n::4] for n in range(4)), strict=False):
            if row:
                self.matrices[name][(int(row), int(its_component or 0)), at] = _number(value)

    def points(self) -> list[tuple[int, int]]:
        """Points and components of all matrices, in rising order."""
        listed = {p for values in self.matrices.values() for at in values for p in at}
        if len(listed) >= _MOST or not all(0 <= component <= 6 for _, component in listed):
            raise InputError("its components are not 0 to 6, or too many", "matrices")
        return sorted(listed)

    def matrix(self, name: str, points: list[tuple[int, int]]) -> Array:
        """One matrix with its rows and columns at these points."""
        rows = {point: number for number, point in enumerate(points)}
        matrix = np.zeros((len(rows), len(rows)))
        for (row, column), value in self.matrices[name].items():
            matrix[rows[row], rows[column]] = value
            if self.symmetric[name]:
                matrix[rows[column], rows[row]] = value
        return matrix


def _fields(line: str) -> list[str]:
    """Fields of a line of bulk data; the head and eight of 8 characters, or four of 16."""
    if "," in line:
        fields = [field.strip() for field in line.split(",")]
        return (fields + [""] * 9)[: 5 if "*" in fields[0] else 9]
    head = line[:8].strip().upper()
    width = 16 if "*" in head else 8
    return [head, *(line[n : n + width].strip() for n in range(8, 72, width))]


def _number(text: str) -> float:
    """Number as Nastran writes it: 1.5D+3, or without a letter 1.5+3."""
    return float(re.sub(r"(?<=[0-9.])(?=[+-])", "E", re.sub("[Dd]", "E", text)))


def _archive(file: io.BytesIO) -> dict[str, Array] | PunchFile:
    content = file.getvalue()
    if content[:2] != b"PK":
        return PunchFile(content.decode("ascii"))
    with np.load(file, allow_pickle=False) as archive:
        return {name: np.asarray(archive[name]) for name in archive.files}


def _market(file: io.BytesIO) -> Array:
    """Real matrix of a Matrix Market file; the reader of SciPy crashes on damaged ones."""
    head, *lines = file.read().decode("ascii").splitlines()
    _, _, layout, field, symmetry = head.lower().split()
    if field not in ("real", "integer") or symmetry not in ("general", "symmetric"):
        raise ValueError(f"it is {field} and {symmetry}, not real and general or symmetric")
    sizes, *rows = (line for line in lines if line.strip() and not line.startswith("%"))
    height, width, *count = map(int, sizes.split())
    if not 0 < max(height, width) < _MOST:
        raise ValueError(f"it has {height} x {width} entries")
    matrix, entries = np.zeros((height, width)), np.loadtxt(rows, ndmin=2)
    if layout == "coordinate":
        at = entries[:, :2].astype(int) - 1
        if entries.shape != (count[0], 3) or at.min() < 0:
            raise ValueError(f"it has {len(entries)} entries, not the {count[0]} of its head")
        np.add.at(matrix, tuple(at.T), entries[:, 2])
    elif symmetry == "symmetric":
        matrix[np.triu_indices(height)[::-1]] = entries[:, 0]
    else:
        matrix = entries.reshape(width, height).T
    return matrix + np.tril(matrix, -1).T if symmetry == "symmetric" else matrix


def copy_housing(case: Kind, folder: Path, prefix: str) -> Kind:
    """Copy the files of a housing into a folder, and return the case that refers to the copies."""
    moved = case.with_files(prefix)
    for key, path in case.housing_files.items():
        target = folder / moved.housing_files[key]
        if target.resolve() != Path(path).resolve():
            shutil.copyfile(path, target)
    return moved
