"""Stroboscopic sections: the state once per mesh cycle, and after how many cycles it repeats."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.drawing import draw
from tribodyn.dynamics.equations.compiled import Compiled, compile_for
from tribodyn.dynamics.equations.orbit_coordinates import orbit_coordinates, static_start
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.periods import closed_period, open_period
from tribodyn.dynamics.time.response import Response
from tribodyn.dynamics.time.simulate import read_force, read_start
from tribodyn.errors import ComputationError, InputError
from tribodyn.nonlinear.attractors import Motions
from tribodyn.nonlinear.survey import Path, Verdict, follow, step_verdict
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

#: An rms below this share of the largest compression is that of a motion at rest: means of squares
#: do not tell smaller ones.
_REST = 1e-7
#: Mesh cycles in which an orbit becomes that of shorter steps.
_ORBIT = 100


@record
class PoincareSection(Record):
    """States of a motion once per mesh cycle, at the mesh phase 0.

    Parameters
    ----------
    position, velocity : (points, n) array
        Coordinates and their velocities [m or rad, m/s or rad/s].
    deflection : (points, contacts) array
        Compression of each contact [m].
    names : tuple of str
        Names of the coordinates.
    mesh_frequency : float
        Mesh frequency [Hz].
    period : int
        Mesh cycles after which the motion repeats, 1 to 16; 0 if it is quasi-periodic, chaotic or
        not yet settled.
    verdict : "physical", "step-limited", "undecided" or ""
        What half the step says of it, see :func:`~tribodyn.nonlinear.survey.step_verdict`; empty
        where not requested.
    """

    position: Array = quantity("mesh_cycle", "coordinate", unit="m or rad")
    velocity: Array = quantity("mesh_cycle", "coordinate", unit="m/s or rad/s")
    deflection: Array = quantity("mesh_cycle", "contact", unit="m")
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    mesh_frequency: float = fact()
    period: int = fact()
    verdict: str = fact(default="")

    def __repr__(self) -> str:
        """One line."""
        kind = f"period {self.period}" if self.period else "no period up to 16"
        return (
            f"PoincareSection({len(self.position)} points at {self.mesh_frequency:.6g} Hz, {kind}"
            f"{', ' + self.verdict if self.verdict else ''})"
        )

    def plot(self, coordinate: int | str = 0, **options: Any) -> Any:
        """Draw the points of one coordinate in its phase plane.

        Parameters
        ----------
        coordinate : int or str
            Number or name of the coordinate.
        **options
            None are known.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, coordinate=coordinate, **options)


def poincare(
    motion: System | Response,
    mesh_frequency: float | None = None,
    *,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    cycles: int = 64,
    transient: int = 200,
    steps: int = 512,
    extra_force: ArrayLike | None = None,
    verdict: bool = True,
    system: System | None = None,
) -> PoincareSection:
    """Look at a motion once per mesh cycle, and find its period.

    Parameters
    ----------
    motion : System or Response
        A system to march, or a motion that is known already; its first ``transient`` mesh cycles
        are left out if more than as many are there.
    mesh_frequency : float, optional
        Mesh frequency [Hz]; needed with a system.
    start : (position, velocity), optional
        Two (n,) arrays [m or rad, m/s or rad/s]; the static equilibrium at mean stiffness by
        default.
    cycles : int
        Mesh cycles, one point each.
    transient : int
        Mesh cycles before the first point.
    steps : int
        Steps per mesh cycle.
    extra_force : (n,) array, optional
        Constant generalized force on top of the system's [N or N*m].
    verdict : bool
        Whether to march a system again with half the step and compare.
    system : System, optional
        That of a motion that is known already, which is then marched again with half the step.

    Raises
    ------
    InputError
        If an argument is out of range or the step is too long.
    ComputationError
        If the motion grows beyond all bounds.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase))
    >>> poincare(System([[1.0]], [[0.2]], [[0.0]], [1.0], [pair]), 1.0)
    PoincareSection(64 points at 1 Hz, period 1, physical)
    """
    if isinstance(motion, Response):
        return _judged_response(motion, _section_of(motion, transient), transient, system)
    if mesh_frequency is None or cycles < 1 or transient < 0:
        what = f"mesh_frequency = {mesh_frequency}, cycles = {cycles}, transient = {transient}"
        why = "A system needs a mesh frequency, at least one mesh cycle and no negative transient"
        remedy = "Give the mesh frequency of each system in Hz"
        raise InputError(what, "argument mesh_frequency", why, remedy)
    compiled = compile_for(motion, mesh_frequency, steps)
    state = static_start(compiled) if start is None else read_start(motion, start)
    force = read_force(motion, extra_force)
    path = _march(compiled, float(mesh_frequency), (state, force), transient, cycles)
    nodes = compiled.nodes
    position = path.states[:, 0, : motion.size]
    section = PoincareSection(
        position=position,
        velocity=path.states[:, 0, motion.size :],
        deflection=position @ nodes.direction[0, 0].T - nodes.error[0, 0],
        names=tuple(motion.names),
        mesh_frequency=float(mesh_frequency),
        period=_period(compiled, float(mesh_frequency), path),
    )
    if not verdict:
        return section
    reference = (compiled.step_number, section.period, _path_rms(path))
    judged = judge_section(
        motion, mesh_frequency, (state, force), 2 * steps, transient, cycles, reference
    )
    return replace(section, verdict=judged)


def _march(
    compiled: Compiled,
    mesh_frequency: float,
    start: tuple[Array, Array],
    transient: int,
    cycles: int,
) -> Path:
    """One motion over a transient, then once per mesh cycle."""
    state, force = (item[None, :] for item in start)
    motions, lane = Motions(compiled, np.array([mesh_frequency]), state, force), np.zeros(1, int)
    signal = 0 if compiled.system.contacts else compiled.system.names[0]
    for cycle in range(transient):
        state = motions.march(lane, state, 1, force, elapsed=cycle)
        state = motions.at_rest(state)
    return follow(motions, lane, state, cycles, signal, transient)


def _period(compiled: Compiled, mesh_frequency: float, path: Path) -> int:
    return open_period(orbit_coordinates(compiled, mesh_frequency).reduce(path.states[:, 0]))


def _path_rms(path: Path) -> float:
    """Alternating rms; zero for rounding."""
    rms = float(path.rms[0])
    return 0.0 if rms < _REST * float(path.largest[0]) else rms


def judge_section(
    system: System,
    mesh_frequency: float,
    start: tuple[Array, Array],
    steps: int,
    transient: int,
    cycles: int,
    reference: tuple[float, int, float],
) -> Verdict:
    """Judge a section by one with shorter steps."""
    compiled = compile_for(system, mesh_frequency, steps)
    try:
        path = _march(compiled, float(mesh_frequency), start, transient, cycles)
    except ComputationError:
        return "step-limited"
    number, period, rms = reference
    refined = _period(compiled, float(mesh_frequency), path)
    return step_verdict(number, period, rms, refined, _path_rms(path))


def alternating_rms(signal: Array, weight: Array) -> float:
    """Alternating rms; zero for rounding."""
    weight = weight / weight.sum()
    mean = float(weight @ signal)
    rms = float(np.sqrt(weight @ (signal - mean) ** 2))
    return 0.0 if rms < _REST * float(np.abs(signal).max(initial=0.0)) else rms


def _judged_response(
    response: Response, section: PoincareSection, transient: int, system: System | None
) -> PoincareSection:
    """Judge an existing motion, if its system is given."""
    if system is None:
        return section
    orbit = bool(response.floquet_multipliers.size)
    steps = len(response.position) // response.periods
    skipped = transient if response.periods > transient and not orbit else 0
    fine = response.fine
    rows = fine.phase >= skipped
    signal = fine.deflection if fine.deflection.shape[1] else fine.position
    state = np.concatenate((response.position[skipped * steps], response.velocity[skipped * steps]))
    reference = (
        response.step_number,
        section.period,
        alternating_rms(signal[rows, 0], fine.weight[rows]),
    )
    # An orbit is followed until it has become that of the shorter steps.
    judged = judge_section(
        system,
        response.mesh_frequency,
        (state, response.extra_force),
        2 * steps,
        _ORBIT if orbit and response.stable else 0,
        2 * response.periods if orbit else response.periods - skipped,
        reference,
    )
    return replace(section, verdict=judged)


def _section_of(response: Response, transient: int) -> PoincareSection:
    """Section of an existing motion."""
    steps = len(response.position) // response.periods
    skipped = transient if response.periods > transient else 0
    if response.floquet_multipliers.size:
        skipped = 0
    rows = slice(skipped * steps, None, steps)
    deflection = response.deflection[rows]
    place = deflection if deflection.shape[1] else response.position[rows]
    is_orbit = response.floquet_multipliers.size and response.converged
    size = float(np.linalg.norm(place, axis=1).max()) or 1.0
    return PoincareSection(
        position=response.position[rows],
        velocity=response.velocity[rows],
        deflection=deflection,
        names=response.names,
        mesh_frequency=response.mesh_frequency,
        period=closed_period(place, size) if is_orbit else open_period(place),
    )


@record
class PhasePortrait(Record):
    """One coordinate, or the compression of a contact, in its phase plane.

    Parameters
    ----------
    name : str
        Name of the coordinate, or ``contact 0``.
    position, velocity : (points,) array
        The motion [m or rad, m/s or rad/s]; a motion that repeats is closed.
    section_position, section_velocity : (cycles,) array
        The same at the mesh phase 0.
    period : int
        Mesh cycles after which the motion repeats; 0 if it does not.
    gap : float
        Half of the backlash of the contact [m]; -1 for a coordinate.
    mesh_frequency : float
        Mesh frequency [Hz].
    verdict : "physical", "step-limited", "undecided" or ""
        What half the step says of it; empty where not requested.
    """

    name: str = fact()
    position: Array = quantity("point", unit="m or rad")
    velocity: Array = quantity("point", unit="m/s or rad/s")
    section_position: Array = quantity("mesh_cycle", unit="m or rad")
    section_velocity: Array = quantity("mesh_cycle", unit="m/s or rad/s")
    period: int = fact()
    gap: float
    mesh_frequency: float = fact()
    verdict: str = fact(default="")

    def __repr__(self) -> str:
        """One line."""
        return (
            f"PhasePortrait(name={self.name!r}, period={self.period!r}, "
            f"mesh_frequency={self.mesh_frequency!r}, verdict={self.verdict!r})"
        )


def phase_portrait(
    motion: Response,
    of: int | str = 0,
    *,
    gap: float = -1.0,
    transient: int = 0,
    system: System | None = None,
) -> PhasePortrait:
    """Take one coordinate or one contact of a motion into its phase plane.

    Parameters
    ----------
    motion : Response
        From :func:`tribodyn.dynamics.steady_state` or :func:`tribodyn.dynamics.simulate`.
    of : int or str
        Number of the contact whose compression is evaluated, or name of a coordinate.
    gap : float
        Half of the backlash of the contact [m], which the figure then shows.
    transient : int
        First mesh cycles to leave out.
    system : System, optional
        That of the motion: it is then marched again with half the step, for the verdict.

    Raises
    ------
    InputError
        If there is no such contact or coordinate, or nothing is left of the motion.

    Notes
    -----
    The rate of a compression is taken by differences of second order over the rows, since a
    Response holds no exact one.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[(2.0 * np.pi) ** 2]], [0.0])
    >>> turn = phase_portrait(simulate(free, 1.0, 4, ([1.0], [0.0]), steps=256), "q0")
    >>> turn.period, float(abs(turn.velocity).max().round(4))
    (1, 6.2832)
    """
    cycles = motion.periods - transient
    is_coordinate = isinstance(of, str) and of in motion.names
    contact = not isinstance(of, str) and 0 <= of < motion.deflection.shape[1]
    if cycles < 1 or not (is_coordinate or contact):
        raise InputError(
            f"{of!r} after {transient} of {motion.periods} mesh cycles",
            where="argument of",
            why=f"A contact from 0 to {motion.deflection.shape[1] - 1}, or one of "
            f"{', '.join(motion.names)}, over at least one mesh cycle",
            remedy="Choose one of these, and leave at least one mesh cycle",
        )
    steps = len(motion.position) // motion.periods
    rows = slice(transient * steps, None)
    if isinstance(of, str):
        column = motion.names.index(of)
        place, speed = motion.position[rows, column], motion.velocity[rows, column]
    else:
        place = motion.deflection[rows, of]
        speed = np.asarray(np.gradient(place, motion.time[rows]))
    section = poincare(motion, transient=transient, system=system)
    mark = slice(0, None, steps)
    points = place[mark], speed[mark]
    if motion.floquet_multipliers.size:
        place, speed = np.append(place, place[0]), np.append(speed, speed[0])
    return PhasePortrait(
        name=of if isinstance(of, str) else f"contact {of}",
        position=place,
        velocity=speed,
        section_position=points[0],
        section_velocity=points[1],
        period=section.period,
        gap=max(gap, 0.0) if not isinstance(of, str) else -1.0,
        mesh_frequency=motion.mesh_frequency,
        verdict=section.verdict,
    )
