"""Indicators of a signal to the order of accuracy of the integrator: mean, rms, peaks.

All take signals on the fine samples of a response, (3 * steps, ...): both ends and the middle of
every step. Between these three samples a signal is a parabola, so that peaks are not missed.
"""

from __future__ import annotations

import numpy as np

from tribodyn.arrays.memory import Memo
from tribodyn.dynamics.time.response import FineSamples, Response, sample_extremes
from tribodyn.errors import Argument, InputError, require_positive
from tribodyn.record import Record, quantity, record
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.types import Array, ComplexArray


def _on(size: int, signal: Array) -> Array:
    """Signal whose samples are as many as the fine samples, or a multiple of their three a step."""
    count = len(signal) if signal.ndim else 0
    if not count or (count % 3 if size == 3 else count != size):
        what = f"signal has the shape {signal.shape}"
        wanted = "a multiple of 3" if size == 3 else size
        why = f"A signal on the fine samples has {wanted} of them along its first axis"
        raise InputError(what, Argument("signal"), why, "Compute it of the motion's fine samples")
    return signal


def mean(samples: FineSamples, signal: Array) -> Array:
    """Mean over time.

    Parameters
    ----------
    samples : FineSamples
        ``response.fine``.
    signal : (3 * steps, ...) array
        Signal in any unit.

    Returns
    -------
    array
        Shape ``signal.shape[1:]``, in the unit of the signal.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(float(mean(samples, wave)), 6)
    3.0
    """
    return samples.mean(_on(samples.phase.size, signal))


def rms(samples: FineSamples, signal: Array) -> Array:
    """Root mean square, mean included.

    Parameters
    ----------
    samples, signal
        As in :func:`mean`.

    Returns
    -------
    array
        As in :func:`mean`.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(float(rms(samples, wave) ** 2), 6)
    11.0
    """
    return np.asarray(np.sqrt(samples.mean(_on(samples.phase.size, signal) ** 2)))


def alternating_rms(samples: FineSamples, signal: Array) -> Array:
    """Root mean square of the signal less its mean.

    Parameters
    ----------
    samples, signal
        As in :func:`mean`.

    Returns
    -------
    array
        As in :func:`mean`.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(float(alternating_rms(samples, wave) ** 2), 6)
    2.0
    """
    return moments(samples, signal)[1]


def moments(samples: FineSamples, signal: Array) -> tuple[Array, Array]:
    """Mean and alternating rms."""
    middle = samples.mean(_on(samples.phase.size, signal))
    away = signal - middle
    away *= away
    return middle, np.asarray(np.sqrt(samples.mean(away)))


def extremes(signal: Array) -> tuple[Array, Array]:
    """Least and largest value, with the peaks between the samples.

    Parameters
    ----------
    signal : (3 * steps, ...) array
        Signal on fine samples, in any unit.

    Returns
    -------
    tuple of two arrays
        Shape ``signal.shape[1:]``, in the unit of the signal.

    Notes
    -----
    Vertex of the parabola through the three samples of each step, where it lies in the step.

    Examples
    --------
    >>> t = np.array([0.0, 0.5, 1.0])
    >>> low, high = extremes(1.0 - (t - 0.6) ** 2)
    >>> round(float(high), 12)
    1.0
    """
    return sample_extremes(_on(3, signal))


def peak_to_peak(signal: Array) -> Array:
    """Largest less least value.

    Parameters
    ----------
    signal
        As in :func:`extremes`.

    Returns
    -------
    array
        Shape ``signal.shape[1:]``, in the unit of the signal.

    Examples
    --------
    >>> float(peak_to_peak(np.array([0.0, 1.0, 2.0])))
    2.0
    """
    low, high = extremes(signal)
    return np.asarray(high - low)


def crest_factor(samples: FineSamples, signal: Array) -> Array:
    """Largest distance from the mean over the rms of the alternating part.

    Parameters
    ----------
    samples, signal
        As in :func:`mean`.

    Returns
    -------
    array
        Shape ``signal.shape[1:]``; zero for a constant signal.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(float(crest_factor(samples, wave) ** 2), 6)
    2.0
    """
    alternating = signal - mean(samples, signal)
    low, high = extremes(alternating)
    size, peak = rms(samples, alternating), np.maximum(high, -low)
    moves = size > 1e-12 * np.abs(signal).max(axis=0)
    return np.asarray(np.divide(peak, size, out=np.zeros_like(peak), where=moves))


def line_of_action_indicator(samples: FineSamples, along: Array, across: Array) -> float:
    """Alternating rms across the line of action over that along it.

    Parameters
    ----------
    samples : FineSamples
        ``response.fine``.
    along, across : (3 * steps,) array
        The same quantity in the two directions, in any unit, for example [N].

    Returns
    -------
    float
        Zero without friction; infinite if nothing vibrates along the line of action.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(line_of_action_indicator(samples, wave, 0.25 * wave), 6)
    0.25
    """
    return across_over_along(alternating_rms(samples, along), alternating_rms(samples, across))


def across_over_along(along: Array | float, across: Array | float) -> float:
    """Line-of-action indicator of two alternating rms."""
    base, other = float(along), float(across)
    if base == 0.0:
        return float("inf") if other > 0.0 else 0.0
    return other / base


def dynamic_factor(mesh_force: object, static_force: float | None = None) -> float:
    """Largest dynamic mesh force over the static one.

    Parameters
    ----------
    mesh_force : (n,) array
        Force along the line of action [N].
    static_force : float, optional
        Force along the line of action at rest under the same torque [N]; where absent, the mean
        of the signal, which is that of a steady motion with its friction in the balance.

    Returns
    -------
    float
        Dynamic factor [-]: 1 without vibration; above 2 the teeth may part.

    Raises
    ------
    InputError
        If the force is not finite or the static force not positive.

    Notes
    -----
    The factor K_v of ISO 6336-1 for a computed force: peak over static. Under friction the force
    of the torque alone is not the static one: a part of the torque is that of the friction.

    Examples
    --------
    >>> dynamic_factor(1000.0 + 250.0 * np.cos(2 * np.pi * np.arange(32) / 32), 1000.0)
    1.25
    """
    force = checked_signal(mesh_force, 2, "mesh_force")
    static = float(force.mean()) if static_force is None else static_force
    require_positive("static_force", static, "N")
    return float(force.max()) / static


def direction_shares(along: object, across: object) -> tuple[float, float]:
    """Parts of the mean square of a vibration along and across the line of action.

    Parameters
    ----------
    along, across : (n,) array
        The same quantity in the two directions at the same samples, in the same unit.

    Returns
    -------
    tuple of two float
        Shares along (LOA) and across (OLOA) the line of action [-], which sum to 1; the means
        do not count. The root of their ratio is
        :func:`tribodyn.analysis.line_of_action_indicator`.

    Raises
    ------
    InputError
        If the signals differ in length, are not finite or do not vibrate at all.

    Examples
    --------
    >>> wave = np.cos(2 * np.pi * np.arange(32) / 32)
    >>> [round(share, 6) for share in direction_shares(2.0 * wave, 5.0 + wave)]
    [0.8, 0.2]
    """
    first = checked_signal(along, 2, "along")
    second = checked_signal(across, 2, "across")
    total = float(np.var(first) + np.var(second))
    if first.size != second.size or total == 0.0:
        raise InputError(
            f"{first.size} samples along and {second.size} across, with the variance "
            f"{total:g} together",
            where="arguments along and across",
            why="Both must have the same samples, and at least one must vibrate",
            remedy="Give both signals over the same samples",
        )
    return float(np.var(first)) / total, float(np.var(second)) / total


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
        If ``count`` harmonics cannot be resolved on this grid.

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


#: Largest transform matrix that is cached for the next signal on the same samples.
_LARGEST_CACHED = 10**6


_recent: Memo[tuple[Array, Array]] = Memo(2)


def _turns(orders: Array, phase: Array, weight: Array) -> tuple[Array, Array]:
    """Matrix of a transform: every order at all phases, weighted; real and imaginary part."""
    turns = np.exp(-2j * np.pi * orders[:, None] * phase) * weight
    return turns.real.copy(), turns.imag.copy()


def _fourier(fine: FineSamples, signal: Array, orders: Array) -> ComplexArray:
    span = round(float(fine.phase[-1]))
    if orders.size and orders[-1] * 8.0 > fine.phase.size / 3.0 / max(span, 1):
        limit = fine.phase.size / 3.0 / max(span, 1) / 8.0
        what = f"mesh harmonic {orders[-1]:g} is requested"
        why = f"With this step it is resolved up to harmonic {limit:.0f}, eight steps each"
        raise InputError(what, "argument count", why, "Use more steps per mesh cycle")
    _on(fine.phase.size, signal)
    transform_grid = orders, fine.phase, fine.weight
    small = orders.size * fine.phase.size < _LARGEST_CACHED
    turns = (
        _recent.get(transform_grid, lambda: _turns(*transform_grid))
        if small
        else _turns(*transform_grid)
    )
    columns = signal.reshape(len(signal), -1)
    real, imaginary = (2.0 * (part @ columns) for part in turns)
    return np.asarray((real + 1j * imaginary).reshape(-1, *signal.shape[1:]))


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
        what = f"signal has the shape {signal.shape}"
        why = f"It must be one signal on the fine samples, {fine.phase.shape}"
        raise InputError(what, "argument signal", why, "Give one signal of this shape")
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
