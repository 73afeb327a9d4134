"""A lumped structure and its contacts: the data of one kernel, whatever the machine.

``M q'' + C q' + K q = f - sum_j [h_j(phi) + s_j(phi)] N_j`` with
``N_j = k_j(phi) g(delta_j) + c_j(phi) delta_j'`` while in contact, ``delta_j = h_j(phi).q -
e_j(phi)``, ``g`` a dead zone of half width ``gap``, ``phi`` the mesh phase, ``h`` the direction
of the line of action in generalized coordinates and ``s`` the direction of friction, which
already carries the sign of sliding, the friction coefficients and the load shares. The mesh phase
of each contact follows from the clock of the system, ``phi_j = (cycles_j*clock + offset_j) mod 1``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arrays.memory import Memo
from tribodyn.dynamics.equations.entry import Entry, read_events, varies
from tribodyn.dynamics.equations.phases import (
    Cycles,
    Turning,
    count_phases,
    narrowed,
    on_clock,
    on_one_clock,
    read_cycles,
    read_turning,
    refuse_several_clocks,
    with_turning_error,
)
from tribodyn.errors import InputError, real_numbers, require_between, require_positive
from tribodyn.nomenclature import require_flag, require_number, require_whole
from tribodyn.types import Array, Mask


@dataclass(frozen=True)
class Contact:
    """One contact of a structure: direction, force law and friction over the mesh phase.

    Each entry is a constant or a vectorized function of the mesh phase in [0, 1). A function for
    ``direction`` or ``friction`` takes phases of shape (p,) and returns (p, n).

    Parameters
    ----------
    direction : (n,) array or function
        Derivative of the contact's compression with respect to the coordinates [1 or m].
    stiffness : float or function
        Contact stiffness [N/m].
    damping : float or function
        Contact damping [N*s/m], acting while in contact.
    error : float or function
        Displacement error subtracted from the compression [m].
    gap : float or function
        Half of the dead zone [m]. Zero makes the contact linear, without separation.
    friction : (n,) array or function, optional
        Generalized friction force per unit contact force [1 or m].
    events : tuple of float
        Mesh phases at which an entry jumps. They become grid points, and values there are taken
        from the left and from the right separately. The beginning of the mesh cycle always is one;
        a function that jumps anywhere else or depends on more than the phase is refused.
    damping_in_gap : bool
        Keep the damping in free flight. Unphysical; for comparison with published models.
    cycles : int or tuple of int
        Mesh cycles of this contact in one period of the clock; or, for a motion over independent
        phases, in one period of each of them.
    offset : float
        Mesh phase of this contact when the clock starts, in [0, 1).
    ramp_stiffness, ramp_gap : (m,) array or function
        Ramps of a force law: stiffnesses that are added beyond further half dead zones [N/m], [m];
        functions return (p, m). Harmonic balance and the modal engine take them.
    turning_error : function or sequence of function
        Errors that turn with a shaft and add to ``error``, such as that of an eccentric gear:
        functions of the phase of that shaft [m].
    turning_cycles : tuple of int or sequence of these
        For each turning error, the turns of its shaft in one period of each phase; of one clock a
        tuple of one number.
    name : str
        Name of the mesh or support in messages; its number by default.
    period : int
        Mesh cycles after which the entries repeat, more than one where teeth differ: they are then
        functions of the phase of all of these, which ``cycles`` counts.

    Raises
    ------
    InputError
        If an event or the offset lies outside [0, 1), the direction is zero, or ``cycles`` is not
        a whole number of at least 1.

    Notes
    -----
    With ramps the spring force is ``k g(d, gap) + sum_m k_m g(d, gap_m)``, where ``g(d, gap)`` is
    the compression beyond a half dead zone. The damping acts where the first spring does.

    Examples
    --------
    >>> Contact(direction=[1.0], stiffness=lambda phase: 1.0 + 0.2 * np.cos(2 * np.pi * phase))
    Contact(stiffness=function, gap=0.0, events=(0.0,))
    """

    direction: Entry
    stiffness: Entry
    damping: Entry = 0.0
    error: Entry = 0.0
    gap: Entry = 0.0
    friction: Entry | None = None
    events: tuple[float, ...] = (0.0,)
    damping_in_gap: bool = False
    cycles: Cycles = 1
    offset: float = 0.0
    ramp_stiffness: Entry = ()
    ramp_gap: Entry = ()
    turning_error: Any = ()
    turning_cycles: Any = ()
    name: str = ""
    period: int = 1

    def __post_init__(self) -> None:
        object.__setattr__(self, "events", read_events(self.events, "Contact.events"))
        require_flag("damping_in_gap", self.damping_in_gap)
        object.__setattr__(self, "cycles", read_cycles("cycles", self.cycles))
        object.__setattr__(self, "period", require_whole("period", self.period))
        read_turning(self.turning_error, self.turning_cycles)
        require_number("offset", self.offset)
        require_between("offset", self.offset, 0.0, float(np.nextafter(1.0, 0.0)), "")
        where = "Contact.direction"
        if not varies(self.direction) and not real_numbers(where, self.direction).any():
            raise no_direction(where)

    @property
    def turning(self) -> tuple[Turning, ...]:
        """Turning errors with their cycles."""
        return read_turning(self.turning_error, self.turning_cycles)

    def __repr__(self) -> str:
        """One line."""
        stiffness = "function" if callable(self.stiffness) else f"{self.stiffness}"
        gap = "function" if callable(self.gap) else f"{self.gap}"
        clock = "" if self.cycles == 1 else f", cycles={self.cycles}, offset={self.offset:g}"
        return f"Contact(stiffness={stiffness}, gap={gap}, events={self.events}{clock})"


@dataclass(frozen=True)
class LoadFriction:
    """Friction whose coefficient follows the contact force.

    Parameters
    ----------
    direction : (n,) array or function
        Generalized force against which one newton of friction acts [1 or m]; a function takes
        mesh phases (p,) and returns (p, n).
    coefficients : float, (m,) array or function
        ``c_0, c_1, ...`` of ``F/N = sum_k c_k x^k``, with the sign of sliding [1]; a function
        returns (p, m).
    load : float
        Contact force at which ``x = 1`` [N].
    contacts : tuple of int
        Contacts whose forces add up to N; the ramps of one force law belong together.
    limit : float
        Largest ``x``: beyond it the coefficient stays as it is there [1].
    events : tuple of float
        Mesh phases at which an entry jumps, in addition to those of the contacts.

    Raises
    ------
    InputError
        If load or limit is not positive, no contact is named, or an event lies outside [0, 1).

    Notes
    -----
    ``x = min(|N|/load, limit)``. The friction has the sign of N: during back-side contact, or while
    a damper pulls, N is negative and the friction reverses, as that of :class:`Contact` does.

    Examples
    --------
    >>> LoadFriction(direction=[1.0, -1.0], coefficients=[0.05, 0.01, -0.002], load=1000.0)
    LoadFriction(load=1000.0, contacts=(0,))
    """

    direction: Entry
    coefficients: Entry
    load: float
    contacts: tuple[int, ...] = (0,)
    limit: float = 4.0
    events: tuple[float, ...] = (0.0,)

    def __post_init__(self) -> None:
        for name, unit in (("load", "N"), ("limit", "")):
            require_number(name, getattr(self, name))
            require_positive(name, getattr(self, name), unit)
        object.__setattr__(self, "events", read_events(self.events, "LoadFriction.events"))
        contacts = (self.contacts,) if isinstance(self.contacts, int) else self.contacts
        listed = real_numbers("LoadFriction.contacts", contacts, "whole numbers").reshape(-1)
        numbers = tuple(require_whole("contacts", contact, 0) for contact in listed)
        if not numbers or min(numbers) < 0:
            why = "The friction follows the force of one or more contacts"
            remedy = "Give their indices in System.contacts, counted from 0"
            raise InputError(f"contacts = {numbers}", "LoadFriction.contacts", why, remedy)
        object.__setattr__(self, "contacts", numbers)

    def __repr__(self) -> str:
        """One line."""
        return f"LoadFriction(load={self.load}, contacts={self.contacts})"


def contact_label(system: System, contact: int) -> str:
    """Name of a contact in messages."""
    return system.contacts[contact].name or f"contact {contact}"


def no_direction(where: str) -> InputError:
    """Error of a contact that no motion compresses."""
    why = "No coordinate compresses the contact, so that it never transmits a force"
    remedy = "Give the derivative of the compression with respect to each coordinate"
    return InputError("the direction is zero", where, why, remedy)


def _matrix(name: str, value: ArrayLike) -> Array:
    matrix = np.array(real_numbers(f"System.{name}", value), ndmin=2)
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
        what = f"{name} has the shape {matrix.shape}"
        remedy = "Give a list of rows, as many as there are coordinates"
        raise InputError(what, f"System.{name}", "It must be a square (n, n) matrix", remedy)
    if not np.all(np.isfinite(matrix)):
        what, why = f"{name} holds NaN or infinity", "The equations of motion need finite numbers"
        raise InputError(what, f"System.{name}", why, "Correct the entry that is not finite")
    return matrix


@dataclass(frozen=True)
class System:
    """A lumped structure with its contacts.

    Parameters
    ----------
    mass, damping, stiffness : (n, n) array
        Structural matrices without the contacts [kg or kg*m^2, N*s/m, N/m, ...].
    force : (n,) array or function
        External generalized force [N or N*m]; a function of the clock returns (p, n).
    contacts : sequence of Contact
        Any number of contacts, each with its own mesh cycles in a period of the clock.
    names : sequence of str, optional
        Names of the coordinates; ``q0, q1, ...`` by default.
    balance : (n,) array, optional
        Direction of a torque whose size is determined so that the free rotation of the drive has
        a constant mean speed [N*m per unit]. Without it all forces are as prescribed.
    frictions : sequence of LoadFriction
        Frictions whose coefficients follow the contact forces.
    gyroscopic : (n, n) array, optional
        Skew matrix of the gyroscopic moments at the speed of the motion, added to the damping
        matrix; it does no work [N*s/m or N*m*s].
    lead : function, optional
        Time by which an unsteady rotation is ahead of its mean [s], of a motion over phases: takes
        points (p, phases), returns this time and the rates at which it grows with each phase,
        (p,) and (p, phases). All mesh phases and all that turns with shafts follow it.
    phase_names : sequence of str, optional
        What turns with each phase, for messages.

    Raises
    ------
    InputError
        If shapes disagree, a value is not finite, the mass matrix is not symmetric and positive
        definite, the gyroscopic matrix is not skew, or a friction refers to a contact that does not
        exist or to contacts with different ``cycles`` or ``offset``.

    Examples
    --------
    >>> System(mass=[[1.0]], damping=[[0.1]], stiffness=[[0.0]], force=[0.5],
    ...        contacts=[Contact(direction=[1.0], stiffness=1.0, gap=1.0)])
    System(1 coordinates, 1 contact)
    """

    mass: ArrayLike
    damping: ArrayLike
    stiffness: ArrayLike
    force: Entry
    contacts: Sequence[Contact] = ()
    names: Sequence[str] = ()
    balance: ArrayLike | None = None
    frictions: Sequence[LoadFriction] = ()
    gyroscopic: ArrayLike | None = None
    lead: Callable[[Array], tuple[Array, Array]] | None = None
    phase_names: Sequence[str] = ()
    #: Largest rate of the motion by the number of steps with which it was computed.
    _rates: dict[int, float] = field(default_factory=dict, init=False, repr=False, compare=False)
    #: Matrices about the static load, by the phase at which they were computed.
    _linear: dict[Any, Any] = field(default_factory=dict, init=False, repr=False, compare=False)
    #: Widest step over a mesh cycle when the entries were checked for jumps and randomness.
    _checked: float = field(default=np.inf, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        matrices = {name: _matrix(name, getattr(self, name)) for name in _MATRICES}
        size = matrices["mass"].shape[0]
        for name, matrix in matrices.items():
            if matrix.shape != (size, size):
                what = f"{name} has the shape {matrix.shape}, mass has {(size, size)}"
                why = "All three matrices belong to the same coordinates"
                remedy = "Give it the shape of the mass matrix"
                raise InputError(what, f"System.{name}", why, remedy)
            object.__setattr__(self, name, matrix)
        contacts = (self.contacts,) if isinstance(self.contacts, Contact) else self.contacts
        single_friction = isinstance(self.frictions, LoadFriction)
        frictions = (self.frictions,) if single_friction else self.frictions
        for name, parts, kind in (
            ("contacts", contacts, Contact),
            ("frictions", frictions, LoadFriction),
            ("names", self.names, str),
        ):
            if not isinstance(parts, list | tuple) or not all(isinstance(p, kind) for p in parts):
                what = f"{name} is not a sequence of {kind.__name__}"
                why = "A system can have several of them"
                raise InputError(what, f"System.{name}", why, "Give a list or a tuple")
        object.__setattr__(self, "frictions", tuple(frictions))
        object.__setattr__(self, "contacts", tuple(contacts))
        names = tuple(self.names) or tuple(f"q{i}" for i in range(size))
        if len(names) != size:
            what = f"{len(names)} names for {size} coordinates"
            remedy = "Give as many names as coordinates, or none"
            raise InputError(what, "System.names", "Every coordinate has one name", remedy)
        object.__setattr__(self, "names", names)
        _inverse_of(matrices["mass"], names)
        _refuse_missing_contacts(self)
        if not self.phases and self.lead is not None:
            what, why = "a lead without phases", "It is a function of the phases of the contacts"
            remedy = (
                "Give cycles for each phase, or entries over the clock of the unsteady rotation"
            )
            raise InputError(what, "System.lead", why, remedy)
        for f, friction in enumerate(self.frictions):
            refuse_several_clocks(friction, self.contacts, f"System.frictions[{f}]")
        if self.gyroscopic is not None:
            object.__setattr__(self, "gyroscopic", _skew(self.gyroscopic, size))
        if self.balance is not None:
            balance = real_numbers("System.balance", self.balance)
            if balance.shape != (size,):
                what = f"balance has the shape {balance.shape}, not ({size},)"
                why = "It is the torque on each coordinate"
                raise InputError(what, "System.balance", why, "Give one number for each coordinate")
            object.__setattr__(self, "balance", balance)

    @cached_property
    def size(self) -> int:
        """Number of coordinates."""
        return int(np.asarray(self.mass).shape[0])

    @cached_property
    def inverse_mass(self) -> Array:
        """Inverse of the mass matrix, (n, n) [1/kg or 1/(kg*m^2)]."""
        return _inverse_of(np.asarray(self.mass), tuple(self.names))

    @cached_property
    def over_mass(self) -> tuple[Array, Array]:
        """Inverse of the mass matrix times stiffness and damping, (n, n) [1/s^2] and [1/s]."""
        inverse = self.inverse_mass
        return inverse @ np.asarray(self.stiffness), inverse @ self.rate_matrix

    @cached_property
    def rate_matrix(self) -> Array:
        """Damping plus gyroscopic matrix, (n, n) [N*s/m or N*m*s]."""
        damping = np.asarray(self.damping)
        return damping if self.gyroscopic is None else damping + np.asarray(self.gyroscopic)

    @property
    def phases(self) -> int:
        """Number of independent phases; 0 where all contacts follow one clock."""
        return count_phases(self.contacts, led=self.lead is not None)

    @cached_property
    def cycles(self) -> int:
        """Mesh cycles of the fastest contact in one period of the clock."""
        return max((each.cycles * each.period for each in on_one_clock(self)), default=1)

    @cached_property
    def _narrow(self) -> tuple[System, Array] | None:
        """The same contacts over fewer coordinates (c, n), where their directions span few."""
        return narrowed(self)

    @cached_property
    def _damped_in_gap(self) -> Mask:
        """Contacts whose damping acts in the gap too."""
        return np.array([contact.damping_in_gap for contact in self.contacts], dtype=bool)

    @cached_property
    def clocked_contacts(self) -> tuple[Contact, ...]:
        """Contacts whose entries and events are over the clock."""
        contacts = on_one_clock(self)
        clocked = (on_clock(c, CONTACT_ENTRIES, c.cycles, c.offset) for c in contacts)
        return tuple(map(with_turning_error, clocked))

    @cached_property
    def clocked_frictions(self) -> tuple[LoadFriction, ...]:
        """Frictions whose entries and events are over the clock."""
        clocked = on_one_clock(self)
        clocks = [clocked[friction.contacts[0]] for friction in self.frictions]
        return tuple(
            on_clock(friction, FRICTION_ENTRIES, clock.cycles, clock.offset)
            for friction, clock in zip(self.frictions, clocks, strict=True)
        )

    def __repr__(self) -> str:
        """One line."""
        count = len(self.contacts)
        return f"System({self.size} coordinates, {count} contact{'s' if count != 1 else ''})"


_MATRICES = ("mass", "damping", "stiffness")
CONTACT_ENTRIES = (
    "direction", "stiffness", "damping", "error", "gap", "friction", "ramp_stiffness", "ramp_gap"
)  # fmt: skip
FRICTION_ENTRIES = ("direction", "coefficients")
#: Inverses of mass matrices: a study builds the same structure many times.
_inverses: Memo[Array] = Memo(8)


def _skew(value: ArrayLike, size: int) -> Array:
    matrix = _matrix("gyroscopic", value)
    skew = matrix.shape == (size, size)
    if not skew or np.abs(matrix + matrix.T).max() > 1e-9 * np.abs(matrix).max():
        what = "the gyroscopic matrix " + ("is not skew" if skew else f"is not ({size}, {size})")
        why = "Gyroscopic moments do no work, so that G = -G^T"
        raise InputError(what, "System.gyroscopic", why, "Put damping into System.damping")
    return matrix


def _inverse_of(mass: Array, names: tuple[str, ...]) -> Array:
    def inverse() -> Array:
        _refuse_singular(mass, names)
        return np.asarray(np.linalg.inv(mass))

    return _inverses.get((mass,), inverse)


def _refuse_singular(mass: Array, names: tuple[str, ...]) -> None:
    scale = np.sqrt(np.abs(np.diag(mass)))
    empty = np.flatnonzero(scale == 0.0)
    if empty.size or np.linalg.cond(mass / np.outer(scale, scale)) > 1e12:
        at = int(empty[0]) if empty.size else 0
        detail = f"coordinate {at} has no inertia ({names[at]})"
        raise InputError(
            "the mass matrix cannot be inverted: "
            + (detail if empty.size else f"it is singular{_without_inertia(mass, names)}"),
            where="System.mass",
            why="Every coordinate needs an inertia",
            remedy="Remove the coordinate, or give it a mass or moment of inertia",
        )
    even = np.abs(mass - mass.T).max() <= 1e-9 * np.abs(mass).max()
    if not even or np.linalg.eigvalsh(mass / np.outer(scale, scale))[0] <= 0.0:
        raise InputError(
            "the mass matrix is not symmetric and positive definite"
            + ("" if not even else _without_inertia(mass, names)),
            where="System.mass",
            why="Every motion has a kinetic energy greater than zero",
            remedy="Check signs and positions of the entries of the matrix",
        )


def _without_inertia(mass: Array, names: tuple[str, ...]) -> str:
    """Name the coordinates that move most in the motion with the least kinetic energy."""
    scale = np.sqrt(np.abs(np.diag(mass)))
    even = 0.5 * (mass + mass.T) / np.outer(scale, scale)
    motion = np.abs(np.linalg.eigh(even)[1][:, 0])
    most = [names[i] for i in np.flatnonzero(motion > 0.5 * motion.max())]
    return f", a motion of {' and '.join(most[:4])} has no kinetic energy"


def _refuse_missing_contacts(system: System) -> None:
    for f, friction in enumerate(system.frictions):
        if max(friction.contacts) >= len(system.contacts):
            count = len(system.contacts)
            raise InputError(
                f"friction {f} follows contact {max(friction.contacts)}, and there "
                + (f"are {count} contacts" if count != 1 else "is 1 contact"),
                where=f"System.frictions[{f}].contacts",
                why="Contacts are counted from 0 in the order of System.contacts",
                remedy="Give the numbers of contacts that the system has",
            )
