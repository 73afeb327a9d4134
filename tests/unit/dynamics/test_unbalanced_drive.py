"""The warning of a drive that speeds up counts the friction of the teeth."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from tribodyn.dynamics import Contact, LoadFriction, System, harmonic_balance
from tribodyn.errors import ModelWarning

FRICTION = 0.05


def drive(output, *, over_phases, follows_load):
    """Two gears that turn freely, whose teeth rub by 5 % of their force on both."""
    rub = lambda x: np.outer(1.0 + np.sin(2 * np.pi * x), [FRICTION, FRICTION])  # noqa: E731
    clock = {"cycles": (1, 0), "turning_cycles": (0, 1)} if over_phases else {"turning_cycles": ()}
    contact = Contact(
        [1.0, -1.0], lambda x: 3e8 * (1 + 0.15 * np.cos(2 * np.pi * x)), 800.0,
        friction=None if follows_load else rub,
        turning_error=(lambda x: 1e-6 * np.cos(2 * np.pi * x)) if over_phases else (), **clock,
    )  # fmt: skip
    frictions = [LoadFriction(rub, [1.0], 3e3, (0,))] if follows_load else []
    none = np.zeros((2, 2))
    return System(np.diag([1.2, 0.8]), none, none, [3e3, -output], [contact], frictions=frictions)


@pytest.mark.parametrize("follows_load", [False, True])
@pytest.mark.parametrize("over_phases", [False, True])
def test_loads_that_balance_with_friction_give_no_warning(over_phases, follows_load):
    frequency = (1200.0, 70.1) if over_phases else 1200.0
    options = {"over_phases": over_phases, "follows_load": follows_load}
    balanced = 3e3 * (1.0 - FRICTION) / (1.0 + FRICTION)  # N (1 + f) = 3e3, N (1 - f) = output
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert harmonic_balance(drive(balanced, **options), frequency).converged
    with pytest.warns(ModelWarning, match=r"loads and friction .* do not balance"):
        harmonic_balance(drive(0.7 * balanced, **options), frequency)
