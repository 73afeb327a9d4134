"""Models whose tooth pairs are solved together: finite elements, ``analytic``, also ``weber``.

Like any other model they return the stiffness of the pairs over a mesh cycle, as the
secant of the loaded tooth contact on the path of contact.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tribodyn.contact import FaceContacts, face_contacts, path_of_contact
from tribodyn.contact.face_contacts import SLICES
from tribodyn.gear import Material, SpurGear
from tribodyn.model import flag
from tribodyn.stiffness.loaded.contact import mesh_problem
from tribodyn.stiffness.model import MODELS, MeshState, reference_option
from tribodyn.stiffness.teeth.face_influence import FaceInfluence
from tribodyn.stiffness.teeth.influence import GearInfluence
from tribodyn.types import Array, Mask

#: Options of every model that knows the structure of the gears.
OPTIONS = {"reference": "bore", "extended_contact": True}


def _fe2d(gear: SpurGear, material: Material, *, reference: str) -> GearInfluence:
    from tribodyn.stiffness.fe2d import fe2d_influence

    return fe2d_influence(gear, material, reference=reference)


def _fe3d(gear: SpurGear, material: Material, *, reference: str) -> FaceInfluence:
    from tribodyn.stiffness.fe3d import fe3d_influence

    return fe3d_influence(gear, material, reference=reference)


def _analytic(gear: SpurGear, material: Material, *, reference: str) -> GearInfluence:
    from tribodyn.stiffness.teeth.analytic import analytic_influence

    return analytic_influence(gear, material, reference=reference)


def _weber(gear: SpurGear, material: Material, *, reference: str) -> GearInfluence:
    from tribodyn.stiffness.teeth.influence import weber_influence

    return weber_influence(gear, material, reference=reference)


def _pair_stiffness(name: str) -> Callable[..., Array]:
    def function(*mesh: Any, **options: Any) -> Array:
        state, over_face = MeshState(*mesh), MODELS[name].over_face
        places: tuple[Array, Array, Mask] | FaceContacts
        places = state.phase, state.path, state.in_contact
        if over_face:
            before_end = np.minimum(state.phase, np.nextafter(1.0, 0.0))
            contact = path_of_contact(state.pair)
            places = face_contacts(contact, state.phase, SLICES, before_end)
        problem = mesh_problem(
            state.pair,
            provider=name,
            places=places,
            total_force=state.normal_force,
            extended_contact=bool(options.get("extended_contact")),
            material=state.material,
            options=options,
        )
        equilibrium = problem.at_loads(np.array([state.normal_force]))
        force = problem.forces(equilibrium.load[0])
        if over_face:
            force = force.reshape(len(force), -1, SLICES).sum(axis=2)
        if force.shape != state.in_contact.shape:
            force = force[:, 1:-1]
        deflection = equilibrium.approach[0] - problem.least_gap
        return np.where(state.in_contact, force / deflection[:, None], 0.0)

    return function


_TOGETHER = {
    "options": {
        "reference": reference_option("bore"),
        "extended_contact": flag(
            True, meaning="let tip corners of bent teeth touch before A and after E"
        ),
    },
    "coupled": True,
    "papers": ("weber-banaschek", "conry-seireg"),
}
MODELS.define(
    "fe2d",
    influence=_fe2d,
    meaning="stiffness from plane finite elements of both whole gears, all tooth pairs solved "
    "together",
    **_TOGETHER,
)(_pair_stiffness("fe2d"))
MODELS.define(
    "fe3d",
    influence=_fe3d,
    over_face=True,
    meaning="stiffness from finite elements of both whole gears with their face width, all slices "
    "of all tooth pairs solved together",
    **{**_TOGETHER, "options": {"reference": reference_option("bore")}},
)(_pair_stiffness("fe3d"))
MODELS.define(
    "analytic",
    external_only=True,
    influence=_analytic,
    meaning="stiffness from strain energy of the teeth and Fourier series of the gear bodies, "
    "all pairs together",
    **_TOGETHER,
)(_pair_stiffness("analytic"))
MODELS.define(
    "weber",
    external_only=True,
    options={"reference": reference_option("rim")},
    influence=_weber,
    meaning="stiffness after Weber: bending of the tooth, half plane under it, local compression",
    papers=("weber-banaschek",),
)(_pair_stiffness("weber"))
