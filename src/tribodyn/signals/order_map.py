"""Order map: what turns with the shaft, apart from what does not, over its speed."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem, require_between, require_positive
from tribodyn.signals.order_map_resampling import angular_resampling, shaft_rotation
from tribodyn.signals.order_map_result import OrderMap
from tribodyn.signals.spectrum_input import checked_rising, checked_signal, window_values


def order_map(
    signal: Any,
    time: Any,
    *,
    rotation: Any = None,
    speed: Any = None,
    highest_order: float = 50.0,
    revolutions: int = 8,
    overlap: float = 0.75,
    window: str = "hann",
    unit: str = "",
) -> OrderMap:
    """Amplitude over orders and speed of a run-up, by resampling over the rotation.

    Parameters
    ----------
    signal : (n,) array
        Signal over time, in any unit.
    time : (n,) array
        Time of each sample [s].
    rotation : (n,) array, optional
        Rotation of the shaft at each sample [rad], counted on without wrap.
    speed : float or (n,) array, optional
        Rotational speed [rad/s], instead of the rotation.
    highest_order : float
        Highest order, in cycles per revolution [-].
    revolutions : int
        Revolutions in a block: orders are told apart down to about two over this number, and
        amplitudes are means over so many revolutions.
    overlap : float
        Part of a block that it shares with the next [-].
    window : str
        Window of :func:`scipy.signal.get_window`; ``"flattop"`` for orders that are no multiple
        of one over ``revolutions``.
    unit : str
        Unit of the signal, for display.

    Returns
    -------
    OrderMap

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
    >>> made = order_map(np.cos(3 * rotation) * 2.0, time, speed=speed, highest_order=8, unit="N")
    >>> float(made.order[made.strongest()[0]]), float(made.order[1])
    (3.0, 0.125)
    >>> round(float(made.cut(3).amplitude.min()), 3)
    2.0
    """
    values = checked_signal(signal, 16)
    moments = checked_rising(time, values.size, "time", "s")
    angle = shaft_rotation(rotation, speed, moments)
    require_positive("highest_order", highest_order)
    require_positive("revolutions", revolutions)
    require_between("overlap", overlap, 0.0, 0.95)
    per_turn = 2 * int(np.ceil(1.3 * highest_order + 2))
    made = angular_resampling(
        values,
        moments,
        angle,
        samples_per_revolution=per_turn,
        highest_order=highest_order,
    )
    length = revolutions * per_turn
    if made.signal.size < length:
        raise InputError(
            Problem(
                what=f"the record holds {made.signal.size / per_turn:.3g} revolutions",
                where="argument revolutions",
                why=f"One block takes {revolutions}",
                remedy="Take shorter blocks, or record longer",
            )
        )
    hop = max(length - round(overlap * length), 1)
    starts = np.arange(0, made.signal.size - length + 1, hop)
    weights = window_values(window, length)
    blocks = np.lib.stride_tricks.sliding_window_view(made.signal, length)[starts]
    lines = np.abs(np.fft.rfft(blocks * weights, axis=1)) * (2.0 / weights.sum())
    lines[:, 0] *= 0.5
    orders = np.arange(lines.shape[1]) / revolutions
    kept = orders <= highest_order + 1e-9
    middle = starts + length // 2
    return OrderMap(
        orders[kept],
        made.speed[middle],
        made.time[middle],
        lines[:, kept].T,
        float(revolutions),
        window,
        unit,
    )
