"""Oil film columns of the mesh table: films, their ratio to the roughness, pressure, stiffness."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.ehl import FILM_MODELS, film_load_share
from tribodyn.ehl.steady.batch import Films
from tribodyn.errors import Problem, TribodynError, collected, require_between, warn
from tribodyn.friction import LAWS, FrictionParts, TribologicalContact
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.columns import FILM_COLUMNS
from tribodyn.mesh.face_lines import slice_count
from tribodyn.mesh.table import MeshTable
from tribodyn.model import NO_OPTIONS
from tribodyn.types import Array, ByName, Mask

if TYPE_CHECKING:
    from tribodyn.ehl import RoughnessProfile, TransientLineContact
    from tribodyn.gear import Material
    from tribodyn.lubricant import Lubricant


def film_columns(
    film_model: str,
    contact: TribologicalContact,
    material: Material,
    lubricant: Lubricant,
    *,
    common_face_width: float = 1.0,
    film_options: ByName = NO_OPTIONS,
) -> dict[str, Array]:
    """Films of the loaded contacts, as far as the model gives them; each contact separately.

    Parameters
    ----------
    film_model : str
        Name in ``tribodyn.ehl.FILM_MODELS``.
    contact : TribologicalContact
        Loaded contacts.
    material, lubricant : Material, Lubricant
        Of both gears, and the oil at working temperature.
    common_face_width : float [m]
        Length of the contact line, for the film stiffness.
    film_options : mapping
        Options of the film model.

    Returns
    -------
    dict of str to array
        ``central_film`` and ``minimum_film`` [m], ``film_pressure`` [Pa] and ``film_stiffness``
        [N/m] where the model has them, and ``film_ratio``, the smallest film known over the
        composite roughness where there is one. Empty for the model ``none``.

    Raises
    ------
    InputError
        If the model or an option is unknown.
    ComputationError
        If a contact cannot be solved.

    Notes
    -----
    Range and source: those of the chosen model.

    Examples
    --------
    >>> one = np.ones(1)
    >>> contact = TribologicalContact(
    ...     1e5 * one, 8e8 * one, one, 2 * one, one / 2, 8e-3 * one, 0.08, 5e-7
    ... )
    >>> list(film_columns("moes", contact, Material(), Lubricant(0.08, 880.0, 2e-8)))
    ['central_film', 'film_ratio', 'film_stiffness']
    """
    films = FILM_MODELS[film_model].films(
        contact.load_per_width,
        contact.equivalent_radius,
        contact.entrainment_speed,
        lubricant,
        effective_modulus(material, material),
        length=common_face_width,
        sliding_speed=contact.sliding_speed,
        **film_options,
    )
    return as_columns(films, contact.composite_roughness)


def as_columns(films: Films, composite_roughness: float) -> dict[str, Array]:
    """Name the films as columns and add their ratio to the roughness."""
    columns = {name: getattr(films, name, None) for name in FILM_COLUMNS}
    thickness = smallest_film(films)
    if thickness is not None and composite_roughness > 0.0:
        columns["film_ratio"] = thickness / composite_roughness
    return {name: values for name, values in columns.items() if values is not None}


def friction_columns(friction: Array | FrictionParts, film_ratio: Array | None) -> dict[str, Array]:
    """Friction and its parts by the law, or with the load share by the film ratio."""
    if isinstance(friction, FrictionParts):
        return {
            "friction_coefficient": friction.coefficient,
            "asperity_friction_coefficient": friction.asperities,
            "film_load_share": friction.film_load_share,
        }
    columns = {"friction_coefficient": friction}
    if film_ratio is not None:
        finite = np.isfinite(film_ratio)
        share = film_load_share(np.where(finite, film_ratio, 0.0))
        columns["film_load_share"] = np.where(finite, share, np.nan)
    return columns


#: Load per width over the greatest of the mesh from which warnings of film formulas and friction
#: laws apply to a contact: pairs that do not touch have a token load.
JUDGED_LOAD = 0.25


def judged(load_per_width: Array) -> Mask:
    """Mask of the contacts with enough load for model warnings, row by row for rows of contacts."""
    return np.asarray(load_per_width >= JUDGED_LOAD * load_per_width.max(axis=-1, keepdims=True))


#: Part of the load outside of the range of a friction law from which there is a warning.
EXTRAPOLATED_LOAD = 0.2

Answer = TypeVar("Answer")


def warn_of_loaded(compute: Callable[[], Answer], again: Callable[[], object]) -> Answer:
    """Compute all contacts; if a model warns, warn of the judged ones, which ``again`` computes."""
    with collected() as warnings:
        answer = compute()
    if warnings:
        again()
    return answer


def friction_by_law(
    law: str, contact: TribologicalContact, options: ByName
) -> Array | FrictionParts:
    """Friction of every contact; warn where a real part of the load is outside of the law."""
    load = np.asarray(contact.load_per_width)
    judge = judged(load)

    def of_judged() -> None:
        columns = {each.name: getattr(contact, each.name) for each in fields(contact)}
        columns = {n: c for n, c in columns.items() if np.shape(c) == judge.shape}
        part = replace(contact, **{name: c[judge] for name, c in columns.items()})
        with collected() as warnings:
            LAWS[law].evaluate(part, options)
        for warning in warnings:
            if warning.affected is None:
                warn(warning.code, warning.message)
                continue
            outside = np.broadcast_to(warning.affected, np.shape(load[judge]))
            share = float(load[judge][outside].sum() / load.sum())
            if share >= EXTRAPOLATED_LOAD:
                limit = f"less than {EXTRAPOLATED_LOAD:.0%} is not reported"
                text = f"{warning.message} This concerns {share:.0%} of the load ({limit})."
                warn(warning.code, text, affected=share)

    return warn_of_loaded(lambda: LAWS[law].evaluate(contact, options), of_judged)


def smallest_film(films: Films) -> Array | None:
    """Smallest film of each contact: the minimum film, or else the central film."""
    thin = [film for film in (films.central_film, films.minimum_film) if film is not None]
    return np.asarray(np.min(thin, axis=0)) if thin else None


#: Name of a failed contact in an error of the batch.
_CONTACT = re.compile(r"contact \[([\d, ]+)\]")


@contextmanager
def film_places(describe: Callable[..., str]) -> Iterator[None]:
    """Replace the index of a contact in an error by its location."""

    def named(problem: Problem) -> Problem:
        def place(match: re.Match[str]) -> str:
            return f"contact {describe(*(int(part) for part in match.group(1).split(',')))}"

        return replace(problem, what=_CONTACT.sub(place, problem.what))

    try:
        yield
    except TribodynError as error:
        raise type(error)([named(problem) for problem in error.problems]) from error


#: Time steps of an engagement: fewer leave the change of the load unresolved.
_LEAST, _MOST = 50, 20000
_NO_ROUGHNESS = (None, None)
#: Load at entry and exit over which a film has at least this part everywhere.
_LEAST_LOAD = 0.1


def moving_film(
    mesh: MeshTable,
    lubricant: Lubricant,
    material: Material,
    *,
    steps: int = 400,
    ramp: float = 0.05,
    least_share: float = 0.02,
    roughness: tuple[RoughnessProfile | None, RoughnessProfile | None] = _NO_ROUGHNESS,
    face_position: float = 0.0,
    **options: Any,
) -> TransientLineContact:
    """Follow the film of one tooth pair through the mesh, with the squeeze of the oil.

    Where contacts are slices of lines of contact, as of helical gears, the film is that of one
    flank line through the mesh, in the transverse plane at a place on the face.

    Parameters
    ----------
    mesh : MeshTable
        Loads, radii and speeds of the pair over the mesh cycle.
    lubricant, material : Lubricant, Material
        Oil at working temperature, and material of both gears.
    steps : int
        Time steps from entry to exit; where the number of pairs changes, one of them spreads the
        jump of the load.
    ramp : float [mesh cycles]
        Time in which the load comes up after the entry, and goes down before the exit.
    least_share : float
        Part of the load at the very entry and exit: a film needs some.
    roughness : two of RoughnessProfile or None
        Heights of both flanks, carried along at their speeds.
    face_position : float [m]
        Of the flank line, from the middle of the face; the nearest slice is followed. Whole pairs
        are the same everywhere.
    **options : Any
        Further options of :func:`tribodyn.ehl.solve_transient_line_contact`, such as ``nodes``,
        ``keep_every`` and ``thermal``.

    Returns
    -------
    TransientLineContact
        Time counts from the entry of the pair, or of its slice.

    Raises
    ------
    InputError
        If an option is out of range.
    ComputationError
        If an instant does not converge; the message names it.

    Notes
    -----
    Between the knots of the table the load is interpolated linearly. Source: Reynolds equation;
    see :func:`tribodyn.ehl.solve_transient_line_contact`.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> mesh = tribodyn.run(case).mesh  # doctest: +SKIP
    >>> moving_film(mesh, case.lubricant_properties, case.material_properties)  # doctest: +SKIP
    """
    from tribodyn.ehl import solve_transient_line_contact

    require_between("steps", steps, _LEAST, _MOST)
    require_between("ramp", ramp, 1e-3, 0.5, "mesh cycles")
    require_between("least_share", least_share, 1e-3, 1.0)
    names = ("load_per_width", "equivalent_radius", "entrainment_speed", "sliding_speed")
    half = 0.5 * mesh.common_face_width
    require_between("face_position", face_position, -half, half, "m")
    age, columns = _life(mesh, names, face_position)
    cycles = np.linspace(0.0, age[-1], steps + 1)
    load, radius, speed, sliding = (np.interp(cycles, age, values) for values in columns)
    # Relief and crowning leave parts of a flank line without load, where a film needs some.
    least = _LEAST_LOAD * least_share * load.max()
    surfaces = (speed + 0.5 * sliding, speed - 0.5 * sliding)
    return solve_transient_line_contact(
        cycles / mesh.mesh_frequency,
        np.maximum(load * _share(cycles, ramp, least_share), least),
        radius,
        speed,
        lubricant,
        effective_modulus(material, material),
        roughness=roughness,
        surface_speeds=surfaces,
        **options,
    )


def _life(
    mesh: MeshTable, names: tuple[str, ...], face_position: float
) -> tuple[Array, list[Array]]:
    """Columns in the order in which a pair passes them at a place on the face, over mesh cycles."""
    slices = slice_count(mesh)
    face = np.zeros(1) if mesh.face_position is None else mesh.face_position[:slices]
    chosen = slice(int(np.argmin(np.abs(face - face_position))), None, slices)
    alive = mesh.in_contact[:, chosen].T
    age = (mesh.phase[None, :] + np.arange(alive.shape[0])[:, None])[alive]
    return age - age[0], [getattr(mesh, name)[:, chosen].T[alive] for name in names]


def _share(cycles: Array, ramp: float, least: float) -> Array:
    """Factor of the load: up from ``least`` after the entry, down to it before the exit."""
    inside = np.clip(np.minimum(cycles, cycles[-1] - cycles) / ramp, 0.0, 1.0)
    return np.asarray(least + (1.0 - least) * inside**2 * (3.0 - 2.0 * inside))
