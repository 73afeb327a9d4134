"""Faults of hypoid pairs: errors of the mesh at rest, and their lines in the motion."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import tribodyn
from tribodyn.errors import InputError
from tribodyn.faults import PitchDeviations
from tribodyn.study.faults.motion import TurningMotion, turning_mesh_of, turning_motion
from tribodyn.study.faults.section import bevel_gears
from tribodyn.study.pipeline.run import PreparedRun, prepare_run

SOUND = {
    "friction.law": "constant", "friction.coefficient": 0.05, "film.model": "dowson-higginson",
    "friction.boundary_friction_coefficient": None,
}  # fmt: skip


@pytest.fixture(scope="module")
def sound() -> PreparedRun:
    return prepare_run(tribodyn.load_case("hypoid-mixed-ehl").replace(SOUND))


def with_fault(sound: PreparedRun, **keys: Any) -> PreparedRun:
    fault = {f"faults.it.{key}": value for key, value in {"gear": "pinion", **keys}.items()}
    return replace(sound, case=sound.case.replace(fault))


def static_lines(run: PreparedRun) -> np.ndarray:
    values = turning_mesh_of(run.case, run.mesh).transmission_error[:-1]
    return 2.0 * np.abs(np.fft.rfft(values)) / values.size


def orders(motion: TurningMotion) -> np.ndarray:
    """Amplitudes [m] at multiples of the frequency of all turns."""
    return np.abs(motion.harmonics("transmission_error")[1])


@pytest.mark.parametrize(("gear", "order", "cycles"), [("pinion", 1, 10), ("wheel", 7, 43)])
def test_a_wave_is_one_line_of_its_amplitude(
    sound: PreparedRun, gear: str, order: int, cycles: int
) -> None:
    wave = {"kind": "waviness", "gear": gear, "order": order, "phase": "40 deg"}
    none, five = (
        static_lines(with_fault(sound, **wave, amplitude=size)) for size in ("0 um", "5 um")
    )
    assert (
        turning_mesh_of(with_fault(sound, **wave, amplitude=0.0).case, sound.mesh).cycles == cycles
    )
    added = five - none
    assert abs(added[order] - 5e-6) < 1e-12
    added[order] = 0.0
    assert np.abs(added[1:]).max() < 1e-12
    # without the wave, what is left repeats with the mesh
    assert none[np.arange(none.size) % cycles > 0].max() < 1e-12


def test_pitch_deviations_are_shared_as_the_load(sound: PreparedRun) -> None:
    keys = {"kind": "pitch-deviations", "accuracy_class": 7, "seed": 3}
    run = with_fault(sound, **keys)
    mesh = turning_mesh_of(run.case, run.mesh)
    pinion = bevel_gears(run.case, run.mesh)["pinion"]
    places = np.cumsum(PitchDeviations(accuracy_class=7, seed=3).single(pinion))
    gaps = (places - places[0]) * pinion.lever / pinion.reference_radius
    np.testing.assert_allclose(mesh.load_share.sum(axis=1), 1.0, rtol=1e-9)
    alone = turning_mesh_of(sound.case, sound.mesh).transmission_error
    steps = alone.size - 1
    for cycle in (0, 4, 9):  # where pairs change, and in the middle between
        for step in (0, steps // 2):
            row = cycle * steps + step
            share = mesh.load_share[row]
            expected = sum(part * gaps[(cycle - j) % 10] for j, part in enumerate(share))
            assert abs(mesh.transmission_error[row] - alone[step] - expected) < 1e-12
    # a lever is the torque over the force
    force = sound.mesh.total_normal_force
    assert abs(sound.case.pinion_torque / force / pinion.lever - 1.0) < 0.02


def test_lines_of_the_motion_are_those_of_the_shafts(sound: PreparedRun) -> None:
    eccentric = turning_motion(
        with_fault(sound, kind="eccentricity", amplitude="10 um"),
    )
    line = orders(eccentric)
    assert abs(eccentric.rotation_frequency("pinion") - 50.0) < 1e-9
    assert abs(eccentric.harmonics("mesh_force")[0][1] - 50.0) < 1e-9
    mesh, sides = line[[10, 20]], line[[9, 11, 19, 21]]
    others = np.delete(line[:25], [0, 1, 9, 10, 11, 19, 20, 21])
    assert sides.min() > 1e3 * others.max()
    assert sides.max() < 0.01 * mesh.max()
    ripple = turning_motion(with_fault(sound, kind="torque-ripple", orders=[2], torques=["20 N*m"]))
    twice = orders(ripple)
    assert ripple.cycles == 5
    assert twice[1] > 10.0 * np.delete(twice[:5], [0, 1]).max()  # order 2 of the pinion
    assert orders(turning_motion(with_fault(
        sound, kind="torque-ripple", orders=[2], torques=["10 N*m"]
    )))[1] == pytest.approx(0.5 * twice[1], rel=0.02)  # fmt: skip


def test_damage_of_one_tooth_is_refused(sound: PreparedRun) -> None:
    with pytest.raises(InputError, match="Kinds of hypoid pairs are eccentricity, waviness"):
        with_fault(sound, kind="broken-tooth", tooth=1)
    with pytest.raises(InputError, match="Waves of hypoid pairs are uniform"):
        with_fault(sound, kind="waviness", order=3, amplitude="1 um", lead_angle="2 deg")
