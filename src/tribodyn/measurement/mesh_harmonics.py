"""Mesh harmonics of recorded channels: where the angle of the mesh comes from, and what is in them.

The angle comes from a tachometer, from a channel that holds the angle of a shaft, or from the mesh
lines of the recording. Amplitudes are those of the spectrum over this angle, with the noise between
the harmonics and the power adjacent to them, which shows whether a line is smeared.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from tribodyn.errors import Argument, InputError, warn
from tribodyn.measurement.mesh_speed import MeshSpeed, mesh_speed
from tribodyn.measurement.orders import order_spectrum
from tribodyn.measurement.recording import Recording
from tribodyn.measurement.tacho import angle_of_channel
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array, Mask

#: Least mesh cycles, amplitude over noise of a line, and share of the mean square in harmonics.
_CYCLES, _CLEAR, _SHARE = 20.0, 3.0, 0.5
#: Standard deviation over the amplitude from which it is unsure by 5 %, which is twice that.
_UNSURE = 0.025
#: Share of the power next to a line from which its amplitude is more than 5 % too low: up to the
#: first sideband of the slowest shaft, and over a wider band, to which sidebands contribute.
_SMEARED, _SPREAD = 0.1, 0.25
#: Distance up to which power next to a harmonic is counted, over the mesh frequency.
_FAR = 0.12
#: Noise bandwidth of the window "flattop" in lines of the spectrum, which are half a bin apart.
_LINES = 2.0 * 3.8112


@dataclass(frozen=True)
class MeshHarmonics:
    """Mesh harmonics of one channel."""

    amplitude: Array  #: peak amplitudes
    noise: Array  #: rms amplitude of the noise at each harmonic
    smearing: Array  #: share of the power next to each line, up to the first sideband
    spreading: Array  #: the same over a wider band
    share: float  #: of the alternating mean square that is in these harmonics
    spectrum: tuple[Array, Array]  #: orders of the mesh and amplitudes

    @property
    def clear(self) -> Mask:
        """Whether each harmonic exceeds the noise."""
        return np.asarray(self.amplitude > _CLEAR * self.noise)


def speed_by_tacho(
    recording: Recording, tacho: str, pulses: int, teeth: int, frequency: float
) -> MeshSpeed:
    """Mesh frequency and mesh angle of a recording by a channel with pulses or the speed."""
    angle, jitter, source, _ = angle_of_channel(recording, tacho, pulses)
    method = f"{source}, of the gear of {teeth} teeth"
    return _of_shaft(recording, angle, jitter, teeth, frequency, method)


def speed_by_angle(recording: Recording, angle: str, teeth: int, frequency: float) -> MeshSpeed:
    """Mesh frequency and mesh angle of a recording by a channel with the angle of a shaft."""
    method = f'angle "{angle}" of the gear of {teeth} teeth'
    return _of_shaft(recording, recording[angle], 0.0, teeth, frequency, method)


def speed_by_lines(
    recording: Recording,
    channels: Iterable[str],
    frequency: float,
    count: int,
    tolerance: float,
    teeth: Sequence[int],
) -> MeshSpeed:
    """Mesh frequency and mesh angle of a recording by its mesh lines; warn where they fail."""
    rows = np.stack([recording[name] for name in channels])
    speed = mesh_speed(
        rows,
        recording.sample_rate,
        frequency,
        harmonics=max(count, 3),
        tolerance=max(tolerance, 1e-6),
        teeth=teeth,
    )
    if not speed.located:
        warn(
            "speed-not-found",
            f"The speed of the recording is unknown: {speed.method}. Its mesh harmonics are not "
            "compared. Record a tachometer, set the mesh frequency of the rig, or check the "
            "channels.",
            stacklevel=4,
        )
    elif speed.rivals:
        rivals = ", ".join(f"{ratio:.4f}" for ratio in speed.rivals)
        warn(
            "speed-ambiguous",
            f"The mesh frequency is taken as {speed.ratio:.4f} times the computed one, but lines "
            f"about as strong fit {rivals} times. Record a tachometer, or give the mesh frequency "
            "of the rig and a smaller tolerance.",
            stacklevel=4,
        )
    return speed


def _of_shaft(
    recording: Recording, angle: Array, jitter: float, teeth: int, frequency: float, method: str
) -> MeshSpeed:
    """Mesh speed from the angle of a shaft with a given rms jitter [rad]."""
    tooth_count = require_whole("teeth", teeth, why="the teeth of the gear on that shaft,")
    mesh = tooth_count * np.asarray(angle, dtype=float)
    seconds = (mesh.size - 1) / recording.sample_rate
    cycles = float(mesh[-1] - mesh[0]) / (2.0 * np.pi)
    if cycles <= 0.0:
        what = f"the {method} does not rise"
        why = "The angle must increase in the direction of rotation"
        raise InputError(what, Argument("angle"), why, "Negate it")
    step = min(max(round(tooth_count * mesh.size / cycles), 1), mesh.size - 1)  # one revolution
    unit = 2.0 * np.pi * frequency / recording.sample_rate
    ratio = np.diff(mesh[::step]) / (step * unit)
    return MeshSpeed(
        cycles / (seconds * frequency),
        np.sqrt(2.0) * tooth_count * jitter / (2.0 * np.pi * seconds * frequency),
        float(ratio.min()),
        float(ratio.max()),
        cycles / seconds,
        mesh,
        method=method,
    )


def harmonics_of(
    values: Array, speed: MeshSpeed, count: int, teeth: Sequence[int] = ()
) -> MeshHarmonics:
    """Mesh harmonics of a channel over the angle of the mesh."""
    cycles = float(speed.angle[-1] - speed.angle[0]) / (2.0 * np.pi)
    if cycles < _CYCLES:
        what = f"the record lasts {cycles:.3g} mesh cycles"
        why = f"Separating mesh harmonics from adjacent lines takes at least {_CYCLES:g} cycles"
        raise InputError(what, Argument("measured"), why, "Record longer")
    limit = np.pi / float(np.diff(speed.angle).max())
    if limit < count:
        what = f"mesh harmonic {count} is beyond the record"
        why = f"At the highest speed the sampling resolves harmonics up to {limit:.3g}"
        raise InputError(
            what, Argument("harmonics"), why, "Request fewer harmonics, or sample faster"
        )
    mesh_orders = order_spectrum(values, speed.angle, min(count + 0.5, limit * (1.0 - 1e-9)))
    power, spacing = mesh_orders.amplitudes**2, float(mesh_orders.orders[1])
    lines = np.minimum(np.rint(np.arange(1, count + 1) / spacing).astype(int), power.size - 1)
    square = float(np.var(values))
    half = round(0.5 / spacing)
    floor = [np.median(power[line - half : line + half]) / np.log(2.0) for line in lines]
    noise = np.maximum(np.array(floor), 1e-18 * square)
    gap = 0.4 / max(teeth, default=64)  # up to the first sideband of the slowest shaft
    smearing, spreading = (
        np.array(
            [
                _next_to(power, line, level, round(width / spacing))
                for line, level in zip(lines, noise, strict=True)
            ]
        )
        for width in (gap, _FAR)
    )
    amplitude = mesh_orders.amplitudes[lines]
    share = 0.5 * float(np.sum(amplitude**2)) / square if square > 0.0 else 0.0
    spectrum = (mesh_orders.orders, mesh_orders.amplitudes)
    return MeshHarmonics(amplitude, np.sqrt(noise), smearing, spreading, share, spectrum)


def _next_to(power: Array, line: int, noise: float, width: int) -> float:
    """Share of the power next to a line in the band; 0 if the resolution cannot separate it."""
    if width < 2.0 * _LINES:
        return 0.0
    band = power[max(line - width, 0) : line + width + 1]
    total = (float(band.sum()) - noise * band.size) / _LINES
    spread = total - float(power[line])
    # Noise in the band varies by its own size over the root of the number of lines.
    unsure = 4.0 * noise * np.sqrt(band.size * _LINES) / _LINES
    return max(spread - unsure, 0.0) / total if total > 0.0 else 0.0


def warn_of_speed(speed: MeshSpeed, frequency: float, tolerance: float) -> None:
    """Warn if the speed of the recording differs from that of the computed response."""
    if abs(speed.ratio - 1.0) > tolerance:
        warn(
            "speed-off",
            f"The mesh frequency of the recording is {speed.mesh_frequency:.6g} Hz by the "
            f"{speed.method}, {speed.ratio:.4g} times the computed {frequency:.6g} Hz. Check the "
            "number of pulses and the gear of the tachometer, or compute at the speed of the rig.",
            stacklevel=4,
        )


def warn_of_harmonics(name: str, harmonics: MeshHarmonics) -> None:
    """Warn of noise, smeared lines, and power outside the harmonics of a channel."""
    amplitude, clear = harmonics.amplitude, harmonics.clear
    with np.errstate(divide="ignore"):
        unsure = harmonics.noise / np.sqrt(2.0) / amplitude
    noisy = np.flatnonzero(~clear | (unsure > _UNSURE))
    smeared = clear & ((harmonics.smearing > _SMEARED) | (harmonics.spreading > _SPREAD))
    if noisy.size:
        worst = float(unsure[noisy].max())
        lost = np.flatnonzero(~clear) + 1
        buried = f"; {_numbers(lost)} not above it at all" if lost.size else ""
        text = f"within {200.0 * worst:.2g} % only" if not lost.size else "unsure by more than 5 %"
        warn(
            "harmonics-in-noise",
            f"Noise makes mesh harmonics {_numbers(noisy + 1)} of channel {name} {text}"
            f"{buried}. Record longer, or compare fewer harmonics.",
            stacklevel=4,
        )
    if smeared.any():
        part = float(np.maximum(harmonics.smearing, harmonics.spreading)[smeared].max())
        warn(
            "harmonics-smeared",
            f"Up to {100.0 * part:.2g} % of the power of mesh harmonics "
            f"{_numbers(np.flatnonzero(smeared) + 1)} of channel {name} lies next to the line: "
            "the speed changes faster than it is followed, or the level changes. Their amplitudes "
            "are too low; record a tachometer with more pulses, or a steadier part.",
            stacklevel=4,
        )
    if harmonics.share < _SHARE:
        warn(
            "signal-outside-harmonics",
            f"Mesh harmonics 1 to {amplitude.size} hold {100.0 * harmonics.share:.2g} % of the "
            f"alternating mean square of channel {name}: the rest is noise, sidebands, other "
            "sources or higher harmonics. Check its spectrum before relying on gain and errors.",
            stacklevel=4,
        )


def _numbers(values: Iterable[int]) -> str:
    return ", ".join(str(value) for value in values)
