"""Seals, churning and windage."""

from __future__ import annotations

import math

import pytest

from tribodyn.errors import InputError, ModelWarning
from tribodyn.losses import churning_loss, seal_loss, windage_loss

RPM = math.pi / 30.0
#: R, b, m, h [m], omega [rad/s], V [m^3], rho, nu
BATH = (54.9e-3, 20e-3, 4.5e-3, 30e-3, 30.0, 1.2e-3, 880.0, 60e-6)


def test_printed_seal():
    assert seal_loss(30e-3, 1400.0 * RPM) == pytest.approx(9.69, abs=5e-3)
    assert seal_loss(30e-3, 1400.0 * RPM) == pytest.approx(7.69e-6 * 30.0**2 * 1400.0, rel=1e-12)
    with pytest.raises(InputError, match="shaft_diameter"):
        seal_loss(0.0, 100.0)


def printed_churning(speed, *, fast):
    radius, width, module, depth, _, volume, density, viscosity = BATH
    theta = math.acos(1.0 - depth / radius)
    surface = radius**2 * (2 * theta - math.sin(2 * theta)) + 2 * radius * width * theta
    surface += 2.0 * (2 * radius / module) * theta * 2.25 * module * width / math.pi
    froude, reynolds = speed**2 * radius / 9.80665, speed * radius**2 / viscosity
    h, v, b = depth / (2 * radius), volume / (2 * radius) ** 3, width / (2 * radius)
    if fast:
        factor = 3.644 * h**0.1 * v**-0.35 * froude**-0.88 * b**0.85
    else:
        factor = 1.366 * h**0.45 * v**0.1 * froude**-0.6 * reynolds**-0.21
    return 0.5 * density * speed**3 * surface * radius**3 * factor


def churned(**changes):
    names = ("pitch_radius", "face_width", "module", "immersion", "speed", "oil_volume",
             "oil_density", "kinematic_viscosity")  # fmt: skip
    return churning_loss(**{**dict(zip(names, BATH, strict=True)), **changes})


def test_churning_slow_and_fast_and_between():
    bound = math.sqrt(54.9e-3 * 4.5e-3)
    slow, fast = 0.9 * math.sqrt(750.0 / bound), 1.1 * math.sqrt(1250.0 / bound)
    assert churned(speed=slow) == pytest.approx(printed_churning(slow, fast=False), rel=1e-12)
    assert churned(speed=fast) == pytest.approx(printed_churning(fast, fast=True), rel=1e-12)
    middle = math.sqrt(1000.0 / bound)
    ends = [printed_churning(middle, fast=kind) for kind in (False, True)]
    assert churned(speed=middle) == pytest.approx(sum(ends) / 2.0, rel=1e-12)


def test_no_oil_and_no_speed_churn_nothing():
    assert churned(immersion=0.0) == churned(speed=0.0) == 0.0
    assert churned(immersion=1e-9) < 1e-3 * churned()
    with pytest.raises(InputError, match="immersion"):
        churned(immersion=60e-3)
    with pytest.raises(InputError, match="oil_volume"):
        churned(oil_volume=0.0)


def test_windage():
    wanted = 2.82e-7 * (1.0 + 2.3 * 0.5) * (1000.0 / RPM) ** 2.8 * 0.1**4.6 * 0.299**0.2
    assert windage_loss(0.1, 0.05, 1000.0, 0.01) == pytest.approx(1e3 * wanted, rel=1e-12)
    assert windage_loss(0.1, 0.05, 0.0) == 0.0
    assert windage_loss(0.1, 0.05, 200.0) == pytest.approx(
        windage_loss(0.1, 0.05, 100.0) * 2.0**2.8
    )
    with pytest.warns(ModelWarning, match="windage-range.*250 m/s"):
        windage_loss(0.1, 0.05, 2500.0)
