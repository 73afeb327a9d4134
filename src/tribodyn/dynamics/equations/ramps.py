"""Contacts with ramps for methods that take springs with a dead zone only."""

from __future__ import annotations

from dataclasses import replace
from itertools import accumulate
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.nodes import ramp_count
from tribodyn.dynamics.equations.system import Contact, System
from tribodyn.errors import InputError
from tribodyn.types import Array


class _Column:
    """One column of an entry over the mesh phase."""

    def __init__(self, function: Any, column: int) -> None:
        self.function, self.column = function, column
        if (events := getattr(function, "event_phases", None)) is not None:
            self.event_phases = events

    def __call__(self, phase: Array) -> Array:
        """Values at mesh phases."""
        return np.asarray(self.function(phase))[..., self.column]


def split_ramps(system: System) -> System:
    """Replace each ramp of a contact by a contact; frictions follow all that belong together."""
    counts = [ramp_count(f"contacts[{j}]", each) for j, each in enumerate(system.contacts)]
    if not any(counts):
        return system
    ends = list(accumulate((1 + count for count in counts), initial=0))
    contacts = [
        part for pair in zip(system.contacts, counts, strict=True) for part in _parts(*pair)
    ]
    frictions = [
        replace(f, contacts=tuple(n for j in f.contacts for n in range(ends[j], ends[j + 1])))
        for f in system.frictions
    ]
    return replace(system, contacts=contacts, frictions=frictions)


def _parts(contact: Contact, count: int) -> list[Contact]:
    def column(entry: Any, ramp: int) -> Any:
        return _Column(entry, ramp) if callable(entry) else np.ravel(entry)[ramp]

    first = replace(contact, ramp_stiffness=(), ramp_gap=())
    ramps = [
        replace(
            first,
            stiffness=column(contact.ramp_stiffness, ramp),
            gap=column(contact.ramp_gap, ramp),
            damping=0.0,
        )
        for ramp in range(count)
    ]
    return [first, *ramps]


def refuse_ramps(system: System) -> None:
    """Refuse contacts with ramps, which the compiled engines of small systems do not know."""
    for j, contact in enumerate(system.contacts):
        if count := ramp_count(f"contacts[{j}]", contact):
            raise InputError(
                f"contact {j} has a force law of {count} ramps",
                f"System.contacts[{j}].ramp_stiffness",
                "This method takes springs with a dead zone",
                'Use harmonic_balance or method = "modal", or one contact for each ramp, as '
                "law_contacts gives them",
            )
