"""A shaft with its sections from its beginning on, and the coupling of two shafts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tribodyn.errors import Argument, InputError
from tribodyn.gear import Material
from tribodyn.machine.fields import check_number, quoted
from tribodyn.machine.section import STEEL, Section
from tribodyn.model import REQUIRED, Model, Option, Registry, number
from tribodyn.types import ByName

#: Positions on a shaft closer than this are one, and overlaps below it are rounding [m].
SAME_PLACE = 1e-9


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
    moment_of_inertia : float
        Polar moment of inertia of a body that turns with it, such as an engine, a coupling or a
        carrier, besides sections and gears [kg*m^2].
    mass : float
        Mass of that body [kg].
    transverse_moment_of_inertia : float
        Its moment of inertia about an axis across the shaft [kg*m^2].
    mass_position : float
        Position of that body; at the beginning by default [m].

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
    moment_of_inertia: float = 0.0
    mass: float = 0.0
    transverse_moment_of_inertia: float = 0.0
    mass_position: float = 0.0

    def __post_init__(self) -> None:
        sections = tuple(self.sections)
        if not all(isinstance(section, Section) for section in sections):
            what, where = f"sections = {quoted(sections)}", Argument("Shaft.sections")
            raise InputError(what, where, "Wanted: a list of Sections", "Give [Section(...), ...]")
        object.__setattr__(self, "sections", sections)
        if not isinstance(self.material, Material):
            what, remedy = f"material = {quoted(self.material)}", "Give a Material, such as STEEL"
            raise InputError(what, Argument("Shaft.material"), "Wanted: a Material", remedy)
        check_number(self, "mass", "kg", 0.0)
        for name in ("moment_of_inertia", "transverse_moment_of_inertia"):
            check_number(self, name, "kg*m^2", 0.0)
        check_number(self, "mass_position", "m", -1e3, 1e3)

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


@dataclass(frozen=True)
class Coupling:
    """A torsional spring between the end of a shaft and the beginning of the next on its axis.

    Parameters
    ----------
    shafts : (str, str)
        Names of both shafts.
    torsional_stiffness : float
        Stiffness against twist [N*m/rad]; it resists nothing else.
    torsional_damping : float
        Damping of the twist [N*m*s/rad].

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> Coupling(("engine", "input"), 1e5).torsional_damping
    0.0
    """

    shafts: tuple[str, str]
    torsional_stiffness: float
    torsional_damping: float = 0.0

    def __post_init__(self) -> None:
        names = tuple(self.shafts) if isinstance(self.shafts, list | tuple) else ()
        if len(names) != 2 or names[0] == names[1] or not all(isinstance(n, str) for n in names):
            what, where = f"shafts = {quoted(self.shafts)}", Argument("Coupling.shafts")
            raise InputError(what, where, "A coupling joins two shafts", "Give their two names")
        object.__setattr__(self, "shafts", names)
        check_number(self, "torsional_stiffness", "N*m/rad", 0.0, above=True)
        check_number(self, "torsional_damping", "N*m*s/rad", 0.0)


@dataclass(frozen=True)
class CouplingModel(Model):
    """A kind of coupling: how its data become stiffness and damping.

    Parameters
    ----------
    name : str
        As ``model`` of ``[couplings.NAME]`` names it.
    function : callable
        Called with the names of both shafts and the options; returns a :class:`Coupling`.
    source, meaning : str
        Publication, and one line.
    papers : tuple of str
        Keys of the bibliography.
    options : mapping
        Data of the coupling, as :func:`tribodyn.model.number` and its like declare them.

    Examples
    --------
    >>> COUPLINGS["linear"].function(("engine", "input"), torsional_stiffness=1e5)
    Coupling(shafts=('engine', 'input'), torsional_stiffness=100000.0, torsional_damping=0.0)
    """

    name: str
    function: Callable[..., Coupling]
    source: str = ""
    meaning: str = ""
    papers: tuple[str, ...] = ()
    options: ByName = field(default_factory=dict)


COUPLINGS: Registry[CouplingModel] = Registry("coupling", "tribodyn.coupling", CouplingModel)


def _torsional(default: object, unit: str, meaning: str) -> Option:
    limits = (0.0, 1e14, "guards against a wrong unit")
    option: Option = number(default, *limits, unit=unit, meaning=meaning, example=f'"4e8 {unit}"')
    return option


@COUPLINGS.define(
    "linear",
    meaning="a torsional spring with a damper",
    options={
        "torsional_stiffness": _torsional(REQUIRED, "N*m/rad", "stiffness against twist"),
        "torsional_damping": _torsional(0.0, "N*m*s/rad", "damping of the twist"),
    },
)
def _linear(
    shafts: tuple[str, str], *, torsional_stiffness: float, torsional_damping: float = 0.0
) -> Coupling:
    """Coupling of given stiffness and damping."""
    return Coupling(shafts, torsional_stiffness, torsional_damping)
