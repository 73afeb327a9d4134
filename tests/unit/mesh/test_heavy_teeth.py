"""Heavy loads: the force law ends where the formula of the local compression does."""

import math
import warnings

import numpy as np
import pytest

from tribodyn.errors import ComputationError, ModelWarning
from tribodyn.gear import Material, cylindrical_pair
from tribodyn.stiffness.loaded import contact_problem
from tribodyn.stiffness.loaded.ramps import force_ramps


def _problem(helix_angle):
    pair = cylindrical_pair(
        pinion_teeth=19, wheel_teeth=31, normal_module=2e-3, helix_angle=math.radians(helix_angle),
        normal_pressure_angle=math.radians(20.0), pinion_face_width=0.02,
        pinion_profile_shift_coefficient=0.45, pinion_bore_diameter=0.01,
        wheel_bore_diameter=0.01,
    )  # fmt: skip
    phase = np.linspace(0.0, 0.95, 12)
    return contact_problem(
        pair, provider="analytic", phase=phase, total_force=2e3, material=Material()
    )


def _greatest_load(problem):
    """Load up to which the teeth can be solved [N], to a per cent, by bisection."""
    low, high = 1e3, 1e8
    while high > 1.01 * low:
        middle = math.sqrt(low * high)
        try:
            problem.at_loads(np.array([middle]))
            low = middle
        except ComputationError:
            high = middle
    return low


@pytest.mark.parametrize("helix_angle", [0.0, 25.0])
@pytest.mark.parametrize("margin", [1.1, 2.2, 3.3])
def test_law_reaches_as_far_as_the_teeth_can_be_solved(helix_angle, margin):
    problem = _problem(helix_angle)
    load = _greatest_load(problem) / margin
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ModelWarning)
        place, slope, error = force_ramps(problem, load)
    told = [w.message for w in caught if w.message.code == "force-law"]
    assert len(told) == (margin < 3.0)
    assert error < 1e-2
    approach = problem.at_loads(np.array([load])).approach[0]
    force = (slope * np.maximum(approach[:, None] - place, 0.0)).sum(axis=1)
    np.testing.assert_allclose(force, load, rtol=2e-2)


def test_a_load_that_the_teeth_cannot_be_solved_under_is_refused():
    problem = _problem(0.0)
    with pytest.raises(ComputationError, match="as wide as the teeth are thick"):
        force_ramps(problem, 1.1 * _greatest_load(problem))
