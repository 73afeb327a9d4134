"""Dimensionless groups of a line contact: of Dowson and Higginson, and of Moes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_positive
from tribodyn.types import Array


class Groups(NamedTuple):
    """Groups of an isothermal line contact, and the radius that scales the film.

    Parameters
    ----------
    speed : array
        ``U = eta0 u_e / (E' R)`` with the mean entrainment speed, a pure number.
    material : array [1]
        ``G = alpha E'``.
    load : array [1]
        ``W = w / (E' R)``.
    equivalent_radius : array [m]
        Film thickness over dimensionless film ``H = h/R``.
    """

    speed: Array
    material: Array
    load: Array
    equivalent_radius: Array

    @property
    def moes_load(self) -> Array:
        """Load number of Moes, ``M = W (2 U)^(-1/2)``."""
        return np.asarray(self.load / np.sqrt(2.0 * self.speed))

    @property
    def moes_material(self) -> Array:
        """Material number of Moes, ``L = G (2 U)^(1/4)``."""
        return np.asarray(self.material * (2.0 * self.speed) ** 0.25)

    @property
    def moes_film_unit(self) -> Array:
        """Film [m] at ``H_Moes = (h/R) (2 U)^(-1/2) = 1``."""
        return np.asarray(self.equivalent_radius * np.sqrt(2.0 * self.speed))


def line_contact_groups(
    load_per_width: ArrayLike,
    equivalent_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    pressure_viscosity_coefficient: ArrayLike,
    effective_modulus: ArrayLike,
) -> Groups:
    """Dimensionless groups of a line contact, from checked SI values.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Normal load per face width.
    equivalent_radius : float or array [m]
        Reduced radius of curvature.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure.
    pressure_viscosity_coefficient : float or array [1/Pa]
        Slope of ln(viscosity) over pressure.
    effective_modulus : float or array [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.

    Returns
    -------
    Groups
        Arrays of the common shape of the arguments.

    Raises
    ------
    InputError
        If any value is not finite and positive.

    Valid for any line contact. Source: Dowson and Higginson (1966); Moes (1965).

    Examples
    --------
    >>> groups = line_contact_groups(49267.5, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11)
    >>> round(float(groups.moes_load), 3), round(float(groups.moes_material), 2)
    (1.654, 19.82)
    """
    require_positive("load_per_width", load_per_width, "N/m", remedy="1 N/mm is 1000 N/m")
    require_positive("equivalent_radius", equivalent_radius, "m")
    require_positive(
        "entrainment_speed",
        entrainment_speed,
        "m/s",
        remedy="A film needs a rolling motion: give half the sum of the surface speeds",
    )
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    require_positive("pressure_viscosity_coefficient", pressure_viscosity_coefficient, "1/Pa")
    require_positive("effective_modulus", effective_modulus, "Pa")
    load, radius, speed, viscosity, coefficient, modulus = np.broadcast_arrays(
        load_per_width,
        equivalent_radius,
        entrainment_speed,
        dynamic_viscosity,
        pressure_viscosity_coefficient,
        effective_modulus,
    )
    stiffness = modulus * radius
    return Groups(
        speed=np.asarray(viscosity * speed / stiffness),
        material=np.asarray(coefficient * modulus),
        load=np.asarray(load / stiffness),
        equivalent_radius=radius,
    )
