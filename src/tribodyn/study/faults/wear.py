"""Wear of the flanks by Archard's law, in steps with the flanks that it changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import InputError, collected, require_positive
from tribodyn.gear.mesh_geometry import flank_ranges
from tribodyn.mesh.face_lines import by_pair, slice_count
from tribodyn.nomenclature import GEARS, require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, quantity, record
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.pair import PairCase

#: Places on the used flank.
_PLACES = 41


@record
class Wear(Record):
    """Depth of wear over the turns.

    Parameters
    ----------
    turns : (k,) array
        Turns of the pinion, from 0 on.
    place : (p,) array
        Place on the used flank, 0 at its lowest point and 1 at the tip.
    depth_pinion, depth_wheel : (k, p) array
        Depth of wear [m].
    case : PairCase
        The case with the worn flanks of the last step.
    """

    turns: Array = quantity("turns", unit="1", axis=True)
    place: Array = quantity("place", unit="1", axis=True)
    depth_pinion: Array = quantity("turns", "place", unit="m")
    depth_wheel: Array = quantity("turns", "place", unit="m")
    case: PairCase

    def __repr__(self) -> str:
        """One line."""
        depths = [1e6 * depth[-1].max() for depth in (self.depth_pinion, self.depth_wheel)]
        return (
            f"Wear({self.turns[-1]:.4g} turns of the pinion, {depths[0]:.3g} um on the pinion, "
            f"{depths[1]:.3g} um on the wheel)"
        )


def wear(
    case: PairCase,
    coefficient: float,
    turns: float,
    *,
    steps: int = 10,
    progress: Progress = SILENT,
) -> Wear:
    """Wear both flanks by Archard's law.

    Parameters
    ----------
    case : PairCase
        Of a cylindrical pair with teeth whose deflection is computed.
    coefficient : float
        Wear coefficient: volume over load and sliding distance [m^2/N]; mild wear of steel in
        boundary lubrication has 1e-18 to 1e-16.
    turns : float
        Turns of the pinion.
    steps : int
        Steps, each with the load distribution of the flanks worn so far.
    progress : Progress
        Receives the number of finished steps.

    Returns
    -------
    Wear

    Raises
    ------
    InputError
        If a value is out of range, or the gears are not cylindrical.

    Notes
    -----
    A point of flank i is passed once a turn by a contact with the line load f, which moves over it
    with the surface speed u_i: it loses ``h = k f |u_1 - u_2| / u_i``. Where the contact is solved
    in slices of the face, as of helical pairs, the depth is their mean over the face: the profile
    wears, the lead does not. Source: Archard (1953), J. Appl. Phys. 24, 981; Flodin and Andersson
    (1997), Wear 207, 16, for spur, and (2000), Wear 241, 123, for helical gears.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    >>> worn = wear(case, 1e-17, 1e6, steps=1)
    >>> worn.depth_pinion.shape, bool(worn.depth_pinion[-1].max() > 0.0)
    ((2, 41), True)
    """
    require_positive("coefficient", coefficient, "m^2/N")
    require_positive("turns", turns, "")
    require_whole("steps", steps, 1)
    if case.gears.kind != "spur":
        why = "Wear is computed over the path of contact of involute teeth"
        what = "the gears are not cylindrical"
        raise InputError(what, "gears.kind", why, "Give a spur or helical pair")
    with collected():
        bare = case.replace({"film.model": "none", "friction.law": "none"})
    each, place = turns / steps, np.linspace(0.0, 1.0, _PLACES)
    depths = [[_stated(case, name)] for name in GEARS]
    ratio = (1.0, 1.0 / case.gear_ratio)
    progress.start("Wear", steps)
    for _step in range(steps):
        rates = _rates(_worn(bare, [depth[-1] for depth in depths]), coefficient)
        for depth, rate, turned in zip(depths, rates, ratio, strict=True):
            depth.append(depth[-1] + rate * each * turned)
        progress.advance()
    progress.finish()
    pinion, wheel = (np.array(depth) for depth in depths)
    worn = _worn(case, [pinion[-1], wheel[-1]])
    return Wear(np.asarray(each * np.arange(steps + 1)), place, pinion, wheel, worn)


def _stated(case: PairCase, name: str) -> Array:
    """Depth of wear that a case begins with."""
    modification = getattr(case.gears, name).modification
    stated = modification.wear_depth if modification is not None else None
    depth = np.atleast_1d(np.asarray(stated or 0.0, dtype=float))
    at = np.linspace(0.0, 1.0, _PLACES)
    return np.asarray(np.interp(at, np.linspace(0.0, 1.0, depth.size), depth))


def _worn(case: PairCase, depths: list[Array]) -> PairCase:
    changes = {
        f"gears.{name}.modification.wear_depth": depth.tolist()
        for name, depth in zip(GEARS, depths, strict=True)
    }
    with collected():
        return case.replace(changes)


def _rates(case: PairCase, coefficient: float) -> list[Array]:
    """Depth that each flank loses in a turn of its gear, over the places (p,) [m]."""
    from tribodyn.study.pipeline.tooth_contact import mesh_of

    with collected():
        mesh = mesh_of(case, about_load=True)
    return [_rate(mesh, gear, coefficient) for gear in GEARS]


def _rate(mesh: MeshTable, gear: str, coefficient: float) -> Array:
    pair, slices = mesh.gear_pair, slice_count(mesh)
    flank = flank_ranges(pair)[GEARS.index(gear)]
    speed = abs(mesh.pinion_speed) * (1.0 if gear == "pinion" else 1.0 / abs(pair.ratio))
    radii = getattr(mesh, f"{gear}_curvature_radius")
    columns = [radii, np.abs(mesh.sliding_speed), mesh.load_per_width, mesh.in_contact]
    depth = np.zeros(_PLACES)
    for each in zip(*(np.moveaxis(by_pair(c, slices), -1, 0) for c in columns), strict=True):
        radius, sliding, load = (column[each[3]] for column in each[:3])
        order = np.argsort(radius)
        share = (radius[order] - flank.lowest) / flank.length
        lost = coefficient * load * sliding / (speed * radius)
        depth += np.interp(np.linspace(0.0, 1.0, _PLACES), share, lost[order]) / slices
    return depth
