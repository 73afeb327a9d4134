"""Attractors of a plane of starts, and the attractor that each start converges to."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tribodyn.arrays.linear_algebra import lengths
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.orbits.steady_state import steady_state
from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.nonlinear.attractors import Motions, settle
from tribodyn.nonlinear.survey import Survey, follow, measure
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, Index, Mask

#: States of one motion differ by less than this part of the largest state.
_SAME = 1e-3
#: Motions this much smaller than their starts are at rest.
_REST = 1e-3
#: Certified distance of an attractor to the motion that repeats, relative to the state.
_EXACT = 1e-9
#: Motions that still change by more than this are taken for irregular ones.
_WILD = 1e-3
#: Rms values of one irregular motion agree within this.
_IRREGULAR = 0.1
#: Attractors at most; what comes after is left unresolved.
_MOST = 64


@dataclass(frozen=True)
class Attractor:
    """A motion that starts are drawn to.

    Parameters
    ----------
    position, velocity : (p, n) array
        State at the mesh phase 0 of its ``p`` mesh cycles; of an irregular motion one state
        [m or rad, m/s or rad/s].
    period : int
        Mesh cycles after which it repeats; 0 if it does not.
    rms : float
        Alternating rms of the signal [m or rad].
    contact_loss_share : float
        Part of the time off the driving flank [-].
    largest_multiplier : float
        Modulus of its largest Floquet multiplier [-]; NaN if it does not repeat.
    stable : bool
        Whether that is below one; true of a motion that does not repeat, since it attracts
        starts.
    share : float
        Part of the starts that converge to it [-].
    verdict : str
        ``"physical"``, ``"step-limited"``, ``"undecided"``; empty if not requested.
    refined_period : int
        Period with half the step [mesh cycles].
    refined_rms : float
        Rms with half the step [m or rad].
    section : (p, 2) array, optional
        Its states in the coordinates of the plane of starts [their units].
    """

    position: Array = field(repr=False)
    velocity: Array = field(repr=False)
    period: int
    rms: float
    contact_loss_share: float
    largest_multiplier: float
    stable: bool = field(repr=False)
    share: float
    verdict: str = ""
    refined_period: int = field(default=0, repr=False)
    refined_rms: float = field(default=float("nan"), repr=False)
    section: Array | None = field(default=None, repr=False)


@dataclass
class MarchedAttractor:
    """An attractor as it comes out of the marching."""

    states: Array  #: reduced states at the mesh phase 0
    state: Array  #: one state [mixed]
    force: Array  #: generalized force that balanced the drive [N or N*m]
    period: int  #: mesh cycles after which it repeats
    rms: float  #: [m or rad, -]
    contact_loss_share: float  #: [m or rad, -]
    full: Array  #: states at the mesh phase 0 [mixed]


class Catalogue:
    """Attractors known so far."""

    def __init__(self, survey: Survey, least: float = 0.0) -> None:
        self.survey, self.least = survey, least
        self.known: list[MarchedAttractor] = []

    def label(self, motions: Motions) -> Index:
        """Tell which attractor every motion came to; unknown ones are added."""
        label = np.full(motions.frequency.size, -1)
        alive = motions.finished & np.all(np.isfinite(motions.state), axis=1)
        if not alive.any():
            return label
        every = np.arange(alive.size)
        reduced = motions.reduce(np.where(alive[:, None], motions.state, 0.0), every)
        begin = motions.reduce(motions.start[alive], every[alive])
        longest = [float(lengths(each).max()) for each in (reduced, begin)]
        size = max(longest[0], _REST * longest[1]) or 1.0
        for number, attractor in enumerate(self.known):
            self._claim(label, number, attractor, motions, reduced, size)
        while True:
            free = np.flatnonzero((label < 0) & alive & (motions.period > 0))
            if not free.size or len(self.known) >= _MOST:
                break
            label[free[0]] = self._number(self._trace(motions, free[:1]), size)
            number = int(label[free[0]])
            self._claim(label, number, self.known[number], motions, reduced, size)
        self._irregular(label, alive, motions)
        return label

    def _number(self, new: MarchedAttractor, size: float) -> int:
        """Number of an attractor; that of an existing one if both have the same states."""
        for number, attractor in enumerate(self.known):
            if attractor.period == new.period:
                distance = lengths(attractor.states - new.states[0])
                if distance.min() <= _SAME * size:
                    return number
        self.known.append(new)
        return len(self.known) - 1

    def _claim(
        self,
        label: Index,
        number: int,
        attractor: MarchedAttractor,
        motions: Motions,
        reduced: Array,
        size: float,
    ) -> None:
        """Give a number to all motions near the states of an attractor."""
        if not attractor.period:
            return
        for state in attractor.states:
            close = lengths(reduced - state) <= _SAME * size
            settled = (motions.period > 0) | (motions.change <= _WILD)
            label[close & settled & (label < 0) & motions.finished] = number

    def _trace(self, motions: Motions, index: Index) -> MarchedAttractor:
        """Follow one motion over its period, or over the cycles of the statistics."""
        period = int(motions.period[index[0]])
        if period:
            single = Motions(
                motions.compiled,
                motions.frequency[index],
                motions.state[index],
                motions.force[index],
            )
            settle(single, [0], self.survey.cycles, tolerance=_EXACT, width=1)
            motions, index = single, np.array([0])
            shorter = int(motions.period[0])
            period = shorter if shorter and period % shorter == 0 else period
        path = follow(
            motions, index, motions.state[index], period or self.survey.cycles, self.survey.signal
        )
        full = path.states[: max(period, 1), 0]
        rms = float(path.rms[0])
        return MarchedAttractor(
            motions.reduce(full[:, None], index)[:, 0],
            full[0],
            motions.force[index[0]].copy(),
            period,
            0.0 if rms < self.least else rms,
            float(path.contact_loss_share[0]),
            full,
        )

    def _irregular(self, label: Index, alive: Mask, motions: Motions) -> None:
        """Sort motions that do not repeat by their rms; those that still approach stay open."""
        wild = np.flatnonzero((label < 0) & alive & (motions.period == 0))
        wild = wild[motions.change[wild] > _WILD]
        if not wild.size:
            return
        rms = measure(motions, wild, self.survey).rms
        open_ = np.isfinite(rms)
        while open_.any() and len(self.known) < _MOST:
            irregular = [n for n, f in enumerate(self.known) if not f.period]
            for number in irregular:
                close = np.abs(rms - self.known[number].rms) <= _IRREGULAR * self.known[number].rms
                label[wild[open_ & close]] = number
                open_ &= ~close
            if not open_.any():
                break
            middle = np.flatnonzero(open_)[np.argsort(rms[open_])[np.count_nonzero(open_) // 2]]
            self.known.append(self._trace(motions, wild[middle : middle + 1]))
            self.known[-1].rms = float(rms[middle])

    def again(self, compiled: Compiled, beat: float, force: Array) -> Catalogue:
        """Follow every attractor with other steps."""
        new, count = Catalogue(self.survey, self.least), len(self.known)
        if not count:
            return new
        begin = np.array([attractor.state for attractor in self.known])
        motions = Motions(compiled, np.full(count, beat), begin, np.tile(force, (count, 1)))
        settle(motions, np.arange(count), self.survey.transient, tolerance=self.survey.tolerance)
        new.known += [self._trace(motions, np.array([number])) for number in range(count)]
        return new


def multiplier_of(attractor: MarchedAttractor, motions: Motions, steps: int) -> float:
    """Modulus of the largest Floquet multiplier of an attractor."""
    half = attractor.state.size // 2
    start = (attractor.state[:half], attractor.state[half:])
    if not attractor.period:
        return float("nan")
    try:
        # NaN marks an orbit that is not found; at rest its relative error means nothing.
        with quiet():
            orbit = steady_state(
                motions.compiled.system,
                float(motions.frequency[0]),
                steps=steps,
                periods=attractor.period,
                start=start,
            )
    except (ComputationError, InputError):
        return float("nan")
    if not orbit.converged or not orbit.floquet_multipliers.size:
        return float("nan")
    return float(np.abs(orbit.floquet_multipliers).max())


@record
class Basins(Record):
    """Motion that every start of a plane converges to.

    Parameters
    ----------
    coordinates : tuple of two str
        Components of the state that vary, a velocity ends in ``_velocity``; or the transmission
        error and its rate.
    units : tuple of two str
        Their units.
    first, second : (nx,), (ny,) array
        Their values [m, rad, m/s or rad/s].
    attractor : (nx, ny) int array
        Number of the attractor; -1 where the motion grew beyond all bounds or has not come near
        any motion that repeats.
    attractors : tuple of Attractor
        The motions, the one with the largest share first.
    refined_attractor : (nx, ny) int array
        The same with half the step, -2 for an attractor that the longer step does not show; all
        -3 if not requested.
    names : tuple of str
        Names of the coordinates of the system.
    signal : str
        Name of what rms and contact loss are of, a contact or a coordinate.
    mesh_frequency : float
        Mesh frequency [Hz].
    steps : int
        Steps per mesh cycle.
    step_number : float
        ``omega_max * dt`` [-].
    finished : (nx, ny) bool array
        Which starts were marched; all of them unless the work was interrupted.
    """

    coordinates: tuple[str, str]
    units: tuple[str, str]
    first: Array = quantity("first", axis=True)
    second: Array = quantity("second", axis=True)
    attractor: Index = quantity("first", "second")
    attractors: tuple[Attractor, ...]
    refined_attractor: Index = quantity("first", "second")
    names: tuple[str, ...]
    signal: str = fact()
    mesh_frequency: float = fact()
    steps: int = fact()
    step_number: float = fact()
    finished: Mask = quantity("first", "second")

    @property
    def complete(self) -> bool:
        """Whether every start was marched."""
        return bool(self.finished.all())

    @property
    def unresolved(self) -> float:
        """Part of the starts that come to no attractor [-]."""
        return float(np.mean(self.attractor[self.finished] < 0)) if self.finished.any() else 1.0

    @property
    def changed(self) -> float:
        """Part of the starts that come to another attractor with half the step [-]."""
        judged = self.finished & (self.refined_attractor > -3)
        if not judged.any():
            return float("nan")
        return float(np.mean(self.attractor[judged] != self.refined_attractor[judged]))

    def __repr__(self) -> str:
        """One line."""
        kinds = [
            f"{100.0 * a.share:.3g} % {f'period {a.period}' if a.period else 'irregular'}"
            for a in self.attractors
        ]
        extra = f", {100.0 * self.unresolved:.3g} % unresolved" if self.unresolved else ""
        count = f"{self.first.size} x {self.second.size}"
        return (
            f"Basins({count} starts over {' and '.join(self.coordinates)} at "
            f"{self.mesh_frequency:.6g} Hz: {', '.join(kinds) or 'no attractor'}{extra}"
            f"{'' if self.complete else ', interrupted'})"
        )

    def _parts(self) -> Parts:
        parts = super()._parts().over(self.coordinates, self.units)
        units = {"rms": "m or rad"}
        for name in ("period", "rms", "contact_loss_share", "largest_multiplier", "share"):
            values = [getattr(each, name) for each in self.attractors]
            parts.variables[name] = ("number", values, {"units": units.get(name, "1")})
        parts.variables["verdict"] = ("number", [each.verdict for each in self.attractors])
        return parts
