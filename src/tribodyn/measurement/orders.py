"""Amplitudes over orders: Fourier integrals over the angle of the shaft, without resampling.

Samples that are evenly spaced in time are unevenly spaced in angle. The integral over the angle
is a sum over the samples, each with the angle that the shaft turns during it; a sum over uneven
places for all orders at once is a non-uniform Fourier transform. Nothing is interpolated or
filtered, a shaft at rest contributes nothing, and no order is aliased as long as the sampling rate
is at least twice the frequency of the highest order at the highest speed.
"""

from __future__ import annotations

import numpy as np

from tribodyn.errors import Argument, InputError, require_between, require_one_of, require_positive
from tribodyn.nomenclature import require_whole
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.signals.order_map import OrderMap
from tribodyn.signals.uneven_transform import uneven_transform
from tribodyn.types import Array, ComplexArray

#: Cosine sums over the block: G. Heinzel, A. Ruediger, R. Schilling, Spectrum and spectral density
#: estimation by the discrete Fourier transform, 2002, appendix D.
WINDOWS = {
    "boxcar": (1.0,),
    "hann": (1.0, -1.0),
    "flattop": (1.0, -1.9383379, 1.3045202, -0.4028270, 0.0350665),  # HFT95
}


@record
class OrderSpectrum(Record):
    """Amplitudes over the orders of a shaft.

    Parameters
    ----------
    orders : (k,) array
        Cycles per revolution [-].
    amplitudes : (k,) array
        Peak amplitude, in the unit of the signal; at order zero the mean over the angle.
    phases : (k,) array
        Phase of the cosine at angle zero [rad].
    revolutions : float
        Revolutions over which the amplitudes are means [-].
    window : str
        Window over the angle.
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    orders: Array = quantity("order", unit="1", axis=True, name="order")
    amplitudes: Array = quantity("order", unit="@unit", name="amplitude")
    phases: Array = quantity("order", unit="rad", name="phase")
    revolutions: float = fact()
    window: str = fact()
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        top = 1 + int(np.argmax(self.amplitudes[1:]))
        size = f"{self.amplitudes[top]:.4g} {self.unit}".rstrip()
        return (
            f"OrderSpectrum(to order {self.orders[-1]:g} over {self.revolutions:g} "
            f"revolutions, largest {size} at order {self.orders[top]:.5g})"
        )

    def amplitude(self, order: float) -> float:
        """Amplitude of an order.

        Parameters
        ----------
        order : float
            Cycles per revolution [-].

        Returns
        -------
        float
            In the unit of the signal. Between two lines of the spectrum the gain of the window at
            that distance is taken out.

        Raises
        ------
        InputError
            If the spectrum does not reach that order.
        """
        require_between("order", order, 0.0, float(self.orders[-1]))
        return float(self._amplitudes_at(np.array([order]))[0])

    def _amplitudes_at(self, orders: Array) -> Array:
        """Amplitudes of several orders."""
        lines = np.rint(orders / self.orders[1]).astype(int)
        lines = np.minimum(lines, self.orders.size - 1)
        away = (orders - self.orders[lines]) * self.revolutions
        return np.asarray(self.amplitudes[lines] / _window_gain(self.window, away))


def _window_gain(window: str, away: Array) -> Array:
    """Transform of a window over that at its centre, at a distance in inverse lengths."""
    coefficients = np.abs(WINDOWS[window])  # about the middle of the block
    shift = np.arange(coefficients.size)
    offset = np.asarray(away)[..., None]
    return np.asarray(0.5 * (np.sinc(offset - shift) + np.sinc(offset + shift)) @ coefficients)


def order_spectrum(
    signal: object,
    angle: object,
    max_order: float,
    *,
    window: str = "flattop",
    unit: str = "",
    period: int = 1,
) -> OrderSpectrum:
    """Compute the amplitudes of a signal over the orders of a shaft.

    Parameters
    ----------
    signal : (n,) array
        Evenly spaced samples over time, in any unit.
    angle : (n,) array
        Angle of the shaft at each sample [rad], non-decreasing, as returned by :func:`shaft_angle`.
    max_order : float
        Highest order, in cycles per revolution [-].
    window : {"flattop", "hann", "boxcar"}
        Window over the angle: ``"flattop"`` is accurate to 0.05 % in amplitude, ``"hann"``
        separates close orders better.
    unit : str
        Unit of the signal, for display.
    period : int
        Revolutions after which the mate is back too, its teeth over the largest common factor:
        so many or a multiple are used if the record holds them, and the orders of the mate fall on
        lines.

    Returns
    -------
    OrderSpectrum
        ``orders`` and peak ``amplitudes``, two lines per resolved order.

    Raises
    ------
    InputError
        If the record is not finite, the angle falls, the shaft turns less than four times, or the
        record was sampled less than twice in a period of the highest order.

    Notes
    -----
    The whole revolutions of the record are used, so that whole orders fall on lines. Speed
    may rise, fall and rest. Amplitude in an order is the mean over the angle; where it changes
    with the speed, look at :func:`order_map`.

    Examples
    --------
    >>> time = np.arange(40000) / 10000.0
    >>> angle = 2 * np.pi * 5.0 * time**2
    >>> spectrum = order_spectrum(2.0 * np.cos(7 * angle), angle, 20)
    >>> round(spectrum.amplitude(7), 4)
    2.0
    """
    values, turned = _checked(signal, angle, max_order)
    revolutions = np.floor((turned[-1] - turned[0]) / (2.0 * np.pi) + 1e-9)
    if revolutions < 4.0:
        raise _too_short(turned, 4.0)
    require_one_of("window", window, WINDOWS)
    turns = require_whole("period", period)
    revolutions -= revolutions % turns if revolutions >= max(turns, 4) else 0.0
    lines = _lines(values, turned, float(turned[0]), revolutions, max_order, window)
    orders = np.arange(lines.size) / (2.0 * revolutions)
    return OrderSpectrum(orders, np.abs(lines), np.angle(lines), float(revolutions), window, unit)


def order_map(
    signal: object,
    angle: object,
    max_order: float,
    sample_rate: float,
    *,
    revolutions: float = 8.0,
    overlap: float = 0.75,
    window: str = "hann",
    unit: str = "",
) -> OrderMap:
    """Amplitudes of a signal over the orders of a shaft and its speed.

    Parameters
    ----------
    signal, angle, max_order
        As of :func:`order_spectrum`.
    sample_rate : float
        Samples per second [Hz].
    revolutions : float
        Revolutions in a block: orders are parted down to about two over it [-].
    overlap : float
        Part of a block that it shares with the next [-].
    window : {"hann", "flattop", "boxcar"}
        Window over the angle.
    unit : str
        Unit of the signal, for display.

    Returns
    -------
    tribodyn.analysis.OrderMap
        Draws itself, and cuts along an order.

    Raises
    ------
    InputError
        As :func:`order_spectrum`, and if the record is shorter than a block.
    """
    values, turned = _checked(signal, angle, max_order)
    require_positive("sample_rate", sample_rate, "Hz")
    require_between("revolutions", revolutions, 2.0, 1e6)
    require_between("overlap", overlap, 0.0, 0.95)
    require_one_of("window", window, WINDOWS)
    length = 2.0 * np.pi * revolutions
    if turned[-1] - turned[0] < length:
        raise _too_short(turned, revolutions)
    starts = np.arange(turned[0], turned[-1] - length * (1.0 - 1e-12), (1.0 - overlap) * length)
    bounds = np.searchsorted(turned, np.stack((starts, starts + length)))
    columns, speeds, times = [], [], []
    for start, first, last in zip(starts, *bounds, strict=True):
        block = slice(max(first - 1, 0), last + 1)
        lines = _lines(values[block], turned[block], start, revolutions, max_order, window)
        columns.append(np.abs(lines[::2]))
        ends = (start, start + length)
        begin, end = np.interp(ends, turned[block], np.arange(turned[block].size))
        speeds.append(length * sample_rate / (end - begin))
        times.append((block.start + 0.5 * (begin + end)) / sample_rate)
    orders = np.arange(columns[0].size) / revolutions
    amplitudes = np.array(columns).T
    return OrderMap(
        orders, np.array(speeds), np.array(times), amplitudes, float(revolutions), window, unit
    )


def _checked(signal: object, angle: object, max_order: float) -> tuple[Array, Array]:
    """Validate samples and angles, and that the sampling resolves the highest order."""
    values = checked_signal(signal, 16)
    turned = checked_signal(angle, 16, "angle", values.size)
    require_positive("max_order", max_order)
    where = Argument("angle")
    steps = np.diff(turned)
    if steps.min() < 0.0:
        at = int(np.argmin(steps))
        what = f"angle falls from {turned[at]:.6g} to {turned[at + 1]:.6g} rad at sample {at + 1}"
        why = "It must accumulate over revolutions without resetting to zero"
        remedy = "Unwrap it (numpy.unwrap), or negate it if the shaft turns backwards"
        raise InputError(what, where, why, remedy)
    if max_order * steps.max() > np.pi:
        per = 2.0 * np.pi / steps.max()
        raise InputError(
            f"max_order = {max_order:g}",
            where=Argument("max_order"),
            why=f"At the highest speed a revolution has {per:.4g} samples, which resolve orders "
            f"up to {0.5 * per:.4g}",
            remedy="Sample faster, run slower, or reduce max_order",
        )
    return values, turned


def _too_short(turned: Array, least: float) -> InputError:
    turns = (turned[-1] - turned[0]) / (2.0 * np.pi)
    what, why = f"the shaft turns {turns:.4g} times", f"At least {least:g} revolutions are needed"
    return InputError(what, Argument("angle"), why, "Record longer, or use shorter blocks")


def _lines(
    values: Array, turned: Array, start: float, revolutions: float, max_order: float, window: str
) -> ComplexArray:
    """Complex amplitudes at multiples of half an order over the revolutions."""
    length = 2.0 * np.pi * revolutions
    inside = np.clip((turned - start) * (1.0 / length), 0.0, 1.0)  # of the block
    # The weight of a sample is the angle between the midpoints to its neighbours.
    widths = np.empty_like(inside)
    np.subtract(inside[2:], inside[:-2], out=widths[1:-1])
    widths[0], widths[-1] = inside[1] - inside[0], inside[-1] - inside[-2]
    # The cosine of a multiple of an angle is a polynomial of its cosine.
    weights = widths * np.polynomial.chebyshev.chebval(
        np.cos(2.0 * np.pi * inside), 0.5 * np.array(WINDOWS[window])
    )
    count = int(np.floor(2.0 * max_order * revolutions + 1e-9)) + 1
    # A large offset would leak into orders. A product by BLAS would wait for its threads.
    mean = float(np.sum(values * weights) / np.sum(weights))
    sums = uneven_transform((values - mean) * weights, 0.5 * inside, count)
    lines = 2.0 * sums * np.exp(-1j * np.arange(count) * start / (2.0 * revolutions))
    lines[0] = 0.5 * lines[0] + mean
    return np.asarray(lines)
