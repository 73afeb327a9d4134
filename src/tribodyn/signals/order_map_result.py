"""An order map and its cuts at single orders."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import draw
from tribodyn.errors import InputError, Problem
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.spectrum_peaks import window_gain
from tribodyn.types import Array


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
        """Return where the amplitude is largest, the mean left out.

        Returns
        -------
        tuple of two int
            Index of the order and of the block.
        """
        # the mean reaches into the orders beside zero as far as the main lobe of the window
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
            raise InputError(
                Problem(
                    what=f"order {order:g} asked for",
                    where="argument order",
                    why=f"The map reaches from order {self.order[0]:g} to {self.order[-1]:g}",
                    remedy="Make the map with a larger highest_order",
                )
            )
        line = int(np.argmin(np.abs(self.order - order)))
        away = (order - float(self.order[line])) * self.revolutions
        offset, gain = window_gain(self.window, 2048)
        loss = 1.0 if abs(away) < 1e-9 else float(np.interp(-away, offset, np.abs(gain)))
        return OrderCut(float(order), self.speed, self.amplitude[line] / loss, self.unit)

    def plot_waterfall(self) -> Any:
        """Draw the order spectra one behind the other.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, "waterfall")
