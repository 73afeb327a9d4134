"""Narrowband demodulation of a mean revolution: amplitude and phase of a mesh harmonic."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import Argument, ComputationError, InputError, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.synchronous_average import SynchronousAverage
from tribodyn.types import Array, ComplexArray


@record
class NarrowbandDemodulation(Record):
    """Amplitude and phase modulation of a mesh harmonic over a revolution.

    Parameters
    ----------
    angle : (n,) array
        Angle of the shaft, that of the mean revolution [rad].
    amplitude_modulation : (n,) array
        Envelope of the harmonic over its mean, less one [-].
    phase_modulation : (n,) array
        Phase of the harmonic less its mean [rad]; negative where the teeth lag.
    teeth : int
        Teeth of the gear [-].
    harmonic : int
        Mesh harmonic that carries the modulation [-].
    sidebands : int
        Sidebands on each side of it in the band [-].
    carrier_amplitude : float
        Mean of the envelope, in the unit of the signal.
    unit : str
        Unit of the signal.
    """

    angle: Array = quantity("angle", unit="rad", axis=True)
    amplitude_modulation: Array = quantity("angle", unit="1")
    phase_modulation: Array = quantity("angle", unit="rad")
    teeth: int = fact()
    harmonic: int = fact()
    sidebands: int = fact()
    carrier_amplitude: float = fact()
    unit: str = ""

    @property
    def largest_lag(self) -> float:
        """Angle at which the phase lags most, where a cracked tooth would be [rad]."""
        return float(self.angle[int(np.argmin(self.phase_modulation))])

    def __repr__(self) -> str:
        """One line."""
        return (
            f"NarrowbandDemodulation(mesh harmonic {self.harmonic} of {self.teeth} teeth with "
            f"{self.sidebands} sidebands, amplitude {self.amplitude_modulation.min():+.3g} to "
            f"{self.amplitude_modulation.max():+.3g}, phase {self.phase_modulation.min():+.3g} to "
            f"{self.phase_modulation.max():+.3g} rad)"
        )


def mesh_band(
    average: SynchronousAverage, harmonic: int | None, sidebands: int | None
) -> tuple[ComplexArray, int, int]:
    """Analytic signal of a mesh harmonic with its sidebands, the harmonic and their number."""
    size, teeth = average.signal.size, average.teeth
    width = (teeth - 1) // 2 if sidebands is None else sidebands
    highest = max((size - 1) // 2 - width, 0) // teeth
    if harmonic is None:
        harmonic = 1 + int(np.argmax(average.mesh_amplitudes(max(highest, 1))))
    require_positive("harmonic", harmonic)
    if not 1 <= width < teeth:
        what = f"sidebands = {width} of a gear with {teeth} teeth"
        why = "The band holds at least one and ends before the next mesh harmonic"
        raise InputError(what, Argument("sidebands"), why, f"Pass 1 to {teeth - 1}")
    if harmonic > highest:
        what = f"mesh harmonic {harmonic} with {width} sidebands ends at {harmonic * teeth + width}"
        why = f"A revolution of {size} samples holds orders below {0.5 * size:g}"
        remedy = "Average with more mesh_harmonics, or take fewer sidebands"
        raise InputError(what, Argument("harmonic"), why, remedy)
    band = slice(harmonic * teeth - width, harmonic * teeth + width + 1)
    lines = np.zeros(size, dtype=complex)
    lines[band] = 2.0 * np.fft.rfft(average.signal)[band]
    return np.asarray(np.fft.ifft(lines)), harmonic, width


def narrowband_demodulation(
    average: SynchronousAverage, *, harmonic: int | None = None, sidebands: int | None = None
) -> NarrowbandDemodulation:
    """Amplitude and phase of a mesh harmonic over the revolution.

    Parameters
    ----------
    average : SynchronousAverage
        Mean revolution of the shaft.
    harmonic : int, optional
        Mesh harmonic [-]; the strongest by default.
    sidebands : int, optional
        Sidebands on each side of it [-]; by default all up to halfway to the next harmonic. More
        of them show shorter events.

    Raises
    ------
    InputError
        If the band leaves the spectrum of the revolution or reaches the next harmonic.
    ComputationError
        If the harmonic is weaker than its sidebands, so that the phase has no meaning.

    Notes
    -----
    The harmonic of order k z and its sidebands are the signal A (1 + a) cos(k z theta + phi + b);
    modulus and argument of its analytic signal are A (1 + a) and k z theta + phi + b. A crack
    reduces the stiffness of one tooth and makes the phase b lag there: P. D. McFadden, Journal of
    Vibration and Acoustics 108 (1986) 165.

    Examples
    --------
    >>> from tribodyn.signals.synchronous_average import SynchronousAverage
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = (1.0 + 0.2 * np.cos(angle)) * np.cos(16 * angle + 0.3 * np.sin(2 * angle))
    >>> result = narrowband_demodulation(SynchronousAverage(angle, wave, 0.0 * angle, 50, 16))
    >>> round(float(result.amplitude_modulation.max()), 4)
    0.2
    >>> round(float(result.phase_modulation.max()), 4)
    0.3
    """
    band, order, width = mesh_band(average, harmonic, sidebands)
    hull = np.abs(band)
    baseband = band * np.exp(-1j * order * average.teeth * average.angle)
    steps = np.angle(np.roll(baseband, -1) * np.conj(baseband))
    if not hull.max() > 0.0 or round(float(steps.sum()) / (2.0 * np.pi)):
        raise ComputationError(
            f"mesh harmonic {order} is weaker than its sidebands",
            why="Its phase turns over in a revolution, so that it shows no modulation",
            remedy="Take a stronger harmonic or fewer sidebands, or check the number of teeth",
        )
    phase = np.angle(baseband[0]) + np.concatenate(([0.0], np.cumsum(steps[:-1])))
    mean = float(hull.mean())
    return NarrowbandDemodulation(
        average.angle,
        hull / mean - 1.0,
        phase - phase.mean(),
        average.teeth,
        order,
        width,
        mean,
        average.unit,
    )
