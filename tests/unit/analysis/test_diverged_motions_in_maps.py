"""Diagrams and maps mark motions that grew beyond all bounds."""

import numpy as np

from tribodyn.analysis import bifurcation, parameter_map
from tribodyn.dynamics import Contact, System


def pumped():
    """An oscillator whose stiffness swings: at twice its frequency it grows without bounds."""
    pair = Contact([1.0], lambda phase: 1.0 + 0.8 * np.cos(2.0 * np.pi * phase))
    return System([[1.0]], [[0.02]], [[0.0]], [0.5], [pair])


def test_a_parametric_resonance_over_the_mesh_frequency():
    values = np.array([2.0, 6.0]) / (2.0 * np.pi)
    diagram = bifurcation(
        pumped(), values, sweep="independent", steps=128, transient=8000, cycles=8, keep=8
    )
    assert diagram.ran_away.tolist() == [[True, False]]
    assert diagram.verdict.tolist() == [["undecided", "physical"]]
    assert repr(diagram).endswith("1 physical, 1 undecided, 1 ran away)")


def test_a_parametric_resonance_in_a_map():
    over = (("mesh_frequency", np.array([2.0, 6.0]) / (2.0 * np.pi)), ("force_scale", [1.0]))
    map_result = parameter_map(pumped(), over=over, signal="q0", steps=128, transient=8000)
    assert map_result.ran_away.tolist() == [[True], [False]]
    assert repr(map_result).endswith("1 ran away)")
    assert "1 of 2 responses grows without bound" in map_result.plot().layout.title.text
