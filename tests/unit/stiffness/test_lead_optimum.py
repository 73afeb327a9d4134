"""Search of crowning and slope over the face: what it must find, and what it must not worsen."""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import FlankModification, cylindrical_pair
from tribodyn.stiffness import loaded_contact, optimize_lead


def helical(**changes):
    return cylindrical_pair(
        pinion_teeth=27,
        wheel_teeth=51,
        normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(21.0),
        pinion_face_width=50e-3,
        **changes,
    )


def test_a_misalignment_is_taken_back_by_the_slope():
    """One torque: the slope cancels the misalignment and nothing is crowned."""
    best = optimize_lead(helical(), 600.0, provider="iso6336", misalignment=12e-6, phases=16)
    assert best.lead_slope == pytest.approx(-12e-6, abs=0.3e-6)
    assert best.crowning == pytest.approx(0.0, abs=0.3e-6)
    assert best.face_load_factor_before > 1.2
    assert best.face_load_factor_after < 1.03


def test_misalignment_that_grows_with_the_torque_needs_a_compromise():
    torques = np.array([200.0, 600.0])
    best = optimize_lead(
        helical(), torques, provider="iso6336", misalignment=[2e-6, 20e-6], phases=8, slices=12
    )
    assert best.torque.size == 5
    assert best.face_load_factor_after.max() < best.face_load_factor_before.max()
    assert -20e-6 < best.lead_slope < -2e-6


def test_the_pair_that_is_found_has_the_load_that_is_reported():
    class Counting:
        tasks: ClassVar[list[str]] = []
        steps = 0

        def start(self, task, total=None):
            self.tasks.append(task)

        def advance(self, steps=1):
            self.steps += steps

        def finish(self):
            self.tasks.append("")

    options = {"provider": "fe2d", "reference": "rim", "phases": 8}
    torques, progress = [300.0, 400.0, 600.0], Counting()
    best = optimize_lead(helical(), torques, progress=progress, **options)
    for torque, before, after in zip(
        torques, best.face_load_factor_before, best.face_load_factor_after, strict=True
    ):
        loaded = loaded_contact(best.modified_pair, torque, slices=24, **options)
        assert float(loaded.face_load_factor) == pytest.approx(after, rel=1e-9)
        assert after <= before + 1e-6
    assert progress.tasks[-2:] == ["crowning and slope over the face", ""]
    assert progress.steps > 21  # a grid of so many, and the simplex


def test_a_spur_pair_is_searched_slice_by_slice():
    crowned = FlankModification(crowning=15e-6)
    pair = cylindrical_pair(
        pinion_teeth=20,
        wheel_teeth=30,
        normal_module=4e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=0.0,
        pinion_face_width=30e-3,
        pinion_modification=crowned,
    )
    best = optimize_lead(pair, 200.0, provider="iso6336", slices=11, phases=8)
    assert best.crowning == pytest.approx(0.0, abs=0.1e-6)
    assert best.face_load_factor_after[0] == pytest.approx(1.0, abs=5e-3)


def test_ranges_and_words_are_checked():
    with pytest.raises(InputError, match="crowning = 5 to 1 um"):
        optimize_lead(helical(), 600.0, crowning=(5e-6, 1e-6))
    with pytest.raises(InputError, match='gear = "ring"'):
        optimize_lead(helical(), 600.0, gear="ring")
    with pytest.raises(InputError, match="3 misalignments"):
        optimize_lead(helical(), [100.0, 600.0], misalignment=[1e-6, 2e-6, 3e-6])
