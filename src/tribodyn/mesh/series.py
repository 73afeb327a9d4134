"""Teeth and oil film in series: the stiffness of each tooth pair and the load that it takes."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import ComputationError, ModelWarning, Problem
from tribodyn.mesh.path_film import FilmAt

__all__ = ["in_series"]

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: The film is solved anew until the load shares move by less than this.
_TOLERANCE = 1e-6
_PASSES = 12
#: Between two solutions the shares settle to this; each pass gains one digit or two.
_SETTLED = 1e-13
_STEPS = 200
#: Load share below which a pair has lost its load to a film that is softer than its teeth.
_LOST = 1e-9


def in_series(
    teeth: FloatArray,
    in_contact: BoolArray,
    total_load: float,
    film_of: Callable[[FloatArray], FilmAt],
) -> tuple[FloatArray, FloatArray, FilmAt]:
    """Put the film of each pair in series with its teeth, at the load share that follows.

    Parameters
    ----------
    teeth : array (n, pairs) [N/m]
        Stiffness of the teeth of each pair, zero where it is not in contact.
    in_contact : bool array (n, pairs)
        Whether the pair is in contact.
    total_load : float [N/m]
        Load of all pairs together per face width.
    film_of : callable
        Solves the film for the loads (n, pairs) of a mesh table, and returns the films of the
        touching pairs as a function of their loads.

    Returns
    -------
    tuple
        Stiffness of each pair (n, pairs) [N/m], its share of the load (n, pairs), and the films
        of the touching pairs as a function of their loads.

    Raises
    ------
    ComputationError
        If the share does not settle: the film is softer than the teeth.

    Notes
    -----
    ``1/k = 1/k_teeth + 1/K_film`` for each pair, never for the sum of the pairs; pairs deflect
    alike, so that a share is in proportion to ``k``. The stiffness of the film grows with its
    load, hence the search for a fixed point. The teeth keep the stiffness that they have at the
    share without film, which differs by parts of a percent.
    """
    share = teeth / teeth.sum(axis=1, keepdims=True)
    for _ in range(_PASSES):
        film_at = film_of(total_load * share)
        settled, stiffness = _settle(teeth, in_contact, total_load, film_at, share)
        change = float(np.max(np.abs(settled - share)))
        share = settled
        if change < _TOLERANCE:
            return stiffness, share, film_at
    raise _unsettled(f"the load share still moves by {change:.2g} after {_PASSES} solutions")


def _settle(
    teeth: FloatArray,
    in_contact: BoolArray,
    total_load: float,
    film_at: FilmAt,
    share: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Find the fixed point of share and stiffness with the films as a function of their load."""
    stiffness = np.zeros(teeth.shape)
    for _ in range(_STEPS):
        with warnings.catch_warnings():
            # What a formula has to say, it says of the load share that is found.
            warnings.simplefilter("ignore", ModelWarning)
            film = film_at(total_load * share[in_contact]).film_stiffness
        stiffness[in_contact] = 1.0 / (1.0 / teeth[in_contact] + 1.0 / np.asarray(film))
        settled = stiffness / stiffness.sum(axis=1, keepdims=True)
        change = float(np.max(np.abs(settled - share)))
        share = settled
        if change < _SETTLED:
            return share, stiffness
        if np.min(share[in_contact]) < _LOST:
            raise _unsettled("a tooth pair loses its whole load to its film")
    raise _unsettled(f"the load share still moves by {change:.2g} after {_STEPS} steps")


def _unsettled(what: str) -> ComputationError:
    return ComputationError(
        Problem(
            what=what,
            where="film stiffness in series with the teeth",
            why="The film of a lightly loaded pair is softer than its teeth",
            remedy='Give more torque, or set film.stiffness = "none"',
        )
    )
