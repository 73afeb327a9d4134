"""The rectangular stiffness: its two forms and their contradictions."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError
from tribodyn.stiffness import rectangular_stiffness

ZONES = np.array([[True, True], [True, False]])


def test_the_mean_of_a_constant_pair_stiffness_is_the_contact_ratio_times_it(fzg):
    contact = path_of_contact(fzg())
    phase = (np.arange(100_000) + 0.5) / 100_000
    _, in_contact = contact.pair_paths(phase)
    total = rectangular_stiffness(in_contact, pair_stiffness=2e8).sum(axis=1)
    assert total.mean() == pytest.approx(2e8 * contact.contact_ratio, rel=1e-5)


def test_mesh_values_are_totals():
    stiffness = rectangular_stiffness(ZONES, single_pair_stiffness=2e8, double_pair_stiffness=3.2e8)
    assert stiffness.sum(axis=1).tolist() == [3.2e8, 2e8]
    assert stiffness[0, 0] == stiffness[0, 1]


def test_both_forms_are_refused_with_both_values():
    with pytest.raises(InputError, match=r"pair_stiffness = 2e\+08 N/m.*3e\+08 N/m"):
        rectangular_stiffness(ZONES, pair_stiffness=2e8, double_pair_stiffness=3e8)


def test_half_of_the_second_form_is_refused():
    with pytest.raises(InputError, match="double_pair_stiffness not given"):
        rectangular_stiffness(ZONES, single_pair_stiffness=2e8)


@pytest.mark.parametrize("value", [0.0, -1e8, np.nan, np.inf])
def test_a_value_that_is_no_stiffness_is_refused(value):
    with pytest.raises(InputError, match="pair_stiffness"):
        rectangular_stiffness(ZONES, pair_stiffness=value)
    with pytest.raises(InputError, match="single_pair_stiffness"):
        rectangular_stiffness(ZONES, single_pair_stiffness=value, double_pair_stiffness=3e8)


def test_mesh_values_do_not_describe_three_pairs():
    with pytest.raises(InputError, match="3 pairs in contact"):
        rectangular_stiffness(
            np.array([[True, True, True]]), single_pair_stiffness=2e8, double_pair_stiffness=3e8
        )
