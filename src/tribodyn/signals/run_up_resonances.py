"""Resonances of a run-up: peaks of its orders, and the natural modes that they meet."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.linear.natural_modes import NaturalModes
from tribodyn.dynamics.running_up.run_up_result import RunUp
from tribodyn.errors import InputError, require_between
from tribodyn.signals.run_up_orders import Part, order_cut
from tribodyn.types import Array

#: Frequencies of the mains [Hz], and how near a peak has to be.
_MAINS, _MAINS_NEAR = (50.0, 60.0), 0.02


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
        Height over the higher of the two valleys beside it, in the unit of the signal.
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


def resonances(
    run: RunUp,
    signal: str = "contact_force",
    *,
    orders: Iterable[float] = (1, 2, 3, 4, 5),
    modes: NaturalModes | None = None,
    part: Part = "all",
    prominence: float = 0.05,
    near: float = 0.1,
) -> tuple[RunUpResonance, ...]:
    """Find peaks of mesh orders over the speed and the natural modes that they meet.

    Parameters
    ----------
    run : RunUp
    signal : str
        ``"deflection"``, ``"contact_force"``, a coordinate (its acceleration) or an output.
    orders : iterable of float
        Mesh orders [-].
    modes : NaturalModes, optional
        Natural modes; those of the run by default.
    part : "all", "up" or "down"
        Part of the run; peaks of a run-up and of a run-down are different peaks.
    prominence : float
        Least prominence over the largest amplitude of all orders [-].
    near : float
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
    peak lies beside the natural frequency. Of the modes within reach the nearest whose strain sits
    in the contacts to a hundredth or more is named.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact, System, run_up
    >>> pair = Contact([1.0], stiffness=40.0, error=lambda phase: 0.1 * np.cos(2 * np.pi * phase))
    >>> run = run_up(System([[1.0]], [[0.3]], [[0.0]], [0.0], [pair]), ([0.0, 400.0], [0.6, 1.6]))
    >>> (found,) = resonances(run, orders=[1])
    >>> found.mode, round(found.mode_frequency, 3), abs(found.frequency - 1.007) < 0.03
    (0, 1.007, True)
    """
    from scipy.signal import find_peaks

    lines = [float(order) for order in orders]
    if not lines:
        raise InputError("no order is asked for", where="argument orders")
    require_between("prominence", prominence, 0.0, 1.0)
    known = modes if modes is not None else run.modes
    cuts = [order_cut(run, order, signal, part=part) for order in lines]
    largest = max(float(cut.amplitude.max()) for cut in cuts)
    found: list[RunUpResonance] = []
    for order, cut in zip(lines, cuts, strict=True):
        peaks, facts = find_peaks(cut.amplitude, prominence=max(prominence * largest, 1e-300))
        for place, height in zip(peaks, facts["prominences"], strict=True):
            speed, top = _vertex(cut.speed, cut.amplitude, int(place))
            beat = speed * run.teeth / (2.0 * np.pi)
            mode, natural = _mode(known, order * beat, near)
            found.append(
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
                    _mains(order * beat),
                )
            )
    return tuple(sorted(found, key=lambda each: -each.amplitude))


def _vertex(speed: Array, amplitude: Array, place: int) -> tuple[float, float]:
    """Top of the parabola through a peak and its neighbours."""
    left, middle, right = amplitude[place - 1 : place + 2]
    bend = left - 2.0 * middle + right
    shift = 0.5 * (left - right) / bend if bend < 0.0 else 0.0
    at = float(np.interp(place + shift, np.arange(speed.size), speed))
    return at, float(middle - 0.25 * (left - right) * shift)


def _mode(modes: NaturalModes | None, frequency: float, near: float) -> tuple[int, float]:
    if modes is None:
        return -1, float("nan")
    natural = np.where(modes.frequency > 0.0, modes.frequency, np.inf)
    away = np.abs(frequency / natural - 1.0)
    share = modes.contact_share if modes.contacts else np.ones_like(natural)
    away = np.where((away <= near) & (share >= 0.01), away, np.inf)
    number = int(np.argmin(away))
    if not np.isfinite(away[number]):
        return -1, float("nan")
    return number, float(natural[number])


def _mains(frequency: float) -> float:
    for mains in _MAINS:
        for times in (1.0, 2.0):
            if abs(frequency / (times * mains) - 1.0) <= _MAINS_NEAR:
                return mains
    return 0.0
