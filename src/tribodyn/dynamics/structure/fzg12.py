"""The gear test rig with twelve coordinates: two shafts, wheel and pinion, each in a plane."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.structure.force_law import MeshForce, carried
from tribodyn.dynamics.structure.gear_pair import (
    Driver,
    TorqueBalance,
    balance_direction,
    row_of,
    torques,
    with_error_of,
)
from tribodyn.dynamics.structure.shafts import Body, GearMesh, assemble, shaft_chain
from tribodyn.errors import InputError, require_between
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions


_MODULE, _TEETH = 4.5e-3, (16, 24)
_COSINE = float(np.cos(np.radians(20.0)))
#: Base radii (pinion, wheel) of the test gears type A [m].
BASE_RADIUS = tuple(0.5 * _MODULE * teeth * _COSINE for teeth in _TEETH)
_PITCH = float(np.pi) * _MODULE * _COSINE
_ANGLE = float(np.arccos(sum(BASE_RADIUS) / 91.5e-3))
_LINE = 91.5e-3 * float(np.sin(_ANGLE))
_PITCH_POINT = BASE_RADIUS[0] * float(np.tan(_ANGLE))
#: Radius of curvature of the pinion where the path of contact begins on its side [m]: the tip
#: circle of the wheel is that of centre distance 91.5 mm with shortened addendum.
_BEGIN = 0.324239 * BASE_RADIUS[0]


@dataclass(frozen=True)
class RectangularMesh:
    """Rectangular mesh stiffness: one value in double-pair and one in single-pair contact."""

    single: float  #: [N/m]
    double: float  #: [N/m]
    duty: float = 1.0 / 3.0  #: part of the mesh cycle with two pairs [1]
    friction_coefficient: float = 0.0  #: constant friction coefficient [1]
    driver: Driver = "pinion"  #: driving gear: contacts move away from its base tangent point

    @property
    def event_phases(self) -> tuple[float, ...]:
        """Phases at which a pair enters, leaves or passes the pitch point."""
        return tuple(sorted({0.0, self.duty, self._pitch_point_age % 1.0}))

    def stiffness(self, phase: Array) -> Array:
        """Mesh stiffness."""
        return np.where(np.asarray(phase) < self.duty, self.double, self.single)

    def friction_sum(self, phase: Array) -> Array:
        """Directed friction coefficient of all pairs, each with its share of the load."""
        return np.asarray(sum(pull for pull, _ in self._pairs(phase)))

    def friction_moment_pinion(self, phase: Array) -> Array:
        """Friction moment on the pinion over the normal force."""
        return np.asarray(sum(pull * lever for pull, lever in self._pairs(phase)))

    def friction_moment_wheel(self, phase: Array) -> Array:
        """Friction moment on the wheel over the normal force."""
        return np.asarray(sum(pull * (_LINE - lever) for pull, lever in self._pairs(phase)))

    @property
    def _pitch_point_age(self) -> float:
        """Base pitches that a contact has travelled at the pitch point."""
        forward = (_PITCH_POINT - _BEGIN) / _PITCH
        return forward if self.driver == "pinion" else 1.0 + self.duty - forward

    def _pairs(self, phase: Array) -> list[tuple[Array, Array]]:
        """Friction coefficient and lever on the pinion of the last and of the previous pair."""
        phases = np.asarray(phase, dtype=float)
        two_pairs = phases < self.duty
        pairs = []
        for age in (0.0, 1.0):
            travelled = phases + age
            path = travelled if self.driver == "pinion" else 1.0 + self.duty - travelled
            lever = _BEGIN + path * _PITCH
            share = np.where(two_pairs, 0.5, 1.0 - age)
            sense = np.sign(lever - _PITCH_POINT)
            pairs.append((self.friction_coefficient * share * sense, lever))
        return pairs


_BODIES = ("shaft1", "wheel", "pinion", "shaft2")
#: Coordinates of the structure with 12 degrees of freedom, in their order.
FZG12_NAMES = tuple(f"{body}_{axis}" for body in _BODIES for axis in ("v", "w", "theta"))
#: Mesh frequency of the benchmark: 16 teeth at 1000 rpm [Hz].
FZG12_MESH_FREQUENCY = 16 * 1000.0 / 60.0

#: The moment of inertia of both shaft discs with which shafts of 75397.3113 N m/rad put the first
#: elastic mode of the rig at 492 Hz [kg*m^2].
_SHAFT_INERTIA = 6.829922680095e-3

#: Options of a lightly damped rig, ``fzg12(**FZG12_LIGHT)``: its first mode still lies at 492 Hz,
#: its second 0.11 % below the fifth mesh harmonic with 0.06 % of critical damping.
FZG12_LIGHT: Mapping[str, Any] = MappingProxyType(
    {
        "moment_of_inertia": (6.81483e-3, 2.20711e-3, 7.69088e-4, 6.81483e-3),
        "shaft_damping": 0.004,
        "mesh_damping": 300.0,
    }
)


def fzg12(
    mesh: MeshFunctions | None = None,
    *,
    torque: float = 172.0,
    mass: ArrayLike = (1.5, 1.084, 0.676, 1.5),
    moment_of_inertia: ArrayLike = (_SHAFT_INERTIA, 1168e-6, 407e-6, _SHAFT_INERTIA),
    shaft_stiffness: ArrayLike = 75397.3113,
    shaft_damping: ArrayLike = 1.0,
    bearing_stiffness: ArrayLike = 3.5e9,
    bearing_damping: ArrayLike = 4e3,
    base_radius: ArrayLike = BASE_RADIUS,
    single_pair_stiffness: float = 1.2e8,
    double_pair_stiffness: float = 1.92e8,
    mesh_damping: Entry = 900.0,
    friction_coefficient: float = 0.0,
    backlash: float = 0.0,
    error: Entry = 0.0,
    driver: Driver = "wheel",
    torque_balance: TorqueBalance = "drive",
    damping_in_gap: bool = False,
    mesh_force: MeshForce = "stiffness",
) -> System:
    """Build the test rig of two shafts and one gear pair; by default the benchmark rig.

    Parameters
    ----------
    mesh : MeshFunctions, optional
        From ``mesh_table.functions()``; a rectangular stiffness with two pairs for a third of the
        cycle by default.
    torque : float
        Torque on the pinion's shaft [N*m].
    mass : float or (4,) array
        Masses (shaft 1, wheel, pinion, shaft 2) [kg].
    moment_of_inertia : float or (4,) array
        Polar moments of inertia, in the same order [kg*m^2].
    shaft_stiffness : float or (2,) array
        Torsional stiffness of shaft 1 and shaft 2 [N*m/rad].
    shaft_damping : float or (2,) array
        Torsional damping of shaft 1 and shaft 2 [N*m*s/rad].
    bearing_stiffness : float or (4,) array
        Radial stiffness of each support, the same in v and w [N/m].
    bearing_damping : float or (4,) array
        Radial damping of each support [N*s/m].
    base_radius : (2,) array
        Base radii (pinion, wheel) [m].
    single_pair_stiffness : float
        Mesh stiffness with one pair; unused with a mesh [N/m].
    double_pair_stiffness : float
        Mesh stiffness with two pairs; unused with a mesh [N/m].
    mesh_damping : float or function
        Damping along the line of action [N*s/m].
    friction_coefficient : float
        Constant coefficient of friction; unused with a mesh [1].
    backlash, error, driver, torque_balance, damping_in_gap
        As in :func:`spur6` [m]; the motor is on shaft 1 with the wheel.
    mesh_force : "stiffness", "tangent" or "force-law"
        Force law of the teeth of a mesh.

    Returns
    -------
    System
        Coordinates ``v`` across the line of action, ``w`` along it and ``theta`` in the running
        sense of shaft 1, wheel, pinion and shaft 2.

    Raises
    ------
    InputError
        If a value is out of range, or the mesh does not have the data that ``mesh_force`` needs.

    Notes
    -----
    Source: the structure of a published model of the FZG rig, which gives no masses, stiffnesses
    or damping. The benchmark defines the pair stiffness, the torque, the speed, the torsional
    stiffness of the shafts and the first elastic mode of 492.000 Hz at mean mesh stiffness. All
    other values are assumed: gears and supports as in the reference pair with six degrees of
    freedom, shaft discs of 1.5 kg with the moment of inertia that leads to 492 Hz, shaft damping
    of 1 N m s/rad (about 2 % of critical).

    Examples
    --------
    >>> fzg12()
    System(12 coordinates, 1 contact)
    """
    radii = row_of("base_radius", base_radius, 2, "m")
    require_between("torque", torque, 0.0, np.inf, "N*m")
    _refuse_directions(mesh)
    teeth = mesh or RectangularMesh(
        single_pair_stiffness,
        double_pair_stiffness,
        friction_coefficient=friction_coefficient,
        driver=driver,
    )
    gears = GearMesh(
        "pinion",
        "wheel",
        radii,
        stiffness=teeth.stiffness,
        damping=mesh_damping,
        error=with_error_of(teeth, error),
        backlash=backlash,
        events=tuple(teeth.event_phases),
        driver=driver,
        friction=teeth,
    )
    shafts = _shafts(
        mass=mass,
        moment_of_inertia=moment_of_inertia,
        shaft_stiffness=shaft_stiffness,
        shaft_damping=shaft_damping,
        bearing_stiffness=bearing_stiffness,
        bearing_damping=bearing_damping,
    )
    turning = torques(float(torque) * np.array([1.0, radii[1] / radii[0]]), driver)
    system = assemble(shafts, [gears], {"shaft2": turning[0], "shaft1": turning[1]})
    balance = _at_the_ends(balance_direction(torque_balance, driver))
    (contact,) = system.contacts
    contacts = carried(replace(contact, damping_in_gap=damping_in_gap), teeth, mesh_force)
    return replace(system, names=FZG12_NAMES, balance=balance, contacts=contacts)


def _at_the_ends(pair: Array | None) -> Array | None:
    """Apply the torques of the pinion side and the wheel side to the discs of their shafts."""
    if pair is None:
        return None
    out = np.zeros(len(FZG12_NAMES))
    out[FZG12_NAMES.index("shaft2_theta")], out[FZG12_NAMES.index("shaft1_theta")] = pair
    return out


def _shafts(**values: ArrayLike) -> list[Body]:
    """Shaft 1 with the wheel, and the pinion with shaft 2."""
    four = {
        name: row_of(name, values[name], 4, unit, positive=name in ("mass", "moment_of_inertia"))
        for name, unit in (
            ("mass", "kg"),
            ("moment_of_inertia", "kg*m^2"),
            ("bearing_stiffness", "N/m"),
            ("bearing_damping", "N*s/m"),
        )
    }
    stiffness = row_of("shaft_stiffness", values["shaft_stiffness"], 2, "N*m/rad")
    damping = row_of("shaft_damping", values["shaft_damping"], 2, "N*m*s/rad", positive=False)
    return [
        shaft_chain(
            _BODIES[part],
            stiffness=stiffness[number],
            damping=damping[number],
            **{name: value[part] for name, value in four.items()},
        )
        for number, part in enumerate((slice(0, 2), slice(2, 4)))
    ]


def _refuse_directions(mesh: object) -> None:
    """Refuse a mesh that defines contact directions."""
    if getattr(mesh, "direction", None) is not None or getattr(mesh, "friction", None) is not None:
        what = "the mesh defines contact directions"
        why = "The shafts of this structure move in one plane, with the base radii as levers"
        raise InputError(what, "argument mesh", why, "Use spur6, or a mesh with base radii")
