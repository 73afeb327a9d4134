"""From a gear pair and the name of a model to the problem of its loaded tooth contact."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear import Material, SpurPair
from tribodyn.stiffness.loaded.gaps import slice_gaps, slice_widths
from tribodyn.stiffness.loaded.local import local_coefficients
from tribodyn.stiffness.loaded.places import (
    ContactPlaces,
    contact_places,
    extended_places,
    on_path_places,
)
from tribodyn.stiffness.loaded.problem import ContactProblem
from tribodyn.stiffness.loaded.structure import (
    Compliance,
    coupled_compliance,
    independent_compliance,
)
from tribodyn.stiffness.model import MODELS, StiffnessModel, usable_stiffness
from tribodyn.types import Array, Mask

NO_OPTIONS: Mapping[str, Any] = MappingProxyType({})


def compliance_of(
    pair: SpurPair,
    material: Material,
    places: ContactPlaces,
    total_force: float,
    model: StiffnessModel,
    options: Mapping[str, Any] = NO_OPTIONS,
) -> Compliance:
    """Compliance of the teeth at given places by a named model."""
    if model.influence is not None:
        reference = {**model.options, **options}["reference"]
        pinion, wheel = (
            model.influence(gear, material, reference=reference)
            for gear in (pair.pinion, pair.wheel)
        )
        structure = coupled_compliance(pinion, wheel, places)
        return Compliance(structure, *local_coefficients(pair, material, places))
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
    options: Mapping[str, Any] = NO_OPTIONS,
    slices: int | None = None,
) -> ContactProblem:
    """Prepare the loaded tooth contact at given mesh phases.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position, with their deviations.
    provider : str
        Name in ``tribodyn.stiffness.MODELS``.
    phase : array (p,)
        Mesh phases; the whole part counts mesh cycles, where teeth differ.
    total_force : float [N]
        Normal force of all pairs.
    extended_contact : bool
        Let tip corners touch outside of the path of contact.
    material : Material
        Material of both gears.
    options : mapping
        Options of the provider.
    slices : int, optional
        Slices of the face width; by default one, or 21 where flanks vary over the width.

    Returns
    -------
    ContactProblem

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
    model = MODELS[provider]
    extended = extended_contact and model.influence is not None
    places = contact_places(pair, phase, extended=extended)
    compliance = compliance_of(pair, material, places, total_force, model, options)
    widths = slice_widths(pair, slices)
    return ContactProblem(places, compliance, slice_gaps(places, widths.size), widths)


def mesh_problem(
    pair: SpurPair,
    *,
    provider: str,
    places: tuple[Array, Array, Mask],
    total_force: float,
    extended_contact: bool,
    material: Material,
    options: Mapping[str, Any] = NO_OPTIONS,
) -> ContactProblem:
    """Prepare the loaded tooth contact on the knots of a mesh table, one-sided at its events.

    A mesh table repeats with every mesh cycle, so what differs from tooth to tooth is left out.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position, with their deviations.
    provider : str
        Name in ``tribodyn.stiffness.MODELS``.
    places : tuple
        Phase (p,), path (p, n) [m] and whether each pair is between A and E (p, n).
    total_force : float [N]
        Normal force of all pairs.
    extended_contact : bool
        Let tip corners touch outside of the path of contact; then there are two pairs more.
    material : Material
        Material of both gears.
    options : mapping
        Options of the provider.

    Returns
    -------
    ContactProblem

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
    ...     extended_contact=False, material=Material(), options={"reference": "rim"}).gaps.shape
    (2, 1, 2)
    """
    model, contact = MODELS[provider], path_of_contact(pair)
    phase, path, touching = places
    if extended_contact and model.influence is not None:
        where = extended_places(contact, phase, path)
    else:
        where = on_path_places(contact, phase, path, touching)
    compliance = compliance_of(pair, material, where, total_force, model, options)
    widths = slice_widths(pair, None)
    gaps = slice_gaps(where, widths.size, teeth_alike=True)
    return ContactProblem(where, compliance, gaps, widths)


def phases_of(phases: int | Array, mesh_cycles: int) -> Array:
    """Mesh phases over all cycles, from a number for each cycle or as they are given."""
    if not isinstance(phases, int | np.integer):
        return np.atleast_1d(np.asarray(phases, dtype=float))
    if phases < 8:
        raise InputError(
            Problem(
                what=f"phases = {phases}",
                where=Argument("phases"),
                why="A mesh cycle needs at least 8 phases",
                remedy="Give for example phases=64",
            )
        )
    return np.arange(int(phases) * mesh_cycles) / int(phases)
