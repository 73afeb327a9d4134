"""Shaft angle from the pulses of a tachometer."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    require_one_of,
    require_positive,
    warn,
)
from tribodyn.measurement.recording import Recording, in_si
from tribodyn.nomenclature import require_whole
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.types import Array

#: Hysteresis over the distance of the two signal levels.
_HYSTERESIS = 0.25
#: Maximum number of consecutive missing pulses; a longer pause is slow running or standstill.
_MAX_MISSING = 3
#: Gaps on either side from which the expected length of a gap is computed.
_NEIGHBOURS = 4
#: Rise of a steep edge within one sample over the height of the signal.
_STEEP = 0.8
#: Squared residual over the variance of the edges up to which a smoother spline is accepted.
_SMOOTH_ENOUGH = 1.05
#: Factor on the longest gap that acceleration explains; from rest the first gap is 1.33 times it.
_WIDER = 1.5
#: Ratio to the adjacent gaps from which a gap is a rest, at which the angle is split.
_REST = 8.0
#: Speed below zero over the highest up to which a shaft counts as at rest.
_BACKWARDS = 0.01
#: Maximum number of pulses per piece of the smoothing spline.
_MAX_PER_PIECE = 4096


def shaft_angle(
    tacho: object,
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
        Edge of the pulse that is counted.
    threshold : float, optional
        Level of the edge, in the unit of the signal; midway between its two levels by default.

    Returns
    -------
    (n,) array
        Angle from the first pulse [rad], non-decreasing.

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
    The time of an edge is interpolated between two samples; the next edge is counted only after
    the signal has passed a quarter of its height beyond the threshold on the other side
    (hysteresis). A pulse is double if the two gaps around it add up to one expected gap. Pulses are
    missing if a gap is two to four times the length expected from the gaps on either side. The
    angle over time is a least-squares cubic spline. Generalized cross validation selects the number
    of pulses per piece, which smooths the jitter of single pulses but not the speed. For steep
    edges the pieces are the longest whose residual stays within the sampling step, because this
    rounding error repeats at a steady speed. Before the first pulse, after the last one and around
    a rest, the angle is extrapolated with constant acceleration until standstill.
    G. Wahba, Spline Models for Observational Data, SIAM 1990, equation (4.3.1).

    Examples
    --------
    >>> time = np.arange(20000) / 10000.0
    >>> angle = 2 * np.pi * (10.0 * time + 5.0 * time**2)
    >>> estimate = shaft_angle(np.sin(60 * angle), 10000.0, 60)
    >>> bool(np.abs(estimate - estimate[0] - angle)[100:-100].max() < 1e-4)
    True
    """
    return angle_and_jitter(tacho, sample_rate, pulses_per_revolution, edge, threshold)[0]


def angle_and_jitter(
    tacho: object,
    sample_rate: float,
    pulses_per_revolution: int,
    edge: Literal["rising", "falling"] = "rising",
    threshold: float | None = None,
) -> tuple[Array, float]:
    """Compute the shaft angle at every sample and the rms deviation of the pulses from it [rad]."""
    values = checked_signal(tacho, 16, "tacho")
    require_positive("sample_rate", sample_rate, "Hz")
    pitch = 2.0 * np.pi / require_whole("pulses_per_revolution", pulses_per_revolution)
    require_one_of("edge", edge, ("rising", "falling"))
    moments, unsure = find_edges(values if edge == "rising" else -values, threshold, edge)
    count, moments = number_pulses(moments / sample_rate)
    time = np.arange(values.size) / sample_rate
    pulse_count = _pulses_passed(moments, count, time, unsure / sample_rate)
    jitter = pitch * float(np.std(np.interp(moments, time, pulse_count) - count))
    return np.asarray(np.maximum.accumulate(pitch * pulse_count)), jitter


def angle_of_channel(recording: Recording, name: str, pulses: int) -> tuple[Array, float, str, str]:
    """Angle of a shaft, rms jitter [rad], source and zero, of pulses or a speed in rpm or rad/s."""
    # A channel without a unit holds a speed where its name ends with one, such as "speed_rpm".
    values, rate = recording[name], recording.sample_rate
    unit = recording.units[name] or re.split(r"[\s_]", name)[-1]
    speed, si = in_si(values, unit)
    if si != "rad/s":
        per = "1 pulse" if pulses == 1 else f"{pulses} pulses"
        angle, jitter = angle_and_jitter(values, rate, pulses)
        source = f"tachometer {name}, {per} per revolution"
        return angle, jitter, source, "the first pulse of the tachometer"
    if pulses != 1:
        what, why = f"pulses_per_revolution = {pulses}", f"Channel {name} holds the speed in {unit}"
        remedy = "Leave it out, or correct the unit of the channel"
        raise InputError(what, Argument("pulses_per_revolution"), why, remedy)
    speed = np.sign(speed.mean()) * speed
    top = float(speed.max())
    if not top > 0.0 or speed.min() < -_BACKWARDS * top:
        ends = f"{values.min():.4g} to {values.max():.4g} {unit}"
        what = f"the speed of channel {name} goes from {ends}"
        why, remedy = "The shaft must turn, and in one direction", "Check the channel, or cut it"
        raise InputError(what, Argument("tacho"), why, remedy)
    steps = np.maximum(0.5 * (speed[1:] + speed[:-1]), 0.0) / rate
    angle = np.concatenate(([0.0], np.cumsum(steps)))
    return angle, 0.0, f"speed of channel {name}", "the first sample"


def find_edges(values: Array, threshold: float | None, edge: str = "rising") -> tuple[Array, float]:
    """Find the upward threshold crossings and their standard uncertainty [samples].

    The uncertainty is that of a uniform distribution within one sample for steep edges, else zero.
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
    decided_samples = np.flatnonzero(decided)
    crossings = decided_samples[1:][
        (decided[decided_samples[1:]] > 0) & (decided[decided_samples[:-1]] < 0)
    ]
    rises = np.flatnonzero(~above[:-1] & above[1:])
    # The last rise through the threshold before the signal is surely high is the edge.
    last = rises[np.searchsorted(rises, crossings, side="left") - 1] if rises.size else rises
    if last.size < 4:
        raise ComputationError(
            f"{last.size} pulses found",
            Argument("tacho"),
            f"At least four are needed; searched edges through {level:.4g}, with levels "
            f"{_HYSTERESIS * height:.4g} below and above",
            "Set the threshold, select the other edge, or record longer",
        )
    low, high = values[last], values[last + 1]
    steep = np.median(high - low) > _STEEP * height
    return np.asarray(last + (level - low) / (high - low)), 1.0 / np.sqrt(12.0) if steep else 0.0


def _levels(values: Array) -> tuple[float, float]:
    """Mean and distance of the low and high levels of a pulse signal."""
    level = 0.5 * float(values.min() + values.max())
    for _ in range(20):
        above = values > level
        if above.all() or not above.any():
            what = "the signal is constant"
            remedy = "Check the channel and the connection of the tachometer"
            raise InputError(what, Argument("tacho"), "It contains no pulses", remedy)
        low, high = float(values[~above].mean()), float(values[above].mean())
        if abs(0.5 * (low + high) - level) < 1e-6 * (high - low):
            break
        level = 0.5 * (low + high)
    return 0.5 * (low + high), high - low


def number_pulses(moments: Array) -> tuple[Array, Array]:
    """Number the pulses: drop double ones and count missing ones; return numbers and times."""
    moments, double = _drop_double_pulses(moments)
    gaps = np.diff(moments)
    expected = _expected_gaps(gaps)
    steps = np.rint(gaps / expected)
    even = np.abs(gaps / expected - steps) < 0.25 * steps
    missing = (
        (steps > 1) & (steps <= 1 + _MAX_MISSING) & even & (gaps > _WIDER * _longest_gaps(gaps))
    )
    number = np.concatenate(([0.0], np.cumsum(np.where(missing, steps, 1.0))))
    lost = int(np.sum(steps[missing] - 1.0))
    if double or lost:
        repairs = [f"{n} {kind}" for n, kind in ((lost, "missing"), (double, "double")) if n]
        warn(
            "tacho-repaired",
            f"Of {moments.size + double} pulses {' and '.join(repairs)}: the angle is "
            "corrected for them. If they are many, check the tachometer or sample it faster.",
            stacklevel=4,
        )
    return number, moments


def _expected_gaps(gaps: Array) -> Array:
    """Length of each gap that is expected from the gaps on both sides at smoothly varying speed."""
    wide = np.pad(gaps, _NEIGHBOURS, mode="edge")
    around = np.lib.stride_tricks.sliding_window_view(wide, 2 * _NEIGHBOURS + 1)
    before, after = around[:, :_NEIGHBOURS], around[:, _NEIGHBOURS + 1 :]
    return np.asarray(np.sqrt(np.median(before, axis=1) * np.median(after, axis=1)))


def _longest_gaps(gaps: Array) -> Array:
    """Longest gap that the gaps on either side explain, such as those of a shaft coming to rest.

    The squared speed is extrapolated linearly over the angle, as under constant acceleration;
    slope and level are medians, so that a single wrong gap has no effect.
    """
    wide = np.pad(1.0 / gaps**2, _NEIGHBOURS, mode="reflect")
    around = np.lib.stride_tricks.sliding_window_view(wide, 2 * _NEIGHBOURS + 1)
    longest = np.zeros_like(gaps)
    distance = np.arange(1.0, _NEIGHBOURS + 1)
    first, second = np.triu_indices(_NEIGHBOURS, 1)
    for side in (around[:, :_NEIGHBOURS][:, ::-1], around[:, _NEIGHBOURS + 1 :]):
        slopes = (side[:, second] - side[:, first]) / (distance[second] - distance[first])
        slope = np.median(slopes, axis=1, keepdims=True)
        square = np.median(side - slope * distance, axis=1)
        longest = np.maximum(longest, 1.0 / np.sqrt(np.maximum(square, 1e-4 * side[:, 0])))
    return longest


def _drop_double_pulses(moments: Array) -> tuple[Array, int]:
    """Drop pulses that split an expected gap; the shorter of the two parts identifies the pulse."""
    dropped = 0
    while moments.size > 4:
        gaps = np.diff(moments)
        expected = _expected_gaps(gaps)
        pair = gaps[:-1] + gaps[1:]
        shorter_gap = np.minimum(gaps[:-1], gaps[1:])
        expected_pair = np.sqrt(expected[:-1] * expected[1:])
        spare = (shorter_gap < 0.5 * expected_pair) & (pair < 1.35 * expected_pair)
        if not spare.any():
            break
        # Of adjacent candidates, only the one with the shorter gap is dropped.
        shortest = np.where(spare, shorter_gap, np.inf)
        shorter_neighbour = np.minimum(
            np.append(shortest[1:], np.inf), np.append(np.inf, shortest[:-1])
        )
        worst = spare & (shorter_gap <= shorter_neighbour)
        indices = 1 + np.flatnonzero(worst)
        indices = indices[np.append(True, np.diff(indices) > 1)]
        dropped += indices.size
        moments = np.delete(moments, indices)
    return moments, dropped


def _pulses_passed(moments: Array, count: Array, time: Array, unsure: float) -> Array:
    """Number of pulses passed at each time, with a separate spline between any two rests."""
    gaps = np.diff(moments)
    adjacent_gap = np.maximum(np.append(gaps[1:], gaps[-2]), np.append(gaps[1], gaps[:-1]))
    rests = 1 + np.flatnonzero((gaps > _REST * adjacent_gap) & (gaps > _REST * np.median(gaps)))
    turned = np.full(time.size, -np.inf)
    bounds = [0, *rests.tolist(), moments.size]
    for first, last in pairwise(bounds):
        part = slice(first, last)
        begin = 0.5 * (moments[first - 1] + moments[first]) if first else -np.inf
        end = 0.5 * (moments[last - 1] + moments[last]) if last < moments.size else np.inf
        in_part = (time >= begin) & (time < end)
        turned[in_part] = _smoothed_count(moments[part], count[part], time[in_part], unsure)
    return turned


def _smoothed_count(moments: Array, count: Array, time: Array, unsure: float) -> Array:
    """Number of pulses passed at each time, by a smoothing spline through the pulse times."""
    from scipy.interpolate import make_interp_spline, make_lsq_spline

    if moments.size == 1:
        return np.full(time.size, count[0])
    spline = make_interp_spline(moments, count, k=min(3, moments.size - 1))
    best, pulses = np.inf, 2
    while pulses <= min(_MAX_PER_PIECE, moments.size // 4):
        knots = np.concatenate(
            (
                np.repeat(moments[0], 4),
                moments[pulses : -max(pulses // 2, 2) : pulses],
                np.repeat(moments[-1], 4),
            )
        )
        fit = make_lsq_spline(moments, count, knots)
        freedom = 1.0 - (knots.size - 4) / moments.size
        residual = float(np.mean((fit(moments) - count) ** 2))
        score = residual / freedom**2
        accepted_residual = _SMOOTH_ENOUGH * float(np.mean((unsure * fit(moments, 1)) ** 2))
        if score < best or residual < accepted_residual:
            best, spline = min(score, best), fit
        pulses *= 2
    return _extrapolated_count(spline, moments, time)


def _extrapolated_count(spline: Any, moments: Array, time: Array) -> Array:
    """Evaluate the spline; extrapolate it with constant acceleration until standstill."""
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
