"""Waves of a moving surface in the contact: how much of their amplitude the film keeps."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.roughness import RoughnessProfile
from tribodyn.ehl.solver.contact_case import si_case
from tribodyn.ehl.steady.line_contact import solve_line_contact
from tribodyn.ehl.transient.transient import solve_transient_line_contact
from tribodyn.errors import InputError, require_between
from tribodyn.lubricant import Lubricant
from tribodyn.nomenclature import positive
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

#: Fit to computed line contacts under pure rolling.
_LINEAR, _SQUARE = 0.125, 0.04
#: Nodes of the grid at least, for a wave, and at most; steps for a period; half widths a step.
_LEAST_NODES, _PER_WAVE, _MOST_NODES, _STEPS, _STEP = 513, 24, 4097, 40, 0.05
#: Amplitude over the central film by default, and half widths that the oil travels first.
_SMALL, _TRAVEL = 0.05, 1.2


def amplitude_reduction(
    wavelength: ArrayLike, half_width: ArrayLike, moes_load: ArrayLike, moes_viscosity: ArrayLike
) -> Array:
    """Amplitude of waves in a line contact under pure rolling, over that of the free surface.

    ``A_d/A_i = 1/(1 + 0.125 N + 0.04 N^2)`` with ``N = wavelength/b M^(3/4) L^(-1/2)``.

    Parameters
    ----------
    wavelength, half_width : float or array [m]
        Length of the waves across the direction of rolling, and half width b of the dry contact.
    moes_load, moes_viscosity : float or array [-]
        Numbers M and L of Moes.

    Returns
    -------
    float or array
        Between 0, for long waves, and 1, for short ones, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not positive.

    Valid for piezoviscous elastic contacts, waves lower than the film. Source: Venner, Couhier,
    Lubrecht and Greenwood (1997). :func:`solve_amplitude_reduction` agrees within 0.025 at M = 100
    and L = 10, where 2 < N < 16; at M = 20 and L = 5 it has up to 0.16 more.

    Examples
    --------
    >>> float(amplitude_reduction(100e-6, 100e-6, 20.0, 10.0).round(3))
    0.577
    """
    length, width, load, viscosity = positive(**locals())
    number = length / width * load**0.75 / np.sqrt(viscosity)
    return np.asarray(1.0 / (1.0 + _LINEAR * number + _SQUARE * number**2))


def flattened_roughness(
    profile: RoughnessProfile, half_width: float, moes_load: float, moes_viscosity: float
) -> RoughnessProfile:
    """Measured profile as it passes through a line contact in pure rolling.

    Every wave of its Fourier series keeps the part of its amplitude that
    :func:`amplitude_reduction` gives.

    Parameters
    ----------
    profile : RoughnessProfile
        Heights of the free surface; one that is not periodic is continued as its mirror image.
    half_width : float [m]
        Half width b of the dry contact.
    moes_load, moes_viscosity : float [-]
        Numbers M and L of Moes.

    Returns
    -------
    RoughnessProfile
        Heights about their mean, over the same positions.

    Raises
    ------
    InputError
        If a number is not positive.

    Valid as :func:`amplitude_reduction`. Source: Venner, Couhier, Lubrecht and Greenwood (1997);
    Venner and Lubrecht, Multilevel Methods in Lubrication (2000).

    Examples
    --------
    >>> import numpy as np
    >>> wave = RoughnessProfile.wave(1e-7, 1e-4)
    >>> flat = flattened_roughness(wave, half_width=1e-4, moes_load=20.0, moes_viscosity=10.0)
    >>> round(flat.rms / wave.rms, 3)
    0.577
    """
    from scipy.fft import dct, idct

    height, size = profile.height - np.mean(profile.height), profile.height.size
    periodic = profile.beyond == "periodic"
    spectrum = np.fft.rfft(height) if periodic else dct(height, type=2)
    length = profile.spacing * size * (1.0 if periodic else 2.0)
    lengths = length / np.arange(1, spectrum.size)
    spectrum[1:] *= amplitude_reduction(lengths, half_width, moes_load, moes_viscosity)
    spectrum[0] = 0.0
    flat = np.fft.irfft(spectrum, size) if periodic else idct(spectrum, type=2)
    return RoughnessProfile(profile.position, np.asarray(flat), profile.beyond)


@record
class AmplitudeReduction(Record):
    """Waves of one surface in a line contact: the amplitude that the film keeps.

    Parameters
    ----------
    wavelength : (waves,) array [m]
        Lengths of the waves.
    amplitude_ratio : (waves,) array [-]
        Amplitude of the central film over that of the free surface, at the frequency of the waves.
    fitted_ratio : (waves,) array [-]
        The same by :func:`amplitude_reduction`, which holds for pure rolling.
    wave_number : (waves,) array [-]
        ``N = wavelength/b M^(3/4) L^(-1/2)``.
    half_width : float [m]
        Half width b of the dry contact.
    central_film : float [m]
        Film of smooth surfaces.
    slide_to_roll_ratio : float [-]
        Speed of the rough surface less that of the other one, over the entrainment speed.
    moes_load, moes_viscosity : float [-]
        Numbers M and L of Moes.
    """

    wavelength: Array = quantity("wave", unit="m", axis=True)
    amplitude_ratio: Array = quantity("wave", unit="1")
    fitted_ratio: Array = quantity("wave", unit="1")
    wave_number: Array = quantity("wave", unit="1")
    half_width: float = fact()
    central_film: float = fact()
    slide_to_roll_ratio: float = fact()
    moes_load: float = fact()
    moes_viscosity: float = fact()


def solve_amplitude_reduction(
    load_per_width: float,
    equivalent_radius: float,
    entrainment_speed: float,
    lubricant: Lubricant,
    effective_modulus: float,
    wavelength: ArrayLike,
    *,
    slide_to_roll_ratio: float = 0.0,
    amplitude: float | None = None,
    progress: Progress = SILENT,
) -> AmplitudeReduction:
    """Amplitude that waves of a moving surface keep in the film, by the transient line contact.

    Each wave moves through the contact with its surface until the film repeats; its amplitude there
    is that of the central film at the frequency of the waves.

    Parameters
    ----------
    load_per_width : float [N/m]
        Normal load per face width.
    equivalent_radius : float [m]
        Reduced radius of curvature.
    entrainment_speed : float [m/s]
        HALF the sum of the surface speeds.
    lubricant : Lubricant
        Oil at the temperature of the inlet.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    wavelength : float or array [m]
        Lengths of the waves.
    slide_to_roll_ratio : float [-]
        Speed of the rough surface less that of the smooth one, over the entrainment speed: zero
        in pure rolling, above -1.8.
    amplitude : float, optional [m]
        Amplitude of the free surface; by default a twentieth of the central film.
    progress : Progress
        Receives the progress over the waves.

    Raises
    ------
    InputError
        If a value is out of range, or a wave too short for a grid of 4097 nodes.
    ComputationError
        If an instant does not converge.

    Valid for one-sided waves across the direction of rolling, isothermal, Newtonian. Source:
    Venner, Couhier, Lubrecht and Greenwood (1997).

    Examples
    --------
    >>> from tribodyn.lubricant import Lubricant
    >>> oil = Lubricant(0.08, 880.0, 2.2e-8)
    >>> waves = solve_amplitude_reduction(1e5, 8e-3, 1.0, oil, 2.2e11, [2e-4, 4e-4])
    >>> waves.amplitude_ratio.round(2), waves.fitted_ratio.round(2)
    (array([0.75, 0.47]), array([0.7 , 0.46]))
    """
    contact = load_per_width, equivalent_radius, entrainment_speed, lubricant, effective_modulus
    scales = si_case(*contact, "roelands", True).scales
    lengths = np.atleast_1d(positive(wavelength=wavelength)[0]).ravel()
    require_between("slide_to_roll_ratio", slide_to_roll_ratio, -1.8, 2.0)
    smooth = solve_line_contact(*contact, film_tolerance=2e-3)
    height = _SMALL * smooth.central_film if amplitude is None else amplitude
    positive(amplitude=height)
    speeds = tuple(entrainment_speed * (1.0 + part * slide_to_roll_ratio) for part in (0.5, -0.5))
    ratios = []
    progress.start("Waves", lengths.size)
    for length in lengths.tolist():
        time, steps = _instants(length, smooth.half_width, speeds[0], entrainment_speed)
        film = solve_transient_line_contact(
            time,
            *contact,
            nodes=_nodes(length, smooth.half_width),
            roughness=(RoughnessProfile.wave(height, length), None),
            surface_speeds=(speeds[0], speeds[1]),
            keep_every=0,
        ).central_film[-steps:]
        ratios.append(2.0 * abs(np.fft.fft(film)[1]) / steps / height)
        progress.advance()
    progress.finish()
    moes = scales.moes_load, scales.moes_viscosity
    number = lengths / smooth.half_width * moes[0] ** 0.75 / math.sqrt(moes[1])
    return AmplitudeReduction(
        wavelength=lengths,
        amplitude_ratio=np.array(ratios),
        fitted_ratio=amplitude_reduction(lengths, smooth.half_width, *moes),
        wave_number=number,
        half_width=smooth.half_width,
        central_film=smooth.central_film,
        slide_to_roll_ratio=slide_to_roll_ratio,
        moes_load=moes[0],
        moes_viscosity=moes[1],
    )


def _nodes(wavelength: float, half_width: float) -> int:
    """Nodes of a grid that resolves a wave."""
    extent = 6.0 * half_width  # of a usual domain
    halvings = max(math.ceil(math.log2(_PER_WAVE * extent / wavelength)), 0)
    nodes = max(_LEAST_NODES, (1 << halvings) + 1)
    if nodes > _MOST_NODES:
        shortest = _PER_WAVE * extent / (_MOST_NODES - 1)
        raise InputError(
            f"wavelength = {wavelength * 1e6:.4g} um",
            where="argument wavelength",
            why=f"a contact of the half width {half_width * 1e6:.4g} um resolves waves from "
            f"{shortest * 1e6:.3g} um on",
            remedy="Leave out shorter waves, which hardly deform",
        )
    return nodes


def _instants(
    wavelength: float, half_width: float, speed: float, entrainment_speed: float
) -> tuple[Array, int]:
    """Instants until the film repeats and over one more period, and how many a period has."""
    steps = max(_STEPS, math.ceil(wavelength / (_STEP * half_width)))
    step = wavelength / speed / steps
    # What was in the contact at the start leaves it at the slower of both speeds.
    travel = (1.0 + _TRAVEL) * 2.0 * half_width / min(speed, entrainment_speed)
    count = math.ceil(travel / step) + 2 * steps
    return np.asarray(step * np.arange(count + 1), dtype=float), steps
