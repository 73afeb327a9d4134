"""What half the step says of sections, phase portraits and exponents."""

from dataclasses import replace

import numpy as np
import pytest

from known_systems import hysteresis_system
from references.backlash_orbits import LOW
from tribodyn.analysis import lyapunov_exponents, phase_portrait, poincare
from tribodyn.dynamics import Contact, System, simulate, steady_state
from tribodyn.errors import InputError
from tribodyn.nonlinear.lyapunov import exponent_verdict
from tribodyn.nonlinear.poincare import alternating_rms, judge_section

BEAT = 0.88 / (2.0 * np.pi)
START = ([1.5], [0.8])


def test_a_section_of_a_well_resolved_motion_is_physical():
    section = poincare(hysteresis_system(), BEAT, start=START, steps=64)
    assert section.verdict == "physical"
    assert repr(section).endswith("period 1, physical)")
    assert section.to_xarray().attrs["verdict"] == "physical"
    plain = poincare(hysteresis_system(), BEAT, start=START, steps=64, verdict=False)
    assert plain.verdict == ""
    assert plain.to_xarray().attrs["verdict"] == ""
    np.testing.assert_array_equal(plain.position, section.position)


def test_a_section_of_too_long_steps_is_not_physical():
    """Near the step limit the integrator damps the motion, whose size then depends on the step."""
    light = System([[1.0]], [[0.02]], [[9.0]], lambda p: np.cos(2 * np.pi * p)[:, None])
    frequency = 3.0 / (2.0 * np.pi)
    coarse = poincare(light, frequency, transient=600, steps=3)
    assert coarse.period == 1
    assert coarse.verdict == "undecided"
    assert poincare(light, frequency, transient=600, steps=64).verdict == "physical"


def test_another_period_or_size_with_half_the_step():
    system, state, force = hysteresis_system(), np.concatenate(START), np.zeros(1)

    def judged(number, period, rms):
        return judge_section(system, BEAT, (state, force), 128, 200, 24, (number, period, rms))

    orbit = steady_state(system, BEAT, start=START)
    rms = alternating_rms(orbit.fine.deflection[:, 0], orbit.fine.weight)
    assert rms == pytest.approx(LOW, rel=1e-5)
    assert judged(0.1, 1, rms) == "physical"
    assert judged(0.1, 2, rms) == "step-limited"
    assert judged(3.0, 1, rms) == "step-limited"
    assert judged(0.1, 1, 1.1 * rms) == "undecided"


def test_a_motion_at_rest_is_physical():
    still = System([[1.0]], [[0.5]], [[0.0]], [2.0], [Contact([1.0], 4.0)])
    section = poincare(still, 1.0, start=([0.5], [0.0]), steps=64)
    assert section.verdict == "physical"


def test_a_motion_has_a_verdict_if_its_system_is_given():
    system = hysteresis_system()
    orbit = steady_state(system, BEAT, start=START)
    assert poincare(orbit).verdict == ""
    assert poincare(orbit, system=system).verdict == "physical"
    portrait = phase_portrait(orbit, 0, gap=1.0, system=system)
    assert portrait.verdict == "physical"
    assert portrait.to_xarray().attrs["verdict"] == "physical"
    assert phase_portrait(orbit, 0).verdict == ""
    limited = replace(portrait, verdict="step-limited")
    assert "depends on the time step" in limited.plot().layout.title.text
    motion = simulate(system, BEAT, 120, START, steps=128)
    assert poincare(motion, transient=80, system=system).verdict == "physical"
    # The section of another system is another motion.
    other = System([[1.0]], [[0.1]], [[0.0]], [0.4], system.contacts)
    assert poincare(motion, transient=80, system=other).verdict != "physical"


def test_exponents_carry_a_verdict():
    options = {"start": START, "cycles": 60, "transient": 200, "steps": 64}
    result = lyapunov_exponents(hysteresis_system(), BEAT, **options)
    assert result.verdict == "physical"
    assert repr(result).endswith("not chaotic, physical)")
    assert result.to_xarray().attrs["verdict"] == "physical"
    plain = lyapunov_exponents(hysteresis_system(), BEAT, verdict=False, **options)
    assert plain.verdict == ""
    assert repr(plain).endswith("not chaotic)")
    np.testing.assert_array_equal(plain.exponents, result.exponents)
    assert (
        "dependent on the time step"
        in replace(result, verdict="step-limited").plot().layout.title.text.lower()
    )


def test_exponents_that_disagree():
    result = lyapunov_exponents(
        hysteresis_system(), BEAT, start=START, cycles=60, transient=200, steps=64, verdict=False
    )
    assert result.repeats == 1
    assert exponent_verdict(result, result) == "physical"
    assert exponent_verdict(result, replace(result, repeats=2)) == "step-limited"
    chaos = replace(
        result, repeats=0, exponents=np.array([0.1, -0.2]), standard_error=np.array([0.01, 0.01])
    )
    assert chaos.chaotic
    assert exponent_verdict(result, chaos) == "step-limited"
    assert exponent_verdict(chaos, result) == "step-limited"

    def exponents_of(value, error=0.01):
        return replace(chaos, exponents=np.array([value, -0.2]),
                       standard_error=np.array([error, 0.01]))  # fmt: skip

    assert exponent_verdict(chaos, exponents_of(0.13)) == "physical"
    assert exponent_verdict(chaos, exponents_of(0.15)) == "undecided"
    sharp = exponents_of(0.1, 1e-5)
    assert exponent_verdict(sharp, exponents_of(0.104, 1e-5)) == "physical"
    assert exponent_verdict(sharp, exponents_of(0.107, 1e-5)) == "undecided"


def test_steps_beyond_the_limit_are_refused():
    with pytest.raises(InputError, match="omega_max"):
        poincare(System([[1.0]], [[0.1]], [[1e4]], [0.0]), 1.0, steps=32)
