"""Synthetic run-up with prescribed orders, to test an analysis before using it on a rig."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError, real_numbers, require_between, require_positive
from tribodyn.measurement.recording import Recording
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array


def synthetic_run_up(
    orders: Mapping[float, float],
    speed: object = (0.0, 314.159265, 0.0),
    *,
    duration: float = 20.0,
    sample_rate: float = 25600.0,
    pulses_per_revolution: int = 60,
    jitter: float = 0.0,
    noise: float = 0.0,
    mains: float = 0.0,
    missing: int = 0,
    double: int = 0,
    seed: int = 0,
    unit: str = "m/s^2",
) -> Recording:
    """Create the recording of a run-up with prescribed orders.

    Parameters
    ----------
    orders : mapping of float to float
        Peak amplitude of each order, in the unit of the signal.
    speed : (m,) array
        Speeds of the shaft at even times [rad/s], joined by straight lines.
    duration : float
        Length of the recording [s].
    sample_rate : float
        Samples per second [Hz].
    pulses_per_revolution : int
        Pulses of the tachometer in a revolution.
    jitter : float
        Standard deviation of the moment of a pulse over the time between two [-].
    noise : float
        Standard deviation of white noise in the signal, in its unit.
    mains : float
        Peak amplitude of a line at 50 Hz, in the unit of the signal.
    missing, double : int
        Number of pulses that the tachometer misses, and that it repeats.
    seed : int
        Seed of the random numbers.
    unit : str
        Unit of the signal.

    Returns
    -------
    Recording
        Channels ``signal`` and ``tacho`` [V], and ``angle`` [rad], the true angle of the shaft.

    Raises
    ------
    InputError
        If an argument is out of its range, or an order passes half the sampling rate.

    Examples
    --------
    >>> synthetic_run_up({29: 2.0}, duration=2.0)
    Recording(signal [m/s^2], tacho [V], angle [rad], 51200 samples at 25600 Hz, 2 s)
    """
    speeds = np.atleast_1d(real_numbers(Argument("speed"), speed))
    require_between("speed", speeds, 0.0, 1e5, "rad/s")
    for name, value in (("duration", duration), ("sample_rate", sample_rate)):
        require_positive(name, value)
    for name, value in (("jitter", jitter), ("noise", noise), ("mains", mains)):
        require_between(name, value, 0.0, 1e9)
    per = require_whole("pulses_per_revolution", pulses_per_revolution)
    lost, twice = require_whole("missing", missing, 0), require_whole("double", double, 0)
    size = require_whole("duration times sample_rate", round(duration * sample_rate), 100)
    time = np.arange(size) / sample_rate
    angle = _angle(speeds, duration, time)
    top = max(map(float, orders), default=0.0) * float(speeds.max()) / (2.0 * np.pi)
    if not top < 0.5 * sample_rate:
        what = f"the highest order reaches {top:.6g} Hz"
        why = f"Only frequencies below half of {sample_rate:g} Hz can be recorded"
        raise InputError(what, Argument("orders"), why, "Sample faster, or omit it")
    random = np.random.default_rng(require_whole("seed", seed, 0))
    signal = mains * np.cos(2.0 * np.pi * 50.0 * time) + noise * random.standard_normal(size)
    for order, amplitude in orders.items():
        signal += float(amplitude) * np.cos(float(order) * angle)
    pulses = _pulses(angle, time, per, jitter, lost, twice, random)
    channels = {"signal": signal, "tacho": pulses, "angle": angle}
    return Recording(channels, sample_rate, {"signal": unit, "tacho": "V", "angle": "rad"})


def _angle(speeds: Array, duration: float, time: Array) -> Array:
    """Exact angle for speeds on straight lines."""
    if speeds.size == 1:
        return np.asarray(speeds[0] * time)
    knots = np.linspace(0.0, duration, speeds.size)
    slopes = np.diff(speeds) / np.diff(knots)
    start_angles = np.concatenate(
        ([0.0], np.cumsum(0.5 * (speeds[1:] + speeds[:-1]) * np.diff(knots)))
    )
    piece = np.clip(np.searchsorted(knots, time, side="right") - 1, 0, slopes.size - 1)
    past = time - knots[piece]
    return np.asarray(start_angles[piece] + speeds[piece] * past + 0.5 * slopes[piece] * past**2)


def _pulses(
    angle: Array, time: Array, per: int, jitter: float, missing: int, double: int, random: Any
) -> Array:
    """Pulses of 5 V with a width of 0.4 of their spacing; a double one is two of half the width."""
    pitch = 2.0 * np.pi / per
    passed = angle / pitch
    moments = np.interp(np.arange(1, int(passed[-1]) + 1), passed, time)
    if moments.size < 8 + 4 * (missing + double):
        what = f"the shaft gives {moments.size} pulses"
        why = "At least eight are needed, and four more for each that is missing or double"
        remedy = "Turn longer or faster, or take more pulses per revolution"
        raise InputError(what, Argument("duration"), why, remedy)
    intervals = np.diff(moments)
    gaps = np.minimum(np.append(intervals, intervals[-1]), np.append(intervals[0], intervals))
    moments = moments + jitter * gaps * random.standard_normal(moments.size)
    keep = np.ones(moments.size, dtype=bool)
    keep[random.choice(np.arange(3, moments.size - 3, 3), missing, replace=False)] = False
    moments, gaps = moments[keep], gaps[keep]
    if not 0.2 * gaps.min() > time[1]:
        what = f"pulses follow each other within {gaps.min() / time[1]:.3g} samples"
        why = "Each pulse needs at least five"
        remedy = "Sample faster, or take fewer pulses per revolution"
        raise InputError(what, Argument("pulses_per_revolution"), why, remedy)
    repeated = random.choice(np.arange(3, moments.size - 3, 3), double, replace=False)
    starts = np.concatenate((moments, moments[repeated] + 0.4 * gaps[repeated]))
    width = 0.4 * gaps
    width[repeated] *= 0.5
    ends = starts + np.concatenate((width, width[repeated]))
    change = np.zeros(time.size + 1)
    np.add.at(change, np.searchsorted(time, starts), 5.0)
    np.add.at(change, np.searchsorted(time, ends), -5.0)
    return np.asarray(np.cumsum(change)[:-1])
