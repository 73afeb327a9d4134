"""The basic rack: the straight-sided profile whose rolling generates both flank and fillet."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tribodyn.errors import Argument, InputError, Problem


@dataclass(frozen=True)
class BasicRack:
    """Basic rack tooth profile; the defaults are profile A of ISO 53.

    Parameters
    ----------
    addendum_coefficient : float
        Addendum divided by the module.
    dedendum_coefficient : float
        Dedendum divided by the module: the depth to which the generating rack cuts.
    tip_radius_coefficient : float
        Tip radius of the generating rack divided by the module.

    Raises
    ------
    InputError
        If a coefficient is not finite, the addendum or dedendum is not positive, or the tip
        radius is negative.

    Examples
    --------
    >>> round(BasicRack().largest_tip_radius_coefficient(math.radians(20.0)), 4)
    0.4719
    """

    addendum_coefficient: float = 1.0
    dedendum_coefficient: float = 1.25
    tip_radius_coefficient: float = 0.38

    def __post_init__(self) -> None:
        limits = {
            "addendum_coefficient": (self.addendum_coefficient, False),
            "dedendum_coefficient": (self.dedendum_coefficient, False),
            "tip_radius_coefficient": (self.tip_radius_coefficient, True),
        }
        problems = [
            Problem(
                what=f"{name} = {value:.6g}",
                where=Argument(name),
                why="It must be finite and " + ("not negative" if zero else "greater than zero"),
                remedy="ISO 53 profile A has 1.0, 1.25 and 0.38",
            )
            for name, (value, zero) in limits.items()
            if not math.isfinite(value) or value < 0.0 or (value == 0.0 and not zero)
        ]
        if problems:
            raise InputError(problems)

    def tip_half_width_coefficient(self, pressure_angle: float) -> float:
        """Half width of the sharp rack tooth at its tip line, over the module.

        Parameters
        ----------
        pressure_angle : float
            Pressure angle of the rack [rad].

        Returns
        -------
        float
            pi/4 - h_fP* tan(alpha); not positive when the flanks meet before the tip line.
        """
        return math.pi / 4.0 - self.dedendum_coefficient * math.tan(pressure_angle)

    def largest_tip_radius_coefficient(self, pressure_angle: float) -> float:
        """Tip radius over the module at which the rack tip is one full round.

        Parameters
        ----------
        pressure_angle : float
            Pressure angle of the rack [rad].

        Returns
        -------
        float
            Radius of the circle that touches both flanks and the tip line, over the module.
        """
        width = self.tip_half_width_coefficient(pressure_angle)
        return width * math.cos(pressure_angle) / (1.0 - math.sin(pressure_angle))

    def fitting_tip_radius_coefficient(self, pressure_angle: float) -> float:
        """Tip radius over the module that is cut: the given one, or the full round if smaller.

        Parameters
        ----------
        pressure_angle : float
            Pressure angle of the rack [rad].

        Returns
        -------
        float
            Smaller one of the given and the largest tip radius coefficient.
        """
        largest = self.largest_tip_radius_coefficient(pressure_angle)
        return min(self.tip_radius_coefficient, largest)

    def shape_problems(self, pressure_angle: float) -> list[Problem]:
        """Find why a rack of this pressure angle has no tip line, or no flank below its round.

        Parameters
        ----------
        pressure_angle : float
            Pressure angle of the rack [rad].

        Returns
        -------
        list of Problem
        """
        if self.tip_half_width_coefficient(pressure_angle) <= 0.0:
            limit = math.pi / 4.0 / math.tan(pressure_angle)
            return [
                Problem(
                    what=f"dedendum_coefficient = {self.dedendum_coefficient:.6g}",
                    where=Argument("rack"),
                    why=f"The flanks of the rack meet at a depth of {limit:.6g} modules",
                    remedy="Reduce the dedendum or the pressure angle",
                )
            ]
        height = self.fitting_tip_radius_coefficient(pressure_angle) * (
            1.0 - math.sin(pressure_angle)
        )
        if height <= self.dedendum_coefficient:
            return []
        return [
            Problem(
                what=f"tip_radius_coefficient = {self.tip_radius_coefficient:.6g}",
                where=Argument("rack"),
                why=f"The tip round is {height:.6g} modules high, more than the dedendum "
                f"of {self.dedendum_coefficient:.6g} modules",
                remedy="Reduce the tip radius",
            )
        ]
