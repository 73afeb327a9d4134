"""The grid of a contact: how far it reaches, the inlet before it, and how many nodes it has."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real
from typing import Any, cast

import numpy as np

from tribodyn.ehl.formulas.dimensionless_groups import (
    elastic_isoviscous,
    elastic_piezoviscous,
    rigid_isoviscous,
    rigid_piezoviscous,
)
from tribodyn.ehl.formulas.line import blended, isoviscous
from tribodyn.ehl.solver.contact_case import ContactScales
from tribodyn.errors import InputError

INLETS = ("flooded", "zero")

#: Where the inlet pressure of a cut domain is given by the wedge alone: it starts at least here.
_NEAREST_TAIL = -3.0
#: Nodes and weights of Gauss on [0, 1].
_GAUSS = np.polynomial.legendre.leggauss(40)


@dataclass(frozen=True)
class Domain:
    """Extent of the grid in half widths, and the inlet before it."""

    start: float
    end: float
    tail: float  #: pressure at the first position, in Hertz pressures
    tail_load: float  #: load before the first position, in ``b p_h``
    inlet: str  #: ``"flooded"`` or ``"zero"``
    stated: bool  #: whether the user gave the extent


def _asymptotes(M: float, L: float) -> dict[str, float]:
    load, viscosity = np.asarray(M), np.asarray(L)
    return {
        "rigid-isoviscous": float(rigid_isoviscous(load)),
        "elastic-isoviscous": float(elastic_isoviscous(load)),
        "rigid-piezoviscous": float(rigid_piezoviscous(viscosity)),
        "elastic-piezoviscous": float(elastic_piezoviscous(load, viscosity)),
    }


def regime_name(M: float, L: float) -> str:
    """Regime of the survey diagram of Moes (1965) whose asymptote gives the film."""
    film = _asymptotes(M, L)
    thin = max("rigid-isoviscous", "elastic-isoviscous", key=film.__getitem__)
    thick = min("rigid-piezoviscous", "elastic-piezoviscous", key=film.__getitem__)
    return max(thin, thick, key=film.__getitem__)


def estimate_film(M: float, L: float, density_ratio: float) -> float:
    """Central film ``H = h R/b^2`` by the formula of Moes, for domain and start; L may be zero."""
    films = tuple(_asymptotes(M, L).values())
    film = blended(*films) if L > 0.0 else isoviscous(*films[:2])
    return float(math.pi / 8.0 * film / M / density_ratio)


def inlet_tail(start: float, film: float, lam: float) -> tuple[float, float]:
    """Pressure and load of the flooded wedge before the first position."""
    reach = abs(start)
    t = (_GAUSS[0] + 1.0) / (2.0 * reach)
    x = 1.0 / t
    root = np.sqrt(x * x - 1.0)
    d = 0.5 * (x * root - np.log(x + root))
    weight = _GAUSS[1] / (2.0 * reach) * lam * d / (d + film) ** 3 * x * x
    return float(np.sum(weight)), float(np.sum(weight * (x - reach)))


#: Relative error of the film over ``(film/X^2)^2``, X being where a flooded grid begins, at most;
#: and the part of the tolerance of the film that it may take.
_CUT, _CUT_SHARE = 2.0, 0.3


def cut_error(start: float, film: float) -> float:
    """Bound of the relative error of a film whose wedge before ``start`` is taken as undeformed."""
    return _CUT * (film / start**2) ** 2


def choose_domain(
    domain: object, inlet: str, film: float, scales: ContactScales, tolerance: float = math.inf
) -> Domain:
    """Extent of the grid: by the film and its tolerance, or as stated."""
    if not isinstance(inlet, str) or inlet not in INLETS:
        raise InputError(
            f"inlet = {inlet!r}",
            where="argument inlet",
            why='"flooded": oil everywhere before the contact; "zero": no pressure before the '
            "first position of the domain, as if the oil began there",
            remedy="Choose one of the two",
        )
    stated = not (isinstance(domain, str) and domain == "auto")
    if stated:
        start, end = _pair(domain)
    elif inlet == "zero":
        raise InputError(
            'inlet = "zero" with domain = "auto"',
            where="argument inlet",
            why="the film then depends on where the oil begins",
            remedy="State the domain, for example (-4.5, 1.5) in half widths, or take the "
            'inlet "flooded"',
        )
    else:
        # The first terms hold for gears; between rigid bodies all lengths go with the root.
        root = math.sqrt(2.0 * film)
        start = -max(
            4.0 + min(1.2 * film, 8.0 * root),
            math.sqrt(film) * (_CUT / (_CUT_SHARE * tolerance)) ** 0.25,
        )
        end = 1.5 + min(0.4 * max(0.0, film - 0.5), 1.5 * root)
    _check_extent(start, end, inlet, film)
    tail, tail_load = inlet_tail(start, film, scales.lam) if inlet == "flooded" else (0.0, 0.0)
    if tail_load > 0.5 * math.pi / 2.0:
        raise _too_short(start, end, film)
    return Domain(start, end, tail, tail_load, inlet, stated)


def _pair(domain: Any) -> tuple[float, float]:
    try:
        start, end = (float(edge) for edge in domain)
    except (TypeError, ValueError) as error:
        why = 'it is "auto" or a pair (first position, last position) in half widths b'
        remedy = "For example domain = (-4.5, 1.5)"
        raise InputError(f"domain = {domain!r}", "argument domain", why, remedy) from error
    if not (-1e5 <= start <= -1.05 and 1.05 <= end <= 1e5):
        raise InputError(
            f"domain = ({start:g}, {end:g})",
            where="argument domain",
            why="in half widths b, the dry contact reaches from -1 to 1: the first position "
            "lies between -1e5 and -1.05, the last one between 1.05 and 1e5",
            remedy='Give multiples of the half width, not metres, or domain = "auto"',
        )
    return start, end


def _check_extent(start: float, end: float, inlet: str, film: float) -> None:
    if inlet == "flooded" and start > _NEAREST_TAIL:
        raise InputError(
            f"domain = ({start:g}, {end:g}) with a flooded inlet",
            where="argument domain",
            why=f"the inlet before the domain is given by the wedge alone from X = "
            f"{_NEAREST_TAIL:g} outwards",
            remedy=f'Begin at X <= {_NEAREST_TAIL:g}, take domain = "auto", or take '
            'inlet = "zero" for a contact that is starved from there',
        )
    if film > start * start:
        raise _too_short(start, end, film)


def _too_short(start: float, end: float, film: float) -> InputError:
    return InputError(
        f"domain = ({start:g}, {end:g}) with a film of about {film:.3g} b^2/R",
        where="argument domain",
        why=f"the film is thicker than the inlet of the domain is high "
        f"({0.5 * start * start:.3g} b^2/R)",
        remedy='Use domain = "auto", or check load (N/m), radius (m) and speed (m/s)',
    )


#: Nodes of a grid: fewest and most.
FEWEST, MOST = 65, 16385
#: Numbers beyond this are none of nodes.
_ENDLESS = 1e9
#: Intervals of the coarsest grid at most, so that halving leads to a grid that is quickly solved.
_COARSEST = 255


def choose_nodes(nodes: object) -> tuple[int, bool]:
    """Nodes of the finest grid, and whether coarser ones may do."""
    if isinstance(nodes, str) and nodes == "auto":
        return MOST, True
    if (
        isinstance(nodes, bool)
        or not isinstance(nodes, Real)
        or not -_ENDLESS < cast(float, nodes) < _ENDLESS
        or not float(nodes).is_integer()
    ):
        why = f'it is "auto" or a whole number from {FEWEST} to {MOST}'
        remedy = 'Leave it at "auto", or give a number of this range'
        raise InputError(f"nodes = {nodes!r}", "argument nodes", why, remedy)
    count = int(float(nodes))
    suggestion = 2 ** min(14, max(6, round(math.log2(max(count - 1, 1))))) + 1
    if not FEWEST <= count <= MOST:
        why = f"a grid has {FEWEST} to {MOST} nodes"
        raise InputError(f"nodes = {count}", "argument nodes", why, f"Use nodes = {suggestion}")
    intervals = count - 1
    while intervals % 2 == 0 and intervals > _COARSEST:
        intervals //= 2
    if intervals > _COARSEST:
        what = f"nodes = {count}, hence {count - 1} intervals"
        why = f"halving the intervals must lead to {_COARSEST} or fewer, and ends at {intervals}"
        raise InputError(
            what, "argument nodes", why, f"Use nodes = {suggestion}, or another 2^k + 1"
        )
    return count, False
