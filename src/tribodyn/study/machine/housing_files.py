"""Matrices of a housing from files of NumPy, Matrix Market, Nastran, Abaqus and Ansys."""

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
    from tribodyn.study.case.case import Case

Kind = TypeVar("Kind", bound="Case")
Point = tuple[int, int]
_MATRICES = {"stiffness": "K", "mass": "M", "damping": "C"}
#: Before the names of the files of the housing in the folder of a result.
HOUSING = "housing-"
#: Rows of a matrix in a file, at most.
_MOST = 10_000
#: Degrees of freedom of a node as Ansys calls them.
_FREEDOMS = ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")
#: Units of length, mass and time of the files, and how many of the length a metre has.
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
    """Matrices in SI by name, and the nodes that the files name."""
    if table.matrices is not None:
        for name in ("stiffness_file", "mass_file", "damping_file", "mapping_file"):
            if getattr(table, name) is not None:
                why = "The file of matrices has all of the housing"
                raise InputError(
                    f"{name} and matrices are both given", name, why, "Remove one of both"
                )
        kind = "a NumPy archive, or a text file with Nastran DMIG entries or an Abaqus substructure"
        archive = _read("matrices", table.matrices, kind, _archive)
        if isinstance(archive, Superelement):
            return archive.in_si("matrices", table.units)
        if table.units is not None:
            why, remedy = "NumPy archives are in SI: N/m, N, N*m, kg", "Remove it"
            raise InputError(f'units = "{table.units}" has no effect here', "units", why, remedy)
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
    return _read_single_matrices(table, paths)


def _read_single_matrices(
    table: Any, paths: Mapping[str, str]
) -> tuple[dict[str, Array], dict[str, list[int]]]:
    """Matrices of files that hold one each."""
    kind = "a Matrix Market, Harwell-Boeing or Abaqus matrix file"
    read = {k: _read(f"{k}_file", path, kind, _single_matrix) for k, path in paths.items()}
    labelled = {k: m for k, m in read.items() if isinstance(m, Superelement)}
    mapping = table.mapping_file
    if labelled and (len(labelled) < len(read) or mapping is not None):
        key = "mapping_file" if mapping is not None else f"{min(set(read) - set(labelled))}_file"
        what = f"the file of the {min(labelled)} names its nodes, and {key} is of another kind"
        raise InputError(what, key, "All files are over the same coordinates", "Use one format")
    if labelled:
        return Superelement.of(labelled).in_si("stiffness_file", table.units)
    nodes = {} if mapping is None else _read("mapping_file", mapping, "an Ansys mapping", _mapping)
    supplied = {
        str(n): v.value if isinstance(v, Plain) else v for n, v in (table.nodes or {}).items()
    }
    if table.units is None and all(_is_market(path) for path in paths.values()):
        return read, nodes
    return _in_si(read, supplied or nodes, f"{min(read)}_file", table.units), nodes


def _read(key: str, path: str, kind: str, load: Callable[[io.BytesIO], Any]) -> Any:
    """Content of a regular file of limited size."""
    if Path(path).suffix.lower() == ".op2":
        why = "It is a binary file of Nastran, which no reader for NumPy 2 reads"
        remedy = "Write the matrices as DMIG entries: EXTSEOUT with DMIGPCH"
        raise InputError(f"{Path(path).name} cannot be read", key, why, remedy)
    try:
        return load(io.BytesIO(read_bytes(path, "housing")))
    except InputError:
        raise
    except Exception as error:  # readers of damaged files raise errors of many types
        what = f"{Path(path).name} cannot be read: {getattr(error, 'strerror', None) or error}"
        remedy = "Correct the path" if isinstance(error, OSError) else "Write the file again"
        raise InputError(what, key, f"It is {kind}", remedy) from None


def _in_si(
    matrices: Mapping[str, Array], nodes: Mapping[str, Any], key: str, units: str | None
) -> dict[str, Array]:
    """Matrices with the lengths of the nodes in metres and energies in joules."""
    if units is None:
        why = f"The file of {key} does not state its units"
        raise InputError("units is missing", "units", why, f"Write one of {', '.join(_UNITS)}")
    # a generalized coordinate may have any scale: the energies are those of the file
    along = np.ones(max(len(matrix) for matrix in matrices.values()))
    rows = [row for numbers in nodes.values() for row in tuple(numbers)[:3]]
    along[[row for row in rows if isinstance(row, int) and 0 <= row < len(along)]] = _UNITS[units]
    return {
        name: matrix * np.outer(along, along)[: len(matrix), : len(matrix)] / _UNITS[units]
        for name, matrix in matrices.items()
    }


class Superelement:
    """Matrices by values between points, which are a node and one of its components."""

    # Components are 1 to 6 along x, y, z and about them; 0 is a generalized coordinate.

    def __init__(self) -> None:
        self.matrices: dict[str, dict[tuple[Point, Point], float]] = {}
        self.symmetric: dict[str, bool] = {}

    @classmethod
    def of(cls, files: Mapping[str, Superelement]) -> Superelement:
        """One of files that have a matrix each."""
        joined = cls()
        joined.matrices = {name: file.matrices["matrix"] for name, file in files.items()}
        joined.symmetric = {name: file.symmetric["matrix"] for name, file in files.items()}
        return joined

    def names(self) -> dict[str, str]:
        """Names of the stiffness, the mass and the damping in the file."""
        return {name: name for name in _MATRICES if name in self.matrices}

    def points(self) -> list[Point]:
        """Points of all matrices, in rising order."""
        listed = {p for values in self.matrices.values() for at in values for p in at}
        if len(listed) >= _MOST or not all(0 <= component <= 6 for _, component in listed):
            raise InputError("its components are not 0 to 6, or too many", "matrices")
        return sorted(listed)

    def matrix(self, name: str, points: list[Point]) -> Array:
        """One matrix with its rows and columns at these points."""
        rows = {point: number for number, point in enumerate(points)}
        matrix = np.zeros((len(rows), len(rows)))
        for (row, column), value in self.matrices[name].items():
            matrix[rows[row], rows[column]] = value
            if self.symmetric[name]:
                matrix[rows[column], rows[row]] = value
        return matrix

    def in_si(self, key: str, units: str | None) -> tuple[dict[str, Array], dict[str, list[int]]]:
        """Matrices in SI, and the six coordinates of each node, named by its number."""
        names = self.names()
        missing = [name for name in ("stiffness", "mass") if name not in names]
        if missing:
            why = f"Its matrices: {', '.join(self.matrices) or 'none'}"
            remedy = "Write both the stiffness and the mass"
            raise InputError(f"the file has no {missing[0]} matrix", key, why, remedy)
        points = self.points()
        matrices = {name: self.matrix(listed, points) for name, listed in names.items()}
        nodes: dict[str, list[int]] = {}
        for row, (node, component) in enumerate(points):
            if component:
                nodes.setdefault(str(node), [-1] * 6)[component - 1] = row
        return _in_si(matrices, nodes, key, units), nodes


class PunchFile(Superelement):
    """DMIG entries of a Nastran file."""

    # Entries have eight fields of 8 characters, four of 16 (``DMIG*``), or fields between commas:
    # NAME, column, component, a blank, then row, component, value, imaginary part. Source: entry
    # DMIG in the reference guides of Autodesk Nastran 2025 and Altair OptiStruct 2021.

    def __init__(self, text: str) -> None:
        super().__init__()
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

    def names(self) -> dict[str, str]:
        """Names of the stiffness, the mass and the damping in the file."""
        names = {}
        for name, letter in (("stiffness", "K"), ("mass", "M"), ("damping", "B")):
            named = [each for each in self.matrices if each == f"{letter}AAX"]
            named = named or [n for n in self.matrices if n[0] == letter and n[:2] != "K4"]
            if len(named) == 1:
                names[name] = named[0]
            elif named or name != "damping":
                what = f"the file has {len(named) or 'no'} DMIG matrices of the {name}"
                why = f"Its matrices: {', '.join(self.matrices) or 'none'}"
                remedy = f"Write one whose name begins with {letter}, such as {letter}AAX"
                raise InputError(what, "matrices", why, remedy)
        return names


def _user_element(text: str) -> Superelement:
    """Substructure that Abaqus writes as a linear user element."""
    # *USER ELEMENT has the nodes in comments below it and, below these, the components of the
    # first node, then "number of a node, its components" where these change. *MATRIX has the lower
    # triangle row by row, or all columns with UNSYM. Source: *SUBSTRUCTURE MATRIX OUTPUT, *USER
    # ELEMENT and *MATRIX of the Abaqus keywords guide 2016; records 1011 and 1012 of its output.
    parts = re.split(r"(?m)^\*(?=[A-Za-z])", text)
    head = next(part for part in parts if part.upper().startswith("USER ELEMENT"))
    options, *lines = head.splitlines()
    listed = "".join(line.lstrip("*") + "," for line in lines if re.match(r"\*\*[\s\d,]+$", line))
    nodes = [int(number) for number in re.findall(r"\d+", listed)]
    count = re.search(r"NODES\s*=\s*(\d+)", options.upper())
    if count is None or len(nodes) != int(count[1]):
        raise ValueError(f"it lists {len(nodes)} nodes, not the NODES of *USER ELEMENT")
    rows = [[int(n) for n in re.findall(r"\d+", line)] for line in lines if line[:1] != "*"]
    changes = {1: rows[0], **{first: components for first, *components in rows[1:]}}
    points, components = [], rows[0]
    for number, node in enumerate(nodes, 1):
        components = changes.get(number, components)
        points += [(node, component) for component in components]
    if len(set(points)) < len(points) or len(points) >= _MOST:
        raise ValueError(f"a component of a node is listed twice, or there are {_MOST} or more")
    element, square = Superelement(), "UNSYM" in options.upper()
    for part in parts:
        option, _, data = part.partition("\n")
        if (kind := re.match(r"MATRIX\s*,\s*TYPE\s*=\s*([A-Z ]+)", option.upper())) is None:
            continue
        if (name := kind[1].strip().lower()) not in ("stiffness", "mass"):
            raise ValueError(f"it has a matrix of TYPE={kind[1]}; only STIFFNESS and MASS are read")
        numbers = [line for line in data.splitlines() if line[:1] != "*"]
        values = [float(value) for value in re.split(r"[\s,]+", "\n".join(numbers)) if value]
        size, full = len(points), square and name == "stiffness" and len(values) == len(points) ** 2
        at = (
            np.indices((size, size)).reshape(2, -1)[::-1].T
            if full
            else np.array(np.tril_indices(size)).T
        )
        if len(values) != len(at):
            raise ValueError(f"its {name} has {len(values)} values, not the {len(at)} of its nodes")
        element.symmetric[name] = not full
        element.matrices[name] = {
            (points[row], points[column]): value
            for (row, column), value in zip(at, values, strict=True)
        }
    return element


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


def _archive(file: io.BytesIO) -> dict[str, Array] | Superelement:
    content = file.getvalue()
    if content[:2] != b"PK":
        text = content.decode("ascii")
        is_element = re.search(r"(?mi)^\*USER ELEMENT", text) is not None
        return _user_element(text) if is_element else PunchFile(text)
    with np.load(file, allow_pickle=False) as archive:
        try:
            return {name: np.asarray(archive[name]) for name in archive.files}
        except ValueError:
            what = "an array has Python objects, such as a dict of nodes"
            remedy = 'Save nodes as an array of names, nodes=numpy.array(["seat A", "seat B"])'
            raise InputError(what, "matrices", "Six rows follow for each name", remedy) from None


def _is_market(path: str) -> bool:
    with Path(path).open("rb") as file:
        return file.read(14).lower() == b"%%matrixmarket"


def _single_matrix(file: io.BytesIO) -> Array | Superelement:
    """Matrix of a Matrix Market file, a Harwell-Boeing file, or a table of Abaqus."""
    if file.getvalue()[:14].lower() == b"%%matrixmarket":
        return _market(file)
    lines = file.getvalue().decode("ascii").splitlines()
    if len(lines) > 4 and re.match(r"[A-Z]{3}\s+\d+\s+\d+", lines[2].upper()):
        return _harwell_boeing(lines)
    return _matrix_output(lines)


def _matrix_output(lines: list[str]) -> Array | Superelement:
    """Matrix of an Abaqus file, between nodes and their components or between numbered rows."""
    # FORMAT=MATRIX INPUT and LABELS have five columns, COORDINATE has row, column and value, all
    # as a triangle or square. Source: *MATRIX OUTPUT and *MATRIX INPUT of the keywords guide 2016.
    listed = [(n, re.split(r"[\s,]+", line.strip(" ,\t"))) for n, line in enumerate(lines, 1)
              if line.strip() and line[:1] not in "*%"]  # fmt: skip
    if not listed or {len(fields) for _, fields in listed} not in ({3}, {5}):
        wrong = [n for n, fields in listed if len(fields) != len(listed[0][1])] or [1]
        raise ValueError(
            f"line {wrong[0]}: each row has node, component, node, component and value, or row, "
            "column and value"
        )
    element = Superelement()
    entries: dict[tuple[Point, Point], float] = {}
    for number, (*labels, value) in listed:
        try:
            at, entry = [int(label) for label in labels], float(value)
        except ValueError as error:
            raise ValueError(f"line {number}: {error}") from None
        points = ((at[0], at[1]), (at[2], at[3])) if at[2:] else ((at[0], 0), (at[1], 0))
        if entries.setdefault(points, entry) != entry:
            raise ValueError(f"line {number}: the entry is there twice, with another value")
    # One triangle represents both; a full matrix has pairs.
    element.symmetric["matrix"] = not any(r != c and (c, r) in entries for r, c in entries)
    element.matrices["matrix"] = entries
    if len(listed[0][1]) == 5:
        return element
    size = max(row for points in entries for row, _ in points)
    if not 0 < size < _MOST or min(row for points in entries for row, _ in points) < 1:
        raise ValueError(f"its rows are not numbers from 1 to {_MOST - 1}")
    return element.matrix("matrix", [(row, 0) for row in range(1, size + 1)])


def _harwell_boeing(lines: list[str]) -> Array:
    """Real assembled matrix of a Harwell-Boeing file, symmetric or not."""
    # The reader of SciPy takes neither symmetric matrices nor files with a right-hand side, as
    # Ansys writes them. Source: Duff, Grimes and Lewis, User's guide for the Harwell-Boeing sparse
    # matrix collection (1992), section 2; HBMAT in the Ansys commands reference.
    counts = [int(lines[1][n : n + 14] or 0) for n in range(14, 70, 14)]
    form, (height, width, entries) = lines[2][:3].upper(), map(int, lines[2][14:56].split())
    if form not in ("RSA", "RUA") or height != width or not 0 < height < _MOST:
        raise ValueError(
            f"it is {form} of {height} x {width}, not a real assembled square matrix (RSA, RUA) of "
            f"less than {_MOST} rows; reduce the housing to its interface nodes"
        )
    at, columns = 4 + (counts[3] > 0), []
    sizes = (width + 1, entries, entries)
    for layout, count, size in zip(lines[3].upper().split(")"), counts, sizes, strict=False):
        repeat, digits = map(int, re.search(r"(\d+)[IEDFG](\d+)", layout).groups())  # type: ignore[union-attr]
        fields = (line[n * digits : (n + 1) * digits] for line in lines[at : at + count]
                  for n in range(repeat))  # fmt: skip
        columns.append([_number(field.strip()) for field in fields if field.strip()])
        if len(columns[-1]) != size:
            raise ValueError(f"it has {len(columns[-1])} entries where its head says {size}")
        at += count
    starts, rows = (np.array(column).astype(int) - 1 for column in columns[:2])
    if rows.min() < 0 or rows.max() >= height or starts[-1] != entries or np.diff(starts).min() < 0:
        raise ValueError("its pointers lie outside the matrix")
    matrix = np.zeros((height, width))
    np.add.at(matrix, (rows, np.repeat(np.arange(width), np.diff(starts))), columns[2])
    return matrix if form == "RUA" else matrix + matrix.T - np.diag(np.diag(matrix))


def _mapping(file: io.BytesIO) -> dict[str, list[int]]:
    """Rows of each node by the mapping that Ansys writes: equation, node, degree of freedom."""
    nodes: dict[str, list[int]] = {}
    for number, line in enumerate(file.read().decode("ascii").splitlines(), 1):
        equation, node, label, *_ = *line.split(), "", "", ""
        if not equation.isdigit():
            continue  # the head
        if label.upper() not in _FREEDOMS or not node.isdigit():
            raise ValueError(f"line {number}: {line.strip()} is not equation, node, and UX to ROTZ")
        component = _FREEDOMS.index(label.upper())
        nodes.setdefault(str(int(node)), [-1] * 6)[component] = int(equation) - 1
    return nodes


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
