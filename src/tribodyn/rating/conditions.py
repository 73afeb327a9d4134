"""Conditions of a rating: loads from outside, life, edition of the standard, design of leads."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final

from tribodyn.errors import (
    Argument,
    InputError,
    did_you_mean,
    require_between,
    require_one_of,
    require_positive,
)
from tribodyn.rating.rated_gear import PinionShaft
from tribodyn.types import Tree

#: Editions of ISO 6336 that are computed.
EDITIONS: Final = (2006, 2019)
#: B_1, B_2 by the design of the lead.
LEADS: Final = {
    "none": (1.0, 1.0), "crowning": (1.0, 0.5), "full crowning": (0.5, 0.5),
    "helix correction": (0.1, 1.0), "helix correction and crowning": (0.1, 0.5),
    "end relief": (0.7, 0.7),
}  # fmt: skip
#: f_ZCa of helical pairs by how the profile relief was designed.
RELIEF_DESIGNS: Final = {"none": 1.2, "experience": 1.07, "contact analysis": 1.0}


@dataclass(frozen=True, kw_only=True)
class RatingConditions:
    """Conditions under which a gear pair is rated.

    Parameters
    ----------
    application_factor : float
        K_A; 1 where the torque comes from a spectrum or a simulation.
    mesh_load_factor : float
        K_gamma, greatest load of a branch over the mean.
    required_life : float, optional
        Required running time [s]; without one the endurance limits count.
    edition : int
        Edition of ISO 6336: 2019 or 2006.
    long_life_factor : float
        Z_NT and Y_NT at 1e10 load cycles, 0.85 to 1.
    some_pitting : bool
        Whether some pitting is allowed.
    lead : str, optional
        Design of the lead: ``none``, ``crowning`` (half of the manufacturing deviation), ``full
        crowning`` (that of the deflection too), ``helix correction``, ``helix correction and
        crowning``, ``end relief``; by default from the flanks of the pair.
    relief_design : str, optional
        How the profile relief was designed: ``none``, ``experience``, ``contact analysis``; by
        default from the flanks of the pair.
    contact_pattern_proven : bool
        Whether a favourable contact pattern was proven.
    shaft : PinionShaft, optional
        Shaft of the pinion; by default the pinion is in the middle between its bearings.
    shaft_deflection : float, optional
        f_sh [m] that replaces the computed one.
    power_share : float
        Share of the power in this mesh, of a pinion with several meshes; pure number.
    pitting_safety, bending_safety : float
        Required safeties S_H,min and S_F,min, pure numbers.
    scuffing_safety, micropitting_safety : float
        Required safeties against scuffing and micropitting, pure numbers.

    Raises
    ------
    InputError
        If a value is out of range or a name is unknown.

    Examples
    --------
    >>> RatingConditions(application_factor=1.25).edition
    2019
    """

    application_factor: float = 1.0
    mesh_load_factor: float = 1.0
    required_life: float | None = None
    edition: int = 2019
    long_life_factor: float = 0.85
    some_pitting: bool = False
    lead: str | None = None
    relief_design: str | None = None
    contact_pattern_proven: bool = False
    shaft: PinionShaft | None = None
    shaft_deflection: float | None = None
    power_share: float = 1.0
    pitting_safety: float = 1.0
    bending_safety: float = 1.4
    scuffing_safety: float = 1.5
    micropitting_safety: float = 1.0

    def __post_init__(self) -> None:
        require_between("application_factor", self.application_factor, 0.1, 10.0)
        require_between("mesh_load_factor", self.mesh_load_factor, 1.0, 10.0)
        require_between("long_life_factor", self.long_life_factor, 0.85, 1.0)
        require_between("power_share", self.power_share, 0.01, 1.0)
        if self.required_life is not None:
            require_positive("required_life", self.required_life, "s")
        if self.shaft_deflection is not None:
            require_between("shaft_deflection", self.shaft_deflection, 0.0, 1e-2, "m")
        if self.edition not in EDITIONS:
            why = f"Known: {', '.join(map(str, EDITIONS))}"
            remedy = "Choose one of these"
            raise InputError(f"edition = {self.edition}", Argument("edition"), why, remedy)
        if self.lead is not None:
            require_one_of("lead", self.lead, LEADS)
        if self.relief_design is not None:
            require_one_of("relief_design", self.relief_design, RELIEF_DESIGNS)
        for kind in ("pitting", "bending", "scuffing", "micropitting"):
            require_positive(f"{kind}_safety", getattr(self, f"{kind}_safety"))


def rating_conditions(values: Tree) -> RatingConditions:
    """Conditions from keyword arguments, with a message for an unknown name."""
    names = [field.name for field in fields(RatingConditions)]
    for name in values:
        if name not in names:
            why = f"Conditions of a rating: {', '.join(names)}"
            remedy = did_you_mean(name, names, "Use one of these names")
            raise InputError(f'unknown argument "{name}"', Argument(name), why, remedy)
    return RatingConditions(**values)
