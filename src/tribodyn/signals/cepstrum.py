"""Cepstrum: families of evenly spaced lines gathered in single peaks, and removed by liftering."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from tribodyn.errors import Argument, InputError, require_one_of, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.signals.spectrum import spectrum
from tribodyn.types import Array, ComplexArray

#: Smallest line over the largest one: the logarithm of an empty line would be infinite.
_FLOOR = 1e-12


@record
class Cepstrum(Record):
    """Spectrum of a logarithmic spectrum.

    Parameters
    ----------
    quefrency : (n,) array
        Quefrency, the inverse of the spacing of lines [s]; from zero on for the real cepstrum.
    cepstrum : (n,) array
        Value [-].
    kind : str
        ``"real"`` or ``"complex"``.
    delay : int
        Linear phase that was removed before the transform, in samples [-].
    sign : int
        Sign of the mean of the signal, which was removed too [-].
    """

    ARRAY = "cepstrum"

    quefrency: Array = quantity("quefrency", unit="s", axis=True)
    cepstrum: Array = quantity("quefrency", unit="1")
    kind: str = fact()
    delay: int = fact(default=0)
    sign: int = fact(default=1)

    def __repr__(self) -> str:
        """One line."""
        return f"Cepstrum({self.kind}, {self.cepstrum.size} samples to {self.quefrency[-1]:.4g} s)"

    def peak(self, shortest: float, longest: float) -> tuple[float, float]:
        """Largest value between two quefrencies.

        Parameters
        ----------
        shortest, longest : float
            Ends of the search [s].

        Returns
        -------
        tuple of two float
            Quefrency of the vertex of the parabola through the peak [s], the inverse of the spacing
            of its lines, and the value there [-].

        Raises
        ------
        InputError
            If fewer than three samples lie between the ends.
        """
        inside = np.flatnonzero((self.quefrency >= shortest) & (self.quefrency <= longest))
        if inside.size < 3:
            what = f"from {shortest:g} to {longest:g} s"
            step = self.quefrency[1] - self.quefrency[0]
            why = f"Less than three samples lie there, {step:g} s apart"
            raise InputError(what, "arguments shortest and longest", why, "Search a wider range")
        top = int(inside[np.argmax(self.cepstrum[inside])])
        top = min(max(top, 1), self.cepstrum.size - 2)
        left, middle, right = self.cepstrum[top - 1 : top + 2]
        bend = left - 2.0 * middle + right
        shift = 0.5 * (left - right) / bend if bend < 0.0 else 0.0
        step = float(self.quefrency[1] - self.quefrency[0])
        vertex = middle - 0.25 * (left - right) * shift
        return float(self.quefrency[top] + shift * step), float(vertex)

    def signal(self) -> Array:
        """Signal of a complex cepstrum.

        Returns
        -------
        (n,) array
            The signal from which it was computed, or that of an edited cepstrum, in its unit.

        Raises
        ------
        InputError
            If the cepstrum is real: it has no phase.
        """
        if self.kind != "complex":
            what, why = "a real cepstrum has no phase", "The signal cannot be recovered from it"
            raise InputError(what, "", why, "Use lifter, which retains the phase of the signal")
        size = self.cepstrum.size
        logarithm = np.fft.rfft(np.fft.ifftshift(self.cepstrum))
        turn = 2.0 * np.pi * self.delay / size * np.arange(logarithm.size)
        return np.asarray(self.sign * np.fft.irfft(np.exp(logarithm + 1j * turn), size))


def _log_size(lines: ComplexArray) -> Array:
    """Logarithm of the moduli."""
    size = np.abs(lines)
    return np.asarray(np.log(np.maximum(size, _FLOOR * size.max())))


def cepstrum(
    signal: object,
    sampling_rate: float,
    *,
    kind: Literal["real", "complex"] = "real",
    block_length: int | None = None,
) -> Cepstrum:
    """Real or complex cepstrum of a signal.

    Parameters
    ----------
    signal, sampling_rate
        As in :func:`tribodyn.analysis.spectrum` [Hz].
    kind : {"real", "complex"}
        ``"real"``: of the amplitudes, for any record. ``"complex"``: of the phases too, for an
        impulse response or another transient whose phase is continuous over the frequency.
    block_length : int, optional
        Samples of a block of the real cepstrum [-]: the mean squares of the spectra of the blocks
        are averaged (Welch, Hann window), so that families of lines stand out of noise. A block
        must last several quefrencies; the record is one block without window by default.

    Raises
    ------
    InputError
        If the signal is not finite, zero or too short, or a complex cepstrum is to have blocks.

    Notes
    -----
    Inverse Fourier transform of log|X| or of log|X| + i arg X, with the phase unwrapped and without
    its linear part. A family of lines with the spacing f, such as the sidebands of a mesh at the
    shaft frequency, is a peak at the quefrency 1/f and its multiples, the rahmonics; an echo
    after t is one at t. Lines below 1e-12 of the largest one are raised to it. R. B. Randall, A
    history of cepstrum analysis and its application to mechanical problems, Mechanical Systems and
    Signal Processing 97 (2017) 3.

    Examples
    --------
    >>> wave = np.exp(-0.05 * np.arange(512)) * np.cos(0.3 * np.arange(512))
    >>> echo = wave + 0.4 * np.roll(wave, 100)
    >>> result = cepstrum(echo, 1000.0)
    >>> round(result.peak(0.05, 0.15)[0], 4), round(result.peak(0.05, 0.15)[1], 3)
    (0.1, 0.2)
    """
    values = checked_signal(signal, 16)
    require_positive("sampling_rate", sampling_rate, "Hz")
    require_one_of("kind", kind, ("real", "complex"))
    if block_length is not None:
        if kind == "complex":
            what, why = f"block_length = {block_length}", "A mean over blocks has no phase"
            raise InputError(what, Argument("block_length"), why, "Leave it out")
        mean = spectrum(
            values, sampling_rate, window="hann", scaling="power", block_length=block_length
        )
        lines, size = np.sqrt(mean.amplitude).astype(complex), block_length
    else:
        lines, size = _lines(values), values.size
    if kind == "real":
        mirrored = np.fft.irfft(_log_size(lines), size)[: size // 2 + 1]
        return Cepstrum(np.arange(size // 2 + 1) / sampling_rate, mirrored, kind)
    sign = -1 if lines[0].real < 0.0 else 1
    phase = np.unwrap(np.angle(sign * lines))
    last = lines.size - 1
    delay = round(float(phase[-1]) * size / (2.0 * np.pi * last))
    phase -= 2.0 * np.pi * delay / size * np.arange(lines.size)
    ordered = np.fft.fftshift(np.fft.irfft(_log_size(lines) + 1j * phase, size))
    number = np.arange(size) - size // 2
    return Cepstrum(number / sampling_rate, ordered, kind, delay, sign)


def _lines(values: Array) -> ComplexArray:
    """Transform of a signal that is not zero."""
    if not values.any():
        what, why = "the signal is zero", "It has no logarithmic spectrum"
        raise InputError(what, Argument("signal"), why, "Look at the channel")
    return np.asarray(np.fft.rfft(values))


def lifter(
    signal: object,
    sampling_rate: float,
    *,
    remove: Sequence[float] = (),
    notch_width: float | None = None,
    longest: float | None = None,
) -> Array:
    """Remove families of lines from a signal by editing its real cepstrum.

    Parameters
    ----------
    signal, sampling_rate
        As in :func:`tribodyn.analysis.spectrum` [Hz].
    remove : sequence of float
        Quefrencies of families that are removed with all their rahmonics [s]: the inverse of the
        spacing of their lines, such as the period of a shaft.
    notch_width : float, optional
        Width of the notch at each rahmonic [s]; four samples by default.
    longest : float, optional
        Quefrency above which everything is removed [s]: what remains is the smooth course of the
        spectrum, for gears that of the path to the sensor.

    Returns
    -------
    (n,) array
        Signal with the edited amplitudes and its own phases, in its unit. The difference from the
        signal is the part that was removed.

    Raises
    ------
    InputError
        If nothing is to be removed, or a quefrency is not between the width of a notch and half the
        record.

    Notes
    -----
    R. B. Randall and N. Sawalhi, A new method for separating discrete components from a signal,
    Sound and Vibration 45 (2011) 6. The speed must not change by more than a line over the record:
    resample it over the rotation before, with the revolution as the unit of time.

    Examples
    --------
    >>> noise = np.random.default_rng(0).standard_normal(8000)
    >>> time = np.arange(8000) / 1000.0
    >>> family = sum(np.cos(2 * np.pi * 20.0 * k * time + k * k) for k in range(1, 25))
    >>> cleaned = lifter(noise + family, 1000.0, remove=[1.0 / 20.0])
    >>> [round(float(np.std(each)), 1) for each in (noise, noise + family, cleaned)]
    [1.0, 3.6, 1.0]
    """
    values = checked_signal(signal, 16)
    require_positive("sampling_rate", sampling_rate, "Hz")
    notch = 4.0 / sampling_rate if notch_width is None else notch_width
    require_positive("notch_width", notch, "s")
    if not len(remove) and longest is None:
        what, why = "nothing is to be removed", "Neither remove nor longest is given"
        raise InputError(what, Argument("remove"), why, "Name a quefrency in seconds")
    size = values.size
    quefrency = np.minimum(np.arange(size), size - np.arange(size)) / sampling_rate
    keep = np.ones(size, dtype=bool)
    half = 0.5 * size / sampling_rate
    for period in (*remove, *(() if longest is None else (longest,))):
        if not notch < period < half:
            what = f"a quefrency of {period:g} s"
            why = f"It must be above the width of a notch, {notch:g} s, and below {half:g} s"
            where = Argument("longest" if period == longest else "remove")
            raise InputError(what, where, why, "Pass the inverse of the spacing of the lines")
    for period in remove:
        number = np.rint(quefrency / period)
        keep &= (number == 0) | (np.abs(quefrency - number * period) > 0.5 * notch)
    if longest is not None:
        keep &= quefrency <= longest
    lines = _lines(values)
    edited = np.fft.rfft(np.fft.irfft(_log_size(lines), size) * keep).real
    return np.asarray(np.fft.irfft(np.exp(edited + 1j * np.angle(lines)), size))
