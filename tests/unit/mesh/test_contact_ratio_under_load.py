"""Mean number of tooth pairs that carry load, against ends of contact found by bisection."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import ModelWarning
from tribodyn.mesh.face_lines import (
    contact_ratio,
    loaded_ages,
    loaded_intervals,
    sharing_parts,
    teeth_shares,
)
from tribodyn.mesh.grid import phase_grid
from tribodyn.stiffness import loaded_contact
from tribodyn.study import Case
from tribodyn.study.pipeline.tooth_contact import loaded_settings, mesh_of

PAIR = {
    "title": "29 and 67 teeth",
    "gears": {
        "normal_module": "2.5 mm",
        "normal_pressure_angle": "20 deg",
        "driver": "pinion",
        "pinion": {"teeth": 29, "face_width": "25 mm", "bore_diameter": "25 mm"},
        "wheel": {"teeth": 67, "face_width": "25 mm", "bore_diameter": "40 mm"},
    },
    "operation": {"speed": "3000 rpm", "torque": "90 N*m"},
    "stiffness": {"model": "analytic"},
    "friction": {"law": "none"},
    "dynamics": {"model": "torsional"},
}


def relief(amount, length=None, **further):
    """Changes that give both gears a tip relief."""
    values = {"tip_relief": amount, "tip_relief_length": length, **further}
    return {
        f"gears.{gear}.modification.{key}": value
        for gear in ("pinion", "wheel")
        for key, value in values.items()
        if value is not None
    }


def case_with(**changes):
    return Case(**PAIR).replace(changes)


def table_of(case):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return mesh_of(case)


def exact(case):
    """Ages at which a pair begins and ceases to carry, each bisected on the loaded contact."""
    settings = loaded_settings(case)

    def carries(age):
        contact = loaded_contact(
            case.gear_pair, case.pinion_torque, phases=np.mod(age, 1.0), **settings
        )
        column = np.floor(age).astype(int) - contact.number[0]
        inside = (column >= 0) & (column < contact.number.size)
        force = contact.normal_force[np.arange(age.size), np.where(inside, column, 0)]
        return inside & (force > 0.0)

    ages = np.linspace(-0.45, case.gear_pair.transverse_contact_ratio + 0.45, 160)
    loaded = carries(ages)
    edges = np.flatnonzero(np.diff(loaded.astype(int)))
    low, high, begins = ages[edges], ages[edges + 1], loaded[edges + 1]
    for _ in range(24):
        middle = 0.5 * (low + high)
        beyond = carries(middle) == begins
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return high


@pytest.mark.parametrize(
    ("changes", "tolerance"),
    [
        ({}, 1e-4),
        (relief("18 um", "3 mm"), 1e-4),
        (relief("18 um", "5 mm"), 1e-4),
        (relief("8 um", "3 mm", tip_relief_shape="parabolic"), 1e-4),
        ({"gears.pinion.teeth": 17, "operation.torque": "150 N*m", **relief("10 um")}, 1e-4),
        pytest.param(
            {"gears.pinion.modification.crowning": "6 um", **relief("18 um", "3 mm")},
            1e-3,
            marks=pytest.mark.slow,
        ),
        ({"stiffness.model": "weber", **relief("18 um", "3 mm")}, 1e-4),
    ],
    ids=["none", "linear", "long", "parabolic", "17 teeth", "crowned", "weber"],
)
def test_ends_of_contact_are_those_of_the_loaded_contact(changes, tolerance):
    case = case_with(**changes)
    mesh, ends = table_of(case), exact(case)
    assert mesh.contact_ratio_under_load == pytest.approx(np.diff(ends)[::2].sum(), abs=tolerance)
    ages = np.ravel(loaded_ages(mesh, teeth_shares(mesh)))
    assert ages == pytest.approx(ends, abs=tolerance)


@pytest.mark.parametrize("model", ["potential-energy", "rectangular", "iso6336"])
@pytest.mark.parametrize("teeth", [17, 29])
def test_teeth_that_never_part_have_the_transverse_contact_ratio(model, teeth):
    options = {"stiffness.pair_stiffness": "400 N/um"} if model == "rectangular" else {}
    mesh = table_of(case_with(**{"stiffness.model": model, "gears.pinion.teeth": teeth}, **options))
    assert mesh.contact_ratio_under_load == pytest.approx(mesh.transverse_contact_ratio, rel=1e-12)


def test_without_extended_contact_it_is_the_transverse_one():
    mesh = table_of(case_with(**{"stiffness.extended_contact": False}))
    assert mesh.contact_ratio_under_load == pytest.approx(mesh.transverse_contact_ratio, rel=1e-12)


def test_it_rises_with_the_load_and_falls_with_the_relief():
    loads = [
        table_of(case_with(**{"operation.torque": f"{torque} N*m"})).contact_ratio_under_load
        for torque in (1, 30, 90, 200)
    ]
    ratio = case_with().gear_pair.transverse_contact_ratio
    assert loads == sorted(loads)
    assert ratio < loads[0] < ratio + 0.02 < ratio + 0.1 < loads[2]
    reliefs = [
        table_of(case_with(**relief(f"{amount} um", "3 mm"))).contact_ratio_under_load
        for amount in (0, 4, 9, 18, 40)
    ]
    assert reliefs == sorted(reliefs, reverse=True)
    assert reliefs[-1] >= 1.0


@pytest.mark.parametrize("steps", [16, 64, 1024])
def test_straight_ends_are_located_between_the_grid_points(steps):
    """A share that rises and falls as a straight line has its ends where the line is zero."""
    grid = phase_grid((0.0, 0.4), steps)
    share = np.maximum(0.0, 1.0 - np.abs(grid.phase - 0.613) / 0.2037)[:, None]
    ((start, end),) = loaded_intervals(grid, share[:, 0])
    assert (start, end) == pytest.approx((0.613 - 0.2037, 0.613 + 0.2037), abs=1e-12)
    assert contact_ratio(grid, share, np.zeros((grid.phase.size, 2))) == pytest.approx(0.4074)


def test_parts_of_the_cycle_by_the_number_of_pairs():
    assert sharing_parts([(-0.1, 1.3)]) == pytest.approx({1: 0.6, 2: 0.4})
    assert sharing_parts([(0.2, 1.2)]) == pytest.approx({1: 1.0})
    assert sharing_parts([(-0.3, 0.5), (0.6, 1.7)]) == pytest.approx({1: 0.1, 2: 0.9})
    assert sharing_parts([(-0.2, 2.1)]) == pytest.approx({2: 0.7, 3: 0.3})
    for ages in ([(-0.1, 1.3)], [(-0.3, 0.5), (0.6, 1.7)], [(-0.2, 2.1)]):
        mean = sum(number * part for number, part in sharing_parts(ages).items())
        assert mean == pytest.approx(sum(end - start for start, end in ages))


def test_a_table_of_another_program_has_one_too(tmp_path):
    mesh = table_of(case_with(**relief("18 um", "3 mm")))
    mesh.to_csv(tmp_path / "mesh.csv")
    bodies = {
        "pinion": {"teeth": 29, "moment_of_inertia": "500 kg*mm^2"},
        "wheel": {"teeth": 67, "moment_of_inertia": "15000 kg*mm^2"},
    }
    case = Case(
        gears={"kind": "table", "table": str(tmp_path / "mesh.csv"), "driver": "pinion", **bodies},
        operation=PAIR["operation"],
        dynamics={"model": "torsional"},
    )
    contact_ratio = table_of(case).contact_ratio_under_load
    assert contact_ratio == pytest.approx(mesh.contact_ratio_under_load, rel=1e-9)


def test_a_hypoid_pair_has_the_mean_number_of_its_loaded_pairs():
    case = td.load_case("hypoid-mixed-ehl")
    mesh = table_of(case)
    loaded = (mesh.load_share > 0.0).sum(axis=1).astype(float)
    counted = float(np.diff(mesh.phase) @ (0.5 * (loaded[1:] + loaded[:-1])))
    assert mesh.contact_ratio_under_load == pytest.approx(counted, abs=0.03)
    assert 1.0 <= mesh.contact_ratio_under_load <= loaded.max()
