"""Friction laws by name: options, contacts, refusals; the trivial laws."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from known_pairs import pair_of
from tribodyn.ehl import FilmState
from tribodyn.errors import InputError
from tribodyn.friction import (
    LAWS,
    TribologicalContact,
    benedict_kelly,
    constant,
    none,
    pitch_point,
    xu_2007,
)
from tribodyn.lubricant import Lubricant

OPTIONS = {"constant": {"coefficient": 0.05}}


def hertz_film():
    """Three contacts with flat gaps under the Hertz pressure."""
    x = np.linspace(-1.0, 1.0, 201)
    pressures = np.array([[0.8e9], [0.9e9], [0.8e9]])
    return FilmState(
        1.2e-4 * x * np.ones((3, 1)),
        pressures * np.sqrt(1.0 - x**2),
        np.full((3, 201), 1e-6),
        Lubricant(0.082, 880.0, 2.19e-8),
        2.2e11,
    )


def contact(**changes):
    values = {
        "load_per_width": np.array([150e3, 200e3, 150e3]),
        "hertz_pressure": np.array([0.8e9, 0.9e9, 0.8e9]),
        "sliding_speed": np.array([-1.0, 0.0, 1.2]),
        "entrainment_speed": np.array([2.0, 2.2, 2.4]),
        "slide_to_roll_ratio": np.array([-0.5, 0.0, 0.5]),
        "equivalent_radius": np.array([7e-3, 8e-3, 8e-3]),
        "dynamic_viscosity": 0.082,
        "composite_roughness": 0.4e-6,
        "film": hertz_film(),
        "oil_density": 880.0,
        "film_thickness": np.array([0.5e-6, 0.6e-6, 0.7e-6]),
        "pitch": pitch_point(pair_of(), 1400.0 * np.pi / 30.0, 150.0),
    }
    return TribologicalContact(**{**values, **changes})


def test_names():
    assert set(LAWS.names()) >= {
        "none", "constant", "benedict-kelly", "xu-2007", "ehl", "exponential", "schlenk",
        "iso-14179", "iso-6336-22", "niemann", "matsumoto", "drozdov", "misharin",
        "odonoghue-cameron", "mixed-ehl", "measured",
    }  # fmt: skip


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("name", LAWS.names())
def test_every_law_gives_a_coefficient_for_every_contact(name):
    law = LAWS[name]
    coefficient = law(contact(), **OPTIONS.get(name, {}))
    assert coefficient.shape == (3,)
    assert np.all((coefficient >= 0.0) & (coefficient < 0.3))
    assert law.name == name
    assert law.source


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("name", LAWS.names())
def test_no_law_sees_the_direction_of_sliding(name):
    state = contact()
    mirrored = contact(
        sliding_speed=-state.sliding_speed, slide_to_roll_ratio=-state.slide_to_roll_ratio
    )
    options = OPTIONS.get(name, {})
    assert np.array_equal(LAWS[name](state, **options), LAWS[name](mirrored, **options))


def test_none_and_constant():
    assert np.array_equal(LAWS["none"](contact()), [0.0, 0.0, 0.0])
    assert np.array_equal(LAWS["constant"](contact(), coefficient=0.05), [0.05] * 3)
    assert none() == 0.0
    assert constant(0.1) == 0.1
    assert constant(0.1, (2, 2)).shape == (2, 2)


@pytest.mark.parametrize("coefficient", [-0.01, 1.01, np.nan])
def test_constant_must_be_a_friction_coefficient(coefficient):
    with pytest.raises(InputError, match="coefficient"):
        LAWS["constant"](contact(), coefficient=coefficient)


def test_laws_hand_the_right_quantities_to_their_formulas():
    c = contact()
    assert np.array_equal(
        LAWS["xu-2007"](c),
        xu_2007(
            slide_to_roll_ratio=c.slide_to_roll_ratio,
            hertz_pressure=c.hertz_pressure,
            dynamic_viscosity=c.dynamic_viscosity,
            roughness_rms=c.composite_roughness,
            entrainment_speed=c.entrainment_speed,
            equivalent_radius=c.equivalent_radius,
        ),
    )
    options = {"variant": "he-singh", "rolling_speed": "sum", "minimum_sliding_speed": 0.01}
    assert np.array_equal(
        LAWS["benedict-kelly"](c, **options),
        benedict_kelly(
            load_per_width=c.load_per_width,
            sliding_speed=c.sliding_speed,
            entrainment_speed=c.entrainment_speed,
            dynamic_viscosity=c.dynamic_viscosity,
            roughness=c.composite_roughness,
            **options,
        ),
    )


def test_options_are_declared():
    assert dict(LAWS["none"].options) == {}
    assert dict(LAWS["xu-2007"].options) == {}
    assert dict(LAWS["constant"].options) == {"coefficient": None}
    assert dict(LAWS["benedict-kelly"].options) == {
        "variant": "benedict-kelly",
        "rolling_speed": "mean",
        "minimum_sliding_speed": 1e-3,
    }
    with pytest.raises(TypeError):
        LAWS["constant"].options["coefficient"] = 0.1


def test_unknown_and_missing_options_are_reported_together():
    with pytest.raises(InputError) as caught:
        LAWS["constant"](contact(), coeficient=0.1, colour="red")
    message = str(caught.value)
    assert len(caught.value.problems) == 3
    assert 'Did you mean "coefficient"' in message
    assert 'unknown option "colour"' in message
    assert 'option "coefficient" is missing' in message


def test_misspelt_law_names_the_nearest():
    with pytest.raises(InputError, match='Did you mean "benedict-kelly"'):
        LAWS["benedict-kelley"]


def test_unloaded_contacts_are_refused():
    with pytest.raises(InputError, match=r"load_per_width = 0 N/m.*Leave unloaded pairs out"):
        contact(load_per_width=np.array([150e3, 0.0, 150e3]))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("hertz_pressure", np.array([1e9, np.nan, 1e9])),
        ("entrainment_speed", np.array([2.0, 0.0, 2.4])),
        ("equivalent_radius", np.array([7e-3, -8e-3, 8e-3])),
        ("dynamic_viscosity", 0.0),
        ("composite_roughness", -1e-7),
    ],
)
def test_impossible_contacts_are_refused(name, value):
    with pytest.raises(InputError, match=name):
        contact(**{name: value})


def test_shapes_must_agree():
    with pytest.raises(InputError, match=r"shapes differ.*hertz_pressure"):
        contact(hertz_pressure=np.array([0.8e9]))


def test_no_contact_at_all_is_refused():
    empty = {
        field.name: np.array([])
        for field in dataclasses.fields(TribologicalContact)
        if field.name
        not in {"dynamic_viscosity", "composite_roughness", "oil_density", "film", "pitch"}
    }
    with pytest.raises(InputError, match="no contact"):
        contact(**empty)


def test_sum_of_the_surface_speeds_is_noticed():
    speed = contact().entrainment_speed
    with pytest.raises(InputError, match="half the sum of the surface speeds"):
        contact(entrainment_speed=2 * speed)


def test_single_contact_as_numbers():
    state = TribologicalContact(150e3, 0.8e9, -1.0, 2.0, -0.5, 7e-3, 0.082, 0.4e-6)
    assert state.size == 1
    assert LAWS["xu-2007"](state) == pytest.approx(LAWS["xu-2007"](contact())[0])


@pytest.mark.parametrize(
    ("law", "field", "remedy"),
    [
        ("mixed-ehl", "film_thickness", r"\[film\] model"),
        ("matsumoto", "film_thickness", r"\[film\] model"),
        ("drozdov", "oil_density", "density of the oil"),
        ("schlenk", "pitch", "pitch_point"),
        ("measured", "pitch", "pitch_point"),
    ],
)
def test_a_law_names_its_missing_inputs(law, field, remedy):
    with pytest.raises(InputError, match=f"{field} is not known.*{remedy}"):
        LAWS[law](contact(**{field: None, "film": None}))


def test_film_ratio_and_kinematic_viscosity():
    c = contact()
    assert c.film_ratio == pytest.approx([1.25, 1.5, 1.75])
    assert np.all(np.isinf(contact(composite_roughness=0.0).film_ratio))
    assert c.kinematic_viscosity == pytest.approx(0.082 / 880.0)
