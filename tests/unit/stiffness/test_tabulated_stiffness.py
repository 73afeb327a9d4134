"""Stiffness tables: interpolation, coverage, faults in the table."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError
from tribodyn.stiffness import MODELS, tabulated_stiffness

X = [0.0, 0.25, 0.5, 1.0]
Y = [3e8, 3e8, 2e8, 2e8]


def test_knots_are_met_and_nothing_overshoots():
    fine = tabulated_stiffness(X, Y, np.linspace(0.0, 1.0, 1001))
    assert tabulated_stiffness(X, Y, np.array(X)).tolist() == Y
    assert fine.min() == 2e8
    assert fine.max() == 3e8
    assert np.all(np.diff(fine) <= 0.0)


@pytest.mark.parametrize(
    ("abscissa", "stiffness", "message"),
    [
        ([0.0, 1.0], [1e8], "shape"),
        ([0.0], [1e8], "at least two values"),
        ([0.0, 0.5, 0.5, 1.0], Y, "0.5 is followed by 0.5"),
        ([0.0, 0.7, 0.5, 1.0], Y, "must increase strictly"),
        ([0.0, np.nan, 0.5, 1.0], Y, "entry 2 of abscissa is nan"),
        (X, [3e8, np.nan, 2e8, 2e8], "stiffness of the table = nan"),
        (X, [3e8, -1.0, 2e8, 2e8], "greater than zero"),
        ([0.0, 0.25, 0.5, 0.9], Y, "covers abscissa 0 to 0.9"),
        ([0.1, 0.25, 0.5, 1.0], Y, "The mesh needs 0 to 1"),
    ],
)
def test_faults_of_the_table_are_named(abscissa, stiffness, message):
    with pytest.raises(InputError, match=message):
        tabulated_stiffness(abscissa, stiffness, np.array([0.0, 1.0]))


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_pair_stiffness_over_the_roll_angle_of_the_driving_gear(driver, fzg, steel):
    pair = fzg(driver=driver)
    contact = path_of_contact(pair)
    ends = contact.roll_angles
    phase = np.array([0.0, 0.5])
    path, in_contact = contact.pair_paths(phase)
    stiffness = MODELS["table"](
        pair, steel, path, in_contact, phase, 1.0,
        roll_angle=[ends["A"], ends["E"]], pair_stiffness=[1e8, 2e8],
    )  # fmt: skip
    # Two points make a straight line from A to E: the stiffness follows the way travelled.
    travelled = (phase[:, None] + np.arange(2)) / contact.contact_ratio
    assert stiffness[in_contact] == pytest.approx((1e8 * (1.0 + travelled))[in_contact])


def test_a_roll_angle_table_must_reach_from_entry_to_exit(fzg, steel):
    pair = fzg()
    contact = path_of_contact(pair)
    ends = contact.roll_angles
    phase = np.array([0.5])
    path, in_contact = contact.pair_paths(phase)
    with pytest.raises(InputError, match="Extend the table"):
        MODELS["table"](
            pair, steel, path, in_contact, phase, 1.0,
            roll_angle=[ends["A"], ends["D"]], pair_stiffness=[1e8, 2e8],
        )  # fmt: skip


def test_a_phase_table_must_cover_the_cycle(fzg, steel):
    pair = fzg()
    phase = np.array([0.5])
    path, in_contact = path_of_contact(pair).pair_paths(phase)
    with pytest.raises(InputError, match="The mesh needs 0 to 1"):
        MODELS["table"](
            pair, steel, path, in_contact, phase, 1.0, phase=[0.2, 0.8], mesh_stiffness=[1e8, 2e8]
        )  # fmt: skip


def test_mixed_forms_are_refused(fzg, steel):
    pair = fzg()
    phase = np.array([0.5])
    path, in_contact = path_of_contact(pair).pair_paths(phase)
    with pytest.raises(InputError, match="given: mesh_stiffness, roll_angle"):
        MODELS["table"](
            pair, steel, path, in_contact, phase, 1.0, roll_angle=[0, 1], mesh_stiffness=[1e8, 2e8]
        )  # fmt: skip
