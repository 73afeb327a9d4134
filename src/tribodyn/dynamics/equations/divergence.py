"""What to say of a motion that grew beyond all bounds: when, who, and the probable cause."""

from __future__ import annotations

from typing import NoReturn

import numpy as np

from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.load_friction import friction_tangent, push_with_friction
from tribodyn.errors import ComputationError, Problem
from tribodyn.types import Array

#: ``omega_max * dt`` above which the step itself is a suspect.
_SUSPECT_STEP = 2.0
#: Negative eigenvalues smaller than this share of the largest are rounding.
_ROUNDING = 1e-9


def report_divergence(
    system: System,
    nodes: Nodes,
    grid: Grid,
    step_number: float,
    states: Array,
    mesh_frequency: float,
    cycles: int,
    lane: int | None,
    factors: Array,
) -> NoReturn:
    """Raise the error that tells when and where a motion ran away, and why that may be."""
    size = system.size
    finite = np.all(np.isfinite(states), axis=1)
    last = int(np.argmin(finite)) - 1 if not finite.all() else len(states) - 2
    last = max(last, 0)
    weight = np.sqrt(np.diag(np.asarray(system.mass)))
    # Whoever has most of the kinetic energy ran away; a coordinate that went first has it too.
    with np.errstate(all="ignore"):
        speed = np.nan_to_num(np.abs(states[last, size:]) * weight, nan=np.inf)
    worst = int(np.argmax(speed))
    phase = cycles + float(grid.left[min(last, grid.steps - 1)])
    name = system.names[worst]
    body = name.rpartition("_")[0]
    causes, remedy = probable_cause(system, nodes, step_number, factors)
    raise ComputationError(
        Problem(
            what=f"the motion grew beyond all bounds after {phase:.4g} mesh cycles, at the time "
            f"{phase / mesh_frequency:.6g} s" + ("" if lane is None else f", in lane {lane}"),
            where=f"coordinate {name}" + (f" of the body {body}" if body else "") + ", first of all"
            if size > 1
            else f"coordinate {name}",
            why=f"{causes}. omega_max*dt = {step_number:.3g}, limit 2.7 of the integrator",
            remedy=remedy,
        )
    )


def probable_cause(
    system: System, nodes: Nodes, step_number: float, factors: Array
) -> tuple[str, str]:
    """Look for what can make a motion grow."""
    stiff, damp = factors[:2]
    for kind, entry, factor, unit in (
        ("stiffness", nodes.stiffness, stiff, "N/m"), ("damping", nodes.damping, damp, "N*s/m"),
    ):  # fmt: skip
        values = factor * entry
        if values.size and values.min() < 0.0:
            row, node, j = np.unravel_index(int(values.argmin()), values.shape)
            return (
                f"The {kind} of contact {j} is negative: {values.min():.6g} {unit} at the mesh "
                f"phase {nodes.phase[row, node]:.4g}",
                f"Look for a wrong sign in contacts[{j}].{kind}",
            )
    spring, damper, push = _mean_matrices(system, nodes, factors)
    checks = (
        ("stiffness", spring, np.asarray(system.stiffness)),
        ("damping", damper, np.asarray(system.damping)),
    )
    for kind, total, own in checks:
        found = _negative_direction(total, system)
        if found:
            where = f"System.{kind}" if _negative_direction(own, system) else "the contacts"
            return (
                f"The {kind} matrix has a negative eigenvalue, in a motion of {found}",
                f"Look for a wrong sign or place in {where}",
            )
    mass = np.asarray(system.mass)
    if np.abs(push).max(initial=0.0) > 0.0:
        rub_spring, rub_damper = push
        growth, still = (
            _growth(mass, spring + part * rub_spring, damper + part * rub_damper)
            for part in (1.0, 0.0)
        )
        if growth > max(10.0 * still, _ROUNDING):
            return (
                "Friction feeds energy in: with it a motion about the static load grows, without "
                "it none does",
                "Look for the sign of the sliding direction, or add damping",
            )
    if step_number > _SUSPECT_STEP:
        return (
            "Nothing in the system makes its motion grow, but the step is near the stability limit",
            "Use twice as many steps per mesh cycle",
        )
    if np.ptp(nodes.stiffness, axis=(0, 1)).max(initial=0.0) > 0.0:
        return (
            "The mean system is stable, so that the stiffness that changes over the mesh cycle "
            "feeds energy in: a parametric resonance",
            "Add damping, move the mesh frequency, or let the contact open with a gap",
        )
    return (
        "The system itself is unstable",
        "Look for negative stiffness or damping, or friction that feeds energy in",
    )


def _mean_matrices(system: System, nodes: Nodes, factors: Array) -> tuple[Array, Array, Array]:
    """Stiffness and damping with all contacts closed, and what friction adds to both."""
    stiff, damp, rub = factors[:3]
    push = nodes.force_direction
    if system.frictions:
        nominal = np.array([one.load for one in system.frictions])
        ratio = friction_tangent(system, nodes.friction_coefficients, nominal)
        push = push_with_friction(system, nodes, ratio)
    along = nodes.direction
    spring, damper = (
        np.einsum("rs,rsj,rsji,rsjk->ik", nodes.weight, part, along, along)
        for part in (stiff * nodes.stiffness, damp * nodes.damping)
    )
    sliding = rub * (push - along)
    added = [
        np.einsum("rs,rsj,rsji,rsjk->ik", nodes.weight, part, sliding, along)
        for part in (stiff * nodes.stiffness, damp * nodes.damping)
    ]
    total = spring + np.asarray(system.stiffness), damper + np.asarray(system.damping)
    return (*total, np.array(added))


def _negative_direction(matrix: Array, system: System) -> str:
    """Coordinates of the motion with the most negative eigenvalue; empty if there is none."""
    scale = np.sqrt(np.diag(np.asarray(system.mass)))
    values, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T) / np.outer(scale, scale))
    if values[0] >= -_ROUNDING * np.abs(values).max():
        return ""
    motion = np.abs(vectors[:, 0])
    most = [system.names[int(i)] for i in np.flatnonzero(motion > 0.5 * motion.max())]
    return " and ".join(most[:4])


def _growth(mass: Array, stiffness: Array, damping: Array) -> float:
    """Largest growth of a motion over the fastest rate [-]."""
    size = len(mass)
    inverse = np.linalg.inv(mass)
    spring = inverse @ stiffness
    scale = max(float(np.sqrt(np.abs(spring).max())), 1e-30)
    state = np.block(
        [[np.zeros((size, size)), scale * np.eye(size)], [-spring / scale, -inverse @ damping]]
    )
    values = np.linalg.eigvals(state)
    return float(values.real.max() / max(np.abs(values).max(), 1e-300))
