"""Two cylindrical gears in mesh, with checks that they can run and that modifications fit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

from tribodyn.errors import InputError
from tribodyn.gear.contact_lines import FaceGeometry
from tribodyn.gear.cylindrical_gear import CylindricalGear
from tribodyn.gear.pair_checks import (
    fit_problems,
    match_problems,
    mesh_problems,
    misalignment_problems,
    warn_of_limits,
)
from tribodyn.types import Array

_Path = TypeVar("_Path", float, Array)


@dataclass(frozen=True)
class CylindricalPair(FaceGeometry):
    """Cylindrical gear pair, spur or helical, external or internal: gears, distance and driver.

    Parameters
    ----------
    pinion, wheel : CylindricalGear
        The gear with the smaller or equal number of teeth, and the other or the ring, of the same
        module, pressure angle and helix angle.
    center_distance : float
        Distance of the axes [m], positive.
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
    ``path``: the distance from the pinion's base tangent point, whichever gear drives. For an
    internal pair the signs of ISO 21771 hold: ``ratio``, ``line_of_action_length`` and radii of
    curvature of the ring are negative. :class:`SpurPair` is another name of this class.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> pair
    SpurPair(z 20/30, m 4 mm, a 100 mm, contact ratio 1.605, pinion drives)
    """

    pinion: CylindricalGear
    wheel: CylindricalGear
    center_distance: float
    driver: str = "pinion"
    misalignment: float = 0.0

    def __post_init__(self) -> None:
        problems = match_problems(self.pinion, self.wheel, self.driver) or mesh_problems(self)
        problems = problems or [*misalignment_problems(self.misalignment), *fit_problems(self)]
        if problems:
            raise InputError(problems)
        warn_of_limits(self)

    def __repr__(self) -> str:
        """One line with units."""
        name, helix, overlap = "SpurPair", "", ""
        if self.helix_angle:
            name, overlap = "CylindricalPair", f" + {self.overlap_ratio:.4g}"
            helix = f"beta {math.degrees(self.helix_angle):g} deg, "
        return (
            f"{name}(z {self.pinion.teeth}/{self.wheel.teeth}, {helix}"
            f"m {self.pinion.normal_module * 1e3:g} mm, a {self.center_distance * 1e3:g} mm, "
            f"contact ratio {self.transverse_contact_ratio:.4g}{overlap}, {self.driver} drives)"
        )

    @cached_property
    def driving(self) -> CylindricalGear:
        """The gear that drives."""
        return self.pinion if self.driver == "pinion" else self.wheel

    def driving_radius(self, path: _Path) -> _Path:
        """Radius of curvature of the driving flank at positions on the line of action [m].

        Parameters
        ----------
        path : float or array
            Distance from the pinion's base tangent point [m].

        Returns
        -------
        float or array
            Distance from the base tangent point of the driving gear [m]; negative for a ring, and
            growing while the gears turn.
        """
        return path if self.driver == "pinion" else self.line_of_action_length - path

    @property
    def driven_gear(self) -> str:
        """Name of the driven gear."""
        return "wheel" if self.driver == "pinion" else "pinion"

    @cached_property
    def driven(self) -> CylindricalGear:
        """The gear that is driven."""
        return self.wheel if self.driver == "pinion" else self.pinion

    def entry_distance(self, face_position: _Path) -> _Path:
        """Distance across the face from the end that enters contact first.

        Parameters
        ----------
        face_position : float or array
            Position along the face from its middle [m], growing along the axis about which the
            pinion turns in the positive sense.

        Returns
        -------
        float or array
            Distance [m]: a right-hand pinion enters at the far end of that axis, a left-hand one
            at the near end, whichever gear drives.
        """
        sense = -1.0 if self.hand == "right" else 1.0
        return 0.5 * self.common_face_width + sense * face_position

    @cached_property
    def has_profile_modification(self) -> bool:
        """Whether the gap of a flank changes over its profile."""
        return any(gear.modification.changes_profile for gear in (self.pinion, self.wheel))

    @cached_property
    def has_lead_modification(self) -> bool:
        """Whether the gap changes over the face width."""
        leads = any(gear.modification.changes_lead for gear in (self.pinion, self.wheel))
        return leads or self.misalignment != 0.0

    @cached_property
    def has_pitch_deviation(self) -> bool:
        """Whether tooth pairs differ by pitch deviations."""
        return any(gear.modification.changes_pitch for gear in (self.pinion, self.wheel))

    @cached_property
    def has_run_out(self) -> bool:
        """Whether a gear turns about an axis that is not its own."""
        return any(gear.modification.run_out != 0.0 for gear in (self.pinion, self.wheel))

    @cached_property
    def teeth_differ(self) -> bool:
        """Whether one mesh cycle differs from the next."""
        return any(gear.modification.teeth_differ for gear in (self.pinion, self.wheel))

    @cached_property
    def has_modification(self) -> bool:
        """Whether the flanks differ from ideally placed involutes."""
        shape = self.has_profile_modification or self.has_lead_modification
        return shape or self.teeth_differ


SpurPair = CylindricalPair
