"""Motion of a result as labelled series with units and meanings, for figures and files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.mesh.functions import WRENCH
from tribodyn.mesh.gears import SPATIAL_COORDINATES
from tribodyn.nomenclature import GEARS
from tribodyn.study.case.to_models import mesh_law_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import FineSamples, Response, System
    from tribodyn.study.pipeline.result import PairResult


#: Distance from an event that separates its two sides [mesh cycles].
_SIDE = 1e-11
#: Coordinates of structures with shafts across and along the line of action.
_LETTERS = {"x": "v", "y": "w"}


def is_steady(response: Response) -> bool:
    """Whether a response is a periodic orbit, not a transient."""
    return response.floquet_multipliers.size > 0


def centre_column(names: Sequence[str], gear: str, axis: str) -> int | None:
    """Return the column of a coordinate of a gear's centre, or None if there is none."""
    candidates = [f"{gear}_{letter}" for letter in (axis, _LETTERS.get(axis, axis))]
    return next((column for column, name in enumerate(names) if name in candidates), None)


def measured(response: Response) -> FineSamples:
    """Return the samples from which the figures of a summary are computed."""
    fine = response.fine
    if is_steady(response):
        return replace(fine, weight=fine.weight / fine.weight.sum())
    first = response.periods // 2
    skipped = fine.phase.size * first // response.periods
    part = replace(fine, **{f.name: getattr(fine, f.name)[skipped:] for f in fields(fine)})
    return replace(part, phase=part.phase - first, weight=part.weight / part.weight.sum())


def one_sided_phase(samples: FineSamples) -> Array:
    """Phase of each sample, moved slightly into its step so that events have two sides."""
    steps = samples.phase.reshape(-1, 3) + np.array([_SIDE, 0.0, -_SIDE])
    return np.asarray(steps.reshape(-1))


def mesh_force(samples: FineSamples) -> Array:
    """Force of the mesh: the sum over the ramps of its force law, damping included."""
    force = samples.contact_force
    return force[:, 0] if force.shape[1] == 1 else np.asarray(force.sum(axis=1))


def compression(samples: FineSamples) -> Array:
    """Compression of the mesh, which all ramps of its force law share."""
    return samples.deflection[:, 0]


def first_touch(system: System, samples: FineSamples) -> Array:
    """Compression at which the driving flanks touch; its negative is that of the back flanks."""
    gap = system.contacts[0].gap
    values = gap(one_sided_phase(samples)) if callable(gap) else gap
    return np.broadcast_to(np.asarray(values, dtype=float), samples.phase.shape)


def transmission_error(result: PairResult, samples: FineSamples) -> Array:
    """Dynamic transmission error, counted from where perfect rigid driving flanks touch."""
    error = compression(samples) + result.static_error(samples.phase)
    return np.asarray(error - result.half_backlash - film_offset(result))


def film_offset(result: PairResult) -> float:
    """Distance before the flanks touch from which the compression of the mesh is counted.

    A force law and its tangent count from where the first oil film in series carries; a plain
    stiffness from where its mean deflection is zero.
    """
    mesh = result.mesh
    if mesh.film_offset == 0.0 or mesh_law_of(result.case) != "stiffness":
        return mesh.film_offset
    deflection = mesh.total_normal_force / mesh.mesh_stiffness
    return float(mesh.grid.mean(deflection - mesh.transmission_error_at_rest))


def tooth_force(result: PairResult, phase: Array, force: Array) -> Array | None:
    """Force of the teeth with friction in the axes of the first gear; None in a plane."""
    functions = result.mesh.functions()
    if functions.direction is None or result.mesh.direction.shape[-1] != len(SPATIAL_COORDINATES):
        return None
    rows = functions.direction(phase)
    law = result.friction
    if law is not None and law.wrench is not None:
        rubs = [law.value(name, phase, force) for name in WRENCH[:3]]
        return np.asarray((rows[:, :3] + np.stack(rubs, axis=-1)) * force[:, None])
    if functions.friction is not None:
        rows = rows + functions.friction(phase)
    return np.asarray(rows[:, :3] * force[:, None])


def support_force(system: System, samples: FineSamples, number: int) -> Array:
    """Force of the bodies on the support of a coordinate, from springs and dampers together."""
    return np.asarray(support_forces(system, samples, [number])[0])


def support_forces(system: System, samples: FineSamples, numbers: Sequence[int]) -> Array:
    """Forces of the bodies on the supports of several coordinates, a row for each."""
    springs, dampers = (
        np.asarray(matrix)[numbers] for matrix in (system.stiffness, system.damping)
    )
    return np.asarray(springs @ samples.position.T + dampers @ samples.velocity.T)


_IN_PLANE = {"loa": ("y", "along the line of action"), "oloa": ("x", "across it")}
_ALONG_AXES = {**_IN_PLANE, "axial": ("z", "along the axes")}
_IN_SPACE = {
    "x": ("x", "along the common perpendicular of the axes"),
    "y": ("y", "along its own axis"),
    "z": ("z", "across both"),
}


def directions_of(names: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Directions in the names of figures, each with its coordinate and its description."""
    if f"{GEARS[0]}_z" not in names:
        return _IN_PLANE
    return _ALONG_AXES if f"{GEARS[0]}_theta_y" in names else _IN_SPACE


def _sided(samples: Any) -> Array:
    """Phase of samples; fine samples are on their side of an event."""
    fine = hasattr(samples, "weight")
    return one_sided_phase(samples) if fine else np.asarray(samples.phase)


def friction_forces(result: PairResult, samples: Any) -> dict[str, tuple[Array, str, str]]:
    """Friction force of all pairs, and its parts from films and asperities if split."""
    from tribodyn.mesh.functions import ASPERITIES

    force, phase, law = mesh_force(samples), _sided(samples), result.friction
    if law is None:
        channels: Any = result.mesh.functions()
        rubbing = channels.friction_sum(phase) * force
        split = result.mesh.asperity_friction_coefficient is not None
        metal = result.mesh.at(ASPERITIES, phase) * force if split else None
    else:
        rubbing = law.value("friction_sum", phase, force) * force
        metal = law.value(ASPERITIES, phase, force) * force if law.splits else None
    forces = {"friction_force": (rubbing, "N", "friction force of all tooth pairs")}
    if metal is not None:
        forces["film_friction_force"] = (
            rubbing - metal,
            "N",
            "part of it that the oil films cause",
        )
        forces["asperity_friction_force"] = (metal, "N", "part of it that the asperities cause")
    return forces


def signals(result: PairResult, samples: Any) -> dict[str, tuple[Array, str, str]]:
    """Signals of figures on the samples: values, unit and meaning by name."""
    force, phase = mesh_force(samples), _sided(samples)
    static = result.transmission_error_at_rest(phase)
    series = {
        "mesh_force": (force, "N", "force along the line of action of all tooth pairs"),
        "dynamic_transmission_error": (
            transmission_error(result, samples),
            "m",
            "lag of the driven gear on the line of action, from first contact of the flanks",
        ),
        "static_transmission_error": (static, "m", "the same at rest under the nominal load"),
        **friction_forces(result, samples),
    }
    if (in_space := tooth_force(result, phase, force)) is not None:
        for axis, values in zip("xyz", in_space.T, strict=True):
            first, second = GEARS
            meaning = f"force of the teeth on the {second} along the {axis} axis of the {first}"
            series[f"mesh_force_{axis}"] = (values, "N", meaning)
    for gear in GEARS:
        for direction, (axis, direction_text) in directions_of(result.response.names).items():
            column = centre_column(result.response.names, gear, axis)
            if column is not None:
                meaning = f"force of the {gear} on its bearing {direction_text}"
                force = support_force(result.system, samples, column)
                series[f"bearing_force_{direction}_{gear}"] = (force, "N", meaning)
                meaning = f"acceleration of the {gear}'s centre {direction_text}"
                signal = samples.acceleration[:, column]
                series[f"acceleration_{direction}_{gear}"] = (signal, "m/s^2", meaning)
    return series
