"""How a mesh carries its load, as columns of the mesh table: stiffness, shares, force law."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.mesh.force_ramps import force_ramps
from tribodyn.mesh.teeth import Carried, Teeth

__all__ = ["carried_columns"]

FloatArray = NDArray[np.float64]


def carried_columns(
    teeth: Teeth, carried: Carried, film_stiffness: FloatArray | None, *, force_law: bool
) -> dict[str, Any]:
    """Columns of the mesh table that follow from teeth and films under load.

    Parameters
    ----------
    teeth : Teeth
        Teeth of all pairs.
    carried : Carried
        How they carry the load, with the film where it is in series.
    film_stiffness : array (m,) [N/m] or None
        Stiffness of the films of the touching pairs, where they are in series with the teeth.
    force_law : bool
        Fit the force law of pairs that are springs of their own too.

    Returns
    -------
    dict of str to array
        Arguments of :class:`tribodyn.mesh.MeshTable`.

    Raises
    ------
    ComputationError
        If the load is beyond what the formula of the local compression covers.
    """
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
