"""Lyapunov exponents: how fast neighbouring motions diverge or converge.

The tangent method: small disturbances are carried along the motion by the linear equations that
hold between two changes of contact, with saltation matrices where contacts open or close, and
made orthogonal again before they become parallel. Growth per time is the spectrum of exponents.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.compiled import announce
from tribodyn.dynamics.equations.orbit_coordinates import OrbitCoordinates, static_start
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.modal.modal_march import compile_motion
from tribodyn.dynamics.time.simulate import read_force, read_start
from tribodyn.errors import ComputationError, InputError
from tribodyn.nomenclature import require_whole
from tribodyn.nonlinear.lyapunov_carrier import (
    Carrier,
    carrier_of,
    floquet_growth,
    repeats_after,
)
from tribodyn.nonlinear.survey import Verdict
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, Mask

_BLOCKS = 32
#: Mesh cycles that are averaged by default, and of a motion that does not repeat the fewest, and
#: the derivatives of its states in them.
_CYCLES, _FEWEST, _DERIVATIVES = 1000, 20, 2e9
#: Mesh cycles over which a motion that repeats is integrated with half the step.
_FEW = 64
#: Standard errors by which the largest exponent of a chaotic motion is above zero.
_SURE = 3.0
#: Largest exponents agree within this many standard errors of their difference, or this share, or
#: this share of the mesh frequency, which is how well an exponent of zero is known.
_ERRORS, _EXPONENT, _ZERO = 3.0, 0.05, 1e-3
#: Mean share of a disturbance in a braked free rotation above which its exponent belongs to it.
_BELONGS = 0.5
#: Amplitude, relative to the largest, above which a coordinate takes part in a free rotation.
_TURNS = 1e-6


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
        Growth of the orthogonal disturbances in every mesh cycle, in the order of the exponents
        [1/s].
    verdict : "physical", "step-limited", "undecided" or ""
        What half the step says of it, see
        :func:`~tribodyn.nonlinear.lyapunov.exponent_verdict`; empty where not requested.
    free_rotation : (2 n,) bool array, optional
        Which exponents belong to free rotations, a pair for each: that of its angle, which is
        zero, and that of its speed, which is zero without dampers and minus their rate with them.
    rotating : tuple of str, optional
        Coordinates that turn in free rotations; empty where the structure has none.
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
    free_rotation: Mask = quantity("exponent", default=None)
    rotating: tuple[str, ...] = fact(default=())

    def __post_init__(self) -> None:
        """Assign exact zeros to the free rotations if ``free_rotation`` is None."""
        if self.free_rotation is None:
            zero = self.exponents == 0.0
            object.__setattr__(self, "free_rotation", zero & (np.cumsum(zero) <= self.free))

    @property
    def largest(self) -> float:
        """Largest exponent, those of free rotations left out [1/s]."""
        return float(self.vibrating[0])

    @property
    def largest_error(self) -> float:
        """Standard error of the largest exponent [1/s]."""
        return float(self.standard_error[~self.free_rotation][0])

    @property
    def vibrating(self) -> Array:
        """Exponents without those of free rotations, the largest first [1/s]."""
        return np.asarray(self.exponents[~self.free_rotation])

    @property
    def vibrating_growth(self) -> Array:
        """Growth in every mesh cycle without that of braked free rotations [1/s]."""
        zeros = np.flatnonzero(self.free_rotation & (self.exponents == 0.0))[: self.free]
        return np.asarray(self.growth[:, ~np.delete(self.free_rotation, zeros)])

    @property
    def chaotic(self) -> bool:
        """Whether nothing repeats and the largest exponent is three standard errors above zero."""
        above = self.largest > _SURE * self.largest_error
        return bool(above and self.largest > 0.0 and self.repeats == 0)

    @property
    def left_out(self) -> str:
        """Text that lists the exponents of free rotations; empty where the structure has none."""
        count = int(self.free_rotation.sum())
        if not count:
            return ""
        values = ", ".join(f"{value:.4g}" for value in self.exponents[self.free_rotation])
        return (
            f"free rotation of {', '.join(self.rotating)} left out: "
            f"{count} exponent{'s' if count > 1 else ''}, {values} 1/s"
        )

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
        parts = [
            f"largest {self.largest:.5g} +- {self.largest_error:.1g} 1/s",
            self.left_out,
            f"sum {self.exponents.sum():.6g} 1/s",
            f"{self.cycles} mesh cycles",
            kind,
            self.verdict,
        ]
        return f"LyapunovExponents({', '.join(part for part in parts if part)})"

    def _parts(self) -> Parts:
        parts = super()._parts()
        parts.coordinates["exponent"] = np.arange(self.exponents.size)
        parts.attributes["rotating"] = ", ".join(self.rotating)
        parts.attributes["largest"] = self.largest
        parts.attributes["largest_error"] = self.largest_error
        return parts


def lyapunov_exponents(
    system: System,
    mesh_frequency: float,
    *,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    cycles: int | None = None,
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
    cycles : int, optional
        Mesh cycles over which to average; by default 1000, or of a motion that does not repeat as
        many as 2e9 derivatives reach, and at least 20.
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
        Receives the number of finished mesh cycles; silent by default.

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
    saltation matrix is that of Mueller, Chaos, Solitons and Fractals 5 (1995). Systems with more
    than 24 coordinates, and those with ramps, are integrated in modal coordinates: until
    the motion repeats, which leaves the matrices of one period, or until the matrices do.

    Free rotations follow from the structure, not from exponents that are small: they are the
    motions that no spring strains and no contact direction feels at any mesh phase. The exponent
    of the speed of one that dampers brake is that of the disturbances that lie, on the average,
    for more than half in it; where dampers tie it so closely to the vibration that there are
    none, it stays among the others.

    Examples
    --------
    >>> free = System([[1.0]], [[0.2]], [[4.0]], [0.0])
    >>> spectrum = lyapunov_exponents(free, 1.0, start=([1.0], [0.0]), cycles=300, steps=64)
    >>> bool(np.allclose(spectrum.exponents, -0.1, rtol=1e-6))
    True
    """
    if cycles is not None:
        require_whole("cycles", cycles)
    require_whole("transient", transient, 0)
    compiled = compile_motion(system, mesh_frequency, steps)
    extra = read_force(system, extra_force)
    state = static_start(compiled) if start is None else read_start(system, start)
    forced = np.broadcast_to(extra, (system.size,))
    carrier = carrier_of(compiled, mesh_frequency, state, forced)
    if carrier.tables.coordinates.elastic.shape[1] == 0:
        what = "no coordinate is restrained by a spring or a contact"
        why = "Nothing vibrates, so that every exponent is zero"
        raise InputError(what, "System.stiffness", why, "Restrain at least one coordinate")
    progress.start("Mesh cycles", int((cycles or _CYCLES) + transient))
    turning = carrier.settle(int(transient), progress)
    costly = compiled.engine is not None and not carrier.period
    cycles = cycles or (_affordable(compiled.grid.steps, system.size) if costly else _CYCLES)
    if costly and turning > cycles:
        carrier.march(turning - cycles)  # without derivatives, which cost more than the mean then
        turning = cycles
    carrier.carry(turning, progress)
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


def _affordable(steps: int, coordinates: int) -> int:
    """Mesh cycles whose derivatives are not too many, with a notice where they are few."""
    count = int(_DERIVATIVES / (steps * (2.0 * coordinates) ** 2))
    if count >= _CYCLES:
        return _CYCLES
    count = max(count, _FEWEST)
    announce(
        f"the motion does not repeat: averaging over {count} periods, some minutes; cycles "
        "(--cycles) asks for others"
    )
    return count


def _summarize(carrier: Carrier, growth: Array, divergence: Array, count: int) -> LyapunovExponents:
    mesh_frequency = carrier.tables.mesh_frequency
    values, errors, share = growth.mean(axis=0), _block_error(growth), carrier.share
    mean = float(divergence.mean())
    period, mismatch = repeats_after(carrier.last)
    if period:
        span = period / mesh_frequency
        repeated = list(carrier.last)[-period:]
        values, share, separated = floquet_growth(repeated, carrier.frame, carrier.braked)
        averages, deviations = _averages(growth)
        values = np.where(separated, values / span, averages)
        errors = np.where(separated, mismatch / span, deviations)
        mean = float(divergence[-period:].mean())
    elif not np.nanmax(values) > _SURE * np.nan_to_num(errors[int(values.argmax())]):
        mean = float(_windowed(divergence[:, None])[0])
        values, errors = _averages(growth)
    growth = growth[:, np.argsort(-values, kind="stable")]
    free, braked = count - values.size, np.zeros(values.size, dtype=bool)
    braked[np.argsort(-share, kind="stable")[: carrier.braked.shape[1]]] = True
    braked &= share > _BELONGS
    values, errors = np.append(values, np.zeros(free)), np.append(errors, np.zeros(free))
    order = np.argsort(-values, kind="stable")
    return LyapunovExponents(
        exponents=values[order],
        standard_error=errors[order],
        divergence=mean,
        free=free,
        free_rotation=np.append(braked, np.ones(free, dtype=bool))[order],
        rotating=_rotating(carrier.tables.coordinates, carrier.tables.compiled.system),
        mesh_frequency=mesh_frequency,
        cycles=len(growth),
        repeats=period,
        growth=growth,
    )


def _rotating(coordinates: OrbitCoordinates, system: System) -> tuple[str, ...]:
    """Coordinates that take part in free rotations."""
    shape = coordinates.inverse.T @ coordinates.rotations
    size = np.sqrt(np.diag(np.asarray(system.mass))) * np.linalg.norm(shape, axis=1)
    least = _TURNS * size.max(initial=0.0)
    return tuple(name for name, each in zip(system.names, size, strict=True) if each > least)


def _block_error(growth: Array) -> Array:
    """Standard error of the mean from block averages; NaN with a single cycle."""
    blocks = min(_BLOCKS, len(growth))
    if blocks < 2:
        return np.full(growth.shape[1], np.nan)
    length = len(growth) // blocks
    means = growth[-blocks * length :].reshape(blocks, length, -1).mean(axis=1)
    return np.asarray(means.std(axis=0, ddof=1) / np.sqrt(blocks))


def _averages(growth: Array) -> tuple[Array, Array]:
    """Averages with a smooth window, and half the difference of those of both halves."""
    half = (len(growth) + 1) // 2
    errors = 0.5 * np.abs(_windowed(growth[:half]) - _windowed(growth[-half:]))
    return _windowed(growth), errors


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
    largest, refined_largest = spectrum.largest, refined.largest
    errors = (item.largest_error for item in (spectrum, refined))
    spread = math.hypot(*(0.0 if math.isnan(error) else error for error in errors))
    allowed = max(
        _EXPONENT * max(abs(largest), abs(refined_largest)),
        _ERRORS * spread,
        _ZERO * spectrum.mesh_frequency,
    )
    return "physical" if abs(largest - refined_largest) <= allowed else "undecided"
