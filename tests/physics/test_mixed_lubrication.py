"""Film and asperities that share a load: integrals, limits, moments, and the laws of friction."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from references import mixed_contact as plain
from tribodyn.ehl import (
    FILM_MODELS,
    Asperities,
    FilmState,
    RoughnessProfile,
    asperity_integral,
    balanced_load_share,
    lubrication_regime,
    mixed_line_contact,
)
from tribodyn.errors import InputError, quiet
from tribodyn.friction import LAWS, TribologicalContact, ehl, mixed, mixed_solved, xu_2007
from tribodyn.lubricant import Lubricant, from_library

MODULUS = 2.3e11
FLANKS = Asperities.from_slope(0.7e-6, 0.1)
OTHERS = Asperities(0.4e-6, 8e-6, 2e10)


@pytest.mark.parametrize("order", [1.0, 2.0, 2.5])
@pytest.mark.parametrize("ratio", [-12.0, -3.0, -0.5, 0.0, 0.7, 2.0, 6.0, 15.0])
def test_asperity_integral_is_its_quadrature(ratio, order):
    assert asperity_integral(ratio, order) == pytest.approx(plain.integral(ratio, order), rel=1e-9)


def test_asperity_integral_in_closed_form_and_at_its_ends():
    assert asperity_integral(0.0) == pytest.approx(
        2**0.75 * math.gamma(1.75) / math.sqrt(2 * math.pi)
    )
    assert asperity_integral(-20.0, 2.0) == pytest.approx(401.0)  # mean of (20 + s)^2
    assert asperity_integral([50.0, math.inf]) == pytest.approx([0.0, 0.0])
    rise = (asperity_integral(1.0 + 1e-6) - asperity_integral(1.0 - 1e-6)) / 2e-6
    assert rise == pytest.approx(-2.5 * asperity_integral(1.0, 1.5), rel=1e-8)


@pytest.mark.parametrize("separation", [-0.5e-6, 0.2e-6, 1e-6])
def test_pressure_is_that_of_every_summit_on_every_other(separation):
    shape = (OTHERS.rms_height, OTHERS.summit_radius, OTHERS.summit_density)
    wanted = plain.asperity_pressure(separation, *shape, MODULUS)
    assert OTHERS.pressure(separation, MODULUS) == pytest.approx(wanted, rel=1e-6)


def test_real_area_is_the_fall_of_the_pressure_over_the_roots():
    # dp/dd = -5/2 C F_3/2 / sigma: a check of the order, and the area of Greenwood and Tripp.
    area = OTHERS.contact_area(0.3e-6)
    product = OTHERS.summit_density * OTHERS.summit_radius * OTHERS.rms_height
    assert area == pytest.approx((math.pi * product) ** 2 * plain.integral(0.75, 2.0), rel=1e-9)


def test_moments_of_waves_come_from_their_slope_and_curvature():
    errors = []
    for count in (500, 1000, 2000):
        x = np.arange(count) * 1e-3 / count
        wave = RoughnessProfile(x, 2e-7 * np.sin(2e4 * np.pi * x), beyond="periodic")
        k = 2e4 * np.pi
        exact = np.array([2e-14, 2e-14 * k**2, 2e-14 * k**4])
        errors.append(np.abs(np.array(wave.spectral_moments()) / exact - 1.0))
    order = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))[:, 1:]
    assert order == pytest.approx(np.full(order.shape, 2.0), abs=0.03)
    assert errors[0][0] < 1e-12


def test_moments_of_a_random_profile_give_its_asperities():
    # Sum of waves with random phases: the moments are sums over its spectrum, without sampling.
    random = np.random.default_rng(4)
    k = np.arange(1, 61) * 2.0 * np.pi / 2e-3
    amplitude = 1e-7 / (1.0 + (k / 5e4) ** 2)
    x = np.arange(40000) * 2e-3 / 40000
    phase = random.uniform(0.0, 2.0 * np.pi, k.size)
    height = (amplitude[:, None] * np.cos(k[:, None] * x + phase[:, None])).sum(axis=0)
    exact = [0.5 * np.sum(amplitude**2 * k**n) for n in (0, 2, 4)]
    profile = RoughnessProfile(x, height, beyond="periodic")
    assert profile.spectral_moments() == pytest.approx(exact, rel=1e-4)
    computed, wanted = Asperities.from_profiles(profile), Asperities.from_moments(*exact)
    assert computed.rms_height == pytest.approx(math.sqrt(2.0) * profile.rms, rel=1e-9)
    assert computed.summit_density == pytest.approx(wanted.summit_density, rel=1e-4)
    smooth = RoughnessProfile(x, 0.5 * height, beyond="periodic")
    combined = Asperities.from_profiles(profile, smooth)
    assert combined.rms_height == pytest.approx(math.hypot(profile.rms, smooth.rms), rel=1e-9)


def test_slope_and_density_give_back_the_moments():
    m0, m2, m4 = 0.2e-12, 0.012, 6e9
    wanted = Asperities.from_moments(m0, m2, m4)
    asperities = Asperities.from_slope(math.sqrt(2.0 * m0), math.sqrt(m2), wanted.summit_density)
    assert asperities.summit_radius == pytest.approx(wanted.summit_radius, rel=1e-12)
    assert asperities.summit_radius == pytest.approx(0.375 * math.sqrt(math.pi / m4), rel=1e-12)
    assert Asperities.from_slope(0.5e-6, 0.07).product == pytest.approx(0.05, rel=1e-12)


@pytest.mark.parametrize("film", [0.02e-6, 0.1e-6, 0.35e-6, 1.2e-6])
@pytest.mark.parametrize(
    ("flanks", "pressure"), [(FLANKS, 0.4e9), (FLANKS, 1.6e9), (OTHERS, 0.9e9)]
)
def test_share_and_gap_are_those_of_a_plain_bisection(film, flanks, pressure):
    share, gap = balanced_load_share(film, pressure, MODULUS, flanks)
    wanted = plain.shared(film, pressure, MODULUS, flanks)
    assert (share, gap) == pytest.approx(wanted, rel=2e-7)


def test_limits_of_the_share():
    film = np.concatenate([[0.0], np.geomspace(1e-9, 1e-5, 400), [math.inf]])
    share, gap = balanced_load_share(film, 0.8e9, MODULUS, FLANKS)
    assert share[0] == 0.0 or share[0] < 1e-300
    assert share[1] < 1e-12  # film ratio 0.0014
    assert share[-2:] == pytest.approx([1.0, 1.0], abs=1e-12)
    # Shares far from 0 and 1 rise with the film, and so does the gap.
    between_limits = (share > 1e-12) & (share < 1.0 - 1e-12)
    assert np.all(np.diff(share[between_limits]) > 0.0)
    assert np.all(np.diff(gap[:-1]) >= -1e-12 * gap[:-2])
    assert np.all(gap >= film * (1.0 - 1e-12))


def test_without_film_the_gap_is_that_of_the_dry_contact():
    _, gap = balanced_load_share(0.0, 0.8e9, MODULUS, FLANKS)
    separation = np.linspace(-2.0, 0.5, 200001) * FLANKS.rms_height
    dry = np.interp(0.25 * math.pi * 0.8e9, -FLANKS.pressure(separation, MODULUS)[::-1] * -1.0,
                    separation[::-1])  # fmt: skip
    mean = FLANKS.rms_height * plain.integral(-dry / FLANKS.rms_height, 1.0)
    assert gap == pytest.approx(mean, rel=1e-6)


def test_both_shares_add_up_to_one_at_one_gap():
    share, gap = balanced_load_share(0.3e-6, 0.8e9, MODULUS, FLANKS)
    ratio = gap / FLANKS.rms_height
    low, high = -12.0, 12.0
    for _ in range(80):  # separation of the mean planes that leaves this mean gap
        middle = 0.5 * (low + high)
        low, high = (middle, high) if asperity_integral(-middle, 1.0) < ratio else (low, middle)
    asperity_share = FLANKS.pressure(low * FLANKS.rms_height, MODULUS) / (0.25 * math.pi * 0.8e9)
    assert share + asperity_share == pytest.approx(1.0, abs=1e-9)
    assert gap == pytest.approx(0.3e-6 * share**-0.13, rel=1e-9)


def contact(film=0.3e-6, roughness=0.7e-6, **changes):
    ones = np.ones(3)
    radius, pressure = 8e-3 * ones, np.array([0.6e9, 0.8e9, 0.8e9])
    state = {
        "load_per_width": 2.0 * np.pi * radius * pressure**2 / MODULUS,
        "hertz_pressure": pressure,
        "sliding_speed": np.array([-1.0, 0.5, 2.0]),
        "entrainment_speed": 2.0 * ones,
        "slide_to_roll_ratio": np.array([-0.5, 0.25, 1.0]),
        "equivalent_radius": radius,
        "dynamic_viscosity": 0.08,
        "composite_roughness": roughness,
        "film_thickness": film * ones,
    }
    return TribologicalContact(**{**state, **changes})


def xu_of(c):
    return xu_2007(
        c.slide_to_roll_ratio, c.hertz_pressure, 0.08, 0.0, c.entrainment_speed, c.equivalent_radius
    )


def test_mixed_takes_modulus_and_share_of_every_contact():
    c = contact()
    parts = mixed(c, boundary_friction_coefficient=0.12)
    for i, pressure in enumerate(c.hertz_pressure):
        share, _ = plain.shared(0.3e-6, float(pressure), MODULUS, FLANKS)
        assert parts.film_load_share[i] == pytest.approx(share, rel=1e-6)
        assert parts.asperities[i] == pytest.approx(0.12 * (1.0 - share), rel=1e-5)
        assert parts.film[i] == pytest.approx(xu_of(c)[i] * share**1.2, rel=1e-6)
    assert LAWS["mixed"](c, boundary_friction_coefficient=0.12) == pytest.approx(parts.coefficient)


def test_mixed_prefers_the_film_in_the_centre():
    central = contact(central_film=np.full(3, 0.5e-6))
    assert np.all(mixed(central).film_load_share > mixed(contact()).film_load_share)
    assert mixed(central).film_load_share == pytest.approx(mixed(contact(0.5e-6)).film_load_share)


def test_mixed_of_smooth_flanks_and_without_film():
    smooth = mixed(contact(roughness=0.0))
    assert smooth.coefficient == pytest.approx(xu_of(contact()), rel=1e-12)
    assert np.all(smooth.asperities == 0.0)
    assert mixed(contact(film=0.0)).coefficient == pytest.approx([0.15] * 3, rel=1e-12)
    thick = mixed(contact(film=7e-6))
    assert thick.coefficient == pytest.approx(xu_of(contact()), rel=1e-6)


def solved(film=0.3e-6, roughness=0.7e-6):
    """Three contacts with flat gaps under the pressure of Hertz."""
    x = np.linspace(-1.0, 1.0, 801)
    c = contact(film, roughness)
    half = 2.0 * c.load_per_width / (np.pi * c.hertz_pressure)
    state = FilmState(
        half[:, None] * x,
        c.hertz_pressure[:, None] * np.sqrt(1.0 - x**2),
        np.full((3, 801), film),
        from_library("80W"),
        MODULUS,
    )
    return replace(c, film=state)


def test_solved_film_is_sheared_under_its_own_part_of_the_load():
    c = solved()
    parts = mixed_solved(c)
    share, gap = balanced_load_share(0.3e-6, c.hertz_pressure, MODULUS, FLANKS)
    assert parts.film_load_share == pytest.approx(share, rel=1e-12)
    film = replace(
        c.film,
        pressure=c.film.pressure * share[:, None],
        film_thickness=np.repeat(gap[:, None], 801, axis=1),
    )
    # Over the whole load, which bends the flanks as before.
    assert parts.film == pytest.approx(ehl(replace(c, film=film)), rel=1e-12)
    assert parts.asperities == pytest.approx(0.15 * (1.0 - share), rel=1e-12)
    # Less pressure makes the oil thinner and the gap larger: the film rubs less than the whole.
    assert np.all(parts.film < ehl(c))


def test_solved_film_of_smooth_flanks_and_of_hardly_any_film():
    smooth = mixed_solved(solved(roughness=0.0))
    assert smooth.coefficient == pytest.approx(ehl(solved()), rel=1e-12)
    thin = mixed_solved(solved(film=1e-9))
    assert thin.asperities == pytest.approx([0.15] * 3, rel=1e-6)
    assert np.all(thin.film < 0.006)  # the oil between the asperities, at no pressure


def test_one_film_for_several_sliding_speeds_has_one_share():
    c = solved()
    first = np.zeros(3, dtype=int)
    load, pressure = c.load_per_width[first], c.hertz_pressure[first]
    c = replace(c, load_per_width=load, hertz_pressure=pressure, film=replace(c.film, index=first))
    share = mixed_solved(c).film_load_share
    assert np.ptp(share) == 0.0


def test_regimes_by_the_film_ratio():
    ratio = [[0.0, 0.19, 0.2], [1.99, 2.0, math.inf]]
    assert lubrication_regime(ratio).tolist() == [[0, 0, 1], [1, 2, 2]]
    assert math.isnan(lubrication_regime(math.nan))
    with pytest.raises(InputError, match=r"film_ratio = -0.1"):
        lubrication_regime([-0.1, math.nan])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Asperities(0.0, 1e-5, 1e10), "rms_height = 0 m.*Smooth flanks have no"),
        (lambda: Asperities(1e-6, -1e-5, 1e10), "summit_radius"),
        (lambda: Asperities.from_slope(0.5e-6, 0.0), "rms_slope = 0"),
        (lambda: Asperities.from_slope(0.5e-6, 0.1, -1.0), "summit_density"),
        (lambda: Asperities.from_slope(0.5e-6, 0.5, 1e9), r"m0 m4/m2\^2 = .*Give a smaller slope"),
        (lambda: Asperities.from_moments(1e-13, 0.01, 1e8), "less than 1.5"),
        (lambda: balanced_load_share(-1e-7, 1e9, MODULUS, FLANKS), "central_film"),
        (lambda: balanced_load_share(math.nan, 1e9, MODULUS, FLANKS), "central_film"),
        (lambda: balanced_load_share(1e-7, 0.0, MODULUS, FLANKS), "hertz_pressure"),
        (
            lambda: balanced_load_share(1e-7, 3e9, MODULUS, Asperities(1e-7, 1e-3, 1e7)),
            "asperities carry at most .* of the load.*larger slope",
        ),
    ],
)
def test_an_invalid_roughness_is_explained(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_a_flat_profile_has_no_asperities():
    flat = RoughnessProfile(np.linspace(0.0, 1e-3, 100), np.zeros(100))
    with pytest.raises(InputError, match=r"m0 = 0 m.*without roughness"):
        Asperities.from_profiles(flat)


def test_coefficient_of_the_asperities_outside_of_its_range_is_reported():
    with pytest.warns(match="boundary_friction_coefficient 0.2, fitted for 0.1 to 0.15"):
        mixed(contact(), boundary_friction_coefficient=0.2)
    with quiet("friction-range"):
        rough = mixed(contact(), rms_slope=0.3).asperities
    assert np.all(rough > mixed(contact(), rms_slope=0.05).asperities)


OIL = Lubricant(0.03, 860.0, 1.8e-8)
SPEEDS = np.array([0.5, 3.0, 12.0])


def test_power_law_of_the_film_is_that_of_its_formula():
    film = mixed_line_contact(1e5, 8e-3, SPEEDS, OIL, MODULUS, FLANKS)
    share, gap = balanced_load_share(film.smooth_film, film.hertz_pressure, MODULUS, FLANKS)
    assert film.film_load_share == pytest.approx(share, rel=1e-8)
    assert film.gap == pytest.approx(gap, rel=1e-8)
    assert film.film_load + film.asperity_load == pytest.approx(np.full(3, 1e5), rel=1e-12)


@pytest.mark.parametrize("model", ["moes", "pan-hamrock", "newton"])
def test_film_carries_its_own_share_at_the_gap_at_which_asperities_carry_theirs(model):
    options = {"nodes": 257} if model == "newton" else {}
    speeds = SPEEDS[:2]
    mixed_film = mixed_line_contact(
        1e5, 8e-3, speeds, OIL, MODULUS, FLANKS, film_model=model, **options
    )
    for i, f in enumerate(mixed_film.film_load_share):
        film = FILM_MODELS[model].films(
            f * 1e5, 8e-3, speeds[i], OIL, float(f) * MODULUS, **options
        )
        assert film.central_film == pytest.approx(mixed_film.gap[i], rel=1e-6)
        # The flanks keep the width that the whole load gives them.
        width = math.sqrt(8.0 * f * 1e5 * 8e-3 / (math.pi * f * MODULUS))
        assert mixed_film.half_width[i] == pytest.approx(width, rel=1e-12)
    law, _ = balanced_load_share(mixed_film.smooth_film, mixed_film.hertz_pressure, MODULUS, FLANKS)
    # The law, which knows no more than the film under the whole load, is as near as this.
    assert mixed_film.film_load_share == pytest.approx(law, abs=0.06)


def test_rough_contacts_without_film_model_or_in_a_table_are_refused():
    with pytest.raises(InputError, match='film_model = "none"'):
        mixed_line_contact(1e5, 8e-3, 1.0, OIL, MODULUS, FLANKS, film_model="none")
    with pytest.raises(InputError, match="arrays of 2 axes"):
        mixed_line_contact(np.full((2, 2), 1e5), 8e-3, 1.0, OIL, MODULUS, FLANKS)
