"""Many line contacts at once, in threads."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, wait
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.ehl.film_stiffness import FilmSlopes, film_distance, film_slopes
from tribodyn.ehl.solver.contact_case import si_case
from tribodyn.ehl.steady.line_contact import STATED_LIMIT, SolverOptions, solve_case
from tribodyn.ehl.steady.solution import LineContactSolution
from tribodyn.ehl.thermal.thermal_model import ThermalModel
from tribodyn.errors import (
    Argument,
    InputError,
    Problem,
    TribodynError,
    quiet,
    real_numbers,
    require_one_of,
    require_positive,
    warn,
)
from tribodyn.interrupt import Threads, begins_thread, processors
from tribodyn.lubricant import Lubricant
from tribodyn.nomenclature import require_number
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array

#: Contacts handed to the threads ahead of the one that is collected.
_AHEAD = 64

Value = TypeVar("Value")


@dataclass(frozen=True, eq=False)
class LineContactBatch:
    """Films of many line contacts: arrays of the common shape of the arguments.

    Parameters
    ----------
    central_film, minimum_film : array [m]
        Film at position zero, and least film.
    film_stiffness : array [N/m]
        Stiffness of the film over the given length; empty if no length was given.
    hertz_pressure : array [Pa]
        Maximum pressure of the dry contact.
    half_width : array [m]
        Half width of the dry contact.
    outlet : array [m]
        Position where the oil film parts.
    flux_error : array [-]
        Greatest relative deviation of the mass flux from its mean.
    central_film_error : array [m]
        Estimate of the error of ``central_film`` by the grid.
    solutions : array of LineContactSolution
        The solutions; empty unless requested.
    """

    central_film: Array
    minimum_film: Array
    film_stiffness: Array
    hertz_pressure: Array
    half_width: Array
    outlet: Array
    flux_error: Array
    central_film_error: Array
    solutions: NDArray[Any] = field(repr=False)

    def __repr__(self) -> str:
        """One line."""
        low, high = np.min(self.central_film), np.max(self.central_film)
        return (
            f"LineContactBatch({self.central_film.size} contacts, central film {low * 1e6:.4g} "
            f"to {high * 1e6:.4g} um)"
        )


def solve_line_contacts(
    load_per_width: ArrayLike,
    equivalent_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    lubricant: Lubricant,
    effective_modulus: float,
    *,
    nodes: str | int = 513,
    method: str = "newton",
    domain: str | tuple[float, float] = "auto",
    inlet: str = "flooded",
    viscosity_law: str = "roelands",
    compressible: bool = True,
    tolerance: float = 1e-4,
    flux_tolerance: float = 3e-4,
    film_tolerance: float = 5e-4,
    stiffness: bool | str = True,
    length: float = 1.0,
    keep_solutions: bool = False,
    threads: int | None = None,
    thermal: bool | ThermalModel = False,
    sliding_speed: ArrayLike = 0.0,
    progress: Progress = SILENT,
) -> LineContactBatch:
    """Films of many line contacts with one oil; see :func:`solve_line_contact`.

    Parameters
    ----------
    load_per_width, equivalent_radius, entrainment_speed : float or array [N/m], [m], [m/s]
        Loads, radii and speeds that broadcast.
    lubricant, effective_modulus : Lubricant, float [Pa]
        Oil and modulus of all contacts.
    nodes, method, domain, inlet, viscosity_law, compressible
        As for :func:`solve_line_contact`; the domain in half widths of each contact [-].
    tolerance, flux_tolerance, film_tolerance
        As there.
    stiffness : bool or {"approach", "tangent"}
        Film stiffness to compute, by one linear solve a contact: of the approach of the bodies, or
        of the central film, which ``True`` means too.
    length : float [m]
        Length of the contact line, for the stiffness.
    keep_solutions : bool
        Whether to keep pressure and film of every contact.
    threads : int, optional
        Contacts solved at a time; the number of processors by default.
    thermal, sliding_speed : bool or ThermalModel, float or array [m/s]
        Heat of the film, as for :func:`solve_line_contact`; the speeds broadcast too.
    progress : Progress
        Receives the progress over the contacts.

    Raises
    ------
    InputError
        If an argument is out of range; the message names the index of the contact.
    ComputationError
        If a contact is not solved; the message names its index.

    Valid as :func:`solve_line_contact`. Source: see there.

    Examples
    --------
    >>> from tribodyn.lubricant import Lubricant
    >>> oil = Lubricant(0.082, 880.0, 2.19e-8)
    >>> films = solve_line_contacts([49267.5, 147802.0], 8e-3, 3.0722, oil, 2.2e11, nodes=257)
    >>> (films.central_film * 1e6).round(2)
    array([1.14, 1.02])
    """
    options = SolverOptions.among(locals())
    require_number("length", length)
    if not isinstance(stiffness, (bool, np.bool_)):
        require_one_of("stiffness", stiffness, ("approach", "tangent"))
    require_positive("length", length, "m")
    contacts = load_per_width, equivalent_radius, entrainment_speed
    shape, columns = _broadcast(*contacts, sliding_speed)

    def solve(index: int) -> tuple[list[float], LineContactSolution | None]:
        load, radius, speed, sliding = (float(column[index]) for column in columns)
        try:
            case = si_case(
                load, radius, speed, lubricant, effective_modulus, viscosity_law, compressible
            )
            solution = solve_case(case, replace(options, sliding_speed=sliding))
            row = _row(solution, stiffness)
        except TribodynError as error:
            raise type(error)(
                [_at(problem, index, shape, columns) for problem in error.problems]
            ) from error
        return row, solution if keep_solutions else None

    size = columns[0].size
    table, solutions = np.empty((8, size)), np.empty(size, dtype=object)
    progress.start("Oil films", size)
    for index, (row, solution) in enumerate(_in_order(solve, size, threads)):
        table[:, index], solutions[index] = row, solution
        progress.advance()
    progress.finish()
    warn_coarse(table[7].reshape(shape) / table[0].reshape(shape), options.nodes)
    table[2] = -length * columns[0] / table[2]
    if stiffness:
        _warn_negative(table[2], shape)
    return _gather(table, solutions if keep_solutions else solutions[:0], shape, bool(stiffness))


def _gather(
    table: Array, solutions: NDArray[Any], shape: tuple[int, ...], stiffness: bool
) -> LineContactBatch:
    """Collect results: a column of the table for each field."""
    fields = [column.reshape(shape) for column in table]
    if not stiffness:
        fields[2] = np.empty(0)
    return LineContactBatch(*[*fields, solutions.reshape(shape) if solutions.size else solutions])


def _broadcast(*arguments: ArrayLike) -> tuple[tuple[int, ...], list[Array]]:
    try:
        names = ("load_per_width", "equivalent_radius", "entrainment_speed", "sliding_speed")
        arrays = np.broadcast_arrays(*map(real_numbers, map(Argument, names), arguments))
    except InputError:
        raise
    except ValueError as error:
        shapes = ", ".join(str(np.shape(item)) for item in arguments)
        raise InputError(
            f"the shapes {shapes} of load, radius and speeds do not fit",
            where="arguments load_per_width, equivalent_radius, entrainment_speed, sliding_speed",
            why="they must be numbers, or arrays that broadcast",
            remedy="Give numbers, or arrays of one shape",
        ) from error
    return arrays[0].shape, [np.ascontiguousarray(array).reshape(-1) for array in arrays]


def _row(solution: LineContactSolution, stiffness: bool | str) -> list[float]:
    slopes = film_slopes(solution) if stiffness else FilmSlopes(1.0, 1.0)
    return [
        solution.central_film,
        solution.minimum_film,
        slopes.distance if stiffness == "approach" else slopes.central,
        solution.hertz_pressure,
        solution.half_width,
        solution.outlet,
        solution.flux_error,
        solution.central_film_error,
    ]


def warn_coarse(error: Array, nodes: str | int) -> None:
    """One warning for all contacts whose stated nodes are too few, by the error of their film."""
    if isinstance(nodes, str) or not np.any(error > STATED_LIMIT):
        return
    worst = np.unravel_index(np.argmax(error), error.shape)
    place = ", ".join(str(part) for part in worst) or "0"
    warn(
        "film-resolution",
        f"With nodes = {nodes} the central film of {np.sum(error > STATED_LIMIT)} of "
        f"{error.size} contacts has an estimated error above {STATED_LIMIT:g} of it; the worst is "
        f'contact [{place}] with {error[worst]:.2g}. Use nodes = "auto" or more nodes',
        stacklevel=4,
    )


def _warn_negative(stiffness: Array, shape: tuple[int, ...]) -> None:
    """One warning for all contacts whose central film rises with the load."""
    rising = np.flatnonzero(stiffness <= 0.0)
    if rising.size:
        place = ", ".join(str(part) for part in np.unravel_index(rising[0], shape)) or "0"
        warn(
            "film-stiffness",
            f"The central film of {rising.size} of {stiffness.size} contacts, the first of them "
            f"[{place}], rises with the load, so that its tangent stiffness is negative: the "
            "load is so light that the outlet comes near the centre, or the inlet is starved",
            stacklevel=4,
        )


def _at(problem: Problem, index: int, shape: tuple[int, ...], columns: list[Array]) -> Problem:
    """Problem with the index of its contact."""
    place = ", ".join(str(part) for part in np.unravel_index(index, shape)) if shape else "0"
    load, radius, speed = (column[index] for column in columns[:3])
    return Problem(
        what=f"contact [{place}] with {load:.6g} N/m, {radius:.6g} m, {speed:.6g} m/s: "
        f"{problem.what}",
        where=problem.where,
        why=problem.why,
        remedy=problem.remedy,
    )


def _in_order(work: Callable[[int], Value], size: int, threads: int | None) -> Iterator[Value]:
    """Results in order as they come; an interrupt or an error leaves no work behind."""
    count = min(threads or processors(), size)
    if count < 1 or (count == 1 and not begins_thread()):
        yield from map(work, range(size))
        return
    # One thread for all of them, where it is one, and not one for each.
    with Threads(count) as pool:
        waiting: deque[Future[Value]] = deque()
        for index in range(size + _AHEAD):
            if index < size:
                waiting.append(pool.submit(work, index))
            if index >= _AHEAD and waiting:
                future = waiting.popleft()
                while not future.done():
                    # A wait with an end lets Ctrl-C through on every system.
                    wait([future], timeout=0.2)
                    pool.refuse_interrupted()
                yield future.result()


@dataclass(frozen=True, eq=False)
class Films:
    """Oil films of loaded contacts: arrays of one shape, ``None`` where a model has none."""

    central_film: Array | None  #: [m]
    minimum_film: Array | None  #: [m]
    film_pressure: Array | None  #: greatest pressure in the film [Pa]
    film_stiffness: Array | None  #: stiffness of the film over the length of the contact line [N/m]
    #: distance of the bodies beyond that of Hertz's dry contact [m]
    film_distance: Array | None = None
    solutions: tuple[Any, ...] = field(default=(), repr=False)


def solved_films(*contacts: Any, length: ArrayLike, stiffness: str, **solver: Any) -> Films:
    """Solve many contacts in threads, with arguments of :func:`solve_line_contacts`."""
    sums = stiffness in ("secant", "seed")
    with quiet("film-stiffness"):
        # Whoever uses the stiffness says what a negative one means for it.
        kind = False if sums else "tangent" if stiffness == "tangent" else "approach"
        batch = solve_line_contacts(*contacts, stiffness=kind, keep_solutions=True, **solver)
    solutions = tuple(np.ravel(batch.solutions))
    pressures = np.array([solution.pressure.max() for solution in solutions])
    if sums:
        film_stiffness = _sums(solutions, length, stiffness).reshape(batch.central_film.shape)
    else:
        film_stiffness = np.asarray(length) * batch.film_stiffness
    if stiffness == "seed":
        warn(
            "seed-film-stiffness",
            "the film stiffness is the sum as one source prints it: a length, which doubles when "
            f"the {solver['nodes']} nodes are doubled. It is shown, and is no spring. "
            'Use film.stiffness = "approach", or "secant" for a consistent sum',
            stacklevel=4,
        )
    return Films(
        central_film=batch.central_film,
        minimum_film=batch.minimum_film,
        film_pressure=pressures.reshape(batch.central_film.shape),
        film_stiffness=film_stiffness,
        film_distance=np.array([film_distance(s) for s in solutions]).reshape(pressures.shape),
        solutions=solutions,
    )


def _sums(solutions: tuple[Any, ...], length: ArrayLike, kind: str) -> Array:
    """Secant or printed sum of every solution; what the latter has to say is said once."""
    lengths = np.broadcast_to(np.ravel(length), len(solutions))
    with quiet("seed-film-stiffness"):
        each = [
            s.film_stiffness(each, kind=kind)
            for s, each in zip(solutions, lengths.tolist(), strict=True)
        ]
    return np.array(each)
