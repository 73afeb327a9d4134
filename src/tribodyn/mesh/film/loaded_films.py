"""Films that were solved for some loads, and follow loads nearby."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.ehl.steady.batch import Films
from tribodyn.mesh.cycle import PairsInContact
from tribodyn.mesh.film.film_refinement import RIGID, PathLoads
from tribodyn.types import Array, Mask


@dataclass(frozen=True, eq=False)
class LoadedFilms:
    """Films of all contacts under solved loads; their scales tell what other loads would do."""

    pairs: PairsInContact  #: contacts of the mesh table
    keeps_distance: bool  #: whether each film is a spring about the distance that it keeps
    factors: Array  #: films and pressure (3, n) over their scales
    yielding: Array  #: compliance of the films over its scale
    doubtful: Mask  #: quantities (4, contacts) that may be further from a solution than promised
    loads: PathLoads  #: loads that the films were solved for

    @property
    @abstractmethod
    def distance_factors(self) -> Array:
        """Distance under the solved loads, over the scale of films."""

    @property
    def scored(self) -> Mask:
        """Contacts that carry enough for a film of their own."""
        return self.loads.scored

    @property
    def rigid_share(self) -> float:
        """Part of the contacts whose film does not fall with the load."""
        return float(np.mean(self.yielding[self.scored] < RIGID))

    @cached_property
    def _distance(self) -> tuple[Array, Array]:
        """Distance under the solved loads, and the power of the load by which it falls."""
        film = self.pairs.scales(self.loads.of_contacts)["central_film"]
        factors = self.distance_factors
        return film * factors, np.clip(self.yielding / factors, RIGID, 1.0)

    def __call__(self, load_per_width: Array) -> Films:
        """Films of all contacts of the mesh table."""
        *scales, stiffness = self.pairs.scales(load_per_width).values()
        central, minimum, pressure = np.stack(scales) * self.factors
        if not self.keeps_distance:
            film_stiffness = stiffness / np.maximum(self.yielding, RIGID)
            return Films(central, minimum, pressure, film_stiffness)
        solved, power = self._distance
        distance = solved * (load_per_width / self.loads.of_contacts) ** -power
        film_stiffness = self.pairs.common_face_width * load_per_width / (power * distance)
        return Films(central, minimum, pressure, film_stiffness, film_distance=distance)

    def reported(self, films: Films, load: Array) -> tuple[Films, Mask]:
        """Films as they are reported, and which quantities of them are known."""
        return films, ~self.doubtful
