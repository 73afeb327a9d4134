"""Load capacity of a mesh from computed fields: sharing, root stress, criteria point by point."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import collected
from tribodyn.gear import FlankModification
from tribodyn.nomenclature import GEARS
from tribodyn.rating.root_elements import root_stress_by_elements
from tribodyn.rating.surface.micropitting import heated_film

if TYPE_CHECKING:
    import xarray

    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.rating import MeshRating, RatedMesh


def load_sharing_factor(case: Case, table: MeshTable) -> float:
    """Greatest load of a tooth pair over that of flanks without modification or deviation."""
    from tribodyn.mesh.build import teeth_under_load
    from tribodyn.mesh.face.lines import by_pair, slice_count
    from tribodyn.study.mesh_inputs import mesh_inputs

    inputs, bare = mesh_inputs(case), FlankModification()
    gears = {name: replace(getattr(case.gear_pair, name), modification=bare) for name in GEARS}
    with collected():
        pair = replace(case.gear_pair, **gears)
        cycle, teeth = teeth_under_load(pair, inputs.settings, table.pinion_torque, None, None)
    slices = 1 if cycle.slices is None else slice_count(table)
    ideal = by_pair(teeth.shared_load().share, slices).sum(axis=2)
    shares = by_pair(table.load_share, slice_count(table)).sum(axis=2)
    return max(float(shares.max() / ideal.max()), 1.0)


def root_stresses(rating: MeshRating) -> dict[str, dict[str, float]]:
    """Root stress by finite elements of both gears, at rest and along the motion, by role."""
    mesh = rating.rated
    if mesh is None or (table := mesh.table) is None:
        return {}
    outer = rating.computed.factors["K_A"] * rating.computed.factors["K_gamma"]
    # a table of whole pairs has the mean load of the face
    spread = rating.computed.factors["K_Fbeta"] if table.face_position is None else 1.0
    phase, force = mesh.motion() if mesh.motion is not None else (table.phase, 1.0)
    force, figures = np.broadcast_to(force, phase.shape), {}
    for role, standard in rating.standard.gears.items():
        nu = mesh.common[role].material.poissons_ratio
        root = root_stress_by_elements(mesh.case.gear_pair, role, table, nu)
        dynamic = root.under_force(phase, force * table.total_normal_force)
        assert root.greatest is not None
        assert dynamic is not None
        figures[role] = {
            "ratio": root.ratio,
            "static_stress": outer * spread * root.greatest,
            "dynamic_stress": outer * spread * dynamic,
            "bending_safety": standard.factors["sigma_FG"] / (outer * spread * dynamic),
        }
    return figures


#: Keys of pointwise safeties by the names of their maps.
POINTWISE = {
    "pitting_safety": "pitting_safety",
    "scuffing_safety": "scuffing_safety_flash",
    "micropitting_safety": "micropitting_safety",
}


def rating_maps(rating: MeshRating) -> xarray.Dataset | None:
    """Criteria at every place of path and face; None without computed teeth."""
    mesh = rating.rated
    if mesh is None or (table := mesh.table) is None:
        return None
    factors, oil = rating.computed.factors, mesh.common["oil"]
    outer = factors["K_A"] * factors["K_gamma"] * factors["K_v"]
    maps = {"pressure": table.over_face("hertz_pressure") * outer**0.5}
    limit = min(gear.factors["sigma_HG"] for gear in rating.computed.gears.values())
    maps["pitting_safety"] = limit / maps["pressure"].where(maps["pressure"] > 0.0)
    if table.flash_temperature is not None and table.friction_coefficient.any():
        flash = table.over_face("flash_temperature") * outer**0.75
        mates = 0.5 * (1.0 + max(mesh.meshes_per_turn))
        bulk = oil.temperature + 0.47 * oil.lubrication_factor * mates * float(flash.mean())
        maps["friction_coefficient"] = table.over_face("friction_coefficient")
        maps["contact_temperature"] = bulk + flash
        if "theta_S" in factors:
            margin = factors["theta_S"] - oil.temperature
            maps["scuffing_safety"] = margin / (maps["contact_temperature"] - oil.temperature)
        film = _film_between_heated_flanks(mesh, flash, factors["theta_MGF"])
        if film is not None:
            roughness = sum(mesh.common[role].roughness_ra for role in GEARS) / len(GEARS)
            maps["specific_film"] = film * outer**-0.13 / roughness
            if "lambda_GFP" in factors:
                maps["micropitting_safety"] = maps["specific_film"] / factors["lambda_GFP"]
    return _dataset(maps)


def _film_between_heated_flanks(
    mesh: RatedMesh, flash: xarray.DataArray, bulk: float
) -> xarray.DataArray | None:
    """Film of the run at a bulk temperature [K] and that of the contact; None without a film."""
    table = mesh.table
    assert table is not None
    column = "central_film" if table.minimum_film is None else "minimum_film"
    if getattr(table, column) is None:
        return None
    film = table.over_face(column)
    if table.film_model == "thermal":  # it has its heat
        return film
    oil, stated = mesh.common["oil"], mesh.case.lubricant
    temperature = oil.temperature if stated is None else stated.gear_temperature or oil.temperature
    return film * heated_film(oil, temperature, bulk + flash.values, bulk)


def _dataset(maps: dict[str, xarray.DataArray]) -> xarray.Dataset:
    from xarray import Dataset

    units = {"pressure": "Pa", "contact_temperature": "K"}
    named = {n: each.rename(n).assign_attrs(units=units.get(n, "1")) for n, each in maps.items()}
    return Dataset(named)


def least_safeties(maps: xarray.Dataset | None) -> dict[str, dict[str, float]]:
    """Least value of each pointwise safety and its place."""
    least: dict[str, dict[str, float]] = {}
    for name, key in POINTWISE.items():
        if maps is not None and name in maps:
            at = maps[name].where(np.isfinite(maps[name])).argmin(("face_position", "path"))
            value = maps[name].isel(at)
            least[key] = {
                "safety": float(value),
                **{str(n): float(c) for n, c in value.coords.items()},
            }
    return least
