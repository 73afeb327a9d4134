"""Mesh tables of several operating points from one pass are those of single points."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import collected
from tribodyn.study.pipeline.run import PendingRun, prepare_run, with_tables
from tribodyn.study.pipeline.tooth_contact import mesh_of

_POINTS = (100.0, 60.0), (100.0, 150.0), (300.0, 60.0), (300.0, 150.0)
_KEYS = "operation.speed", "operation.torque"


def _pending(case: td.Case, points: Any = _POINTS) -> list[PendingRun]:
    return [PendingRun(case.replace(dict(zip(_KEYS, point, strict=True)))) for point in points]


def _columns(mesh: Any) -> dict[str, Any]:
    return {name: value for name, value in vars(mesh).items() if not name.startswith("_")}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"film.model": "moes", "friction.law": "xu-2007"},
        {"friction.law": "none"},
        {"stiffness.model": "analytic"},
        {"friction.law": "iso-6336-22"},
        {"friction.law": "mixed"},
        {"gears.composite_roughness": 0.9e-6},
        {"gears.pinion.modification.tip_relief": 3e-6},
        {"gears.pinion.modification.tip_relief": 10e-6},  # the film formula warns
    ],
    ids=str,
)
def test_every_column_is_that_of_a_single_point(changes: dict[str, Any]) -> None:
    check_columns(td.load_case("fzg-roughness").replace(changes))


def test_every_column_of_slices_is_that_of_a_single_point() -> None:
    changes = {"film.stiffness": "none", "stiffness.model": "iso6336", "friction.law": "mixed"}
    check_columns(td.load_case("helical-pair").replace(changes))


def check_columns(case: td.Case) -> None:
    """Compare each table of one pass with that of its point alone."""
    pending = with_tables(_pending(case))
    assert [callable(mesh_source) for _, mesh_source in pending] == [True] * len(_POINTS)
    for mesh_column, mesh_source in pending:
        with collected() as single_warnings:
            together = _columns(mesh_source())
        with collected() as messages:
            alone = _columns(mesh_of(mesh_column))
        assert [str(each) for each in single_warnings] == [str(each) for each in messages]
        assert together.keys() == alone.keys()
        for name, value in alone.items():
            if isinstance(value, np.ndarray):
                assert together[name].shape == value.shape, name
                np.testing.assert_allclose(together[name], value, rtol=1e-14, atol=0.0)
            elif isinstance(value, float | str):
                assert together[name] == value, name


def test_films_in_series_need_points_of_their_own() -> None:
    changes = {"film.model": "moes", "film.stiffness": "tangent"}
    case = td.load_case("fzg-roughness").replace(changes)
    assert [mesh_source for _, mesh_source in with_tables(_pending(case))] == [None] * len(_POINTS)


def test_points_of_other_gears_are_no_company() -> None:
    case = td.load_case("fzg-roughness")
    wide = case.replace({"gears.pinion.face_width": 15e-3})
    pending = [*_pending(case, _POINTS[:2]), *_pending(wide, _POINTS[:1])]
    mesh_source = [mesh_source for _, mesh_source in with_tables(pending)]
    assert [each is None for each in mesh_source] == [False, False, True]
    assert mesh_source[1]().pinion_torque == _POINTS[1][1]


def test_a_point_that_fails_leaves_the_others_to_themselves() -> None:
    case = td.load_case("fzg-roughness")
    pending = with_tables(_pending(case, [*_POINTS, (300.0, 1e7)]))
    assert all(mesh_source is None for _, mesh_source in pending)
    with pytest.raises(td.ComputationError):
        prepare_run(pending[-1].case)
    assert prepare_run(pending[0].case).mesh.pinion_torque == _POINTS[0][1]
