"""One clock for all meshes, whole numbers of mesh cycles in its period; or phases of their own."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import combinations

from tribodyn.errors import InputError, no_such

#: Meshes share a phase if each has no more cycles in a period of it.
_SHARED = 4


@dataclass(frozen=True)
class Clock:
    """Period of a machine: the shortest with a whole number of cycles of every mesh.

    Parameters
    ----------
    cycles : mapping of str to int
        Mesh cycles of each mesh in a period.
    turns : mapping of str to Fraction
        Turns of each shaft in a period, without a sign; exact.
    frequency : float
        Periods per second [Hz].

    Examples
    --------
    >>> clock = clock_of({"first": Fraction(27), "second": Fraction(23 * 27, 51)},
    ...                  {"input": Fraction(1), "middle": Fraction(27, 51)}, 10.0)
    >>> clock.cycles, clock.turns["middle"]
    ({'first': 51, 'second': 23}, Fraction(1, 1))
    """

    cycles: Mapping[str, int]
    turns: Mapping[str, Fraction]
    frequency: float

    def with_whole_turns(self, *shafts: str) -> Clock:
        """Clock in whose period these shafts make whole turns too, for what repeats with a shaft.

        Parameters
        ----------
        *shafts : str
            Names of shafts.

        Raises
        ------
        InputError
            If there is no such shaft.
        """
        for shaft in shafts:
            if shaft not in self.turns:
                raise InputError(no_such("shaft", shaft, self.turns, "argument shafts"))
        return self._longer(math.lcm(*(self.turns[shaft].denominator for shaft in shafts)))

    def with_whole_periods(self, periods: Mapping[str, int]) -> Clock:
        """Clock whose mesh cycles are multiples of those after which each mesh repeats.

        Parameters
        ----------
        periods : mapping of str to int
            Mesh cycles after which the teeth of each mesh repeat.
        """
        factors = (period // math.gcd(period, self.cycles[m]) for m, period in periods.items())
        return self._longer(math.lcm(*factors))

    def _longer(self, factor: int) -> Clock:
        return Clock(
            {mesh: factor * cycles for mesh, cycles in self.cycles.items()},
            {shaft: factor * turns for shaft, turns in self.turns.items()},
            self.frequency / factor,
        )


@dataclass(frozen=True)
class Phases:
    """Independent phases of a machine, of its meshes and of what turns with its shafts.

    Parameters
    ----------
    cycles : mapping of str to tuple of int
        Periods of each mesh over each phase: its mesh cycles, or of teeth that differ the periods
        after which they repeat.
    frequency : tuple of float
        Frequency of each phase [Hz].
    turns, driven : mapping of Fraction to tuple of int
        Cycles over each phase of what turns with the meshes, and of what drives them, by their
        rates: cycles in a period of the clock.

    Examples
    --------
    >>> clock = clock_of({"first": Fraction(27), "second": Fraction(23 * 27, 51)}, {}, 10.0)
    >>> phases_of(clock, {"first": 1, "second": 1}).cycles
    {'first': (1, 0), 'second': (0, 1)}
    """

    cycles: Mapping[str, tuple[int, ...]]
    frequency: tuple[float, ...]
    turns: Mapping[Fraction, tuple[int, ...]] = field(default_factory=dict)
    driven: Mapping[Fraction, tuple[int, ...]] = field(default_factory=dict)


def phases_of(
    clock: Clock,
    periods: Mapping[str, int],
    turning: Sequence[Fraction] = (),
    driven: Sequence[Fraction] = (),
    *,
    together: bool = False,
    size: Callable[[Phases], float] | None = None,
) -> Phases:
    """Phases of meshes, of what turns with them and of what drives them; or one together."""
    # size: what grids over phases take; where teeth differ, phases that make it less are one.
    rates = {mesh: Fraction(cycles, periods[mesh]) for mesh, cycles in clock.cycles.items()}
    # Meshes follow a rotation that is ahead, but not what drives it: that has phases of its own.
    all_rates = [*rates.values(), *turning]
    locked, free = [all_rates] if together else _groups(all_rates), _groups([*driven])
    # Meshes of one frequency follow one phase, also where the teeth of some differ.
    for cycles in dict.fromkeys(clock.cycles.values()):
        locked = _joined(locked, [rates[m] for m, each in clock.cycles.items() if each == cycles])

    def over(locked: list[list[Fraction]]) -> Phases:
        bases = [_common(group) for group in (*locked, *free)]

        def counts(rate: Fraction, groups: list[list[Fraction]], first: int) -> tuple[int, ...]:
            axis = next(first + at for at, group in enumerate(groups) if rate in group)
            return (*(0,) * axis, int(rate / bases[axis]), *(0,) * (len(bases) - axis - 1))

        return Phases(
            {mesh: counts(rate, locked, 0) for mesh, rate in rates.items()},
            tuple(clock.frequency * float(base) for base in bases),
            {rate: counts(rate, locked, 0) for rate in turning},
            {rate: counts(rate, free, len(locked)) for rate in driven},
        )

    differing = {rates[mesh] for mesh, period in periods.items() if period > 1}
    phases = over(locked)
    while size is not None and len(phases.frequency) > 2:
        pairs = [(a, b) for a, b in combinations(locked, 2) if not differing.isdisjoint(a + b)]
        joined = [_joined(locked, [a[0], b[0]]) for a, b in pairs]
        merged = min(joined, key=lambda each: size(over(each)), default=locked)
        if size(over(merged)) >= size(phases):
            break
        locked, phases = merged, over(merged)
    return phases


def _groups(rates: Iterable[Fraction]) -> list[list[Fraction]]:
    """Rates that share a phase."""
    groups: list[list[Fraction]] = []
    for rate in dict.fromkeys(rates):
        group = next((each for each in groups if _most_cycles([*each, rate]) <= _SHARED), None)
        if group is None:
            groups.append(group := [])
        group.append(rate)
    return groups


def _joined(groups: list[list[Fraction]], rates: Iterable[Fraction]) -> list[list[Fraction]]:
    """Groups, with one for all that contain some of these rates."""
    wanted = {*rates}
    chosen = [group for group in groups if not wanted.isdisjoint(group)]
    others = [group for group in groups if wanted.isdisjoint(group)]
    return [[rate for group in chosen for rate in group], *others] if chosen[1:] else groups


def _common(rates: Sequence[Fraction]) -> Fraction:
    """Largest rate of which all these are whole multiples."""
    return Fraction(
        math.gcd(*(rate.numerator for rate in rates)),
        math.lcm(*(rate.denominator for rate in rates)),
    )


def _most_cycles(rates: Sequence[Fraction]) -> int:
    return int(max(rates) / _common(rates))


def clock_of(
    cycles: Mapping[str, Fraction], turns: Mapping[str, Fraction], input_frequency: float
) -> Clock:
    """Clock from mesh cycles and turns of the shafts per turn of the input."""
    values = cycles.values()
    common = math.gcd(*(value.numerator for value in values))
    period = Fraction(math.lcm(*(value.denominator for value in values)), common)
    return Clock(
        {mesh: int(value * period) for mesh, value in cycles.items()},
        {shaft: abs(value) * period for shaft, value in turns.items()},
        input_frequency / float(period),
    )
