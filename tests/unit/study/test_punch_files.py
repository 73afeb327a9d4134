"""Housings from Nastran punch files: every layout of the entries, units, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.study.machine.housing_files import PunchFile

SMALL = """\
$ two grid points and a generalized coordinate, millimetres and tonnes
ASET1   123     101
DMIG    KAAX           0       6       2       0                       6
DMIG    KAAX         101       1             101       1  2.5+03
             102       3 -5.0+02             901       0    1.D1
DMIG    KAAX         102       3             102       3 7500.0
DMIG    KAAX         901       0             901       0    9.+4
DMIG    MAAX           0       6       2       0
DMIG    MAAX         101       1             101       1   4.-03
DMIG    MAAX         102       3             102       3   2.-03
DMIG    MAAX         901       0             901       0     1.0
"""
LARGE = """\
DMIG    KAAX           0       6       2       0                       6
DMIG*   KAAX                         101               1
*                    101               1 2.500000000D+03
*                    102               3-5.000000000D+02
*                    901               0 1.000000000D+01
DMIG*   KAAX                         102               3
*                    102               3 7.500000000D+03
DMIG*   KAAX                         901               0
*                    901               0 9.000000000D+04
"""
FREE = """\
DMIG,KAAX,0,6,2
DMIG,KAAX,101,1,,101,1,2500.0,,
+,102,3,-500.0,,901,0,10.0
DMIG,KAAX,102,3,,102,3,7.5E3
DMIG*,KAAX,901,0,,
*,901,0,9.+4
"""
POINTS = [(101, 1), (102, 3), (901, 0)]
EXPECTED = [[2500.0, -500.0, 10.0], [-500.0, 7500.0, 0.0], [10.0, 0.0, 9e4]]


@pytest.mark.parametrize("text", [SMALL, LARGE, FREE], ids=["small", "large", "free"])
def test_entries_of_every_layout_are_one_matrix(text: str) -> None:
    punched = PunchFile(text)
    assert punched.points() == POINTS
    assert punched.matrix("KAAX", POINTS) == pytest.approx(np.array(EXPECTED))


def test_a_square_matrix_is_not_mirrored() -> None:
    punched = PunchFile(FREE.replace("0,6,2", "0,1,2"))
    matrix = punched.matrix("KAAX", POINTS)
    assert (matrix[1, 0], matrix[0, 1]) == (-500.0, 0.0)  # the entry is of column 101, row 102


def punch(name: str, matrix: np.ndarray) -> str:
    """Symmetric matrix of six seats with three translations each, in large fields."""
    lines = [f"DMIG    {name:<8}{0:>8}{6:>8}{2:>8}"]
    at = [(1 + row // 3, 1 + row % 3) for row in range(len(matrix))]
    for column, (grid, component) in enumerate(at):
        lines.append(f"DMIG*   {name:<16}{grid:>16}{component:>16}")
        lines += [
            f"*       {g:>16}{c:>16}{value:>16.8E}"
            for (g, c), value in zip(at[column:], matrix[column:, column], strict=True)
            if value
        ]
    return "\n".join(lines) + "\n"


def test_a_housing_in_tonnes_and_millimetres_is_that_in_si(tmp_path: Path) -> None:
    case = td.load_case("two-stage-spur")
    stiffness, mass = np.array(case.housing.stiffness), np.array(case.housing.mass)
    text = punch("KAAX", stiffness * 1e-3) + punch("MAAX", mass * 1e-3)
    (tmp_path / "housing.pch").write_text(text)
    seats = ("input left", "middle left", "output left", "input right", "middle right",
             "output right")  # fmt: skip
    assert list(case.housing.nodes) == list(seats)
    nodes = {name: str(1 + seats.index(case[f"bearings.{name}.node"])) for name in "ABCDEF"}
    bare = {**{f"bearings.{name}.node": None for name in nodes}, "housing": None}
    text = case.replace(bare).to_toml()
    for name, node in nodes.items():
        text = text.replace(f"[bearings.{name}]", f'[bearings.{name}]\nnode = "{node}"')
    path = tmp_path / "machine.toml"
    table = '[housing]\nmatrices = "housing.pch"\nunits = "mm-t-s"\n'
    path.write_text(f"{text}\n{table}", "utf-8")
    again = td.load_case(path)
    assert again.housing.stiffness == pytest.approx(stiffness, rel=1e-8)
    assert again.housing.mass == pytest.approx(mass, rel=1e-8)
    assert again.housing.nodes["2"][:3] == (3, 4, 5)
    for old, new, message in (
        ('units = "mm-t-s"\n', "", "The file of matrices does not state its units"),
        ("housing.pch", "complex.pch", "KAAX is not a real square or symmetric matrix"),
        ("housing.pch", "none.pch", "no DMIG matrices of the stiffness.*Its matrices: MAAX"),
        ("housing.pch", "cut.pch", "KAAX has no header"),
    ):
        (tmp_path / "complex.pch").write_text("DMIG    KAAX           0       6       4\n")
        (tmp_path / "none.pch").write_text(punch("MAAX", mass))
        (tmp_path / "cut.pch").write_text(punch("KAAX", stiffness).partition("\n")[2])
        path.write_text(f"{text}\n{table.replace(old, new)}", "utf-8")
        with pytest.raises(InputError, match=message):
            td.load_case(path)


def test_units_of_archives_are_refused(tmp_path: Path) -> None:
    names = [str(name) for name in range(6)]
    np.savez(tmp_path / "h.npz", K=np.eye(36), M=np.eye(36), nodes=names)
    keys = {"stiffness_file": None, "mass_file": None, "damping_file": None, "nodes": None}
    files = {"matrices": str(tmp_path / "h.npz"), "units": "mm-t-s", **keys}
    with pytest.raises(InputError, match="has no effect here"):
        td.load_case("two-stage-spur").replace({f"housing.{k}": v for k, v in files.items()})


def test_rotations_and_forces_change_their_units(tmp_path: Path) -> None:
    """N*mm/rad is 1e-3 N*m/rad, N/rad stays, and a generalized coordinate keeps its frequency."""
    text = SMALL + "DMIG    KAAX         101       5             101       5   8.+06\n"
    text += "DMIG    KAAX         101       1             101       5   3.+04\n"
    text += "DMIG    MAAX         101       5             101       5   6.+02\n"
    matrices, nodes = PunchFile(text).in_si("matrices", "mm-t-s")
    assert nodes == {"101": [0, -1, -1, -1, 1, -1], "102": [-1, -1, 2, -1, -1, -1]}
    assert matrices["stiffness"][0, 0] == pytest.approx(2.5e6)
    assert matrices["stiffness"][1, 1] == pytest.approx(8e3)
    assert matrices["stiffness"][0, 1] == pytest.approx(3e4)
    assert matrices["mass"].diagonal() == pytest.approx([4.0, 0.6, 2.0, 1e-3])
    assert matrices["stiffness"][3, 3] / matrices["mass"][3, 3] == pytest.approx(9e4)
