"""Recordings of a sensor: the motion over turn turns as a measuring system would store it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.signals.spectrum import sum_of_lines
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.faults import BearingImpacts
    from tribodyn.measurement import Recording
    from tribodyn.study.faults.turning import PeriodicMotion

#: Most samples of a recording.
_MOST = 2**26
#: Frequencies over the sampling rate between which the anti-alias filter falls from 1 to 0.
_PASSED, _STOPPED = 0.4, 0.5
#: Samples between those of a recording from which a wandering speed interpolates, those beyond its
#: ends, and samples that are computed at once; part of the strongest line that matters.
_OVERSAMPLED, _MARGIN, _TOGETHER, _LEAST = 8, 32, 2**18, 1e-13


class Scatter(NamedTuple):
    """What differs from one recording of a motion to the next."""

    noise: float  #: standard deviation, in the unit of the sensor
    speed_fluctuation: float  #: standard deviation of the speed over its mean
    tacho_jitter: float  #: standard deviation of the edges of the tacho over a turn
    seed: int


def recording_of(
    motion: PeriodicMotion,
    defects: Sequence[tuple[str, BearingImpacts]],
    sensor: str | Sequence[str],
    duration: float,
    sample_rate: float,
    scatter: Scatter,
) -> Recording:
    """Sample signals of a motion; arguments as those of ``Result.recording``."""
    from tribodyn.measurement import Recording

    sensors = [sensor] if isinstance(sensor, str) else list(sensor)
    require_number("duration", duration)
    require_positive("duration", duration, "s")
    require_positive("sample_rate", sample_rate, "Hz")
    limits = {"noise": 1e9, "speed_fluctuation": 0.1, "tacho_jitter": 0.1}
    for name, most in limits.items():
        require_between(name, getattr(scatter, name), 0.0, most, "")
    require_whole("seed", scatter.seed, 0)
    count = round(duration * sample_rate)
    if not 16 <= count <= _MOST:
        what = f"duration * sample_rate = {duration * sample_rate:.6g} samples"
        why = f"A recording has 16 to {_MOST} samples"
        raise InputError(what, "argument duration", why, "Change the duration or the rate")
    rng = np.random.default_rng(scatter.seed)
    time = np.arange(count) / sample_rate
    motion_time = _motion_time(motion, time, scatter.speed_fluctuation, rng)
    channels: dict[str, Array] = {}
    units: dict[str, str] = {}
    for sensor in sensors:
        key = sensor, sample_rate
        if key not in motion.splines:
            motion.splines[key] = _passed(motion, sensor, sample_rate)
        even = scatter.speed_fluctuation == 0.0
        samples = _sampled(motion.splines[key], sample_rate, motion_time, even=even)
        for number, defect in enumerate(defects):
            draw = scatter.seed * 1009 + number
            samples = samples + motion.impacts(sensor, defect, time, draw)
        channels[sensor] = samples + scatter.noise * rng.standard_normal(count)
        units[sensor] = motion.places.place(sensor).unit
    ahead = motion.lead_at(motion_time) / motion.mesh_frequency
    turns = (motion_time + ahead) * motion.rotation_frequency(motion.tacho)
    channels["tacho"] = _tacho(turns, scatter.tacho_jitter, rng)
    units["tacho"] = "V"
    return Recording(channels, sample_rate, units)


def _motion_time(
    motion: PeriodicMotion, time: Array, fluctuation: float, rng: np.random.Generator
) -> Array:
    """Times of the motion that are reached at each time; the speed wanders slowly [s]."""
    motion_time = time + motion.period * rng.random()
    if fluctuation == 0.0:
        return np.asarray(motion_time)
    # A few slow waves with random phases, shorter than ten turns of the pinion.
    slow = motion.rotation_frequency(motion.tacho) * (rng.random(4) * 0.2 + 0.05)
    phases = 2.0 * np.pi * rng.random(4)
    size = fluctuation * np.sqrt(2.0 / slow.size)  # rms of the speed over its mean
    for frequency, phase in zip(slow, phases, strict=True):
        omega = 2.0 * np.pi * frequency
        motion_time = motion_time + size / omega * (np.sin(omega * time + phase) - np.sin(phase))
    return np.asarray(motion_time)


def _passed(motion: PeriodicMotion, sensor: str, rate: float) -> tuple[Array, ComplexArray]:
    """Lines of a signal that half the rate can hold."""
    frequency, lines = motion.harmonics(sensor)
    lines = lines * anti_alias(frequency / rate)
    significant = np.abs(lines) > _LEAST * np.abs(lines).max(initial=0.0)
    return frequency[significant], lines[significant]


def _sampled(lines: tuple[Array, ComplexArray], rate: float, time: Array, *, even: bool) -> Array:
    """Sum of lines at rising times, evenly spaced or nearly so."""
    from scipy.interpolate import CubicSpline

    parts = []
    for begin in range(0, time.size, _TOGETHER):
        at = time[begin : begin + _TOGETHER]
        if even:
            parts.append(sum_of_lines(*lines, float(at[0]), 1.0 / rate, at.size))
            continue
        step = 1.0 / (_OVERSAMPLED * rate)
        start = float(at[0]) - _MARGIN * step
        count = math.ceil((float(at[-1]) - start) / step) + _MARGIN
        values = sum_of_lines(*lines, start, step, count)
        parts.append(CubicSpline(start + step * np.arange(count), values)(at))
    return np.concatenate(parts)


def anti_alias(frequency: Array) -> Array:
    """Gain of the anti-alias filter over the frequency, in sampling rates."""
    fall = (frequency - _PASSED) / (_STOPPED - _PASSED)
    return np.asarray(0.5 * (1.0 + np.cos(np.pi * np.clip(fall, 0.0, 1.0))))


def _tacho(turns: Array, jitter: float, rng: np.random.Generator) -> Array:
    """A pulse of 5 V a turn, a tenth of the turn long; its edges scatter by a part of the turn."""
    turn = np.floor(turns).astype(int)
    first = int(turn[0])
    edges = jitter * rng.standard_normal(int(turn[-1]) - first + 2)
    late = edges[turn - first]
    place = turns - turn
    return np.asarray(np.where((place >= late) & (place < 0.1 + late), 5.0, 0.0))
