"""Basins of attraction: the motion that each start of a plane converges to."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.modal.modal_march import compile_motion
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import InputError
from tribodyn.nonlinear.attractors import Motions
from tribodyn.nonlinear.basins_attractors import Attractor, Basins, Catalogue, multiplier_of
from tribodyn.nonlinear.survey import Survey, signal_name, step_verdict
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, Index, Mask

#: Certified distance to an attractor at which a start has come to it, relative to the state.
_NEAR = 1e-4
#: A motion this much smaller than the starts is at rest.
_REST = 1e-9
#: Lanes of one block.
_WIDTH = 64


def basins(
    system: System,
    mesh_frequency: float,
    *,
    between: tuple[tuple[float, float], tuple[float, float]],
    coordinates: tuple[str, str] | None = None,
    points: tuple[int, int] = (101, 101),
    start: tuple[ArrayLike, ArrayLike] | None = None,
    cycles: int = 400,
    steps: int = 256,
    signal: int | str = 0,
    extra_force: ArrayLike | None = None,
    verdict: bool = True,
    keep_partial: bool = False,
    progress: Progress = SILENT,
) -> Basins:
    """Find the motion that every start of a plane converges to.

    Parameters
    ----------
    system : System
        The structure and its contacts.
    mesh_frequency : float
        Mesh frequency [Hz].
    between : two pairs of float
        Range of each of the two components of the state [m, rad, m/s or rad/s].
    coordinates : two str, optional
        The components: the name of a coordinate, or of one followed by ``_velocity``; the first
        coordinate and its velocity by default. Or ``("dynamic_transmission_error",
        "dynamic_transmission_error_rate")``: the compression of the first contact, or that of
        ``signal``, from where its driving flank first touches, and its rate, as a push at the
        contact changes them.
    points : two int
        Values of each.
    start : (position, velocity), optional
        What the other components are [m or rad, m/s or rad/s]; the static equilibrium at mean
        stiffness by default.
    cycles : int
        Mesh cycles at most for a start to come near its motion.
    steps : int
        Steps per mesh cycle.
    signal : int or str
        Contact whose compression rms and contact loss are of, or name of a coordinate.
    extra_force : (n,) array, optional
        Constant generalized force on top of the system's [N or N*m].
    verdict : bool
        Repeat everything with half the step, and judge.
    keep_partial : bool
        Return what is finished when interrupted (Ctrl-C), see ``finished``.
    progress : Progress
        Receives the number of finished starts; silent by default.

    Returns
    -------
    Basins
        Attractors with their shares, the largest first.

    Raises
    ------
    InputError
        If an argument is out of range or the step is too long.
    KeyboardInterrupt
        On an interruption (Ctrl-C), unless ``keep_partial``.

    Notes
    -----
    A motion that repeats only after ``p`` mesh cycles is one attractor, whichever of its ``p``
    states a start comes to. Motions that do not repeat are distinguished by their rms. Boundaries
    between basins can be fractal: ``changed`` is the part of the starts that another step sends to
    another motion, which no step makes zero.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda p: 1.0 + 0.2 * np.cos(2 * np.pi * p), gap=1.0)
    >>> system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [pair], names=["x"])
    >>> result = basins(system, 0.14, between=((1.0, 2.0), (0.0, 1.0)), points=(3, 3), steps=64)
    >>> result.coordinates, [each.period for each in result.attractors]
    (('x', 'x_velocity'), [1, 1])
    """
    compiled = compile_motion(system, mesh_frequency, steps)
    beat = float(mesh_frequency)
    plane = start_plane(compiled, beat, coordinates, signal if isinstance(signal, int) else 0)
    axes = _axes(between, points, cycles)
    state = static_start(compiled) if start is None else read_start(system, start)
    starts = plane.starts(axes, state)
    force = np.zeros(system.size) if extra_force is None else np.asarray(extra_force, dtype=float)
    name = signal_name(system, signal)
    quantity = signal if system.contacts else name
    settings = (cycles, max(64, cycles), 2, quantity, keep_partial)
    survey = Survey(*settings, tolerance=_NEAR, width=_WIDTH)
    catalogue = Catalogue(survey, _REST * float(np.abs(starts[:, : system.size]).max()))
    progress.start("Motions", len(starts) * (1 + bool(verdict)))
    motions = _motions(compiled, starts, beat, force)
    survey.settle(motions, np.arange(len(starts)), progress)
    label = catalogue.label(motions)
    attractors = [
        _attractor(catalogue, n, label[motions.finished] == n, motions, steps, plane)
        for n in range(len(catalogue.known))
    ]
    refined = np.full(label.shape, -3)
    if verdict and motions.finished.all():
        again = _motions(compile_motion(system, beat, 2 * steps), starts, beat, force)
        fine = _followed_again(catalogue, again, force, progress)
        attractors = _judged(attractors, fine, compiled.limited_number)
        refined = _labels_again(fine, again, len(attractors))
    progress.finish()
    order = np.argsort([-attractor.share for attractor in attractors], kind="stable")
    rank, shape = np.argsort(order), (axes[0].size, axes[1].size)
    return Basins(
        coordinates=plane.names,
        units=plane.units,
        first=axes[0],
        second=axes[1],
        attractor=_renumbered(label, rank).reshape(shape),
        attractors=tuple(attractors[n] for n in order),
        refined_attractor=_renumbered(refined, rank).reshape(shape),
        names=tuple(system.names),
        signal=name,
        mesh_frequency=beat,
        steps=steps,
        step_number=compiled.step_number,
        finished=motions.finished.reshape(shape),
    )


def _followed_again(
    catalogue: Catalogue, again: Motions, force: Array, progress: Progress
) -> Catalogue:
    """Follow all attractors, then all starts, with shorter steps."""
    fine = catalogue.again(again.compiled, float(again.frequency[0]), force)
    catalogue.survey.settle(again, np.arange(again.frequency.size), progress)
    return fine


def _motions(compiled: Compiled, starts: Array, beat: float, force: Array) -> Motions:
    count = len(starts)
    return Motions(compiled, np.full(count, beat), starts, np.tile(force, (count, 1)))


def _attractor(
    catalogue: Catalogue,
    number: int,
    mine: Mask,
    motions: Motions,
    steps: int,
    plane: StartPlane,
) -> Attractor:
    marched = catalogue.known[number]
    half = marched.full.shape[1] // 2
    multiplier = multiplier_of(marched, motions, steps)
    return Attractor(
        position=marched.full[:, :half],
        velocity=marched.full[:, half:],
        period=marched.period,
        rms=marched.rms,
        contact_loss_share=marched.contact_loss_share,
        largest_multiplier=multiplier,
        stable=not multiplier >= 1.0,
        share=float(np.mean(mine)) if mine.size else 0.0,
        section=plane.section(marched.full),
    )


def _judged(attractors: list[Attractor], fine: Catalogue, step_number: float) -> list[Attractor]:
    """Attractors with the verdict of a repetition with half the step."""
    return [
        replace(
            each,
            verdict=step_verdict(step_number, each.period, each.rms, other.period, other.rms),
            refined_period=other.period,
            refined_rms=other.rms,
        )
        for each, other in zip(attractors, fine.known, strict=True)
    ]


def _labels_again(fine: Catalogue, again: Motions, count: int) -> Index:
    """Attractor of every start with shorter steps; -2 for a new one."""
    if not again.finished.all():
        return np.full(again.frequency.size, -3)
    refined = fine.label(again)
    refined[refined >= count] = -2
    return refined


def _renumbered(label: Index, rank: Index) -> Index:
    labelled = label >= 0
    out = label.copy()
    out[labelled] = rank[label[labelled]]
    return out


def _axes(
    between: tuple[tuple[float, float], tuple[float, float]], points: tuple[int, int], cycles: int
) -> tuple[Array, Array]:
    ends = np.asarray(between, dtype=float)
    counts = np.asarray(points)
    wrong = ends.shape != (2, 2) or counts.shape != (2,)
    if wrong or not np.all(np.isfinite(ends)) or np.any(counts < 2) or cycles < 1:
        what = f"between = {between}, points = {points}, cycles = {cycles}"
        why = "A plane has two ranges of at least two values, and needs a mesh cycle"
        remedy = "Write, for example, between=((-1e-4, 1e-4), (-0.1, 0.1))"
        raise InputError(what, "argument between", why, remedy)
    first, second = (
        np.linspace(float(low), float(high), int(n))
        for (low, high), n in zip(ends, counts, strict=True)
    )
    return first, second


#: Coordinates of a plane across a contact.
MESH_PLANE = ("dynamic_transmission_error", "dynamic_transmission_error_rate")
#: Ending of the name of a velocity.
VELOCITY = "_velocity"


@dataclass(frozen=True)
class StartPlane:
    """Plane of states through a state at rest."""

    names: tuple[str, str]
    units: tuple[str, str]
    project: Array  #: coordinates of a state (2, 2 n)
    offset: Array  #: taken off them (2,)
    lift: Array  #: change of the state for a change of each coordinate (2 n, 2)
    columns: tuple[int, ...] = ()  #: components of the state, where the coordinates are such

    def section(self, states: Array) -> Array:
        """Coordinates of states (..., 2 n) in the plane."""
        return np.asarray(states @ self.project.T - self.offset)

    def starts(self, axes: tuple[Array, Array], rest_state: Array) -> Array:
        """States of all starts, the second axis varying fastest."""
        values = np.stack([each.ravel() for each in np.meshgrid(*axes, indexing="ij")], axis=1)
        starts = rest_state + (values - self.section(rest_state)) @ self.lift.T
        for number, column in enumerate(self.columns):
            starts[:, column] = values[:, number]
        return np.asarray(starts)


def start_plane(
    compiled: Compiled, mesh_frequency: float, names: tuple[str, str] | None, contact: int = 0
) -> StartPlane:
    """Plane of starts over two coordinates; by default the first of the system and its velocity."""
    system = compiled.system
    names = names or (system.names[0], system.names[0] + VELOCITY)
    if tuple(names) == MESH_PLANE and system.contacts:
        return _across_mesh(compiled, mesh_frequency, contact)
    columns = _columns(system, names)
    rows = np.eye(2 * system.size)[list(columns)]
    units = (_unit(names[0]), _unit(names[1]))
    return StartPlane((names[0], names[1]), units, rows, np.zeros(2), rows.T, columns)


def _across_mesh(compiled: Compiled, mesh_frequency: float, contact: int) -> StartPlane:
    nodes = compiled.nodes
    along = nodes.direction[0, 0, contact]
    turning = mesh_frequency * nodes.direction_slope[0, 0, contact]
    push = np.linalg.solve(np.asarray(compiled.system.mass), along)
    push = push / (along @ push)
    still = np.zeros_like(along)
    lift = np.concatenate((push, -(turning @ push) * push)), np.concatenate((still, push))
    return StartPlane(
        MESH_PLANE,
        ("m", "m/s"),
        np.vstack((np.concatenate((along, still)), np.concatenate((turning, along)))),
        np.array([float(nodes.gap[..., contact].min()), 0.0]),
        np.stack(lift, axis=1),
    )


def _columns(system: System, names: tuple[str, str]) -> tuple[int, int]:
    components = [*system.names, *(name + VELOCITY for name in system.names)]
    if len(names) != 2 or names[0] == names[1] or not set(names) <= set(components):
        mesh = f", or {' and '.join(MESH_PLANE)}" if system.contacts else ""
        what, why = f"coordinates = {names!r}", f"Two of {', '.join(components)}{mesh}"
        raise InputError(what, "argument coordinates", why, "Choose two different ones of these")
    return components.index(names[0]), components.index(names[1])


def _unit(name: str) -> str:
    angle = "theta" in name
    if name.endswith(VELOCITY):
        return "rad/s" if angle else "m/s"
    return "rad" if angle else "m"
