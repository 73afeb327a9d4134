"""One clock for all meshes: whole numbers of mesh cycles in its period."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from tribodyn.errors import InputError, did_you_mean


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
                why = f"Known: {', '.join(self.turns)}"
                remedy = did_you_mean(shaft, self.turns, "Choose one of these")
                raise InputError(f'there is no shaft "{shaft}"', "argument shafts", why, remedy)
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
