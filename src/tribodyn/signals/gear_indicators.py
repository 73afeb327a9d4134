"""Condition indicators of a gear, from the mean revolution of its shaft."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribodyn.errors import Argument, ComputationError, InputError
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.signals.demodulation import mesh_band
from tribodyn.signals.synchronous_average import SynchronousAverage, locked_variance
from tribodyn.types import Array

#: Part of the rms of the mean revolution below which a part of it is nothing.
_NOTHING = 1e-12


def kurtosis(signal: object) -> float:
    """Fourth central moment over the square of the second.

    Parameters
    ----------
    signal : (n,) array
        Signal in any unit.

    Returns
    -------
    float
        3 for a normal distribution, 1.5 for a sine, 1 for a square wave [-].

    Raises
    ------
    ComputationError
        If the signal does not change.

    Examples
    --------
    >>> round(kurtosis(np.cos(2 * np.pi * np.arange(64) / 64)), 12)
    1.5
    """
    values = checked_signal(signal, 4)
    away = values - values.mean()
    if np.mean(away**2) <= (1e-14 * float(np.abs(values).max())) ** 2:
        what = "the kurtosis of a signal that does not change"
        why = "It is a moment over the variance, which is zero"
        raise ComputationError(what, why=why, remedy="Give a signal that changes")
    return _standardized(values, 4)


def _standardized(values: Array, order: int) -> float:
    """Central moment over the power of the standard deviation."""
    away = values - values.mean()
    return float(np.mean(away**order) / np.mean(away**2) ** (0.5 * order))


def _checked(average: SynchronousAverage, part: Array) -> Array:
    """Residual, difference or envelope; raise an error if nothing is left in it."""
    _refuse_nothing(average, float(np.std(part)), "has nothing but mesh harmonics")
    return part


def _refuse_nothing(average: SynchronousAverage, size: float, finding: str) -> None:
    """Raise an error where a part of the mean revolution is rounding."""
    if size <= _NOTHING * float(np.std(average.signal)):
        why = "The indicators compare what is left over with the mesh harmonics"
        remedy = "Check the number of teeth, and that the shaft is the one measured"
        raise ComputationError(f"the mean revolution {finding}", why=why, remedy=remedy)


def mesh_sum(average: SynchronousAverage, mesh_harmonics: int) -> float:
    """Sum of the amplitudes of the mesh harmonics."""
    mesh = float(average.mesh_amplitudes(mesh_harmonics).sum())
    _refuse_nothing(average, mesh, "has no mesh harmonics")
    return mesh


def fm0(average: SynchronousAverage, *, mesh_harmonics: int = 5) -> float:
    """FM0, the zero-order figure of merit: peak to peak over the sum of the mesh amplitudes.

    Parameters
    ----------
    average : SynchronousAverage
        Mean revolution of the shaft.
    mesh_harmonics : int
        Harmonics in the sum [-].

    Returns
    -------
    float
        FM0 [-]: 2 for one mesh harmonic alone. It grows with a broken or heavily worn tooth.

    Raises
    ------
    ComputationError
        If the mean revolution has no mesh harmonics.

    Notes
    -----
    R. M. Stewart, Some useful data analysis techniques for gearbox diagnostics, University of
    Southampton, 1977.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> round(fm0(SynchronousAverage(angle, np.cos(16 * angle), 0.0 * angle, 50, 16)), 6)
    2.0
    """
    return float(np.ptp(average.signal)) / mesh_sum(average, mesh_harmonics)


def fm4(average: SynchronousAverage) -> float:
    """FM4: kurtosis of the difference signal.

    Parameters
    ----------
    average : SynchronousAverage
        Mean revolution of the shaft.

    Returns
    -------
    float
        N sum d^4 / (sum d^2)^2 of the difference d less its mean [-]: 3 for noise, more where
        one or two teeth stand out; it falls again when damage spreads.

    Raises
    ------
    ComputationError
        If the difference signal is zero.

    Notes
    -----
    R. M. Stewart, University of Southampton, 1977. The difference signal is the mean revolution
    less the mesh harmonics, their first sidebands and the shaft orders 1 and 2.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = 2.0 * np.cos(16 * angle) + 0.1 * np.cos(21 * angle)
    >>> round(fm4(SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)), 9)
    1.5
    """
    return _standardized(_checked(average, average.difference()), 4)


def m6a(average: SynchronousAverage) -> float:
    """M6A: sixth standardized moment of the difference signal.

    Parameters
    ----------
    average
        As in :func:`fm4`.

    Returns
    -------
    float
        N^2 sum d^6 / (sum d^2)^3 [-]: 15 for noise, 2.5 for a sine; it weights peaks more than FM4.

    Raises
    ------
    ComputationError
        As :func:`fm4`.

    Notes
    -----
    H. R. Martin, Statistical moment analysis as a means of surface damage detection, Proceedings
    of the 7th International Modal Analysis Conference, 1989, 1016.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = 2.0 * np.cos(16 * angle) + 0.1 * np.cos(21 * angle)
    >>> round(m6a(SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)), 9)
    2.5
    """
    return _standardized(_checked(average, average.difference()), 6)


def m8a(average: SynchronousAverage) -> float:
    """M8A: eighth standardized moment of the difference signal.

    Parameters
    ----------
    average
        As in :func:`fm4`.

    Returns
    -------
    float
        N^3 sum d^8 / (sum d^2)^4 [-]: 105 for noise, 4.375 for a sine.

    Raises
    ------
    ComputationError
        As :func:`fm4`.

    Notes
    -----
    As for :func:`m6a`.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = 2.0 * np.cos(16 * angle) + 0.1 * np.cos(21 * angle)
    >>> round(m8a(SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)), 9)
    4.375
    """
    return _standardized(_checked(average, average.difference()), 8)


def _over_variance(present: Array, variances: Sequence[float]) -> float:
    """Fourth central moment over the square of a mean variance."""
    fourth = float(np.mean((present - present.mean()) ** 4))
    return fourth / float(np.mean(variances)) ** 2


def na4(average: SynchronousAverage, *, earlier: Sequence[SynchronousAverage] = ()) -> float:
    """NA4: fourth moment of the residual over the square of its mean variance over all records.

    Parameters
    ----------
    average : SynchronousAverage
        Mean revolution of the present record.
    earlier : sequence of SynchronousAverage
        Of all earlier records of the same gear.

    Returns
    -------
    float
        NA4 [-]: 3 for noise of constant strength. It goes on growing when damage spreads, since
        the variance in it is that of all records.

    Raises
    ------
    ComputationError
        If the residual signal is zero.

    Notes
    -----
    J. J. Zakrajsek, D. P. Townsend and H. J. Decker, NASA TM-105950, 1993:
    N sum r^4 / ((1/M) sum_j sum r_j^2)^2 over the records j = 1 to M, with the residual r less its
    mean: the mean revolution less mesh harmonics and shaft orders, sidebands retained. Without
    earlier records it is the kurtosis of the residual.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> mesh, tone = np.cos(16 * angle), 0.1 * np.cos(21 * angle)
    >>> sound = SynchronousAverage(angle, mesh + tone, 0.0 * angle, 50, 16)
    >>> worn = SynchronousAverage(angle, mesh + 3.0 * tone, 0.0 * angle, 50, 16)
    >>> round(na4(sound), 9), round(na4(worn, earlier=[sound]), 9)
    (1.5, 4.86)
    """
    residual = _checked(average, average.residual())
    variances = [float(np.var(each.residual())) for each in (*earlier, average)]
    return _over_variance(residual, variances)


def na4_star(
    average: SynchronousAverage,
    healthy: Sequence[SynchronousAverage] = (),
    *,
    earlier: Sequence[SynchronousAverage] = (),
) -> float:
    """NA4*: fourth moment of the residual over the squared variance of the gear in good condition.

    Parameters
    ----------
    average : SynchronousAverage
        Mean revolution of the present record.
    healthy : sequence of SynchronousAverage
        Of records of the same gear in good condition.
    earlier : sequence of SynchronousAverage
        Instead of them all earlier records in their order; the variance is that of the records
        before damage begins, as :func:`locked_variance` finds it.

    Returns
    -------
    float
        NA4* [-]: 3 for noise as strong as in good condition. Unlike NA4 it does not adapt to slow
        damage, since the variance stays that of the sound gear.

    Raises
    ------
    InputError
        If there are neither records in good condition nor earlier ones, or both.
    ComputationError
        If the residual signal is zero.

    Notes
    -----
    H. J. Decker, R. F. Handschuh and J. J. Zakrajsek, An enhancement to the NA4 gear vibration
    diagnostic parameter, NASA TM-106553, 1994.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> mesh, tone = np.cos(16 * angle), 0.1 * np.cos(21 * angle)
    >>> sound = SynchronousAverage(angle, mesh + tone, 0.0 * angle, 50, 16)
    >>> worn = SynchronousAverage(angle, mesh + 3.0 * tone, 0.0 * angle, 50, 16)
    >>> round(na4_star(worn, [sound]), 9)
    121.5
    """
    if bool(healthy) == bool(earlier):
        what = "healthy and earlier are both " + ("given" if healthy else "empty")
        why = "NA4* compares with the gear in good condition"
        raise InputError(what, Argument("healthy"), why, "Pass at least one average in one of them")
    residual = _checked(average, average.residual())
    variances = [float(np.var(_checked(e, e.residual()))) for e in healthy or earlier]
    if earlier:
        variances = [locked_variance([*variances, float(np.var(residual))])[0]]
    return _over_variance(residual, variances)


def nb4(
    average: SynchronousAverage,
    *,
    earlier: Sequence[SynchronousAverage] = (),
    harmonic: int | None = None,
    sidebands: int | None = None,
) -> float:
    """NB4: NA4 of the envelope of a mesh harmonic with its sidebands.

    Parameters
    ----------
    average, earlier
        As in :func:`na4`.
    harmonic, sidebands : int, optional
        Mesh harmonic and sidebands on each side of it in the band [-]; the strongest harmonic of
        this record and all sidebands up to halfway to the next harmonic by default.

    Returns
    -------
    float
        NB4 [-]: 1.5 for a load that varies as a sine, more where a few teeth change the load.

    Raises
    ------
    InputError
        If the band leaves the spectrum of the revolution or reaches the next harmonic.
    ComputationError
        If the envelope is constant.

    Notes
    -----
    J. J. Zakrajsek, R. F. Handschuh and H. J. Decker, Application of fault detection techniques to
    spiral bevel gear fatigue data, NASA TM-106467, 1994: the mean revolution is filtered about the
    dominant mesh harmonic, and the envelope is the modulus of its analytic signal.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = (1.0 + 0.2 * np.cos(angle)) * np.cos(16 * angle)
    >>> round(nb4(SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)), 9)
    1.5
    """
    band, order, width = mesh_band(average, harmonic, sidebands)
    hull = _checked(average, np.abs(band))
    before = (np.abs(mesh_band(each, order, width)[0]) for each in earlier)
    return _over_variance(hull, [float(np.var(each)) for each in (*before, hull)])


def energy_ratio(average: SynchronousAverage) -> float:
    """Energy ratio: rms of the difference over that of the regular meshing signal.

    Parameters
    ----------
    average : SynchronousAverage
        Mean revolution of the shaft.

    Returns
    -------
    float
        ER [-]: near 0 for a sound gear. It grows with wear of all teeth, to which FM4 is blind.

    Raises
    ------
    ComputationError
        If the mean revolution has no mesh harmonics.

    Notes
    -----
    N. S. Swansson, Application of vibration signal analysis techniques to condition monitoring,
    Conference on Lubrication, Friction and Wear in Engineering, Melbourne, 1980, 262. The regular
    signal holds the mesh harmonics and their first sidebands; mean and shaft orders 1 and 2 are
    in neither.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = 2.0 * np.cos(16 * angle) + 0.1 * np.cos(21 * angle)
    >>> round(energy_ratio(SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)), 9)
    0.05
    """
    mesh_sum(average, max(average.signal.size // (2 * average.teeth), 1))
    return float(np.std(average.difference()) / np.std(average.regular()))


def sideband_index(average: SynchronousAverage) -> float:
    """Sideband index: mean amplitude of the first sidebands of the mesh frequency.

    Parameters
    ----------
    average : SynchronousAverage
        Mean revolution of the shaft.

    Returns
    -------
    float
        SI, in the unit of the signal.

    Notes
    -----
    J. Szczepanik, Time synchronous averaging of ball mill vibration, Mechanical Systems and Signal
    Processing 3 (1989) 99; P. Vecer, M. Kreidl and R. Smid, Acta Polytechnica 45 (2005) 35.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = (1.0 + 0.2 * np.cos(angle)) * np.cos(16 * angle)
    >>> round(sideband_index(SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)), 9)
    0.1
    """
    lines = 2.0 * np.abs(np.fft.rfft(average.signal)) / average.signal.size
    return float(0.5 * (lines[average.teeth - 1] + lines[average.teeth + 1]))


def sideband_level_factor(average: SynchronousAverage) -> float:
    """Sideband level factor: amplitudes of the first sidebands over the rms.

    Parameters
    ----------
    average
        As in :func:`sideband_index`.

    Returns
    -------
    float
        SLF [-]: near 0 for a straight, centred shaft.

    Raises
    ------
    ComputationError
        If the mean revolution does not change.

    Notes
    -----
    As for :func:`sideband_index`; the rms is that of the mean revolution less its mean.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = (1.0 + 0.2 * np.cos(angle)) * np.cos(16 * angle)
    >>> round(sideband_level_factor(SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)), 6)
    0.280056
    """
    return float(2.0 * sideband_index(average) / np.sqrt(variance(average)))


def variance(average: SynchronousAverage) -> float:
    """Variance of the mean revolution; raise an error if it does not change."""
    variance = float(np.var(average.signal))
    if variance == 0.0:
        what, why = "the mean revolution does not change", "The rms in the denominator is zero"
        raise ComputationError(what, why=why, remedy="Check the sensor")
    return variance
