"""Matrices of a housing from files: NumPy archives and Matrix Market files."""

from __future__ import annotations

import io
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
        archive = _read("matrices", table.matrices, "a NumPy archive with K and M", _archive)
        missing = [name for name in ("K", "M") if name not in archive]
        if missing:
            why, remedy = f"It has: {', '.join(archive)}", "Save it by numpy.savez(K=.., M=..)"
            raise InputError(f"the file has no {missing[0]}", "matrices", why, remedy)
        matrices = {k: archive[n] for k, n in _MATRICES.items() if n in archive}
        names = [str(name) for name in archive.get("nodes", ())]
        return matrices, {name: list(range(6 * i, 6 * i + 6)) for i, name in enumerate(names)}
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


def _archive(file: io.BytesIO) -> dict[str, Array]:
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
