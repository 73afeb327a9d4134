"""Sections of a shaft: cylinders and cones, solid or hollow."""

from __future__ import annotations

from dataclasses import dataclass

from tribodyn.errors import Argument, InputError
from tribodyn.gear import Material
from tribodyn.machine.fields import check_number, display

#: Steel of shafts and gear bodies.
STEEL = Material(206e9, 0.3, 7850.0)


@dataclass(frozen=True)
class Section:
    """Part of a shaft with one shape: a cylinder or a cone, solid or hollow.

    Parameters
    ----------
    length : float
        Length along the axis [m].
    outer_diameter : float
        Outer diameter where the section begins [m].
    inner_diameter : float
        Diameter of the bore where the section begins [m].
    end_outer_diameter : float, optional
        Outer diameter where it ends [m]; that of the beginning by default.
    end_inner_diameter : float, optional
        Diameter of the bore where it ends [m]; that of the beginning by default.

    Raises
    ------
    InputError
        If a size is out of range, or a bore is not smaller than its shaft.

    Examples
    --------
    >>> Section(0.060, 0.040, 0.010).end_outer_diameter
    0.04
    """

    length: float
    outer_diameter: float
    inner_diameter: float = 0.0
    end_outer_diameter: float | None = None
    end_inner_diameter: float | None = None

    def __post_init__(self) -> None:
        for end, begin in (
            ("end_outer_diameter", self.outer_diameter),
            ("end_inner_diameter", self.inner_diameter),
        ):
            if getattr(self, end) is None:
                object.__setattr__(self, end, begin)
        for name in ("length", "outer_diameter", "end_outer_diameter"):
            check_number(self, name, "m", 0.0, 100.0, above=True)
        for name in ("inner_diameter", "end_inner_diameter"):
            check_number(self, name, "m", 0.0, 100.0)
            outer = getattr(self, name.replace("inner", "outer"))
            if (inner := getattr(self, name)) >= outer:
                raise InputError(
                    f"{name} = {display(inner, 'm')}",
                    Argument(f"Section.{name}"),
                    f"It must be smaller than the outer diameter there, {display(outer, 'm')}",
                    "Give a smaller bore, or a thicker shaft",
                )

    @property
    def is_cylindrical(self) -> bool:
        """Whether both diameters are constant over the length."""
        ends = self.end_outer_diameter, self.end_inner_diameter
        return ends == (self.outer_diameter, self.inner_diameter)

    def diameters(self, fraction: float) -> tuple[float, float]:
        """Outer and inner diameter [m] at a fraction of the length.

        Parameters
        ----------
        fraction : float
            0 where the section begins, 1 where it ends.

        Returns
        -------
        tuple of float
            Outer and inner diameter [m].
        """
        outer = self.end_outer_diameter or 0.0  # never None once constructed
        inner = self.end_inner_diameter or 0.0
        return (
            self.outer_diameter + fraction * (outer - self.outer_diameter),
            self.inner_diameter + fraction * (inner - self.inner_diameter),
        )
