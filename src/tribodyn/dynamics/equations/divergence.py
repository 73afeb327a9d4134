"""Error messages of failed integrations: time, coordinate and probable cause."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.nodes import Nodes, nominal_push
from tribodyn.dynamics.equations.step_limit import state_roots
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import ComputationError
from tribodyn.types import Array

#: ``omega_max * dt`` above which the step itself is a suspect.
_SUSPECT_STEP = 2.0
#: Negative eigenvalues smaller than this share of the largest are rounding.
_ROUNDING = 1e-9
#: Friction over contact force, both as accelerations, above which it is the first suspect.
_STRONG = 0.4
#: A state above this has diverged; the contact forces are then not the cause.
_HUGE = 1e100
#: The same over the usual size, for adaptive steps, which become too small before it is infinite.
_BEYOND = 1e9
#: Reason of a failure of adaptive steps: a contact changes its side without end.
CHATTERS = 2


class Failed(NamedTuple):
    """A trajectory that failed, and its last states."""

    system: System
    nodes: Nodes
    states: Array  #: before every attempted step (steps, 2 n)
    phase: Array  #: mesh phase of these and possibly of later states, from the start [1]
    period: float  #: [s]
    lane: int | None  #: its number among several
    factors: Array  #: of stiffness, damping, friction, error, gap and force [1]
    step_number: float  #: ``omega_max * dt``; 0 of a method that is stable with any [-]

    @property
    def who(self) -> str:
        """Name of the lane."""
        return "" if self.lane is None else f", in lane {self.lane}"

    def fastest(self, step: int) -> str:
        """Coordinate with most of the kinetic energy, or the first that is not finite."""
        with np.errstate(all="ignore"):
            speed = np.abs(self.states[step, self.system.size :])
            energy = np.diag(np.asarray(self.system.mass)) * speed**2
        return self.system.names[int(np.argmax(np.nan_to_num(energy, nan=np.inf)))]


def runaway(failed: Failed, steps: str) -> ComputationError:
    """Error of a motion that diverged: when, where and why; ``steps`` describes the step size."""
    finite = np.append(np.isfinite(failed.states).all(axis=1), False)
    last = max(int(np.argmin(finite)) - 1, 0)
    phase, name = float(failed.phase[last]), failed.fastest(last)
    body = name.rpartition("_")[0]
    causes, remedy = probable_cause(failed.system, failed.nodes, failed.step_number, failed.factors)
    return ComputationError(
        f"the motion grew beyond all bounds after {phase:.4g} mesh cycles, at the time "
        f"{phase * failed.period:.6g} s{failed.who}",
        where=f"first in coordinate {name}" + (f" of the body {body}" if body else "")
        if failed.system.size > 1
        else f"coordinate {name}",
        why=f"{causes}. {steps}",
        remedy=remedy,
    )


def newmark_failure(
    failed: Failed, unconverged: bool, law: tuple[float, float, float]
) -> ComputationError:
    """Error of Newmark's scheme: the motion or the iteration for contact forces diverged."""
    step_number = failed.step_number
    number = f" at omega_max*dt = {step_number:.3g}" if np.isfinite(step_number) else ""
    if unconverged and np.abs(failed.states).max() < _HUGE:
        time = failed.phase[len(failed.states)] * failed.period
        return ComputationError(
            f"the contact forces of the step that ends at {time:.6g} s did not converge"
            f"{failed.who}",
            why=f"Newton's method did not reach the tolerance of {law[2]:.0e} within 25 "
            f"iterations{number}",
            remedy="Use more steps per mesh cycle or a larger tolerance, and check for negative "
            "contact stiffness or damping, which can make the equations of a step singular",
        )
    steps = f"gamma = {law[0]:g}, beta = {law[1]:g} are stable{number}: the step is not the cause"
    return runaway(failed._replace(step_number=0.0), steps)


def adaptive_failure(failed: Failed, scale: Array) -> ComputationError:
    """Error of adaptive steps that became too small; ``scale`` is the size of usual states."""
    state, name = failed.states[-1], failed.fastest(-1)
    if not np.abs(state / scale).max() <= _BEYOND:
        return runaway(failed, "Steps are as short as accuracy needs: they are not the cause")
    phase = float(failed.phase[-1])
    return ComputationError(
        f"no step meets the tolerance: {name} moves fastest",
        where=_place(phase, phase * failed.period, failed.who),
        why="An entry is not smooth there, or rounding exceeds the tolerance",
        remedy="Give the phase as an event, or a larger rtol or atol",
    )


def _place(phase: float, time: float, who: str) -> str:
    return f"mesh phase {phase % 1.0:.6g} of mesh cycle {int(phase) + 1}, time {time:.6g} s{who}"


def most_splits(contacts: int) -> int:
    """Largest number of contact changes within a step; more count as endless chatter."""
    return 16 + 4 * contacts


def chattering_step(
    contact: int,
    contacts: int,
    phase: float,
    time: float,
    lane: int | None,
    *,
    adaptive: bool = False,
) -> ComputationError:
    """Error of a contact that chatters; ``phase`` counts mesh cycles [1], ``time`` is in s."""
    often = f"{most_splits(contacts)} times within one step"
    remedy = "Use more steps per mesh cycle, or damping that does not vanish in the gap"
    if adaptive:
        often = "64 times within a millionth of a mesh cycle"
        remedy = "Check for negative damping, too stiff flanks and too small a gap"
    who = "" if lane is None else f", in lane {lane}"
    return ComputationError(
        f"the contacts open and close more than {often}",
        where=f"contacts[{contact}], {_place(phase, time, who)}",
        why="The flanks chatter at the boundary of the dead zone, where the damping force "
        "jumps: the step cannot be divided into parts with one force law each",
        remedy=f"{remedy}; check for an error or a gap that changes fast at that mesh phase",
    )


def probable_cause(
    system: System, nodes: Nodes, step_number: float, factors: Array
) -> tuple[str, str]:
    """Return what can make a motion grow, and the remedy."""
    stiff, damp = factors[:2]
    spring, damper = ("stiffness", stiff, "N/m"), ("damping", damp, "N*s/m")
    for (kind, factor, unit), entry in ((spring, nodes.stiffness), (damper, nodes.damping)):
        values = factor * entry
        if values.size and values.min() < 0.0:
            row, node, j = np.unravel_index(int(values.argmin()), values.shape)
            return (
                f"The {kind} of contact {j} is negative: {values.min():.6g} {unit} at the mesh "
                f"phase {nodes.phase[row, node]:.4g}",
                f"Check the sign of contacts[{j}].{kind}",
            )
    stiffness, damping, push = _mean_matrices(system, nodes, factors)
    checks = (
        ("stiffness", stiffness, np.asarray(system.stiffness)),
        ("damping", damping, np.asarray(system.damping)),
    )
    for kind, total, structural in checks:
        coordinates = _negative_direction(total, system)
        if coordinates:
            where = f"System.{kind}" if _negative_direction(structural, system) else "the contacts"
            return (
                f"The {kind} matrix has a negative eigenvalue, in a motion of {coordinates}",
                f"Check signs and positions of the entries of {where}",
            )
    rubbing = _friction_cause(system, nodes, factors[2], (stiffness, damping, push))
    if rubbing is not None:
        return rubbing
    if step_number > _SUSPECT_STEP:
        return (
            "Nothing in the system makes its motion grow, but the step is near the stability limit",
            "Use twice as many steps per mesh cycle",
        )
    if np.ptp(nodes.stiffness, axis=(0, 1)).max(initial=0.0) > 0.0:
        return (
            "The mean system is stable, so that the varying mesh stiffness feeds energy in: a "
            "parametric resonance",
            "Add damping, move the mesh frequency, or let the contact open with a gap",
        )
    return (
        "The system itself is unstable",
        "Check for negative stiffness or damping, and for friction that feeds energy in",
    )


def _friction_cause(
    system: System, nodes: Nodes, rub: float, mean: tuple[Array, Array, Array]
) -> tuple[str, str] | None:
    """Cause and remedy if friction feeds energy in or is too strong for a tooth."""
    strength, phase = _friction_strength(system, nodes, rub)
    strong = (
        f"Friction accelerates the coordinates {strength:.3g} times as much as the contact force, "
        f"at the mesh phase {phase:.4g}"
    )
    remedy = "Check the friction coefficient: lubricated steel hardly exceeds 0.2"
    spring, damper, push = mean
    if np.abs(push).max(initial=0.0) > 0.0:
        mass = np.asarray(system.mass)
        growth, still = (
            _growth(mass, spring + part * push[0], damper + part * push[1]) for part in (1.0, 0.0)
        )
        if growth > max(10.0 * still, _ROUNDING):
            cause = (
                "Friction feeds energy in: a motion about the static load grows with friction and "
                "decays without it"
            )
            if strength > _STRONG:
                return f"{strong}. {cause}", f"{remedy}, and the sign of the sliding direction"
            return cause, "Check the sign of the sliding direction, or add damping"
    return (f"{strong}, which can drive a motion", remedy) if strength > _STRONG else None


def _friction_strength(system: System, nodes: Nodes, rub: float) -> tuple[float, float]:
    """Greatest friction over contact force, both as accelerations, and its mesh phase."""
    push, along = nominal_push(system, nodes), nodes.direction
    inverse = np.linalg.inv(np.linalg.cholesky(np.asarray(system.mass)))
    size = [np.linalg.norm(part @ inverse.T, axis=-1) for part in (rub * (push - along), along)]
    ratio = size[0] / np.maximum(size[1], 1e-300) * (size[1] > 0.0)
    at = np.unravel_index(int(np.argmax(ratio)), ratio.shape) if ratio.size else (0, 0)
    return float(ratio.max(initial=0.0)), float(nodes.phase[at[0], at[1]])


def _mean_matrices(system: System, nodes: Nodes, factors: Array) -> tuple[Array, Array, Array]:
    """Stiffness and damping with all contacts closed, and the contributions of friction."""
    stiff, damp, rub = factors[:3]
    along = nodes.direction
    (spring, damper), added = (
        np.array([
            np.einsum("rs,rsj,rsji,rsjk->ik", nodes.weight, part, push, along)
            for part in (stiff * nodes.stiffness, damp * nodes.damping)
        ])
        for push in (along, rub * (nominal_push(system, nodes) - along))
    )  # fmt: skip
    return spring + np.asarray(system.stiffness), damper + system.rate_matrix, added


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
    inverse = np.linalg.inv(mass)
    values = state_roots(inverse @ stiffness, inverse @ damping)
    return float(values.real.max() / max(np.abs(values).max(), 1e-300))
