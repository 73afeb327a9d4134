"""Housings as Abaqus and Ansys write them: a reduced beam keeps its modes in every format."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.io import hb_read, mmwrite
from scipy.linalg import eigh, solve

import tribodyn as td
from tribodyn.errors import InputError

CASE = """
[gears.z1]
shaft = "a"
teeth = 20
face_width = "20 mm"
[gears.z2]
shaft = "b"
teeth = 40
face_width = "20 mm"
[meshes.m]
gears = ["z1", "z2"]
normal_module = "2 mm"
stiffness = "4e8 N/m"
[operation]
input = "a"
output = "b"
speed = "100 rpm"
torque = "10 N*m"
[dynamics]
backlash = "0.1 mm"
[housing]
"""
#: A steel wall of 0.6 m, clamped at both ends, with seats at two of its 13 nodes.
ELEMENTS, LENGTH, HEIGHT, WIDTH = 12, 0.6, 0.05, 0.08
SEATS = {4: 101, 9: 7}  # number in the beam: number in the file
AXES = (2, 6)  # deflection along y, rotation about z
POINTS = [(101, 2), (101, 6), (7, 2), (7, 6)]


def beam() -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and consistent mass of an Euler-Bernoulli beam, its ends clamped, in SI."""
    part, area, inertia = LENGTH / ELEMENTS, HEIGHT * WIDTH, WIDTH * HEIGHT**3 / 12
    scale = np.diag([1.0, part, 1.0, part])
    bending = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
    moving = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]])
    stiffness, mass = np.zeros((2, 2 * ELEMENTS + 2, 2 * ELEMENTS + 2))
    for first in range(0, 2 * ELEMENTS, 2):
        at = np.ix_(range(first, first + 4), range(first, first + 4))
        stiffness[at] += 2.1e11 * inertia / part**3 * scale @ bending @ scale
        mass[at] += 7850.0 * area * part / 420 * scale @ moving @ scale
    return stiffness[2:-2, 2:-2], mass[2:-2, 2:-2]


def reduced(modes: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """Craig-Bampton reduction to the seats and some modes with the seats held."""
    stiffness, mass = beam()
    kept = [2 * (seat - 1) + side for seat in SEATS for side in (0, 1)]
    inner = np.setdiff1d(np.arange(len(mass)), kept)
    _, shapes = eigh(stiffness[np.ix_(inner, inner)], mass[np.ix_(inner, inner)])
    basis = np.zeros((len(mass), len(kept) + modes))
    basis[kept, range(len(kept))] = 1.0
    basis[inner, : len(kept)] = -solve(stiffness[np.ix_(inner, inner)], stiffness[inner][:, kept])
    basis[inner, len(kept) :] = shapes[:, :modes]
    return basis.T @ stiffness @ basis, basis.T @ mass @ basis


def in_millimetres(matrix: np.ndarray) -> np.ndarray:
    """Matrix of the reduced beam in N, mm and tonnes."""
    along = np.array([1e-3, 1.0, 1e-3, 1.0, *[1.0] * (len(matrix) - 4)])
    return 1e3 * matrix * np.outer(along, along)


def user_element(matrices: dict[str, np.ndarray], unsymmetric: bool = False) -> str:
    """Linear user element: two seats and generalized coordinates at nodes of their own."""
    count = len(next(iter(matrices.values()))) - 4
    nodes = [101, 7, *range(900, 900 + count)]
    lines = ["**", "** GENERATION OF SUBSTRUCTURE Z1",
             f"*USER ELEMENT, NODES={len(nodes):10}, LINEAR{', UNSYM' * unsymmetric}",
             "** ELEMENT NODES"]  # fmt: skip
    rows = [nodes[i : i + 3] for i in range(0, len(nodes), 3)]
    lines += ["**" + ",".join(f"{n:11}" for n in row) + ", " * (row is not rows[-1])
              for row in rows]  # fmt: skip
    lines += ["          2,          6", "          3,          1"]
    for name, matrix in matrices.items():
        lines.append(f"*MATRIX,TYPE={name}")
        full = unsymmetric and name == "STIFFNESS"
        for row in range(len(matrix)):
            values = [f"{v:22.14E}" for v in (matrix[:, row] if full else matrix[row, : row + 1])]
            lines += [" ,".join(values[i : i + 4]) + " ," * (i + 4 < len(values))
                      for i in range(0, len(values), 4)]  # fmt: skip
    return "\n".join(lines) + "\n"


def labelled(matrix: np.ndarray, form: str, triangle: str = "lower") -> str:
    """Rows of *MATRIX OUTPUT between nodes, or between numbers."""
    labels = [*POINTS, *((900 + n, 1) for n in range(len(matrix) - 4))]
    rows = []
    for r, c in np.argwhere(matrix != 0.0):
        if triangle == "square" or (r >= c if triangle == "lower" else r <= c):
            value = f"{matrix[r, c]:.15e}"
            if form == "coordinate":
                rows.append(f"{r + 1} {c + 1} {value}")
            else:
                rows.append((", " if form == "matrix input" else "  ").join(
                    map(str, (*labels[r], *labels[c], value))))  # fmt: skip
    return "\n".join(rows) + "\n"


def harwell_boeing(matrix: np.ndarray, form: str = "RSA", side: bool = True) -> str:
    """Harwell-Boeing file with fields that touch, and a right-hand side as Ansys writes it."""
    columns = [np.flatnonzero(column) for column in matrix.T]
    if form == "RSA":
        columns = [rows[rows >= number] for number, rows in enumerate(columns)]
    starts = 1 + np.cumsum([0, *map(len, columns)])
    values = np.concatenate([matrix[rows, number] for number, rows in enumerate(columns)])

    def written(fields: list[str], count: int) -> list[str]:
        return ["".join(fields[i : i + count]) for i in range(0, len(fields), count)]

    pointers = written([f"{n:10}" for n in starts], 8)
    rows = written([f"{n + 1:10}" for n in np.concatenate(columns)], 8)
    entries = written([f"{v:24.15E}" for v in values], 3)
    right = written([f"{0.0:24.15E}"] * len(matrix), 3) if side else []
    counts = [len(part) for part in (pointers, rows, entries, right)]
    layout = "(1P,3E24.15)" if side else "(3E24.15)"
    head = [f"{'wall':<72}{'KEY':<8}", "".join(f"{n:14}" for n in (sum(counts), *counts)),
            f"{form:<14}{len(matrix):14}{len(matrix):14}{len(values):14}{0:14}",
            f"{'(8I10)':<16}{'(8I10)':<16}{layout:<20}"]  # fmt: skip
    if side:
        head[3] += f"{layout:<20}"
        head.append(f"{'F':<14}{1:14}{0:14}")
    return "\n".join([*head, *pointers, *rows, *entries, *right]) + "\n"


MAPPING = """\
     Matrix Eqn          Node     DOF
              1           101      UY
              2           101    ROTZ
              3             7      UY
              4             7    ROTZ
"""


def housing(folder: Path, files: dict[str, str], keys: str):
    for name, content in files.items():
        (folder / name).write_text(content)
    path = folder / "m.toml"
    path.write_text(CASE + keys, "utf-8")
    return td.load_case(path).housing


def labelled_files(form: str, triangle: str = "lower") -> dict[str, str]:
    k, m = map(in_millimetres, reduced())
    return {"k.mtx": labelled(k, form, triangle), "m.mtx": labelled(m, form, triangle)}


def boeing_files(form: str, side: bool) -> dict[str, str]:
    k, m = map(in_millimetres, reduced())
    files = {"k.mtx": harwell_boeing(k, form, side), "m.mtx": harwell_boeing(m, form, side)}
    return {**files, "k.mapping": MAPPING}


def element_file(unsymmetric: bool) -> dict[str, str]:
    k, m = map(in_millimetres, reduced())
    return {"wall.mtx": user_element({"STIFFNESS": k, "MASS": m}, unsymmetric)}


SINGLE = 'stiffness_file = "k.mtx"\nmass_file = "m.mtx"\nunits = "mm-t-s"\n'
NODES = '[housing.nodes]\n"101" = [-1, 0, -1, -1, -1, 1]\n"7" = [-1, 2, -1, -1, -1, 3]\n'
ELEMENT = 'matrices = "wall.mtx"\nunits = "mm-t-s"\n'
MAPPED = SINGLE + 'mapping_file = "k.mapping"\n'
FORMATS = {
    "user element": (element_file(False), ELEMENT),
    "unsymmetric user element": (element_file(True), ELEMENT),
    "matrix input": (labelled_files("matrix input"), SINGLE),
    "upper triangle": (labelled_files("matrix input", "upper"), SINGLE),
    "labels, square": (labelled_files("labels", "square"), SINGLE),
    "coordinate": (labelled_files("coordinate"), SINGLE + NODES),
    "symmetric Harwell-Boeing": (boeing_files("RSA", True), MAPPED),
    "Harwell-Boeing": (boeing_files("RUA", False), MAPPED),
    "Harwell-Boeing, nodes in the case": (boeing_files("RSA", False), SINGLE + NODES),
}


@pytest.mark.parametrize("form", FORMATS)
def test_a_reduced_beam_has_the_modes_of_the_whole(form: str, tmp_path: Path) -> None:
    part = housing(tmp_path, *FORMATS[form])
    assert part.nodes.keys() >= {"101", "7"}
    rows = [part.nodes[str(node)][axis - 1] for node, axis in POINTS]
    frequencies = np.sqrt(eigh(part.stiffness, part.mass, eigvals_only=True))
    expected = np.sqrt(eigh(*beam(), eigvals_only=True))
    assert frequencies[:4] == pytest.approx(expected[:4], rel=3e-3)
    assert np.all(frequencies > (1.0 - 1e-9) * expected[: len(frequencies)])  # Rayleigh
    # under static loads on the seats the reduction is exact: their flexibility in SI
    seats = [2 * (seat - 1) + side for seat in SEATS for side in (0, 1)]
    flexibility = np.linalg.inv(beam()[0])[np.ix_(seats, seats)]
    assert np.linalg.inv(part.stiffness)[np.ix_(rows, rows)] == pytest.approx(
        flexibility, rel=1e-7, abs=1e-9 * np.abs(flexibility).max()
    )


def test_a_file_of_scipy_is_read_as_scipy_reads_it(tmp_path: Path) -> None:
    text = boeing_files("RUA", False)["k.mtx"]
    (tmp_path / "k.hb").write_text(text)
    from tribodyn.study.machine.housing_files import _harwell_boeing

    assert np.array_equal(_harwell_boeing(text.splitlines()), hb_read(tmp_path / "k.hb").toarray())


def test_a_market_file_may_state_units(tmp_path: Path) -> None:
    k, m = reduced()
    mmwrite(tmp_path / "k.mtx", in_millimetres(k))
    mmwrite(tmp_path / "m.mtx", in_millimetres(m))
    part = housing(tmp_path, {"k.mapping": MAPPING}, MAPPED)
    assert part.stiffness == pytest.approx(k, rel=1e-12, abs=1e-6)
    assert part.mass == pytest.approx(m, rel=1e-12, abs=1e-12)


K, M = map(in_millimetres, reduced())
TILTED = K + 0.01 * np.triu(K, 1)
BOTH = {"STIFFNESS": K, "MASS": M}
LABELS, BOEING = labelled_files("labels"), boeing_files("RSA", True)
REFUSED = {
    "no units": (LABELS, SINGLE.replace('units = "mm-t-s"\n', ""), "does not state its units"),
    "not symmetric": (
        {**labelled_files("labels", "square"), "k.mtx": labelled(TILTED, "labels", "square")},
        SINGLE,
        "stiffness is not symmetric",
    ),
    "no nodes": (labelled_files("coordinate"), SINGLE, "no named nodes"),
    "negative stiffness": (
        {"wall.mtx": user_element({**BOTH, "STIFFNESS": -K})},
        ELEMENT,
        "stiffness matrix is singular or not positive",
    ),
    "no mass": ({"wall.mtx": user_element({"STIFFNESS": K})}, ELEMENT, "no mass matrix"),
    "another matrix": (
        {"wall.mtx": user_element({**BOTH, "STRUCTURAL DAMPING": M})},
        ELEMENT,
        "only STIFFNESS and MASS are read",
    ),
    "cut": (
        {"wall.mtx": user_element(BOTH)[:-60]},
        ELEMENT,
        "its mass has 3. values, not the 36",
    ),
    "nodes missing": (
        {"wall.mtx": user_element(BOTH).replace("=         6", "=         7")},
        ELEMENT,
        "6 nodes, not the NODES",
    ),
    "four columns": ({**LABELS, "m.mtx": "1 2 3 4\n"}, SINGLE, "line 1: each row"),
    "two values": (
        {**LABELS, "m.mtx": "1 1 1 1 2.0\n1 1 1 1 3.0\n"},
        SINGLE,
        "line 2: the entry is there twice",
    ),
    "no number": ({**LABELS, "m.mtx": "1 1 1 1 x\n"}, SINGLE, "line 1: .*could not convert"),
    "two formats": (
        {**LABELS, "m.mtx": harwell_boeing(M)},
        SINGLE,
        "mass_file is of another kind",
    ),
    "complex": (
        {**BOEING, "m.mtx": harwell_boeing(M).replace("RSA", "CSA")},
        MAPPED,
        "it is CSA of 8 x 8, not a real",
    ),
    "cut entries": (
        {**BOEING, "k.mtx": harwell_boeing(K, side=False)[:-40]},
        MAPPED,
        "entries where its head says",
    ),
    "mapping": (
        {**BOEING, "k.mapping": MAPPING.replace("UY", "TEMP")},
        MAPPED,
        r"line 2: 1\s+101\s+TEMP is not",
    ),
    "rows outside": (
        {**BOEING, "k.mapping": MAPPING.replace(" 4 ", "40 ")},
        MAPPED,
        'node "7" has the coordinates',
    ),
    "both": (
        element_file(False),
        ELEMENT + 'mass_file = "m.mtx"\n',
        "mass_file and matrices are both given",
    ),
    "binary results": ({"h.op2": "x"}, ELEMENT.replace("wall.mtx", "h.op2"), "DMIGPCH"),
    "active damping": (
        {**LABELS, "c.mtx": labelled(-M, "labels")},
        SINGLE + 'damping_file = "c.mtx"\n',
        "damping matrix feeds in power",
    ),
}


@pytest.mark.parametrize("fault", REFUSED)
def test_wrong_files_are_refused_with_the_key(fault: str, tmp_path: Path) -> None:
    files, keys, message = REFUSED[fault]
    with pytest.raises(InputError, match=message) as caught:
        housing(tmp_path, files, keys)
    assert "m.toml" in str(caught.value)
    assert "housing" in str(caught.value)
