"""What runs but deserves a second look: gear bodies, oil film, pressure and contact loss."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.ehl import film_load_share
from tribodyn.errors import ComputationError, ModelWarning, Problem, collected
from tribodyn.study.case.derive import gear_warnings
from tribodyn.study.case.hypoid import hypoid_warnings
from tribodyn.study.case.provenance import body, changed_keys, effective
from tribodyn.study.pipeline.series import compression, first_touch, is_steady, measured, mesh_force

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.gear import MassProperties, SpurGear
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case.case import Case


#: Hertzian pressure that case-hardened steel does not survive [Pa].
_STEEL = 3e9
#: Relief over the deflection of one pair under the whole load that is told.
_RELIEVED = 3.0
#: Part of the contact ratio whose loss to modified flanks is reported.
_LOST_CONTACT = 0.1
#: Friction coefficient above which friction is the first suspect where a motion runs away.
_RUBS = 0.3
#: What to do about asperities that the friction law does not count.
_COUNT = 'Set friction.law = "mixed", which counts the asperities. '
#: What asperities leave as it is, where the film model tells of a stiffness.
_FILMS = "Film and film stiffness are those"
#: Rim under the root below which the body bends with the teeth [modules].
_RIM = 1.0
#: Ratio of a given mass or inertia to that of the solid, or the inverse, that is told: of a value
#: that the document behind the case states for this gear, and of any other.
_OF_SOURCE, _UNLIKELY = 3.0, 1.25
#: What a gear weighs: key, unit shown, and how many of it make the SI unit.
_INERTIAS = (("mass", "kg", 1.0), ("moment_of_inertia", "kg*mm^2", 1e6))


def case_cautions(case: Case) -> tuple[ModelWarning, ...]:
    """Find what is odd about the gears of a case, before anything is computed."""
    if case.gears.kind == "hypoid":
        return hypoid_warnings(case.gears)
    if case.gears.kind == "table":
        return ()
    tables = ("gears", "dynamics", "material", "stiffness", "film")
    return case._once("cautions", tables, lambda: _of_gears(case))


def _of_gears(case: Case) -> tuple[ModelWarning, ...]:
    pair = case.gear_pair
    found = list(gear_warnings(case.gears, case.dynamics.backlash))
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        found += [*_rim(case, name, gear), *_mass(case, name, gear), *_other_gear(case, name, gear)]
    return (*found, *_starved(case))


def _starved(case: Case) -> Iterator[ModelWarning]:
    if case.film.inlet == "zero" and case.film.domain is not None:
        yield ModelWarning(
            "starved-inlet",
            f"the oil of every contact begins {-case.film.domain[0]:g} Hertzian half widths before "
            "its centre: a starved contact, whose film may rise with the load and is thinner than "
            'a flooded one, which film.inlet = "flooded" gives',
        )


def _rim(case: Case, name: str, gear: SpurGear) -> Iterator[ModelWarning]:
    rim = gear.root_radius - 0.5 * gear.bore_diameter
    if (
        effective(case)["stiffness.reference"] == "bore"
        and gear.bore_diameter > 0.0
        and rim < _RIM * gear.normal_module
    ):
        yield ModelWarning(
            "thin-rim",
            f"{name}: the body under the root is {rim * 1e3:.4g} mm thick, less than one module of "
            f"{gear.normal_module * 1e3:.4g} mm; such a ring bends as a whole, which the stiffness "
            'model does not know. Reduce the bore, or set stiffness.reference = "rim"',
        )


@lru_cache(maxsize=16)
def _solid(gear: SpurGear, density: float) -> MassProperties:
    from tribodyn.gear import mass_properties

    with collected():  # What is odd about the shape has been said.
        bare = replace(gear, mass=None, moment_of_inertia=None)
        return mass_properties(bare, density)


def _other_gear(case: Case, name: str, gear: SpurGear) -> Iterator[ModelWarning]:
    """A mass that stayed what it was while the shape of its gear has changed."""
    changed, base = changed_keys(case), case.stated.base
    shape = [key for key in changed if key in body(name)]
    for key, unit, factor in _INERTIAS:
        full, given = f"gears.{name}.{key}", getattr(gear, key)
        if not shape or given is None or base.get(full) is None or full in changed:
            continue
        own = getattr(_solid(gear, case.density(name)), key)
        yield ModelWarning(
            "mass-of-other-gear",
            f"{name}: {key} = {given * factor:.4g} {unit} is that of the gear before "
            f"{', '.join(shape)} changed; the solid gear now has {own * factor:.4g} {unit}. Give "
            f"that of this gear, or leave {key} out for the solid one",
        )


def _mass(case: Case, name: str, gear: SpurGear) -> Iterator[ModelWarning]:
    """Compare given inertias with those of the solid: a wrong unit is far off."""
    solid = _solid(gear, case.density(name))
    for key, unit, factor in _INERTIAS:
        given, own = getattr(gear, key), getattr(solid, key)
        most = _OF_SOURCE if _is_stated(case, name, key) else _UNLIKELY
        if given is not None and not 1.0 / most <= given / own <= most:
            yield ModelWarning(
                "mass-unlikely",
                f"{name}: {key} = {given * factor:.4g} {unit}, {given / own:.3g} times that of the "
                f"solid gear, {own * factor:.4g} {unit}. Check unit and value; a web or a hub "
                f"explain a difference. Leave {key} out for the solid gear",
            )


def _is_stated(case: Case, name: str, key: str) -> bool:
    """Whether the document that the case began with states the value, for a gear of this shape."""
    changed = changed_keys(case)
    full = f"gears.{name}.{key}"
    stated = case.stated.base.get("origin") and case.stated.base.get(full) is not None
    return bool(stated) and not any(k in changed for k in (full, *body(name)))


def mesh_cautions(mesh: MeshTable) -> tuple[ModelWarning, ...]:
    """Find a load that no gear stands, and flanks that the film does not keep apart."""
    return (*load_cautions(mesh), *_mixed(mesh))


def load_cautions(mesh: MeshTable, contact_ratio: float | None = None) -> tuple[ModelWarning, ...]:
    """The same of the load alone; a mesh with few knots needs the contact ratio under load."""
    ratio = mesh.contact_ratio_under_load if contact_ratio is None else contact_ratio
    return (*_pressure(mesh), *_relieved(mesh), *_parted(mesh, ratio))


@contextmanager
def friction_suspected(mesh: MeshTable) -> Iterator[None]:
    """Name friction that no lubricated tooth has before any other cause of a motion that fails."""
    try:
        yield
    except ComputationError as error:
        greatest = float(np.nanmax(mesh.friction_coefficient, initial=0.0))
        if greatest <= _RUBS:
            raise
        suspect = Problem(
            f"the friction coefficient reaches {greatest:.3g}",
            "friction.law",
            "Lubricated steel hardly exceeds 0.2, and such friction can drive the motion by itself",
            "Check roughness and speed, or choose another friction law",
        )
        raise ComputationError([suspect, *error.problems]) from None


def friction_cautions(
    friction: MeshFriction | None, response: Response
) -> tuple[ModelWarning, ...]:
    """Find loads of the teeth beyond those for which friction is known."""
    if friction is None:
        return ()
    force = np.abs(mesh_force(measured(response)))
    most = float(force.max()) / friction.load
    if most <= friction.limit:
        return ()
    return (
        ModelWarning(
            "friction-load",
            f"the teeth carry up to {most:.3g} times their nominal load of {friction.load:.4g} N. "
            f"Friction is known up to {friction.limit:g} times: above, its coefficient is kept",
        ),
    )


def _relieved(mesh: MeshTable) -> Iterator[ModelWarning]:
    """Relief far beyond what a loaded tooth gives way takes pairs out of contact."""
    if mesh.gears is None or not mesh.gear_pair.has_profile_modification:
        return
    gears = {"pinion": mesh.gear_pair.pinion, "wheel": mesh.gear_pair.wheel}
    amount, name, end = max(
        (getattr(gear.modification, end), name, end)
        for name, gear in gears.items()
        for end in ("tip_relief", "root_relief")
    )
    given_way = mesh.total_normal_force / mesh.maximum_single_pair_stiffness
    if amount > _RELIEVED * given_way:
        pairs = float(mesh.grid.mean((mesh.load_per_width > 0.0).sum(axis=1).astype(float)))
        yield ModelWarning(
            "relief-large",
            f"{end} = {1e6 * amount:.4g} um of the {name} is {amount / given_way:.3g} times the "
            f"{1e6 * given_way:.3g} um by which a pair gives way under the whole load: "
            f"{pairs:.3g} tooth pairs carry on average instead of "
            f"{mesh.transverse_contact_ratio:.3g}. Usual is about once this deflection; check the "
            "unit",
        )


def _parted(mesh: MeshTable, under_load: float) -> Iterator[ModelWarning]:
    """Modified profiles that keep pairs apart for much of their path under this load."""
    if mesh.gears is None or not mesh.gear_pair.has_profile_modification:
        return
    ratio = mesh.transverse_contact_ratio
    if under_load >= (1.0 - _LOST_CONTACT) * ratio:
        return
    yield ModelWarning(
        "contact-ratio-reduced",
        f"under this load {under_load:.3g} tooth pairs carry on average, and the transverse "
        f"contact ratio is {ratio:.3g}: modified flanks take off "
        f"{100.0 * (1.0 - under_load / ratio):.2g} % "
        f"of it (limit {100.0 * _LOST_CONTACT:g} %). A pair begins to carry after A and ceases "
        "before E. Shorten or reduce the relief, or give the load for which it was made; tribodyn "
        "relief finds one for a range of loads",
    )


def _pressure(mesh: MeshTable) -> Iterator[ModelWarning]:
    greatest = float(mesh.hertz_pressure.max())
    if greatest > _STEEL:
        yield ModelWarning(
            "hertz-pressure",
            f"the Hertzian pressure reaches {greatest * 1e-9:.4g} GPa; gear steel stands no more "
            f"than {_STEEL * 1e-9:g} GPa. Check torque and face width",
        )


def _mixed(mesh: MeshTable) -> Iterator[ModelWarning]:
    """A film below the roughness carries only a part of the load; the models give it the whole."""
    if mesh.film_ratio is None:
        return
    least = float(np.nanmin(mesh.film_ratio[mesh.in_contact]))
    if least < 1.0:
        from tribodyn.mesh.film.film_columns import judged

        counted, share = _counts_asperities(mesh), float(film_load_share(least))
        if mesh.film_load_share is not None:
            heavy = judged(mesh.load_per_width.ravel()).reshape(mesh.in_contact.shape)
            known = float(np.nanmin(mesh.film_load_share[heavy]))
            share = known if counted else min(known, share)
        films = "The film is that" if mesh.film_stiffness is None else _FILMS
        yield ModelWarning(
            "mixed-lubrication",
            f"the film ratio falls to {least:.3g}: below 1 asperities touch; they carry up to "
            f"{1.0 - share:.0%} of the load. {films} of smooth flanks "
            f"under the whole of it{'' if counted else ', and so is the friction'}. "
            f"{'' if counted else _COUNT}A thicker oil, smoother flanks or more speed part them",
        )


def _counts_asperities(mesh: MeshTable) -> bool:
    """Whether the friction law of a mesh has a part for asperities."""
    from tribodyn.friction import LAWS

    split = mesh.asperity_friction_coefficient is not None
    return split or (mesh.friction_law in LAWS and LAWS[mesh.friction_law].asperities)


def motion_cautions(case: Case, system: System, response: Response) -> tuple[ModelWarning, ...]:
    """Find flanks that part in a steady motion."""
    if case.backlash == 0.0 or not is_steady(response):
        return ()
    samples = response.fine  # all of them, as the motion is steady
    deflection, touch = compression(samples), first_touch(system, samples)
    apart = deflection <= touch
    if not apart.any():
        return ()
    share = float(measured(response).mean(apart.astype(float)))
    back = "the back flanks touch as well" if np.any(deflection < -touch) else ""
    message = (
        f"the flanks are apart for {share:.3g} of the mesh cycle; "
        f"{back or 'no back flank touches'}. More load or damping "
        "keeps them together; other steady motions may exist beside this one"
    )
    return (ModelWarning("contact-loss", message),)


def teeth_cautions(case: Case) -> tuple[ModelWarning, ...]:
    """Say what the motion leaves out where teeth differ from each other."""
    if case.gears.kind != "spur" or not case.gear_pair.teeth_differ:
        return ()
    message = (
        "pitch deviations and run-out differ from tooth to tooth: the static transmission error "
        "runs over all teeth, the motion repeats with every mesh cycle and leaves them out"
    )
    return (ModelWarning("teeth-alike", message),)
