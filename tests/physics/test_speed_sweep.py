"""Steady motions over the speed in both directions: jumps, stability, doubled periods."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from known_systems import hysteresis_system, reference_system
from references.backlash_orbits import HIGH, LOW
from tribodyn.analysis import rms
from tribodyn.dynamics import Contact, System, continuation, speed_sweep, steady_state
from tribodyn.errors import InputError

TURN = 2 * np.pi


def test_two_motions_between_the_folds_of_the_oscillator_with_backlash() -> None:
    # Case H1: stable branches overlap for 0.8344 < W < 0.9069; rms and multipliers at 0.88
    W = np.arange(0.81, 0.93, 0.002)
    sweep = speed_sweep(hysteresis_system(), W / TURN)
    up, down = (next(j for j in sweep.jumps if j.direction == way) for way in ("up", "down"))
    assert len(sweep.jumps) == 2
    assert TURN * up.before < 0.9069 < TURN * up.after
    assert TURN * down.after < 0.8344 < TURN * down.before
    place = W[sweep.differs]
    assert place[0] == pytest.approx(0.8344, abs=0.0021)
    assert place[-1] == pytest.approx(0.9069, abs=0.0021)
    at = int(np.argmin(np.abs(W - 0.88)))
    assert sweep.rms[:, at, 0] == pytest.approx([LOW, HIGH], rel=3e-6)
    assert np.abs(sweep.floquet_multipliers[:, at, 0]) == pytest.approx(0.699773, rel=3e-5)
    assert sweep.stable.all()
    assert sweep.contact_loss[0, at, 0] == 0.0
    assert sweep.contact_loss[1, at, 0] > 0.1
    assert sweep.to_xarray().rms.dims == ("direction", "mesh_frequency", "signal")


def test_linear_orbits_are_those_of_single_computations() -> None:
    system = replace(reference_system(0.1), balance=[0.0, 0.0, 0.0, 0.0, 0.0, -1.0])
    beats = np.array([240.0, 1500.0, 2900.0, 5800.0])
    sweep = speed_sweep(system, beats, steps=1024)
    assert sweep.error.max() < 1e-9
    for number, beat in enumerate(beats):
        orbit = steady_state(system, beat, steps=1024)
        largest = np.abs(orbit.floquet_multipliers[0])
        assert np.abs(sweep.floquet_multipliers[:, number, 0]) == pytest.approx(
            float(largest), rel=1e-5
        )
        force = float(rms(orbit.fine, orbit.fine.contact_force[:, 0]))
        amplitude = np.hypot(*(part[0, number, 1] for part in (sweep.rms, sweep.mean)))
        assert amplitude == pytest.approx(force, rel=2e-6)
        assert sweep.extra_force[0, number] == pytest.approx(orbit.extra_force, rel=1e-5)


def test_unstable_orbits_of_a_linear_system_are_marked() -> None:
    # Mathieu: stiffness 1 + 0.5 cos, instability about W = 2; Hill's determinant gives its edges
    teeth = Contact([1.0], stiffness=lambda p: 1.0 + 0.5 * np.cos(TURN * p))
    system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [teeth])
    W = np.arange(1.5, 2.5, 0.01)
    sweep = speed_sweep(system, W / TURN)
    wild = W[~sweep.stable[0]]
    # first order of the stability chart: W = 2 +- eps/2, with damping sqrt((eps/2)^2 - (2 c)^2)
    half = np.sqrt(0.25**2 - 0.2**2 * 0.25)
    assert wild[0] == pytest.approx(2.0 - half, abs=0.05)
    assert wild[-1] == pytest.approx(2.0 + half, abs=0.05)


def test_a_motion_that_repeats_every_second_cycle_is_detected() -> None:
    # With backlash the instability of the Mathieu oscillator ends in a motion of two cycles
    teeth = Contact([1.0], stiffness=lambda p: 1.0 + 0.5 * np.cos(TURN * p), gap=1.0)
    system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [teeth])
    W = np.arange(2.10, 2.30, 0.02)
    sweep = speed_sweep(system, W / TURN, directions=("down",), patience=1500)
    # the doubling lies at 2.218242
    assert sweep.period[0, W > 2.225].tolist() == [1] * int(np.sum(W > 2.225))
    inside = (sweep.period[0] == 2) & (W < 2.21)
    assert inside.any()
    at = int(np.flatnonzero(inside)[-1])
    start = (sweep.position[0, at], sweep.velocity[0, at])
    orbit = steady_state(system, W[at] / TURN, periods=2, start=start)
    assert orbit.period == 2
    level = np.sqrt(orbit.fine.mean((orbit.position[:, 0].mean() - orbit.fine.position[:, 0]) ** 2))
    assert sweep.rms[0, at, 0] == pytest.approx(level, rel=1e-2)


def test_folds_of_the_pair_agree_with_continuation() -> None:
    system = replace(reference_system(0.1, gap=20e-6), balance=[0.0, 0.0, 0.0, 0.0, 0.0, -1.0])
    beats = np.linspace(2430.0, 2520.0, 31)
    sweep = speed_sweep(system, beats, steps=512)
    branch = continuation(system, between=(2430.0, 2520.0), steps=512, longest_step=0.1)
    folds = sorted(point.parameter for point in branch.special("fold"))
    up = [jump for jump in sweep.jumps if jump.direction == "up"]
    down = [jump for jump in sweep.jumps if jump.direction == "down"]
    assert up[0].before < folds[-1] < up[0].after
    assert down[0].after < folds[0] < down[0].before
    assert sweep.teeth == 1
    assert "jumps" in repr(sweep)
    names = {trace.name for trace in sweep.plot().data}
    assert {"upwards", "downwards", "jump"} <= names


def test_bad_arguments_are_refused() -> None:
    system = hysteresis_system()
    with pytest.raises(InputError, match="do not rise"):
        speed_sweep(system, [0.2, 0.1])
    with pytest.raises(InputError, match="directions"):
        speed_sweep(system, [0.1, 0.2], directions=("left",))
    with pytest.raises(InputError, match="omit steps"):
        speed_sweep(reference_system(), [10.0, 20.0], steps=64)
