"""Films over the whole flank of a tooth pair, for many torques and speeds."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tribodyn.contact import hertz_line
from tribodyn.contact.face_contacts import SLICES, face_positions
from tribodyn.mesh.build import teeth_under_load
from tribodyn.mesh.cycle import pairs_in_contact
from tribodyn.mesh.face.lines import along_flank
from tribodyn.mesh.film.film_columns import as_columns
from tribodyn.mesh.film.film_lookup import look_up_slices
from tribodyn.mesh.film.path_film import film_of
from tribodyn.mesh.gears import Gears
from tribodyn.mesh.loads import reported_films, under_load
from tribodyn.mesh.sharing import ToothContact
from tribodyn.progress import Progress
from tribodyn.types import Array


def films_over_flank(
    pair: Gears, settings: ToothContact, torques: Array, speeds: Array, progress: Progress
) -> dict[str, Any]:
    """Films of all slices, one after the other, each at its places from entry to exit."""
    dry = replace(settings, film_model="none", film_options={})
    loads, films = list[Array](), list[list[dict[str, Array]]]()
    for torque in torques.tolist():
        cycle, teeth = teeth_under_load(pair, settings, torque, None, None)
        number = np.zeros(cycle.in_contact.shape, dtype=np.int64)
        number[cycle.in_contact] = np.arange(np.count_nonzero(cycle.in_contact))
        order = along_flank(number, cycle.in_contact, SLICES)
        films.append([])
        for speed in speeds.tolist():
            motion = cycle.motion(speed)
            pairs = pairs_in_contact(cycle, motion, settings.lubricant, settings.material)
            film = look_up_slices(settings, cycle, teeth, pairs) or film_of(
                settings, cycle, teeth, pairs, speed, progress
            )
            shared = under_load(teeth, dry, film, cycle.named)
            solved = reported_films(shared.film_at(shared.tribological), shared, teeth.least_load)
            columns = as_columns(solved, settings.composite_roughness)
            films[-1].append({name: column[order] for name, column in columns.items()})
        loads.append(shared.tribological[order])
    motion, load = cycle.motion(speeds[:, None]), np.array(loads)
    radius = getattr(motion, f"{pair.driver}_curvature_radius")[0]
    modulus, reduced = pairs.effective_modulus, motion.equivalent_radius[0][order]
    positions = np.tile(face_positions(cycle.contact, SLICES), cycle.path.shape[1] // SLICES)
    face = np.broadcast_to(positions, cycle.path.shape)
    return {
        "path": along_flank(cycle.path, cycle.in_contact, SLICES),
        "face_position": along_flank(face, cycle.in_contact, SLICES),
        "roll_angle": radius[order] / pair.driving.base_radius,
        "load_per_width": load,
        "hertz_pressure": hertz_line(load, reduced, modulus).maximum_pressure,
        "entrainment_speed": motion.entrainment_speed[:, order],
        **{n: np.array([[point[n] for point in row] for row in films]) for n in films[0][0]},
    }
