"""Load capacity of a mesh from computed fields: sharing, root stress, criteria point by point."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.errors import collected
from tribodyn.gear import FlankModification
from tribodyn.nomenclature import GEARS
from tribodyn.rating.root_elements import root_stress_by_elements
from tribodyn.rating.surface.micropitting import heated_film, local_film
from tribodyn.rating.surface.subsurface import subsurface_exposure

if TYPE_CHECKING:
    import xarray

    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.rating import MeshRating, RatedMesh


#: Load per face width at which perfect flanks share the load [N/m]: 200 times the load changes
#: their shares by 0.3 %, and one load serves all load cases.
_REFERENCE_LOAD = 3e5


def load_sharing_factor(case: PairCase, table: MeshTable) -> float:
    """Greatest load of a tooth pair over that of flanks without modification or deviation."""
    from tribodyn.mesh.build import teeth_under_load
    from tribodyn.mesh.face_lines import by_pair, slice_count
    from tribodyn.study.mesh_inputs import mesh_inputs

    inputs, bare = mesh_inputs(case), FlankModification()
    gears = {name: replace(getattr(case.gear_pair, name), modification=bare) for name in GEARS}
    with collected():
        pair = replace(case.gear_pair, **gears)
        torque = _REFERENCE_LOAD * pair.common_face_width * pair.pinion.base_radius
        if pair == case.gear_pair:
            torque = table.pinion_torque  # so that perfect flanks have the factor 1
        cycle, teeth = teeth_under_load(pair, inputs.settings, torque, None, None)
    slices = 1 if cycle.slices is None else slice_count(table)
    ideal = by_pair(teeth.shared_load().share, slices).sum(axis=2)
    ideal /= ideal.sum(axis=1, keepdims=True)  # without corners beyond the path of contact
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


#: Depths at which the exposure below a contact is looked for.
_DEPTHS = 60
#: Keys of pointwise safeties by the names of their maps.
POINTWISE = {
    "pitting_safety": "pitting_safety",
    "scuffing_safety": "scuffing_safety_flash",
    "micropitting_safety": "micropitting_safety",
    "micropitting_safety_a": "micropitting_safety_method_a",
}


def rating_maps(rating: MeshRating) -> xarray.Dataset | None:
    """Criteria at every place of path and face; None without computed teeth."""
    from xarray import Dataset

    mesh = rating.rated
    if mesh is None or (table := mesh.table) is None:
        return None
    with collected() as warnings:
        maps = _maps(rating, mesh, table)
    units = {"pressure": "Pa", "contact_temperature": "K"}
    named = {n: each.rename(n).assign_attrs(units=units.get(n, "1")) for n, each in maps.items()}
    listed = list(dict.fromkeys(map(str, warnings)))
    return Dataset(named, attrs={"warnings": listed} if listed else {})


def _maps(rating: MeshRating, mesh: RatedMesh, table: MeshTable) -> dict[str, xarray.DataArray]:
    factors, oil = rating.computed.factors, mesh.common["oil"]
    outer = factors["K_A"] * factors["K_gamma"] * factors["K_v"]
    maps = {"pressure": table.over_face("hertz_pressure") * outer**0.5}
    limit = min(gear.factors["sigma_HG"] for gear in rating.computed.gears.values())
    maps["pitting_safety"] = limit / maps["pressure"].where(maps["pressure"] > 0.0)
    roughness = sum(mesh.common[role].roughness_ra for role in GEARS) / len(GEARS)
    maps["specific_film_a"] = _film_of_method_a(rating, maps["pressure"]) / roughness
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
            maps["specific_film"] = film * outer**-0.13 / roughness
    if "lambda_GFP" in factors:
        for end in ("", "_a"):
            if (film := maps.get(f"specific_film{end}")) is not None:
                maps[f"micropitting_safety{end}"] = film / factors["lambda_GFP"]
    return maps


def _film_of_method_a(rating: MeshRating, pressure: xarray.DataArray) -> xarray.DataArray:
    """Film of ISO/TS 6336-22 where the flanks press, of the computed pressure: method A."""
    mesh, factors = rating.rated, rating.computed.factors
    assert mesh is not None
    assert mesh.table is not None
    modulus = effective_modulus(*(mesh.common[role].material for role in GEARS))
    names = ("equivalent_radius", "entrainment_speed", "sliding_speed")
    radius, *speeds = (mesh.table.over_face(name).values for name in names)
    constants = modulus, factors["mu_mGF"], factors["theta_MGF"]
    oil = mesh.common["oil"]
    _, film = local_film(oil, constants, pressure.values, radius, (speeds[0], speeds[1]))
    return pressure.copy(data=film).where(pressure > 0.0)


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


def exposures(rating: MeshRating) -> dict[str, dict[str, float]]:
    """Greatest exposure below flanks of gears whose material has a hardness profile, by role."""
    # At each place of the path the greatest pressure over the face, friction as the run has it.
    mesh, maps = rating.rated, rating.maps
    figures: dict[str, dict[str, float]] = {}
    if mesh is None or mesh.table is None or maps is None:
        return figures
    columns = [maps["pressure"], mesh.table.over_face("equivalent_radius"), 0.0 * maps["pressure"]]
    if "friction_coefficient" in maps:
        columns[2] = maps["friction_coefficient"]
    row = maps["pressure"].argmax("face_position")
    places = np.stack([maps["path"], *(each.isel(face_position=row) for each in columns)], axis=1)
    elastic = effective_modulus(*(mesh.common[role].material for role in GEARS))
    for role in GEARS:
        material = mesh.common[role].material
        if not material.hardness_profile:
            continue
        profiles = material.hardness_profile, material.residual_stress_profile or (0.0,)
        greatest = []
        for place, pressure, radius, friction in places[places[:, 1] > 0.0].tolist():
            width = 4.0 * pressure * radius / elastic
            depth = np.linspace(0.0, max(material.profile_depth[-1], 3.0 * width), _DEPTHS + 1)[1:]
            hardness, residual = (
                np.interp(depth, material.profile_depth[: len(each)], each) for each in profiles
            )
            exposed = subsurface_exposure(
                depth, hardness, pressure=pressure, width=width, friction=friction,
                residual_stress=residual, poissons_ratio=material.poissons_ratio,
            )  # fmt: skip
            greatest.append((*exposed.greatest, place))
        figures[role] = dict(zip(("exposure", "depth", "path"), max(greatest), strict=True))
    return figures


def wear_depths(rating: MeshRating) -> dict[str, float]:
    """Greatest depth of wear [m] after the required life, by role; empty without a coefficient."""
    from tribodyn.study.faults.wear import wear

    mesh = rating.rated
    data = None if mesh is None else mesh.case.rating
    if mesh is None or data is None or data.wear_coefficient is None:
        return {}
    life = mesh.common["required_life"]
    turns = mesh.operation[0] / (2.0 * np.pi) * life * mesh.meshes_per_turn[0]
    worn = wear(mesh.case, data.wear_coefficient, turns)
    return {role: float(getattr(worn, f"depth_{role}")[-1].max()) for role in GEARS}
