"""Orders of a run-up: their amplitude over the speed, the overall level and the resonances."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.dynamics.linear.natural_modes import NaturalModes
from tribodyn.dynamics.running_up.run_up_result import RunUp
from tribodyn.errors import InputError, require_between, require_one_of, require_positive
from tribodyn.record import Record, quantity, record
from tribodyn.signals.angular_resampling import window_values
from tribodyn.signals.order_map import OrderCut, OrderMap, orders_of_blocks
from tribodyn.signals.spectrum import mains_of
from tribodyn.types import Array, Index, Mask

Part = Literal["all", "up", "down"]

#: Fewest and most mesh cycles in a block of one order.
_SHORT, _LONG = 4, 64


@record
class OverallLevel(Record):
    """Alternating rms of a signal over the speed.

    Parameters
    ----------
    time : (m,) array
        Time of the middle of each block [s].
    speed : (m,) array
        Speed of the shaft there [rad/s].
    rms : (m,) array
        Alternating rms, in the unit of the signal.
    unit : str
        Unit of the signal.
    """

    ARRAY = "rms"

    time: Array = quantity("block", unit="s", axis=True)
    speed: Array = quantity("block", unit="rad/s", axis=True)
    rms: Array = quantity("block", unit="@unit")
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        top = int(np.argmax(self.rms))
        return (
            f"OverallLevel({self.speed.size} blocks, largest {self.rms[top]:.4g} {self.unit} at "
            f"{self.speed[top]:.5g} rad/s)"
        ).replace("  ", " ")


def _blocks_inside(run: RunUp, starts: Index, cycles: int, part: Part) -> Mask:
    """Return a mask of the blocks that lie entirely in a part of the run."""
    require_one_of("part", part, ("all", "up", "down"))
    if part == "all":
        return np.ones(starts.size, dtype=bool)
    in_part = run.cycles.rate > 0.0 if part == "up" else run.cycles.rate < 0.0
    count = np.append(0, np.cumsum(in_part))
    inside_part = count[starts + cycles] - count[starts] == cycles
    if not inside_part.any():
        what = f"the speed never goes {part} for {cycles} mesh cycles"
        why = "An order map needs a record of this length"
        raise InputError(what, "argument part", why, 'Take part="all", or a profile that does')
    return np.asarray(inside_part)


def _starts(run: RunUp, cycles: int, hop: int, part: Part) -> tuple[Index, Index]:
    """First mesh cycle of each block, and the sample in its middle."""
    total = run.cycles.time.size
    if total < cycles:
        what, why = f"the run has {total} mesh cycles", f"One block takes {cycles}"
        raise InputError(what, "argument cycles", why, "Take shorter blocks, or a longer run")
    starts: Index = np.arange(0, total - cycles + 1, hop, dtype=np.int64)
    starts = starts[_blocks_inside(run, starts, cycles, part)]
    return starts, starts * run.samples + cycles * run.samples // 2


def run_up_order_map(
    run: RunUp,
    signal: str = "contact_force",
    *,
    cycles: int = 16,
    overlap: float = 0.75,
    highest_order: float | None = None,
    window: str = "hann",
    part: Part = "all",
) -> OrderMap:
    """Amplitude over orders and speed of a computed run-up.

    Parameters
    ----------
    run : RunUp
    signal : str
        ``"deflection"``, ``"contact_force"``, a coordinate (its acceleration) or an output.
    cycles : int
        Mesh cycles in a block: mesh orders are resolved down to about two over this number.
    overlap : float
        Part of a block that it shares with the next [-].
    highest_order : float, optional
        Highest mesh order [-]; all by default.
    window : str
        Window of :func:`scipy.signal.get_window`.
    part : "all", "up" or "down"
        Part of the run.

    Returns
    -------
    OrderMap
        Over orders of the shaft: mesh order times ``run.teeth``.

    Raises
    ------
    InputError
        If an argument is out of range or the run is shorter than a block.

    Notes
    -----
    The samples of a run-up lie equally in the mesh phase, so that nothing is resampled.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact, System, run_up
    >>> pair = Contact([1.0], stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase))
    >>> system = System([[1.0]], [[0.2]], [[0.0]], [1.0], [pair])
    >>> run = run_up(system, ([0.0, 60.0], [1.0, 2.0]), samples=16)
    >>> result = run_up_order_map(run, "deflection")
    >>> float(result.order[result.strongest()[0]])
    1.0
    """
    require_positive("cycles", cycles)
    require_between("overlap", overlap, 0.0, 0.95)
    values, unit = run.signal(signal)
    length = int(cycles) * run.samples
    starts, middle = _starts(run, int(cycles), max(round((1.0 - overlap) * cycles), 1), part)
    blocks = np.lib.stride_tricks.sliding_window_view(values, length)[starts * run.samples]
    highest = run.samples / 2 if highest_order is None else highest_order
    orders, lines = orders_of_blocks(blocks, cycles, highest, window)
    speed, moments = run.speed[middle], run.time[middle]
    return OrderMap(orders * run.teeth, speed, moments, lines, cycles / run.teeth, window, unit)


def order_cut(
    source: RunUp | OrderMap,
    order: float,
    signal: str = "contact_force",
    *,
    of: Literal["mesh", "shaft"] = "mesh",
    cycles: int | None = None,
    part: Part = "all",
) -> OrderCut:
    """Amplitude of one order over the speed.

    Parameters
    ----------
    source : RunUp or OrderMap
        Of an order map the order counts per revolution, and the other arguments do not matter.
    order : float
        Cycles per mesh cycle, or per revolution of the shaft [-].
    signal : str
        ``"deflection"``, ``"contact_force"``, a coordinate (its acceleration) or an output.
    of : "mesh" or "shaft"
        What the order counts.
    cycles : int, optional
        Mesh cycles in a block; by default the fewest, from 4 to 64, in which the order fits a whole
        number of times: orders that do so too leave no trace.
    part
        As in :func:`run_up_order_map`.

    Returns
    -------
    OrderCut
        Its order counts per revolution.

    Raises
    ------
    InputError
        If the order is not below half of the samples, or an argument is out of range.

    Notes
    -----
    A Hann window over the mesh phase. Amplitudes are means over a block, in which the speed changes
    a little: a narrow resonance passed quickly comes out lower in longer blocks.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact, System, run_up
    >>> pair = Contact([1.0], stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase))
    >>> system = System([[1.0]], [[0.2]], [[0.0]], [1.0], [pair])
    >>> run = run_up(system, ([0.0, 60.0], [1.0, 2.0]), samples=16, teeth=2)
    >>> float(order_cut(run, 1, "deflection").order)
    2.0
    """
    if isinstance(source, OrderMap):
        return source.cut(order)
    require_one_of("of", of, ("mesh", "shaft"))
    require_positive("order", order)
    mesh = order / source.teeth if of == "shaft" else order
    if mesh >= source.samples / 2:
        what = f"mesh order {mesh:g} with {source.samples} samples per mesh cycle"
        why = "Orders up to half of the samples per cycle can be resolved"
        remedy = f"Run with samples = {4 * int(np.ceil(mesh))} or more"
        raise InputError(what, "argument order", why, remedy)
    values, unit = source.signal(signal)
    count = cycles or _shortest_block(mesh)
    starts, middle = _starts(source, count, max(count // 4, 1), part)
    phase = np.arange(count * source.samples) / source.samples
    weights = window_values("hann", phase.size)
    wave = weights * np.exp(-2j * np.pi * mesh * phase) * (2.0 / weights.sum())
    view = np.lib.stride_tricks.sliding_window_view(values, phase.size)
    amplitude = np.array([abs(view[each] @ wave) for each in starts * source.samples])
    return OrderCut(mesh * source.teeth, source.speed[middle], amplitude, unit)


def _shortest_block(mesh: float) -> int:
    """Fewest mesh cycles in which an order fits a whole number of times."""
    counts = np.arange(_SHORT, _LONG + 1)
    away = np.abs(counts * mesh - np.round(counts * mesh))
    # Less than one period in a block cannot be separated from the mean.
    fits = (away < 1e-9) & (counts * mesh >= 2.0 - 1e-9)
    return int(counts[np.argmax(fits)]) if fits.any() else _LONG


def overall_level(
    run: RunUp, signal: str = "contact_force", *, cycles: int = 4, part: Part = "all"
) -> OverallLevel:
    """Alternating rms of a signal over the speed.

    Parameters
    ----------
    run, signal
        As in :func:`run_up_order_map`.
    cycles : int
        Mesh cycles over which the mean and the mean square are taken.
    part
        As in :func:`run_up_order_map`.

    Raises
    ------
    InputError
        If an argument is out of range or the run is shorter than a block.

    Notes
    -----
    From the figures of the mesh cycles, which are exact to the order of the integrator; for the sum
    of several contacts from the samples.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact, System, run_up
    >>> pair = Contact([1.0], stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase))
    >>> system = System([[1.0]], [[0.2]], [[0.0]], [1.0], [pair])
    >>> overall_level(run_up(system, ([0.0, 60.0], [1.0, 2.0]), samples=16)).speed.size
    87
    """
    require_positive("cycles", cycles)
    starts, middle = _starts(run, int(cycles), 1, part)
    mean, square, unit = _cycle_moments(run, signal)
    sums = [np.append(0.0, np.cumsum(each)) for each in (mean, square)]
    first, second = ((each[starts + cycles] - each[starts]) / cycles for each in sums)
    rms = np.sqrt(np.maximum(second - first**2, 0.0))
    return OverallLevel(run.time[middle], run.speed[middle], rms, unit)


def _cycle_moments(run: RunUp, signal: str) -> tuple[Array, Array, str]:
    """Mean and mean square of a signal in every mesh cycle, and its unit."""
    values, unit = run.signal(signal)
    if signal in run.names:
        part, column = run.cycles.acceleration, run.names.index(signal)
    elif signal in run.output_names:
        part, column = run.cycles.output, run.output_names.index(signal)
    elif signal == "deflection":
        part, column = run.cycles.deflection, 0
    elif run.contact_force.shape[1] == 1:
        part, column = run.cycles.contact_force, 0
    else:
        rows = values.reshape(-1, run.samples)
        return rows.mean(axis=1), (rows**2).mean(axis=1), unit
    return part.mean[:, column], part.rms[:, column] ** 2, unit


@dataclass(frozen=True)
class RunUpResonance:
    """A peak of one order over the speed.

    Parameters
    ----------
    order : float
        Cycles per mesh cycle [-].
    shaft_order : float
        Cycles per revolution of the shaft [-].
    speed : float
        Speed of the shaft [rad/s].
    mesh_frequency : float
        Mesh frequency [Hz].
    frequency : float
        Order times mesh frequency [Hz].
    mode : int
        Number of the natural mode, the rigid ones counted from 0; -1 if none is near.
    mode_frequency : float
        Its natural frequency [Hz]; NaN if none is near.
    amplitude : float
        Peak amplitude, in the unit of the signal.
    prominence : float
        Height over the higher of the two adjacent valleys, in the unit of the signal.
    mains : float
        50 or 60 where the frequency is that of the mains or twice it, so that a measured peak may
        be electrical [Hz]; 0 elsewhere.
    """

    order: float
    shaft_order: float
    speed: float
    mesh_frequency: float
    frequency: float
    mode: int
    mode_frequency: float
    amplitude: float
    prominence: float
    mains: float

    def __repr__(self) -> str:
        """One line, in the units of engineers."""
        mode = f"near mode {self.mode} of {self.mode_frequency:.6g} Hz"
        return (
            f"RunUpResonance(order {self.order:g} peaks at {30.0 / np.pi * self.speed:.6g} rpm, "
            f"{self.frequency:.6g} Hz, {mode if self.mode >= 0 else 'near no mode'})"
        )


@with_old_names
def resonances(
    run: RunUp,
    signal: str = "contact_force",
    *,
    orders: Iterable[float] = (1, 2, 3, 4, 5),
    modes: NaturalModes | None = None,
    part: Part = "all",
    prominence: float = 0.05,
    frequency_tolerance: float = 0.1,
) -> tuple[RunUpResonance, ...]:
    """Find peaks of mesh orders over the speed and the natural modes that they meet.

    Parameters
    ----------
    run, signal
        As in :func:`run_up_order_map`.
    orders : iterable of float
        Mesh orders [-].
    modes : NaturalModes, optional
        Natural modes; those of the run by default.
    part : "all", "up" or "down"
        Part of the run; peaks of a run-up and of a run-down are different peaks.
    prominence : float
        Least prominence over the largest amplitude of all orders [-].
    frequency_tolerance : float
        Largest distance to a natural frequency, over that frequency [-].

    Returns
    -------
    tuple of RunUpResonance
        The strongest first.

    Raises
    ------
    InputError
        If there is no order, or an argument is out of range.

    Notes
    -----
    A contact that pulsates and opens shifts its resonances, and a quick run passes them late: the
    peak is off the natural frequency. Of the modes within reach the nearest whose strain sits
    in the contacts to a hundredth or more is named.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact, System, run_up
    >>> pair = Contact([1.0], stiffness=40.0, error=lambda phase: 0.1 * np.cos(2 * np.pi * phase))
    >>> run = run_up(System([[1.0]], [[0.3]], [[0.0]], [0.0], [pair]), ([0.0, 400.0], [0.6, 1.6]))
    >>> (peak,) = resonances(run, orders=[1])
    >>> peak.mode, round(peak.mode_frequency, 3), abs(peak.frequency - 1.007) < 0.03
    (0, 1.007, True)
    """
    from scipy.signal import find_peaks

    lines = [float(order) for order in orders]
    if not lines:
        what, why = "orders is empty", "Each curve belongs to one order"
        raise InputError(what, "argument orders", why, "Give orders=(1, 2, 3), say")
    require_between("prominence", prominence, 0.0, 1.0)
    natural_modes = modes if modes is not None else run.modes
    cuts = [order_cut(run, order, signal, part=part) for order in lines]
    largest = max(float(cut.amplitude.max()) for cut in cuts)
    resonance_peaks: list[RunUpResonance] = []
    for order, cut in zip(lines, cuts, strict=True):
        tops, properties = find_peaks(cut.amplitude, prominence=max(prominence * largest, 1e-300))
        for index, height in zip(tops, properties["prominences"], strict=True):
            speed, top = _vertex(cut.speed, cut.amplitude, int(index))
            beat = speed * run.teeth / (2.0 * np.pi)
            mode, natural = _mode(natural_modes, order * beat, frequency_tolerance)
            resonance_peaks.append(
                RunUpResonance(
                    order,
                    order * run.teeth,
                    speed,
                    beat,
                    order * beat,
                    mode,
                    natural,
                    top,
                    float(height),
                    mains_of(order * beat),
                )
            )
    return tuple(sorted(resonance_peaks, key=lambda peak: -peak.amplitude))


def _vertex(speed: Array, amplitude: Array, index: int) -> tuple[float, float]:
    """Top of the parabola through a peak and its neighbours."""
    left, middle, right = amplitude[index - 1 : index + 2]
    bend = left - 2.0 * middle + right
    shift = 0.5 * (left - right) / bend if bend < 0.0 else 0.0
    top_speed = float(np.interp(index + shift, np.arange(speed.size), speed))
    return top_speed, float(middle - 0.25 * (left - right) * shift)


def _mode(modes: NaturalModes | None, frequency: float, tolerance: float) -> tuple[int, float]:
    if modes is None:
        return -1, float("nan")
    natural = np.where(modes.frequency > 0.0, modes.frequency, np.inf)
    away = np.abs(frequency / natural - 1.0)
    share = modes.contact_share if modes.contacts else np.ones_like(natural)
    away = np.where((away <= tolerance) & (share >= 0.01), away, np.inf)
    number = int(np.argmin(away))
    if not np.isfinite(away[number]):
        return -1, float("nan")
    return number, float(natural[number])
