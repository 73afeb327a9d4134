"""Static studies of a case: units, whose torque is meant, defaults, and where faults are found."""

from __future__ import annotations

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.stiffness import loaded_contact
from tribodyn.study.pipeline.tooth_contact import loaded_settings


@pytest.fixture(scope="module")
def case():
    return td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})


@pytest.fixture(scope="module")
def film_case():
    return td.load_case("fzg-film").replace({"film.model": "moes"})


def test_harris_map_reads_units(case):
    harris = td.harris_map(case, torque=["0.09 kN*m", 60.0], phases=16)
    np.testing.assert_allclose(harris.torque, [60.0, 90.0])
    single = loaded_contact(case.gear_pair, 90.0, phases=16, **loaded_settings(case))
    np.testing.assert_allclose(harris.transmission_error[1], single.transmission_error, rtol=1e-9)


def test_map_goes_up_to_twice_the_torque_of_the_case(case):
    harris = td.harris_map(case, phases=16)
    assert harris.torque.size == 20
    assert harris.torque[-1] == pytest.approx(2.0 * case.pinion_torque)
    assert harris.torque[0] == pytest.approx(0.1 * case.pinion_torque)


def test_torques_of_a_driving_wheel_become_those_of_the_pinion(film_case):
    wheel = film_case.replace({"stiffness.model": "analytic"})
    assert td.harris_map(wheel, [150.0], phases=16).torque[0] == pytest.approx(100.0)
    best = td.optimize_tip_relief(wheel, [150.0], phases=16, grid=(3, 3))
    assert best.torque[0] == pytest.approx(100.0)
    stiffness = td.comprehensive_stiffness(film_case, torque=150.0, speed="1400 rpm", steps=32)
    assert stiffness.pinion_torque[0] == pytest.approx(100.0)
    assert stiffness.pinion_speed[0] == pytest.approx(1400.0 * np.pi / 30.0 * 1.5)


def test_tip_relief_reads_amounts_and_lengths_with_units(case):
    arguments = {
        "amount": ("0 um", "20 um"),
        "length": ("2 mm", 6e-3),
        "phases": 16,
        "grid": (5, 4),
    }
    optimum = td.optimize_tip_relief(case, ("60 N*m", "120 N*m"), **arguments)
    np.testing.assert_allclose(optimum.map_amount, np.linspace(0.0, 20e-6, 5))
    np.testing.assert_allclose(optimum.map_length, np.linspace(2e-3, 6e-3, 4))
    assert (optimum.torque[0], optimum.torque[-1]) == (60.0, 120.0)
    assert optimum.objective < 0.6 * optimum.objective_before
    changed = case.replace(
        {
            f"gears.{gear}.modification.{name}": value
            for gear in ("pinion", "wheel")
            for name, value in (
                ("tip_relief", optimum.amount),
                ("tip_relief_length", optimum.length),
            )
        }
    )
    after = td.harris_map(changed, optimum.torque, phases=16).peak_to_peak_transmission_error
    np.testing.assert_allclose(after, optimum.peak_to_peak_after, rtol=1e-9)


def test_an_optimal_relief_is_written_as_a_drawing_states_it(case):
    """Four digits, in um and mm; the errors are those of the rounded relief."""
    optimum = td.optimize_tip_relief(case, ("60 N*m", "120 N*m"), phases=16, grid=(5, 4))
    lines = [line.partition("  #")[0] for line in optimum.case.to_toml().splitlines()]
    for name, value, unit in (
        ("tip_relief", optimum.amount * 1e6, "um"),
        ("tip_relief_length", optimum.length * 1e3, "mm"),
    ):
        assert lines.count(f'{name} = "{value:.4g} {unit}"') == 2
        assert float(f"{value:.4g}") == pytest.approx(value, rel=1e-14)
    after = td.harris_map(optimum.case, optimum.torque, phases=16).peak_to_peak_transmission_error
    np.testing.assert_allclose(after, optimum.peak_to_peak_after, rtol=1e-9)
    assert optimum.objective == pytest.approx(after.max(), rel=1e-9)
    exact = td.optimize_tip_relief(case, ("60 N*m", "120 N*m"), phases=16, grid=(5, 4), digits=15)
    assert optimum.objective == pytest.approx(exact.objective, rel=1e-3)
    assert exact.amount != optimum.amount


def test_a_rounded_relief_stays_on_the_flank(case):
    """The longest relief is the used flank, whose length has more than two digits."""
    longest = td.optimize_tip_relief(case, 90.0, phases=16, grid=(3, 3)).map_length[-1]
    ends = (0.98 * longest, longest)
    optimum = td.optimize_tip_relief(
        case, 90.0, phases=16, grid=(2, 2), length=ends, digits=1, amount=("10 um", "20 um")
    )
    assert optimum.length <= longest


def test_tip_relief_range_is_half_the_torque_of_the_case_to_all_of_it(case):
    optimum = td.optimize_tip_relief(case, phases=16, grid=(3, 3))
    assert optimum.torque[0] == pytest.approx(0.5 * case.pinion_torque)
    assert optimum.torque[-1] == pytest.approx(case.pinion_torque)


def test_comprehensive_stiffness_has_the_kind_of_the_case(film_case):
    stiffness = td.comprehensive_stiffness(film_case, steps=32)
    assert stiffness.kind == "tangent"
    assert stiffness.comprehensive_mesh_stiffness.shape[:2] == (1, 1)
    none = film_case.replace({"film.stiffness": "none"})
    again = td.comprehensive_stiffness(none, steps=32)
    np.testing.assert_array_equal(again.pair_stiffness, stiffness.pair_stiffness)


@pytest.mark.parametrize(
    ("study", "options", "message"),
    [
        ("harris_map", {"torque": ["90 mm"]}, "torque"),
        ("harris_map", {"torque": [-1.0]}, "torque"),
        ("optimize_tip_relief", {"amount": ("0 um", "10 s")}, "amount"),
        ("optimize_tip_relief", {"length": ("1 mm", "25 mm")}, "used flank"),
        ("optimize_lead", {"crowning": ("0 um", "10 s")}, "crowning"),
        ("optimize_lead", {"misalignment": "10 N"}, "misalignment"),
        ("comprehensive_stiffness", {"speed": "fast"}, "speed"),
    ],
)
def test_faults_name_the_argument(case, study, options, message):
    with pytest.raises(InputError, match=message):
        getattr(td, study)(case, **options)


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_the_best_lead_compensates_the_misalignment(case, gear):
    iso = case.replace({"stiffness.model": "iso6336", "gears.misalignment": "8 um"})
    best = td.optimize_lead(iso, gear=gear, misalignment="4 um", slices=8)
    assert best.lead_slope == pytest.approx(-12e-6, abs=5e-7)
    assert best.case == iso.replace(best.changes)
    assert set(best.changes) == {
        f"gears.{gear}.modification.{name}" for name in ("crowning", "lead_slope")
    }
    np.testing.assert_allclose(best.face_load_factor_after, 1.0, atol=0.05)


def test_a_case_without_film_has_no_comprehensive_stiffness(case):
    with pytest.raises(InputError, match="no oil film"):
        td.comprehensive_stiffness(case.replace({"film.model": "none"}))


def test_every_study_has_its_plot(case, film_case):
    torque = ("60 N*m", "120 N*m")
    results = (
        td.harris_map(case, torque, phases=16),
        td.optimize_tip_relief(case, torque, phases=16, grid=(4, 3)),
        td.comprehensive_stiffness(film_case, torque=torque, steps=32),
    )
    for result in results:
        assert len(result.plot().data) > 1
