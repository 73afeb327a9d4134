"""Loaded tooth contact analysis: load sharing and deflection of the mesh."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import FaceContacts, face_contacts, path_of_contact
from tribodyn.contact.face_contacts import SLICES, checked_slices, face_positions
from tribodyn.errors import (
    Argument,
    InputError,
    collected,
    require_positive,
)
from tribodyn.gear import Material, SpurPair
from tribodyn.model import NO_OPTIONS
from tribodyn.stiffness.loaded.face_problem import gear_influences, has_slices, sliced_problem
from tribodyn.stiffness.loaded.problem import (
    Compliance,
    ContactPlaces,
    ContactProblem,
    Equilibrium,
    contact_places,
    coupled_compliance,
    extended_places,
    independent_compliance,
    local_coefficients,
    mesh_period,
    on_path_places,
    slice_gaps,
    slice_widths,
)
from tribodyn.stiffness.loaded.result import LoadedContact
from tribodyn.stiffness.model import MODELS, StiffnessModel, usable_stiffness
from tribodyn.types import Array, ByName, Mask


def compliance_of(
    pair: SpurPair,
    material: Material,
    places: ContactPlaces,
    total_force: float,
    model: StiffnessModel,
    options: ByName = NO_OPTIONS,
) -> Compliance:
    """Compliance of the teeth at given places by a named model."""
    if model.influence is not None:
        structure = coupled_compliance(*gear_influences(pair, material, model, options), places)
        return Compliance(structure, *local_coefficients(material, places))
    stiffness = model(
        pair, material, places.path, places.on_path, places.phase, total_force, **options
    )
    checked = usable_stiffness(stiffness, places.on_path, model.name)
    structure = independent_compliance(checked, pair.common_face_width)
    return Compliance(structure, np.zeros(places.path.shape), 0.0)


def contact_problem(
    pair: SpurPair,
    *,
    provider: str = "fe2d",
    phase: Array,
    total_force: float,
    extended_contact: bool = True,
    material: Material,
    options: ByName = NO_OPTIONS,
    slices: int | None = None,
) -> ContactProblem:
    """Prepare the loaded tooth contact at given mesh phases.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position, with their deviations.
    provider : str
        As ``extended_contact``, ``material``, ``options`` and ``slices`` for
        :func:`loaded_contact`.
    phase : array (p,)
        Mesh phases; the whole part counts mesh cycles, where teeth differ.
    total_force : float [N]
        Normal force of all pairs.
    extended_contact, material, options, slices
        As there.

    Raises
    ------
    InputError
        If the provider is unknown or something is out of range.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> problem = contact_problem(pair, provider="analytic", phase=np.array([0.0, 0.5]),
    ...     total_force=2000.0, material=Material(), options={"reference": "rim"})
    >>> problem.gaps.shape
    (2, 1, 4)
    """
    model, contact = MODELS[provider], path_of_contact(pair)
    if has_slices(pair, model):
        contacts = face_contacts(contact, phase, checked_slices(slices, SLICES))
        parts = pair, material, contacts, total_force, model, options
        return sliced_problem(*parts)
    extended = extended_contact and model.influence is not None
    places = contact_places(contact, phase, extended=extended)
    compliance = compliance_of(pair, material, places, total_force, model, options)
    widths = slice_widths(contact, slices)
    gaps = slice_gaps(places, face_positions(contact, widths.size)[:, None])
    return ContactProblem(places, compliance, gaps, widths[None, :, None])


def mesh_problem(
    pair: SpurPair,
    *,
    provider: str,
    places: tuple[Array, Array, Mask] | FaceContacts,
    total_force: float,
    extended_contact: bool,
    material: Material,
    options: ByName = NO_OPTIONS,
) -> ContactProblem:
    """Prepare the loaded tooth contact on the knots of a mesh table, one-sided at its events.

    A mesh table repeats with every mesh cycle, so what differs from tooth to tooth is left out.

    Parameters
    ----------
    pair, provider
        As for :func:`contact_problem`.
    places : tuple or FaceContacts
        Phase (p,), path (p, n) [m] and whether each pair is between A and E (p, n); or slices of
        the lines of contact.
    total_force : float [N]
        Normal force of all pairs.
    extended_contact : bool
        Let tip corners touch outside of the path of contact; then there are two pairs more.
    material, options
        As for :func:`contact_problem`.

    Raises
    ------
    InputError
        As :func:`contact_problem`.

    Examples
    --------
    >>> from tribodyn.contact import path_of_contact
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> phase = np.array([0.0, 1.0])
    >>> places = phase, *path_of_contact(pair).pair_paths(phase)
    >>> mesh_problem(pair, provider="analytic", places=places, total_force=2000.0,
    ...     extended_contact=False, material=Material(),
    ...     options={"reference": "rim"}).gaps.shape
    (2, 1, 2)
    """
    model, contact = MODELS[provider], path_of_contact(pair)
    if isinstance(places, FaceContacts):
        parts = pair, material, places, total_force, model, options
        return sliced_problem(*parts, teeth_alike=True)
    phase, path, touching = places
    if extended_contact and model.influence is not None:
        where = extended_places(contact, phase, path)
    else:
        where = on_path_places(contact, phase, path, touching)
    compliance = compliance_of(pair, material, where, total_force, model, options)
    widths = slice_widths(contact, None)
    gaps = slice_gaps(where, face_positions(contact, widths.size)[:, None], teeth_alike=True)
    return ContactProblem(where, compliance, gaps, widths[None, :, None])


def contact_settings(
    provider: str,
    phase: Array,
    extended_contact: bool,
    reference: str | None,
    material: Material | None,
    slices: int | None,
    options: ByName,
) -> dict[str, Any]:
    """Arguments of :func:`contact_problem` but for the pair and its load."""
    takes_reference = reference is not None and "reference" in MODELS[provider].options
    return {
        "provider": provider,
        "phase": phase,
        "extended_contact": extended_contact,
        "material": material or Material(),
        "options": {**options, "reference": reference} if takes_reference else dict(options),
        "slices": slices,
    }


def phases_of(phases: int | Array, mesh_cycles: int) -> Array:
    """Mesh phases over all cycles, from a number for each cycle or as they are given."""
    if not isinstance(phases, int | np.integer):
        return np.atleast_1d(np.asarray(phases, dtype=float))
    if phases < 8:
        what, why = f"phases = {phases}", "A mesh cycle needs at least 8 phases"
        raise InputError(what, Argument("phases"), why, "Give for example phases=64")
    return np.arange(int(phases) * mesh_cycles) / int(phases)


def loaded_contact(
    pair: SpurPair,
    torque: ArrayLike,
    *,
    provider: str = "fe2d",
    phases: int | Array = 64,
    extended_contact: bool = True,
    reference: str | None = None,
    material: Material | None = None,
    film_stiffness: ArrayLike | None = None,
    slices: int | None = None,
    options: ByName = NO_OPTIONS,
) -> LoadedContact:
    """Find load sharing, transmission error and stiffness of a mesh under a torque.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position, with modifications and deviations of their flanks.
    torque : float or array (t,) [N*m]
        Torque on the pinion, positive.
    provider : str
        Where the tooth compliances come from: ``"fe2d"``, ``"analytic"``, or a model of the
        literature, whose pairs do not act on each other.
    phases : int or array
        Number of evenly spaced phases of a mesh cycle, or the phases.
    extended_contact : bool
        Let tip corners touch before A and after E, where deflected teeth meet early and part
        late. Models that know stiffness over the path of contact alone ignore it.
    reference : str, optional
        ``"bore"`` or ``"rim"``: where the gear bodies are held; by default that of the provider.
    material : Material, optional
        Material of both gears; steel by default.
    film_stiffness : float or array (p, n) [N/m], optional
        Stiffness of an oil film in series with each pair, of all pairs that may touch.
    slices : int, optional
        Slices of the face width; by default one, or 21 where flanks vary over the width.
    options : mapping
        Further options of the provider.

    Raises
    ------
    InputError
        If a value is out of range, the provider unknown, or a gear held at a bore that it lacks.
    ComputationError
        If the load is beyond what the formula of the local compression covers.

    Notes
    -----
    ``delta = C F + local(F) + gap``, ``F >= 0``, ``sum F = T / r_b`` at every phase, with the
    local compression of Weber and Banaschek growing less than the load. Slices of the face width
    are independent: they share only the approach, unless the provider knows the face width. Lines
    of contact of helical pairs are always cut into slices; those touch between A and E alone.
    Without friction. Source:
    Conry and Seireg (1973), J. Eng. Ind. 95, 1115-1122, for the complementarity problem.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02,
    ...     pinion_bore_diameter=0.03, wheel_bore_diameter=0.03)
    >>> mesh = loaded_contact(pair, 100.0, provider="potential-energy")
    >>> round(float(mesh.load_share.sum(axis=-1).min()), 9)
    1.0
    """
    torques = np.asarray(torque, dtype=float)
    require_positive("torque", torques, "N*m")
    phase = phases_of(phases, mesh_period(path_of_contact(pair)))
    settings = contact_settings(
        provider, phase, extended_contact, reference, material, slices, options
    )
    totals = np.atleast_1d(torques) / pair.pinion.base_radius
    problem, equilibrium = _solved(pair, totals, film_stiffness, settings)
    shape = torques.shape
    places = problem.places
    load = equilibrium.load.reshape(*shape, *equilibrium.load.shape[1:])
    measured_from = {**MODELS[provider].options, **settings["options"]}.get(
        "reference", "as measured"
    )
    force, gap = problem.forces(load), problem.gaps.min(axis=1)
    face_load = problem.face_load(load)
    number, middle = places.number, slice(None)
    if places.is_sliced:
        # Columns of whole pairs: those of the slices together, or of the one in the middle.
        number = np.unique(places.number)
        count = places.number.size // number.size
        middle = slice(count // 2, None, count)
        load = np.moveaxis(load.reshape(*load.shape[:-2], number.size, count), -1, -2)
        force = force.reshape(*force.shape[:-1], number.size, count).sum(axis=-1)
        gap = gap.reshape(-1, number.size, count).min(axis=2)
    return LoadedContact(
        gear_pair=pair,
        provider=provider,
        reference="rim" if provider == "iso6336" else measured_from,
        torque=torques,
        phase=places.phase,
        number=number,
        path=places.path[:, middle],
        pinion_curvature_radius=places.pinion_curvature_radius[:, middle],
        wheel_curvature_radius=places.wheel_curvature_radius[:, middle],
        gap=gap,
        transmission_error=equilibrium.approach.reshape(*shape, places.phase.size),
        normal_force=force,
        load_per_width=load,
        face_load=face_load,
        mesh_stiffness_tangent=equilibrium.tangent.reshape(*shape, places.phase.size),
    )


def _solved(
    pair: SpurPair, totals: Array, film_stiffness: ArrayLike | None, settings: dict[str, Any]
) -> tuple[ContactProblem, Equilibrium]:
    """One problem for all loads, or one for each where the stiffness itself depends on the load."""
    if film_stiffness is not None and not np.all(np.asarray(film_stiffness, float) > 0.0):
        what, why = "a film stiffness is not positive", "Films in series with the teeth carry load"
        raise InputError(what, Argument("film_stiffness"), why, "Give positive numbers in N/m")

    def solve(forces: Array) -> tuple[ContactProblem, Equilibrium]:
        problem = contact_problem(pair, total_force=float(forces[0]), **settings)
        if film_stiffness is not None:
            shape = problem.compliance.local.shape
            problem = problem.with_film(np.broadcast_to(np.asarray(film_stiffness, float), shape))
        order = np.argsort(forces)
        equilibrium = problem.at_loads(forces[order])
        back = np.argsort(order)
        return problem, Equilibrium(*(column[back] for column in equilibrium))

    if MODELS[settings["provider"]].influence is not None or totals.size == 1:
        return solve(totals)
    each = [solve(totals[k : k + 1]) for k in range(totals.size)]
    return each[0][0], Equilibrium(
        *(
            np.concatenate(parts)
            for parts in zip(*(equilibrium for _, equilibrium in each), strict=True)
        )
    )


#: Phases of a mesh cycle over which the share of the gear bodies is averaged.
_PHASES = 32
#: What makes the teeth of a gear differ from each other, left out.
_EVEN: dict[str, Any] = {
    "run_out": 0.0,
    "single_pitch_deviation": (),
    "cumulative_pitch_deviation": (),
}


def body_share(pair: SpurPair, torque: float, *, options: ByName, **settings: Any) -> float:
    """Part of the mean deflection under a torque that lies between the rim and the bore."""
    key = (pair, torque, tuple(settings.items()), tuple(sorted(options.items())))
    try:
        hash(key)
    except TypeError:  # an option is an array
        return _cached_share.__wrapped__(*key, MODELS.version)
    return _cached_share(*key, MODELS.version)


@lru_cache(maxsize=8)
def _even(pair: SpurPair) -> SpurPair:
    with collected():
        pinion, wheel = (
            replace(gear, modification=replace(gear.modification, **_EVEN))
            for gear in (pair.pinion, pair.wheel)
        )
        return replace(pair, pinion=pinion, wheel=wheel)


@lru_cache(maxsize=256)
def _cached_share(
    pair: SpurPair, torque: float, settings: Any, options: Any, _version: int
) -> float:
    even = _even(pair)

    def deflection(reference: str) -> float:
        arguments = {**dict(settings), "options": {**dict(options), "reference": reference}}
        return float(loaded_contact(even, torque, phases=_PHASES, **arguments).deflection.mean())

    with collected():
        return 1.0 - deflection("rim") / deflection("bore")
