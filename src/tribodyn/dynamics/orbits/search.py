"""Search for a fixed point: let the motion settle, then Newton's method; accelerate if needed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tribodyn.dynamics.equations.motion import compression, has_gap, sides
from tribodyn.dynamics.equations.nodes import force_laws
from tribodyn.dynamics.orbits.orbit_map import OrbitMap, newton_step
from tribodyn.types import Array, ComplexArray

#: Earlier points that an acceleration combines.
_DEPTH = 8


def anderson(
    function: Callable[[Array], Array],
    start: Array,
    *,
    tolerance: float,
    limit: int,
) -> tuple[Array, Array, int]:
    """Fixed point, residual, evaluations. Type II of Fang and Saad (2009), equation (24)."""
    y = start.copy()
    points: list[Array] = []
    residuals: list[Array] = []
    best = (np.inf, y, np.zeros_like(y))
    for count in range(1, limit + 1):
        residual = function(y) - y
        size = float(np.linalg.norm(residual))
        if size < best[0]:
            best = (size, y, residual)
        if size <= tolerance * max(float(np.linalg.norm(y)), 1e-300):
            return y, residual, count
        if size > 10.0 * best[0]:
            points, residuals = points[-1:], residuals[-1:]
        points.append(y)
        residuals.append(residual)
        points, residuals = points[-_DEPTH - 1 :], residuals[-_DEPTH - 1 :]
        y = _combine(points, residuals)
    return best[1], best[2], limit


def _combine(points: list[Array], residuals: list[Array]) -> Array:
    image = points[-1] + residuals[-1]
    if len(points) == 1:
        return image
    delta_y = np.diff(np.array(points), axis=0).T
    delta_r = np.diff(np.array(residuals), axis=0).T
    scale = np.linalg.norm(delta_r, axis=0)
    scale[scale == 0.0] = 1.0
    weights, *_ = np.linalg.lstsq(delta_r / scale, residuals[-1], rcond=1e-12)
    combined: Array = image - ((delta_y + delta_r) / scale) @ weights
    return combined


#: Largest number of periods to look ahead, and the part of the distance that is negligible.
HORIZON, GONE = 2000, 1e-3


class FlankWatch:
    """Clearance of the flanks from separation, for all meshes with a dead zone."""

    def __init__(self, mapping: OrbitMap) -> None:
        nodes = mapping.compiled.nodes
        dead = np.any(nodes.gap > 0.0, axis=(0, 1))
        laws = force_laws(nodes)
        meshes = [np.flatnonzero(laws == number) for number in np.unique(laws)]
        gapped = [mesh for mesh in meshes if dead[mesh].all()]
        first = [mesh[0] for mesh in gapped]
        self._direction = nodes.direction[:, ::2][:, :, first]
        self._error = nodes.error[:, ::2][:, :, first]
        gaps = [nodes.gap[:, ::2, mesh].min(axis=2) for mesh in gapped]
        self._gap = np.stack(gaps, axis=-1) if gaps else np.zeros((*self._error.shape[:2], 0))
        #: Whether no mesh consists of several contacts, which open one after the other.
        self.single_contacts = len(gapped) == np.count_nonzero(dead)
        self._constant_direction = not np.ptp(self._direction, (0, 1)).any()
        self._steps = mapping.compiled.grid.steps
        self._size = mapping.compiled.system.size

    def compression(self, states: Array) -> Array:
        """Compression of each mesh at both ends of every step, (periods, steps, 2, meshes)."""
        return self._along(states[..., None])[..., 0] - self._error

    def _along(self, states: Array) -> Array:
        """States (rows, 2 n, k) along the directions, (periods, steps, 2, meshes, k)."""
        q, cycles = states[:, : self._size], len(states) // self._steps
        shape = (cycles, self._steps, 2, self._direction.shape[2], states.shape[2])
        if self._constant_direction:  # the same direction all along
            along = np.zeros((len(q), *shape[3:]))
            for mesh, place in zip(*np.nonzero(self._direction[0, 0]), strict=True):
                along[:, mesh] += self._direction[0, 0, mesh, place] * q[:, place]
            return np.stack((along[:-1], along[1:]), axis=1).reshape(shape)
        ends = np.stack((q[:-1], q[1:]), axis=1).reshape(cycles, self._steps, 2, *q.shape[1:])
        return np.asarray(np.einsum("rsji,crsik->crsjk", self._direction, ends))

    def clearance(self, compression: Array) -> Array:
        """Distance of each mesh from separation, on the flank on which it starts."""
        return self.flank(compression) * compression - self._gap

    @staticmethod
    def flank(compression: Array) -> Array:
        """Side of the dead zone on which each mesh starts, (meshes,): 1 or -1."""
        return np.where(compression[0, 0, 0] < 0.0, -1.0, 1.0)

    def in_touch(self, states: Array) -> bool:
        """Whether no mesh separates in a motion."""
        return bool(np.all(self.clearance(self.compression(states)) > 0.0))

    def rates(self, states: Array, slopes: Array) -> tuple[Array, Array]:
        """Clearance along a motion (samples,), and its derivatives (samples, k)."""
        compression = self.compression(states)
        clearance = self.clearance(compression).reshape(-1)
        rates = self.flank(compression)[:, None] * self._along(slopes)
        return clearance, rates.reshape(clearance.size, slopes.shape[-1])

    def stays(self, states: Array, slopes: Array, matrix: Array, distance: Array) -> bool:
        """Whether a motion near an orbit approaches it without separation."""
        clearance, rates = self.rates(states, slopes)
        if np.any(clearance <= 0.0):
            return False
        first, steepest = float(np.abs(rates @ distance).max(initial=0.0)), 0.0
        if rates.size:
            steepest = float(np.sqrt((rates**2).sum(axis=1).max()))
        for _ in range(HORIZON):
            if steepest * float(np.linalg.norm(distance)) > clearance.min(initial=np.inf):
                moved = rates @ distance
                if np.any(clearance + moved <= 0.0):
                    return False
                if float(np.abs(moved).max(initial=0.0)) <= GONE * first:
                    break
            elif steepest * float(np.linalg.norm(distance)) <= GONE * first:
                break
            distance = matrix @ distance
        return True


#: Largest number of integrated periods with dead zones if the flanks separate: they keep a start in
#: its basin of attraction. A linear system has one orbit and needs none.
_SETTLE = 24
#: Integrated periods after which Newton's method is tried while the flanks are in contact.
_TRIES = (2, 8)
#: A disturbance this small relative to the orbit no longer changes the basin.
_SETTLED = 1e-3
#: A motion this far from an unstable orbit, relative to it, has left it.
_AWAY = 0.1
_ANDERSON_LIMIT = 40
NEWTON_LIMIT = 8
#: Integrated periods of each further attempt.
PATIENCE = (150, 400)
#: Size of the disturbances for the monodromy matrix relative to the orbit; and for linear
#: equations, where larger ones are exact and lose fewer digits.
_DISTURBANCE, APART = 1e-7, 1e-3


@dataclass
class OrbitPoint:
    """A point of the map with its residual and the matrix of the map."""

    point: Array  #: [m/s]
    residual: Array  #: [m/s]
    matrix: Array  #: derivative of the map, the monodromy matrix [-]
    scale: float  #: size of the motion [m/s]
    multipliers: ComplexArray  #: floquet multipliers, the largest first
    states: Array  #: the motion over one period
    slopes: Array  #: its derivative by the reduced vector, the last axis
    search: int = 0
    linear: bool = False  #: no separation: nearby motions differ by multiples of the slopes

    @property
    def correction(self) -> Array:
        """Newton step to the fixed point, (k,)."""
        return self._newton[0]

    @property
    def error(self) -> float:
        """Distance to the orbit over its size; at least the rounding of the map."""
        return self._newton[1] / self.scale

    @cached_property
    def _newton(self) -> tuple[Array, float]:
        return newton_step(self.matrix, self.residual)

    @property
    def attracts(self) -> bool:
        """Whether nearby motions approach the orbit, or keep their distance."""
        return bool(np.abs(self.multipliers[:1]).max(initial=0.0) <= 1.0 + 1e-6)


def motion_size(mapping: OrbitMap, states: Array) -> float:
    """Size of a motion, free of drift."""
    reduced = mapping.coordinates.reduce(mapping.without_drift(states.copy()))
    return float(np.linalg.norm(reduced, axis=1).max()) or 1.0


def _examine(mapping: OrbitMap, y: Array, reference: OrbitPoint | None = None) -> OrbitPoint:
    """Evaluate the map and its matrix at a point; reuse the matrix of an equivalent reference."""
    image, states = mapping.follow(y)
    scale = motion_size(mapping, states)
    if reference is not None and _same_equations(mapping, reference.states, states):
        return replace(reference, point=y, residual=image - y, scale=scale, states=states)
    if mapping.affine:
        # Of a linear map any difference is exact, and a large one loses no digits.
        matrix, slopes = mapping.matrix(y, scale)[1], np.zeros((*states.shape, 0))
    else:
        _, matrix, _, slopes = mapping.differences(y, _DISTURBANCE * scale)
    return OrbitPoint(y, image - y, matrix, scale, mapping.multipliers(matrix), states, slopes)


def _same_equations(mapping: OrbitMap, first_states: Array, second_states: Array) -> bool:
    """Whether two motions obey the same linear equations: all contacts always on the same side."""
    if mapping.affine:
        return True
    nodes, size = mapping.compiled.nodes, mapping.compiled.system.size
    if nodes.friction_coefficients.shape[-1] > 1:
        return False
    gap, dead = nodes.gap[:, 0], has_gap(nodes)
    rows = nodes._replace(direction=nodes.direction[:, 0], error=nodes.error[:, 0])
    places = (
        part[:-1, :size].reshape(-1, len(gap), size) for part in (first_states, second_states)
    )
    first, second = (sides(compression(rows, q), gap, dead) for q in places)
    return np.array_equal(first, second)


def finish_orbit(
    mapping: OrbitMap, y: Array, tolerance: float, reference: OrbitPoint | None = None
) -> OrbitPoint:
    """Newton's method from a point near the orbit; ``reference`` is another point near it."""
    search = mapping.cycles
    best = _examine(mapping, y, reference)
    for _ in range(NEWTON_LIMIT):
        if best.error <= 0.01 * tolerance:
            break
        trial = _examine(mapping, best.point + best.correction, best)
        if not trial.error < 0.5 * best.error:
            break
        best = trial
    best.search = search
    return best


def is_stable(orbit: OrbitPoint, tolerance: float) -> bool:
    """Whether an orbit is certified, and nearby motions do not leave it."""
    return orbit.error <= tolerance and orbit.attracts


def _in_one_march(mapping: OrbitMap, y: Array, tolerance: float) -> OrbitPoint | None:
    """Orbit that a motion approaches without separation: its equations are linear."""
    watch = FlankWatch(mapping)
    if not watch.single_contacts or mapping.compiled.nodes.friction_coefficients.shape[-1] > 1:
        return None
    step = APART * float(np.linalg.norm(y))
    image, matrix, states, slopes = mapping.differences(y, step)
    clearance, rates = watch.rates(states, slopes)
    if np.any(clearance <= 0.0) or np.any(clearance[:, None] + step * rates <= 0.0):
        return None
    motion = mapping.multipliers(matrix), states, slopes
    start = OrbitPoint(y, image - y, matrix, motion_size(mapping, states), *motion, linear=True)
    orbit = finish_orbit(mapping, y + start.correction, tolerance, start)
    if orbit.linear and is_stable(orbit, tolerance):
        return orbit if watch.stays(orbit.states, slopes, matrix, y - orbit.point) else None
    return None


def _settle(
    mapping: OrbitMap, y: Array, periods: int, tolerance: float, unstable: OrbitPoint | None
) -> tuple[Array, bool, OrbitPoint | None]:
    """Integrate periods until the change is small or contact is certain up to the orbit."""
    watch, candidate, spent = FlankWatch(mapping), None, 0
    for count in range(1, periods + 1):
        new, states = mapping.follow(y)
        change = float(np.linalg.norm(new - y))
        y = new
        touching = watch.in_touch(states)
        if candidate is None and touching and count in _TRIES:
            before = mapping.cycles
            candidate = finish_orbit(mapping, y, tolerance)
            if not (is_stable(candidate, tolerance) and watch.in_touch(candidate.states)):
                candidate = None
            else:
                spent = mapping.cycles - before
        if candidate is not None and watch.stays(
            candidate.states, candidate.slopes, candidate.matrix, y - candidate.point
        ):
            candidate.search = mapping.cycles - spent
            return candidate.point, True, candidate
        if unstable is not None and np.linalg.norm(y - unstable.point) < _AWAY * unstable.scale:
            continue
        if count >= 3 and change < _SETTLED * motion_size(mapping, states):
            return y, True, None
    return y, False, None


def approach_orbit(
    mapping: OrbitMap,
    y: Array,
    tolerance: float,
    periods: int = _SETTLE,
    unstable: OrbitPoint | None = None,
) -> tuple[OrbitPoint | None, Array]:
    """Follow a motion until the stable orbit that it approaches is certain."""
    y, settled, attractor = _settle(mapping, y, periods, tolerance, unstable)
    if attractor is None and settled:
        orbit = finish_orbit(mapping, y, tolerance)
        attractor = orbit if is_stable(orbit, tolerance) else None
    return attractor, y


def _attempt(
    mapping: OrbitMap, y: Array, periods: int, tolerance: float, unstable: OrbitPoint | None
) -> OrbitPoint:
    """Let the motion settle, accelerate if necessary, and finish with Newton's method."""
    attractor, y = approach_orbit(mapping, y, tolerance, periods, unstable)
    if attractor is not None:
        return attractor
    accelerated, _, _ = anderson(mapping, y, tolerance=1e-3 * tolerance, limit=_ANDERSON_LIMIT)
    return finish_orbit(mapping, accelerated, tolerance)


# The norm of a diverging motion overflows before it is reported.
@np.errstate(over="ignore", invalid="ignore")
def find_orbit(
    mapping: OrbitMap, y: Array, tolerance: float, patience: Sequence[int] = PATIENCE
) -> OrbitPoint:
    """Find an orbit from a start; each further attempt integrates more periods first."""
    if mapping.affine:
        return finish_orbit(mapping, y, tolerance)
    touching = _in_one_march(mapping, y, tolerance)
    if touching is not None:
        return touching
    orbit = _attempt(mapping, y, _SETTLE, tolerance, None)
    generator = np.random.default_rng(0)
    for periods in patience:
        if is_stable(orbit, tolerance):
            break
        unstable = orbit if orbit.error <= tolerance else None
        # A motion leaves an unstable orbit, so the search continues from a point near it.
        disturbance = _SETTLED * orbit.scale * generator.standard_normal(y.size)
        start = orbit.point if unstable is None else orbit.point + disturbance
        orbit = _attempt(mapping, start, periods, tolerance, unstable)
    return orbit
