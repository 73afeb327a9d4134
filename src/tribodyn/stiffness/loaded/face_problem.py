"""Structure of both gears of a pair by a stiffness model, the same for all loads."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from tribodyn.contact import FaceContacts
from tribodyn.errors import ModelWarning, collected, warn
from tribodyn.gear import Material, SpurGear, SpurPair
from tribodyn.stiffness.loaded.problem import (
    FAR,
    Compliance,
    ContactPlaces,
    ContactProblem,
    coupled_compliance,
    independent_compliance,
    local_coefficients,
    slice_gaps,
)
from tribodyn.stiffness.model import StiffnessModel, usable_stiffness
from tribodyn.stiffness.teeth.face_influence import FaceInfluence
from tribodyn.stiffness.teeth.influence import GearInfluence
from tribodyn.types import Array, ByName


def gear_influences(
    pair: SpurPair, material: Material, model: StiffnessModel, options: ByName
) -> tuple[Any, Any]:
    """Structure of pinion and wheel by a model that knows it, the same under every load."""
    model.require_known_teeth(pair)
    reference = {**model.options, **options}["reference"]
    gears = pair.gears.values()
    pinion, wheel = (_influence(model.influence, gear, material, reference) for gear in gears)
    return pinion, wheel


def _influence(*arguments: Any) -> Any:
    influence, model_warnings = _cached_influence(*arguments)
    for warning in model_warnings:
        warn(warning.code, warning.message, stacklevel=4)
    return influence


@lru_cache(maxsize=8)
def _cached_influence(
    model: Callable[..., Any], gear: SpurGear, material: Material, reference: str
) -> tuple[Any, list[ModelWarning]]:
    with collected() as model_warnings:
        return model(gear, material, reference=reference), model_warnings


def has_slices(pair: SpurPair, model: StiffnessModel) -> bool:
    """Whether a pair is solved by slices of its lines of contact."""
    return model.over_face or pair.base_helix_angle != 0.0


def sliced_problem(
    pair: SpurPair,
    material: Material,
    contacts: FaceContacts,
    total_force: float,
    model: StiffnessModel,
    options: ByName,
    *,
    teeth_alike: bool = False,
) -> ContactProblem:
    """Loaded tooth contact of all slices between A and E, without tip corners beyond the path."""
    places = face_places(contacts)
    parts = face_compliance(pair, material, contacts, places, total_force, model, options)
    gaps = slice_gaps(places, contacts.face_position[None], teeth_alike=teeth_alike)
    return ContactProblem(places, parts, gaps, contacts.width[:, None])


def face_places(contacts: FaceContacts) -> ContactPlaces:
    """Places of all slices; those off the path of contact are far apart."""
    contact, on_path = contacts.contact, contacts.in_contact
    low, high = sorted((contact.A, contact.E))
    path = np.clip(contacts.path, low, high)
    return ContactPlaces(
        contact=contact,
        phase=contacts.phase,
        number=contacts.number,
        path=contacts.path,
        separation=np.where(on_path, 0.0, FAR),
        pinion_curvature_radius=path,
        wheel_curvature_radius=contact.pair.line_of_action_length - path,
    )


def thin_slices(
    pinion: GearInfluence, wheel: GearInfluence, contacts: FaceContacts, places: ContactPlaces
) -> Array:
    """Compliance of slices of which each is a thin spur gear (p, c, c)."""
    each = coupled_compliance(pinion, wheel, places.slice_by_slice(contacts.slices))
    phases, pairs, k = len(places.path), each.shape[1], np.arange(contacts.slices)
    total = np.zeros((phases, pairs, k.size, pairs, k.size))
    total[:, :, k, :, k] = np.moveaxis(each.reshape(phases, k.size, pairs, pairs), 1, 0)
    return total.reshape(phases, pairs * k.size, pairs * k.size)


def coupled_slices(
    pinion: FaceInfluence, wheel: FaceInfluence, contacts: FaceContacts, places: ContactPlaces
) -> Array:
    """Compliance of slices that act on each other through the teeth (p, c, c)."""
    pair = contacts.contact.pair
    edges = np.linspace(-0.5, 0.5, contacts.slices + 1) * pair.common_face_width
    shape = contacts.phase.size, -1, contacts.slices
    structure = np.zeros((*places.path.shape, places.path.shape[1]))
    # Lines of contact fall along the face where slices enter one after the other.
    fall = places.direction * float(contacts.delay[-1] - contacts.delay[0])
    for gear, radius, sense in (
        (pinion, places.pinion_curvature_radius, 1),
        (wheel, places.wheel_curvature_radius, -pair.wheel.sign),
    ):
        sliced = gear.sliced(edges, rising=sense * fall < 0.0)
        sliced.fill(structure, radius.reshape(shape), sense * places.direction)
    return structure


def local_of_slices(material: Material, places: ContactPlaces) -> tuple[Array, float]:
    """Local compression of each slice along the transverse line of action."""
    # Along the normal it is that of a line contact under the load per length of the line, which
    # equals the transverse load per face width; along the line of action 1/cos(beta_b) of that.
    cosine = math.cos(places.contact.pair.base_helix_angle)
    local, logarithm = local_coefficients(material, places)
    # Across the line the flanks are less curved and the teeth thinner than in the transverse plane.
    local = local + 3.0 * logarithm * math.log(cosine)
    return local / cosine, logarithm / cosine


def slice_stiffness(
    model: StiffnessModel,
    pair: SpurPair,
    material: Material,
    contacts: FaceContacts,
    normal_force: float,
    options: ByName,
) -> Array:
    """Stiffness of each slice by a model of pairs, as that part of a spur pair (p, c)."""
    count, stiffness = contacts.slices, np.zeros(contacts.path.shape)
    for k in range(count):
        columns = slice(k, None, count)
        on_path = contacts.in_contact[:, columns]
        phase = (contacts.phase - contacts.delay[k]) % 1.0
        each = model(
            pair, material, contacts.path[:, columns], on_path, phase, normal_force, **options
        )
        checked = usable_stiffness(each, on_path, model.name)
        stiffness[:, columns] = checked * contacts.width[:, columns] / pair.common_face_width
    return stiffness


def face_compliance(
    pair: SpurPair,
    material: Material,
    contacts: FaceContacts,
    places: ContactPlaces,
    total_force: float,
    model: StiffnessModel,
    options: ByName,
) -> Compliance:
    """Compliance of all slices by a named model."""
    if model.influence is None:
        stiffness = slice_stiffness(model, pair, material, contacts, total_force, options)
        structure = independent_compliance(stiffness, contacts.width)
        return Compliance(structure, np.zeros(places.path.shape), 0.0)
    gears = gear_influences(pair, material, model, options)
    of_gears = coupled_slices if model.over_face else thin_slices
    structure = of_gears(*gears, contacts, places)
    alone = np.diagonal(structure, axis1=1, axis2=2).copy()
    # Where a part of a slice alone is on the path of contact, its load per width acts on less.
    structure *= (contacts.width * (contacts.slices / pair.common_face_width))[:, None, :]
    if not model.over_face:  # that part is a thinner gear: its own load deflects it as a slice
        diagonal = np.arange(alone.shape[1])
        structure[:, diagonal, diagonal] = alone
    return Compliance(structure, *local_of_slices(material, places))
