"""Sidebands of a recording: cursors on them, and the shaft that makes them."""

from __future__ import annotations

from dataclasses import dataclass
from math import gcd

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import Argument, InputError, Problem, require_positive
from tribodyn.measurement.orders import OrderSpectrum
from tribodyn.nomenclature import require_whole
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

#: Fewest lines that stand out where a gear modulates.
_LEAST = 2
#: Power of the multiples of another order over that of the mesh from which the teeth are doubted,
#: the fewest of a gear, and the largest ratio of the true number to the stated one.
_DOUBT, _FEWEST, _OTHERS = 4.0, 8, 3


@dataclass(frozen=True)
class ShaftLines:
    """Lines of an order spectrum that belong to one of two gears alone.

    Parameters
    ----------
    number : int
        Lines that are neither of the mate nor of the mesh.
    clear : int
        Those of them that stand out of the noise.
    rms : float
        Root mean square of the clear ones together, in the unit of the signal.
    """

    number: int
    clear: int
    rms: float

    @property
    def stands_out(self) -> bool:
        """Whether at least two lines stand out: what varies turns with this gear."""
        return self.clear >= _LEAST


def modulating_shaft(
    orders: OrderSpectrum, teeth: int, mate_teeth: int
) -> tuple[ShaftLines, ShaftLines]:
    """Find lines of the gear on the shaft alone, and lines of its mate alone.

    A fault of a gear repeats with its turns. Where the numbers of teeth have a common factor, some
    of its lines are at the same orders as lines of the mate, whose mean revolution and indicators
    then show the fault too; lines of one gear alone tell which it is.

    Parameters
    ----------
    orders : OrderSpectrum
        Over the turns of the shaft.
    teeth, mate_teeth : int
        Teeth of the gear on the shaft and of its mate [-].

    Returns
    -------
    tuple of ShaftLines
        Of the shaft and of the mate. Of a gear whose every line is one of its mate, all its lines
        if no line of the mate alone is clear.

    Raises
    ------
    InputError
        If a number of teeth is not whole or below 1.

    Examples
    --------
    >>> from tribodyn.measurement import order_spectrum
    >>> angle = 2 * np.pi * 50.0 * np.arange(20000) / 10000.0
    >>> wave = (1.0 + 0.2 * np.cos(16 / 24 * angle)) * np.cos(16 * angle)
    >>> wave += 1e-3 * np.random.default_rng(1).standard_normal(wave.size)
    >>> shaft, mate = modulating_shaft(order_spectrum(wave, angle, 40), 16, 24)
    >>> shaft.stands_out, mate.stands_out
    (False, True)
    """
    for name, count in (("teeth", teeth), ("mate_teeth", mate_teeth)):
        require_whole(name, count, 1)
    reach = LOBE * float(orders.orders[1])
    top = float(orders.orders[-1]) - reach
    families: list[Array] = [
        np.arange(1.0, int(top / each) + 1.0) * each for each in (1.0, teeth / mate_teeth)
    ]
    floor = _floor(orders, np.concatenate(families))
    mesh = np.arange(0.0, top + teeth, teeth)

    def lines_of(family: Array, strange: Array) -> ShaftLines:
        alone = family[_distance(family, strange) > reach]
        places = np.rint(alone / orders.orders[1]).astype(int)
        size = orders._amplitudes_at(alone)
        clear = size > CLEAR * floor[places]
        return ShaftLines(
            places.size, int(clear.sum()), float(np.sqrt(0.5 * np.sum(size[clear] ** 2)))
        )

    of_gears = [
        lines_of(family, np.concatenate([other, mesh]))
        for family, other in (families, families[::-1])
    ]
    for number in (0, 1):  # a multiple of its teeth is the number of its mate's
        if not of_gears[number].number and not of_gears[1 - number].stands_out:
            of_gears[number] = lines_of(families[number], mesh)
    return of_gears[0], of_gears[1]


def doubt_teeth(orders: OrderSpectrum, teeth: int) -> Problem | None:
    """Doubt a number of teeth where multiples of another order hold far more power than its."""
    highest = float(orders.orders[-1])
    floor = CLEAR * float(np.median(orders.amplitudes))

    def power(count: int) -> float:
        size = orders._amplitudes_at(np.arange(float(count), highest + 1e-9, count))
        return float(np.sum(size[size > floor] ** 2))

    counts = range(max(teeth // _OTHERS, _FEWEST), min(_OTHERS * teeth, int(highest)) + 1)
    powers = {count: power(count) for count in counts}
    most = max(powers.values(), default=0.0)
    if most <= _DOUBT * powers.get(teeth, most):
        return None
    likely = max(count for count, value in powers.items() if value > 0.9 * most)
    times = most / max(powers[teeth], 1e-3 * most)
    return Problem(
        f"the mesh lines seem to be multiples of order {likely}, not of {teeth}",
        "",
        f"Those hold {times:.0f} times the power or more",
        "Check the number of teeth, and the pulses of the tachometer in a revolution",
    )


def explain_modulation(
    lines: tuple[ShaftLines, ShaftLines], teeth: int, mate_teeth: int, unit: str
) -> str:
    """Sentence that names the gear whose lines stand out; empty where none does."""
    if teeth == mate_teeth:
        return ""
    names = ("shaft", "mate")
    loud = [k for k in (0, 1) if lines[k].stands_out]
    if not loud:
        return ""
    parts = [
        f"{lines[k].clear} of the {lines[k].number} lines of the {names[k]} stand out of the "
        f"noise, rms {lines[k].rms:.3g} {unit}".rstrip()
        for k in loud
    ]
    if len(loud) == 2:
        return f"Both gears modulate the mesh: {'; '.join(parts)}."
    this, other = names[loud[0]], 1 - loud[0]
    text = f"What modulates the mesh turns with the {this}: {parts[0]}, "
    text += f"of the {names[other]} alone {lines[other].clear or 'none'}."
    common = gcd(teeth, mate_teeth)
    if common > 1:
        text += (
            f" Teeth with the common factor {common} put lines of the {this} into the mean "
            f"revolution of the {names[other]} too: its indicators are not those of the "
            f"{names[other]} alone."
        )
    return text


def _distance(orders: Array, others: Array) -> Array:
    """Distance of each order to the nearest of others."""
    others = np.sort(others)
    right = np.clip(np.searchsorted(others, orders), 1, others.size - 1)
    return np.minimum(np.abs(orders - others[right - 1]), np.abs(orders - others[right]))


def _floor(orders: OrderSpectrum, lines: Array) -> Array:
    """Noise at each order: medians between the lines over stretches of four orders."""
    step = float(orders.orders[1])
    between = _distance(orders.orders, np.append(lines, 0.0)) > LOBE * step
    if not between.any():
        return np.full(orders.orders.size, np.inf)
    places = np.flatnonzero(between)
    stretches = np.array_split(places, max(1, int(orders.orders[-1] / 4.0)))
    stretches = [each for each in stretches if each.size]
    centers = [float(orders.orders[each].mean()) for each in stretches]
    medians = [float(np.median(orders.amplitudes[each])) for each in stretches]
    return np.interp(orders.orders, centers, medians)


#: Amplitude over the median of the lines around it from which a sideband is clear.
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
