"""Motion over whole turns of any case: its steady search, and what sensors receive of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import InputError, collected, warn
from tribodyn.progress import SILENT, Progress
from tribodyn.study.faults.sensors import check_tacho
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.faults import BearingImpacts, DrivenSystem
    from tribodyn.study.faults.sensors import SensorPlace, Sensors

#: Even samples of a mesh cycle.
SAMPLES = 512
#: Change of the motion with half the steps, over its size, that is small enough.
_ACCURATE = 2e-3


class Accuracy(NamedTuple):
    """How exactly a motion over whole turns is searched."""

    steps: tuple[int, ...]  #: of a mesh cycle, tried in turn
    certified: float  #: error that suffices beside a small change with half the steps


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicMotion:
    """Motion over a period of whole turns; its classes add their data and :meth:`series`."""

    cycles: int  #: mesh cycles of the period, of the fastest mesh
    mesh_frequency: float  #: mesh cycles per second [Hz]
    places: Sensors  #: what there is to sense
    turns: Mapping[str, Any]  #: of each shaft in the period
    tacho: str  #: shaft with the tacho
    #: Mesh cycles by which the rotation is ahead of its mean: even samples, or a function.
    lead: Any

    def series(self, place: SensorPlace) -> Array:
        """Means over even intervals of the period about each sample, of the data of a class."""
        return np.asarray(getattr(self, place.quantity))

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
            what, why = f"{shaft} stands", "A tacho counts the turns of a shaft"
            raise InputError(what, "argument tacho", why, "Name another one")
        return turns / self.period

    def lead_at(self, time: Array) -> Array:
        """Mesh cycles by which the rotation is ahead of its mean at times [s]."""
        clock = time / self.period % 1.0
        if callable(self.lead):
            return np.asarray(self.lead(clock))
        count = len(self.lead)
        return np.asarray(np.interp(clock, np.arange(count) / count, self.lead, period=1.0))

    @property
    def sensors(self) -> tuple[str, ...]:
        """Signals of :meth:`signal`."""
        return self.places.names

    def signal(self, sensor: str) -> tuple[Array, str]:
        """What a sensor receives on even samples of the period, with its unit."""
        place = self.places.place(sensor)
        values = self.series(place)
        if place.seat is not None:
            lines = np.fft.rfft(values)
            lines *= place.seat(np.arange(lines.size, dtype=float) / self.period)
            values = np.fft.irfft(lines, values.size)
        return np.asarray(values), place.unit

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
        return signal_lines(self.signal(sensor)[0], self.period)


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
    lines = np.fft.rfft(values) / values.size
    lines /= np.sinc(np.arange(lines.size) / values.size)  # gain of the means
    lines[1:] *= 2.0
    return np.arange(lines.size) / period, lines


def refuse_long_period(cycles: int, seconds: float, limit: int, remedy: str) -> None:
    """Refuse a motion that would need more memory than a notebook has."""
    if cycles > limit:
        what = f"all repeats only after {cycles} mesh cycles, {seconds:.4g} s"
        raise InputError(what, "faults", f"At most {limit} mesh cycles are computed", remedy)


def repeated(response: Response, frequency: float, slower: float) -> Response:
    """A periodic motion over the longer period of a slower clock."""
    count, last = round(frequency / slower), -1
    start = response.time - response.time[0]
    times = [start[:last] + turn / frequency for turn in range(count)]
    position = np.concatenate([*count * [response.position[:last]], response.position[last:]])
    time = np.concatenate([*times, [count / frequency]])
    return replace(response, time=time, position=position, mesh_frequency=slower)


def steady_over_turns(
    driven: DrivenSystem,
    frequency: float,
    accuracy: Accuracy,
    start: Response | None = None,
    progress: Progress = SILENT,
) -> Response:
    """Find the periodic motion of a driven system, with as many steps as it needs."""
    from tribodyn.dynamics import harmonic_balance

    response = start
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
