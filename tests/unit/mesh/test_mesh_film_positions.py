"""Positions on the path of contact: where they stand, and how well they are interpolated."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import InputError
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import phase_grid
from tribodyn.mesh.cycle import PairsInContact, path_positions
from tribodyn.mesh.film.film_refinement import SolvedContacts, contact_numbers, places_of


@pytest.fixture(params=["pinion", "wheel", "high contact ratio"])
def contact(request, fzg, high_contact_pair):
    if request.param == "high contact ratio":
        return path_of_contact(high_contact_pair)
    return path_of_contact(fzg(driver=request.param))


def test_zones_end_where_the_load_jumps_and_at_the_pitch_point(contact):
    ratio, pitch = contact.contact_ratio, contact.pair.base_pitch
    inside = {round(contact.direction * (contact.C - contact.A) / pitch, 9)}
    for number in range(1, contact.pairs):
        inside |= {float(number), round(ratio - number, 9)}
    edges = path_positions(contact, 30).edges
    assert (edges[0], edges[-1]) == (0.0, ratio)
    assert sorted(inside) == pytest.approx(edges[1:-1], abs=1e-8)


def test_a_contact_ratio_above_two_has_more_zones(high_contact_pair, fzg):
    assert path_of_contact(high_contact_pair).contact_ratio > 2.0
    assert len(path_positions(path_of_contact(high_contact_pair), 30).counts) == 6
    assert len(path_positions(path_of_contact(fzg()), 30).counts) == 4


@pytest.mark.parametrize("wanted", [8, 30, 61, 200])
def test_positions_are_as_many_as_wanted_and_at_least_four_in_a_zone(contact, wanted):
    places = path_positions(contact, wanted)
    assert min(places.counts) >= 4
    assert places.age.size == max(wanted, 4 * len(places.counts)) == sum(places.counts)
    longest = int(np.argmax(np.diff(places.edges)))
    assert places.counts[longest] == max(places.counts)


def test_edges_occur_twice_once_on_each_side(contact):
    places = path_positions(contact, 30)
    for edge, (left, right) in zip(
        places.edges[1:-1], zip(places.zones[:-1], places.zones[1:], strict=True), strict=True
    ):
        assert places.age[left][-1] == places.age[right][0] == edge
        assert places.sided_age[left][-1] < edge < places.sided_age[right][0]
    assert np.array_equal(
        places.zone_of(places.sided_age), np.repeat(np.arange(len(places.counts)), places.counts)
    )


def test_interpolation_is_exact_for_polynomials_and_on_the_positions(contact):
    places = path_positions(contact, 30)
    degree = min(places.counts) - 1
    age = np.linspace(0.0, places.edges[-1], 301)
    zone = places.zone_of(age)
    interpolated = places.interpolate(places.age**degree, age, zone)
    assert interpolated == pytest.approx(age**degree, abs=1e-12)
    itself = np.repeat(np.arange(len(places.counts)), places.counts)
    jumps = np.exp(places.age) + itself
    assert places.interpolate(jumps, places.age, itself) == pytest.approx(jumps, rel=1e-14)


def test_a_jump_stays_between_two_zones(contact):
    places = path_positions(contact, 30)
    values = np.repeat(np.arange(len(places.counts), dtype=float), places.counts)
    age = np.array([places.edges[1] - 1e-6, places.edges[1] + 1e-6])
    assert places.interpolate(values, age, places.zone_of(age)).tolist() == [0.0, 1.0]
    # the value at the edge itself is that of the requested zone
    edge = np.full(2, places.edges[1])
    assert places.interpolate(values, edge, np.array([0, 1])).tolist() == [0.0, 1.0]


def test_several_columns_are_interpolated_at_once(contact):
    places = path_positions(contact, 30)
    age = np.linspace(0.0, places.edges[-1], 50)
    zone = places.zone_of(age)
    columns = np.stack([places.age, places.age**2], axis=1)
    interpolated = places.interpolate(columns, age, zone)
    assert interpolated.shape == (50, 2)
    assert interpolated[:, 1] == pytest.approx(
        places.interpolate(columns[:, 1], age, zone), rel=1e-15
    )


@pytest.mark.parametrize("positions", [7, 0, 201, -30])
def test_numbers_out_of_range_are_refused(contact, positions):
    with pytest.raises(InputError, match=f"positions = {positions}.*between 8 and 200"):
        path_positions(contact, positions)


def test_every_knot_of_a_mesh_table_lies_in_the_zone_of_its_segment(contact):
    places = path_positions(contact, 30)
    grid = phase_grid(contact.event_phases(), 64)
    for number in range(contact.pairs):
        middle, age = grid.middle + number, grid.phase + number
        touching = middle < contact.contact_ratio
        zone = places.zone_of(middle[touching])
        edges = np.array(places.edges)
        assert np.all(age[touching] >= edges[zone] - 1e-12)
        assert np.all(age[touching] <= edges[zone + 1] + 1e-12)


def test_a_solved_contact_is_not_solved_again():
    radius, speed, load = np.array([8e-3, 9e-3]), np.array([3.0, 3.1]), np.array([1e5, 2e5])
    oil = Lubricant(0.082, 880.0, 2.19e-8)
    pairs = PairsInContact(np.array([0.1, 0.2]), radius, speed, oil, 2.2e11, 0.02)
    zone, memory, solved = np.array([0, 1]), SolvedContacts(), []

    def solve(new):
        solved.append(new.tolist())
        options = FILM_MODELS["newton"].complete({"nodes": 129})
        films = pairs.some(new).films("newton", requested_loads[new], **options)
        return places_of(
            pairs.some(new), zone[new], requested_loads[new], films, np.ones(new.size, bool)
        )

    requested_loads = load
    first = memory.films_of(pairs, zone, requested_loads, solve)
    requested_loads = load * [1.0, 1.1]
    memory.retain(contact_numbers(pairs, requested_loads))
    again = memory.films_of(pairs, zone, requested_loads, solve)
    assert solved == [[0, 1], [1]]
    np.testing.assert_array_equal(again.values[:, 0], first.values[:, 0])
    assert again.solution[0] is first.solution[0]
    assert np.all(again.values[:3, 1] != first.values[:3, 1])
    np.testing.assert_array_equal(again.zone, zone)
