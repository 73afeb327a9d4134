"""Order tracking over time with the second-generation Vold-Kalman filter."""

from __future__ import annotations

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

#: Maximum number of unknowns (samples times orders).
_MAX_UNKNOWNS = 8_000_000


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
        matches = np.flatnonzero(np.abs(self.order - order) < 1e-9)
        if not matches.size:
            tracked = ", ".join(f"{value:g}" for value in self.order)
            what = f"order {order:g} is not tracked"
            raise InputError(
                what, Argument("order"), f"Tracked orders: {tracked}", "Add it to orders"
            )
        row = int(matches[0])
        return np.asarray(self.amplitude[row] * np.cos(order * self.angle + self.phase[row]))


def track_orders(
    signal: object,
    angle: object,
    orders: object,
    sample_rate: float,
    *,
    bandwidth: float = 1.0,
    unit: str = "",
) -> TrackedOrders:
    """Track orders of a shaft over time simultaneously, which separates crossing orders.

    Parameters
    ----------
    signal : (n,) array
        Evenly spaced samples, in any unit.
    angle : (n,) array
        Angle of the shaft at each sample [rad], as returned by :func:`shaft_angle`.
    orders : (k,) array
        Orders to track, in cycles per revolution [-].
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
    >>> tracked = track_orders(3.0 * np.cos(4 * angle) + np.cos(5 * angle), angle, [4, 5], 1000.0)
    >>> tracked.amplitude[:, 2000].round(3).tolist()
    [3.0, 1.0]
    """
    from scipy.linalg import LinAlgError, solveh_banded

    values = checked_signal(signal, 16)
    shaft_angles = checked_signal(angle, 16, "angle", values.size)
    shaft_orders = np.atleast_1d(real_numbers(Argument("orders"), orders))
    require_positive("orders", shaft_orders)
    require_positive("sample_rate", sample_rate, "Hz")
    require_between("bandwidth", bandwidth, 1e-3, 0.25 * sample_rate, "Hz")
    _check_inputs(values, shaft_angles, shaft_orders)
    count, width = values.size, shaft_orders.size
    turn = 2.0 * np.pi * (0.5 * bandwidth / sample_rate)
    weight = (np.sqrt(2.0) - 1.0) / (4.0 * np.sin(0.5 * turn) ** 2) ** 2
    waves = np.exp(1j * shaft_orders * shaft_angles[:, None])  # (n, k)
    upper = _equations(waves, weight)
    # A real signal is half the sum of two counter-rotating complex waves.
    right = 2.0 * np.conj(waves) * values[:, None]
    try:
        envelope = solveh_banded(upper, right.ravel(), overwrite_ab=True, check_finite=False)
    except LinAlgError:
        what = f"bandwidth = {bandwidth:g} Hz cannot be resolved"
        why = f"At {sample_rate:g} Hz the equations are singular to working precision"
        remedy = "Increase the bandwidth, or downsample the recording first"
        raise ComputationError(what, Argument("bandwidth"), why, remedy) from None
    envelopes: ComplexArray = envelope.reshape(count, width).T
    time = np.arange(count) / float(sample_rate)
    size, phase = np.abs(envelopes), np.angle(envelopes)
    return TrackedOrders(shaft_orders, time, size, phase, shaft_angles, float(bandwidth), unit)


def _check_inputs(values: Array, angles: Array, orders: Array) -> None:
    if orders.ndim != 1 or np.unique(orders).size != orders.size:
        what, why = f"orders = {orders.tolist()}", "Each order can be tracked only once"
        raise InputError(what, Argument("orders"), why, "Pass a list of distinct orders")
    if values.size * orders.size > _MAX_UNKNOWNS:
        what = f"{orders.size} orders over {values.size} samples"
        why = f"At most {_MAX_UNKNOWNS} unknowns can be solved at once"
        remedy = "Track fewer orders at once, or split the recording"
        raise InputError(what, Argument("orders"), why, remedy)
    top = float(orders.max() * np.abs(np.diff(angles)).max())
    if top > np.pi:
        what = f"order {orders.max():g} is too high"
        why = f"At the highest speed it has {2 * np.pi / top:.3g} samples in a period, not two"
        raise InputError(what, Argument("orders"), why, "Omit it, or sample faster")


def _equations(waves: ComplexArray, weight: float) -> ComplexArray:
    """Upper bands of the normal equations; the unknowns of one sample are adjacent."""
    count, width = waves.shape
    depth = 2 * width
    upper = np.zeros((depth + 1, count, width), dtype=complex)
    ends = np.ones(count)
    diagonal = 6.0 * ends
    diagonal[[0, -1]], diagonal[[1, -2]] = 1.0, 5.0
    first_off_diagonal = -4.0 * ends
    first_off_diagonal[[1, -1]] = -2.0
    upper[depth] = 1.0 + weight * diagonal[:, None]
    upper[width, 1:] = weight * first_off_diagonal[1:, None]
    upper[0, 2:] = weight
    # Orders of one sample: row k, column k + apart.
    for offset in range(1, width):
        upper[depth - offset, :, offset:] += np.conj(waves[:, :-offset]) * waves[:, offset:]
    return upper.reshape(depth + 1, count * width)
