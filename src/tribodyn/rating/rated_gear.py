"""What a rating needs of a gear beyond its geometry: material, accuracy, roughness, loads."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.gear import CylindricalGear
from tribodyn.rating.materials import GearMaterial
from tribodyn.rating.tolerances import Deviations, gear_tolerances

#: Accuracy grade that is assumed where neither a grade nor deviations are stated.
ASSUMED_GRADE = 6


@dataclass(frozen=True, kw_only=True)
class ShaperCutter:
    """Gear-shaped cutter that made a gear; its addendum is the dedendum of the gear's rack.

    Parameters
    ----------
    teeth : int
        Number of teeth z_0.
    profile_shift_coefficient : float
        x_0, of the state of the cutter.
    tip_radius_coefficient : float
        Radius of its tip round over the module.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> ShaperCutter(teeth=25, tip_radius_coefficient=0.2).teeth
    25
    """

    teeth: int
    profile_shift_coefficient: float = 0.0
    tip_radius_coefficient: float = 0.2

    def __post_init__(self) -> None:
        require_between("teeth", self.teeth, 5, 500)
        require_between("profile_shift_coefficient", self.profile_shift_coefficient, -2.0, 2.0)
        require_between("tip_radius_coefficient", self.tip_radius_coefficient, 0.0, 1.0)


@dataclass(frozen=True, kw_only=True)
class RatedGear:
    """Data of one gear for its rating.

    Parameters
    ----------
    material : GearMaterial
        Strength and elastic constants.
    accuracy_grade : int, optional
        Grade of ISO 1328-1; 6 is assumed where deviations are missing too.
    tolerance_edition : int
        Edition of ISO 1328-1, 1995 or 2013.
    pitch_deviation, profile_deviation, helix_deviation : float, optional
        f_pt, f_fa and f_Hb [m]; by default the tolerances of the grade.
    flank_roughness : float
        Rz of the flank [m].
    root_roughness : float
        Rz of the root [m].
    arithmetic_roughness : float, optional
        Ra of the flank [m]; a sixth of Rz by default.
    cutter : ShaperCutter, optional
        Cutter that made the root; by default the gear's basic rack, of a ring the arc of its tip.
    load_cycles : float, optional
        Number of load cycles N, pure number; by default from the required life.
    meshes_per_turn : int
        Load cycles of a flank per turn: meshes of the gear that load the same flank.
    structure_factor : float, optional
        X_W of scuffing: 1 for normal steel (default), 1.5 nitrided (default of NT, NV), 1.25
        phosphated, 1.15 and 0.85 for little and much austenite, 0.45 austenitic.
    micropitting_factor : float, optional
        W_W of micropitting: 1 carburized, 0.95 with more than 25 % austenite, 1.5 nitrided,
        0.65 induction-hardened, 0.5 through-hardened, by default by the type of material.
    running_in : float
        Degree of running-in of the flank, pure number from 0 (new) to 1.
    stress_ratio : float
        Least over greatest root stress R, pure number: 0 for pulsating load, -1.2 for an idler.
    inertia_share : float
        Part of its inertia that moves with one mesh, for K_v, pure number: 1/p for the sun of p
        planets, infinity for a ring that does not turn.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> RatedGear(accuracy_grade=5, load_cycles=1e8).material.kind
    'Eh'
    """

    material: GearMaterial = field(default_factory=GearMaterial)
    accuracy_grade: int | None = None
    tolerance_edition: int = 1995
    pitch_deviation: float | None = None
    profile_deviation: float | None = None
    helix_deviation: float | None = None
    flank_roughness: float = 4e-6
    root_roughness: float = 16e-6
    arithmetic_roughness: float | None = None
    cutter: ShaperCutter | None = None
    load_cycles: float | None = None
    meshes_per_turn: int = 1
    structure_factor: float | None = None
    micropitting_factor: float | None = None
    running_in: float = 1.0
    stress_ratio: float = 0.0
    inertia_share: float = 1.0

    def __post_init__(self) -> None:
        for name in ("pitch_deviation", "profile_deviation", "helix_deviation"):
            if (deviation := getattr(self, name)) is not None:
                require_between(name, deviation, 0.0, 1e-3, "m")
        for name in ("flank_roughness", "root_roughness", "arithmetic_roughness"):
            if getattr(self, name) is not None:
                require_between(name, getattr(self, name), 1e-9, 1e-3, "m")
        if self.load_cycles is not None:
            require_positive("load_cycles", self.load_cycles)
        require_between("meshes_per_turn", self.meshes_per_turn, 1, 100)
        require_between("running_in", self.running_in, 0.0, 1.0)
        for name in ("structure_factor", "micropitting_factor"):
            if getattr(self, name) is not None:
                require_between(name, getattr(self, name), 0.1, 3.0)
        require_between("stress_ratio", self.stress_ratio, -2.0, 1.0 - 1e-9)
        if self.inertia_share != math.inf:
            require_between("inertia_share", self.inertia_share, 1e-3, 1e3)

    @property
    def roughness_ra(self) -> float:
        """Ra of the flank [m]."""
        ra = self.arithmetic_roughness
        return self.flank_roughness / 6.0 if ra is None else ra

    @property
    def grade_text(self) -> str:
        """Where the deviations come from."""
        if self.accuracy_grade is not None:
            memory = " from memory" if self.tolerance_edition == 2013 else ""
            return f"grade {self.accuracy_grade} of ISO 1328-1:{self.tolerance_edition}{memory}"
        return f"grade {ASSUMED_GRADE} assumed" if None in self._stated else "stated"

    @property
    def _stated(self) -> tuple[float | None, float | None, float | None]:
        return self.pitch_deviation, self.profile_deviation, self.helix_deviation

    @property
    def grade(self) -> int | None:
        """Accuracy grade; None where only deviations are stated."""
        assumed = ASSUMED_GRADE if None in self._stated else None
        return assumed if self.accuracy_grade is None else self.accuracy_grade

    def deviations(self, gear: CylindricalGear) -> Deviations:
        """Return the deviations of a gear: those stated, else the tolerances of its grade.

        Parameters
        ----------
        gear : CylindricalGear
            The gear.
        """
        tolerances: Deviations | tuple[float, ...] = (0.0, 0.0, 0.0)
        if None in self._stated:
            tolerances = gear_tolerances(gear, self.grade or 0, self.tolerance_edition)
        pairs = zip(self._stated, tolerances, strict=True)
        return Deviations(*(limit if stated is None else stated for stated, limit in pairs))


@dataclass(frozen=True, kw_only=True)
class PinionShaft:
    """Shaft of the pinion between its bearings, for the deflection in the mesh.

    Parameters
    ----------
    bearing_span : float [m]
        l, between the bearings.
    offset : float [m]
        s, of the pinion from the middle of the span.
    diameter : float [m]
        d_sh of the shaft.
    arrangement : str
        ``a`` to ``e``: pinion between the bearings on the side of the output (a) or the input (b),
        overhung (c), in the middle of a train between the bearings (d, e), as drawn in the source.

    Raises
    ------
    InputError
        If a value is out of range, or s/l is 0.3 or more.

    Examples
    --------
    >>> PinionShaft(bearing_span=0.2, offset=0.02, diameter=0.04).arrangement
    'a'
    """

    bearing_span: float
    offset: float
    diameter: float
    arrangement: str = "a"

    def __post_init__(self) -> None:
        require_positive("bearing_span", self.bearing_span, "m")
        require_positive("diameter", self.diameter, "m")
        require_between("offset", self.offset, 0.0, self.bearing_span, "m")
        if self.arrangement not in SHAFT_FACTORS:
            what, why = f'arrangement = "{self.arrangement}"', f"Known: {', '.join(SHAFT_FACTORS)}"
            raise InputError(what, Argument("arrangement"), why, "Choose one of these")
        if self.offset >= 0.3 * self.bearing_span:
            raise InputError(
                f"offset = {self.offset * 1e3:g} mm",
                Argument("offset"),
                "The formula of f_sh holds for s/l below 0.3, here below "
                f"{300.0 * self.bearing_span:g} mm",
                "Give shaft_deflection, or the factor K_Hbeta from a computed load distribution",
            )


#: K' by arrangement: with stiffening by the pinion (d_1/d_sh of 1.15 and more), without.
SHAFT_FACTORS = {
    "a": (0.48, 0.8), "b": (-0.48, -0.8), "c": (1.33, 1.33), "d": (-0.36, -0.6), "e": (-0.6, -1.0),
}  # fmt: skip
