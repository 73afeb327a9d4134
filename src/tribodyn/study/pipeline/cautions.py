"""Warnings about valid but unusual results: gear bodies, oil film, pressure, contact loss."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from tribodyn.ehl import film_load_share
from tribodyn.errors import ComputationError, ModelWarning, Problem, collected, warn
from tribodyn.study.case.hypoid import hypoid_warnings
from tribodyn.study.case.provenance import body, changed_keys, effective
from tribodyn.study.case.section import flat_keys
from tribodyn.study.case.to_models import gear_warnings
from tribodyn.study.pipeline.response_series import compression, first_touch, is_steady, measured
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.gear import MassProperties, SpurGear
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.case.pair import PairCase


#: Hertzian pressure above the strength of case-hardened steel [Pa].
_STEEL = 3e9
#: Ratio of relief to the deflection of a pair under the full load above which a warning is raised.
_RELIEVED = 3.0
#: Part of the contact ratio whose loss to modified flanks is reported.
_LOST_CONTACT = 0.1
#: Friction coefficient above which friction is the first suspect where a motion runs away.
_RUBS = 0.3
#: Remedy if the friction law ignores asperities.
_COUNT = 'Set friction.law = "mixed", which counts the asperities. '
#: Results of the film model that asperities do not change.
_FILMS = "Film and film stiffness are those"
#: Keys of a length, a shape, a place or a phase, and those of what has it.
_OWNERS: dict[str, tuple[str, ...]] = {
    **{
        f"{end}_{of}": (end,)
        for end in ("tip_relief", "root_relief", "end_relief")
        for of in ("length", "shape")
    },
    "relief_length": ("tip_relief", "root_relief"),
    "center": ("lengthwise_crowning", "profile_crowning", "bias"),
    "run_out_phase": ("run_out",),
    "profile_map_interpolation": ("profile_map",),
    "transmission_error_phase": ("transmission_error_amplitude",),
}
#: Keys that only the heat of a film needs.
_HEAT = "temperature_viscosity_coefficient", "thermal_conductivity", "specific_heat"
#: Rim under the root below which the body bends with the teeth [modules].
_RIM = 1.0
#: Ratio of a given mass or inertia to that of the solid gear, or its inverse, above which a warning
#: is raised: for values that the source of the case states for this gear, and for others.
_OF_SOURCE, _UNLIKELY = 3.0, 1.25
#: Inertias of a gear: key, display unit, and factor from SI to it.
_INERTIAS = (("mass", "kg", 1.0), ("moment_of_inertia", "kg*mm^2", 1e6))


class MeshWarning(NamedTuple):
    """Warning about a mesh of a machine."""

    mesh: str
    load: str  #: empty of the shape of the gears
    warning: ModelWarning


def warn_of_meshes(mesh_warnings: Iterable[MeshWarning]) -> None:
    """Warn of meshes, each reason once, greatest part of the load first, with all the meshes."""
    groups: dict[tuple[str, str], list[MeshWarning]] = {}
    for each in mesh_warnings:
        message = each.warning.message
        model = re.sub(r"[-+]?\d[\d.e+-]*", "#", message)
        if not each.load:
            model = message  # of one gear
        elif _part(each):
            model = message.partition(":")[0]
        groups.setdefault((each.warning.code, model), []).append(each)
    for (code, _), group in groups.items():
        first, *others = sorted(group, key=_part, reverse=True)
        places = [
            _place(each) + (f" ({_part(each):.0%})" if _part(each) else "") for each in others
        ]
        text = f"{_place(first)}: {first.warning.message}"
        same = f". The same in {'; '.join(dict.fromkeys(places))}." if places else ""
        warn(code, text.removesuffix(".") + same if same else text)


def _place(mesh_warning: MeshWarning) -> str:
    return ", ".join(filter(None, (f"mesh {mesh_warning.mesh}", mesh_warning.load)))


def _part(mesh_warning: MeshWarning) -> float:
    """Part of the load that a warning concerns; zero where it does not say."""
    part = mesh_warning.warning.affected
    return part if isinstance(part, float) else 0.0


def case_cautions(case: PairCase, machine: Case | None = None) -> tuple[ModelWarning, ...]:
    """Return warnings about the gears of a case, or of a pair of a machine, before a run."""
    if case.hypoid_flanks is not None:
        return hypoid_warnings(case.gears)
    if case.spur_pair is None:
        return ()
    tables = ("gears", "dynamics", "material", "stiffness", "film")
    return case._once("cautions", tables, lambda: _of_gears(case, machine or case))


def _of_gears(case: PairCase, source_case: Case) -> tuple[ModelWarning, ...]:
    pair = case.gear_pair
    warnings = list(gear_warnings(case.gears, case.dynamics.backlash))
    for name, gear in pair.gears.items():
        warnings += [
            *_rim(case, name, gear),
            *_mass(case, source_case, name, gear),
            *_other_gear(case, source_case, name, gear),
        ]
    return (*warnings, *_starved(case))


def _starved(case: PairCase) -> Iterator[ModelWarning]:
    if case.film.inlet == "zero" and case.film.domain is not None:
        yield ModelWarning(
            "starved-inlet",
            f"the oil of every contact begins {-case.film.domain[0]:g} Hertzian half widths before "
            "its centre: a starved contact, whose film may rise with the load and is thinner than "
            'a flooded one, which film.inlet = "flooded" gives',
        )


def _rim(case: PairCase, name: str, gear: SpurGear) -> Iterator[ModelWarning]:
    rim = gear.root_radius - 0.5 * gear.bore_diameter
    if (
        effective(case)["stiffness.reference"] == "bore"
        and gear.bore_diameter > 0.0
        and rim < _RIM * gear.normal_module
    ):
        yield ModelWarning(
            "thin-rim",
            f"{name}: the body under the root is {rim * 1e3:.4g} mm thick, less than one module of "
            f"{gear.normal_module * 1e3:.4g} mm; such a ring bends as a body, which the stiffness "
            'model ignores. Reduce the bore, or set stiffness.reference = "rim"',
        )


@lru_cache(maxsize=16)
def _solid(gear: SpurGear, density: float) -> MassProperties:
    from tribodyn.gear import mass_properties

    with collected():  # The warnings about the shape have been raised.
        bare = replace(gear, mass=None, moment_of_inertia=None)
        return mass_properties(bare, density)


def _other_gear(
    case: PairCase, source_case: Case, name: str, gear: SpurGear
) -> Iterator[ModelWarning]:
    """Warn of a given mass that was not adapted to the changed shape of its gear."""
    changed, base = changed_keys(source_case), source_case.stated.base
    of_shape = {case.source.key(key) for key in body(name)}
    shape = [key for key in changed if key in of_shape]
    for key, unit, factor in _INERTIAS:
        full, value = case.source.key(f"gears.{name}.{key}"), getattr(gear, key)
        if not shape or value is None or base.get(full) is None or full in changed:
            continue
        reference = getattr(_solid(gear, case.density(name)), key)
        yield ModelWarning(
            "mass-of-other-gear",
            f"{name}: {key} = {value * factor:.4g} {unit} is that of the gear before "
            f"{', '.join(shape)} changed; the solid gear now has {reference * factor:.4g} {unit}. "
            f"Give that of this gear, or leave {key} out for the solid one",
        )


def _mass(case: PairCase, source_case: Case, name: str, gear: SpurGear) -> Iterator[ModelWarning]:
    """Compare given inertias with those of the solid: a wrong unit is far off."""
    solid = _solid(gear, case.density(name))
    for key, unit, factor in _INERTIAS:
        value, reference = getattr(gear, key), getattr(solid, key)
        most = _OF_SOURCE if _is_stated(case, source_case, name, key) else _UNLIKELY
        if value is not None and not 1.0 / most <= value / reference <= most:
            yield ModelWarning(
                "mass-unlikely",
                f"{name}: {key} = {value * factor:.4g} {unit}, {value / reference:.3g} times that "
                f"of the solid gear, {reference * factor:.4g} {unit}. Check unit and value; a web "
                f"or a hub explain a difference. Leave {key} out for the solid gear",
            )


def _is_stated(case: PairCase, source_case: Case, name: str, key: str) -> bool:
    """Whether the document that the case began with states the value, for a gear of this shape."""
    changed, base = changed_keys(source_case), source_case.stated.base
    full, *shape = map(case.source.key, (f"gears.{name}.{key}", *body(name)))
    stated = base.get("origin") and base.get(full) is not None
    return bool(stated) and not any(k in changed for k in (full, *shape))


def mesh_cautions(mesh: MeshTable) -> tuple[ModelWarning, ...]:
    """Return warnings about excessive load, and about films that do not separate the flanks."""
    return (*load_cautions(mesh), *_mixed(mesh))


def load_cautions(mesh: MeshTable, contact_ratio: float | None = None) -> tuple[ModelWarning, ...]:
    """Return warnings about the load; a coarse mesh table needs the contact ratio under load."""
    ratio = mesh.contact_ratio_under_load if contact_ratio is None else contact_ratio
    return (*_pressure(mesh), *_relieved(mesh), *_parted(mesh, ratio))


@contextmanager
def friction_suspected(meshes: Iterable[MeshTable]) -> Iterator[None]:
    """Name an implausibly high friction first if the motion inside the block fails."""
    try:
        yield
    except ComputationError as error:
        coefficients = [float(np.nanmax(m.friction_coefficient, initial=0.0)) for m in meshes]
        greatest = max(coefficients, default=0.0)
        if greatest <= _RUBS:
            raise
        suspect = Problem(
            f"the friction coefficient reaches {greatest:.3g}",
            "friction.law",
            "Lubricated steel hardly exceeds 0.2, and such friction can make the motion unstable",
            "Check roughness and speed, or choose another friction law",
        )
        raise ComputationError([suspect, *error.problems]) from None


class FrictionRange(Protocol):
    """Friction of teeth that is known up to a limit of their load."""

    @property
    def load(self) -> float:
        """Nominal load [N]."""

    @property
    def limit(self) -> float:
        """Highest load over the nominal one."""


def friction_cautions(friction: FrictionRange | None, force: Array) -> tuple[ModelWarning, ...]:
    """Warn of tooth loads beyond the range of the friction table."""
    if friction is None:
        return ()
    most = float(np.abs(force).max()) / friction.load
    if most <= friction.limit:
        return ()
    return (
        ModelWarning(
            "friction-load",
            f"the teeth carry up to {most:.3g} times their nominal load of {friction.load:.4g} N. "
            f"Friction is tabulated up to {friction.limit:g} times: above, its coefficient stays "
            "constant",
        ),
    )


def tension_cautions(force: Array, *, linear: bool) -> tuple[ModelWarning, ...]:
    """Warn of tension in a mesh without backlash, where real flanks would separate."""
    least = float(force.min())
    if least >= -1e-9 * float(force.max()):
        return ()
    consequence = "makes the mesh linear" if linear else "lets the back flanks push at once"
    message = (
        f"backlash 0 {consequence}, and its force falls to {least:.4g} N: real flanks "
        "part below 0 N. Give dynamics.backlash, for example 0.05 mm"
    )
    return (ModelWarning("mesh-tension", message),)


def _relieved(mesh: MeshTable) -> Iterator[ModelWarning]:
    """Warn of a relief far beyond the deflection of a loaded tooth: it reduces the contact."""
    if mesh.gears is None or not mesh.gear_pair.has_profile_modification:
        return
    amount, name, end = max(
        (getattr(gear.modification, end), name, end)
        for name, gear in mesh.gear_pair.gears.items()
        for end in ("tip_relief", "root_relief")
    )
    deflection = mesh.total_normal_force / mesh.maximum_single_pair_stiffness
    if amount > _RELIEVED * deflection:
        pairs = float(mesh.grid.mean((mesh.load_per_width > 0.0).sum(axis=1).astype(float)))
        yield ModelWarning(
            "relief-large",
            f"{end} = {1e6 * amount:.4g} um of the {name} is {amount / deflection:.3g} times the "
            f"{1e6 * deflection:.3g} um by which a pair deflects under the full load: "
            f"{pairs:.3g} tooth pairs carry on average instead of "
            f"{mesh.transverse_contact_ratio:.3g}. Usual is about once this deflection; check the "
            "unit",
        )


def _parted(mesh: MeshTable, under_load: float) -> Iterator[ModelWarning]:
    """Warn of modified profiles that separate pairs for much of their path under this load."""
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
            f"the Hertzian pressure reaches {greatest * 1e-9:.4g} GPa; gear steel withstands no "
            f"more than {_STEEL * 1e-9:g} GPa. Check torque and face width",
        )


def _mixed(mesh: MeshTable) -> Iterator[ModelWarning]:
    """Warn of films below the roughness: the models assume that they carry the full load."""
    if mesh.film_ratio is None:
        return
    least = float(np.fmin.reduce(mesh.film_ratio[mesh.in_contact], initial=np.inf))
    if least < 1.0:
        from tribodyn.mesh.film.film_columns import judged

        counted, share = _counts_asperities(mesh), float(film_load_share(least))
        if mesh.film_load_share is not None:
            heavy = judged(mesh.load_per_width.ravel()).reshape(mesh.in_contact.shape)
            film_share = float(np.nanmin(mesh.film_load_share[heavy]))
            share = film_share if counted else min(film_share, share)
        films = "The film is that" if mesh.film_stiffness is None else _FILMS
        yield ModelWarning(
            "mixed-lubrication",
            f"the film ratio falls to {least:.3g}: below 1 asperities touch; they carry up to "
            f"{1.0 - share:.0%} of the load. {films} of smooth flanks "
            f"under the full load{'' if counted else ', and so is the friction'}. "
            f"{'' if counted else _COUNT}A thicker oil, smoother flanks or more speed separates "
            "them",
        )


def _counts_asperities(mesh: MeshTable) -> bool:
    """Whether the friction law of a mesh has a part for asperities."""
    from tribodyn.friction import LAWS

    split = mesh.asperity_friction_coefficient is not None
    return split or (mesh.friction_law in LAWS and LAWS[mesh.friction_law].asperities)


def motion_cautions(case: PairCase, system: System, response: Response) -> tuple[ModelWarning, ...]:
    """Warn of loss of contact in a steady motion."""
    if case.backlash == 0.0 or not is_steady(response):
        return ()
    samples = response.fine  # all of them, as the motion is steady
    deflection, touch = compression(samples), first_touch(system, samples)
    share = float(measured(response).mean((deflection <= touch).astype(float)))
    back, damped = bool(np.any(deflection < -touch)), case.dynamics.damping_in_gap
    return contact_cautions(share, touches_back=back, damped=damped)


def contact_cautions(share: float, *, touches_back: bool, damped: bool) -> tuple[ModelWarning, ...]:
    """Warn of loss of contact for a part of the mesh cycle, and of damping that has no gap."""
    if not share:
        message = "damping_in_gap has no effect: the flanks stay in touch in this motion"
        return (ModelWarning("closed-gap", message),) if damped else ()
    back = "the back flanks touch as well" if touches_back else "no back flank touches"
    message = (
        f"the flanks lose contact for {share:.3g} of the mesh cycle; {back}. More load or damping "
        "prevents this; other steady motions may exist as well"
    )
    return (ModelWarning("contact-loss", message),)


def _is_overhang(case: PairCase, key: str, other_use: object) -> bool:
    """Whether a face width is that of the wider one of two plain straight gears."""
    pair, gear = case.spur_pair, key.split(".")[1]
    if pair is None or pair.pinion.helix_angle or other_use or pair.has_profile_modification:
        return False
    return bool(pair.gears[gear].face_width > min(each.face_width for each in pair.gears.values()))


def idle_values(case: PairCase) -> Iterator[tuple[str, str]]:
    """Keys that a case gives and that have no effect because of its other values, and why."""
    film, friction, oil, gears = case.film, case.friction, case.lubricant, case.gears
    other_use = case.rating or case.losses or getattr(oil, "heat_transfer", None)
    crossed = gears.kind == "hypoid"
    dry = film.model == "none" and friction.law in ("none", "constant")
    dry = dry and not (crossed or other_use)  # crossed flanks have the film of their ellipses
    warm = (
        getattr(film.chosen, "heated", False)
        or friction.inlet_heating
        or friction.flash_temperature
    )
    stiff = crossed and gears.stiffness_model != "fe3d"
    weighed = [n for n, g in gears.by_name.items() if None not in (g.mass, g.moment_of_inertia)]
    for key, _ in flat_keys({k: v for k, v in case.data.items() if k != "assumed"}):
        table, _, name = key.rpartition(".")
        owners = _OWNERS.get(name, ())
        if owners and not any(case.get(f"{table}.{owner}") for owner in owners):
            yield key, f"there is no {' and no '.join(owners)}"
        elif name == "thickness_factor" and stiff:
            yield key, 'stiffness_model is "line", which does not know the thickness of the teeth'
        elif name == "outer_backlash" and stiff and case.dynamics.backlash is not None:
            yield key, "dynamics.backlash is given"
        elif key == "material.density" and crossed and len(weighed) == len(gears.by_name):
            yield key, "both gears have mass and moment_of_inertia"
        elif key in map("gears.{}.face_width".format, weighed) and _is_overhang(
            case, key, other_use
        ):
            yield key, "its mate is narrower, and mass and moment_of_inertia are given"
        elif name == "damping_in_gap" and case.backlash == 0.0:
            yield key, "the flanks never part without backlash"
        elif name in _HEAT and not warm and not (table == "lubricant" and other_use):
            yield key, "neither film nor friction is heated"
        elif name == "hand" and case.spur_pair is not None and not case.gears.helix_angle:
            yield key, "the teeth are straight"
        elif key == "solver.coupling_tolerance" and case.solver.coupling == "none":
            yield key, "solver.coupling is none"
        elif dry and (table == "lubricant" or "roughness" in name):
            yield key, "neither film nor friction is computed of it"


def teeth_cautions(case: PairCase) -> tuple[ModelWarning, ...]:
    """Warn that the motion ignores deviations from tooth to tooth."""
    if case.spur_pair is None or not case.spur_pair.teeth_differ:
        return ()
    message = (
        "pitch deviations and run-out differ from tooth to tooth: the static transmission error "
        "covers all teeth, the motion repeats with every mesh cycle and ignores them"
    )
    return (ModelWarning("teeth-alike", message),)
