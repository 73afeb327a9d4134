"""What all planets of a machine that is one stage have in common, under one name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine import Machine


def only_stage(machine: Machine) -> str | None:
    """Name of the stage to which all meshes of a machine belong; None of other machines."""
    for name, stage in machine.planets.items():
        if stage._meshes(name) == {*machine.meshes}:
            return name
    return None


def common_lines(levels: Any, machine: Machine) -> dict[str, Array | tuple[str, ...]]:
    """Fields of levels with the greatest of all planets for each kind of mesh and the pins."""
    stage = only_stage(machine)
    if stage is None:
        return {}
    kinds = machine.planets[stage].mesh_names(stage)
    meshes = {kind: [levels.mesh.index(name) for name in names] for kind, names in kinds.items()}
    roles = [name.removeprefix(f"{stage}_").rstrip("0123456789") for name in levels.bearing]
    bearings: dict[str, list[int]] = {}
    for number in sorted(range(len(roles)), key=lambda i: "pin" not in roles[i]):
        name = roles[number] + "s" * ("pin" in roles[number])
        bearings.setdefault(name, []).append(number)
    labels = line_labels(machine)
    lines = {line: line.rpartition(" x ") for line in levels.line}
    stage_lines = {
        line: f"{labels[mesh]} x {k}" for line, (mesh, _, k) in lines.items() if mesh in labels
    }
    places = [levels.line.index(line) for line in stage_lines]

    def greatest(values: Array, groups: Mapping[str, list[int]]) -> Array:
        """The greatest of each group, in the last axis."""
        return np.stack([values[..., group].max(axis=-1) for group in groups.values()], axis=-1)

    return {
        "mesh": tuple(meshes),
        "bearing": tuple(bearings),
        "line": tuple(stage_lines.values()),
        "order": levels.order[places],
        "mesh_force": greatest(levels.mesh_force, meshes),
        "transmission_error": greatest(levels.transmission_error, meshes),
        "bearing_force": greatest(levels.bearing_force, bearings),
        "mesh_force_line": greatest(levels.mesh_force_line[:, places], meshes),
        "transmission_error_line": greatest(levels.transmission_error_line[:, places], meshes),
        "bearing_force_line": greatest(levels.bearing_force_line[:, places], bearings),
        "acceleration_line": levels.acceleration_line[:, places],
    }


def line_labels(machine: Machine) -> dict[str, str]:
    """Names of the lines of a machine that is one stage, by the mesh that has them first."""
    stage = only_stage(machine)
    first: dict[float, tuple[str, str]] = {}
    for kind, meshes in machine.planets[stage].mesh_names(stage).items() if stage else ():
        first.setdefault(machine.kinematics.meshes[meshes[0]].mesh_frequency, (kind, meshes[0]))
    return {mesh: kind if len(first) > 1 else "mesh" for kind, mesh in first.values()}
