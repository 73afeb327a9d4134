"""Lyapunov exponents: how fast motions that begin side by side part or close up.

The tangent method: small disturbances are carried along the motion by the linear equations that
hold between two changes of contact, with saltation matrices where contacts open or close, and
made orthogonal again before they become parallel. Growth per time is the spectrum of exponents.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import require_whole
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.equations.motion import sides
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.coordinates import static_start
from tribodyn.dynamics.time.simulate import read_force, read_start
from tribodyn.errors import ComputationError, InputError
from tribodyn.nonlinear.lyapunov_tangent import TangentTables, carry_over_crossings
from tribodyn.nonlinear.survey import Verdict
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array

#: Numbers kept at a time while disturbances are carried.
_ROOM = 6_000_000
#: Mesh cycles of the transient over which disturbances already turn into their directions.
_ALIGN = 200
_BLOCKS = 32
#: Mesh cycles over which a motion that repeats is looked at with half the step.
_FEW = 64
#: Mesh cycles whose matrices are compared to see whether they repeat.
_KEPT = 32
#: Standard errors by which the largest exponent of a chaotic motion is above zero.
_SURE = 3.0
#: Largest exponents agree within this many standard errors of their difference, or this share, or
#: this share of the mesh frequency, which is how well an exponent of zero is known.
_ERRORS, _EXPONENT, _ZERO = 3.0, 0.05, 1e-3
#: Mesh cycles after which matrices may repeat, and how closely.
_PERIODS, _REPEATS = 16, 1e-8
#: Blocks of the frame are apart when they exchange less than this.
_APART = 1e-10
#: A product whose singular values differ by more loses the small disturbances to rounding.
_SPREAD = 1e6


@record
class LyapunovExponents(Record):
    """Spectrum of Lyapunov exponents of one motion.

    Parameters
    ----------
    exponents : (2 n,) array
        Exponents, the largest first [1/s].
    standard_error : (2 n,) array
        Standard error of each [1/s].
    divergence : float
        Mean trace of the equations, found by quadrature: what the exponents add up to [1/s].
    free : int
        How many exponents are exactly zero because nothing depends on the place or speed of the
        free rotation of the drive.
    mesh_frequency : float
        Mesh frequency [Hz].
    cycles : int
        Mesh cycles over which the exponents were averaged.
    repeats : int
        Mesh cycles after which the linear equations of a disturbance repeat; 0 if they do not.
    growth : (cycles, 2 n - free) array
        Growth of the orthogonal disturbances in every mesh cycle [1/s].
    verdict : "physical", "step-limited", "undecided" or ""
        What half the step says of it, see
        :func:`~tribodyn.nonlinear.lyapunov.exponent_verdict`; empty where it was not asked.
    """

    exponents: Array = quantity("exponent", unit="1/s", name="lyapunov_exponent")
    standard_error: Array = quantity("exponent", unit="1/s")
    divergence: float = fact()
    free: int
    mesh_frequency: float = fact()
    cycles: int = fact()
    repeats: int
    growth: Array
    verdict: str = fact(default="")

    @property
    def largest(self) -> float:
        """Largest exponent [1/s]."""
        return float(self.exponents[0])

    @property
    def vibrating(self) -> Array:
        """Exponents without those of the free rotation, the largest first [1/s]."""
        zeros = np.flatnonzero(self.exponents == 0.0)[: self.free]
        return np.delete(self.exponents, zeros)

    @property
    def chaotic(self) -> bool:
        """Whether nothing repeats and the largest exponent is three standard errors above zero."""
        above = self.exponents[0] > _SURE * self.standard_error[0]
        return bool(above and self.exponents[0] > 0.0 and self.repeats == 0)

    @property
    def kaplan_yorke_dimension(self) -> float:
        """Dimension of the attractor in a stroboscopic section after Kaplan and Yorke [-]."""
        vibrating = self.vibrating
        sums = np.cumsum(vibrating)
        grown = int(np.count_nonzero(sums >= 0.0))
        if grown == 0 or grown == vibrating.size:
            return float(grown)
        return grown + float(sums[grown - 1] / abs(vibrating[grown]))

    def __repr__(self) -> str:
        """One line."""
        kind = "chaotic" if self.chaotic else "not chaotic"
        return (
            f"LyapunovExponents(largest {self.largest:.5g} +- {self.standard_error[0]:.1g} 1/s, "
            f"sum {self.exponents.sum():.6g} 1/s, {self.cycles} mesh cycles, {kind}"
            f"{', ' + self.verdict if self.verdict else ''})"
        )

    def _parts(self) -> Parts:
        parts = super()._parts()
        parts.coordinates["exponent"] = np.arange(self.exponents.size)
        return parts


def lyapunov_exponents(
    system: System,
    mesh_frequency: float,
    *,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    cycles: int = 1000,
    transient: int = 200,
    steps: int = 512,
    extra_force: ArrayLike | None = None,
    verdict: bool = True,
    progress: Progress = SILENT,
) -> LyapunovExponents:
    """Find all Lyapunov exponents of the motion that a start leads to.

    Parameters
    ----------
    system : System
        The structure and its contacts.
    mesh_frequency : float
        Mesh frequency [Hz].
    start : (position, velocity), optional
        Two (n,) arrays [m or rad, m/s or rad/s]; the static equilibrium at mean stiffness by
        default.
    cycles : int
        Mesh cycles over which to average.
    transient : int
        Mesh cycles marched before.
    steps : int
        Steps per mesh cycle.
    extra_force : (n,) array, optional
        Constant generalized force on top of the system's [N or N*m].
    verdict : bool
        Whether to find them again with half the step, over half of the mesh cycles, or over 64 if
        the motion repeats.
    progress : Progress
        Told about the mesh cycles.

    Raises
    ------
    InputError
        If an argument is out of range, the step is too long or nothing can vibrate.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    Where the matrices of the steps repeat after 1 to 16 mesh cycles, the exponents are the
    logarithms of the Floquet multipliers. The standard error of a chaotic motion is that of 32
    block averages. Any other motion is averaged with a smooth window, which converges faster than
    every power of the number of cycles for periodic and quasi-periodic motion (Das, Saiki, Sander
    and Yorke, Nonlinearity 30, 2017); its error is half the difference of the two halves. The
    saltation matrix is that of Mueller, Chaos, Solitons and Fractals 5 (1995).

    Examples
    --------
    >>> free = System([[1.0]], [[0.2]], [[4.0]], [0.0])
    >>> found = lyapunov_exponents(free, 1.0, start=([1.0], [0.0]), cycles=300, steps=64)
    >>> bool(np.allclose(found.exponents, -0.1, rtol=1e-6))
    True
    """
    require_whole("cycles", cycles)
    require_whole("transient", transient, 0)
    compiled = compile_for(system, mesh_frequency, steps)
    tables = TangentTables(compiled, mesh_frequency)
    if tables.size == 0:
        what = "no coordinate is held by a spring, a damper or a contact"
        why = "Nothing vibrates, so that every exponent is zero"
        raise InputError(what, "System.stiffness", why, "Hold at least one coordinate")
    extra = read_force(system, extra_force)
    state = static_start(compiled) if start is None else read_start(system, start)
    carrier = _Carrier(tables, state, np.broadcast_to(extra, (system.size,)))
    progress.start("Mesh cycles", int(cycles + transient))
    align = min(int(transient), _ALIGN)
    carrier.settle(int(transient) - align)
    progress.advance(int(transient) - align)
    carrier.carry(align, progress)
    growth, divergence = carrier.carry(int(cycles), progress)
    progress.finish()
    spectrum = _summarize(carrier, growth, divergence, 2 * system.size)
    if not verdict:
        return spectrum
    try:
        refined = lyapunov_exponents(
            system,
            mesh_frequency,
            start=start,
            transient=transient,
            steps=2 * steps,
            cycles=min(cycles, _FEW) if spectrum.repeats else (cycles + 1) // 2,
            extra_force=extra_force,
            verdict=False,
        )
    except ComputationError:
        return replace(spectrum, verdict="step-limited")
    return replace(spectrum, verdict=exponent_verdict(spectrum, refined))


class _Carrier:
    """A motion with its orthogonal disturbances."""

    def __init__(self, tables: TangentTables, state: Array, extra: Array) -> None:
        self.tables = tables
        self.extra = extra
        self.state = state[None, :]
        k = tables.size
        self.frame = np.linalg.qr(np.random.default_rng(0).standard_normal((k, k)))[0]
        self.length = self.elapsed = 0
        self.last: deque[Array] = deque(maxlen=_KEPT)

    def settle(self, cycles: int) -> None:
        """March without disturbances."""
        for first in range(0, cycles, _ALIGN):
            self._march(min(_ALIGN, cycles - first), None)

    def _march(self, cycles: int, record: Array | None) -> None:
        frequency = self.tables.mesh_frequency
        state = march(
            self.tables.compiled,
            np.array([1.0 / frequency]),
            self.state,
            cycles,
            extra_force=self.extra[None, :],
            record=record,
            elapsed=self.elapsed,
        )
        self.elapsed += cycles
        # The free rotation runs away and nothing depends on it.
        coordinates = self.tables.coordinates
        self.state = coordinates.expand(coordinates.reduce(state))

    def carry(self, cycles: int, progress: Progress) -> tuple[Array, Array]:
        """Growth of every disturbance and mean trace in each mesh cycle [1/s]."""
        k, steps = self.tables.size, self.tables.compiled.grid.steps
        chunk = max(1, _ROOM // (steps * (k * k + self.state.shape[1])))
        growth, divergence = np.zeros((cycles, k)), np.zeros(cycles)
        for first in range(0, cycles, chunk):
            count = min(chunk, cycles - first)
            record = np.empty((count * steps + 1, self.state.shape[1], 1))
            self._march(count, record)
            matrices, traces = self._matrices(record[:, :, 0])
            matrices = matrices.reshape(count, steps, k, k)
            divergence[first : first + count] = traces.reshape(count, steps).sum(axis=1)
            self.length = self.length or safe_length(matrices[0])
            for cycle, group in enumerate(grouped_products(matrices, self.length)):
                for product in group:
                    self.frame, upper = np.linalg.qr(product @ self.frame)
                    growth[first + cycle] += np.log(np.abs(np.diag(upper)))
                self.last.append(group.copy())
            progress.advance(count)
        return growth * self.tables.mesh_frequency, divergence * self.tables.mesh_frequency

    def _matrices(self, states: Array) -> tuple[Array, Array]:
        """Matrix of every step along recorded states, and the integral of the trace."""
        tables, nodes = self.tables, self.tables.compiled.nodes
        size, steps = self.extra.size, tables.compiled.grid.steps
        place = states[:, :size].reshape(-1, size)

        def sides_at(q: Array, node: int) -> Array:
            q = q.reshape(-1, steps, size)
            d = np.einsum("rji,cri->crj", nodes.direction[:, node], q) - nodes.error[:, node]
            side = sides(d, nodes.gap[:, node], tables.dead)
            return side.reshape(len(q) * steps, d.shape[-1])

        left, right = sides_at(place[:-1], 0), sides_at(place[1:], 2)
        number = np.tile(np.arange(steps), len(left) // steps)
        crossed = np.any(left != right, axis=1)
        touching = left != 0.0
        matrices = np.empty((len(left), tables.size, tables.size))
        traces = np.empty(len(left))
        patterns = touching @ 2.0 ** np.arange(touching.shape[1])
        for pattern, first in zip(*np.unique(patterns, return_index=True), strict=True):
            which = np.flatnonzero(~crossed & (patterns == pattern))
            known = tables.whole_steps(touching[first])
            matrices[which], traces[which] = known[0][number[which]], known[1][number[which]]
        which = np.flatnonzero(crossed)
        if which.size:
            matrices[which], traces[which] = carry_over_crossings(
                tables, self.extra, number[which], states[which], left[which]
            )
        return matrices, traces


def _summarize(
    carrier: _Carrier, growth: Array, divergence: Array, count: int
) -> LyapunovExponents:
    mesh_frequency = carrier.tables.mesh_frequency
    values, errors = growth.mean(axis=0), _block_error(growth)
    mean = float(divergence.mean())
    period, apart = repeats_after(carrier.last)
    if period:
        span = period / mesh_frequency
        values = floquet_growth(list(carrier.last)[-period:], carrier.frame) / span
        errors, mean = np.full_like(values, apart / span), float(divergence[-period:].mean())
    elif not np.nanmax(values) > _SURE * np.nan_to_num(errors[int(values.argmax())]):
        half = (len(growth) + 1) // 2
        values, mean = _windowed(growth), float(_windowed(divergence[:, None])[0])
        errors = 0.5 * np.abs(_windowed(growth[:half]) - _windowed(growth[-half:]))
    free = count - values.size
    values, errors = np.append(values, np.zeros(free)), np.append(errors, np.zeros(free))
    order = np.argsort(-values, kind="stable")
    return LyapunovExponents(
        exponents=values[order],
        standard_error=errors[order],
        divergence=mean,
        free=free,
        mesh_frequency=mesh_frequency,
        cycles=len(growth),
        repeats=period,
        growth=growth,
    )


def _block_error(growth: Array) -> Array:
    """Standard error of the mean from block averages; NaN with a single cycle."""
    blocks = min(_BLOCKS, len(growth))
    if blocks < 2:
        return np.full(growth.shape[1], np.nan)
    length = len(growth) // blocks
    means = growth[-blocks * length :].reshape(blocks, length, -1).mean(axis=1)
    return np.asarray(means.std(axis=0, ddof=1) / np.sqrt(blocks))


def _windowed(values: Array) -> Array:
    """Mean with the weight ``exp(-1/(t (1 - t)))``, t from 0 to 1 over the rows."""
    t = (np.arange(len(values)) + 0.5) / len(values)
    weight = np.exp(-1.0 / (t * (1.0 - t)))
    return np.asarray(weight @ values / weight.sum())


def exponent_verdict(spectrum: LyapunovExponents, refined: LyapunovExponents) -> Verdict:
    """Judge Lyapunov exponents by those with shorter steps."""
    both_repeat = spectrum.repeats > 0 and refined.repeats > 0
    if spectrum.chaotic != refined.chaotic or (both_repeat and spectrum.repeats != refined.repeats):
        return "step-limited"
    largest, refined_largest = float(spectrum.vibrating[0]), float(refined.vibrating[0])
    errors = (float(item.standard_error[0]) for item in (spectrum, refined))
    spread = math.hypot(*(0.0 if math.isnan(error) else error for error in errors))
    allowed = max(
        _EXPONENT * max(abs(largest), abs(refined_largest)),
        _ERRORS * spread,
        _ZERO * spectrum.mesh_frequency,
    )
    return "physical" if abs(largest - refined_largest) <= allowed else "undecided"


def repeats_after(cycles: Sequence[Array]) -> tuple[int, float]:
    """Tell after how many mesh cycles the matrices repeat."""
    known = np.asarray(cycles)
    size = np.linalg.norm(known, axis=(-2, -1))
    for period in range(1, min(_PERIODS, len(known) // 2) + 1):
        apart = np.linalg.norm(known[period:] - known[:-period], axis=(-2, -1)) / size[period:]
        if apart.max() <= _REPEATS:
            return period, float(apart.max())
    return 0, float("nan")


def floquet_growth(cycles: Sequence[Array], frame: Array) -> Array:
    """Growth of disturbances over one period, from matrices and a frame that has turned in."""
    old, uppers = frame, []
    for product in (product for groups in cycles for product in groups):
        frame, upper = np.linalg.qr(product @ frame)
        uppers.append(upper)
    turn = old.T @ frame
    size = turn.shape[0]
    edges = [0, *(i for i in range(1, size) if np.abs(turn[i:, :i]).max() < _APART), size]
    growth = np.zeros(size)
    for first, last in pairwise(edges):
        block, scale = np.eye(last - first), 0.0
        for upper in uppers:
            block = upper[first:last, first:last] @ block
            norm = float(np.linalg.norm(block))
            block, scale = block / norm, scale + float(np.log(norm))
        values = np.linalg.eigvals(turn[first:last, first:last] @ block)
        growth[first:last] = np.log(np.abs(values)) + scale
    return np.asarray(np.sort(growth)[::-1])


def _pairwise(matrices: Array) -> Array:
    """Products of neighbours (cycles, steps, k, k), the later step on the left."""
    if matrices.shape[1] % 2:
        unit = np.broadcast_to(np.eye(matrices.shape[-1]), (len(matrices), 1, *matrices.shape[2:]))
        matrices = np.concatenate((matrices, unit), axis=1)
    return np.asarray(matrices[:, 1::2] @ matrices[:, ::2])


def safe_length(matrices: Array) -> int:
    """Steps that may be multiplied before disturbances are made orthogonal again."""
    product, length = matrices[None], 1
    while product.shape[1] > 1:
        longer = _pairwise(product)
        if not np.all(np.linalg.cond(longer) <= _SPREAD):
            break
        product, length = longer, 2 * length
    return length


def grouped_products(matrices: Array, length: int) -> Array:
    """Products of every ``length`` steps of every mesh cycle."""
    while length > 1:
        matrices, length = _pairwise(matrices), length // 2
    return matrices
