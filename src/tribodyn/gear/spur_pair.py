"""Two spur gears in mesh."""

from __future__ import annotations

from dataclasses import dataclass

from tribodyn.errors import InputError, warn
from tribodyn.gear.mesh_geometry import MeshGeometry
from tribodyn.gear.modification_checks import modification_pair_problems
from tribodyn.gear.pair_checks import match_problems, mesh_problems, mesh_warnings
from tribodyn.gear.spur_gear import SpurGear


@dataclass(frozen=True)
class SpurPair(MeshGeometry):
    """External spur gear pair: two gears, the distance of their axes, and which one drives.

    Parameters
    ----------
    pinion : SpurGear
        Gear with the smaller (or equal) number of teeth.
    wheel : SpurGear
        Gear with the larger number of teeth, of the same module and pressure angle.
    center_distance : float
        Distance of the axes [m].
    driver : str
        ``"pinion"`` or ``"wheel"``.
    misalignment : float
        Difference of the gap over the common face width [m] that the position of the axes makes;
        positive where the gap is wider at positive ``face_position``.

    Raises
    ------
    InputError
        Listing every reason why the two gears cannot run together, or why a modification does not
        fit the flank that is used.

    Warns
    -----
    ModelWarning
        ``undercut`` when a gear is undercut below its used flank, which runs but is weaker;
        ``flank-interference-rounding`` when rounded shift coefficients leave a negative play
        of more than 0.0005 modules.

    Notes
    -----
    Source: ISO 21771, cylindrical gear pairs. Positions on the line of action are called
    ``path``: the distance from the pinion's base tangent point, whichever gear drives.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> pair
    SpurPair(z 20/30, m 4 mm, a 100 mm, contact ratio 1.605, pinion drives)
    """

    pinion: SpurGear
    wheel: SpurGear
    center_distance: float
    driver: str = "pinion"
    misalignment: float = 0.0

    def __post_init__(self) -> None:
        problems = match_problems(self.pinion, self.wheel, self.driver) or mesh_problems(self)
        problems = problems or modification_pair_problems(self)
        if problems:
            raise InputError(problems)
        for code, message in mesh_warnings(self):
            warn(code, message, stacklevel=3)

    def __repr__(self) -> str:
        """One line with units."""
        return (
            f"SpurPair(z {self.pinion.teeth}/{self.wheel.teeth}, "
            f"m {self.pinion.normal_module * 1e3:g} mm, a {self.center_distance * 1e3:g} mm, "
            f"contact ratio {self.transverse_contact_ratio:.4g}, {self.driver} drives)"
        )

    @property
    def driving(self) -> SpurGear:
        """The gear that drives."""
        return self.pinion if self.driver == "pinion" else self.wheel

    @property
    def driven(self) -> SpurGear:
        """The gear that is driven."""
        return self.wheel if self.driver == "pinion" else self.pinion

    @property
    def common_face_width(self) -> float:
        """Face width in contact [m]."""
        return min(self.pinion.face_width, self.wheel.face_width)

    @property
    def has_profile_modification(self) -> bool:
        """Whether the gap of a flank changes over its profile."""
        return any(gear.modification.changes_profile for gear in (self.pinion, self.wheel))

    @property
    def has_lead_modification(self) -> bool:
        """Whether the gap changes over the face width."""
        leads = any(gear.modification.changes_lead for gear in (self.pinion, self.wheel))
        return leads or self.misalignment != 0.0

    @property
    def has_pitch_deviation(self) -> bool:
        """Whether tooth pairs differ by the places of their teeth."""
        return any(gear.modification.changes_pitch for gear in (self.pinion, self.wheel))

    @property
    def has_run_out(self) -> bool:
        """Whether a gear turns about an axis that is not its own."""
        return any(gear.modification.run_out != 0.0 for gear in (self.pinion, self.wheel))

    @property
    def teeth_differ(self) -> bool:
        """Whether one mesh cycle differs from the next."""
        return self.has_pitch_deviation or self.has_run_out

    @property
    def has_modification(self) -> bool:
        """Whether anything makes the flanks differ from involutes in their places."""
        shape = self.has_profile_modification or self.has_lead_modification
        return shape or self.teeth_differ
