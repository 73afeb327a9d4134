"""The involute function and its inverse."""

import math

import pytest

from tribodyn.errors import InputError
from tribodyn.gear.curves import inverse_involute, involute


@pytest.mark.parametrize("degrees", [0.01, 1.0, 10.0, 20.0, 45.0, 80.0, 89.0])
def test_inverse_undoes_the_function(degrees: float) -> None:
    angle = math.radians(degrees)
    # Cancellation in tan - angle limits what can be recovered from a small value.
    slack = 4e-16 / math.tan(angle) ** 2 * angle + 1e-15
    assert inverse_involute(involute(angle)) == pytest.approx(angle, abs=slack)


def test_ends() -> None:
    assert inverse_involute(0.0) == 0.0
    assert inverse_involute(1000.0) < math.pi / 2.0


@pytest.mark.parametrize("value", [-1e-9, math.nan, math.inf])
def test_values_without_an_angle_are_refused(value: float) -> None:
    with pytest.raises(InputError, match="value"):
        inverse_involute(value)
