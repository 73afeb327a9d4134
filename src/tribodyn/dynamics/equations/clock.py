"""One clock for all contacts of a system.

The clock runs from 0 to 1 over a period of the whole motion. A contact whose mesh repeats
``cycles`` times in this period is at the mesh phase ``(cycles*clock + offset) mod 1``. Here its
entries, which are functions of that mesh phase, become functions of the clock; with one cycle and
no offset they stay as they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tribodyn.errors import InputError
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics.equations.system import Contact, LoadFriction

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
