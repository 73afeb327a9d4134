"""What a part of a contact can be given as: a constant or a function of the mesh phase."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numpy.typing import ArrayLike

from tribodyn.errors import InputError
from tribodyn.types import Array

#: A constant, or a vectorized function of the mesh phase in [0, 1).
Entry = float | ArrayLike | Callable[[Array], Any]


def read_events(given: Any, where: str) -> tuple[float, ...]:
    """Check mesh phases at which an entry jumps."""
    events = tuple(float(event) for event in given)
    bad = [event for event in events if not 0.0 <= event < 1.0]
    if bad:
        raise InputError(
            f"events holds {bad[0]:g}",
            where=where,
            why="Events are mesh phases and lie in [0, 1)",
            remedy="Take the fraction of the mesh cycle, for example phase % 1.0",
        )
    return events
