"""Contacts over several independent phases: their numbers of cycles, and what turns with a shaft.

A phase runs from 0 to 1 at a frequency of its own. A contact whose mesh repeats ``cycles`` times
over each phase is at the mesh phase ``(sum cycles_d phase_d + offset) mod 1``. Entries that turn
with a shaft are functions of another sum of the phases.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.checks import require_whole
from tribodyn.errors import InputError
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics.equations.system import Contact, System

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
    functions = [error] if callable(error) else list(error)
    counts = [cycles] if callable(error) and cycles else list(cycles)
    if len(functions) != len(counts) or not all(map(callable, functions)):
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
    return values


def phase_sum(points: Array, cycles: Iterable[int], offset: float | Array = 0.0) -> Array:
    """Mesh phase in [0, 1) at points (p, phases)."""
    return np.asarray((points @ np.asarray(cycles, dtype=float) + offset) % 1.0 % 1.0)
