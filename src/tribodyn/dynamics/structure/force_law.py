"""Contacts of a gear mesh: a stiffness, the tangent to a force law, or the force law.

For the kernel a contact is a spring with a dead zone. A convex force law made of ramps is therefore
a bundle of contacts with the same direction, friction and error; each has the stiffness of its
ramp, and half of its dead zone is half of the backlash plus the compression at which the ramp
begins. The back flanks have the same law, mirrored at the middle of the backlash.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, TypeVar, cast, get_args

import numpy as np

from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.nodes import GAP_ROUNDING
from tribodyn.dynamics.equations.system import Contact, LoadFriction, System
from tribodyn.errors import InputError, require_one_of
from tribodyn.nomenclature import GEARS
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshForceLaw, MeshFriction


#: Friction force over mesh force, and its moments on both gears; rows 1 to 3 of the directions.
FRICTION_SUMS = ("friction_sum", *(f"friction_moment_{gear}" for gear in GEARS))


def plane_rows(
    names: Sequence[str], gears: Sequence[str] = GEARS, line_angle: float = 0.5 * np.pi
) -> Array:
    """Rows (4, n): along the line of action, across it, and the rotation of either gear."""
    along = np.array([np.cos(line_angle), np.sin(line_angle)])
    along[np.abs(along) < 1e-15] = 0.0
    ways = {"x": along, "y": np.array([along[1], -along[0]])}
    rows = np.zeros((4, len(names)))
    for gear, sign, turn in zip(gears, (1.0, -1.0), (2, 3), strict=True):
        rows[turn, names.index(f"{gear}_theta")] = sign
        for way, row in (*ways.items(), ("v", ways["x"]), ("w", ways["y"])):
            if f"{gear}_{way}" in names:
                rows[:2, names.index(f"{gear}_{way}")] = sign * row
    return rows


def friction_direction(mesh: object, onto: Array) -> Callable[..., Array]:
    """Friction of a mesh (p, n) from its three sums; a table if all three share their grid."""
    sums = [getattr(mesh, name) for name in FRICTION_SUMS]
    kind, grid = type(sums[0]), getattr(sums[0], "grid", None)
    if hasattr(kind, "onto") and all(type(e) is kind and e.grid is grid for e in sums):
        values = np.stack([each.values for each in sums], axis=-1)
        return cast("Callable[..., Array]", kind(grid, values, onto))
    return lambda phase: np.stack([np.asarray(each(phase)) for each in sums], axis=-1) @ onto


T = TypeVar("T")
#: How the force on the mesh follows from its deflection.
MeshForce = Literal["stiffness", "tangent", "force-law"]


def carried(contact: Contact, mesh: Any, mesh_force: MeshForce) -> tuple[Contact, ...]:
    """Replace the contact of a gear pair by the contacts of its force law."""
    require_one_of("mesh_force", mesh_force, get_args(MeshForce))
    if mesh_force == "stiffness":
        return (contact,)
    if mesh_force == "tangent":
        tangent = _needed(getattr(mesh, "tangent_stiffness", None), "tangent stiffness")
        spring = replace(
            contact, stiffness=tangent, error=sum_of(contact.error, mesh.tangent_error)
        )
        return (replace(contact, stiffness=0.0), replace(spring, damping=0.0))
    return law_contacts(contact, _needed(getattr(mesh, "force_law", None), "force law"))


def _needed(value: T | None, name: str) -> T:
    if value is None:
        why = "It comes from a loaded tooth contact"
        remedy = 'Use such a stiffness model, or mesh_force = "stiffness"'
        raise InputError(f"this mesh has no {name}", "argument mesh_force", why, remedy)
    return value


def sum_of(first: Entry, second: Callable[[Array], Array]) -> Callable[[Array], Array]:
    """Sum of an entry and a function of the mesh phase."""

    def total(phase: Array) -> Array:
        value = first(phase) if callable(first) else first
        return np.asarray(np.asarray(value, dtype=float) + second(phase))

    return total


def law_contacts(contact: Contact, law: MeshForceLaw) -> tuple[Contact, ...]:
    """Replace the stiffness of a contact by a force law: one contact for each ramp.

    Parameters
    ----------
    contact : Contact
        Direction, error, friction, damping and events of all of them; its gap, a constant, is
        half of the backlash.
    law : MeshForceLaw
        Force over the compression beyond the backlash, at every mesh phase.

    Returns
    -------
    tuple of Contact
        The first of them is the last to open and has all the damping. Their forces add up.

    Raises
    ------
    InputError
        If the gap is a function, or a pair touches before the backlash is closed.

    Notes
    -----
    The law acts on both flanks, mirrored at the middle of the backlash. Where no ramp is the lowest
    at all phases, one more contact without stiffness has the damping.

    Examples
    --------
    >>> from tribodyn.mesh import MeshForceLaw, phase_grid
    >>> places, stiffness = np.tile([0.0, 1e-5], (17, 1)), np.tile([2e8, 1e8], (17, 1))
    >>> law = MeshForceLaw(phase_grid((0.0,), 16), places, stiffness)
    >>> [each.damping for each in law_contacts(Contact([1.0], 0.0, damping=900.0, gap=5e-5), law)]
    [900.0, 0.0]
    """
    half, lowest = _half_backlash(contact, law), law.lowest
    ramps = [
        replace(
            contact,
            stiffness=law.over_phase(law.knot_stiffness[:, column]),
            gap=law.over_phase(half + law.knot_deflection[:, column]),
            damping=contact.damping if column == lowest else 0.0,
        )
        for column in range(law.knot_stiffness.shape[1])
    ]
    carrying = [ramps[column] for column in _upper_ramps(law)]
    if lowest is not None:
        return (ramps[lowest], *carrying)
    opening = law.over_phase(half + law.knot_first_touch)
    return (replace(contact, stiffness=0.0, gap=opening), *carrying)


def law_contact(contact: Contact, law: MeshForceLaw) -> Contact:
    """Replace the stiffness of a contact by a force law: one contact with ramps.

    Parameters
    ----------
    contact : Contact
        As for :func:`law_contacts`.
    law : MeshForceLaw
        Force over the compression beyond the backlash, at every mesh phase.

    Returns
    -------
    Contact
        Its force is the sum of those of :func:`law_contacts`. Harmonic balance and the modal engine
        take it: a force law costs them hardly more than a spring.

    Raises
    ------
    InputError
        As :func:`law_contacts`.

    Examples
    --------
    >>> from tribodyn.mesh import MeshForceLaw, phase_grid
    >>> places, stiffness = np.tile([0.0, 1e-5], (17, 1)), np.tile([2e8, 1e8], (17, 1))
    >>> law = MeshForceLaw(phase_grid((0.0,), 16), places, stiffness)
    >>> law_contact(Contact([1.0], 0.0, gap=5e-5), law).ramp_gap(0.25)
    array([6.e-05])
    """
    half, lowest, upper = _half_backlash(contact, law), law.lowest, _upper_ramps(law)
    if lowest is None:
        stiffness: Entry = 0.0
        gap = law.over_phase(half + law.knot_first_touch)
    else:
        stiffness = law.over_phase(law.knot_stiffness[:, lowest])
        gap = law.over_phase(half + law.knot_deflection[:, lowest])
    ramps: dict[str, Any] = {}
    if upper:
        ramps["ramp_stiffness"] = law.over_phase(law.knot_stiffness[:, upper])
        ramps["ramp_gap"] = law.over_phase(half + law.knot_deflection[:, upper])
    return replace(contact, stiffness=stiffness, gap=gap, **ramps)


def _upper_ramps(law: MeshForceLaw) -> list[int]:
    """Columns of the ramps that carry, less the lowest one."""
    carrying = np.flatnonzero(law.knot_stiffness.any(axis=0)).tolist()
    return [column for column in carrying if column != law.lowest]


def _half_backlash(contact: Contact, law: MeshForceLaw) -> float:
    """Half of the backlash, in which the teeth are not clamped."""
    if callable(contact.gap) or np.ndim(contact.gap):
        what = "gap is not a constant"
        why = "It is half of the backlash; the law defines where each ramp begins"
        remedy = "Give a constant gap, and a law whose ramps vary"
        raise InputError(what, "argument contact", why, remedy)
    half = float(np.asarray(contact.gap))
    refuse_clamped_teeth(float(law.knot_first_touch.min()), half)
    return half


def refuse_clamped_teeth(first: float, half: float) -> None:
    """Refuse half of a backlash in which teeth whose first touch lies below zero are clamped."""
    if half + first < -GAP_ROUNDING:
        raise InputError(
            f"a pair touches {-1e6 * first:.4g} um before the nominal flanks do, and half "
            f"of the backlash is {1e6 * half:.4g} um",
            where="argument backlash",
            why="The teeth would be clamped between both flanks",
            remedy=f"Give a backlash of at least about {-2e6 * first:.4g} um",
        )


def follow_load(system: System, friction: MeshFriction) -> System:
    """Replace the friction of a mesh by friction that follows its dynamic load.

    Parameters
    ----------
    system : System
        Of one gear pair, its coordinates named ``pinion_theta``, ``wheel_theta`` and, where the
        gears move across the line of action, ``pinion_x`` and ``wheel_x`` (or ``_v``).
    friction : MeshFriction
        Friction of the same mesh over phase and load.

    Returns
    -------
    System
        The same without the friction of its contacts, which all belong to this mesh: friction
        coefficients and load shares are those of the sum of their forces.

    Raises
    ------
    InputError
        If the coordinates are not named like those of a gear pair.

    Notes
    -----
    Friction acts on the pinion against its sliding relative to the wheel, for either driving gear,
    with the radius of curvature as lever, and tilts gears in space by its couple. Load shares are
    those of the static loads.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from tribodyn.dynamics import torsional
    >>> flat = SimpleNamespace(stiffness=lambda p: 3e8 + 0 * p, friction_sum=lambda p: 0 * p,
    ...     friction_moment_pinion=lambda p: 0 * p, friction_moment_wheel=lambda p: 0 * p,
    ...     event_phases=(0.0,))
    >>> pair = torsional(
    ...     flat, moment_of_inertia=1e-3, base_radius=(0.03, 0.05), torque=(90.0, 150.0))
    >>> rubbing = SimpleNamespace(load=3000.0, limit=3.0, grid=SimpleNamespace(event_phases=(0.0,)),
    ...     channel=lambda name: [2e-3, 1e-4])
    >>> [each.direction.tolist() for each in follow_load(pair, rubbing).frictions]
    [[1.0, 0.0], [0.0, -1.0]]
    """
    contacts, frictions = with_load_friction(tuple(system.names), system.contacts, friction)
    return replace(system, contacts=contacts, frictions=(*system.frictions, *frictions))


def with_load_friction(
    names: tuple[str, ...], contacts: Sequence[Contact], friction: MeshFriction
) -> tuple[tuple[Contact, ...], tuple[LoadFriction, ...]]:
    """Contacts of a mesh without friction, and its friction that follows their load."""
    events = tuple(friction.grid.event_phases)
    everyone = tuple(range(len(contacts)))
    frictions = tuple(
        LoadFriction(
            direction=direction,
            coefficients=friction.channel(name),
            load=friction.load,
            contacts=everyone,
            limit=friction.limit,
            events=events,
        )
        for name, direction in _directions(names, friction).items()
        if direction.any()
    )
    smooth = tuple(
        replace(contact, friction=None, events=tuple(sorted({*contact.events, *events})))
        for contact in contacts
    )
    return smooth, frictions


def _directions(names: tuple[str, ...], friction: MeshFriction) -> dict[str, Array]:
    """Direction of each friction sum of the mesh over the coordinates."""
    missing = [name for name in (f"{gear}_theta" for gear in GEARS) if name not in names]
    if missing:
        why = f"Friction acts on the gears, and the coordinates are {', '.join(names)}"
        remedy = "Name the coordinates accordingly, or pass LoadFriction to System"
        raise InputError(f"no coordinate is named {missing[0]}", "argument system", why, remedy)
    if getattr(friction, "wrench", None) is not None and "pinion_theta_x" in names:
        return {
            f"friction_{name}": (np.array(names) == name).astype(float)
            for name in names
            if name.partition("_")[0] in GEARS
        }
    rows = dict(zip(FRICTION_SUMS, plane_rows(names)[1:], strict=True))
    tilts = [names.index(name) for name in (f"{gear}_theta_y" for gear in GEARS) if name in names]
    if tilts and getattr(friction, "couple", None) is not None:
        rows["friction_couple"] = np.zeros(len(names))
        rows["friction_couple"][tilts] = -1.0, 1.0
    return rows
