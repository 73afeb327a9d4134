"""What time integration in modal coordinates takes and returns."""

from __future__ import annotations

from typing import NamedTuple

from tribodyn.types import Array, ComplexArray, Index

#: Reasons of a failure.
UNSETTLED, CHATTER, GROWING = 1, 2, 3


class Modes(NamedTuple):
    """Modes with one of each conjugate pair."""

    values: ComplexArray  #: (m,) [rad/s]
    input: Array  #: of forces in real and imaginary parts of modes (2, s, m)
    output: Array  #: of these in motion and rate at the contacts, doubled for pairs (2, m, 2 r)
    mean: Array  #: mean contact stiffness, then damping, that the modes include (2 r, s)


class Contacts(NamedTuple):
    """Contacts and frictions that do not vary."""

    dead: Index  #: whether each spring has a dead zone (contacts, springs)
    damped_in_gap: Array
    members: Array  #: contacts that each friction follows (f, contacts)
    load: Array  #: of each friction (f,)
    limit: Array


class Weights(NamedTuple):
    """Weights of one step."""

    #: Of each mode, and of the forces on it at three nodes, in the mode at the middle and the end;
    #: real and imaginary parts (2, 4, 2, m).
    modes: Array
    #: Of forces at the middle and end in motion and rate there (2 s, 4 r); of a part of a step
    #: (0, 4 r): a sum over the modes takes less than its weights.
    direct: Array


class Buffers(NamedTuple):
    """Work space of a step."""

    z: Array  #: modes (2, m)
    rows: Array  #: entries at the three nodes (3, row)
    u: Array  #: forces at the three nodes (3, s)
    pushed: Array  #: these in the modes (3, 2, m)
    moved: Array  #: modes at middle and end, without the forces there, then with them (4, 2, m)
    base: Array
    motion: Array  #: (4 r,)
    last: Array
    contact: Array  #: contact forces
    side: Array  #: of the springs (contacts, springs)
    deflection: Array  #: at the three nodes (3, contacts)
    rate: Array  #: of the deflection (3, contacts)


class Trace(NamedTuple):
    """Output of an integration."""

    modes: Array  #: (rows, 2, m); empty to record nothing
    sums: Array  #: integral and double integral of the forces (rows, 2, s)
    contacts: Array  #: motion and rate at middle and end of last steps (steps, 2, 2 r)
    report: Array  #: reason of a failure, step, contact; changes of side, iterations; log entries
    #: changes of side: step, fraction, contact, spring, side, motion and rate (entries, 5 + 2 r)
    log: Array
