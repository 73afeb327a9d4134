"""Registry of the lumped structures: built from a mesh, its gears and the options of the structure.

The options of the chosen structure are keys of ``[dynamics]`` in a case file. A third party adds a
structure as one function decorated with ``STRUCTURES.define``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tribodyn.dynamics.equations.system import Contact
from tribodyn.dynamics.structure.force_law import MeshForce, carried
from tribodyn.dynamics.structure.fzg12 import fzg12
from tribodyn.dynamics.structure.gear_pair import (
    SPUR6_NAMES,
    Driver,
    ToothGap,
    gear_contact,
    pair_of,
    spur6,
    tooth_contact,
    torsional,
)
from tribodyn.dynamics.structure.helical12 import (
    HELICAL12_NAMES,
    SpatialSupports,
    direction_in_space,
    helical12,
)
from tribodyn.dynamics.structure.hypoid14 import (
    HYPOID14_NAMES,
    HypoidSupports,
    directions_of_crossed_axes,
    hypoid14,
)
from tribodyn.model import REQUIRED, Model, Option, Registry, number

if TYPE_CHECKING:
    from tribodyn.dynamics.equations.system import System
    from tribodyn.mesh import MeshFunctions


Pair = tuple[float, float]
#: A value for both gears, or one for each.
Support = float | tuple[float, ...]


@dataclass(frozen=True)
class Gearing:
    """Mesh and gears from which a structure is built, in the order (pinion, wheel).

    Parameters
    ----------
    mesh : MeshFunctions
        Stiffness and friction of the teeth over the mesh phase.
    mass : tuple [kg]
        Masses.
    moment_of_inertia : tuple [kg*m^2]
        Polar moments of inertia.
    base_radius : tuple [m]
        Base radii.
    torque : tuple [N*m]
        Sizes of the nominal torques.
    contact : mapping
        Arguments of the contact: ``mesh_damping``, ``driver``, ``backlash``, ``damping_in_gap``,
        ``torque_balance``, ``mesh_force`` and, if one is prescribed, ``error``, as in
        :func:`tribodyn.dynamics.torsional`.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> flat = SimpleNamespace(stiffness=lambda p: 3e8 + 0 * p, friction_sum=lambda p: 0 * p,
    ...     friction_moment_pinion=lambda p: 0 * p, friction_moment_wheel=lambda p: 0 * p,
    ...     event_phases=(0.0,))
    >>> gears = Gearing(flat, (1.0, 2.0), (1e-3, 3e-3), (0.03, 0.05), (90.0, 150.0), {})
    >>> STRUCTURES["torsional"](gears)
    System(2 coordinates, 1 contact)
    """

    mesh: MeshFunctions
    mass: Pair
    moment_of_inertia: Pair
    base_radius: Pair
    torque: Pair
    contact: Mapping[str, Any]


@dataclass(frozen=True)
class Structure(Model):
    """A structure that vibrates.

    Parameters
    ----------
    name : str
        Name in the registry.
    function : callable
        ``function(gearing, **options)``: takes a :class:`Gearing`, returns a :class:`System`.
        Coordinates of the gears are called ``pinion_x``, ``pinion_y`` (across and along the line
        of action), ``pinion_theta``, and so on.
    options : mapping of str to Option or default
        Its options; after construction their defaults, None without a default.
    turns_with : mapping of str to str
        Gear with which another rotational coordinate turns: ``{"shaft1_theta": "wheel"}``.
    source : str
        Source of the structure.
    meaning : str
        Description in one line.
    papers : tuple of str
        Keys of the bibliography of the package.
    gears : tuple of str
        Supported kinds of gear pairs; empty: all.

    Examples
    --------
    >>> STRUCTURES["spur-6dof"].options["bearing_damping_ratio"]
    0.02
    """

    name: str
    function: Callable[..., System] = field(repr=False)
    options: Mapping[str, Any] = field(default_factory=dict)
    turns_with: Mapping[str, str] = field(default_factory=dict)
    source: str = ""
    meaning: str = ""
    papers: tuple[str, ...] = ()
    gears: tuple[str, ...] = ()

    def __call__(self, gearing: Gearing, **options: Any) -> System:
        """Build the structure.

        Parameters
        ----------
        gearing : Gearing
            Mesh and gears.
        **options : object
            Options of the structure, in SI; missing ones have their defaults.

        Raises
        ------
        InputError
            If an option is out of range.
        """
        return self.function(gearing, **{**self.options, **options})


#: The structures by name, open to third parties through the entry points of this group.
STRUCTURES: Registry[Structure] = Registry("structure", "tribodyn.structure", Structure)

_GUARD = "guards against a wrong unit"
_FIXED = "That model turns the gears about fixed axes"
_NO_SHAFTS = "That model has no shafts"


def _supports(default: object) -> dict[str, Option]:
    """Options of gears on springs and dampers."""
    pair: dict[str, Any] = {"pair": True, "absent": _FIXED}
    return {
        "bearing_stiffness": number(default, 1e3, 1e13, _GUARD, of="bearing_stiffness", **pair),
        "bearing_damping": number(None, 0.0, 1e9, _GUARD, of="bearing_damping", **pair),
        "bearing_damping_ratio": _ratio(0.02, "of each gear on its bearing", _FIXED),
    }


def _ratio(default: float, purpose: str, absent: str) -> Option:
    """Damping ratio of supports."""
    origin = "supports lie between 0.01 and 0.1"
    meaning = f"damping {purpose} over its critical value"
    option: Option = number(default, 0.0, 2.0, origin, meaning=meaning, absent=absent)
    return option


def pair_values(value: Support | None) -> Pair:
    """Values of the supports of pinion and wheel from two, one for both, or None for zero."""
    return (value[0], value[1]) if isinstance(value, tuple) else (value or 0.0, value or 0.0)


def support_damping(
    stiffness: Support | None, mass: Pair, damping: Support | None, ratio: float | None
) -> Pair:
    """Damping of the supports of both gears [N*s/m]: prescribed, or a part of the critical one."""
    if damping is not None or stiffness is None:
        return pair_values(damping)
    critical = [2.0 * math.sqrt(k * m) for k, m in zip(pair_values(stiffness), mass, strict=True)]
    return ((ratio or 0.0) * critical[0], (ratio or 0.0) * critical[1])


def _values(gears: Gearing, *names: str) -> dict[str, Any]:
    """Some values of the gears by name, and the settings of their contact."""
    return {**{name: getattr(gears, name) for name in names}, **gears.contact}


@STRUCTURES.define(
    "spur-6dof",
    options=_supports(REQUIRED),
    gears=("spur", "table"),
    meaning="both gears move along and across the line of action on their supports and turn",
    papers=("he-gunda-singh",),
)
def _spur6(
    gears: Gearing,
    *,
    bearing_stiffness: Support | None,
    bearing_damping: Support | None,
    bearing_damping_ratio: float | None,
) -> System:
    return spur6(
        **_values(gears, "mesh", "mass", "moment_of_inertia", "base_radius", "torque"),
        bearing_stiffness=pair_values(bearing_stiffness),
        bearing_damping=support_damping(
            bearing_stiffness, gears.mass, bearing_damping, bearing_damping_ratio
        ),
    )


@STRUCTURES.define(
    "torsional", meaning="both gears turn about fixed axes", papers=("kahraman-singh",)
)
def _torsional(gears: Gearing) -> System:
    return torsional(**_values(gears, "mesh", "moment_of_inertia", "base_radius", "torque"))


#: Options of the two shafts of the rig: default, range, quantity, description of each shaft.
_SHAFT = {
    "stiffness": (75397.3113, 1.0, 1e12, "shaft_stiffness", "torsional stiffness of shaft {0}{1}"),
    "damping": (1.0, 0.0, 1e6, "shaft_damping", "torsional damping of shaft {0}"),
    "moment_of_inertia": (
        6.829922680095e-3,
        1e-14,
        1e7,
        "moment_of_inertia",
        "polar moment of inertia of the disc of shaft {0}",
    ),
    "mass": (1.5, 1e-7, 1e6, "mass", "mass of the disc of shaft {0}"),
}
_BETWEEN = {1: ", between its disc and the wheel", 2: ", between its disc and the pinion"}


def _shaft_options() -> dict[str, Option]:
    """Options and defaults of the benchmark rig, first elastic mode at 492 Hz; none is printed."""
    return {
        f"shaft{shaft}_{name}": number(
            usual,
            low,
            high,
            _GUARD,
            of=of,
            meaning=text.format(shaft, _BETWEEN[shaft]),
            absent=_NO_SHAFTS,
        )
        for shaft in (1, 2)
        for name, (usual, low, high, of, text) in _SHAFT.items()
    }


@STRUCTURES.define(
    "fzg-12dof",
    options={**_supports(3.5e9), **_shaft_options()},
    turns_with={"shaft1_theta": "wheel", "shaft2_theta": "pinion"},
    gears=("spur", "table"),
    meaning="two shafts with a disc each, wheel and pinion: all move across and along the line of "
    "action on supports and turn",
)
def _fzg12(
    gears: Gearing,
    *,
    bearing_stiffness: Support,
    bearing_damping: Support | None,
    bearing_damping_ratio: float | None,
    **shafts: float,
) -> System:
    def bodies(of_gears: Pair, name: str) -> list[float]:
        return [shafts[f"shaft1_{name}"], of_gears[1], of_gears[0], shafts[f"shaft2_{name}"]]

    masses, stiffness = bodies(gears.mass, "mass"), pair_values(bearing_stiffness)
    # The wheel is on shaft 1, the pinion on shaft 2; each disc has the supports of its gear.
    discs = support_damping(
        stiffness, (masses[3], masses[0]), bearing_damping, bearing_damping_ratio
    )
    wheels = support_damping(stiffness, gears.mass, bearing_damping, bearing_damping_ratio)
    return fzg12(
        gears.mesh,
        torque=gears.torque[0],
        base_radius=gears.base_radius,
        mass=masses,
        moment_of_inertia=bodies(gears.moment_of_inertia, "moment_of_inertia"),
        shaft_stiffness=[shafts[f"shaft{number}_stiffness"] for number in (1, 2)],
        shaft_damping=[shafts[f"shaft{number}_damping"] for number in (1, 2)],
        bearing_stiffness=[stiffness[1], stiffness[1], stiffness[0], stiffness[0]],
        bearing_damping=[discs[1], wheels[1], wheels[0], discs[0]],
        **gears.contact,
    )


def _of_supports(
    usual: object, quantities: Mapping[str, tuple[str, str]], absent: str
) -> dict[str, Option]:
    """Options of supports in space: quantity of each of their fields, and what it is of."""
    options = {}
    for name, (of, purpose) in quantities.items():
        value = getattr(usual, name)
        each = None if np.ndim(value) == 0 else tuple(float(v) for v in value)
        default = value if each is None else (each[0] if each[0] == each[1] else each)
        inertia = of == "moment_of_inertia"
        limits = (1e-14, 1e7) if inertia else (1.0, 1e13)
        text = f"{'moment of inertia' if inertia else 'stiffness'} {purpose}"
        pair = each is not None or value is None
        options[name] = number(
            default, *limits, _GUARD, of=of, meaning=text, absent=absent, pair=pair
        )
    return options


_IN_PLANE = "That model keeps the gears in one plane"


def _spatial_options() -> dict[str, Option]:
    """Options of gears that move in space: those of :class:`SpatialSupports`."""
    usual = SpatialSupports()
    quantities = {
        "bearing_stiffness": ("bearing_stiffness", "of the supports across the axis of each gear"),
        "axial_bearing_stiffness": ("bearing_stiffness", "of the supports along the axis"),
        "tilting_stiffness": ("shaft_stiffness", "of the supports against tilting of each gear"),
        "diametral_moment_of_inertia": (
            "moment_of_inertia",
            "of each gear about an axis perpendicular to its own; half the polar one where left "
            "out",
        ),
    }
    ratio = _ratio(usual.bearing_damping_ratio, "of each support", _IN_PLANE)
    return {**_of_supports(usual, quantities, _IN_PLANE), "bearing_damping_ratio": ratio}


@STRUCTURES.define(
    "helical-12dof",
    options=_spatial_options(),
    gears=("spur",),
    meaning="both gears move along three axes, turn and tilt on supports of their own",
)
def _helical12(gears: Gearing, **options: Any) -> System:
    values = _values(gears, "mesh", "mass", "moment_of_inertia", "torque")
    return helical12(supports=SpatialSupports(**options), **values)


_OWN_AXES = "That model has no crossed axes"


def _hypoid_options() -> dict[str, Option]:
    """Options of shafts and bearings in space: those of :class:`HypoidSupports`, in its order."""
    quantities = {
        "engine_moment_of_inertia": ("moment_of_inertia", "of what drives the pinion's shaft"),
        "load_moment_of_inertia": ("moment_of_inertia", "of what the wheel's shaft drives"),
        "diametral_moment_of_inertia": (
            "moment_of_inertia",
            "of each gear about an axis perpendicular to its own",
        ),
        "bearing_stiffness": ("bearing_stiffness", "of the bearings across the axis of each gear"),
        "axial_bearing_stiffness": ("bearing_stiffness", "of the bearings along the axis"),
        "tilting_stiffness": ("shaft_stiffness", "of the bearings against tilting of each gear"),
        "shaft_stiffness": (
            "shaft_stiffness",
            "against twist from engine to pinion and from wheel to load",
        ),
    }
    usual = HypoidSupports()
    return {
        **_of_supports(usual, quantities, _OWN_AXES),
        "bearing_damping_ratio": _ratio(usual.bearing_damping_ratio, "of each support", _OWN_AXES),
        "shaft_damping_ratio": _ratio(usual.shaft_damping_ratio, "of each shaft", _OWN_AXES),
    }


@STRUCTURES.define(
    "hypoid-14dof",
    options=_hypoid_options(),
    turns_with={"engine_theta": "pinion", "load_theta": "wheel"},
    gears=("hypoid", "table"),
    meaning="both gears move along three axes, turn and tilt; shafts join them to engine and load",
)
def _hypoid14(gears: Gearing, **options: Any) -> System:
    values = _values(gears, "mesh", "mass", "moment_of_inertia", "torque")
    return hypoid14(supports=HypoidSupports(**options), **values)


#: Where the gears of a mesh move: in their plane, in space, or in space on crossed axes.
Axes = Literal["plane", "space", "crossed"]


def pair_contacts(
    mesh: MeshFunctions,
    axes: Axes,
    *,
    base_radius: tuple[float, float],
    driver: Driver,
    mesh_force: MeshForce,
    **contact: Any,
) -> tuple[tuple[str, ...], tuple[Contact, ...]]:
    """Names of the coordinates of both gears, and the contacts of their teeth over them."""
    names: tuple[str, ...]
    gap = ToothGap(**contact)
    if axes == "plane":
        names, radii = SPUR6_NAMES, pair_of("base_radius", base_radius, "m")
        of_teeth = gear_contact(mesh, names, base_radius=radii, driver=driver, gap=gap)
    elif axes == "space":
        names = HELICAL12_NAMES
        entries = direction_in_space(mesh), mesh.spatial_friction
        of_teeth = tooth_contact(mesh, *entries, gap)
    else:
        names = HYPOID14_NAMES[1:-1]
        of_teeth = tooth_contact(mesh, *directions_of_crossed_axes(mesh), gap)
    return names, carried(of_teeth, mesh, mesh_force)
