"""Contacts over several independent phases: their numbers of cycles, and what turns with a shaft.

A phase runs from 0 to 1 at a frequency of its own. A contact whose mesh repeats ``cycles`` times
over each phase is at the mesh phase ``(sum cycles_d phase_d + offset) mod 1``. Entries that turn
with a shaft are functions of another sum of the phases.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from tribodyn.errors import InputError
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics.equations.entry import Entry
    from tribodyn.dynamics.equations.system import Contact, LoadFriction, System


#: Largest ratio of two frequencies.
_RATIO = 1e5
#: Entries that are directions.
_DIRECTED = ("direction", "friction")
#: Mesh cycles over one clock, or over each independent phase.
Cycles = int | tuple[int, ...]


class Turning(NamedTuple):
    """An error of a contact as a function of the phase of a shaft."""

    error: Callable[[Array], Any]  #: function of the phase of the shaft [m]
    cycles: tuple[int, ...]  #: turns of the shaft over each phase


def read_cycles(name: str, value: object) -> Cycles:
    """Whole number of at least 1 over one clock, or one whole number for each phase."""
    if not isinstance(value, list | tuple | np.ndarray):
        return require_whole(name, value)
    numbers = tuple(require_whole(name, number, -(2**31)) for number in value)
    if not any(numbers):
        what, why = f"{name} = {tuple(value)}", "The entries repeat over at least one phase"
        raise InputError(what, f"Contact.{name}", why, "Give a whole number other than 0")
    return numbers[0] if len(numbers) == 1 and numbers[0] > 0 else numbers


def read_turning(error: Any, cycles: Any) -> tuple[Turning, ...]:
    """Turning errors of a contact: one function with its cycles, or as many of both."""
    functions = list(error) if isinstance(error, list | tuple) else [error]
    if not all(map(callable, functions)):
        what, why = f"turning_error = {error}", "It is a function of the phase of a shaft"
        raise InputError(what, "Contact.turning_error", why, "Give a function, or one a shaft")
    nested = not isinstance(cycles, int) and any(map(np.ndim, cycles))
    counts = [cycles] if callable(error) and cycles and not nested else list(cycles)
    if len(functions) != len(counts):
        what = f"{len(functions)} turning errors and {len(counts)} turning cycles"
        why = "Each is a function of the phase of one shaft, with the turns of it over each phase"
        raise InputError(what, "Contact.turning_cycles", why, "Give as many of both")
    terms = []
    for function, count in zip(functions, counts, strict=True):
        numbers = read_cycles("turning_cycles", count)
        numbers = (numbers,) if isinstance(numbers, int) else numbers
        terms.append(Turning(function, numbers))
    return tuple(terms)


def count_phases(contacts: Sequence[Contact], *, led: bool = False) -> int:
    """Number of independent phases; 0 for one clock, unless a lead is a function of its phase."""
    counts = [contact.cycles for contact in contacts]
    counts += [term.cycles for contact in contacts for term in contact.turning]
    phases = {len(count) for count in counts if isinstance(count, tuple)}
    if not phases:
        return 0
    if len(phases) > 1 or (phases != {1} and any(isinstance(count, int) for count in counts)):
        listed = ", ".join(map(str, dict.fromkeys(counts)))
        what, why = f"cycles = {listed}", "All contacts of a system have the same phases"
        remedy = "Give every contact one whole number for each phase"
        raise InputError(what, "Contact.cycles", why, remedy)
    clocked = phases == {1} and all(isinstance(each.cycles, int) for each in contacts)
    return 0 if clocked and not led else phases.pop()


def on_one_clock(system: System) -> list[Any]:
    """Contacts of a system, which have whole numbers of cycles on one clock; refuse others."""
    if system.phases:
        raise InputError(
            f"the system has {system.phases} phase{'s' if system.phases > 1 else ''} without a "
            "common clock",
            "Contact.cycles",
            "This computation needs the period of one clock, which such phases do not have",
            "Use harmonic_balance with one frequency for each phase, or give whole numbers of "
            "cycles in the period of one clock",
        )
    return list(system.contacts)


def read_frequencies(value: object, phases: int) -> Array:
    """Frequencies of all phases [Hz]."""
    values = np.atleast_1d(np.asarray(value, dtype=float))
    if values.shape != (phases,) or not np.all(np.isfinite(values)) or not np.all(values > 0.0):
        what = f"frequency = {value}"
        why = f"The contacts have {phases} independent phases, each with a positive frequency [Hz]"
        raise InputError(what, "frequency", why, f"Give {phases} numbers, one for each phase")
    ratio = float(values.max() / values.min())
    if ratio > _RATIO:
        what = (
            f"frequency = {value}: the fastest phase has {ratio:.3g} cycles in one of the slowest"
        )
        why = f"A motion is recorded over a cycle of the slowest phase, at most {_RATIO:g} cycles"
        raise InputError(what, "frequency", why, "Take what turns so slowly as constant")
    return values


def phase_sum(points: Array, cycles: Iterable[int], offset: float | Array = 0.0) -> Array:
    """Mesh phase in [0, 1) at points (p, phases)."""
    return np.asarray((points @ np.asarray(cycles, dtype=float) + offset) % 1.0 % 1.0)


T = TypeVar("T", "Contact", "LoadFriction")


class ClockEntry:
    """An entry over the clock, from a function of the mesh phase."""

    def __init__(self, function: Any, cycles: int, offset: float) -> None:
        self.function, self.cycles, self.offset = function, cycles, offset

    def __call__(self, clock: Array) -> Any:
        """Values at phases of the clock."""
        return self.function((self.cycles * clock + self.offset) % 1.0)

    def __getattr__(self, name: str) -> Any:
        # Only a table knows where it jumps; any other function is examined for jumps.
        if name == "event_phases":
            events = (0.0, *self.function.event_phases)
            self.event_phases = events_on_clock(events, self.cycles, self.offset)
            return self.event_phases
        raise AttributeError(name)


def table_of(entry: Any) -> tuple[Any, int, float] | None:
    """Table that an entry looks up, and the clock at whose phases; None for other entries."""
    clocked = isinstance(entry, ClockEntry)
    table = entry.function if clocked else entry
    if not (hasattr(table, "grid") and isinstance(getattr(table, "values", None), np.ndarray)):
        return None
    return (table, entry.cycles, entry.offset) if clocked else (table, 1, 0.0)


def narrower(entry: object) -> tuple[Entry, Array] | None:
    """Table with fewer columns and the matrix that makes them those of an entry, if it has both."""
    if (looked_up := table_of(entry)) is None:
        return None
    table, cycles, offset = looked_up
    if (onto := getattr(table, "onto", None)) is None or 2 * len(onto) > onto.shape[1]:
        return None
    narrow = replace(table, onto=None)
    return (ClockEntry(narrow, cycles, offset) if isinstance(entry, ClockEntry) else narrow), onto


def narrowed(system: System) -> tuple[System, Array] | None:
    """Contacts over the few coordinates (c, n) of their tables, without a structure."""
    # None where a direction or a load is no such table, or there are few coordinates anyway.
    parts = [*system.contacts, *system.frictions]
    directions = [getattr(part, name, None) for part in parts for name in _DIRECTED]
    entries = [entry for entry in directions if entry is not None]
    tables = [
        each for each in entries if table_of(each) and getattr(each, "onto", None) is not None
    ]
    if len(tables) < len(entries) or callable(system.force):
        return None
    matrices = {id(each.onto): each.onto for each in tables}
    ends = np.cumsum([0, *map(len, matrices.values())])
    if not 0 < 2 * ends[-1] <= system.size:
        return None
    places = dict(zip(matrices, np.split(np.eye(ends[-1]), ends[1:-1]), strict=True))
    moved = {id(each): replace(each, onto=places[id(each.onto)]) for each in entries}

    def over(part: T) -> T:
        named = {name: getattr(part, name, None) for name in _DIRECTED}
        given = {name: moved[id(each)] for name, each in named.items() if each is not None}
        return replace(part, **given)

    still = np.zeros((ends[-1], ends[-1]))
    narrow = replace(
        system, mass=np.eye(ends[-1]), damping=still, stiffness=still, force=still[0], names=(),
        balance=None, gyroscopic=None, contacts=tuple(map(over, system.contacts)),
        frictions=tuple(map(over, system.frictions)),
    )  # fmt: skip
    return narrow, np.concatenate([*matrices.values()])


def same_entry(first: object, second: object) -> bool:
    """Whether two entries are one function over the same clock, as those of the ramps of a law."""
    if isinstance(first, ClockEntry) and isinstance(second, ClockEntry):
        clocks = (first.cycles, first.offset), (second.cycles, second.offset)
        return clocks[0] == clocks[1] and first.function is second.function
    return callable(first) and first is second


def events_on_clock(events: tuple[float, ...], cycles: int, offset: float) -> tuple[float, ...]:
    """Phases of the clock at which events of a mesh take place, sorted."""
    if cycles == 1 and offset == 0.0:
        return events
    at = (np.add.outer(np.arange(cycles), np.asarray(events)) - offset) / cycles
    return tuple(np.unique(at % 1.0 % 1.0).tolist())


def on_clock(part: T, names: tuple[str, ...], cycles: int, offset: float) -> T:
    """Contact or friction with the entries ``names`` and the events over the clock."""
    if cycles == 1 and offset == 0.0:
        return part

    def entry(value: object) -> Any:
        if callable(value):
            return ClockEntry(value, cycles, offset)
        return [entry(item) for item in value] if isinstance(value, list | tuple) else value

    entries = {name: entry(getattr(part, name)) for name in names}
    clock: dict[str, Any] = {}
    if (period := getattr(part, "period", None)) is not None:
        clock = {"cycles": 1, "offset": 0.0, "period": cycles * period}
    return replace(part, **entries, events=events_on_clock(part.events, cycles, offset), **clock)


class _TurnedError:
    """Error of a contact over the clock, with those that turn with shafts."""

    def __init__(self, contact: Contact) -> None:
        self.error: Any = contact.error
        self.turning = contact.turning

    def __call__(self, clock: Array) -> Any:
        """Values at phases of the clock."""
        fixed = self.error(clock) if callable(self.error) else self.error
        turned = (each.error(each.cycles[0] * clock % 1.0) for each in self.turning)
        return sum(turned, np.asarray(fixed, dtype=float))

    def __getattr__(self, name: str) -> Any:
        if name == "event_phases":  # as of a ClockEntry
            return self.error.event_phases
        raise AttributeError(name)


def with_turning_error(contact: Contact) -> Contact:
    """A contact over the clock whose error contains those that turn with shafts."""
    if not contact.turning:
        return contact
    return replace(contact, error=_TurnedError(contact), turning_error=(), turning_cycles=())


def refuse_several_clocks(friction: LoadFriction, contacts: Sequence[Contact], where: str) -> None:
    """Refuse a friction that follows contacts with different mesh cycles or offsets."""
    clocks = {(contacts[j].cycles, contacts[j].offset) for j in friction.contacts}
    if len(clocks) > 1:
        listed = " and ".join(f"{cycles} with offset {offset:g}" for cycles, offset in clocks)
        raise InputError(
            f"the friction follows contacts with different mesh cycles: {listed}",
            where=where,
            why="Its entries are functions of one mesh phase, that of the contacts it follows",
            remedy="Give one friction for each mesh",
        )
