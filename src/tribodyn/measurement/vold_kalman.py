"""Orders followed through time by the second-generation Vold-Kalman filter."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    real_numbers,
    require_between,
    require_positive,
)
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.types import Array, ComplexArray

#: Most unknowns: samples times orders.
_MOST = 8_000_000


@record
class TrackedOrders(Record):
    """Orders of a shaft as amplitude and phase over time.

    Parameters
    ----------
    order : (k,) array
        Cycles per revolution [-].
    time : (n,) array
        Time from the first sample [s].
    amplitude : (k, n) array
        Peak amplitude, in the unit of the signal.
    phase : (k, n) array
        Phase of the cosine against the shaft [rad].
    angle : (n,) array
        Angle of the shaft [rad].
    bandwidth : float
        Width of the filter at -3 dB [Hz].
    unit : str
        Unit of the signal.
    """

    order: Array = quantity("order", unit="1", axis=True)
    time: Array = quantity("time", unit="s", axis=True)
    amplitude: Array = quantity("order", "time", unit="@unit")
    phase: Array = quantity("order", "time", unit="rad")
    angle: Array = quantity("time", unit="rad")
    bandwidth: float = fact()
    unit: str = ""

    def waveform(self, order: float) -> Array:
        """Signal of one order over time.

        Parameters
        ----------
        order : float
            One of the tracked orders [-].

        Returns
        -------
        (n,) array
            In the unit of the signal.

        Raises
        ------
        InputError
            If the order is not among the tracked ones.
        """
        found = np.flatnonzero(np.abs(self.order - order) < 1e-9)
        if not found.size:
            known = ", ".join(f"{each:g}" for each in self.order)
            what = f"order {order:g} asked for"
            raise InputError(what, Argument("order"), f"Tracked: {known}", "Track it")
        row = int(found[0])
        return np.asarray(self.amplitude[row] * np.cos(order * self.angle + self.phase[row]))


def track_orders(
    signal: Any,
    angle: Any,
    orders: Any,
    sample_rate: float,
    *,
    bandwidth: float = 1.0,
    unit: str = "",
) -> TrackedOrders:
    """Follow orders of a shaft through time, together, so that crossing ones are told apart.

    Parameters
    ----------
    signal : (n,) array
        Evenly spaced samples, in any unit.
    angle : (n,) array
        Angle of the shaft at each sample [rad], as :func:`shaft_angle` gives it.
    orders : (k,) array
        Orders to follow, in cycles per revolution [-].
    sample_rate : float
        Samples per second [Hz].
    bandwidth : float
        Width of the filter at -3 dB [Hz]: an amplitude is followed as it changes within about one
        over it.
    unit : str
        Unit of the signal, for display.

    Raises
    ------
    InputError
        If the record is not finite, an order reaches half the sampling rate, two orders are equal
        or an argument is out of its range.
    ComputationError
        If the bandwidth is so narrow that rounding errors hide the result.

    Notes
    -----
    The complex envelopes x_k minimise |y - sum x_k exp(i k theta)|^2 + r^2 sum |second difference
    of x_k|^2, one banded system of equations for all samples. The weight that gives the bandwidth
    B is r^2 = (sqrt(2) - 1)/(6 - 8 cos(pi B/f_s) + 2 cos(2 pi B/f_s)): J. Tuma, Setting the
    passband width in the Vold-Kalman order tracking filter, 12th ICSV, 2005, equation (20).

    Examples
    --------
    >>> time = np.arange(4000) / 1000.0
    >>> angle = 2 * np.pi * (5.0 * time + 2.0 * time**2)
    >>> found = track_orders(3.0 * np.cos(4 * angle) + np.cos(5 * angle), angle, [4, 5], 1000.0)
    >>> found.amplitude[:, 2000].round(3).tolist()
    [3.0, 1.0]
    """
    from scipy.linalg import LinAlgError, solveh_banded

    values = checked_signal(signal, 16)
    turned = checked_signal(angle, 16, "angle")
    wanted = np.atleast_1d(real_numbers(Argument("orders"), orders))
    require_positive("orders", wanted)
    require_positive("sample_rate", sample_rate, "Hz")
    require_between("bandwidth", bandwidth, 1e-3, 0.25 * sample_rate, "Hz")
    _refuse(values, turned, wanted)
    count, width = values.size, wanted.size
    turn = 2.0 * np.pi * (0.5 * bandwidth / sample_rate)
    weight = (np.sqrt(2.0) - 1.0) / (4.0 * np.sin(0.5 * turn) ** 2) ** 2
    waves = np.exp(1j * wanted * turned[:, None])  # (n, k)
    upper = _equations(waves, weight)
    # A real signal is half of two waves that turn against each other.
    right = 2.0 * np.conj(waves) * values[:, None]
    try:
        envelope = solveh_banded(upper, right.ravel(), overwrite_ab=True, check_finite=False)
    except LinAlgError:
        what = f"bandwidth = {bandwidth:g} Hz cannot be resolved"
        why = f"At {sample_rate:g} Hz the equations are singular to working precision"
        remedy = "Widen it, or sample the record more coarsely first"
        raise ComputationError(what, Argument("bandwidth"), why, remedy) from None
    found: ComplexArray = envelope.reshape(count, width).T
    time = np.arange(count) / float(sample_rate)
    size, phase = np.abs(found), np.angle(found)
    return TrackedOrders(wanted, time, size, phase, turned, float(bandwidth), unit)


def _refuse(values: Array, turned: Array, wanted: Array) -> None:
    if wanted.ndim != 1 or np.unique(wanted).size != wanted.size:
        what, why = f"orders = {wanted.tolist()}", "Each order is followed once"
        raise InputError(what, Argument("orders"), why, "Give a list of different orders")
    if turned.size != values.size:
        what = f"angle has {turned.size} samples, the signal has {values.size}"
        why = "Each sample of the signal has its own angle"
        raise InputError(what, Argument("angle"), why, "Give the angle of the shaft at each sample")
    if values.size * wanted.size > _MOST:
        what = f"{wanted.size} orders over {values.size} samples"
        why = f"At most {_MOST} unknowns are solved at once"
        remedy = "Follow fewer orders together, or cut the record in parts"
        raise InputError(what, Argument("orders"), why, remedy)
    top = float(wanted.max() * np.abs(np.diff(turned)).max())
    if top > np.pi:
        what = f"order {wanted.max():g} asked for"
        why = f"At the highest speed it has {2 * np.pi / top:.3g} samples in a period, not two"
        raise InputError(what, Argument("orders"), why, "Leave it out, or sample faster")


def _equations(waves: ComplexArray, weight: float) -> ComplexArray:
    """Upper bands of the normal equations; unknowns of one sample stand together."""
    count, width = waves.shape
    depth = 2 * width
    upper = np.zeros((depth + 1, count, width), dtype=complex)
    ends = np.ones(count)
    diagonal = 6.0 * ends
    diagonal[[0, -1]], diagonal[[1, -2]] = 1.0, 5.0
    beside = -4.0 * ends
    beside[[1, -1]] = -2.0
    upper[depth] = 1.0 + weight * diagonal[:, None]
    upper[width, 1:] = weight * beside[1:, None]
    upper[0, 2:] = weight
    # Orders of one sample: row k, column k + apart.
    for apart in range(1, width):
        upper[depth - apart, :, apart:] += np.conj(waves[:, :-apart]) * waves[:, apart:]
    return upper.reshape(depth + 1, count * width)
