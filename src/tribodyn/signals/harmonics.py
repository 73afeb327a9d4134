"""Mesh harmonics and amplitude spectra of a periodic or recorded motion."""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics.time.response import FineSamples, Response
from tribodyn.errors import InputError
from tribodyn.record import Record, quantity, record
from tribodyn.types import Array, ComplexArray


def mesh_harmonics(
    response: Response | FineSamples, signal: Array, count: int = 10
) -> ComplexArray:
    """Complex amplitudes of the mesh harmonics 1 to ``count``.

    Parameters
    ----------
    response : Response or FineSamples
        Where the signal comes from.
    signal : (3 * steps, ...) array
        Signal on ``response.fine``, in any unit.
    count : int
        Number of harmonics.

    Returns
    -------
    (count, ...) complex array
        ``A_k`` of ``Re sum A_k exp(2 pi i k phase)``: the modulus is the single-sided peak
        amplitude, in the unit of the signal.

    Raises
    ------
    InputError
        If ``count`` harmonics cannot be told apart on this grid.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[(2 * np.pi) ** 2]], [0.0])
    >>> motion = simulate(free, 1.0, 1, ([1.0], [0.0]), steps=256)
    >>> round(float(abs(mesh_harmonics(motion, motion.fine.position[:, 0], 1)[0])), 6)
    1.0
    """
    fine = response if isinstance(response, FineSamples) else response.fine
    return _fourier(fine, signal, np.arange(1, count + 1, dtype=float))


def _fourier(fine: FineSamples, signal: Array, orders: Array) -> ComplexArray:
    span = round(float(fine.phase[-1]))
    if orders.size and orders[-1] * 8.0 > fine.phase.size / 3.0 / max(span, 1):
        limit = fine.phase.size / 3.0 / max(span, 1) / 8.0
        raise InputError(
            f"mesh harmonic {orders[-1]:g} asked for",
            where="argument count",
            why=f"With this step it is resolved up to harmonic {limit:.0f}, eight steps each",
            remedy="Use more steps per mesh cycle",
        )
    turns = np.exp(-2j * np.pi * orders[:, None] * fine.phase) * fine.weight
    return np.asarray(2.0 * np.tensordot(turns, signal, axes=(1, 0)))


@record
class Spectrum(Record):
    """Single-sided amplitude spectrum.

    Parameters
    ----------
    frequency : (k,) array
        Frequency [Hz].
    order : (k,) array
        Multiple of the mesh frequency [-].
    amplitude : (k,) array
        Peak amplitude, in the unit of the signal.
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    frequency: Array = quantity("frequency", unit="Hz", axis=True)
    order: Array = quantity("frequency", unit="1", axis=True)
    amplitude: Array = quantity("frequency", unit="@unit")
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        top = int(np.argmax(self.amplitude))
        return (
            f"Spectrum({self.frequency.size} lines to {self.frequency[-1]:.6g} Hz, largest "
            f"{self.amplitude[top]:.4g} {self.unit} at {self.frequency[top]:.6g} Hz)"
        )

    def _units(self, unit: str | None) -> dict[str, str]:
        return {"units": self.unit} if unit == "@unit" else super()._units(unit)


def amplitude_spectrum(
    response: Response, signal: Array, *, highest: int | None = None, unit: str = ""
) -> Spectrum:
    """Amplitude spectrum with one line per repetition of the record.

    Parameters
    ----------
    response : Response
        Orbit or transient; a transient is taken as if it repeated.
    signal : (3 * steps, ...) array
        One-dimensional signal on ``response.fine``, in any unit.
    highest : int, optional
        Highest mesh harmonic; all that the step resolves by default, at most 50.
    unit : str
        Unit of the signal, for display.

    Returns
    -------
    Spectrum
        Lines at multiples of ``mesh_frequency / periods``; a whole number of mesh cycles makes
        them exact for a periodic motion, without window or leakage.

    Raises
    ------
    InputError
        If the signal has the wrong shape or ``highest`` is not resolved.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> motion = simulate(free, 50.0, 1, ([0.0], [0.0]), steps=256)
    >>> wave = 2.0 * np.cos(2 * np.pi * 3 * motion.fine.phase)
    >>> amplitude_spectrum(motion, wave, highest=5, unit="um")
    Spectrum(5 lines to 250 Hz, largest 2 um at 150 Hz)
    """
    fine = response.fine
    if signal.shape != fine.phase.shape:
        raise InputError(
            f"signal has the shape {signal.shape}",
            where="argument signal",
            why=f"It must be one signal on the fine samples, {fine.phase.shape}",
        )
    steps = fine.phase.size // 3 // response.periods
    top = min(50, steps // 8) if highest is None else highest
    orders = np.arange(1, top * response.periods + 1) / response.periods
    amplitude = np.concatenate(
        [
            np.abs(_fourier(fine, signal, part))
            for part in np.array_split(orders, orders.size // 64 + 1)
        ]
    )
    return Spectrum(orders * response.mesh_frequency, orders, amplitude, unit)
