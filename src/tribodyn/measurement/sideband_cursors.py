"""Sideband cursors: amplitudes of an order spectrum at a carrier and evenly spaced orders."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import Argument, InputError, require_positive
from tribodyn.measurement.orders import OrderSpectrum
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

#: Amplitude over the median of the lines around it from which a sideband stands out.
CLEAR = 4.0
#: Lines on each side of a cursor that are its own: half the main lobe of the window.
LOBE = 12


@record
class SidebandCursors(Record):
    """Carrier and sidebands of an order spectrum.

    Parameters
    ----------
    orders : OrderSpectrum
        Spectrum that the cursors are set on.
    carrier : float
        Order of the carrier, for a mesh the number of teeth [-].
    spacing : float
        Orders between the cursors [-]: 1 for the shaft itself, z1/z2 for its mate.
    number : (2 * count + 1,) array of int
        Number of each cursor, 0 for the carrier.
    order : (2 * count + 1,) array
        Order of each cursor [-].
    amplitude : (2 * count + 1,) array
        Peak amplitude there, in the unit of the signal.
    level : (2 * count + 1,) array
        The same over the carrier [dB].
    floor : float
        Median of the lines between the cursors, in the unit of the signal.
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    orders: OrderSpectrum
    carrier: float = fact()
    spacing: float = fact()
    number: NDArray[np.int_] = quantity("number", axis=True)
    order: Array = quantity("number", unit="1", axis=True)
    amplitude: Array = quantity("number", unit="@unit")
    level: Array = quantity("number", unit="dB")
    floor: float = fact()
    unit: str = ""

    @property
    def clear(self) -> NDArray[np.bool_]:
        """Cursors whose lines stand out of those between them."""
        return np.asarray(self.amplitude > CLEAR * self.floor)

    @property
    def strongest(self) -> int:
        """Index of the strongest sideband."""
        return int(np.argmax(np.where(self.number == 0, -np.inf, self.level)))

    def __repr__(self) -> str:
        """One line."""
        strongest = self.strongest
        return (
            f"SidebandCursors(order {self.carrier:.6g} every {self.spacing:.6g}, "
            f"{int(self.clear.sum()) - bool(self.clear[self.number == 0])} of "
            f"{self.number.size - 1} sidebands clear, strongest {self.number[strongest]:+d} at "
            f"{self.level[strongest]:.1f} dB)"
        )


def sideband_cursors(
    orders: OrderSpectrum, carrier: float, spacing: float = 1.0, *, count: int = 5
) -> SidebandCursors:
    """Set cursors on a carrier and its sidebands.

    Parameters
    ----------
    orders : OrderSpectrum
        What :func:`order_spectrum` returns.
    carrier : float
        Order of the carrier [-]: the number of teeth for the mesh of the shaft, or a multiple.
    spacing : float
        Orders between the sidebands [-]: 1 where the shaft modulates, z1/z2 where its mate does.
    count : int
        Sidebands on each side.

    Returns
    -------
    SidebandCursors
        Draws itself over the spectrum.

    Raises
    ------
    InputError
        If a cursor is outside the spectrum, or the spectrum does not resolve the spacing.

    Notes
    -----
    Between the cursors lies the noise, of which ``floor`` is the median. Two families that
    coincide within the resolution, such as those of both gears at equal teeth, cannot be separated.

    Examples
    --------
    >>> from tribodyn.measurement import order_spectrum
    >>> angle = 2 * np.pi * 5.0 * np.arange(40000) / 10000.0
    >>> wave = (1.0 + 0.2 * np.cos(angle)) * np.cos(29 * angle + 0.1 * np.sin(angle))
    >>> sideband_cursors(order_spectrum(wave, angle, 60), 29, count=2)
    SidebandCursors(order 29 every 1, 4 of 4 sidebands clear, strongest +1 at -16.5 dB)
    """
    for name, value in (("carrier", carrier), ("spacing", spacing), ("count", count)):
        require_positive(name, value)
    step = float(orders.orders[1])
    low, high = carrier - count * spacing, carrier + count * spacing
    if low <= 0.0 or high > orders.orders[-1]:
        what = f"{count} sidebands every {spacing:g} reach from order {low:g} to {high:g}"
        why = f"The spectrum goes from 0 to {orders.orders[-1]:g}"
        remedy = "Set fewer cursors, or compute more orders"
        raise InputError(what, Argument("count"), why, remedy)
    if spacing < 2 * LOBE * step:
        what = f"sidebands every {spacing:g} orders"
        least = 2 * LOBE * step
        why = f"Over {orders.revolutions:g} revolutions lines are separate from {least:.3g} on"
        raise InputError(what, Argument("spacing"), why, "Record longer")
    number = np.arange(-count, count + 1)
    cursors = carrier + spacing * number.astype(np.float64)
    places = np.rint(cursors / step).astype(int)
    size = orders._amplitudes_at(cursors)
    first, last = max(places[0] - 2 * LOBE, 1), places[-1] + 2 * LOBE + 1
    between = np.ones(orders.orders.size, dtype=bool)
    for place in places:
        between[max(place - LOBE + 1, 0) : place + LOBE] = False
    floor = float(np.median(orders.amplitudes[first:last][between[first:last]]))
    carrier_size = max(float(size[count]), 1e-300)
    return SidebandCursors(
        orders,
        float(carrier),
        float(spacing),
        number,
        cursors,
        size,
        20.0 * np.log10(np.maximum(size, 1e-300) / carrier_size),
        floor,
        orders.unit,
    )
