"""A shaft: the sections that it consists of, from its beginning on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tribodyn.errors import Argument, InputError
from tribodyn.gear import Material
from tribodyn.machine.fields import quoted
from tribodyn.machine.section import STEEL, Section


@dataclass(frozen=True)
class Shaft:
    """A shaft along x; positions on it count from where it begins.

    Parameters
    ----------
    sections : sequence of Section
        Sections in their order along x. Without sections the shaft is rigid and without mass, with
        one node at position 0.
    material : Material
        Material of all sections.

    Raises
    ------
    InputError
        If a section is out of range.

    Examples
    --------
    >>> Shaft([Section(0.060, 0.040), Section(0.050, 0.045, 0.010)]).length
    0.11
    """

    sections: Sequence[Section] = ()
    material: Material = STEEL

    def __post_init__(self) -> None:
        sections = tuple(self.sections)
        if not all(isinstance(section, Section) for section in sections):
            what, where = f"sections = {quoted(sections)}", Argument("Shaft.sections")
            raise InputError(what, where, "Wanted: a list of Sections", "Give [Section(...), ...]")
        object.__setattr__(self, "sections", sections)
        if not isinstance(self.material, Material):
            what, remedy = f"material = {quoted(self.material)}", "Give a Material, such as STEEL"
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
