"""Frequencies that follow from speeds, numbers of teeth and bearing dimensions alone.

Two teeth of a mesh meet again after lcm(z1, z2) mesh cycles: the hunting tooth frequency is
``GMF / lcm(z1, z2)``. Each of the gcd(z1, z2) assembly phases has teeth that wear together.
Bearings roll without slip. A tooth of the sun or the ring meets every planet in a turn
relative to the carrier, a flank of a planet meets one tooth. Speeds are turns per second [Hz].
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product
from typing import NamedTuple

from tribodyn.faults import BearingImpacts


class PartFrequency(NamedTuple):
    """A frequency of a part [Hz], its short name in the trade, and what repeats with it."""

    part: str
    symbol: str
    frequency: float
    meaning: str


def mesh_frequencies(
    part: str,
    frequency: float,
    gears: Mapping[str, tuple[int, float]],
    sidebands: int = 1,
    remark: str = "",
) -> Iterator[PartFrequency]:
    """Lines of a mesh; teeth and speeds of both gears are those relative to its carrier."""
    teeth = [abs(count) for count, _ in gears.values()]
    phases = math.gcd(*teeth)
    yield PartFrequency(part, "GMF", frequency, f"gear mesh, {teeth[0]}/{teeth[1]} teeth")
    for order, (name, (_, turning)) in product(range(1, sidebands + 1), gears.items()):
        shift, meaning = order * abs(turning), f"sideband of a fault of {name}{remark}"
        times = "" if order == 1 else f"{order} "
        if shift < frequency:
            yield PartFrequency(part, f"GMF - {times}f({name})", frequency - shift, meaning)
        yield PartFrequency(part, f"GMF + {times}f({name})", frequency + shift, meaning)
    met = f"assembly phases: {phases}"
    yield PartFrequency(part, "APF", frequency / phases, f"assembly phase passage, {met}")
    hunting = frequency / math.lcm(*teeth)
    yield PartFrequency(part, "HTF", hunting, "hunting tooth: the same two teeth meet again")


def bearing_frequencies(
    part: str, bearing: BearingImpacts, turning: float
) -> Iterator[PartFrequency]:
    """Lines of a rolling bearing whose rings turn against each other."""
    speed, elements = abs(turning), f"{bearing.rolling_elements} elements"
    outer, inner = replace(bearing, place="outer"), replace(bearing, place="inner")
    element = replace(bearing, place="element")
    yield PartFrequency(part, "BPFO", outer.frequency(speed), f"outer ring, {elements}")
    yield PartFrequency(part, "BPFI", inner.frequency(speed), f"inner ring, {elements}")
    spin = 0.5 * element.frequency(speed)
    yield PartFrequency(part, "BSF", spin, "spin of an element, which strikes at 2 BSF")
    yield PartFrequency(part, "FTF", element.modulation(speed), "cage")


def stage_frequencies(
    part: str, count: int, passing: float, gears: Mapping[str, tuple[int, float]]
) -> Iterator[PartFrequency]:
    """Lines of a planetary stage: planets that pass, a damaged tooth of each gear."""
    yield PartFrequency(part, "PPF", count * abs(passing), f"{count} planets pass a sensor")
    for name, (teeth, mesh) in gears.items():
        of_planet = name.endswith("planet")
        what = f"a damaged flank of one {name}" if of_planet else f"a damaged tooth of the {name}"
        meetings = 1 if of_planet else count
        yield PartFrequency(part, f"TF({name})", meetings * mesh / abs(teeth), what)
