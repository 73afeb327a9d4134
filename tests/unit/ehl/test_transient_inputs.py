"""Inputs of a transient contact: series, contradictions, scale, and the result object."""

from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import solve_transient_line_contact
from tribodyn.ehl.transient.moving_contact import flooded_domain, reference_scale
from tribodyn.errors import InputError, ModelWarning
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
TIME = np.linspace(0.0, 1e-4, 9)


def solve(**changes: Any) -> Any:
    arguments: dict[str, Any] = {
        "time": TIME,
        "load_per_width": 147802.0,
        "equivalent_radius": 8e-3,
        "entrainment_speed": 3.0722,
        "lubricant": OIL,
        "effective_modulus": 2.2e11,
        "nodes": 129,
    }
    return solve_transient_line_contact(**(arguments | changes))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"time": [0.0]}, "at least two finite instants"),
        ({"time": TIME[::-1]}, "at least two finite instants that rise"),
        ({"load_per_width": np.ones(4)}, r"shape \(4,\)"),
        ({"load_per_width": 0.0}, "1 to 2 % of the load"),
        ({"load_per_width": np.where(TIME > 5e-5, np.nan, 1e5)}, "at instant 5"),
        ({"equivalent_radius": -1.0}, "equivalent_radius"),
        ({"entrainment_speed": -1.0}, "Mirror the contact"),
        ({"entrainment_speed": 0.0}, "without rolling no steady film"),
        ({"effective_modulus": 0.0}, "effective_modulus"),
        ({"impose": "force"}, "Known: load, approach"),
        ({"impose": "approach"}, "exactly one of load and approach"),
        ({"approach": 1e-6}, "exactly one of load and approach"),
        ({"start": "cold"}, "Known: steady, unloaded"),
        ({"start": "unloaded"}, "carries no load"),
        ({"start": "unloaded", "impose": "approach", "approach": 1e-6}, "needs an open gap"),
        ({"inlet": "dry"}, "Known: flooded, zero"),
        ({"nodes": 12}, "nodes"),
        ({"reference_length": 0.0}, "reference_length"),
        ({"viscosity_law": "arrhenius"}, "viscosity_law"),
    ],
)
def test_bad_input_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        solve(**changes)


def test_functions_arrays_and_numbers_are_the_same() -> None:
    number = solve()
    other = solve(
        load_per_width=lambda time: 147802.0 + 0.0 * time,
        equivalent_radius=np.full(TIME.size, 8e-3),
        entrainment_speed=lambda time: 3.0722,
    )
    assert other.central_film == pytest.approx(number.central_film, rel=1e-14)


def test_result_object() -> None:
    contact = solve(keep_every=4)
    assert contact.pressure.shape == contact.film.shape == (3, 129)
    assert contact.stored_time == pytest.approx(TIME[::4])
    assert contact.maximum_pressure[-1] == pytest.approx(contact.pressure[-1].max())
    middle = np.interp(0.0, contact.position, contact.film[-1])
    assert contact.central_film[-1] == pytest.approx(middle, rel=2e-3)
    # what lies before the first node carries a little too
    inside = np.sum(contact.pressure[-1]) * (contact.position[1] - contact.position[0])
    assert 0.98 * 147802.0 < inside < 147802.0
    data = contact.to_xarray()
    assert data["film"].dims == ("kept_time", "position")
    assert data["load_per_width"].attrs["units"] == "N/m"
    assert "8 steps" in repr(contact)
    assert solve(keep_every=0).pressure.shape == (0, 129)


def test_scale_is_that_of_the_widest_contact() -> None:
    load, radius = np.array([1e5, 2e5, 1.5e5]), np.array([8e-3, 6e-3, 9e-3])
    scale = reference_scale(np.arange(3.0), load, radius, np.array([1.0, 3.0, 2.0]), 2.2e11)
    assert scale.instant == 2
    assert (scale.load, scale.radius, scale.entrainment_speed) == (1.5e5, 9e-3, 3.0)
    assert scale.half_width == pytest.approx(np.sqrt(8.0 * 1.5e5 * 9e-3 / (np.pi * 2.2e11)))
    assert scale.pressure == pytest.approx(2.2e11 * scale.half_width / (4.0 * 9e-3))
    still = reference_scale(np.arange(3.0), load, radius, np.zeros(3), 2.2e11)
    assert still.entrainment_speed == pytest.approx(still.half_width / 2.0)


def test_grid_reaches_further_for_thick_films() -> None:
    series = [np.full(2, value) for value in (147802.0, 8e-3, 3.0722)]
    scale = reference_scale(np.arange(2.0), *series, 2.2e11)
    heavy = flooded_domain(scale, *series, OIL, 2.2e11)
    assert -6.0 < heavy[0] < -4.0
    assert 1.5 <= heavy[1] < 2.0
    series[0] = np.array([147802.0, 1000.0])
    assert flooded_domain(scale, *series, OIL, 2.2e11)[0] < heavy[0]


@pytest.mark.filterwarnings("ignore:\\[outlet-cut\\]:tribodyn.errors.ModelWarning")
def test_a_grid_that_ends_in_the_film_is_reported() -> None:
    time = np.linspace(0.0, 2e-4, 9)
    with pytest.warns(ModelWarning, match="transient-outlet"):
        solve(time=time, load_per_width=147802.0 * (0.05 + time / 2e-4), domain=(-8.0, 1.1))
