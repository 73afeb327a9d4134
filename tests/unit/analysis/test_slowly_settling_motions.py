"""A motion that turns while it settles is not taken for one that repeats after several cycles."""

import numpy as np
import pytest

from tribodyn.analysis import parameter_map
from tribodyn.dynamics import Contact, System

TURN = 2.0 * np.pi


@pytest.mark.parametrize("ratio", [1.0 / 6.0, 1.0 / 7.0, 2.0 / 5.0])
def test_a_linear_motion_repeats_after_one_cycle_or_has_not_settled(ratio):
    # The free motion turns by a part of a turn per mesh cycle, and decays by 2 % in it.
    mesh_frequency = 1.0 / (TURN * ratio)
    contact = Contact([1.0], 1.0, error=lambda phase: 0.1 * np.cos(TURN * phase))
    damping = 2.0 * 0.02 * mesh_frequency
    system = System([[1.0]], [[damping]], [[0.0]], [1.0], [contact])
    frequencies = mesh_frequency * np.array([1.0, 1.0001])
    over = (("mesh_frequency", frequencies), ("force_scale", [1.0, 2.0]))
    long = parameter_map(system, over=over, transient=1600, steps=64)
    assert np.all(long.period == 1)
    # The state falls by 0.98 in a cycle: what is known after 96 cycles is no period.
    short = parameter_map(system, over=over, transient=96, steps=64)
    assert np.all((short.period == 0) | (short.period == 1))
