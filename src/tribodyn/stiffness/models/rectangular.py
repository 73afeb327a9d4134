"""Rectangular mesh stiffness: constant within a zone, with jumps where the pair count changes."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import InputError, ModelOption, require_positive
from tribodyn.model import number
from tribodyn.stiffness.model import MODELS, MeshState, share_equally
from tribodyn.types import Array, Mask


def rectangular_stiffness(
    in_contact: Mask,
    *,
    pair_stiffness: float | None = None,
    single_pair_stiffness: float | None = None,
    double_pair_stiffness: float | None = None,
) -> Array:
    """Constant stiffness of each zone.

    Give either ``pair_stiffness``, which every pair in contact has and which adds up, or the two
    stiffnesses of the whole mesh with one and with two pairs in contact, which the pairs share
    equally.

    Parameters
    ----------
    in_contact : bool array (n, pairs)
        Whether the pair is in contact.
    pair_stiffness : float, optional [N/m]
        Stiffness of one pair.
    single_pair_stiffness : float, optional [N/m]
        Stiffness of the mesh while one pair is in contact.
    double_pair_stiffness : float, optional [N/m]
        Stiffness of the mesh while two pairs are in contact.

    Returns
    -------
    array (n, pairs) [N/m]
        Zero where not in contact.

    Raises
    ------
    InputError
        If neither or both forms are given, a value is not positive, or mesh values are given
        for a mesh that has zones with other than one or two pairs.

    Notes
    -----
    Any contact ratio with ``pair_stiffness``; contact ratio 1 to 2 with the mesh values. The
    share of the double zone in the cycle is the contact ratio minus one, not a half. Source: the
    idealised square wave, for example Kahraman and Singh (1991), J. Sound Vib. 146, 135-156.

    Examples
    --------
    >>> zones = np.array([[True, True], [True, False]])
    >>> rectangular_stiffness(zones, single_pair_stiffness=2e8, double_pair_stiffness=3e8)
    array([[1.5e+08, 1.5e+08],
           [2.0e+08, 0.0e+00]])
    """
    totals: dict[str, float | None] = {
        "single_pair_stiffness": single_pair_stiffness,
        "double_pair_stiffness": double_pair_stiffness,
    }
    _check_forms(pair_stiffness, totals)
    if pair_stiffness is not None:
        require_positive("pair_stiffness", pair_stiffness, "N/m")
        return np.where(in_contact, float(pair_stiffness), 0.0)
    single, double = (float(value or 0.0) for value in totals.values())
    require_positive("single_pair_stiffness", single, "N/m")
    require_positive("double_pair_stiffness", double, "N/m")
    count = in_contact.sum(axis=1)
    if not np.all(np.isin(count, (1, 2))):
        raise InputError(
            f"a zone of this mesh has {count.max()} pairs in contact",
            where="single_pair_stiffness, double_pair_stiffness",
            why="The two mesh values describe zones of one and two pairs only",
            remedy="Give pair_stiffness, which holds for any contact ratio",
        )
    return share_equally(np.where(count == 1, single, double), in_contact)


def _check_forms(pair_stiffness: float | None, totals: dict[str, float | None]) -> None:
    given = {name: value for name, value in totals.items() if value is not None}
    listing = ", ".join(f"{name} = {value:g} N/m" for name, value in given.items())
    if pair_stiffness is not None and given:
        raise InputError(
            f"pair_stiffness = {pair_stiffness:g} N/m and {listing} are both given",
            where=ModelOption("stiffness", "rectangular"),
            why="They are two ways of saying the same thing",
            remedy="Keep pair_stiffness, or the two mesh values, not both",
        )
    if pair_stiffness is None and len(given) < len(totals):
        missing = ", ".join(name for name in totals if name not in given)
        raise InputError(
            f"{missing} not given" + (f" although {listing} is" if given else ""),
            where=ModelOption("stiffness", "rectangular"),
            why="The model needs pair_stiffness, or both mesh values",
            remedy='Give for example pair_stiffness = "2e8 N/m"',
        )


_RANGE = (None, 1e3, 1e13, "guards against a wrong unit")
_OPTIONS = {
    "pair_stiffness": number(*_RANGE, of="pair_stiffness"),
    "single_pair_stiffness": number(
        *_RANGE, of="pair_stiffness", meaning="stiffness with one pair in contact"
    ),
    "double_pair_stiffness": number(
        *_RANGE, of="mesh_stiffness", meaning="stiffness with two pairs in contact"
    ),
}


@MODELS.define(
    "rectangular",
    options=_OPTIONS,
    meaning="stiffness that is constant while the number of pairs in contact is",
    papers=("kahraman-singh",),
)
def _model(*mesh: Any, **options: Any) -> Array:
    return rectangular_stiffness(MeshState(*mesh).in_contact, **options)
