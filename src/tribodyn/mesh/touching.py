"""Touching tooth pairs as the film sees them: radius, speed, oil and width, without their load."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.contact import Kinematics, effective_modulus, hertz_line
from tribodyn.ehl import FILM_MODELS, moes_central
from tribodyn.ehl.solved_films import Films
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.cycle import MeshCycle

__all__ = ["Touching", "touching_pairs"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Touching:
    """Pairs in contact without their load, as arrays of one shape.

    Parameters
    ----------
    age : array
        Mesh cycles since the pair entered contact.
    equivalent_radius : array [m]
        Reduced radius of curvature.
    entrainment_speed : array [m/s]
        HALF the sum of the surface speeds.
    lubricant : Lubricant
        Oil at working temperature.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    common_face_width : float [m]
        Length of the contact line.
    """

    age: FloatArray
    equivalent_radius: FloatArray
    entrainment_speed: FloatArray
    lubricant: Lubricant
    effective_modulus: float
    common_face_width: float

    def films(self, model: str, load_per_width: FloatArray, **options: Any) -> Films:
        """Films of every one of these contacts.

        Parameters
        ----------
        model : str
            Name in ``tribodyn.ehl.FILM_MODELS``.
        load_per_width : array [N/m]
            Their loads.
        **options : object
            Options of the model.

        Returns
        -------
        Films
        """
        return FILM_MODELS[model].films(
            load_per_width,
            self.equivalent_radius,
            self.entrainment_speed,
            self.lubricant,
            self.effective_modulus,
            length=self.common_face_width,
            **options,
        )

    def scales(self, load_per_width: FloatArray) -> dict[str, FloatArray]:
        """Estimates of the films that are right in every regime, but for a factor that is smooth.

        Parameters
        ----------
        load_per_width : array [N/m]
            Their loads.

        Returns
        -------
        dict of str to array
            One for each array of :class:`tribodyn.ehl.solved_films.Films`.
        """
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
    """Gather what the films of the touching pairs depend on, their loads excepted.

    Parameters
    ----------
    cycle : MeshCycle
        Places of the pairs.
    motion : Kinematics
        Curvatures and speeds of the touching ones.
    lubricant : Lubricant
        Oil at working temperature.
    material : Material
        Material of both gears.

    Returns
    -------
    Touching
    """
    return Touching(
        age=cycle.age,
        equivalent_radius=motion.equivalent_radius,
        entrainment_speed=motion.entrainment_speed,
        lubricant=lubricant,
        effective_modulus=effective_modulus(material, material),
        common_face_width=cycle.contact.pair.common_face_width,
    )
