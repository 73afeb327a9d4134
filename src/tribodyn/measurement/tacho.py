"""From the pulses of a tachometer to the angle of the shaft."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Literal

import numpy as np

from tribodyn.checks import require_whole
from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    require_one_of,
    require_positive,
    warn,
)
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.types import Array

#: Part of the distance of both levels by which the signal must pass the middle.
_HYSTERESIS = 0.25
#: Most pulses that can be missing in a row; a longer pause is slow running or standstill.
_MISSING = 3
#: Pulses on either side of a gap that tell how long it should be.
_NEIGHBOURS = 4
#: Part of the height that a steep edge rises within one sample.
_STEEP = 0.8
#: Squared residual over that of unsure edges up to which a smoother curve will do.
_ENOUGH = 1.05
#: Times the longest gap that acceleration explains; from rest the first gap is 1.33 of it.
_WIDER = 1.5
#: Longer than so many gaps beside it is a rest, at which the angle is parted.
_REST = 8.0
#: Most pulses in one piece of the smoothing spline.
_COARSEST = 4096


def shaft_angle(
    tacho: Any,
    sample_rate: float,
    pulses_per_revolution: int,
    *,
    edge: Literal["rising", "falling"] = "rising",
    threshold: float | None = None,
) -> Array:
    """Angle of a shaft at every sample of a tachometer signal.

    Parameters
    ----------
    tacho : (n,) array
        Signal of the tachometer: pulses, or a wave with one period per pulse.
    sample_rate : float
        Samples per second [Hz].
    pulses_per_revolution : int
        Pulses in one revolution of the shaft.
    edge : {"rising", "falling"}
        Edge of the pulse that counts.
    threshold : float, optional
        Level of the edge, in the unit of the signal; midway between its two levels by default.

    Returns
    -------
    (n,) array
        Angle from the first pulse [rad], never falling.

    Raises
    ------
    InputError
        If the signal is not finite, too short or an argument is out of its range.
    ComputationError
        If fewer than four pulses are found.

    Warns
    -----
    ModelWarning
        ``tacho-repaired`` with the number of pulses that were missing or double.

    Notes
    -----
    The moment of an edge is interpolated between two samples; another edge counts only once the
    signal has passed a quarter of its height on the other side (hysteresis). A pulse is double
    where it parts a gap that is as long as its neighbours together with the one after it, and
    pulses are missing where a gap is two to four times as long as those on either side let
    expect. The angle over time is a cubic spline by least squares, whose pieces hold as many
    pulses as generalized cross validation finds best, so that jitter of single pulses is smoothed
    and speed is not; of steep edges as many as leave a residual within the sampling step, whose
    error repeats at a steady speed and is no speed. Before the first pulse, after the last one and
    around a rest the shaft goes on with its acceleration there until it stands.
    G. Wahba, Spline Models for Observational Data, SIAM 1990, equation (4.3.1).

    Examples
    --------
    >>> time = np.arange(20000) / 10000.0
    >>> angle = 2 * np.pi * (10.0 * time + 5.0 * time**2)
    >>> found = shaft_angle(np.sin(60 * angle), 10000.0, 60)
    >>> bool(np.abs(found - found[0] - angle)[100:-100].max() < 1e-4)
    True
    """
    return angle_and_jitter(tacho, sample_rate, pulses_per_revolution, edge, threshold)[0]


def angle_and_jitter(
    tacho: Any,
    sample_rate: float,
    pulses_per_revolution: int,
    edge: Literal["rising", "falling"] = "rising",
    threshold: float | None = None,
) -> tuple[Array, float]:
    """Angle of the shaft at every sample, and the rms distance of the pulses from it [rad]."""
    values = checked_signal(tacho, 16, "tacho")
    require_positive("sample_rate", sample_rate, "Hz")
    each = 2.0 * np.pi / require_whole("pulses_per_revolution", pulses_per_revolution)
    require_one_of("edge", edge, ("rising", "falling"))
    moments, unsure = edges(values if edge == "rising" else -values, threshold, edge)
    count, moments = counted(moments / sample_rate)
    time = np.arange(values.size) / sample_rate
    turned = _turned(moments, count, time, unsure / sample_rate)
    jitter = each * float(np.std(np.interp(moments, time, turned) - count))
    return np.asarray(np.maximum.accumulate(each * turned)), jitter


def edges(values: Array, threshold: float | None, edge: str = "rising") -> tuple[Array, float]:
    """Moments at which the signal rises through its threshold, and how unsure they are [samples].

    Of an edge that rises within one sample it is known between which two samples it lies.
    """
    if threshold is None:
        level, height = _levels(values)
    else:
        level = float(threshold) if edge == "rising" else -float(threshold)
        height = float(np.ptp(values))
    above = values > level
    # The state changes where the signal leaves the band around the threshold.
    decided = np.where(values > level + _HYSTERESIS * height, 1, 0)
    decided[values < level - _HYSTERESIS * height] = -1
    known = np.flatnonzero(decided)
    turns = known[1:][(decided[known[1:]] > 0) & (decided[known[:-1]] < 0)]
    rises = np.flatnonzero(~above[:-1] & above[1:])
    # The last rise through the threshold before the signal is surely high is the edge.
    last = rises[np.searchsorted(rises, turns, side="left") - 1] if rises.size else rises
    if last.size < 4:
        raise ComputationError(
            f"{last.size} pulses found",
            Argument("tacho"),
            f"At least four are needed; looked for edges through {level:.4g}, with levels "
            f"{_HYSTERESIS * height:.4g} below and above",
            "Give the threshold, the other edge, or a longer record",
        )
    low, high = values[last], values[last + 1]
    steep = np.median(high - low) > _STEEP * height
    return np.asarray(last + (level - low) / (high - low)), 1.0 / np.sqrt(12.0) if steep else 0.0


def _levels(values: Array) -> tuple[float, float]:
    """Level midway between low and high of a signal with two levels, and their distance."""
    level = 0.5 * float(values.min() + values.max())
    for _ in range(20):
        above = values > level
        if above.all() or not above.any():
            what = "the signal is constant"
            remedy = "Look at the channel: is the tachometer connected?"
            raise InputError(what, Argument("tacho"), "No pulse can be told from it", remedy)
        low, high = float(values[~above].mean()), float(values[above].mean())
        if abs(0.5 * (low + high) - level) < 1e-6 * (high - low):
            break
        level = 0.5 * (low + high)
    return 0.5 * (low + high), high - low


def counted(moments: Array) -> tuple[Array, Array]:
    """Number of every pulse and its moment, without double ones and with room for missing ones."""
    moments, double = _without_double(moments)
    gaps = np.diff(moments)
    expected = _expected(gaps)
    steps = np.rint(gaps / expected)
    even = np.abs(gaps / expected - steps) < 0.25 * steps
    missing = (steps > 1) & (steps <= 1 + _MISSING) & even & (gaps > _WIDER * _longest(gaps))
    number = np.concatenate(([0.0], np.cumsum(np.where(missing, steps, 1.0))))
    lost = int(np.sum(steps[missing] - 1.0))
    if double or lost:
        told = [f"{n} {kind}" for n, kind in ((lost, "missing"), (double, "double")) if n]
        warn(
            "tacho-repaired",
            f"Of {moments.size + double} pulses {' and '.join(told)}: the angle counts them as "
            "they should be. Look at the tachometer if they are many, or sample it faster.",
            stacklevel=4,
        )
    return number, moments


def _expected(gaps: Array) -> Array:
    """Gap that the neighbours on both sides let expect, at a speed that changes steadily."""
    wide = np.pad(gaps, _NEIGHBOURS, mode="edge")
    around = np.lib.stride_tricks.sliding_window_view(wide, 2 * _NEIGHBOURS + 1)
    before, after = around[:, :_NEIGHBOURS], around[:, _NEIGHBOURS + 1 :]
    return np.asarray(np.sqrt(np.median(before, axis=1) * np.median(after, axis=1)))


def _longest(gaps: Array) -> Array:
    """Longest gap that either side lets expect: a shaft that comes to rest leaves long ones.

    The square of the speed goes on along a line over the angle, as under constant acceleration;
    slope and level are medians, so that one gap that is wrong itself does not count.
    """
    wide = np.pad(1.0 / gaps**2, _NEIGHBOURS, mode="reflect")
    around = np.lib.stride_tricks.sliding_window_view(wide, 2 * _NEIGHBOURS + 1)
    found = np.zeros_like(gaps)
    places = np.arange(1.0, _NEIGHBOURS + 1)
    first, second = np.triu_indices(_NEIGHBOURS, 1)
    for side in (around[:, :_NEIGHBOURS][:, ::-1], around[:, _NEIGHBOURS + 1 :]):
        slopes = (side[:, second] - side[:, first]) / (places[second] - places[first])
        slope = np.median(slopes, axis=1, keepdims=True)
        square = np.median(side - slope * places, axis=1)
        found = np.maximum(found, 1.0 / np.sqrt(np.maximum(square, 1e-4 * side[:, 0])))
    return found


def _without_double(moments: Array) -> tuple[Array, int]:
    """Drop the pulse that parts a gap; of the two gaps beside it the shorter one shows which."""
    dropped = 0
    while moments.size > 4:
        gaps = np.diff(moments)
        expected = _expected(gaps)
        pair = gaps[:-1] + gaps[1:]
        either = np.minimum(gaps[:-1], gaps[1:])
        whole = np.sqrt(expected[:-1] * expected[1:])
        spare = (either < 0.5 * whole) & (pair < 1.35 * whole)
        if not spare.any():
            break
        # Of neighbours that both look spare only the one with the shorter gap is.
        shortest = np.where(spare, either, np.inf)
        beside = np.minimum(np.append(shortest[1:], np.inf), np.append(np.inf, shortest[:-1]))
        worst = spare & (either <= beside)
        places = 1 + np.flatnonzero(worst)
        places = places[np.append(True, np.diff(places) > 1)]
        dropped += places.size
        moments = np.delete(moments, places)
    return moments, dropped


def _turned(moments: Array, count: Array, time: Array, unsure: float) -> Array:
    """Pulses passed at each time; between two rests the shaft turns on a curve of its own."""
    gaps = np.diff(moments)
    beside = np.maximum(np.append(gaps[1:], gaps[-2]), np.append(gaps[1], gaps[:-1]))
    rests = 1 + np.flatnonzero((gaps > _REST * beside) & (gaps > _REST * np.median(gaps)))
    turned = np.full(time.size, -np.inf)
    bounds = [0, *rests.tolist(), moments.size]
    for first, last in pairwise(bounds):
        part = slice(first, last)
        begin = 0.5 * (moments[first - 1] + moments[first]) if first else -np.inf
        end = 0.5 * (moments[last - 1] + moments[last]) if last < moments.size else np.inf
        here = (time >= begin) & (time < end)
        turned[here] = _on_curve(moments[part], count[part], time[here], unsure)
    return turned


def _on_curve(moments: Array, count: Array, time: Array, unsure: float) -> Array:
    """Pulses passed, by a spline through their moments that is as smooth as they need."""
    from scipy.interpolate import BSpline, make_interp_spline
    from scipy.sparse.linalg import spsolve

    if moments.size == 1:
        return np.full(time.size, count[0])
    spline = make_interp_spline(moments, count, k=min(3, moments.size - 1))
    best, pulses = np.inf, 2
    while pulses <= min(_COARSEST, moments.size // 4):
        knots = np.concatenate(
            (
                np.repeat(moments[0], 4),
                moments[pulses : -max(pulses // 2, 2) : pulses],
                np.repeat(moments[-1], 4),
            )
        )
        basis = BSpline.design_matrix(moments, knots, 3)
        fit = BSpline(knots, spsolve((basis.T @ basis).tocsc(), basis.T @ count), 3)
        left = 1.0 - (knots.size - 4) / moments.size
        residual = float(np.mean((fit(moments) - count) ** 2))
        score = residual / left**2
        known = _ENOUGH * float(np.mean((unsure * fit(moments, 1)) ** 2))
        if score < best or residual < known:
            best, spline = min(score, best), fit
        pulses *= 2
    return _beyond(spline, moments, time)


def _beyond(spline: Any, moments: Array, time: Array) -> Array:
    """Values of the spline, and constant acceleration outside until the shaft stands."""
    turned = np.asarray(spline(np.clip(time, moments[0], moments[-1])), dtype=float)
    for end, sign in ((moments[0], -1.0), (moments[-1], 1.0)):
        outside = time < end if sign < 0 else time > end
        away = np.abs(time[outside] - end)
        speed, gain = float(spline(end, 1)), sign * float(spline(end, 2))
        if gain < 0.0:
            away = np.minimum(away, speed / -gain)
        else:
            gain = 0.0
        turned[outside] += sign * (speed * away + 0.5 * gain * away**2)
    return turned
