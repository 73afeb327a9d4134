"""The hypoid pair between engine and load as a machine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics import HypoidSupports, hypoid14
from tribodyn.dynamics.structure.gear_pair import pair_of
from tribodyn.errors import require_one_of, require_positive
from tribodyn.gear import HypoidBlank
from tribodyn.machine.bearing import Bearing
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.crossed import CrossedAxes, CrossedGeometry, Reference
from tribodyn.machine.machine import Machine, Operation
from tribodyn.machine.mesh import Mesh
from tribodyn.machine.shaft import Coupling, Shaft

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions

_GEARS = ("pinion", "wheel")


def hypoid_machine(
    mesh: MeshFunctions,
    blank: HypoidBlank,
    *,
    mass: ArrayLike,
    moment_of_inertia: ArrayLike,
    speed: float,
    torque: float,
    side: str = "drive",
    supports: HypoidSupports | None = None,
    shafts: Mapping[str, Shaft] | None = None,
    positions: Mapping[str, float] | None = None,
    bearings: Mapping[str, Bearing] | None = None,
    **contact: Any,
) -> Machine:
    """Build the machine of a hypoid pair between engine and load.

    Parameters
    ----------
    mesh : MeshFunctions
        Of the mesh table of the pair, for this side.
    blank : HypoidBlank
        Dimensions of the pair.
    mass, moment_of_inertia : float or (2,) array
        Masses [kg] and polar moments of inertia [kg*m^2] of pinion and wheel.
    speed, torque : float
        Sizes of speed [rad/s] and torque [N*m] of the engine.
    side : "drive" or "coast"
        Side of the teeth that carries; the pinion drives.
    supports : HypoidSupports, optional
        Inertias of engine and load, torsional stiffness to them, and springs of the gears; assumed
        where left out.
    shafts : mapping of str to Shaft, optional
        Flexible shafts of ``"pinion"`` and ``"wheel"``; rigid where left out. The apex of a gear
        lies towards x.
    positions : mapping of str to float, optional
        Position of the middle of the face of such a gear on its shaft [m].
    bearings : mapping of str to Bearing, optional
        Bearings on the shafts ``"pinion"`` and ``"wheel"``, in place of the springs of these gears.
    **contact : object
        ``mesh_damping``, ``backlash``, ``error``, ``damping_in_gap`` and ``mesh_force``, as in
        :func:`tribodyn.dynamics.hypoid14`.

    Returns
    -------
    Machine
        Shafts ``engine``, ``pinion``, ``wheel`` and ``load``, joined by the couplings ``engine``
        and ``load`` and the mesh ``hypoid``. Without bearings the springs and the mass of a gear
        are at its crossing point, as those of :func:`tribodyn.dynamics.hypoid14`.

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    The structure without damping of its modes is that of
    ``machine_structure(machine, damping_ratio=0.0)``; the torque of the engine is prescribed.
    To the motion of :func:`tribodyn.dynamics.hypoid14` a machine adds the gyroscopic moments.

    Examples
    --------
    >>> import math
    >>> from types import SimpleNamespace
    >>> from tribodyn.gear import hypoid_blank
    >>> from tribodyn.machine import machine_structure, system
    >>> row = np.array([0, 1, 0, 0, 0.03, 0, 0, 0, -1, 0, -0.12, 0.0])
    >>> flat = SimpleNamespace(stiffness=lambda p: 5e8 + 0 * p, event_phases=(0.0,),
    ...     direction=lambda p: np.tile(row, (np.size(p), 1)), friction=None)
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> machine = hypoid_machine(flat, blank, mass=(11.4, 49.5), moment_of_inertia=(0.0125, 0.9),
    ...                          speed=314.16, torque=500.0)
    >>> system(machine_structure(machine, damping_ratio=0.0))
    System(14 coordinates, 1 contact)
    """
    require_one_of("side", side, ("drive", "coast"))
    for name, value, unit in (("speed", speed, "rad/s"), ("torque", torque, "N*m")):
        require_positive(name, value, unit)
    springs, places = supports or HypoidSupports(), dict(positions or {})
    flexible, supported = dict(shafts or {}), dict(bearings or {})
    masses, polar = pair_of("mass", mass, "kg"), pair_of("moment_of_inertia", moment_of_inertia, "")
    across = np.asarray(springs.diametral_moment_of_inertia)
    points: list[Reference] = ["calculation-point", "calculation-point"]
    for number, gear in enumerate(_GEARS):
        if gear not in {bearing.shaft for bearing in supported.values()}:
            points[number], body = "crossing-point", (masses[number], across[number])
            supported[gear] = _springs(gear, number, places.get(gear, 0.0), springs, body)
    crossed = CrossedAxes(blank, reference=(points[0], points[1]))
    sense = 1 if CrossedGeometry(crossed, 0.0).side(1) == side else -1
    pair = hypoid14(mesh, mass=masses, moment_of_inertia=polar, supports=springs,
                    torque=torque * np.array([1.0, 1.0 / blank.ratio]), **contact)  # fmt: skip
    teeth = Mesh(
        _GEARS,
        blank.mean_normal_module,
        stiffness=mesh.stiffness,
        contacts=pair.contacts,
        frictions=pair.frictions,
        events=tuple(mesh.event_phases),
        crossed=crossed,
    )
    sizes = ((getattr(blank, f"{n}_{g}") for n in ("teeth", "face_width")) for g in _GEARS)
    return Machine(
        shafts={
            "engine": Shaft(moment_of_inertia=springs.engine_moment_of_inertia),
            **{gear: flexible.get(gear, Shaft()) for gear in _GEARS},
            "load": Shaft(moment_of_inertia=springs.load_moment_of_inertia),
        },
        gears={
            gear: Gear(gear, places.get(gear), *size, *body)
            for gear, size, *body in zip(_GEARS, sizes, masses, polar, across, strict=True)
        },
        meshes={"hypoid": teeth},
        bearings=supported,
        couplings=_couplings(springs, polar),
        operation=Operation("engine", "load", sense * speed, torque),
    )


def _springs(
    gear: str, number: int, position: float, supports: HypoidSupports, body: tuple[float, float]
) -> Bearing:
    """Springs of a gear, each with a damper that is a part of the critical value."""
    radial, axial, tilting = (
        float(np.asarray(getattr(supports, f"{name}_stiffness"))[number])
        for name in ("bearing", "axial_bearing", "tilting")
    )
    mass, across = body
    ratio = 2.0 * supports.bearing_damping_ratio
    return Bearing(
        gear,
        position,
        radial,
        axial,
        tilting,
        radial_damping=ratio * np.sqrt(radial * mass),
        axial_damping=ratio * np.sqrt(axial * mass),
        tilting_damping=ratio * np.sqrt(tilting * across),
    )


def _couplings(supports: HypoidSupports, polar: Any) -> dict[str, Coupling]:
    """Springs and dampers from the engine to the pinion, and from the wheel to the load."""
    couplings = {}
    for number, (name, ends) in enumerate(
        {"engine": ("engine", "pinion"), "load": ("wheel", "load")}.items()
    ):
        spring = float(np.asarray(supports.shaft_stiffness)[number])
        outer = getattr(supports, f"{name}_moment_of_inertia")
        reduced = 1.0 / (1.0 / polar[number] + 1.0 / outer)
        damping = supports.shaft_damping_ratio * 2.0 * np.sqrt(spring * reduced)
        couplings[name] = Coupling(ends, spring, float(damping))
    return couplings
