"""Motion with faults of any case: its lines, its search on one clock, and what sensors receive."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import InputError, collected, warn
from tribodyn.progress import SILENT, Progress
from tribodyn.signals.spectrum import sum_of_lines
from tribodyn.study.faults.sensors import check_tacho
from tribodyn.study.machine.motion import MotionLine, Unit, line_cause
from tribodyn.types import Array, ByName, ComplexArray, Index, Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.faults import BearingImpacts, DrivenSystem
    from tribodyn.faults.driven import Lead
    from tribodyn.study.faults.sensors import SensorPlace, Sensors

#: Even samples of a mesh cycle.
SAMPLES = 512
#: Change of the motion with half the steps, over its size, that is small enough.
_ACCURATE = 2e-3
#: Mesh order up to which positions are those of the samples; from half of it on in part.
_SMOOTH = 64
#: Part of the strongest line below which lines are left out, and points of an entry of a contact
#: over a mesh cycle.
_LEAST, _POINTS = 1e-10, 512


class Accuracy(NamedTuple):
    """How exactly a motion over whole turns is searched."""

    steps: tuple[int, ...]  #: of a mesh cycle, tried in turn
    certified: float  #: error that suffices if half the steps change the motion little


class SensedLines:
    """Lines of a sensor: frequency [Hz], amplitude of cosines, and cycles of each phase."""

    def __init__(self, frequency: Array, amplitude: ComplexArray, numbers: Index) -> None:
        # All orders of one clock; of several phases there are many that are rounding.
        least = _LEAST * np.abs(amplitude).max(initial=0.0) if numbers.shape[1] > 1 else -1.0
        strong = np.abs(amplitude) > least
        strong[:1] = True
        order = np.flatnonzero(strong)[np.argsort(frequency[strong], kind="stable")]
        self.frequency, self.amplitude = frequency[order], amplitude[order]
        self.numbers = numbers[order]


def joined(*parts: SensedLines) -> SensedLines:
    """Sum of lines, each number once, the mean first."""
    numbers, first, place = np.unique(
        np.concatenate([part.numbers for part in parts]), axis=0, return_index=True,
        return_inverse=True,
    )  # fmt: skip
    amplitude = np.zeros(len(numbers), dtype=complex)
    np.add.at(amplitude, place.reshape(-1), np.concatenate([part.amplitude for part in parts]))
    frequency = np.concatenate([part.frequency for part in parts])[first]
    still = ~numbers.any(axis=1)
    amplitude[still] = amplitude[still].real
    return SensedLines(frequency, amplitude, numbers)


def lines_over_phase(
    function: Callable[[Array], Any], cycles: Any, of_mesh: int, frequencies: Array
) -> SensedLines:
    """Lines of a function of mesh cycles that has so many periods over each of the phases."""
    numbers = np.atleast_1d(np.asarray(cycles, dtype=np.int64))
    count = _POINTS * of_mesh
    values = np.asarray(function(np.arange(count) / count), dtype=float)
    lines = np.fft.rfft(values)[: count // 2] / count
    lines[1:] *= 2.0
    turned = np.multiply.outer(np.arange(lines.size), numbers)
    return positive(turned @ frequencies, lines, turned)


def positive(frequency: Array, amplitude: ComplexArray, numbers: Index) -> SensedLines:
    """Lines of cosines, those with a negative frequency turned about."""
    back = frequency < 0.0
    amplitude = np.where(back, amplitude.conj(), amplitude)
    numbers = np.where(back[:, None], -numbers, numbers)
    return joined(SensedLines(np.abs(frequency), amplitude, numbers))


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicMotion(ABC):
    """Motion with faults as spectral lines; over phases a period is that of a piece of it."""

    cycles: int  #: mesh cycles of the period, of the fastest mesh
    mesh_frequency: float  #: mesh cycles per second [Hz]
    places: Sensors  #: what there is to sense
    turns: ByName  #: of each shaft in the period
    tacho: str  #: shaft with the tacho
    response: Response  #: without the fluctuation of the mean rotation
    ahead: Lead | None  #: time by which the rotation is ahead of its mean
    meshes: Mapping[str, tuple[int, ...]]  #: mesh cycles over each phase
    units: tuple[Unit, ...]  #: what turns with each phase

    @abstractmethod
    def _linear(self, place: SensorPlace) -> SensedLines:
        """Lines of the data of a class at a place, without its seat."""

    @cached_property
    def frequencies(self) -> Array:
        """Frequency of each phase; one clock is a phase [Hz]."""
        return np.asarray(getattr(self.response, "frequencies", (1.0 / self.period,)))

    @cached_property
    def _listed(self) -> Tree:
        return {}

    def _lines(self, quantity: str) -> tuple[Array, ComplexArray, Index]:
        """Lines of the response: frequencies, amplitudes (k, m), and numbers."""
        if quantity not in self._listed:
            self._listed[quantity] = response_lines(self.response, quantity, self.cycles)
        return self._listed[quantity]  # type: ignore[no-any-return]

    def _lead_lines(self, speed: float) -> SensedLines:
        """Lines of the rotation that is ahead, of what turns so fast [rad/s]."""
        assert self.ahead is not None
        parts = []
        for cycles, series in self.ahead.parts:
            numbers = np.multiply.outer(np.arange(len(series.lines)), cycles)
            parts.append(positive(numbers @ self.frequencies, speed * series.lines, numbers))
        return joined(*parts)

    def sensed(self, sensor: str) -> SensedLines:
        """Lines that a sensor receives."""
        place = self.places.place(sensor)
        lines = self._linear(place)
        if place.seat is None:
            return lines
        amplitude = lines.amplitude * place.seat(lines.frequency)
        return SensedLines(lines.frequency, amplitude, lines.numbers)

    def lines(self, sensor: str, count: int = 20) -> list[MotionLine]:
        """Strongest lines of a sensor by rising frequency, with their causes in words."""
        lines, phases = self.sensed(sensor), len(self.frequencies)
        strongest = np.argsort(-np.abs(lines.amplitude), kind="stable")
        chosen = np.sort(strongest[lines.frequency[strongest] > 0.0][:count])
        listed = []
        for at in chosen.tolist():
            numbers = tuple(lines.numbers[at].tolist())
            cause = line_cause(numbers[:phases], self.meshes, self.units)
            for turns in numbers[phases:]:
                cause += f" {'-' if turns < 0 else '+'} {abs(turns)} x carrier" if turns else ""
            amplitude = complex(lines.amplitude[at])
            listed.append(MotionLine(float(lines.frequency[at]), amplitude, numbers, cause))
        return listed

    @cached_property
    def splines(self) -> dict[Any, Any]:
        """Signals as smooth functions, by sensor and sampling rate; filled where they are used."""
        return {}

    @property
    def period(self) -> float:
        """Time after which all repeats [s]."""
        return self.cycles / self.mesh_frequency

    def rotation_frequency(self, shaft: str) -> float:
        """Turns of a shaft, of a pair of a gear, per second [Hz]."""
        check_tacho(self.places, shaft)
        turns = float(self.turns[shaft])
        if turns == 0.0:
            what, why = f"{shaft} does not turn", "A tacho counts the turns of a shaft"
            raise InputError(what, "argument tacho", why, "Name another one")
        return turns / self.period

    def lead_at(self, time: Array) -> Array:
        """Mesh cycles by which the rotation is ahead of its mean at times [s]."""
        if self.ahead is None:
            return np.zeros(time.shape)
        points = time[:, None] * self.frequencies % 1.0
        return np.asarray(self.ahead(points)[0] * self.mesh_frequency)

    @property
    def sensors(self) -> tuple[str, ...]:
        """Signals of :meth:`signal`."""
        return self.places.names

    def sampled(self, lines: SensedLines) -> Array:
        """Sum of lines on even samples of the period."""
        count = SAMPLES * self.cycles
        return sum_of_lines(lines.frequency, lines.amplitude, 0.0, self.period / count, count)

    def signal(self, sensor: str) -> tuple[Array, str]:
        """What a sensor receives on even samples of the period, with its unit."""
        return self.sampled(self.sensed(sensor)), self.places.place(sensor).unit

    def sensed_from(self, tacho: str | None, angle: float, window: Any) -> Any:
        """The motion with its tacho on another shaft; only a ring has a sensor at an angle."""
        if angle != 0.0 or window is not None:
            what = f"sensor_angle = {angle:g} rad" if angle else "a window"
            why = "They are of a sensor on the ring of a planetary stage"
            raise InputError(what, "argument sensor_angle", why, "Leave them out")
        return self if tacho is None else replace(self, tacho=tacho)

    def impacts(
        self, sensor: str, defect: tuple[str, BearingImpacts], time: Array, seed: int
    ) -> Array | float:
        """What a sensor receives of a damaged bearing, the shaft or bearing of which is named."""
        return 0.0

    def harmonics(self, sensor: str) -> tuple[Array, ComplexArray]:
        """Frequencies (k,) [Hz] and complex peak amplitudes (k,) of a signal, from its mean on."""
        lines = self.sensed(sensor)  # by rising frequency; phases in a ratio share lines
        first = np.flatnonzero(np.diff(lines.frequency, prepend=-1.0) > 1e-9 * self.mesh_frequency)
        return lines.frequency[first], np.add.reduceat(lines.amplitude, first)

    def __repr__(self) -> str:
        """One line."""
        turns = ", ".join(f"{shaft} {float(turns):g}" for shaft, turns in self.turns.items())
        return f"{type(self).__name__}({self.period:.5g} s, turns: {turns})"


def response_lines(
    response: Response, quantity: str, cycles: int
) -> tuple[Array, ComplexArray, Index]:
    """Frequencies, amplitudes (k, m) and numbers of the lines of a response of mesh cycles."""
    from tribodyn.dynamics import PhaseResponse

    if isinstance(response, PhaseResponse):
        return response.lines(quantity)
    fine, period = response.fine, response.periods / response.mesh_frequency
    even = even_samples((fine.phase - fine.phase[0]) / response.periods, SAMPLES * cycles)
    frequency, lines = signal_lines(even(getattr(fine, quantity)), period)
    number: Index = np.arange(frequency.size)
    if quantity == "position":
        # Positions are exact at low orders; of the highest, samples of the acceleration are free
        # of what jumps of the friction alias into the low ones.
        sampled = signal_lines(even(fine.acceleration), period)[1][1:]
        sampled = -sampled / (2.0 * np.pi * frequency[1:, None]) ** 2
        share = np.clip(2.0 * number[1:] / (_SMOOTH * cycles) - 1.0, 0.0, 1.0)[:, None]
        lines[1:] += 0.5 * (1.0 - np.cos(np.pi * share)) * (sampled - lines[1:])
    return frequency, lines, number[:, None]


def even_samples(phase: Array, count: int) -> Callable[[Array], Array]:
    """Means of periodic values (p, ...) over ``count`` equal intervals about their middles."""
    # Samples at the middles would alias jumps, which are two values at one phase.
    order = np.argsort(phase, kind="stable")
    order = np.concatenate((order[-1:], order, order[:1]))
    place = phase[order] + np.array([-1.0, *np.zeros(phase.size), 1.0])
    widths = np.diff(place)
    edges = (np.arange(count + 1) - 0.5) / count
    turned = (edges < place[0]).astype(float)
    edges += turned
    before = np.clip(np.searchsorted(place, edges, side="right") - 1, 0, widths.size - 1)
    part = np.divide(
        edges - place[before], widths[before], out=np.zeros(count + 1), where=widths[before] > 0.0
    )

    def sampled(values: Array) -> Array:
        rows = values[order].reshape(order.size, -1)
        steps = 0.5 * (rows[1:] + rows[:-1]) * widths[:, None]
        integral = np.concatenate((np.zeros((1, rows.shape[1])), np.cumsum(steps, axis=0)))
        change = (rows[before + 1] - rows[before]) * part[:, None]
        remainder = (rows[before] + 0.5 * change) * (part * widths[before])[:, None]
        period = turned[:, None] * integral[-2]  # from the first to the last but one place
        means = np.diff(integral[before] + remainder - period, axis=0) * count
        return np.asarray(means.reshape(count, *values.shape[1:]))

    return sampled


def signal_lines(values: Array, period: float) -> tuple[Array, ComplexArray]:
    """Frequencies and complex peak amplitudes of :func:`even_samples`, from the mean on."""
    count = len(values)
    lines = np.fft.rfft(values, axis=0) / count
    gain = np.sinc(np.arange(len(lines)) / count)  # of the means
    lines /= gain.reshape(-1, *[1] * (values.ndim - 1))
    lines[1:] *= 2.0
    return np.arange(len(lines)) / period, lines


def refuse_long_period(cycles: int, seconds: float, limit: int, remedy: str) -> None:
    """Refuse a motion that would need more memory than a notebook has."""
    if cycles > limit:
        what = f"all repeats only after {cycles} mesh cycles, {seconds:.4g} s"
        raise InputError(what, "faults", f"At most {limit} mesh cycles are computed", remedy)


def lead_on_clock(driven: DrivenSystem, mesh_frequency: float) -> Lead | None:
    """Time by which the rotation of a driven system is ahead, over its clock."""
    from tribodyn.faults.driven import Lead, Series

    if not driven.lead.lines.any():
        return None
    return Lead([((1,), Series(driven.lead.lines / mesh_frequency))])


def steady_over_turns(
    driven: DrivenSystem,
    frequency: float,
    accuracy: Accuracy,
    progress: Progress = SILENT,
) -> Response:
    """Find the periodic motion of a driven system, with as many steps as it needs."""
    from tribodyn.dynamics import harmonic_balance

    response = None
    for steps in accuracy.steps:
        with collected() as model_warnings:
            response = harmonic_balance(
                driven.system,
                frequency,
                steps=math.ceil(steps * driven.cycles / driven.system.cycles),
                start=response,
                tolerance=accuracy.certified,
                progress=progress,
            )
        if not response.step_error > _ACCURATE:
            break
    for warning in model_warnings:
        warn(warning.code, warning.message)
    assert response is not None
    return response
