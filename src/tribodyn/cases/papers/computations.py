"""Computations by name: each returns figures of a case in SI, to compare with printed ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from threading import Lock
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tribodyn.errors import collected
from tribodyn.model import Registry
from tribodyn.nomenclature import GEARS
from tribodyn.study.case.to_models import locate_errors, mesh_law_of, unused_lubricant
from tribodyn.study.mesh_inputs import contact_settings
from tribodyn.study.pipeline.assembly import geometry
from tribodyn.study.pipeline.preview import operating_figures
from tribodyn.study.pipeline.run import computed
from tribodyn.study.pipeline.tooth_contact import mesh_of
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.mesh.build import LoadedMesh
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.pipeline.result import PairResult

Figures = Mapping[str, float]
#: Takes a case, where mesh tables come from, and the arguments of the row.
Computation = Callable[..., Figures]
COMPUTATIONS: Registry[Computation] = Registry("computation")

#: Keys that do not affect loads and films of a mesh.
_AFTER = (
    *("friction.", "solver.", "losses.", "operation.torque_balance", "title", "origin"),
    *("gears.composite_roughness", *(f"gears.{gear}.roughness_" for gear in GEARS)),
)
#: Margin inside the path of contact [base pitches].
_INSIDE = 1e-9
_HARMONICS = 22
#: Neurons that the source found best for each of its networks.
_NEURONS = {"acceleration": 11, "mesh_force": 10}


def loads_of(case: PairCase) -> str:
    """Return the values that determine loads and films of a mesh, as text."""
    values = [(key, str(value)) for key, value in case.values() if not key.startswith(_AFTER)]
    return str([(k, v) for k, v in values if k[:9] != "dynamics." or k == "dynamics.mesh_law"])


class Meshes:
    """Mesh tables; cases that differ in friction and motion alone share their loads and films."""

    def __init__(self) -> None:
        self._loaded: dict[str, LoadedMesh] = {}
        self._locks: dict[str, Lock] = {}

    def loaded(self, case: PairCase) -> LoadedMesh:
        """Loads and films of a pair with computed teeth; threads wait for equal ones."""
        from tribodyn.mesh.build import loaded_mesh

        key, settings = loads_of(case), contact_settings(case)
        with self._locks.setdefault(key, Lock()):
            if key not in self._loaded:
                law = mesh_law_of(case) == "force-law"
                self._loaded[key] = loaded_mesh(
                    case.gear_pair, settings, case.operating_point, force_law=law
                )
        return self._loaded[key]

    def table(self, case: PairCase) -> MeshTable:
        """Mesh table of a case."""
        if case.spur_pair is None:
            return mesh_of(case)
        return self.loaded(case).table(contact_settings(case))


@COMPUTATIONS.register("check")
def _check(case: PairCase, meshes: Meshes) -> Figures:
    """Return numbers of the case, its geometry, operating point and oil; bodies of spur gears."""
    values = dict(case.values())
    numbers = {
        key: float(v)
        for key, v in values.items()
        if isinstance(v, int | float) and not isinstance(v, bool)
    }
    oil = operating_figures(case)
    if "oil_viscosity" in oil:
        oil["oil_kinematic_viscosity"] = oil["oil_viscosity"] / oil["oil_density"]
    turning = {
        "pinion_torque": case.pinion_torque,
        "wheel_torque": case.pinion_torque * case.gear_ratio,
        "pinion_speed": case.pinion_speed,
        "wheel_speed": case.pinion_speed / case.gear_ratio,
        "mesh_frequency": case.pinion_speed * case.gears.pinion.teeth / (2.0 * math.pi),
    }
    return {**numbers, **geometry(case), **oil, **turning, **_spur_pair(case)}


def _spur_pair(case: PairCase) -> dict[str, float]:
    """Solid bodies of spur gears, and their contact at the pitch point."""
    from tribodyn.contact import effective_modulus

    pair, steel = case.spur_pair, case.material_properties
    if pair is None:
        return {}
    bodies = {
        f"gears.{gear}.{key}": None for gear in GEARS for key in ("mass", "moment_of_inertia")
    }
    solid = geometry(case.replace(bodies))
    path = pair.pinion.base_radius * math.tan(pair.operating_pressure_angle)
    return {
        **{f"solid_{name}": solid[name] for name in solid if name.startswith(("mass", "moment"))},
        "effective_modulus": effective_modulus(steel, steel),
        "equivalent_radius_pitch_point": path * case.gear_ratio / (1.0 + case.gear_ratio),
    }


@COMPUTATIONS.register("mesh")
def _mesh(case: PairCase, meshes: Meshes) -> Figures:
    """Friction: mean, change over a mesh cycle, and at five places of the path of spur gears."""
    with locate_errors(case), collected():
        mesh = meshes.table(case)
    sums = np.abs(mesh.friction_sum)
    figures = {
        "mean_friction_coefficient": mesh.mean_friction_coefficient,
        "friction_variation": float(np.ptp(sums) / sums.mean()) if sums.any() else math.nan,
    }
    return figures | _friction_places(case, mesh)


def _friction_places(case: PairCase, mesh: MeshTable) -> dict[str, float]:
    """Friction of spur gears at both ends, in single contact, in the recess, at the pitch point."""
    if case.spur_pair is None:
        return {}
    ratio = case.spur_pair.transverse_contact_ratio
    ages = {
        "start": _INSIDE,
        "single": 0.5 * ratio,
        "double": 0.5 * (1.0 + ratio),
        "end": ratio - _INSIDE,
    }
    friction = {
        f"friction_{place}": float(mesh.at("friction_coefficient", age % 1.0)[int(age)])
        for place, age in ages.items()
    }
    at_pitch_point = mesh.at_pitch_point("friction_coefficient")
    friction["friction_pitch_point"] = math.nan if at_pitch_point is None else at_pitch_point
    return friction


@COMPUTATIONS.register("run")
def _run(case: PairCase, meshes: Meshes) -> Figures:
    """The summary of a run, and of both gears the acceleration in both directions together."""
    mesh_source = None if case.spur_pair is None else lambda: meshes.table(case)
    result = computed(case, mesh_source=mesh_source)
    multipliers = np.abs(result.response.floquet_multipliers)
    figures = result.summary()
    mode = figures.get("mesh_natural_frequency", math.nan)
    return {
        **figures,
        **_accelerations(result),
        "resonance_order": mode / figures["mesh_frequency"],
        "largest_multiplier": float(multipliers.max()) if multipliers.size else math.nan,
    }


def _accelerations(result: PairResult) -> dict[str, float]:
    from tribodyn.analysis import alternating_rms, mesh_harmonics
    from tribodyn.study.pipeline.response_series import centre_column, measured

    samples, figures = measured(result.response), dict[str, float]()
    for gear in GEARS:
        places = [centre_column(result.response.names, gear, letter) for letter in "xy"]
        columns = [place for place in places if place is not None]
        if len(columns) < len(places):
            continue
        signal = samples.acceleration[:, columns]
        figures[f"acceleration_{gear}"] = float(np.hypot(*alternating_rms(samples, signal)))
        harmonics = np.abs(mesh_harmonics(samples, signal, _HARMONICS))
        for order in (1, _HARMONICS):
            across, along = harmonics[order - 1]
            figures[f"acceleration_{gear}_harmonic_{order}"] = float(np.hypot(across, along))
            figures[f"acceleration_oloa_{gear}_harmonic_{order}"] = float(across)
            figures[f"acceleration_loa_{gear}_harmonic_{order}"] = float(along)
    return figures


@COMPUTATIONS.register("line-contact")
def _line_contact(
    case: PairCase, meshes: Meshes, *, torque: float, speed: float, source_domain: bool = False
) -> Figures:
    """Film of a pair with the full load at the pitch point, at a torque [N*m] and speed [rpm]."""
    from tribodyn.contact import effective_modulus
    from tribodyn.ehl import solve_line_contact

    operating_case = case.replace(
        {"operation.torque": torque, "operation.speed": speed * math.pi / 30.0}
    )
    geometry_figures = _check(operating_case, meshes)
    load = (
        operating_case.pinion_torque
        / operating_case.gear_pair.pinion.base_radius
        / geometry_figures["common_face_width"]
    )
    path = operating_case.gear_pair.pinion.base_radius * math.tan(
        geometry_figures["operating_pressure_angle"]
    )
    steel = operating_case.material_properties
    oil = operating_case.lubricant_properties or unused_lubricant()
    options: Tree = {"domain": (-2.5, 1.5), "inlet": "zero"} if source_domain else {}
    with collected():
        film = solve_line_contact(
            load,
            geometry_figures["equivalent_radius_pitch_point"],
            operating_case.pinion_speed * path,
            oil,
            effective_modulus(steel, steel),
            nodes=1025,
            **options,
        )
    rising = np.diff(film.pressure) > 0.0
    peaks = 1 + np.flatnonzero(rising[:-1] & ~rising[1:])
    return {
        "central_film": film.central_film,
        "minimum_film": film.minimum_film,
        "constriction": 1.0 - film.minimum_film / film.central_film,
        "hertz_pressure": film.hertz_pressure,
        "maxima": float(peaks.size),
        "spike_position": float(film.position[peaks[-1]] / film.half_width),
        "spike_height": float(film.pressure[peaks[-1]] / film.hertz_pressure),
        "spike_pressure": float(film.pressure[peaks[-1]]),
    }


@COMPUTATIONS.register("stability")
def _stability(
    case: PairCase, meshes: Meshes, *, over: str, between: list[str], points: int, steps: int
) -> Figures:
    """Return where along a key the motion loses period 1, and the step of that integration."""
    from tribodyn.study.studies.bifurcation import bifurcation

    first, last = between
    with collected():
        diagram = bifurcation(case, over, (first, last), points, steps=steps, cycles=32, keep=16)
    irregular = np.flatnonzero(diagram.period[0] != 1)
    onset = int(irregular[0]) if irregular.size else -1
    return {
        "last_regular": float(diagram.parameter[onset - 1]) if onset > 0 else math.nan,
        "first_irregular": float(diagram.parameter[onset]) if onset >= 0 else math.nan,
        "irregular": float(irregular.size),
        "step_number": float(diagram.step_number[onset]) if onset >= 0 else math.nan,
        "irregular_with_half_the_step": float(np.count_nonzero(diagram.refined_period != 1)),
    }


@COMPUTATIONS.register("rig")
def _rig(case: PairCase, meshes: Meshes, *, slave: str = "QJ 308") -> Figures:
    """Return the motor torque of a back-to-back rig."""
    from tribodyn.study.studies.losses import rig_power_flow

    bearings = {f"losses.{gear}.bearing": slave for gear in GEARS}
    with collected():
        flow = rig_power_flow(case, case.replace(bearings))
    return {"torque_loss": flow.motor_power / case.operation.speed}


@COMPUTATIONS.register("modes")
def _modes(case: PairCase, meshes: Meshes) -> Figures:
    """Return natural frequencies, and energy shares of the mode nearest the fifth mesh harmonic."""
    from tribodyn.dynamics import natural_modes
    from tribodyn.study.pipeline.assembly import whole_system

    with locate_errors(case), collected():
        mesh = meshes.table(case)
        modes = natural_modes(whole_system(case, mesh))
    nearest = int(np.argmin(np.abs(modes.frequency - 5.0 * mesh.mesh_frequency)))
    gears = [name.startswith(GEARS) for name in modes.names]
    return {
        "first_elastic": float(modes.frequency[modes.rigid]),
        "next_to_fifth_harmonic": float(modes.frequency[nearest]),
        "kinetic_share_of_gears": float(modes.kinetic_share[nearest, gears].sum()),
        "strain_share_of_mesh": float(modes.strain_share[nearest, -modes.contacts :].sum()),
    }


@COMPUTATIONS.register("networks")
def _networks(
    case: PairCase,
    meshes: Meshes,
    *,
    over: Literal["time", "cycle"],
    features: list[str],
    targets: list[str],
    trajectories: int = 100,
    moving_average: int = 1,
    starts: int = 1,
) -> Figures:
    """Errors of the networks of the source on its data set, and the rms that they predict."""
    from dataclasses import replace

    from tribodyn.study.uncertain.vibration_data import vibration_data
    from tribodyn.surrogate import BPNN_PL, train

    with collected():
        data = vibration_data(case, seed=1, over=over, trajectories=trajectories)
        data = data.where(data["time"] > 0.205) if over == "time" else data
        groups = "trajectory" if moving_average > 1 else ""
        figures = dict[str, float]()
        for target in targets:
            hidden = (_NEURONS[target],) * 2
            options: Any = {"moving_average": moving_average, "starts": starts}
            training = replace(BPNN_PL, hidden=hidden, **options)
            columns: Any = {"features": features, "targets": [target], "groups": groups}
            model = train(data, **columns, seed=1, training=training)
            figures |= {f"{target}_{key}": v for key, v in vars(model.errors[target]).items()}
            figures[f"predicted_{target}"] = float(np.std(model.predict(data.columns)[target]))
    return figures


@COMPUTATIONS.register("arithmetic")
def _arithmetic(
    case: PairCase, meshes: Meshes, *, first: float, second: float, level: float = 0.95
) -> Figures:
    """Return what follows from two printed numbers alone."""
    from scipy.stats import norm

    return {
        "error_over_first": abs(second - first) / first,
        "error_over_second": abs(second - first) / second,
        "change": second / first - 1.0,
        "product": first * second,
        "ratio": second / first,
        "before_reduction": first / (1.0 - second),
        "half_width_of_band": float(norm.ppf(0.5 + 0.5 * level)) * second,
        "deviation_of_outputs": math.sqrt(first / (1.0 - second)) if second < 1.0 else math.nan,
    }


@COMPUTATIONS.register("seal")
def _seal(case: PairCase, meshes: Meshes) -> Figures:
    """Factor of the loss of a seal over diameter squared and speed."""
    from tribodyn.losses import seal_loss

    return {"factor": float(seal_loss(0.03, 1400.0 * math.pi / 30.0)) / (30.0**2 * 1400.0)}


@COMPUTATIONS.register("xu")
def _xu(case: PairCase, meshes: Meshes) -> Figures:
    """Constants of the regression of Xu and Kahraman as published."""
    from tribodyn.friction.xu import CONSTANTS

    return {f"b{number}": value for number, value in enumerate(CONSTANTS, 1)}


def figures_of(
    name: str, case: PairCase, meshes: Meshes, arguments: Mapping[str, object]
) -> Figures:
    """Figures of a computation, those that are numbers."""
    figures = COMPUTATIONS[name](case, meshes, **arguments)
    return {key: float(value) for key, value in figures.items() if math.isfinite(value)}
