"""Entries of a contact: constants or functions of the mesh phase."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, floats, real_numbers
from tribodyn.types import Array

#: A constant, or a vectorized function of the mesh phase in [0, 1).
Entry = float | ArrayLike | Callable[[Array], Any]

#: Search for jumps: steps examined by each of two criteria; parts into which they are divided, and
#: how often; divisions before a bend has to persist; part of a bend that persists at a jump; least
#: jump over the size of the entry.
_SUSPECTS, _PARTS, _CUTS, _FREE, _KEPT, _JUMP = 8, 16, 4, 1, 0.4, 1e-7
#: Difference of two calls with the same phases, over the size of the entry, that is rounding.
_ROUNDING = 1e-9
#: Part of the largest component of an entry below which another is judged as if it were so large.
_SMALL = 1e-8


def read_events(value: object, where: str) -> tuple[float, ...]:
    """Check mesh phases at which an entry jumps."""
    events = tuple(real_numbers(where, value, "mesh phases").reshape(-1).tolist())
    bad = [event for event in events if not 0.0 <= event < 1.0]
    if bad:
        what = f"events holds {bad[0]:g}"
        remedy = "Give the fraction of the mesh cycle, for example phase % 1.0"
        raise InputError(what, where, "Events are mesh phases and lie in [0, 1)", remedy)
    return events


def varies(entry: object) -> bool:
    """Whether an entry is a function of the mesh phase, or holds one."""
    return callable(entry) or (
        isinstance(entry, list | tuple) and any(callable(item) for item in entry)
    )


def entry_values(where: str, entry: Any, phases: Array, size: int) -> Array:
    """Values (p, size) of an entry at mesh phases (p,)."""
    if callable(entry):
        values = _oriented(where, entry, phases, size)
    elif varies(entry):
        columns = [entry_values(where, item, phases, 1)[:, 0] for item in entry]
        values = _shaped(where, np.stack(columns, axis=1), phases.size, size)
    else:
        value = real_numbers(where, entry, "a number, numbers or a function of the mesh phase")
        if value.ndim > 1 or (value.ndim == 1 and value.size != size):
            what = f"{where} has the shape {value.shape}"
            why = f"It must be a number or have the shape ({size},)"
            raise InputError(what, where, why, "Give a number, or one for each coordinate")
        values = np.broadcast_to(value, (phases.size, size)).astype(float)
    if not np.all(np.isfinite(values)):
        at = phases[np.flatnonzero(~np.isfinite(values).all(axis=1))[0]]
        what = f"{where} is NaN or infinite at the mesh phase {at:.6g}"
        remedy = "Check the table or function there; declare jumps as events"
        raise InputError(what, where, "The equations of motion need a finite number there", remedy)
    return values


def refuse_chance(where: str, entry: object, phases: Array, values: Array) -> None:
    """Refuse a function whose values do not follow from the mesh phase alone."""
    repeated = np.arange(0, phases.size, max(1, phases.size // 31))[::-1]
    difference = np.abs(
        entry_values(where, entry, phases[repeated], values.shape[1]) - values[repeated]
    )
    if np.any(difference > _ROUNDING * np.abs(values).max(axis=0)):
        row = int(difference.max(axis=1).argmax())
        raise InputError(
            f"{where} returns other values when it is called again: the difference at the mesh "
            f"phase {phases[repeated][row]:.6g} is {difference[row].max():.4g}",
            where=where,
            why="The motion repeats only if every value follows from the mesh phase alone",
            remedy="Draw random numbers once beforehand, and look them up by the phase",
        )


def refuse_jumps(where: str, entry: object, nodes: Array, values: Array) -> None:
    """Refuse a function that jumps between events; ``nodes`` (s, 3), ``values`` (s, 3, size).

    The bend over a jump persists when the step is divided, that of a kink falls with it, others
    faster.
    """
    size = np.abs(values).max(axis=(0, 1))
    size = np.maximum(size, _SMALL * size.max()) + 1e-300  # components of rounding do not jump
    bend = (values[:, 0] - 2.0 * values[:, 1] + values[:, 2]) / size
    sharp = np.abs(np.diff(bend, 2, axis=0, prepend=bend[-1:], append=bend[:1])).max(axis=1)
    bend = np.abs(bend).max(axis=1)
    likely = np.unique(np.concatenate([np.argsort(-key)[:_SUSPECTS] for key in (bend, sharp)]))
    likely = likely[bend[likely] > _JUMP]
    low, high, largest_bend = nodes[likely, 0], nodes[likely, 2], bend[likely]
    for cut in range(_CUTS):
        if not low.size:
            return
        at = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, 2 * _PARTS + 1)
        flat = entry_values(where, entry, at.reshape(-1), size.size)
        parts = (flat / size).reshape(*at.shape, -1)
        bends = np.abs(parts[:, :-2] - 2.0 * parts[:, 1:-1] + parts[:, 2:]).max(axis=2)
        rows, first = np.arange(low.size), bends.argmax(axis=1)
        most = bends[rows, first]
        stays = (most > _JUMP) & ((most > _KEPT * largest_bend) | (cut < _FREE))
        low, high, largest_bend = (x[stays] for x in (at[rows, first], at[rows, first + 2], most))
    if low.size:
        row = int(largest_bend.argmax())
        ends = entry_values(where, entry, np.array([low[row], high[row]]), size.size)
        raise InputError(
            f"{where} jumps by {np.ptp(ends, 0).max():.4g} at the mesh phase "
            f"{0.5 * (low[row] + high[row]):.7g}, which is not an event",
            where=where,
            why="A step across a jump loses its order, and steps end at events only",
            remedy="Add this phase to the events of the contact or the friction",
        )


def _shaped(where: str, values: Array, count: int, size: int) -> Array:
    if values.shape != (count, size):
        why = f"It must be ({count}, {size}) for {count} mesh phases"
        remedy = "Return one row of values for each phase that is passed to the function"
        raise InputError(f"{where} returns the shape {values.shape}", where, why, remedy)
    return values


def _oriented(where: str, function: Callable[[Array], Any], phases: Array, size: int) -> Array:
    """Call a function of phase; accept (p, size), (size, p), (p,), (size,) and scalars."""
    # One more or one less phase than components makes the orientation unambiguous.
    probe = phases if phases.size not in (1, size) else np.resize(phases, size + 2)
    try:
        result = function(probe)
    except (TypeError, ValueError) as error:
        what = f"{where} is not a vectorized function of the mesh phase: {error}"
        why = "It is called with an array of phases and returns an array"
        remedy = "Use numpy.where instead of if, and functions that take arrays"
        raise InputError(what, where, why, remedy) from error
    # A table returns an array of its own; another function may go on to change what it returned.
    read = floats if hasattr(function, "event_phases") else real_numbers
    numbers = read(where, result, "real numbers, whatever the mesh phase")
    values = np.asarray(numbers, order="C")
    if values.ndim == 0:
        values = np.full((probe.size, 1), float(values))
    elif values.ndim == 1 and values.size == probe.size and size == 1:
        values = values[:, None]
    elif values.ndim == 1 and values.size == size:
        values = np.broadcast_to(values, (probe.size, size))
    elif values.shape == (size, probe.size):
        values = values.T
    return _shaped(where, values, probe.size, size)[: phases.size]
