"""Frictional moments of bearings: the printed model once more, limits, refusals."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tribodyn.errors import InputError
from tribodyn.losses import BEARINGS, RollingBearing, bearing_moments

RPM = math.pi / 30.0


def sliding_friction(n, nu, dm, full):
    boundary = math.exp(-2.6e-8 * (n * nu) ** 1.4 * dm)
    return 0.12 * boundary + full * (1.0 - boundary)


def factors(n, nu, d, D, k_z):
    dm = 0.5 * (d + D)
    heating = 1.0 / (1.0 + 1.84e-9 * (n * dm) ** 1.28 * nu**0.64)
    starving = math.exp(-3e-8 * nu * n * (d + D) * math.sqrt(k_z / (2.0 * (D - d))))
    return heating * starving * (nu * n) ** 0.6


@pytest.mark.parametrize(("n", "nu", "radial"), [(1400.0, 60.0, 2000.0), (300.0, 200.0, 500.0)])
def test_cylindrical_rollers_in_the_units_of_the_catalogue(n, nu, radial):
    moments = bearing_moments(BEARINGS["NJ 406"], n * RPM, nu * 1e-6, radial, 100.0)
    rolling = factors(n, nu, 30.0, 90.0, 5.1) * 1e-6 * 60.0**2.41 * radial**0.31
    sliding = (0.16 * 60.0**0.9 * 100.0 + 0.0015 * 60.0 * radial) * sliding_friction(
        n, nu, 60, 0.02
    )
    assert 1e3 * moments.rolling == pytest.approx(rolling, rel=1e-12)
    assert 1e3 * moments.sliding == pytest.approx(sliding, rel=1e-12)
    assert moments.seal == moments.drag == 0.0
    assert moments.total == moments.rolling + moments.sliding


@pytest.mark.parametrize("axial", [0.0, 300.0, -300.0])
def test_deep_groove_balls(axial):
    n, nu, radial, dm = 1400.0, 60.0, 1000.0, 46.0
    moments = bearing_moments(BEARINGS["6206"], n * RPM, nu * 1e-6, radial, axial)
    if axial:
        angle = math.sin(math.radians(24.6 * (300.0 / 11200.0) ** 0.24))
        rolling = 3.9e-7 * dm**1.96 * (radial + 1.7 / angle * 300.0) ** 0.54
        cubed = radial**5 + 36.5 * dm**1.5 / angle * 300.0**4
        sliding = 3.23e-3 * dm**-0.145 * cubed ** (1 / 3)
    else:
        rolling = 3.9e-7 * dm**1.96 * radial**0.54
        sliding = 3.23e-3 * dm**-0.26 * radial ** (5 / 3)
    assert 1e3 * moments.rolling == pytest.approx(factors(n, nu, 30, 62, 3.1) * rolling, rel=1e-12)
    wanted = sliding * sliding_friction(n, nu, dm, 0.05)
    assert 1e3 * moments.sliding == pytest.approx(wanted, rel=1e-12)


def test_four_point_contact_carries_the_centrifugal_force_of_its_balls():
    n, dm = 1400.0, 65.0
    moments = bearing_moments(BEARINGS["QJ 308"], n * RPM, 60e-6, 2000.0, 500.0)
    turned = 2000.0 + 1.4e-12 * dm**4 * n**2
    rolling = 4.78e-7 * dm**1.97 * (turned + 2.42 * 500.0) ** 0.54
    assert 1e3 * moments.rolling == pytest.approx(
        factors(n, 60.0, 40, 90, 3.1) * rolling, rel=1e-12
    )
    sliding = 1.2e-2 * dm**0.26 * (turned ** (4 / 3) + 0.9 * 500.0 ** (4 / 3))
    wanted = sliding * sliding_friction(n, 60.0, dm, 0.05)
    assert 1e3 * moments.sliding == pytest.approx(wanted, rel=1e-12)


def test_seals_and_drag():
    sealed = replace(BEARINGS["6206"], seal=(0.018, 2.25, 36.0, 20.0))
    moments = bearing_moments(sealed, 100.0, 60e-6, 500.0)
    assert 1e3 * moments.seal == pytest.approx(0.018 * 36.0**2.25 + 20.0)
    n, dm, d, D = 100.0 / RPM, 46.0, 30.0, 62.0
    bath = bearing_moments(BEARINGS["6206"], 100.0, 60e-6, 500.0, drag_factor=5e-4)
    ball = 0.4 * 5e-4 * 3.1 * (d + D) / (D - d) * 1e-12 * dm**5 * n**2
    assert 1e3 * bath.drag == pytest.approx(ball, rel=1e-12)
    deep = bearing_moments(
        BEARINGS["6206"], 100.0, 60e-6, 500.0, drag_factor=5e-4, oil_level=0.6 * dm * 1e-3
    )
    shape = 3.1 * (d + D) / (D - d)
    stirred = 0.36 * dm**2 * math.pi * 0.05 * shape * 1.093e-7 * n**2 * dm**3
    stirred *= (n * dm**2 / 60.0) ** -1.379
    assert 1e3 * deep.drag == pytest.approx(ball + stirred, rel=1e-12)
    rollers = bearing_moments(BEARINGS["NJ 406"], 100.0, 60e-6, 500.0, drag_factor=5e-4)
    slim = 5.0 * 0.65 * 23.0 / 60.0
    full = 2.789e-10 * slim**3 - 2.786e-4 * slim**2 + 0.0195 * slim + 0.6439
    wanted = 4.0 * 5e-4 * 0.65 * 5.1 * 2.0 * 1e-12 * full * 23.0 * 60.0**4 * n**2
    assert 1e3 * rollers.drag == pytest.approx(wanted, rel=1e-12)


def test_standing_bearing_has_sliding_friction_only():
    moments = bearing_moments(BEARINGS["6206"], 0.0, 60e-6, 1000.0)
    assert moments.rolling == moments.drag == 0.0
    running = bearing_moments(BEARINGS["6206"], 1e-6, 60e-6, 1000.0)
    assert moments.sliding == pytest.approx(running.sliding * 0.15 / 0.12, rel=1e-6)


def test_bad_bearings_are_explained():
    with pytest.raises(InputError, match=r'no bearing series is called "99".*NJ 4'):
        RollingBearing("99", 30e-3, 62e-3, 16e-3)
    with pytest.raises(InputError, match="outer_diameter"):
        RollingBearing("62", 62e-3, 30e-3, 16e-3)
    unknown = RollingBearing("62", 30e-3, 62e-3, 16e-3)
    with pytest.raises(InputError, match=r"static_load_rating.*Read C_0"):
        bearing_moments(unknown, 100.0, 60e-6, 500.0, 100.0)
    with pytest.raises(InputError, match="kinematic_viscosity"):
        bearing_moments(BEARINGS["6206"], 100.0, 0.0, 500.0)
