"""A shaft: the sections that it consists of, from its beginning on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tribodyn.errors import Argument, InputError
from tribodyn.machine.section import STEEL, Material, Section


@dataclass(frozen=True)
class Shaft:
    """A shaft along x; positions on it count from where it begins.

    Parameters
    ----------
    sections : sequence of Section
        Sections in their order along x, or their sizes ``(length, outer, inner, ...)`` [m].
        Without sections the shaft is rigid and without mass, with one node at position 0.
    material : Material
        Material of all sections.

    Raises
    ------
    InputError
        If a section is out of range.

    Examples
    --------
    >>> Shaft([(0.060, 0.040), (0.050, 0.045, 0.010)]).length
    0.11
    """

    sections: Sequence[Section] = ()
    material: Material = STEEL

    def __post_init__(self) -> None:
        try:
            sections = tuple(map(_section, self.sections))
        except TypeError as error:
            what = f"sections cannot be read: {error}"
            why = "A section is a Section or the numbers (length, outer diameter, ...)"
            remedy = "Give a list of sections, each with two to five sizes in m"
            raise InputError(what, Argument("Shaft.sections"), why, remedy) from None
        object.__setattr__(self, "sections", sections)
        if not isinstance(self.material, Material):
            what, remedy = f"material = {self.material!r}", "Give a Material, such as STEEL"
            raise InputError(what, Argument("Shaft.material"), "Wanted: a Material", remedy)

    @property
    def length(self) -> float:
        """Length [m]; zero for a rigid shaft without sections."""
        return sum(section.length for section in self.sections)

    @property
    def is_rigid(self) -> bool:
        """Whether the shaft has no sections."""
        return not self.sections

    @property
    def ends(self) -> tuple[float, ...]:
        """Positions at which sections begin or end, from 0 to the length [m]."""
        positions = [0.0]
        for section in self.sections:
            positions.append(positions[-1] + section.length)
        return tuple(positions)


def _section(section: Any) -> Section:
    return section if isinstance(section, Section) else Section(*section)
