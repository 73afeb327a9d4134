"""The material of a gear: elastic constants and density."""

from __future__ import annotations

from dataclasses import dataclass

from tribodyn.errors import require_between, require_positive


@dataclass(frozen=True)
class Material:
    """Isotropic linear elastic material; the defaults are case-hardening steel.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus [Pa].
    poissons_ratio : float
        Poisson's ratio, 0 to 0.499.
    density : float
        Density [kg/m^3].

    Raises
    ------
    InputError
        If a value is not finite, not positive or outside its limits.

    Examples
    --------
    >>> round(Material().shear_modulus / 1e9, 3)
    79.231
    """

    youngs_modulus: float = 206e9
    poissons_ratio: float = 0.3
    density: float = 7800.0

    def __post_init__(self) -> None:
        require_positive("youngs_modulus", self.youngs_modulus, "Pa")
        require_between("poissons_ratio", self.poissons_ratio, 0.0, 0.499)
        require_positive("density", self.density, "kg/m^3")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus E / (2 (1 + nu)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
