"""Stiffness that is given: constant within a zone, a Fourier series over the phase, a table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tribodyn.arrays.splines import monotone_cubic
from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError, ModelOption, Problem, require_positive
from tribodyn.model import number, numbers
from tribodyn.stiffness.model import MODELS, MeshState, share_equally
from tribodyn.types import Array, Mask, Tree


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
        what = f"a zone of this mesh has {count.max()} pairs in contact"
        why = "The two mesh values describe zones of one and two pairs only"
        remedy = "Give pair_stiffness, which holds for any contact ratio"
        raise InputError(what, "single_pair_stiffness, double_pair_stiffness", why, remedy)
    return share_equally(np.where(count == 1, single, double), in_contact)


def _check_forms(pair_stiffness: float | None, totals: dict[str, float | None]) -> None:
    given_totals = {name: value for name, value in totals.items() if value is not None}
    listing = ", ".join(f"{name} = {value:g} N/m" for name, value in given_totals.items())
    if pair_stiffness is not None and given_totals:
        what = f"pair_stiffness = {pair_stiffness:g} N/m and {listing} are both given"
        why = "Both define the same stiffness"
        remedy = "Keep pair_stiffness, or the two mesh values, not both"
        raise InputError(what, ModelOption("stiffness", "rectangular"), why, remedy)
    if pair_stiffness is None and len(given_totals) < len(totals):
        missing = ", ".join(name for name in totals if name not in given_totals)
        what = f"{missing} not given" + (f" although {listing} is" if given_totals else "")
        why = "The model needs pair_stiffness, or both mesh values"
        remedy = 'Give for example pair_stiffness = "2e8 N/m"'
        raise InputError(what, ModelOption("stiffness", "rectangular"), why, remedy)


_RANGE = (None, 1e3, 1e13, "guards against a wrong unit")
_RECTANGULAR = {
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
    options=_RECTANGULAR,
    meaning="stiffness that is constant while the number of pairs in contact is",
    papers=("kahraman-singh",),
)
def _rectangular(*mesh: Any, **options: Any) -> Array:
    return rectangular_stiffness(MeshState(*mesh).in_contact, **options)


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
        what = "a coefficient of the Fourier series is not a finite number"
        why, remedy = "The sum of the series must be finite", "Give every coefficient in N/m"
        raise InputError(what, ModelOption("stiffness", "fourier", "cosine, sine"), why, remedy)
    scan = np.linspace(0.0, 1.0, _POINTS_PER_WAVE * (coefficients.shape[1] + 1))
    least = _series(scan, mean_stiffness, coefficients)
    if least.min() <= 0.0:
        what = f"the mesh stiffness is {least.min():.4g} N/m at phase {scan[least.argmin()]:.3f}"
        why = "A mesh in contact has a positive stiffness over the whole cycle"
        remedy = f"Raise mean_stiffness = {mean_stiffness:g} N/m or lower the coefficients"
        raise InputError(what, ModelOption("stiffness", "fourier"), why, remedy)
    return _series(np.asarray(phase, dtype=float), mean_stiffness, coefficients)


def _series(phase: Array, mean_stiffness: float, coefficients: Array) -> Array:
    harmonics = np.arange(1, coefficients.shape[1] + 1)
    angle = 2.0 * np.pi * phase[..., None] * harmonics
    waves = np.cos(angle) @ coefficients[0] + np.sin(angle) @ coefficients[1]
    total: Array = mean_stiffness + waves
    return total


_GUARD = "guards against a wrong unit"
_FOURIER = {
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
    options=_FOURIER,
    meaning="mesh stiffness given as a mean and harmonics, shared equally by the pairs",
    papers=("kahraman-singh",),
)
def _fourier(*mesh: Any, **options: Any) -> Array:
    state = MeshState(*mesh)
    if options["mean_stiffness"] is None:
        what = "mean_stiffness not given"
        why, remedy = "The series needs its mean", 'Give for example mean_stiffness = "2.5e8 N/m"'
        raise InputError(what, ModelOption("stiffness", "fourier"), why, remedy)
    return share_equally(fourier_mesh_stiffness(state.phase, **options), state.in_contact)


#: Roll angles of a table may fall short of A..E by this much [rad] (rounding in print).
_COVERAGE_TOLERANCE = 1e-6


def tabulated_stiffness(
    abscissa: Sequence[float] | Array,
    stiffness: Sequence[float] | Array,
    at: Array,
    *,
    name: str = "abscissa",
    unit: str = "",
) -> Array:
    """Interpolate a stiffness table without overshoot.

    Parameters
    ----------
    abscissa, stiffness : array (m,) [unit], [N/m]
        Strictly increasing, at least two values; positive values.
    at : array [unit]
        Where to evaluate; clipped to the table within rounding.
    name, unit : str
        Name and unit of the abscissa in messages.

    Returns
    -------
    array [N/m]
        Shape of ``at``.

    Raises
    ------
    InputError
        If the lengths differ, a value is not finite, the abscissa does not increase, a stiffness
        is not positive or the table does not cover ``at``.

    Notes
    -----
    A monotone piecewise cubic, Fritsch and Carlson (1980), SIAM J. Numer. Anal. 17, 238-246.
    Source: the user's table.

    Examples
    --------
    >>> tabulated_stiffness([0.0, 0.5, 1.0], [1e8, 2e8, 1e8], np.array([0.0, 0.5]))
    array([1.e+08, 2.e+08])
    """
    x = np.asarray(abscissa, dtype=float)
    y = np.asarray(stiffness, dtype=float)
    problems = [*(_shape_problems(x, y, name) or _order_problems(x, name, unit))]
    if problems:
        raise InputError(problems)
    require_positive("stiffness of the table", y, "N/m")
    low, high = float(np.min(at)), float(np.max(at))
    if low < x[0] - _COVERAGE_TOLERANCE or high > x[-1] + _COVERAGE_TOLERANCE:
        raise InputError(
            f"the table covers {name} {x[0]:.6g} to {x[-1]:.6g} {unit}".rstrip(),
            where=ModelOption("stiffness", "table", name),
            why=f"The mesh needs {low:.6g} to {high:.6g} {unit}".rstrip(),
            remedy="Extend the table to the whole contact; nothing is extrapolated",
        )
    return monotone_cubic(x, y)(np.clip(at, x[0], x[-1]))


def _shape_problems(x: Array, y: Array, name: str) -> list[Problem]:
    if x.ndim == 1 and x.shape == y.shape and x.size >= 2:
        return []
    what = f"{name} has shape {x.shape}, the stiffness has shape {y.shape}"
    why = "A table is two lists of equal length with at least two values"
    remedy = "Give one stiffness for every entry of the abscissa"
    return [Problem(what, ModelOption("stiffness", "table"), why, remedy)]


def _order_problems(x: Array, name: str, unit: str) -> list[Problem]:
    bad = np.flatnonzero(~np.isfinite(x))
    if bad.size:
        what = f"entry {bad[0] + 1} of {name} is {x[bad[0]]}"
        why, remedy = "Every entry must be a finite number", "Remove or correct the row"
        return [Problem(what, ModelOption("stiffness", "table", name), why, remedy)]
    falling = np.flatnonzero(np.diff(x) <= 0.0)
    if falling.size:
        first = falling[0]
        text = f"{x[first]:.6g} is followed by {x[first + 1]:.6g} {unit}".rstrip()
        what = f"{text} at entry {first + 2} of {name}"
        why, remedy = f"{name} must increase strictly", "Sort the table and remove repeated rows"
        return [Problem(what, ModelOption("stiffness", "table", name), why, remedy)]
    return []


def _named_values(options: Tree) -> Tree:
    """Call bare values by what their abscissa makes of them."""
    options = dict(options)
    values = options.pop("values", None)
    if values is not None:
        name = "mesh_stiffness" if options.get("phase") is not None else "pair_stiffness"
        options[name] = values
    return options


def _over_roll_angle(state: MeshState, options: Tree) -> Array:
    pair, path, in_contact = state.pair, state.path, state.in_contact
    ends = path_of_contact(pair).roll_angles
    radius = pair.driving.base_radius
    angles = pair.driving_radius(path[in_contact]) / radius
    needed = np.concatenate(([ends["A"], ends["E"]], angles))
    values = tabulated_stiffness(
        options["roll_angle"], options["pair_stiffness"], needed, name="roll_angle", unit="rad"
    )
    stiffness = np.zeros(path.shape)
    stiffness[in_contact] = values[2:]
    return stiffness


_STIFFNESS = (0.0, 1e13, "guards against a wrong unit")
_TABLE = {
    "phase": numbers(
        0.0, 1.0, "one mesh cycle", of="mesh_phase", meaning="mesh phases of the table"
    ),
    "roll_angle": numbers(
        0.0, 2.0 * np.pi, "less than one turn", of="roll_angle", meaning="roll angles of the table"
    ),
    "values": numbers(*_STIFFNESS, of="mesh_stiffness", meaning="stiffness values of the table"),
    # What the values are called where a program gives them with their abscissa.
    "mesh_stiffness": numbers(*_STIFFNESS, of="mesh_stiffness", in_case=False),
    "pair_stiffness": numbers(*_STIFFNESS, of="pair_stiffness", in_case=False),
}


@MODELS.define(
    "table",
    options=_TABLE,
    meaning="stiffness given as a table over the mesh phase or the roll angle",
)
def _table(*mesh: Any, **options: Any) -> Array:
    state, options = MeshState(*mesh), _named_values(options)
    supplied = {name for name, value in options.items() if value is not None}
    if supplied == {"phase", "mesh_stiffness"}:
        whole_cycle = np.concatenate(([0.0, 1.0], state.phase))
        total = tabulated_stiffness(
            options["phase"], options["mesh_stiffness"], whole_cycle, name="phase"
        )
        return share_equally(total[2:], state.in_contact)
    if supplied == {"roll_angle", "pair_stiffness"}:
        return _over_roll_angle(state, options)
    raise InputError(
        f"given: {', '.join(sorted(supplied)) or 'nothing'}",
        where=ModelOption("stiffness", "table"),
        why="A table is phase with mesh_stiffness, or roll_angle (of the driving gear) with "
        "pair_stiffness",
        remedy="Give one of the two forms, complete and alone",
    )
