"""Pins of the planets in the plane model, with clearance in their bearings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.checks import require_number
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.radial_clearance import RadialClearance, clearance_motion
from tribodyn.errors import Argument, InputError, require_between
from tribodyn.machine.planetary.double_planets import Directions
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Response


@dataclass(frozen=True, eq=False)
class Pins:
    """Springs between planets and carrier that may hold only beyond a clearance."""

    axes: Directions
    stiffness: Array  #: of each planet [N/m]
    ahead: Array  #: error of each pin [m]
    clearance: float = 0.0

    def __post_init__(self) -> None:
        number = require_number("pin_clearance", self.clearance)
        require_between("pin_clearance", number, 0.0, 0.01, "m")

    def supports(self) -> list[RadialClearance]:
        """Support of every planet in radial and tangential direction."""
        count = self.stiffness.size
        return [
            RadialClearance(
                np.array([self.axes.radial[i], self.axes.tangential[i]]),
                float(self.stiffness[i % count]),
                self.clearance,
                [0.0, float(self.ahead[i]) if i < count else 0.0],
            )
            for i in range(self.axes.bodies)
        ]

    def springs(self, force: dict[str, float]) -> tuple[Array, Array]:
        """Stiffness (n, n) and load (n,) of the pins, linear about their load by the meshes."""
        matrix, load = np.zeros((self.axes.size, self.axes.size)), np.zeros(self.axes.size)
        if not self.clearance:
            count = self.stiffness.size
            for along in (self.axes.radial, self.axes.tangential):
                matrix += (along.T * np.tile(self.stiffness, self.axes.bodies // count)) @ along
            return matrix, (self.stiffness * self.ahead) @ self.axes.tangential[:count]
        pushed = sum(-force[mesh] * along.sum(axis=0) for mesh, along in self.axes.meshes.items())
        for law, first, at in zip(self.supports(), self.axes.first, self.axes.at, strict=True):
            x, y = np.asarray(pushed)[first : first + 2]
            on_pin = np.array([np.cos(at) * x + np.sin(at) * y, np.cos(at) * y - np.sin(at) * x])
            size, rows = float(np.hypot(*on_pin)), np.asarray(law.directions)
            if not size:
                what, why = "pin_clearance without a load", "The springs are linear about the load"
                raise InputError(what, Argument("pin_clearance"), why, "Give force_per_planet")
            displacement = on_pin / size * (self.clearance + size / law.stiffness)
            tangent = law.tangent(displacement)
            matrix += rows.T @ tangent @ rows
            moved = np.asarray(law.offset) + displacement
            load += rows.T @ (tangent @ moved - law.force(displacement))
        return matrix, load


def pins_of(data: Mapping[str, Any]) -> Pins:
    """Pins of the arguments of a plane model."""
    count, double = int(data["planets"]), data.get("double_planets")
    alpha = data["sun_pressure_angle"], data["ring_pressure_angle"]
    axes = Directions(data["phases"].angles, *alpha, double)
    stiffness, ahead = (
        np.broadcast_to(data[name], (count,)) for name in ("pin_stiffness", "pin_errors")
    )
    return Pins(axes, stiffness, ahead, float(data.get("pin_clearance", 0.0)))


def motion_in_clearance(
    system: System, data: Mapping[str, Any], frequency: float, **search: Any
) -> Response:
    """Periodic motion of a stage with the exact law of its pins."""
    pins = pins_of(data)
    matrix, load = pins.springs(pins.axes.forces(float(data["force_per_planet"])))
    free = replace(
        system,
        stiffness=np.asarray(system.stiffness) - matrix,
        force=np.asarray(system.force) - load,
    )
    return clearance_motion(free, pins.supports(), frequency, **search)
