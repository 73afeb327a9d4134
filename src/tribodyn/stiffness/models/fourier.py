"""Mesh stiffness as a Fourier series over the mesh phase."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tribodyn.errors import InputError, ModelOption, require_positive
from tribodyn.model import number, numbers
from tribodyn.stiffness.model import MODELS, MeshState, share_equally
from tribodyn.types import Array

#: Points at which the sign of the series is checked, per cycle of its highest harmonic.
_POINTS_PER_WAVE = 64


def fourier_mesh_stiffness(
    phase: Array | float,
    mean_stiffness: float,
    cosine: Sequence[float] = (),
    sine: Sequence[float] = (),
) -> Array:
    """Stiffness of the whole mesh, ``K = k0 + sum a_k cos(2 pi k phi) + b_k sin(2 pi k phi)``.

    Parameters
    ----------
    phase : float or array
        Mesh phase; zero where a pair enters contact.
    mean_stiffness : float [N/m]
        Mean over the cycle.
    cosine, sine : sequence of float [N/m]
        Coefficients of the harmonics 1, 2, ...; the two need not be equally long.

    Returns
    -------
    array [N/m]
        Shape of ``phase``.

    Raises
    ------
    InputError
        If a coefficient is not finite or the series is not positive over the whole cycle.

    Notes
    -----
    Valid for any contact ratio. Source: the Fourier representation of a periodic function.

    Examples
    --------
    >>> fourier_mesh_stiffness(np.array([0.0, 0.5]), 2e8, cosine=[3e7])
    array([2.3e+08, 1.7e+08])
    """
    require_positive("mean_stiffness", mean_stiffness, "N/m")
    coefficients = np.zeros((2, max(len(cosine), len(sine))))
    coefficients[0, : len(cosine)] = cosine
    coefficients[1, : len(sine)] = sine
    if not np.all(np.isfinite(coefficients)):
        raise InputError(
            "a coefficient of the Fourier series is not a finite number",
            where=ModelOption("stiffness", "fourier", "cosine, sine"),
            remedy="Give every coefficient in N/m",
            why="The sum of the series must be finite",
        )
    scan = np.linspace(0.0, 1.0, _POINTS_PER_WAVE * (coefficients.shape[1] + 1))
    least = _series(scan, mean_stiffness, coefficients)
    if least.min() <= 0.0:
        raise InputError(
            f"the mesh stiffness is {least.min():.4g} N/m at phase {scan[least.argmin()]:.3f}",
            where=ModelOption("stiffness", "fourier"),
            why="A mesh in contact has a positive stiffness over the whole cycle",
            remedy=f"Raise mean_stiffness = {mean_stiffness:g} N/m or lower the coefficients",
        )
    return _series(np.asarray(phase, dtype=float), mean_stiffness, coefficients)


def _series(phase: Array, mean_stiffness: float, coefficients: Array) -> Array:
    harmonics = np.arange(1, coefficients.shape[1] + 1)
    angle = 2.0 * np.pi * phase[..., None] * harmonics
    waves = np.cos(angle) @ coefficients[0] + np.sin(angle) @ coefficients[1]
    total: Array = mean_stiffness + waves
    return total


_GUARD = "guards against a wrong unit"
_OPTIONS = {
    "mean_stiffness": number(
        None, 1e3, 1e13, _GUARD, of="mesh_stiffness", meaning="mean of the mesh stiffness"
    ),
    "cosine": numbers(
        -1e13,
        1e13,
        _GUARD,
        default=(),
        of="mesh_stiffness",
        meaning="cosine amplitudes of harmonics 1, 2..",
    ),
    "sine": numbers(
        -1e13,
        1e13,
        _GUARD,
        default=(),
        of="mesh_stiffness",
        meaning="sine amplitudes of harmonics 1, 2..",
    ),
}


@MODELS.define(
    "fourier",
    options=_OPTIONS,
    meaning="mesh stiffness given as a mean and harmonics, shared equally by the pairs",
    papers=("kahraman-singh",),
)
def _model(*mesh: Any, **options: Any) -> Array:
    state = MeshState(*mesh)
    if options["mean_stiffness"] is None:
        raise InputError(
            "mean_stiffness not given",
            where=ModelOption("stiffness", "fourier"),
            why="The series needs its mean",
            remedy='Give for example mean_stiffness = "2.5e8 N/m"',
        )
    return share_equally(fourier_mesh_stiffness(state.phase, **options), state.in_contact)
