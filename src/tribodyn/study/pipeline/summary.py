"""Summary figures of a result: their computation from mesh and motion."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.nomenclature import GEARS
from tribodyn.study.pipeline.assembly import geometry, static_error
from tribodyn.study.pipeline.preview import load_figures, mode_figures, operating_figures
from tribodyn.study.pipeline.response_series import (
    centre_column,
    compression,
    directions_of,
    first_touch,
    friction_forces,
    is_steady,
    measured,
    mesh_force,
    one_sided_phase,
    support_forces,
    tooth_force,
    transmission_error,
)
from tribodyn.study.pipeline.summary_figures import MEASURES, SUMMARY
from tribodyn.types import Array, ByName, Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import FineSamples
    from tribodyn.mesh import MeshTable
    from tribodyn.study.pipeline.result import PairResult


#: Mesh harmonics of transmission errors among the figures.
HARMONICS = 5


def summarize(result: PairResult) -> dict[str, float]:
    """Compute all figures of a result."""
    moving = _motion_figures(result, measured(result.response))
    values: Tree = {
        **geometry(result.case),
        **operating_figures(result.case),
        **mesh_figures(result.mesh),
        **_static_error_figures(result),
        "mesh_damping": result.damping.mesh,
        **moving,
        **_line_of_action(moving),
        **_hypoid_figures(result, "mean_mesh_force_x" in moving),
        **_comparison(result),
        **mode_figures(result.system, result.mesh.mesh_frequency, result.case.pinion_speed),
    }
    if centre_column(result.response.names, "pinion", "x") is not None:
        values["bearing_damping_pinion"] = result.damping.bearing_pinion
        values["bearing_damping_wheel"] = result.damping.bearing_wheel
    values["steps_per_mesh_cycle"] = result.response.time.size // result.response.periods
    values["omega_max_dt"] = result.response.step_number
    if is_steady(result.response):
        values["steady_state_error"] = result.response.error
        if np.isfinite(result.response.step_error):
            values["step_error"] = result.response.step_error
    oil = result.case.lubricant
    if oil is not None and oil.heat_transfer is not None:
        values["oil_temperature"] = oil.temperature
    values |= load_figures(result.case, result.mesh, values)
    measures = [(name, each) for name, each in MEASURES.all().items() if name in SUMMARY]
    values |= {name: measure(result) for name, measure in measures}
    return {n: float(values[n]) for n in SUMMARY if values.get(n) is not None}


def mesh_figures(mesh: MeshTable) -> Tree:
    """Figures of teeth at rest and their films."""
    return {
        "mesh_frequency": mesh.mesh_frequency,
        "static_mesh_force": mesh.total_normal_force,
        "mean_mesh_stiffness": mesh.mean_mesh_stiffness,
        "mean_mesh_stiffness_secant": mesh.mean_mesh_stiffness,
        "mean_mesh_stiffness_tangent": mesh.mean_mesh_stiffness_tangent,
        **_stiffness_parts(mesh),
        "contact_ratio_under_load": mesh.contact_ratio_under_load,
        **_face_figures(mesh),
        "maximum_single_pair_stiffness": mesh.maximum_single_pair_stiffness,
        "mean_friction_coefficient": mesh.mean_friction_coefficient,
        "mean_asperity_friction_coefficient": mesh.mean_asperity_friction_coefficient,
        **_pressure(mesh),
        **_error_parts(mesh),
        **_film_figures(mesh),
    }


def _face_figures(mesh: MeshTable) -> Tree:
    """Distribution of the load over the face, where contacts are slices of it."""
    if mesh.face_position is None:
        return {}
    travel = np.ptp(mesh.load_face_position)
    return {"face_load_factor": mesh.face_load_factor, "load_face_position_range": travel}


def _stiffness_parts(mesh: MeshTable) -> Tree:
    """Mean stiffness of the teeth and of the oil films, if these are in series."""
    if mesh.tooth_transmission_error is None:
        return {}
    figures = {"mean_mesh_stiffness_teeth": mesh.grid.mean(mesh.tooth_mesh_stiffness)}
    film = mesh.film_mesh_stiffness
    if film is not None:
        figures["mean_mesh_stiffness_film"] = 1.0 / mesh.grid.mean(1.0 / film)
    return figures


def _error_parts(mesh: MeshTable) -> Tree:
    """Transmission error at rest of the teeth alone, and its change by oil films in series."""
    teeth = mesh.tooth_transmission_error
    if teeth is None:
        return {}
    name, mean = "static_transmission_error", mesh.grid.mean(teeth)
    return {
        f"mean_{name}_teeth": mean,
        f"mean_{name}_film": mesh.grid.mean(mesh.transmission_error_at_rest) - mean,
        f"peak_to_peak_{name}_teeth": np.ptp(teeth),
    }


def _pressure(mesh: MeshTable) -> Tree:
    """Greatest Hertzian pressure, which a mesh table of another program may lack."""
    greatest = mesh.hertz_pressure.max()
    return {"maximum_hertz_pressure": greatest} if np.isfinite(greatest) else {}


def _static_error_figures(result: PairResult) -> Tree:
    """Transmission error at rest: of the mesh cycle, or of all teeth where they differ."""
    name = "static_transmission_error"
    figures: tuple[Any, Any, Any]
    pair = result.case.spur_pair
    if pair is not None and pair.teeth_differ:
        loaded = result.loaded_contact()
        error = loaded.transmission_error + static_error(result.case.dynamics, loaded.phase)
        loaded = replace(loaded, transmission_error=error)
        figures = (
            loaded.mean_transmission_error,
            loaded.peak_to_peak_transmission_error,
            loaded.transmission_error_harmonics(HARMONICS),
        )
    else:
        error, grid = result.transmission_error_at_rest(), result.mesh.grid
        figures = (grid.mean(error), np.ptp(error), grid._harmonics(error, HARMONICS))
    mean, most, amplitudes = figures
    parts = _error_parts(result.mesh)
    if parts and pair is not None and pair.teeth_differ:
        # The loaded contact of all teeth has no film.
        parts |= {f"mean_{name}_teeth": mean, f"peak_to_peak_{name}_teeth": most}
        mean = mean + parts[f"mean_{name}_film"]
    return {
        **parts,
        f"mean_{name}": mean,
        f"peak_to_peak_{name}": most,
        **{f"{name}_harmonic_{order}": size for order, size in enumerate(amplitudes, 1)},
    }


def _film_figures(mesh: MeshTable) -> Tree:
    """Film figures: least values along the path of contact, and those at the pitch point."""
    least = {
        "central_film": mesh.central_film,
        "minimum_film_over_path": mesh.minimum_film,
        "minimum_film_ratio": mesh.film_ratio,
        "minimum_film_load_share": mesh.film_load_share,
    }
    figures: Tree = {
        name: np.fmin.reduce(column[mesh.in_contact])  # the least that is a number
        for name, column in least.items()
        if column is not None
    }
    if mesh.film_pressure is not None:
        figures["maximum_film_pressure"] = np.nanmax(mesh.film_pressure)
    at_pitch_point = {
        "central_film_pitch_point": mesh.at_pitch_point("central_film"),
        "oil_film_stiffness_pitch_point": mesh.at_pitch_point("film_stiffness"),
    }
    return figures | {name: value for name, value in at_pitch_point.items() if value is not None}


def _motion_figures(result: PairResult, samples: FineSamples) -> Tree:
    """Figures of all signals of a motion, averaged in one pass."""
    from tribodyn.signals.indicators import extremes, mesh_harmonics, moments

    name, figures = "dynamic_transmission_error", Tree()
    signals, every = zip(*_signals(result, samples), strict=True)
    averages = (part.tolist() for part in moments(samples, np.array(every).T))
    motions = [every[signals.index(each)] for each in ("mesh_force", name)]
    (least, lowest), (greatest, highest) = extremes(np.array(motions).T)
    figures |= {"peak_mesh_force": greatest, "minimum_mesh_force": least}
    figures[f"peak_to_peak_{name}"] = highest - lowest
    for order, size in enumerate(np.abs(mesh_harmonics(samples, motions[1], HARMONICS)), 1):
        figures[f"{name}_harmonic_{order}"] = size
    for signal, mean, swing in zip(signals, *averages, strict=True):
        if signal == name:
            figures |= {f"mean_{name}": mean, f"rms_{name}": swing}
        elif signal == "contact_loss":
            figures["contact_loss_share"] = mean
        elif signal.endswith("friction_force"):
            figures[f"rms_{signal}"] = np.hypot(mean, swing)
        elif signal == "mesh_force":
            figures |= {f"mean_{signal}": mean, f"rms_{signal}": np.hypot(mean, swing)}
        elif signal.startswith(_OF_CENTRES):
            figures[f"rms_{signal}"] = swing
            figures[f"mean_{signal}"] = abs(mean) if "torque" in signal else mean
        else:
            figures[f"mean_{signal}"] = mean
    return figures


#: Signals of gear centres and shafts: their rms excludes the mean, which is a separate figure.
_OF_CENTRES = ("bearing_force_", "acceleration_", "torque_shaft")


def _signals(result: PairResult, samples: FineSamples) -> Iterator[tuple[str, Array]]:
    force, touch = mesh_force(samples), first_touch(result.system, samples)
    yield "mesh_force", force
    separated = (compression(samples) <= touch) & (touch > 0.0)
    yield "contact_loss", separated.astype(float)
    yield "dynamic_transmission_error", transmission_error(result, samples)
    phase = one_sided_phase(samples)
    yield "friction_power", _friction_power(result, phase, force)
    for name, (values, *_) in friction_forces(result, samples).items():
        yield name, values
    in_space = tooth_force(result, phase, force)
    if in_space is not None and result.mesh.unloaded_transmission_error is not None:
        for number, axis in enumerate("xyz"):
            yield f"mesh_force_{axis}", in_space[:, number]
    yield from _support_signals(result, samples)


def _friction_power(result: PairResult, phase: Array, force: Array) -> Array:
    from tribodyn.mesh.grid import PhaseFunction

    mesh = result.mesh
    # The surfaces of both gears move along the same friction: what one gains the other loses.
    speeds = mesh.pinion_speed, mesh.pinion_speed / result.case.gear_ratio
    names = "friction_moment_pinion", "friction_moment_wheel"
    if result.friction is None:
        moments = (getattr(mesh.functions(), name).values for name in names)
        return PhaseFunction(mesh.grid, _power_difference(speeds, moments))(phase) * force
    moments = (result.friction.value(name, phase, force) for name in names)
    return _power_difference(speeds, moments) * force


def _power_difference(speeds: tuple[float, float], moments: Iterable[Array]) -> Array:
    """Power of a moment on the pinion less that of one on the wheel."""
    pinion, wheel = (speed * moment for speed, moment in zip(speeds, moments, strict=True))
    return pinion - wheel


def _support_signals(result: PairResult, samples: FineSamples) -> Iterator[tuple[str, Array]]:
    """Forces on the supports, accelerations of the gear centres and torque in both shafts."""
    names = result.response.names
    supports: dict[str, int] = {}
    if centre_column(names, "pinion", "x") is not None:
        for gear, (direction, (letter, _)) in product(GEARS, directions_of(names).items()):
            if (number := centre_column(names, gear, letter)) is not None:
                supports[f"bearing_force_{direction}_{gear}"] = number
                yield f"acceleration_{direction}_{gear}", samples.acceleration[:, number].copy()
    if "shaft1_theta" in names:
        # What twists a shaft turns its disc one way and the gear the other.
        supports |= {f"torque_shaft{k}": names.index(f"shaft{k}_theta") for k in (1, 2)}
    forces = support_forces(result.system, samples, list(supports.values()))
    yield from zip(supports, forces, strict=True)


def _hypoid_figures(result: PairResult, in_space: bool) -> Tree:
    """Unloaded and loaded transmission error of gears in space, on the line of action."""
    error = result.mesh.unloaded_transmission_error
    if not in_space or error is None:
        return {}
    return {
        "unloaded_transmission_error_peak_to_peak": np.ptp(error),
        "loaded_transmission_error_peak_to_peak": np.ptp(result.mesh.transmission_error_at_rest),
    }


def _comparison(result: PairResult) -> Tree:
    """Figures of the same motion with the friction of the nominal load."""
    if result.friction is None or result.nominal_friction_response is None:
        return {}
    other = replace(result, response=result.nominal_friction_response, friction=None)
    figures = _motion_figures(other, measured(other.response))
    names = (
        "rms_mesh_force",
        "peak_mesh_force",
        "peak_to_peak_dynamic_transmission_error",
        "rms_friction_force",
        "mean_friction_power",
    )
    compared = {f"{name}_nominal_friction": figures[name] for name in names}
    return compared | {"friction_fit_error": result.friction.fit_error}


def _line_of_action(figures: ByName) -> Tree:
    """Ratio of the bearing force of the pinion across the line of action to that along it."""
    from tribodyn.signals.indicators import across_over_along

    along, across = (figures.get(f"rms_bearing_force_{way}_pinion") for way in ("loa", "oloa"))
    if along is None or across is None:
        return {}
    indicator = across_over_along(along, across)
    return {"line_of_action_indicator": indicator} if np.isfinite(indicator) else {}
