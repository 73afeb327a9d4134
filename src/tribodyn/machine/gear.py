"""A gear on a shaft."""

from __future__ import annotations

from dataclasses import dataclass

from tribodyn.errors import Argument, InputError
from tribodyn.gear import ToothForm
from tribodyn.machine.fields import check_name, check_number, quoted
from tribodyn.machine.section import STEEL


@dataclass(frozen=True)
class Gear:
    """A cylindrical gear on a shaft; module and helix are those of its meshes.

    Parameters
    ----------
    shaft : str
        Name of its shaft.
    position : float or None
        Position of its mid face on the shaft [m]. None, for a rigid shaft only: at its node.
    teeth : int
        Number of teeth; negative for a ring with internal teeth.
    face_width : float
        Face width [m].
    mass : float, optional
        Mass of the gear alone, added to that of the shaft [kg].
    moment_of_inertia : float, optional
        Its polar moment of inertia [kg*m^2].
    transverse_moment_of_inertia : float, optional
        Its moment of inertia about an axis in its mid plane [kg*m^2].
    bore_diameter : float
        Bore of a gear that is wider than its shaft, or whose shaft is rigid [m].
    rim_diameter : float, optional
        Outer diameter of a ring [m]; its rim is 3.5 modules thick by default.
    density : float
        Density [kg/m^3]; that of steel by default.
    form : ToothForm, optional
        Form of its teeth; by default the section is a disc of the reference diameter.

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    What is not given is that of the solid around the shaft or the bore; see
    :attr:`Machine.gear_bodies`.

    Examples
    --------
    >>> Gear("input", 0.085, 27, 0.050).is_ring
    False
    """

    shaft: str
    position: float | None
    teeth: int
    face_width: float
    mass: float | None = None
    moment_of_inertia: float | None = None
    transverse_moment_of_inertia: float | None = None
    bore_diameter: float = 0.0
    rim_diameter: float | None = None
    density: float = STEEL.density
    form: ToothForm | None = None

    def __post_init__(self) -> None:
        check_name(self, "shaft")
        if self.position is not None:
            check_number(self, "position", "m", -1e3, 1e3)
        check_number(self, "teeth")
        count = float(self.teeth)
        if not count.is_integer() or not 4 <= abs(count) <= 10_000:
            why = "It must be a whole number from 4 to 10000, or from -10000 to -4 for a ring"
            what, where = f"teeth = {count:.10g}", Argument("Gear.teeth")
            raise InputError(what, where, why, "Count the teeth")
        object.__setattr__(self, "teeth", int(count))
        check_number(self, "face_width", "m", 0.0, 10.0, above=True)
        for name, unit in (
            ("mass", "kg"),
            ("moment_of_inertia", "kg*m^2"),
            ("transverse_moment_of_inertia", "kg*m^2"),
        ):
            if getattr(self, name) is not None:
                check_number(self, name, unit, 0.0)
        check_number(self, "density", "kg/m^3", 0.0, above=True)
        check_number(self, "bore_diameter", "m", 0.0, 100.0)
        if self.rim_diameter is not None:
            check_number(self, "rim_diameter", "m", 0.0, 100.0, above=True)
        other = "bore_diameter" if self.is_ring else "rim_diameter"
        if getattr(self, other):
            what = f"{other} of a {'ring' if self.is_ring else 'gear with external teeth'}"
            why = "A ring has a rim, other gears have a bore"
            raise InputError(what, Argument(f"Gear.{other}"), why, "Remove it")
        if self.form is not None and getattr(self.form, "teeth", None) != self.teeth:
            what, why = f"form = {quoted(self.form)}", f"Wanted: a ToothForm of {self.teeth} teeth"
            raise InputError(what, Argument("Gear.form"), why, "Give the form of this gear")

    @property
    def is_ring(self) -> bool:
        """Whether the teeth are internal."""
        return self.teeth < 0

    @property
    def node_position(self) -> float:
        """Position on the shaft [m]; 0 where none is given."""
        return self.position or 0.0
