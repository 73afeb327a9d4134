"""Roughness in the gap: carried along, flattened, at rest, and absent."""

from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import (
    RoughnessProfile,
    TransientLineContact,
    solve_line_contact,
    solve_transient_line_contact,
)
from tribodyn.errors import InputError, ModelWarning
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
LOAD, RADIUS, SPEED, MODULUS = 6e5, 8e-3, 0.5, 2.2e11
HALF_WIDTH = float(np.sqrt(8.0 * LOAD * RADIUS / (np.pi * MODULUS)))
DOMAIN = (-4.05, 1.5)


def waviness(wavelength: float, amplitude: float) -> RoughnessProfile:
    """Sinus, wavelength in half widths."""
    x = np.arange(64) * wavelength * HALF_WIDTH / 64
    height = amplitude * np.sin(2.0 * np.pi * x / (wavelength * HALF_WIDTH))
    return RoughnessProfile(x, height, "periodic")


def solve(time: Any, **options: Any) -> TransientLineContact:
    return solve_transient_line_contact(
        time, LOAD, RADIUS, SPEED, OIL, MODULUS, **{"nodes": 513, "domain": DOMAIN, **options}
    )


@pytest.fixture(scope="module")
def smooth() -> TransientLineContact:
    return solve(np.array([0.0, 1e-6]))


@pytest.fixture(scope="module")
def waves() -> dict[float, TransientLineContact]:
    """Pure rolling over a waviness of 10 nm, a while after the first wave has left."""
    fields = {}
    for wavelength in (0.5, 1.0):
        step = wavelength / 40.0 * HALF_WIDTH / SPEED
        time = np.arange(int(5.0 * 40 / wavelength) + 1) * step
        fields[wavelength] = solve(
            time, roughness=(waviness(wavelength, 1e-8), None), surface_speeds=(SPEED, SPEED)
        )
    return fields


def wave_at(
    contact: TransientLineContact, smooth: TransientLineContact, i: int, wavelength: float
) -> complex:
    """Complex amplitude of the film over the undeformed waviness in the middle of the contact."""
    X = contact.position / HALF_WIDTH
    middle = np.abs(X) < 0.7
    change = (contact.film[i] - smooth.film[-1])[middle] / 1e-8
    phase = 2.0 * np.pi * (X[middle] - contact.time[i] * SPEED / HALF_WIDTH) / wavelength
    columns = (np.sin(phase), np.cos(phase), np.ones_like(phase), X[middle], X[middle] ** 2)
    sine, cosine, *_ = np.linalg.lstsq(np.column_stack(columns), change, rcond=None)[0]
    return complex(sine, cosine)


@pytest.mark.parametrize("wavelength", [0.5, 1.0])
def test_waviness_is_carried_through_at_the_speed_of_the_surface(
    waves: Any, smooth: TransientLineContact, wavelength: float
) -> None:
    contact = waves[wavelength]
    late, later = (wave_at(contact, smooth, i, wavelength) for i in (-25, -1))
    # in the frame of the surface the wave is at rest: neither phase nor amplitude change
    assert later == pytest.approx(late, abs=0.03 * abs(later))
    # a peak of the surface is a thin place of the film, more so with less delay in the inlet
    assert later.real < -0.7 * abs(later)


def test_long_waves_are_flattened_more_than_short_ones(
    waves: Any, smooth: TransientLineContact
) -> None:
    """Pure rolling: what is left of the amplitude falls with the wavelength, from 1 towards 0."""
    left = [abs(wave_at(waves[length], smooth, -1, length)) for length in sorted(waves)]
    assert np.all(np.diff(left) < -0.1)
    assert 0.5 < left[0] < 1.0
    assert 0.1 < left[-1] < 0.45


def test_no_height_is_no_roughness(smooth: TransientLineContact) -> None:
    flat = RoughnessProfile(np.linspace(-1e-2, 1e-2, 64), np.zeros(64))
    time = np.linspace(0.0, HALF_WIDTH / SPEED, 11)
    rough = solve(time, roughness=(flat, flat), surface_speeds=(SPEED, SPEED))
    assert rough.film[-1] == pytest.approx(solve(time).film[-1], rel=1e-12)
    steady, even = (
        solve_line_contact(LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=257, profile=profile)
        for profile in (flat, None)
    )
    assert steady.film == pytest.approx(even.film, rel=1e-12)


def test_standing_roughness_is_steady_and_does_not_depend_on_its_surface() -> None:
    """Simple sliding past a rough surface at rest: nothing changes with time."""
    standing = waviness(0.7, 2e-8)
    time = np.linspace(0.0, 2.0 * HALF_WIDTH / SPEED, 21)
    first = solve(time, roughness=(standing, None), surface_speeds=(0.0, 2.0 * SPEED))
    second = solve(time, roughness=(None, standing), surface_speeds=(2.0 * SPEED, 0.0))
    assert np.ptp(first.central_film) < 1e-8 * first.central_film[0]
    assert second.film[-1] == pytest.approx(first.film[-1], rel=1e-12)
    steady = solve_line_contact(
        LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=513, domain=DOMAIN, profile=standing,
        tolerance=1e-9, flux_tolerance=1e-8,
    )  # fmt: skip
    # the inlet of the steady solver goes by an estimated film: a small difference remains
    assert first.film[-1] == pytest.approx(steady.film, rel=2e-3)


def dent(centre: float) -> RoughnessProfile:
    """Dent of 50 nm; centre in half widths."""
    x = np.linspace(-1.0, 1.0, 401)
    depth = 5e-8 * np.exp(-((4.0 * x) ** 2))
    return RoughnessProfile((x + centre) * HALF_WIDTH, -depth, "level")


def test_a_standing_dent_relieves_the_pressure() -> None:
    """Simple sliding: the flux keeps the film, the elastic flank fills the dent."""
    assert float(dent(0.0)(0.0)) == pytest.approx(5e-8)
    dented, smooth = (
        solve_line_contact(LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=513, profile=profile)
        for profile in (dent(0.0), None)
    )
    pressures = [np.interp(0.0, item.position, item.pressure) for item in (dented, smooth)]
    assert pressures[0] < 0.97 * pressures[1]
    assert dented.central_film == pytest.approx(smooth.central_film, rel=0.03)


def test_a_rolling_dent_carries_its_oil(smooth: TransientLineContact) -> None:
    time = np.linspace(0.0, 3.0 * HALF_WIDTH / SPEED, 201)
    contact = solve(time, roughness=(dent(-3.0), None), surface_speeds=(SPEED, SPEED))
    X = contact.position / HALF_WIDTH
    middle = np.abs(X) < 0.8
    deeper = (contact.film[-1] - smooth.film[-1])[middle]
    assert 0.8e-8 < deeper.max() < 5e-8
    assert abs(X[middle][np.argmax(deeper)]) < 0.15


def test_waves_below_the_grid_resolution_are_reported() -> None:
    with pytest.warns(ModelWarning, match=r"roughness-resolution.*profile\.filtered"):
        solve(
            np.array([0.0, 1e-6]), roughness=(waviness(0.1, 1e-9), None),
            surface_speeds=(SPEED, SPEED),
        )  # fmt: skip


def test_a_profile_that_is_too_short_is_refused() -> None:
    x = np.linspace(-1.0, 1.0, 201) * HALF_WIDTH
    short = RoughnessProfile(x, 1e-9 * np.sin(8.0 * x / HALF_WIDTH))
    with pytest.raises(InputError, match="heights are needed from"):
        solve(np.array([0.0, 1e-4]), roughness=(None, short), surface_speeds=(SPEED, SPEED))
    with pytest.raises(InputError, match="without surface speeds"):
        solve(np.array([0.0, 1e-4]), roughness=(None, short))
    with pytest.raises(InputError, match="HALF the sum"):
        solve(np.array([0.0, 1e-4]), roughness=(None, short), surface_speeds=(SPEED, 0.0))
