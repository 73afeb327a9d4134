"""Order map and spectrogram: amplitude over orders and speed, or over frequency and time."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import draw
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.angular_resampling import (
    angular_resampling,
    checked_rising,
    checked_signal,
    noise_bandwidth,
    shaft_rotation,
    window_values,
)
from tribodyn.signals.spectrum import window_gain
from tribodyn.types import Array


@record
class Spectrogram(Record):
    """Amplitude over frequency and time.

    Parameters
    ----------
    frequency : (k,) array
        Frequency [Hz].
    time : (m,) array
        Middle of each block from the first sample [s].
    amplitude : (k, m) array
        Peak amplitude, in the unit of the signal.
    block_duration : float
        Duration of one block [s].
    sampling_rate : float
        Samples per second [Hz].
    noise_bandwidth : float
        Width of the ideal filter that passes as much noise as one line [Hz].
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    frequency: Array = quantity("frequency", unit="Hz", axis=True)
    time: Array = quantity("time", unit="s", axis=True)
    amplitude: Array = quantity("frequency", "time", unit="@unit")
    block_duration: float = fact()
    sampling_rate: float
    noise_bandwidth: float
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        line, block = self.strongest()
        return (
            f"Spectrogram({self.time.size} blocks of {self.block_duration:.4g} s, to "
            f"{self.frequency[-1]:.6g} Hz, largest {self.amplitude[line, block]:.4g} {self.unit} "
            f"at {self.frequency[line]:.6g} Hz and {self.time[block]:.4g} s)"
        ).replace("  ", " ")

    def strongest(self) -> tuple[int, int]:
        """Return the indices of the largest amplitude, excluding the mean.

        Returns
        -------
        tuple of two int
            Index of the frequency and of the time.
        """
        place = int(np.argmax(self.amplitude[1:]))
        line, block = divmod(place, self.time.size)
        return line + 1, block

    def rms(self) -> Array:
        """Root mean square of each block, mean included.

        Returns
        -------
        (m,) array
            In the unit of the signal; samples count with the square of the window (Parseval).
        """
        square = 0.5 * self.amplitude**2
        square[0] *= 2.0
        if np.isclose(self.frequency[-1], 0.5 * self.sampling_rate, rtol=1e-9):
            square[-1] *= 2.0
        return np.asarray(np.sqrt(square.sum(axis=0) * self.frequency[1] / self.noise_bandwidth))


def spectrogram(
    signal: object,
    sampling_rate: float,
    *,
    block_length: int | None = None,
    overlap: float = 0.75,
    window: str = "hann",
    unit: str = "",
) -> Spectrogram:
    """Compute the amplitude spectra of successive short blocks.

    Parameters
    ----------
    signal, sampling_rate
        As in :func:`tribodyn.analysis.spectrum` [Hz].
    block_length : int, optional
        Samples of a block; by default about the square root of eight times their number. Longer
        blocks resolve closer frequencies and blur faster changes.
    overlap, window, unit
        As in :func:`tribodyn.analysis.spectrum` [-].

    Returns
    -------
    Spectrogram
        Only blocks that lie wholly within the record, so that no amplitude falls at its ends.

    Raises
    ------
    InputError
        If the signal is not finite or too short, or an argument is out of its range.

    Examples
    --------
    >>> time = np.arange(4000) / 1000.0
    >>> wave = np.where(time < 2.0, 0.5, 3.0) * np.cos(2 * np.pi * 125.0 * time)
    >>> result = spectrogram(wave, 1000.0, block_length=200, unit="um")
    >>> result.time.size, round(float(result.time[0]), 6), round(float(result.time[-1]), 6)
    (77, 0.1, 3.9)
    >>> line, _ = result.strongest()
    >>> round(float(result.frequency[line]), 6), round(float(result.amplitude[line].max()), 6)
    (125.0, 3.0)
    """
    values = checked_signal(signal, 16)
    require_positive("sampling_rate", sampling_rate, "Hz")
    length = round(np.sqrt(8.0 * values.size)) if block_length is None else block_length
    require_between("block_length", length, 8, values.size, "samples")
    require_between("overlap", overlap, 0.0, 0.95)
    hop = max(length - round(overlap * length), 1)
    # A block number p is centred on the sample p * hop; keep those inside the record.
    first, last = _inside(values.size, length, hop)
    if last < first:
        hop, first, last = length // 2, 1, 1
    weights = window_values(window, length)
    from scipy.signal import ShortTimeFFT

    transform = ShortTimeFFT(
        weights, hop, sampling_rate, fft_mode="onesided2X", scale_to="magnitude", phase_shift=None
    )
    lines = transform.stft(values, p0=first, p1=last + 1)
    return Spectrogram(
        np.asarray(transform.f),
        np.arange(first, last + 1) * hop / sampling_rate,
        np.abs(lines),
        length / sampling_rate,
        sampling_rate,
        noise_bandwidth(weights, sampling_rate),
        unit,
    )


def _inside(size: int, length: int, hop: int) -> tuple[int, int]:
    """First and last block that lie within the record."""
    half = length // 2
    return -(-half // hop), (size - (length - half)) // hop


def order_map(
    signal: object,
    time: object,
    *,
    rotation: object = None,
    speed: object = None,
    highest_order: float = 50.0,
    revolutions: int = 8,
    overlap: float = 0.75,
    window: str = "hann",
    unit: str = "",
) -> OrderMap:
    """Amplitude over orders and speed of a run-up, by resampling over the rotation.

    Parameters
    ----------
    signal, time
        As in :func:`tribodyn.analysis.angular_resampling` [s].
    rotation : (n,) array, optional
        Rotation of the shaft at each sample [rad], counted on without wrap.
    speed : float or (n,) array, optional
        Rotational speed [rad/s], instead of the rotation.
    highest_order : float
        Highest order, in cycles per revolution [-].
    revolutions : int
        Revolutions in a block: orders are resolved down to about two over this number, and
        amplitudes are means over so many revolutions.
    overlap : float
        Part of a block that it shares with the next [-].
    window : str
        Window of :func:`scipy.signal.get_window`; ``"flattop"`` for orders that are no multiple
        of one over ``revolutions``.
    unit : str
        Unit of the signal, for display.

    Raises
    ------
    InputError
        If the record is not finite, does not rise, is shorter than a block or was sampled with
        less than twice the highest order at the highest speed.

    Notes
    -----
    Over the rotation an order is one line at every speed, so that it does not smear while the
    speed changes; a natural frequency, which stays where it is in hertz, becomes a hyperbola.

    Examples
    --------
    >>> time = np.linspace(0.0, 4.0, 16001)
    >>> speed = 2 * np.pi * (10.0 + 5.0 * time)
    >>> rotation = 2 * np.pi * (10.0 * time + 2.5 * time**2)
    >>> result = order_map(np.cos(3 * rotation) * 2.0, time, speed=speed, highest_order=8, unit="N")
    >>> float(result.order[result.strongest()[0]]), float(result.order[1])
    (3.0, 0.125)
    >>> round(float(result.cut(3).amplitude.min()), 3)
    2.0
    """
    values = checked_signal(signal, 16)
    moments = checked_rising(time, values.size, "time", "s")
    angle = shaft_rotation(rotation, speed, moments)
    require_positive("highest_order", highest_order)
    require_positive("revolutions", revolutions)
    require_between("overlap", overlap, 0.0, 0.95)
    per_turn = 2 * int(np.ceil(1.3 * highest_order + 2))
    resampled = angular_resampling(
        values, moments, angle, samples_per_revolution=per_turn, highest_order=highest_order
    )
    length = revolutions * per_turn
    if resampled.signal.size < length:
        what = f"the record holds {resampled.signal.size / per_turn:.3g} revolutions"
        why = f"One block takes {revolutions}"
        raise InputError(what, "argument revolutions", why, "Take shorter blocks, or record longer")
    hop = max(length - round(overlap * length), 1)
    starts = np.arange(0, resampled.signal.size - length + 1, hop)
    blocks = np.lib.stride_tricks.sliding_window_view(resampled.signal, length)[starts]
    orders, lines = orders_of_blocks(blocks, revolutions, highest_order, window)
    middle = starts + length // 2
    speed, moments = resampled.speed[middle], resampled.time[middle]
    return OrderMap(orders, speed, moments, lines, float(revolutions), window, unit)


def orders_of_blocks(
    blocks: Array, revolutions: int, highest: float, window: str
) -> tuple[Array, Array]:
    """Orders up to the highest, and the amplitude of each in every block (orders, blocks)."""
    weights = window_values(window, blocks.shape[1])
    lines = np.abs(np.fft.rfft(blocks * weights, axis=1)) * (2.0 / weights.sum())
    lines[:, 0] *= 0.5
    orders = np.arange(lines.shape[1]) / revolutions
    in_range = orders <= highest + 1e-9
    return orders[in_range], lines[:, in_range].T


@record
class OrderCut(Record):
    """Amplitude of one order over the speed.

    Parameters
    ----------
    order : float
        Cycles per revolution [-].
    speed : (m,) array
        Rotational speed [rad/s].
    amplitude : (m,) array
        Peak amplitude, in the unit of the signal.
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    order: float = fact()
    speed: Array = quantity("block", unit="rad/s", axis=True)
    amplitude: Array = quantity("block", unit="@unit")
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        top = int(np.argmax(self.amplitude))
        return (
            f"OrderCut(order {self.order:g}, largest {self.amplitude[top]:.4g} {self.unit} at "
            f"{self.speed[top]:.5g} rad/s)"
        ).replace("  ", " ")


@record
class OrderMap(Record):
    """Amplitude over order and speed.

    Parameters
    ----------
    order : (k,) array
        Cycles per revolution of the shaft [-].
    speed : (m,) array
        Mean rotational speed of each block [rad/s].
    time : (m,) array
        Time of the middle of each block [s].
    amplitude : (k, m) array
        Peak amplitude, in the unit of the signal.
    revolutions : float
        Revolutions in one block [-]; orders differ by its inverse.
    window : str
        Name of the window.
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    order: Array = quantity("order", unit="1", axis=True)
    speed: Array = quantity("block", unit="rad/s", axis=True)
    time: Array = quantity("block", unit="s", axis=True)
    amplitude: Array = quantity("order", "block", unit="@unit")
    revolutions: float = fact()
    window: str = "hann"
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        line, block = self.strongest()
        return (
            f"OrderMap({self.speed.size} blocks from {self.speed[0]:.5g} to "
            f"{self.speed[-1]:.5g} rad/s, to order {self.order[-1]:g}, largest "
            f"{self.amplitude[line, block]:.4g} {self.unit} at order {self.order[line]:g} and "
            f"{self.speed[block]:.5g} rad/s)"
        ).replace("  ", " ")

    def strongest(self) -> tuple[int, int]:
        """Return the indices of the largest amplitude, excluding the mean.

        Returns
        -------
        tuple of two int
            Index of the order and of the block.
        """
        # the mean leaks into the orders next to zero as far as the main lobe of the window
        start = int(np.searchsorted(self.order, 2.5 / self.revolutions))
        line, block = divmod(int(np.argmax(self.amplitude[start:])), self.speed.size)
        return start + line, block

    def cut(self, order: float) -> OrderCut:
        """Amplitude of one order over the speed.

        Parameters
        ----------
        order : float
            Cycles per revolution [-].

        Returns
        -------
        OrderCut
            Between two lines of the map the gain of the window at that distance is taken out.

        Raises
        ------
        InputError
            If the map does not reach that order.
        """
        if not self.order[0] <= order <= self.order[-1]:
            why = f"The map reaches from order {self.order[0]:g} to {self.order[-1]:g}"
            remedy = "Make the map with a larger highest_order"
            raise InputError(f"order {order:g} is requested", "argument order", why, remedy)
        line = int(np.argmin(np.abs(self.order - order)))
        away = (order - float(self.order[line])) * self.revolutions
        offset, gain = window_gain(self.window, 2048)
        loss = 1.0 if abs(away) < 1e-9 else float(np.interp(-away, offset, np.abs(gain)))
        return OrderCut(float(order), self.speed, self.amplitude[line] / loss, self.unit)

    def plot_waterfall(self) -> Any:
        """Draw the order spectra as a waterfall.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, "waterfall")
