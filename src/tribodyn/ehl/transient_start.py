"""A transient contact ready for the kernel: grid, table of inputs, and the state it starts from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.ehl.roughness import RoughnessProfile
from tribodyn.ehl.roughness_resolution import warn_if_unresolved
from tribodyn.ehl.scales import ContactScales, contact_scales, moes_numbers
from tribodyn.ehl.transient_inputs import TransientInputs
from tribodyn.ehl.transient_scale import ReferenceScale
from tribodyn.ehl.transient_state import REASONS, State
from tribodyn.errors import ComputationError, InputError, Problem
from tribodyn.lubricant import Lubricant
from tribodyn.types import Array

#: Greatest factor of load, speed or curvature from one steady state to the next of the start.
_RATIO = 1.25


@dataclass(frozen=True, eq=False)
class TransientContact:
    """A transient contact in its dimensionless form."""

    inputs: TransientInputs  #: checked series
    scale: ReferenceScale  #: units
    lubricant: Lubricant  #: the oil
    modulus: float  #: effective modulus [Pa]
    nodes: int  #: nodes of the grid
    domain: tuple[float, float]  #: first and last position, in half widths
    inlet: str  #: condition at the first node
    law: str  #: viscosity law
    compressible: bool  #: whether the density rises with pressure
    length: float  #: distance at which the deflection is zero [m]
    limits: Array  #: limits of the solver, see :func:`tribodyn.ehl.kernel.newton.newton_level`

    @property
    def dx(self) -> float:
        """Width of an interval, in half widths."""
        return (self.domain[1] - self.domain[0]) / (self.nodes - 1)

    @property
    def flooded(self) -> bool:
        """Whether the first node carries the pressure of the inlet before it."""
        return self.inlet == "flooded"

    @cached_property
    def numbers(self) -> ContactScales:
        """Factor lambda of the equation and the oil for the kernel, at the reference."""
        scale, oil = self.scale, self.lubricant
        M, L = moes_numbers(scale.load, scale.radius, scale.entrainment_speed, oil, self.modulus)
        return contact_scales(
            M,
            L,
            scale.pressure,
            oil.pressure_viscosity_coefficient,
            oil.roelands_index,
            self.law,
            self.compressible,
        )

    @property
    def depth(self) -> float:
        """Distance at which the deflection is zero, in half widths."""
        return self.length / self.scale.half_width

    @property
    def time(self) -> Array:
        """Instants, in b/u."""
        return self.inputs.time / self.scale.time

    def table(self) -> Array:
        """Inputs of the kernel over time."""
        from tribodyn.ehl.kernel.squeeze import (
            CURVATURE,
            FIRST_SHIFT,
            HEIGHT,
            INPUTS,
            LOAD,
            OFFSET,
            SECOND_SHIFT,
            SPEED,
        )

        inputs, scale = self.inputs, self.scale
        table = np.zeros((inputs.time.size, INPUTS))
        table[:, LOAD] = inputs.load / scale.load
        table[:, SPEED] = inputs.entrainment_speed / scale.entrainment_speed
        table[:, CURVATURE] = scale.radius / inputs.radius
        table[:, FIRST_SHIFT : SECOND_SHIFT + 1] = inputs.travel.T / scale.half_width
        table[:, HEIGHT] = 1.0
        if inputs.approach is not None:
            table[:, OFFSET] = -inputs.approach / scale.film
        return table

    def rough(self) -> tuple[Array, Array, Array]:
        """Heights of both surfaces for the kernel."""
        ends = np.zeros((2, 3))
        heights = [np.zeros(0), np.zeros(0)]
        for side, profile in enumerate(self.inputs.profiles):
            if profile is not None:
                heights[side] = -profile.height / self.scale.film
                ends[side] = (
                    profile.position[0] / self.scale.half_width,
                    profile.spacing / self.scale.half_width,
                    float(profile.beyond == "periodic"),
                )
        return heights[0], heights[1], ends

    def check_roughness(self) -> None:
        """Warn of waves that the grid does not resolve."""
        b = self.scale.half_width
        for side, profile in enumerate(self.inputs.profiles):
            if isinstance(profile, RoughnessProfile):
                travel = self.inputs.travel[side]
                first = self.domain[0] * b - float(np.max(travel))
                profile.require_range(first, self.domain[1] * b - float(np.min(travel)))
                warn_if_unresolved(profile, self.dx * b, stacklevel=4)

    def steady(self) -> State:
        """Steady state under the inputs of the first instant."""
        table, imposed = self.table(), self.inputs.approach is None
        if not self.inputs.entrainment_speed[0] > 0.0:
            raise InputError(
                Problem(
                    what="entrainment_speed = 0 at the first instant",
                    where="arguments entrainment_speed and start",
                    why="without rolling no steady film carries the load",
                    remedy='Begin with a positive speed, or with start = "unloaded" and an '
                    "imposed approach",
                )
            )
        state, row = self._reference_state(), table[0].copy()
        first = row.copy()
        first[[0, 3]], first[6] = 1.0, 0.0
        self._carry(state, first, row, True, 1.0)
        if not imposed:
            # The offset counts the deflection from another distance than the kernel's own, b.
            shift = self.dx * float(np.sum(state.P)) * np.log(self.depth) / np.pi
            state.numbers[0] -= shift
            first = row.copy()
            first[1] = state.numbers[0]
            self._carry(state, first, row, False, self.depth)
        return state

    def unloaded(self) -> State:
        """Film at rest in the open gap of the first instant."""
        if self.inputs.approach is None:
            raise InputError(
                Problem(
                    what='start = "unloaded" with an imposed load',
                    where="argument start",
                    why="an unloaded film carries no load",
                    remedy='Take start = "steady", or impose the approach',
                )
            )
        n, row = self.nodes - 1, self.table()[0]
        X = np.linspace(*self.domain, n + 1)
        H = row[1] + 0.5 * row[3] * X**2
        for travel, profile in zip(self.inputs.travel, self.inputs.profiles, strict=True):
            if profile is not None:
                H += profile(X * self.scale.half_width - travel[0]) / self.scale.film
        if not float(H.min()) > 0.0:
            raise InputError(
                Problem(
                    what=f"approach = {-row[1] * self.scale.film:.6g} m at the first instant",
                    where="arguments approach and start",
                    why="an unloaded start needs an open gap: a negative approach, beyond the "
                    "highest peaks",
                    remedy='Begin earlier, or take start = "steady"',
                )
            )
        numbers = np.zeros(8)
        width = min(0.5 * np.sqrt(2.0 * row[1] / row[3]), 0.9 * self.domain[1])
        numbers[0], numbers[1] = row[1], np.floor((width - self.domain[0]) / self.dx)
        return State(np.zeros(n + 1), H, numbers)

    def _reference_state(self) -> State:
        """Steady state of the widest dry contact at the speed of the first instant."""
        from tribodyn.ehl.line_contact import solve_line_contact

        solution = solve_line_contact(
            self.scale.load,
            self.scale.radius,
            float(self.inputs.entrainment_speed[0]),
            self.lubricant,
            self.modulus,
            nodes=self.nodes,
            domain=self.domain,
            inlet=self.inlet,
            viscosity_law=self.law,
            compressible=self.compressible,
        )
        grid = solution._grid
        numbers = np.zeros(8)
        numbers[0], numbers[1], numbers[5] = grid.H0, grid.free, 0.5 * np.pi
        return State(grid.P.copy(), grid.H.copy(), numbers)

    def _carry(self, state: State, first: Array, row: Array, imposed: bool, depth: float) -> None:
        """Carry a steady state from one set of inputs to another, in place."""
        from tribodyn.ehl.kernel.march_entry import march_contact

        none = np.zeros((0, 0))
        status, _ = march_contact(
            self.nodes - 1, self.domain[0], self.dx, depth, self.numbers.lam, self.numbers.oil,
            self.limits, imposed, self.flooded, _RATIO, np.zeros(0), np.stack((first, row)),
            self.rough(), 0, 0, state.P, state.H, state.numbers, none, none, none,
        )  # fmt: skip
        if status != 0:
            inputs = self.inputs
            raise ComputationError(
                Problem(
                    what=f"The steady state of the first instant, t = {inputs.time[0]:.6g} s, was "
                    f"not found: {REASONS[status]}",
                    why=f"load {inputs.load[0]:.6g} N/m, radius {inputs.radius[0]:.6g} m, "
                    f"entrainment speed {inputs.entrainment_speed[0]:.6g} m/s",
                    remedy="Begin with a moderate load and without roughness, or take more nodes",
                )
            )
