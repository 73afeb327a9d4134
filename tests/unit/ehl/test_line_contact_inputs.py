"""What a line contact refuses: every message names the field, the value and a way out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.ehl import solve_line_contact, solve_line_contact_moes, solve_line_contacts
from tribodyn.errors import InputError
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
CONTACT = {
    "load_per_width": 147802.0,
    "equivalent_radius": 8e-3,
    "entrainment_speed": 3.0722,
    "lubricant": OIL,
    "effective_modulus": 2.2e11,
}


def refusal(**changes):
    with pytest.raises(InputError) as caught:
        solve_line_contact(**{**CONTACT, **changes})
    return str(caught.value)


@pytest.mark.parametrize(
    ("field", "value", "text"),
    [
        ("load_per_width", -1.0, "-1 N/m"),
        ("load_per_width", math.nan, "nan"),
        ("equivalent_radius", 0.0, "0 m"),
        ("entrainment_speed", 0.0, "0 m/s"),
        ("entrainment_speed", math.inf, "inf"),
        ("effective_modulus", 220.0, "220 Pa"),
        ("load_per_width", [1e5, 2e5], "(2,)"),
        ("equivalent_radius", "wide", "wide"),
        ("lubricant", None, "NoneType"),
        ("lubricant", 0.082, "float"),
    ],
)
def test_bad_values_are_named(field, value, text):
    message = refusal(**{field: value})
    assert field in message
    assert text in message


def test_missing_pressure_viscosity_coefficient_is_named():
    with pytest.raises(InputError, match="pressure_viscosity_coefficient"):
        Lubricant(0.082, 880.0, None)


def test_arrays_are_sent_to_the_batch():
    assert "solve_line_contacts" in refusal(load_per_width=np.array([1e5, 2e5]))


def test_pressure_beyond_the_laws_of_viscosity():
    message = refusal(load_per_width=5e6)
    assert "4.678 GPa" in message
    assert "4 GPa" in message
    assert "N/m" in message


def test_barus_overflow_names_a_law_that_holds():
    with pytest.raises(InputError, match="roelands"):
        solve_line_contact_moes(3.0, 1000.0, viscosity_law="barus")


def test_contact_wider_than_its_radius():
    message = refusal(equivalent_radius=1e-6, load_per_width=10.0, effective_modulus=1e5)
    assert "narrow" in message


@pytest.mark.parametrize("nodes", [64, 16386, 600, 3.5, True, "many", None])
def test_nodes_out_of_range(nodes):
    message = refusal(nodes=nodes)
    assert "nodes" in message
    if nodes in (64, 16386, 600):
        assert f"nodes = {({64: 65, 16386: 16385, 600: 513})[nodes]}" in message


@pytest.mark.parametrize("nodes", [65, 101, 201, 501, 1001, np.int64(129), 129.0])
def test_nodes_that_can_be_halved_are_taken(nodes):
    assert solve_line_contact(**CONTACT, nodes=nodes).nodes == nodes


@pytest.mark.parametrize(
    ("domain", "inlet", "message"),
    [
        ("wide", "flooded", "wide"),
        ((1.5, -4.5), "flooded", "(1.5, -4.5)"),
        ((-0.5, 1.5), "zero", "-0.5"),
        ((-4.5, 1.0), "zero", "(-4.5, 1)"),
        ((-4.5,), "zero", "-4.5"),
        ((-2.5, 1.5), "flooded", "X <= -3"),
        ((-5e-4, 2e-4), "zero", "not metres"),
        ("auto", "zero", "State the domain"),
        ("auto", "dry", "dry"),
        ((math.nan, 1.5), "zero", "nan"),
    ],
)
def test_domain_and_inlet(domain, inlet, message):
    assert message in refusal(domain=domain, inlet=inlet)


def test_film_thicker_than_the_domain():
    message = refusal(load_per_width=300.0, domain=(-4.5, 1.5), inlet="zero")
    assert "thicker" in message
    assert "auto" in message


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("tolerance", 0.0),
        ("flux_tolerance", 1.0),
        ("film_tolerance", -1.0),
        ("viscosity_law", "roeland"),
        ("method", "newtom"),
        ("start", 3.0),
        ("profile", np.zeros(5)),
        ("profile", lambda x: np.full(3, 1e-8)),
        ("profile", lambda x: np.full_like(x, np.nan)),
    ],
)
def test_bad_options(option, value):
    message = refusal(**{option: value})
    assert option in message or "film solver" in message


def test_method_names_the_nearest():
    assert '"newton"' in refusal(method="newtom")


@pytest.mark.parametrize(
    "numbers",
    [
        {"M": -1.0},
        {"M": 1e9},
        {"L": -1.0},
        {"L": math.nan},
        {"pressure_viscosity_index": 68.0},
        {"pressure_viscosity_coefficient": 22.0},
    ],
)
def test_numbers_of_moes(numbers):
    with pytest.raises(InputError, match=next(iter(numbers))):
        solve_line_contact_moes(**{"M": 20.0, "L": 10.0, **numbers})


def test_batch_names_the_index_of_a_bad_contact():
    loads = np.full((2, 3), 1e5)
    loads[1, 2] = -1e5
    with pytest.raises(InputError, match=r"contact \[1, 2\] with -100000 N/m"):
        solve_line_contacts(loads, 8e-3, 3.0, OIL, 2.2e11, nodes=129)


def test_batch_refuses_shapes_that_do_not_fit():
    with pytest.raises(InputError, match="broadcast"):
        solve_line_contacts([1e5, 2e5], [8e-3, 8e-3, 8e-3], 3.0, OIL, 2.2e11)
