"""Diagrams and maps say of a motion that grew beyond all bounds that it did."""

import numpy as np

from tribodyn.analysis import bifurcation, parameter_map
from tribodyn.dynamics import Contact, System


def pumped():
    """An oscillator whose stiffness swings: at twice its frequency it grows without bounds."""
    pair = Contact([1.0], lambda phase: 1.0 + 0.8 * np.cos(2.0 * np.pi * phase))
    return System([[1.0]], [[0.02]], [[0.0]], [0.5], [pair])


def test_a_parametric_resonance_over_the_mesh_frequency():
    values = np.array([2.0, 6.0]) / (2.0 * np.pi)
    found = bifurcation(
        pumped(), values, sweep="independent", steps=128, transient=8000, cycles=8, keep=8
    )
    assert found.ran_away.tolist() == [[True, False]]
    assert found.verdict.tolist() == [["undecided", "physical"]]
    assert repr(found).endswith("1 physical, 1 undecided, 1 ran away)")


def test_a_parametric_resonance_in_a_map():
    over = (("mesh_frequency", np.array([2.0, 6.0]) / (2.0 * np.pi)), ("force_scale", [1.0]))
    found = parameter_map(pumped(), over=over, signal="q0", steps=128, transient=8000)
    assert found.ran_away.tolist() == [[True], [False]]
    assert repr(found).endswith("1 ran away)")
    assert "1 of 2 responses grows without bound" in found.plot().layout.title.text
