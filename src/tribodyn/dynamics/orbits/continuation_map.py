"""The map whose fixed points a branch joins: the reduced state over one period, and a parameter.

State and parameter are scaled, so that one length measures both: states by the size of the first
orbit, the parameter by the range that is looked through.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled, compile_for
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.coordinates import OrbitCoordinates
from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array

#: Half of the differences that give the matrix of a map with dead zones, and the slope along the
#: parameter, relative to the motion and to the range.
_DISTURBANCE, _PARAMETER_DISTURBANCE = 3e-6, 1e-6


class Family:
    """Systems that differ by one parameter, each with its mesh frequency."""

    def __init__(
        self,
        make: System | Callable[[float], System | tuple[System, float]],
        mesh_frequency: float | None,
        steps: int,
        lowest: float,
    ) -> None:
        self._make, self._frequency, self._steps = make, mesh_frequency, steps
        # The slowest cycle has the longest steps.
        self._own = compile_for(make, lowest, steps) if isinstance(make, System) else None

    def __call__(self, parameter: float) -> tuple[Compiled, float]:
        """Compile the system of one parameter; returns it with its mesh frequency."""
        if self._own is not None or isinstance(self._make, System):
            assert self._own is not None
            return self._own, parameter
        made = self._make(parameter)
        system, frequency = made if isinstance(made, tuple) else (made, self._frequency)
        if not isinstance(system, System) or frequency is None:
            raise InputError(
                Problem(
                    what=f"the function of the parameter returned {type(made).__name__}"
                    + ("" if frequency is not None else " and no mesh frequency was given"),
                    where="argument make_system",
                    why="A System with mesh_frequency given, or a tuple (System, mesh frequency)",
                )
            )
        return compile_for(system, float(frequency), self._steps), float(frequency)


@dataclass(frozen=True)
class Jet:
    """The map at one point with its derivatives, all scaled."""

    residual: Array  #: what the map adds to the point [-]
    matrix: Array  #: derivative with respect to the point, the monodromy matrix [-]
    slope: Array  #: derivative with respect to the parameter [-]

    def border(self, row: Array) -> Array:
        """Matrix of Newton's method with one more equation."""
        top = np.column_stack((self.matrix - np.eye(self.residual.size), self.slope))
        return np.vstack((top, row))


class ParameterMap:
    """The scaled map of a point ``x = (state / size, (parameter - low) / range)``."""

    def __init__(self, family: Family, periods: int, between: tuple[float, float]) -> None:
        self.family, self.periods = family, periods
        self.origin, self.range = between[0], between[1] - between[0]
        self.size = 1.0
        self.cycles = 0
        self._coordinates: OrbitCoordinates | None = None
        self._kept: tuple[float, OrbitMap] | None = None

    def parameter(self, x: Array) -> float:
        """Parameter of a point."""
        return float(self.origin + self.range * x[-1])

    def at(self, parameter: float) -> OrbitMap:
        """Take the map of one parameter."""
        if self._kept is not None and self._kept[0] == parameter:
            return self._kept[1]
        compiled, frequency = self.family(parameter)
        made = OrbitMap(compiled, frequency, self.periods, self._coordinates, None)
        self._coordinates = made.coordinates
        self._kept = (parameter, made)
        return made

    def reduced(self, x: Array) -> Array:
        """Reduced vector of a point, without the scale."""
        return np.asarray(x[:-1] * self.size)

    def residual(self, x: Array) -> Array:
        """What the map adds to a point."""
        y = self.reduced(x)
        self.cycles += self.periods
        return np.asarray((self.at(self.parameter(x))(y) - y) / self.size)

    def jet(self, x: Array) -> Jet:
        """Evaluate the map at a point and next to it."""
        u, parameter = x[:-1], self.parameter(x)
        step, delta = _DISTURBANCE, _PARAMETER_DISTURBANCE
        sides = [self.at(parameter + sign * delta * self.range)(u * self.size) for sign in (-1, 1)]
        mapping, eye = self.at(parameter), np.eye(u.size)
        if mapping.affine:
            images = mapping((u + np.vstack((0.0 * eye[:1], eye))) * self.size) / self.size
            matrix = (images[1:] - images[0]).T
        else:
            moved = np.vstack((0.0 * eye[:1], step * eye, -step * eye))
            images = mapping((u + moved) * self.size) / self.size
            plus, minus = np.split(images[1:], 2)
            matrix = (plus - minus).T / (2.0 * step)
        self.cycles += self.periods * (images.shape[0] + 2)
        slope = (sides[1] - sides[0]) / (2.0 * delta * self.size)
        return Jet(images[0] - u, matrix, slope)
