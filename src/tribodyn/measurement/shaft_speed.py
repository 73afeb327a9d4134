"""Angle and speed of the shaft of a recording: by a tachometer, by mesh lines, or as stated."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.measurement.mesh_speed import mesh_speed
from tribodyn.measurement.recording import Recording
from tribodyn.measurement.tacho import angle_of_channel
from tribodyn.types import Array

#: Change of the speed over its mean from which it counts as changing.
_VARIES = 0.03
#: Mesh frequency of a recording in samples instead of seconds [Hz].
_USUAL = 500.0


@dataclass(frozen=True)
class ShaftSpeed:
    """Angle of the shaft at every sample and its source.

    Parameters
    ----------
    angle : (n,) array
        Angle, counted from ``zero`` [rad].
    source : str
        Where it comes from: a tachometer, the mesh lines of the recording, or a stated speed.
    mean, lowest, highest : float
        Speed over the whole record, and the range of its means over a revolution [rad/s].
    uncertainty : float
        Standard uncertainty of the mean speed [rad/s]; NaN where it is not known.
    steady : bool
        Whether the speed was stated, not measured: orders are right only if it was exactly that.
    zero : str
        Where the angle is zero: the first pulse of the tachometer, or the first sample.
    """

    angle: Array = field(repr=False)
    source: str
    mean: float
    lowest: float
    highest: float
    uncertainty: float = float("nan")
    steady: bool = False
    zero: str = "the first sample"

    @property
    def varies(self) -> bool:
        """Whether the speed changes by more than a few percent."""
        return self.highest - self.lowest > _VARIES * self.mean


def shaft_speed(
    recording: Recording,
    values: Array,
    source: tuple[str | None, int, float | None],
    teeth: tuple[int, ...],
    notes: list[Problem],
) -> ShaftSpeed | None:
    """Shaft angle from the best available source; None, with a note, if there is none."""
    tacho, pulses, speed = source
    rate = recording.sample_rate
    if tacho is not None:
        angle, _, method, zero = angle_of_channel(recording, tacho, pulses)
        return replace(_with_range(angle, rate, method), zero=zero)
    if speed is None:
        notes.append(
            Problem(
                "no orders, no mean revolution, no gear indicators",
                "",
                "The speed of the shaft is not known",
                "Name a tachometer channel and its pulses per revolution (--tacho NAME --pulses "
                'N), give the speed (--speed "1500 rpm"), or name a line, such as the mesh '
                '(--line "725 Hz")',
            )
        )
        return None
    require_positive("speed", speed, "rad/s")
    reason = "the teeth are not known, by whose mesh lines it could be measured"
    if teeth:
        shaft, reason = _from_mesh_lines(values, rate, speed, teeth, notes)
        if shaft is not None:
            return shaft
    notes.append(
        Problem(
            f"the speed is taken as exactly {speed * 30.0 / np.pi:.6g} rpm",
            "",
            f"{reason[:1].upper()}{reason[1:]}. Orders and mean revolutions of a shaft that turns "
            "a little faster or slower come out low",
            "Record a tachometer" if teeth else "Give the teeth (--teeth 29), or a tachometer",
        )
    )
    angle = np.asarray(speed / rate * np.arange(values.size), dtype=np.float64)
    return ShaftSpeed(angle, "stated, not measured", speed, speed, speed, steady=True)


def _from_mesh_lines(
    values: Array, rate: float, speed: float, teeth: tuple[int, ...], notes: list[Problem]
) -> tuple[ShaftSpeed | None, str]:
    """Speed by the mesh lines of the channel, or the reason why they do not show it."""
    frequency = teeth[0] * speed / (2.0 * np.pi)
    # How fast a speed may change is known in seconds: without a rate, assume a mesh frequency.
    seconds = frequency / _USUAL if rate == 1.0 else 1.0
    try:
        mesh = mesh_speed(values, rate / seconds, frequency / seconds, teeth=teeth)
    except InputError as error:
        return None, f"{error.problems[0].what}, too little to find mesh lines in"
    if not mesh.located:
        return None, mesh.method
    if mesh.rivals:
        others = " or ".join(f"{each * speed * 30.0 / np.pi:.5g}" for each in mesh.rivals)
        what = f"the shaft may turn at {others} rpm as well"
        why = "Lines as strong as those of the mesh stand there"
        notes.append(Problem(what, "", why, "Record a tachometer, or check the stated speed"))
    method = mesh.method if rate != 1.0 else mesh.method.partition(" in blocks")[0]
    shaft = _with_range(mesh.angle / teeth[0], rate, method)
    return replace(shaft, uncertainty=mesh.uncertainty * speed), ""


def _with_range(angle: Array, rate: float, source: str) -> ShaftSpeed:
    """Mean speed of the shaft, and the range of its means over a revolution."""
    turned = float(angle[-1] - angle[0])
    mean = turned * rate / (angle.size - 1)
    count = int(turned / (2.0 * np.pi))
    if count < 2:
        return ShaftSpeed(angle, source, mean, mean, mean)
    marks = angle[0] + 2.0 * np.pi * np.arange(count + 1)
    times = np.interp(marks, angle, np.arange(angle.size) / rate)
    speeds = 2.0 * np.pi / np.diff(times)
    return ShaftSpeed(angle, source, mean, float(speeds.min()), float(speeds.max()))
