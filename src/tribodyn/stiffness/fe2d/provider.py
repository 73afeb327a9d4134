"""Influence of one gear from finite elements of its complete ring."""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
import zipfile
from collections.abc import Callable, Mapping, Sequence
from functools import cache as remember
from functools import partial
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.fe2d.flank_load import flank_loads, remainder_loads
from tribodyn.stiffness.fe2d.ring import Ring, plane_stress
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, tooth_mesh
from tribodyn.stiffness.teeth.influence import GearInfluence
from tribodyn.stiffness.teeth.tooth_compliance import (
    LARGEST_RATIO,
    check_reference,
    wind_up_compliance,
)
from tribodyn.types import Array, Mask

Unit = TypeVar("Unit", bound=NamedTuple)

#: Places along the flank.
NODES = 25
#: Least radius of curvature that is tabulated [modules].
_LEAST_CURVATURE = 0.02
#: Distances from the tip corner [modules] from which the self compliance goes on to the tip.
_TIP_SUPPORT = np.array([0.07, 0.11, 0.15])
#: Largest share of the involute that this may take.
_TIP_SHARE = 0.3


class UnitCompliances(NamedTuple):
    """Compliances for a Young's modulus of one."""

    curvature_radius: Array  #: nodes [m]
    self_compliance: Array
    cross_compliance: Array


def held_radius(gear: SpurGear) -> float:
    """Radius of the circle where the body is held: the bore, or the outer circle of a ring."""
    return gear.rim_radius or gear.root_radius / LARGEST_RATIO


def wind_up_to_take_off(gear: SpurGear, material: Material, reference: str) -> float:
    """Wind-up of the body per unit width that does not belong to the reference."""
    check_reference(reference)
    fixed_radius = gear.rim_radius if reference == "bore" else held_radius(gear)
    inner, outer = sorted((gear.root_radius, fixed_radius))
    wind_up = wind_up_compliance(gear.base_radius, outer, inner, 1.0, material)
    return wind_up if reference == "rim" else 0.0


def unit_compliances(
    gear: SpurGear,
    poissons_ratio: float,
    neighbours: int,
    size: MeshSize | None = None,
    held_at: float | None = None,
) -> UnitCompliances:
    """Compliances of a gear whose body is held along a circle."""
    fixed_radius = held_radius(gear) if held_at is None else held_at
    elasticity = plane_stress(1.0, poissons_ratio)
    mesh = tooth_mesh(gear, fixed_radius, size)
    ring = Ring(mesh, elasticity)
    rho, support = _places(gear)
    loads = flank_loads(gear, mesh, np.concatenate([rho, support]))
    on_tip = gear.sign * (rho - support[0]) > 0.0
    beyond_supports = np.append(on_tip, np.zeros(support.size, dtype=bool))
    forces = loads.forces.copy()
    place, direction, depth = (rows[~beyond_supports] for rows in loads[:3])
    forces[:, ~beyond_supports] = remainder_loads(mesh, place, direction, depth, elasticity)
    solution = ring.solve(forces)
    # the side of larger radii is the clockwise one; of a ring the other
    sectors = [-gear.sign * n for n in range(neighbours + 1)]
    displacements = ring.weighted_displacements(solution, loads.forces, sectors)
    self_compliance = _carried_to_tip(rho, support, np.diagonal(displacements[0]), on_tip)
    return UnitCompliances(rho, self_compliance, displacements[1:, : rho.size, : rho.size].copy())


def _places(gear: SpurGear) -> tuple[Array, Array]:
    """Nodes from the form circle to the tip, denser at both ends, and supports near the tip [m]."""
    base, module = gear.base_radius, gear.normal_module
    tip = gear.roll_angle(gear.tip_radius) * base
    form = gear.roll_angle(max(gear.form_radius, base)) * base
    low, high = sorted((max(form, min(_LEAST_CURVATURE * module, 0.5 * tip)), tip))
    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, NODES))
    rho = low + (high - low) * share
    rho[-1] = high
    flank = 0.5 * (high * high - low * low) / base
    shrink = min(1.0, _TIP_SHARE * flank / (_TIP_SUPPORT[-1] * module))
    return rho, np.sqrt(tip * tip - gear.sign * 2.0 * base * module * shrink * _TIP_SUPPORT)


def _carried_to_tip(
    rho: Array, support: Array, self_compliance: Array, beyond_supports: Mask
) -> Array:
    """Self compliance at the nodes, beyond the supports as the parabola of the length."""
    tip = rho[-1] if support[0] > support[-1] else rho[0]
    scale = tip * tip - support[-1] ** 2
    curve = np.polyfit((tip * tip - support**2) / scale, self_compliance[rho.size :], 2)
    parabola = np.polyval(curve, (tip * tip - rho * rho) / scale)
    return np.where(beyond_supports, parabola, self_compliance[: rho.size])


#: Folders, relative to this one, and modules on which the numbers depend.
_SOURCES = (
    (".", "flank_load provider ring root_stress tooth_mesh"),
    ("../teeth", "tooth_bending tooth_compliance"),
    ("../../gear", "curves tooth_form"),
)


def fe2d_influence(
    gear: SpurGear,
    material: Material,
    *,
    reference: str = "bore",
    neighbours: int = 3,
    cache: bool = True,
    size: MeshSize | None = None,
) -> GearInfluence:
    """Influence of one gear from plane-stress finite elements of its whole ring.

    Parameters
    ----------
    gear, material : SpurGear, Material
        The gear and its material.
    reference : str
        ``"bore"``: the bore is held; ``"rim"``: the wind-up of the body is taken off.
    neighbours : int
        Number of neighbours on each side that are known, 1 or more; no more than there are.
    cache : bool
        Whether the result is read from and stored in the folder of
        :func:`tribodyn.stiffness.fe2d.provider.cache_folder`.
    size : MeshSize, optional
        Sizes of the elements.

    Raises
    ------
    InputError
        If the reference is unknown or is the bore of a gear without bore, the bore leaves hardly
        any rim, or ``neighbours`` is less than one.

    Notes
    -----
    Plane stress; quadratic quadrilaterals; the ring of all teeth, reduced without loss to one
    tooth by the discrete Fourier transform around it. The local compression
    ``2/(pi E) [ln(2h/a) - nu/2]`` of a narrow load of half width ``a`` is not part of the self
    compliance; ``h`` is the depth of :func:`tribodyn.stiffness.load_point`. From 0.07 modules
    before the corner of the tip on the self compliance is continued smoothly. A solid gear with
    the rim as reference is held along a seventh of its root radius. Source: Timoshenko and
    Goodier, Theory of Elasticity (half plane under a point load); Weber and Banaschek (1953), the
    split into structure and local compression.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02, bore_diameter=0.03)
    >>> influence = fe2d_influence(gear, Material(), cache=False)
    >>> bool(influence.between(0.02, 0.02, 1) < influence.at(0.02)), influence.neighbours
    (True, 3)
    """
    wind_up = wind_up_to_take_off(gear, material, reference)
    count = neighbour_count(gear, neighbours)
    unit = _unit(gear, material.poissons_ratio, count, size or MeshSize(), cache)
    self_compliance = unit.self_compliance / material.youngs_modulus - wind_up
    if not np.all(self_compliance > 0.0):
        raise InputError(_too_thin(gear))
    cross = unit.cross_compliance / material.youngs_modulus - wind_up
    return GearInfluence(unit.curvature_radius, self_compliance, cross)


def _too_thin(gear: SpurGear) -> Problem:
    rim = abs(gear.root_radius - held_radius(gear))
    return Problem(
        what=f"the bore of {gear.bore_diameter * 1e3:.4g} mm leaves a rim of {rim * 1e3:.3g} mm "
        "under the root circle",
        where="bore_diameter",
        why="The held bore lies so close to the lowest contacts that the local compression of the "
        "contact alone, which reaches to the middle of the tooth, is more than the whole "
        "deflection",
        remedy="Give a smaller bore",
    )


def neighbour_count(gear: SpurGear, wanted: int) -> int:
    """Number of neighbours on each side, no more than there are."""
    if wanted < 1:
        why, remedy = "Teeth in contact at the same time move one another", "Give 1 or more"
        raise InputError(f"neighbours = {wanted}", Argument("neighbours"), why, remedy)
    return max(min(wanted, (abs(gear.teeth) - 1) // 2), 1)


def _unit(
    gear: SpurGear, poissons_ratio: float, neighbours: int, size: MeshSize, cache: bool
) -> UnitCompliances:
    compute = partial(unit_compliances, gear, poissons_ratio, neighbours, size)
    name = _file_name(gear, poissons_ratio, neighbours, size)
    shapes = [(NODES,), (NODES,), (neighbours, NODES, NODES)]

    def fits(unit: UnitCompliances) -> bool:
        return [rows.shape for rows in unit] == shapes

    return looked_up(UnitCompliances, name, compute, fits) if cache else compute()


def _file_name(gear: SpurGear, poissons_ratio: float, neighbours: int, size: MeshSize) -> str:
    """Hash of everything that the compliances for a Young's modulus of one depend on."""
    form = (
        gear.teeth,
        gear.normal_module,
        gear.normal_pressure_angle,
        gear.profile_shift_coefficient,
        gear.tip_diameter,
        gear.tooth_thinning,
        gear.rack,
        gear.helix_angle,
        held_radius(gear),
    )
    text = repr((form, poissons_ratio, neighbours, size, _digest()))
    return hashlib.sha256(text.encode()).hexdigest()


def digest_of(module: str, sources: Sequence[tuple[str, str]]) -> str:
    """Hash of modules by their folders, relative to that of the file of a module."""
    folder = Path(module).parent
    return "".join(source_digest(folder / part, names.split()) for part, names in sources)


_digest = remember(partial(digest_of, __file__, _SOURCES))


#: Environment variable that names another folder.
VARIABLE = "TRIBODYN_CACHE_DIR"


def cache_folder() -> Path:
    """Folder of the cached arrays, which need not exist."""
    override = os.environ.get(VARIABLE)
    if override:
        return Path(override)
    if sys.platform == "win32":
        local = os.environ.get("LOCALAPPDATA")
        return (Path(local) if local else Path.home() / "AppData" / "Local") / "tribodyn" / "Cache"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "tribodyn"
    shared = os.environ.get("XDG_CACHE_HOME")
    return (Path(shared) if shared else Path.home() / ".cache") / "tribodyn"


def looked_up(
    kind: type[Unit],
    name: str,
    compute: Callable[[], Unit],
    fits: Callable[[Unit], bool] = lambda unit: True,
    method: str = "fe2d",
) -> Unit:
    """Arrays from the folder, or computed and kept where it has none that fit."""
    arrays = load_arrays(name, method)
    if arrays is not None and set(arrays) == set(kind._fields):
        cached = kind._make(arrays[field] for field in kind._fields)
        if fits(cached) and all(np.all(np.isfinite(rows)) for rows in cached):
            return cached
    unit = compute()
    store_arrays(name, unit._asdict(), method)
    return unit


def load_arrays(name: str, method: str = "fe2d") -> dict[str, Array] | None:
    """Read cached arrays."""
    try:
        with np.load(_path(name, method), allow_pickle=False) as file:
            return {key: np.asarray(file[key], dtype=float) for key in file.files}
    except (OSError, ValueError, KeyError, EOFError, RuntimeError, zipfile.BadZipFile):
        return None


def store_arrays(name: str, arrays: Mapping[str, Array], method: str = "fe2d") -> bool:
    """Keep arrays, at once or not at all: another process never sees half a file."""
    path = _path(name, method)
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".part")
        with os.fdopen(handle, "wb") as file:
            np.savez(file, **dict(arrays))  # type: ignore[arg-type]
        os.replace(temporary, path)
    except (OSError, RuntimeError):
        if temporary is not None:
            Path(temporary).unlink(missing_ok=True)
        return False
    return True


def _path(name: str, method: str) -> Path:
    return cache_folder() / method / f"{name}.npz"
