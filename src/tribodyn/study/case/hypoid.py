"""The flanks, masses and levers that the keys of a hypoid pair in ``[gears]`` make."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import Argument, InputError, ModelWarning, collected
from tribodyn.gear.hypoid.blank import hypoid_blank
from tribodyn.study.case.gears import MEANINGS, EaseOffData, Gears, MountingData

if TYPE_CHECKING:
    from tribodyn.gear import HypoidFlanks, Misalignment


@contextmanager
def _placed_in(table: str) -> Iterator[None]:
    """Place the arguments of the physics under the table of the case that they came from."""
    try:
        yield
    except InputError as error:
        raise InputError(
            [
                replace(each, where=Argument(table + each.where.name.removeprefix("blank.")))
                if isinstance(each.where, Argument)
                else each
                for each in error.problems
            ]
        ) from None


def hypoid_flanks(gears: Gears) -> HypoidFlanks:
    """Flanks of the side that carries, silently; what was to be said is in the warnings."""
    return _built(gears)[0]


def hypoid_warnings(gears: Gears) -> tuple[ModelWarning, ...]:
    """Warnings about blank and flanks."""
    return _built(gears)[1]


@lru_cache(maxsize=16)
def _built(gears: Gears) -> tuple[HypoidFlanks, tuple[ModelWarning, ...]]:
    from tribodyn.gear import EaseOff
    from tribodyn.gear import hypoid_flanks as flanks_of

    values = {name: getattr(gears, name) for name in (*MEANINGS, "hand_pinion")}
    eased = {name: getattr(gears.ease_off, name) for name, _ in EaseOffData.specs()}
    with collected() as found:
        with _placed_in("ease_off."):
            ease_off = EaseOff(**eased)
        with _placed_in(""):
            blank = hypoid_blank(gears.pinion.teeth, gears.wheel.teeth, **values)
            flanks = flanks_of(blank, gears.side, ease_off)
    return flanks, tuple(found)


@lru_cache(maxsize=16)
def contact_ratio(gears: Gears) -> float:
    """Rotation over which a pair has contact lines, over the pitch."""
    from tribodyn.gear.hypoid.contact_lines import ContactLines

    flanks = hypoid_flanks(gears)
    low, high = ContactLines(flanks.conjugate).span()
    return (high - low) * flanks.blank.teeth_wheel / (2.0 * math.pi)


def mounting(gears: Gears) -> Misalignment:
    """Displacements of both gears."""
    from tribodyn.gear import Misalignment

    return Misalignment(**{n: getattr(gears.mounting, n) for n, _ in MountingData.specs()})


def levers(flanks: HypoidFlanks) -> tuple[float, float]:
    """Levers of the normal in the calculation point about the axes of pinion and wheel [m]."""
    wheel = float(flanks.conjugate.touch(np.zeros(2)).lever)
    return wheel / flanks.blank.ratio, wheel


def solid(flanks: HypoidFlanks, density: float) -> dict[str, tuple[float, float]]:
    """Mass and polar inertia of both toothed cones, cut at the pitch cone, without shafts."""
    found, blank = {}, flanks.blank
    for gear in ("pinion", "wheel"):
        cone = getattr(blank, f"pitch_angle_{gear}")
        outer, inner = (getattr(blank, f"{end}_cone_distance_{gear}") for end in ("outer", "inner"))
        one, two, height = (
            outer * math.sin(cone),
            inner * math.sin(cone),
            (outer - inner) * math.cos(cone),
        )
        scale = math.pi * density * height
        mass = scale / 3.0 * (one**2 + one * two + two**2)
        found[gear] = (mass, scale / 10.0 * sum(one**k * two ** (4 - k) for k in range(5)))
    return found
