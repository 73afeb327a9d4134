"""Friction of a solved film: known at the positions of the film, for every sliding speed there.

A law that shears the film needs its pressure profile, which is there at the positions only. At
each of them the law is asked for a range of sliding speeds; a contact between two positions takes
its own sliding speed and interpolates over the positions. So the steep reversal at the pitch point
is followed although no position is near it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tribodyn.contact import Kinematics, hertz_line
from tribodyn.ehl.traction.film_state import FilmState
from tribodyn.friction import LAWS, TribologicalContact
from tribodyn.mesh.path_film import SolvedPath
from tribodyn.mesh.positions import lobatto_points, lobatto_polynomial
from tribodyn.types import Array, Index

#: Sliding speed up to which friction is about linear in it, for any oil under pressure [m/s].
_SLOW = 1e-4
#: Samples for each unit of asinh(v/_SLOW), and the least number of them.
_DENSITY, _LEAST = 4.0, 8
#: Sliding speed over entrainment speed, below the 2 at which one surface stands still.
_MOST_SLIDING = 1.99


def film_friction(
    law: str,
    options: Mapping[str, Any],
    solved: SolvedPath,
    motion: Kinematics,
    composite_roughness: float,
) -> Array:
    """Friction coefficient of every touching pair from the films at the positions."""
    path = solved.path
    found = np.zeros(path.zone.size)
    samples = _samples(np.abs(motion.sliding_speed), path.zone, path.places.zones)
    coefficient = _asked(law, options, solved, samples, composite_roughness)
    first = 0
    for number, (part, speeds) in enumerate(zip(path.places.zones, samples, strict=True)):
        here = path.zone == number
        size = (part.stop - part.start, speeds.size)
        values = coefficient[first : first + size[0] * size[1]].reshape(size)
        first += values.size
        scaled = np.arcsinh(np.abs(motion.sliding_speed[here]) / _SLOW)
        over_speed = lobatto_polynomial(np.arcsinh(speeds / _SLOW), scaled)
        along = lobatto_polynomial(path.places.age[part], path.touching.age[here])
        found[here] = np.einsum("kp,ks,ps->k", along, over_speed, values)
    return np.maximum(found, 0.0)


def _samples(speed: Array, zone: Index, zones: tuple[slice, ...]) -> list[Array]:
    """Sliding speeds of each zone [m/s], dense near zero, from its least to its greatest."""
    found = []
    for number in range(len(zones)):
        ends = np.arcsinh(np.array([f(speed[zone == number]) for f in (np.min, np.max)]) / _SLOW)
        count = max(_LEAST, int(np.ceil(_DENSITY * (ends[1] - ends[0]))) + 1)
        inner = ends.mean() + 0.5 * (ends[1] - ends[0]) * lobatto_points(count)
        found.append(_SLOW * np.sinh(inner))
    return found


def _asked(
    law: str,
    options: Mapping[str, Any],
    solved: SolvedPath,
    samples: list[Array],
    composite_roughness: float,
) -> Array:
    """Ask the law for all sliding speeds of all positions at once, in the order of the zones."""
    zones = solved.path.places.zones
    index = np.concatenate(
        [
            np.repeat(np.arange(part.start, part.stop), speeds.size)
            for part, speeds in zip(zones, samples, strict=True)
        ]
    )
    speed = np.concatenate(
        [
            np.tile(speeds, part.stop - part.start)
            for part, speeds in zip(zones, samples, strict=True)
        ]
    )
    places = solved.path.solved
    load, radius = solved.load_per_width[index], places.equivalent_radius[index]
    entrainment = places.entrainment_speed[index]
    speed = np.minimum(speed, _MOST_SLIDING * entrainment)
    contact = TribologicalContact(
        load_per_width=load,
        hertz_pressure=hertz_line(load, radius, places.effective_modulus).maximum_pressure,
        sliding_speed=speed,
        entrainment_speed=entrainment,
        slide_to_roll_ratio=speed / entrainment,
        equivalent_radius=radius,
        dynamic_viscosity=places.lubricant.dynamic_viscosity,
        composite_roughness=composite_roughness,
        film=FilmState.from_solutions(solved.films.solutions, index),
    )
    return LAWS[law](contact, **options)
