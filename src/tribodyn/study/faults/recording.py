"""Recordings of a sensor: the motion over turn turns as a measuring system would store it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.checks import require_number, require_whole
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.faults import BearingImpacts
    from tribodyn.measurement import Recording
    from tribodyn.study.faults.turning import PeriodicMotion

#: Most samples of a recording.
_MOST = 2**26
#: Frequencies over the sampling rate between which the anti-alias filter falls from 1 to 0.
_PASSED, _STOPPED = 0.4, 0.5
#: Samples of the periodic signal for each period of its highest line.
_OVERSAMPLED = 16


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
    turned = _mesh_cycles(motion, time, scatter.speed_fluctuation, rng)
    channels: dict[str, Array] = {}
    units: dict[str, str] = {}
    for sensor in sensors:
        values, unit = motion.signal(sensor)
        key = sensor, sample_rate
        if key not in motion.splines:
            motion.splines[key] = _band_limited(motion, values, sample_rate)
        samples = motion.splines[key]((turned / motion.cycles) % 1.0)
        for number, defect in enumerate(defects):
            draw = scatter.seed * 1009 + number
            samples = samples + motion.impacts(sensor, defect, time, draw)
        channels[sensor] = samples + scatter.noise * rng.standard_normal(count)
        units[sensor] = unit
    cycles_of_turn = motion.mesh_frequency / motion.rotation_frequency(motion.tacho)
    ahead = _lead_at(motion, (turned / motion.cycles) % 1.0)
    channels["tacho"] = _tacho((turned + ahead) / cycles_of_turn, scatter.tacho_jitter, rng)
    units["tacho"] = "V"
    return Recording(channels, sample_rate, units)


def _mesh_cycles(
    motion: PeriodicMotion, time: Array, fluctuation: float, rng: np.random.Generator
) -> Array:
    """Mesh cycles at each time; the speed wanders slowly about its mean."""
    cycles = motion.mesh_frequency * time + motion.cycles * rng.random()
    if fluctuation == 0.0:
        return np.asarray(cycles)
    # A few slow waves with random phases, shorter than ten turns of the pinion.
    slow = motion.rotation_frequency(motion.tacho) * (rng.random(4) * 0.2 + 0.05)
    phases = 2.0 * np.pi * rng.random(4)
    size = fluctuation * np.sqrt(2.0 / slow.size)  # rms of the speed over its mean
    for frequency, phase in zip(slow, phases, strict=True):
        omega = 2.0 * np.pi * frequency
        cycles = cycles + motion.mesh_frequency * size / omega * (
            np.sin(omega * time + phase) - np.sin(phase)
        )
    return np.asarray(cycles)


def _lead_at(motion: PeriodicMotion, clock: Array) -> Array:
    """Mesh cycles by which the rotation is ahead of its mean."""
    if callable(motion.lead):
        return np.asarray(motion.lead(clock))
    count = len(motion.lead)
    return np.asarray(np.interp(clock, np.arange(count) / count, motion.lead, period=1.0))


def _band_limited(motion: PeriodicMotion, values: Array, sample_rate: float) -> Any:
    """A periodic signal as a function of the phase, without what half the rate cannot hold."""
    from scipy.interpolate import CubicSpline

    lines = np.fft.rfft(values)
    frequency = np.arange(lines.size) / motion.period
    passed = anti_alias(frequency / sample_rate)
    lines *= passed / np.sinc(np.arange(lines.size) / values.size)  # values are means
    highest = int(np.flatnonzero(passed > 0.0)[-1]) + 1
    points = max(_OVERSAMPLED * highest, 64)
    dense = np.fft.irfft(lines[:highest], points) * (points / values.size)
    return CubicSpline(np.arange(points + 1) / points, [*dense, dense[0]], bc_type="periodic")


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
