"""Touching tooth pairs as the film sees them: radius, speed, oil and width, without their load."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tribodyn.contact import Kinematics, effective_modulus, hertz_line
from tribodyn.ehl import FILM_MODELS, moes_central
from tribodyn.ehl.steady.solved_films import Films
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.cycle import MeshCycle
from tribodyn.types import Array, Index


@dataclass(frozen=True, eq=False)
class Touching:
    """Pairs in contact without their load, as arrays of one shape."""

    age: Array  #: mesh cycles since the pair entered contact
    equivalent_radius: Array  #: reduced radius of curvature [m]
    entrainment_speed: Array  #: HALF the sum of the surface speeds [m/s]
    lubricant: Lubricant  #: oil at working temperature
    effective_modulus: float  #: ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2`` [Pa]
    common_face_width: float  #: length of the contact line [m]

    def some(self, index: Index) -> Touching:
        """A part of these contacts."""
        return replace(
            self,
            age=self.age[index],
            equivalent_radius=self.equivalent_radius[index],
            entrainment_speed=self.entrainment_speed[index],
        )

    def joined(self, others: Touching) -> Touching:
        """These contacts and others of the same pair."""
        return replace(
            self,
            age=np.concatenate([self.age, others.age]),
            equivalent_radius=np.concatenate([self.equivalent_radius, others.equivalent_radius]),
            entrainment_speed=np.concatenate([self.entrainment_speed, others.entrainment_speed]),
        )

    def films(self, model: str, load_per_width: Array, **options: Any) -> Films:
        """Films of every one of these contacts."""
        return FILM_MODELS[model].films(
            load_per_width,
            self.equivalent_radius,
            self.entrainment_speed,
            self.lubricant,
            self.effective_modulus,
            length=self.common_face_width,
            **options,
        )

    def scales(self, load_per_width: Array) -> dict[str, Array]:
        """Estimates of the films, right in every regime but for a factor that is smooth."""
        arguments = (
            load_per_width, self.equivalent_radius, self.entrainment_speed,
            self.lubricant.dynamic_viscosity, self.lubricant.pressure_viscosity_coefficient,
            self.effective_modulus,
        )  # fmt: skip
        film = moes_central(*arguments)
        hertz = hertz_line(load_per_width, self.equivalent_radius, self.effective_modulus)
        return {
            "central_film": film,
            "minimum_film": film,
            "film_pressure": hertz.maximum_pressure,
            "film_stiffness": self.common_face_width * load_per_width / film,
        }


def touching_pairs(
    cycle: MeshCycle, motion: Kinematics, lubricant: Lubricant, material: Material
) -> Touching:
    """Gather what the films of the touching pairs depend on, their loads excepted."""
    return Touching(
        age=cycle.age,
        equivalent_radius=motion.equivalent_radius,
        entrainment_speed=motion.entrainment_speed,
        lubricant=lubricant,
        effective_modulus=effective_modulus(material, material),
        common_face_width=cycle.contact.pair.common_face_width,
    )
