"""Friction that follows the load of a contact: coefficient and share vary with the force.

``F = N sum_k c_k(phi) x^k`` with ``x = min(|N|/load, limit)`` acts along ``-direction(phi)``. The
coefficients carry the sign of sliding, so that a friction coefficient and a load share that depend
on the tooth force become one polynomial for each row of the table.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.dynamics.equations.system import LoadFriction, System
from tribodyn.errors import InputError, real_numbers
from tribodyn.types import Array, Mask

if TYPE_CHECKING:
    from tribodyn.dynamics.equations.grid import RowEvaluator
    from tribodyn.dynamics.equations.nodes import Nodes


#: Phases at which a function tells how many coefficients it returns; no likely number of these.
_PROBE = 37


def coefficient_count(where: str, friction: LoadFriction) -> int:
    """Number of coefficients of one row."""
    given = friction.coefficients
    probe = (np.arange(_PROBE) + 0.5) / _PROBE
    values = real_numbers(where, given(probe) if callable(given) else given, "rows of numbers")
    shape = values.shape
    if callable(given) and _PROBE in shape:
        shape = tuple(np.delete(shape, shape.index(_PROBE)).tolist())
    if len(shape) > 1 or 0 in shape:
        raise InputError(
            f"{where} gives the shape {values.shape}",
            where=where,
            why=f"A row of coefficients for each mesh phase: ({_PROBE}, m) for {_PROBE} phases",
        )
    return int(shape[0]) if shape else 1


def friction_directions(system: System, rows: RowEvaluator) -> Array:
    """Directions of all frictions on the rows."""
    out = np.zeros((*rows.nodes.shape, len(system.frictions), system.size))
    for f, one in enumerate(system.frictions):
        out[:, :, f] = rows.values(f"frictions[{f}].direction", one.direction, system.size)
    return out


def friction_coefficients(system: System, rows: RowEvaluator) -> Array:
    """Coefficients of all frictions on the rows, filled up with zeros."""
    names = [f"frictions[{f}].coefficients" for f in range(len(system.frictions))]
    pairs = list(zip(names, system.frictions, strict=True))
    counts = [coefficient_count(name, one) for name, one in pairs]
    out = np.zeros((*rows.nodes.shape, len(pairs), max(counts, default=1)))
    for f, (name, one) in enumerate(pairs):
        out[:, :, f, : counts[f]] = rows.values(name, one.coefficients, counts[f])
    return out


def carried_load(system: System, contact_force: Array) -> Array:
    """Force N that each friction follows."""
    columns = [contact_force[..., list(one.contacts)].sum(axis=-1) for one in system.frictions]
    return np.stack(columns, axis=-1) if columns else np.zeros((*contact_force.shape[:-1], 0))


def _ratio(system: System, load: Array) -> tuple[Array, Mask]:
    """Load over the nominal load, and whether it is below the limit."""
    nominal = np.array([one.load for one in system.frictions])
    limit = np.array([one.limit for one in system.frictions])
    x = np.abs(load) * (1.0 / nominal)
    return np.minimum(x, limit), x < limit


def _polynomial(coefficients: Array, x: Array) -> Array:
    total = np.zeros(np.broadcast_shapes(coefficients.shape[:-1], x.shape))
    for item in range(coefficients.shape[-1] - 1, -1, -1):
        total = total * x + coefficients[..., item]
    return total


def friction_secant(system: System, coefficients: Array, load: Array) -> Array:
    """Friction over contact force, ``F/N``."""
    return _polynomial(coefficients, _ratio(system, load)[0])


def friction_force(system: System, coefficients: Array, contact_force: Array) -> Array:
    """Force of each friction."""
    load = carried_load(system, contact_force)
    return load * friction_secant(system, coefficients, load)


def friction_tangent(system: System, coefficients: Array, load: Array) -> Array:
    """Change of friction with contact force, ``dF/dN``."""
    x, below = _ratio(system, load)
    # d(x P)/dx = sum (k + 1) c_k x^k; beyond the limit P stays.
    rising = _polynomial(coefficients * np.arange(1, coefficients.shape[-1] + 1), x)
    return np.where(below, rising, _polynomial(coefficients, x))


def push_with_friction(system: System, nodes: Nodes, ratio: Array) -> Array:
    """Generalized force per unit force of each contact, all friction included."""
    push = nodes.force_direction
    for f, one in enumerate(system.frictions):
        push = push.copy() if f == 0 else push
        for j in one.contacts:
            push[..., j, :] += ratio[..., f, None] * nodes.friction_direction[..., f, :]
    return push
