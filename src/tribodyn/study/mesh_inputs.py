"""What the teeth of a mesh are computed from: a pair, a machine and a stage yield it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, cast

from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.gear import mass_properties
from tribodyn.study.case import to_models
from tribodyn.study.case.hypoid import bodies, levers, mounting
from tribodyn.study.case.to_models import chosen_options, locate_errors
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import MeshForce
    from tribodyn.dynamics.structure.structures import Axes
    from tribodyn.gear import CylindricalPair, HypoidFlanks, Misalignment
    from tribodyn.mesh.sharing import ToothContact
    from tribodyn.mesh.table_file import TableFile
    from tribodyn.study.case.gears import Gears
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.case.sections import Dynamics

#: Tables of a case that its tooth contact depends on, in addition to speed and load.
_OF_CONTACT = ("gears", "material", "lubricant", "film", "stiffness", "friction")


@dataclass(frozen=True, eq=False)
class HypoidTeeth:
    """Flanks of a hypoid pair, and where both gears stand."""

    flanks: HypoidFlanks
    mounting: Misalignment
    gears: Gears  #: models of the contact, and bodies


@dataclass(frozen=True, eq=False)
class TableTeeth:
    """Mesh table of another program."""

    file: TableFile
    friction_coefficient: float | None  #: in place of that of the table
    gears: Gears  #: teeth and bodies


@dataclass(frozen=True)
class MeshInputs:
    """Gears of one mesh, models of their contact, speed and torque of the pinion, in SI."""

    teeth: CylindricalPair | HypoidTeeth | TableTeeth
    contact: ToothContact | None  #: None for a mesh table of another program
    speed: float  #: of the pinion [rad/s]
    torque: float  #: on the pinion [N*m]
    driver: str  #: ``pinion`` or ``wheel``
    dynamics: Dynamics  #: damping, backlash, error and force law
    backlash: float  #: in force [m]
    densities: tuple[float, float]  #: [kg/m^3]
    located: Callable[[], AbstractContextManager[None]] = field(default=nullcontext, compare=False)

    @property
    def cylindrical(self) -> CylindricalPair | None:
        """The pair of cylindrical gears; None where the teeth are others."""
        other = isinstance(self.teeth, HypoidTeeth | TableTeeth)
        return None if other else cast("CylindricalPair", self.teeth)

    @property
    def settings(self) -> ToothContact:
        """Models of the tooth contact, which a mesh table of another program does not have."""
        assert self.contact is not None
        return self.contact

    @cached_property
    def law(self) -> MeshForce:
        """Mesh law: stiffness, tangent of the force law, or force law."""
        model = "" if self.contact is None else self.contact.stiffness_model
        table = self.teeth.file if isinstance(self.teeth, TableTeeth) else None
        return to_models.mesh_law(self.dynamics, table, self.cylindrical, model)

    @property
    def axes(self) -> Axes:
        """Where the gears move: in their plane, in space, or in space on crossed axes."""
        if isinstance(self.teeth, HypoidTeeth):
            return "crossed"
        pair = self.cylindrical
        return "space" if pair is not None and pair.helix_angle else "plane"

    @cached_property
    def base_radii(self) -> tuple[float, float]:
        """Levers of the force about the axes of pinion and wheel [m]."""
        if isinstance(self.teeth, HypoidTeeth):
            return levers(self.teeth.flanks)
        if isinstance(self.teeth, TableTeeth):
            first, second = (self.teeth.file.lever(f"{gear}_theta") for gear in ("pinion", "wheel"))
            return first, second
        return self.teeth.pinion.base_radius, self.teeth.wheel.base_radius

    @cached_property
    def inertias(self) -> tuple[float, float]:
        """Polar moments of inertia of pinion and wheel [kg*m^2]."""
        solids: Sequence[Any]
        if isinstance(self.teeth, HypoidTeeth):
            teeth = self.teeth
            solids = [*bodies(teeth.flanks, self.densities[0], teeth.gears).values()]
        elif isinstance(self.teeth, TableTeeth):
            solids = [*self.teeth.gears.by_name.values()]
        else:
            gears = self.teeth.pinion, self.teeth.wheel
            solids = [*map(mass_properties, gears, self.densities)]
        return solids[0].moment_of_inertia, solids[1].moment_of_inertia

    def under(
        self, speed: float, torque: float, misalignment: float | Misalignment = 0.0
    ) -> MeshInputs:
        """The same teeth at another speed and torque, further misaligned."""
        teeth, shift = self.teeth, cast("Any", misalignment)
        if misalignment and isinstance(teeth, HypoidTeeth):
            teeth = replace(teeth, mounting=_sum(teeth.mounting, shift))
        elif misalignment:
            with self.located(), collected():
                teeth = replace(cast("CylindricalPair", teeth), misalignment=shift)
        return replace(self, teeth=teeth, speed=speed, torque=torque)


def _sum(first: Misalignment, second: Misalignment) -> Misalignment:
    """Both displacements together."""
    sums = {name: value + getattr(second, name) for name, value in vars(first).items()}
    return type(first)(**sums)


def mesh_inputs(case: PairCase) -> MeshInputs:
    """What the teeth of the mesh of a pair are computed from."""
    contact = None if case.mesh_table is not None else contact_settings(case)
    teeth: Any = case.spur_pair
    if case.mesh_table is not None:
        teeth = TableTeeth(case.mesh_table, to_models.friction_of_table(case), case.gears)
    elif case.hypoid_flanks is not None:
        teeth = HypoidTeeth(case.hypoid_flanks, mounting(case.gears), case.gears)
    common = case.material.density
    densities = case.density("pinion"), case.density("wheel")
    return MeshInputs(
        *(teeth, contact, case.pinion_speed, case.pinion_torque, case.gears.driver),
        case.dynamics,
        case.backlash,
        (common, common) if isinstance(teeth, HypoidTeeth) else densities,  # blanks have one
        located=partial(locate_errors, case),
    )


def model_settings(case: PairCase) -> Tree:
    """Material, oil, stiffness and film of a case, as arguments of the mesh functions."""
    return {
        "material": case.material_properties,
        "stiffness_model": case.stiffness.model,
        "stiffness_options": chosen_options(case, "stiffness"),
        "lubricant": case.film_lubricant or to_models.unused_lubricant(),
        "composite_roughness": case.composite_roughness or 0.0,
        "film_model": case.film.model,
        "film_options": chosen_options(case, "film"),
    }


def contact_settings(case: PairCase) -> ToothContact:
    """Settings of the tooth contact of a case."""
    from tribodyn.mesh.sharing import ToothContact

    def settings() -> ToothContact:
        return ToothContact(
            friction_law=case.friction.law,
            friction_options=chosen_options(case, "friction"),
            bodies=case.thermal_contact_coefficients,
            **model_settings(case),
        )

    return case._once("contact_settings", _OF_CONTACT, settings)


@contextmanager
def named_mesh(name: str) -> Iterator[None]:
    """Name a mesh in errors that do not."""
    try:
        yield
    except (InputError, ComputationError) as error:
        problems = [
            p if name in str(p) else replace(p, what=f"mesh {name}: {p.what}")
            for p in error.problems
        ]
        raise type(error)(problems) from None
