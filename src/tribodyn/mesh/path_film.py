"""The oil film of the touching pairs: by a formula everywhere, or solved at places on the path.

A solved film is known at some positions of the path of contact under the load that they carry.
What lies between them, and what a slightly other load would do, is told by the ratio of the
solution to a formula that covers all regimes: the ratio hardly changes along the path, while the
formula follows every change of load, radius and speed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tribodyn.contact import PathOfContact
from tribodyn.ehl.steady.solved_films import Films
from tribodyn.errors import quiet
from tribodyn.mesh.film_places import film_places
from tribodyn.mesh.film_refinement import PathLoads, Refinement
from tribodyn.mesh.grid import PhaseFunction, PhaseGrid
from tribodyn.mesh.positions import PathPositions, path_positions
from tribodyn.mesh.solved_places import (
    PRESSURE,
    RIGID,
    STIFFNESS,
    Memory,
    Places,
    places_of,
)
from tribodyn.mesh.touching import Touching
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, Index, Mask

#: Films of all touching pairs under the loads per width given.
FilmAt = Callable[[Array], Films]

#: Distance from an event that tells its two sides apart [mesh cycles].
_BESIDE = 1e-9


@dataclass(frozen=True, eq=False)
class PathFilm:
    """A solved film along the path of contact, as a function of the load of every contact."""

    model: str  #: name of the model in ``tribodyn.ehl.FILM_MODELS``
    options: Mapping[str, Any]  #: options of the model, with its defaults
    places: PathPositions  #: positions at which the film is solved
    first_angle: float  #: roll angle of the driving gear where a pair enters [rad]
    angle_per_cycle: float  #: and its change over a mesh cycle [rad]
    solved: Touching  #: the pair at these positions
    touching: Touching  #: contacts of the mesh table
    zone: Index  #: zone of each contact of the mesh table
    memory: Memory = field(default_factory=Memory)

    def load_of(self, grid: PhaseGrid, load_per_width: Array) -> Array:
        """Read the loads at the positions from those of a mesh table."""
        age = self.places.sided_age
        at = PhaseFunction(grid, load_per_width)(age)
        return np.asarray(at[np.arange(age.size), np.floor(age).astype(int)])

    def solve(
        self, loads: PathLoads, checked: tuple[int, ...] = (), progress: Progress = SILENT
    ) -> SolvedPath:
        """Solve the film at the positions, and beside them where checked quantities need it."""
        count, known = self.places.age.size, self.memory
        # A pass that checks no pressure does without the places that only the pressure needs.
        again = known.contacts if PRESSURE in checked else known.contacts[known.yielding]
        films, first = self._solve(
            self.solved.joined(self.touching.some(again)),
            np.concatenate([self.places.zone, self.zone[again]]),
            np.concatenate([loads.at_positions, loads.of_contacts[again]]),
            progress,
        )
        yielding = known.yielding if PRESSURE in checked else np.ones(again.size, dtype=bool)
        first.yielding[count:] = yielding
        refinement = Refinement(
            self.places, self.touching, self.zone, loads, known, first,
            lambda new: self._solve_more(new, loads, progress),
        )  # fmt: skip
        if checked:
            refinement.refine(checked)
        if PRESSURE in checked:
            refinement.solve_extremes()
        values = refinement.values(np.arange(self.zone.size))
        return SolvedPath(
            path=self,
            load_per_width=loads.at_positions,
            films=films,
            factors=np.exp(values[:STIFFNESS]),
            yielding=values[STIFFNESS],
            doubtful=refinement.doubtful,
            scored=loads.scored,
        )

    def _solve_more(self, contacts: Index, loads: PathLoads, progress: Progress) -> Places:
        touching, zone = self.touching.some(contacts), self.zone[contacts]
        with quiet("seed-film-stiffness"):
            # The positions have said it already.
            return self._solve(touching, zone, loads.of_contacts[contacts], progress)[1]

    def _solve(
        self, touching: Touching, zone: Index, loads: Array, progress: Progress
    ) -> tuple[Films, Places]:
        angles = self.first_angle + self.angle_per_cycle * touching.age
        with film_places(lambda index: f"at the roll angle {angles[index]:.4f} rad"):
            films = touching.films(self.model, loads, **self.options, progress=progress)
        return films, places_of(touching, zone, loads, films, np.ones(zone.size, dtype=bool))


@dataclass(frozen=True, eq=False)
class SolvedPath:
    """Films solved along the path of contact; called with loads it gives those of all contacts."""

    path: PathFilm  #: positions and contacts
    load_per_width: Array  #: load at each position [N/m]
    films: Films  #: films at the positions, then at contacts that were added
    factors: Array
    yielding: Array  #: compliance of their films over its scale
    doubtful: Mask  #: quantities (4, contacts) that may be further from a solution than promised
    scored: Mask  #: contacts that carry enough for a film of their own

    @property
    def rigid_share(self) -> float:
        """Part of the contacts whose film does not fall with the load."""
        return float(np.mean(self.yielding[self.scored] < RIGID))

    def __call__(self, load_per_width: Array) -> Films:
        """Films of all contacts of the mesh table."""
        *scales, stiffness = self.path.touching.scales(load_per_width).values()
        central, minimum, pressure = np.stack(scales) * self.factors
        film_stiffness = stiffness / np.maximum(self.yielding, RIGID)
        return Films(central, minimum, pressure, film_stiffness)


def path_film(
    model: str,
    options: Mapping[str, Any],
    contact: PathOfContact,
    pinion_speed: float,
    touching: Touching,
    side: Array,
    bends: tuple[float, ...] = (),
) -> PathFilm:
    """Choose the positions at which a solved film is computed."""
    places = path_positions(contact, options["positions"], bends)
    path = contact.A + contact.direction * places.age * contact.pair.base_pitch
    motion = contact.kinematics(path, pinion_speed)
    solved = replace(
        touching,
        age=places.age,
        equivalent_radius=motion.equivalent_radius,
        entrainment_speed=motion.entrainment_speed,
    )
    radius = getattr(motion, f"{contact.pair.driver}_curvature_radius")
    angle = radius / contact.pair.driving.base_radius
    return PathFilm(
        model=model,
        options=options,
        places=places,
        first_angle=float(angle[0]),
        angle_per_cycle=float((angle[-1] - angle[0]) / (places.age[-1] - places.age[0])),
        solved=solved,
        touching=touching,
        # On an event the side tells the zone; bends lie between the knots.
        zone=places.zone_of(touching.age + np.clip(side - touching.age, -_BESIDE, _BESIDE)),
    )
