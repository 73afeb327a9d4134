"""How a mesh carries its load, as columns of the mesh table: stiffness, shares, force law."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.mesh.force_ramps import force_ramps
from tribodyn.mesh.teeth import Carried, Teeth
from tribodyn.types import Array


def carried_columns(
    teeth: Teeth, carried: Carried, film_stiffness: Array | None, *, force_law: bool
) -> dict[str, Any]:
    """Columns of the mesh table that follow from teeth and films under load."""
    film = None
    if film_stiffness is not None:
        film = np.zeros(teeth.in_contact.shape)
        film[teeth.in_contact] = film_stiffness
    if force_law or teeth.stiffness is None:
        ramps = force_ramps(teeth.with_film(film), teeth.total_force)
    else:
        whole = carried.stiffness.sum(axis=1)[:, None]
        ramps = np.zeros_like(whole), whole
    without_film = carried if film is None else teeth.carried()
    return {
        "stiffness": carried.stiffness,
        "tooth_stiffness": without_film.stiffness,
        "corner_share": carried.corner_share,
        "static_transmission_error": carried.transmission_error,
        "mesh_stiffness_tangent": carried.tangent,
        "maximum_single_pair_stiffness": teeth.maximum_single_pair_stiffness,
        "ramp_deflection": ramps[0],
        "ramp_stiffness": ramps[1],
        "load_share": carried.share,
        "normal_force": teeth.total_force * carried.share,
    }
