"""The foundation formula of Sainsot, Velex and Duverger."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError, ModelWarning
from tribodyn.gear import Material
from tribodyn.stiffness import sainsot_coefficients, sainsot_compliance, wind_up_compliance


def test_coefficients_worked_by_hand():
    theta, h = 0.08, 3.0
    coefficients = sainsot_coefficients(theta, h * 0.01, 0.01)
    by_hand = (
        -5.574e-5 / theta**2 - 1.9986e-3 * h**2 - 2.3015e-4 * h / theta + 4.7702e-3 / theta
        + 0.0271 * h + 6.8045,
        60.111e-5 / theta**2 + 28.1e-3 * h**2 - 83.431e-4 * h / theta - 9.9256e-3 / theta
        + 0.1624 * h + 0.9086,
        -50.952e-5 / theta**2 + 185.5e-3 * h**2 + 0.0538e-4 * h / theta + 53.3e-3 / theta
        + 0.2895 * h + 0.9236,
        -6.2042e-5 / theta**2 + 9.0889e-3 * h**2 - 4.0964e-4 * h / theta + 7.8297e-3 / theta
        - 0.1472 * h + 0.6904,
    )  # fmt: skip
    assert coefficients == pytest.approx(by_hand, rel=1e-12)


def test_the_published_extremes_are_reached():
    # The extremes printed with the polynomials check the table as a whole.
    thetas, ratios = np.linspace(0.02, 0.12, 41), np.linspace(1.4, 7.0, 41)
    values = np.array([sainsot_coefficients(t, h, 1.0) for t in thetas for h in ratios])
    assert values[:, 0].max() == pytest.approx(6.94, rel=0.01)
    assert values[:, 2].max() == pytest.approx(13.47, rel=0.01)
    assert values[:, 3].min() == pytest.approx(0.141, rel=0.015)


def test_above_the_fitted_angle_little_changes():
    for h in (2.0, 4.0, 7.0):
        at_end = np.array(sainsot_coefficients(0.12, h, 1.0))
        beyond = np.array(sainsot_coefficients(0.25, h, 1.0))
        assert beyond == pytest.approx(at_end, rel=0.13)


@pytest.mark.parametrize("ratio", [5.0, 7.0])
def test_the_formula_contains_the_wind_up_of_the_body(ratio):
    # Between two bores the foundation must differ by the torsion of the ring between them.
    material, root, width = Material(), 0.05, 0.02
    compliances = [
        sainsot_compliance(0.35, 0.0, 0.1, root, root / h, width, material) for h in (2.0, ratio)
    ]
    # The load is tangent to the base circle and crosses the tooth axis at the root circle.
    base = root * np.cos(0.35)
    ring = [wind_up_compliance(base, root, root / h, width, material) for h in (2.0, ratio)]
    assert compliances[1] - compliances[0] == pytest.approx(ring[1] - ring[0], rel=0.13)


@pytest.mark.parametrize(("angle", "ratio"), [(0.1, 1.02), (0.1, 7.5), (0.3, 3.0), (0.005, 3.0)])
def test_outside_its_range_it_warns(angle, ratio):
    with pytest.warns(ModelWarning, match="foundation-range"):
        sainsot_coefficients(angle, 0.05, 0.05 / ratio)


@pytest.mark.parametrize("position", [0, 1, 2])
def test_arguments_of_the_coefficients_must_be_positive(position):
    arguments = [0.1, 0.05, 0.02]
    arguments[position] = 0.0
    with pytest.raises(InputError, match="greater than zero"):
        sainsot_coefficients(*arguments)
