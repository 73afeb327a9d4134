"""Matrices of a housing from files: NumPy archives and Matrix Market files."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.machine import Housing
from tribodyn.study.case.values import KeyedProblems, Plain
from tribodyn.study.machine.read_parts import built, table_of
from tribodyn.study.machine.tables import HousingTable
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study.machine.case import MachineCase

_MATRICES = {"stiffness": "K", "mass": "M", "damping": "C"}
_NODES = "Write [housing.nodes] with six coordinate numbers a node, counted from 0, -1 at rest"


def read_housing(body: Any, problems: KeyedProblems) -> Housing | None:
    """Housing of the ``[housing]`` table; None without one."""
    if body is None:
        return None
    count = len(problems)
    nodes = dict(body.get("nodes", {})) if isinstance(body, Mapping) else {}
    inner = {k: v for k, v in body.items() if k != "nodes"} if isinstance(body, Mapping) else body
    table = table_of(HousingTable, inner, "housing", problems)
    if len(problems) > count:
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
        with _opened("matrices", table.matrices) as archive:
            missing = [name for name in ("K", "M") if name not in archive]
            if missing:
                why, remedy = f"It has: {', '.join(archive)}", "Save it by numpy.savez(K=.., M=..)"
                raise InputError(f"the file has no {missing[0]}", "matrices", why, remedy)
            matrices = {k: np.asarray(archive[n]) for k, n in _MATRICES.items() if n in archive}
            names = [str(name) for name in archive["nodes"]] if "nodes" in archive else []
        return matrices, {name: list(range(6 * i, 6 * i + 6)) for i, name in enumerate(names)}
    files = {name: getattr(table, f"{name}_file") for name in _MATRICES}
    paths = {name: path for name, path in files.items() if path is not None}
    absent = [name for name in ("stiffness", "mass") if name not in paths]
    if absent:
        why = "A housing has a stiffness and a mass matrix"
        remedy = 'Give matrices = "housing.npz", or stiffness_file and mass_file'
        raise InputError(f"{absent[0]}_file is missing", f"{absent[0]}_file", why, remedy)
    return {name: _market(f"{name}_file", path) for name, path in paths.items()}, {}


def _opened(key: str, path: str) -> Any:
    try:
        return np.load(path, allow_pickle=False)
    except (OSError, ValueError) as error:
        what = f"{Path(path).name} cannot be read: {error}"
        remedy = "Give a file written by numpy.savez"
        raise InputError(what, key, "It is a NumPy archive with K and M", remedy) from None


def _market(key: str, path: str) -> Array:
    from scipy.io import mmread

    try:
        matrix = mmread(path)
    except (OSError, ValueError) as error:
        what = f"{Path(path).name} cannot be read: {error}"
        raise InputError(what, key, "It is a Matrix Market file", "Check the file") from None
    return np.asarray(matrix.toarray() if hasattr(matrix, "toarray") else matrix, dtype=float)


def copy_housing(case: MachineCase, folder: Path, prefix: str) -> MachineCase:
    """Copy the files of a housing into a folder, and return the case that refers to the copies."""
    moved = case.with_files(prefix)
    for key, path in case.housing_files.items():
        target = folder / moved.housing_files[key]
        if target.resolve() != Path(path).resolve():
            shutil.copyfile(path, target)
    return moved
