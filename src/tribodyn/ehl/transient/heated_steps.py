"""Film and temperatures of a line contact over time, solved together at every instant.

The rate of the stored mass and heat is a backward formula of second order, of first order in the
first step. A step whose film or temperatures fail is halved.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from tribodyn.ehl.solver.contact_case import ContactCase, DiscreteContact
from tribodyn.ehl.solver.fallbacks import fluxes
from tribodyn.ehl.thermal.surface_history import SurfaceHistory
from tribodyn.ehl.thermal.thermal_contact import (
    IDLE,
    NO_CHANGE,
    OF_FACTORS,
    PART,
    Prediction,
    Temperatures,
    films_of,
    smooth,
)
from tribodyn.ehl.thermal.thermal_model import ThermalModel
from tribodyn.ehl.transient.moving_contact import REASONS, MovingContact, State
from tribodyn.interrupt import stoppable
from tribodyn.types import Array, Index

#: Least density of the oil in the film, over that at the inlet, as the kernel has it.
_LEAST_DENSITY = 0.3


@dataclass(eq=False)
class HeatOverTime:
    """Heat and temperatures of a contact over time."""

    temperature: Array  #: (stored instants, nodes along, nodes across) [K]
    highest: Array  #: of the oil and of both surfaces (instants, 3) [K]
    balance: Array  #: by shear, by compression, into both bodies, out, stored, missing [W/m]
    traction: Array  #: [N/m]
    passes: Index  #: between film and temperatures
    failure: str = ""  #: why an instant failed
    instant: int = 0  #: that failed


class _Stored(NamedTuple):
    """What the film holds at an instant."""

    film: Array  #: mass at the nodes, over that of a film b^2/R at the inlet
    mass: Array  #: of the cells of the columns [kg/m]
    temperature: Array  #: of these cells [K]
    pressure: Array  #: at the columns [Pa]


class _StepFailedError(Exception):
    """A step that has no solution as it is."""


class _MovingTemperatures(Temperatures):
    """Temperatures of a film over time, and of the surfaces that move under it."""

    def __init__(self, contact: MovingContact, grid: DiscreteContact, model: ThermalModel) -> None:
        scale, inputs = contact.scale, contact.inputs
        assert contact.lubricant is not None
        case = ContactCase(
            contact.numbers, scale.pressure, scale.half_width, scale.load, scale.radius,
            float(inputs.entrainment_speed[0]), contact.modulus, contact.lubricant,
            contact.compressible,
        )  # fmt: skip
        first, second = inputs.surface_speeds[:, 0]
        super().__init__(case, grid, model, float(first - second))
        self.far = self.base
        steps = np.diff(inputs.time)
        times = [
            (float(steps.min()) / 4.0, max(scale.radius**2 / body.diffusivity, float(steps.sum())))
            for body in model.bodies
        ]
        self.surfaces = [
            SurfaceHistory(self.at, self.edges, self.step, body, span, scale.radius)
            for body, span in zip(model.bodies, times, strict=True)
        ]

    def inflow(self, grid: DiscreteContact) -> float:
        """Flux at the first column, over ``b^2/R`` and the entrainment speed."""
        flux, first = fluxes(grid, grid.H), int(self.at[0])
        return float(0.5 * (flux[max(first - 1, 0)] + flux[first]))

    @property
    def most_heat(self) -> float:
        """The greatest of all heats [W/m]."""
        return float(max(np.max(np.abs(self.balance)), abs(self.storage.heat[0])))

    def begin(
        self, duration: float, speeds: tuple[Array, Array], weights: Array, earlier: list[_Stored]
    ) -> None:
        """Turn to the end of a step; speeds of both surfaces at its begin and end."""
        first, second = speeds[1].tolist()
        self.case = replace(self.case, entrainment_speed=0.5 * (first + second))
        self.oil = self.oil._replace(speed_1=first, speed_2=second)
        pairs = zip(self.surfaces, np.stack(speeds).T.tolist(), strict=True)
        starts = [surface.begin(duration, tuple(ends)) for surface, ends in pairs]
        self.base = np.ascontiguousarray(self.far + np.stack([rise for rise, _ in starts]))
        self.responses = starts[0][1], starts[1][1]
        mass = np.stack([w * e.mass for w, e in zip(weights[1:], earlier, strict=True)])
        temperature = np.stack([each.temperature for each in earlier])
        self.storage = self.storage._replace(
            now=float(weights[0]), mass=mass, temperature=temperature
        )

    def density(self, grid: DiscreteContact) -> tuple[Array, Array]:
        """Density by pressure at the columns, and that of every cell, over that at the inlet."""
        P = grid.P[self.at]
        pressed = 1.0 + grid.oil[4] * P / (1.0 + grid.oil[5] * P)
        warmer = self.across.temperature - self.oil.temperature
        return pressed, np.maximum(pressed[:, None] - self.oil.fall * warmer, _LEAST_DENSITY)

    def stored(self, grid: DiscreteContact) -> _Stored:
        """What the film holds now."""
        pressed, density = self.density(grid)
        last = density.shape[1] - 1
        weight = np.full(last + 1, 1.0 / last)
        weight[[0, -1]] *= 0.5
        unit = self.case.half_width**2 / self.case.equivalent_radius * self.oil.density
        cells = (grid.H[self.at] * self.width)[:, None] * weight * density * unit
        factor = self.everywhere(density @ weight / pressed, grid.n + 1)
        everywhere = 1.0 + grid.oil[4] * grid.P / (1.0 + grid.oil[5] * grid.P)
        pressure = grid.P[self.at] * self.case.hertz_pressure
        temperature = self.across.temperature.copy()
        return _Stored(factor * everywhere * grid.H, cells, temperature, pressure)


@dataclass(eq=False)
class _HeatedContact:
    """A contact with its temperatures at the last instant that was solved."""

    contact: MovingContact
    model: ThermalModel
    state: State
    temperatures: _MovingTemperatures = field(init=False)
    earlier: list[_Stored] = field(default_factory=list)  #: the two instants before, last first
    last: float = 0.0  #: last step [s], zero before the first
    points: list[Array] = field(init=False)  #: factors of these instants, last first
    traction: float = 0.0
    steps: int = 0  #: of Newton's method
    passes: int = 0
    record: Array = field(init=False)  #: of the film at this instant
    grid: DiscreteContact = field(init=False)

    def __post_init__(self) -> None:
        grid = self._grid(self.state, np.zeros((2, self.contact.nodes)), 1.0)
        self.temperatures = _MovingTemperatures(self.contact, grid, self.model)
        self.points = [np.zeros((2, self.contact.nodes))]

    def _grid(self, state: State, point: Array, speed: float) -> DiscreteContact:
        """A state as the steady solvers have it."""
        contact, n = self.contact, self.contact.nodes - 1
        oil = np.concatenate([contact.numbers.oil[:6], point[0], np.exp(point[1])])
        return DiscreteContact(
            n, contact.dx, contact.X, state.P, state.H, 0.0, contact.numbers.lam * speed, oil,
            int(state.instant.free), 0.0, 0.0, contact.X,
        )  # fmt: skip

    def _solve_film(self, row: Array, past: Array, grid: DiscreteContact, state: State) -> State:
        """Film of an instant at the factors of a grid."""
        from tribodyn.ehl._kernel.transient import RECORD, follow_contact

        imposed = self.contact.inputs.approach is None
        posed = self.contact.kernel_contact(imposed, 1.0 if imposed else self.contact.depth)
        solved = State(state.P.copy(), state.H.copy(), state.instant)
        records, none = np.zeros((2, RECORD)), np.zeros((0, 0))
        status, _, solved.instant = stoppable(
            follow_contact, posed._replace(oil=grid.oil), 1.25, np.array([0.0, 1.0]),
            np.stack([row, row]), 0, 0, past, solved.P, solved.H, state.instant, records, none,
            none,
        )  # fmt: skip
        if status != 0:
            raise _StepFailedError(REASONS[status])
        self.steps += int(records[1, 6])
        self.record = records[1]
        return solved

    def _toward(
        self, row: Array, past: Array, state: State, last: Array, point: Array
    ) -> tuple[State, Array]:
        """Film at new factors, or at some between them and the last ones that have one."""
        while True:
            try:
                return self._solve_film(row, past, self._grid(state, point, 1.0), state), point
            except _StepFailedError:
                if not np.max(np.abs(point - last)) >= NO_CHANGE:
                    raise
            point = last + PART * (point - last)

    def _correction(self, factor: float, point: Array, state: State, mean: Array) -> Array:
        """Squeezed mass of the density that is dragged along, less that of the mean density."""
        oil = self.contact.numbers.oil
        pressed = 1.0 + oil[4] * state.P / (1.0 + oil[5] * state.P)
        return np.asarray(factor * (pressed * np.exp(point[1]) - mean) * state.H)

    def settle(self, row: Array, weights: Array, ratio: float = 0.0) -> None:
        """Film and temperatures of an instant; all weights are zero for a steady one."""
        from tribodyn.ehl._kernel.transient import SPEED

        temperatures, nodes, scale = self.temperatures, self.contact.nodes, self.contact.scale
        squeeze, earlier = self.contact.dx * scale.time * weights, self.earlier
        history, pressure = np.zeros(nodes), np.zeros(temperatures.at.size)
        for weight, factor, each in zip(weights[1:], squeeze[1:], earlier, strict=False):
            history, pressure = history + factor * each.film, pressure + weight * each.pressure
        last, solved = self.points[0], self.state
        point, prediction = last + ratio * (last - self.points[-1]), Prediction()
        mean = earlier[0].film / solved.H if earlier else np.ones(nodes)
        films, film, traction = np.full(2, np.inf), np.inf, self.traction
        for passes in range(1, self.model.passes + 1):
            correction = self._correction(squeeze[0], point, solved, mean)
            past = np.concatenate([squeeze[:1], history + correction])
            solved, point = self._toward(row, past, solved, last, point)
            grid = self._grid(solved, point, row[SPEED])
            now = grid.P[temperatures.at] * scale.pressure
            temperatures.storage.rate[:] = weights[0] * now - pressure
            moved = temperatures.solve(grid, 2 if passes == 1 else 1)
            factors, share, weight = temperatures.factors(nodes)
            change, before, traction = factors - point, traction, temperatures.traction
            drag = abs(traction - before) / max(abs(before), IDLE * scale.load)
            flow = float(np.max(np.abs(change * share * weight)))
            last_films, films = films, films_of(grid)
            film = float(np.max(np.abs(films / last_films - 1.0))) if passes > 1 else np.inf
            if flow < NO_CHANGE or max(film, drag, OF_FACTORS * flow) < self.model.tolerance:
                temperatures.balance_heat(grid)
                self.traction, self.points = temperatures.traction, [point, self.points[0]]
                self.state, self.grid, self.passes = solved, grid, self.passes + passes
                return
            mean = temperatures.stored(grid).film / grid.H
            last, point = point, prediction.next(point, smooth(change * share, grid), weight)
        raise _StepFailedError(
            f"film and temperatures did not settle in {self.model.passes} passes: in the last one "
            f"the film changed by {film:.2g} of it, the traction by {drag:.2g} and the temperature "
            f"by {moved:.2g} K. A ThermalModel that yields or thins, with more passes or a larger "
            "tolerance may settle"
        )

    def start(self, row: Array, steady: bool) -> None:
        """Solve the first instant, or heat nothing where the contact is not loaded yet."""
        from tribodyn.ehl._kernel.transient import RECORD, SPEED, follow_contact

        temperatures, self.record = self.temperatures, np.zeros((1, RECORD))
        self.grid = self._grid(self.state, self.points[0], row[SPEED])
        if steady:
            self.settle(row, np.zeros(3))
            speeds = temperatures.oil.speed_1, temperatures.oil.speed_2
            for side, (surface, speed) in enumerate(
                zip(temperatures.surfaces, speeds, strict=True)
            ):
                surface.rest_on(temperatures.along.heat[side], speed)
        else:
            posed, none = self.contact.kernel_contact(False, self.contact.depth), np.zeros((0, 0))
            stoppable(
                follow_contact, posed, 1.25, np.zeros(1), row[None], 0, 0, np.zeros(0),
                self.state.P, self.state.H, self.state.instant, self.record, none, none,
            )  # fmt: skip
            self.record = self.record[0]
        self.earlier = [temperatures.stored(self.grid)] * 2

    def step(self, duration: float, row: Array, speeds: tuple[Array, Array]) -> None:
        """Go on by a step, or leave everything as it is."""
        temperatures, ratio = self.temperatures, 0.0
        weights = np.array([1.0, 1.0, 0.0]) / duration
        if self.last > 0.0:
            ratio = duration / self.last
            weights = np.array([1.0 + 2.0 * ratio, (1.0 + ratio) ** 2, -(ratio**2)])
            weights /= (1.0 + ratio) * duration
        arrays = (*temperatures.across, *temperatures.along)
        copies = [each.copy() for each in arrays]
        temperatures.begin(duration, speeds, weights, self.earlier)
        try:
            self.settle(row, weights, ratio)
        except _StepFailedError:
            for each, copy in zip(arrays, copies, strict=True):
                each[...] = copy
            raise
        for surface, heat in zip(temperatures.surfaces, temperatures.along.heat, strict=True):
            surface.end(heat)
        self.earlier = [temperatures.stored(self.grid), self.earlier[0]]
        self.last = duration

    def advance(self, m: int, table: Array, halvings: int) -> int:
        """Go on to an instant, in parts where the whole step fails; their number."""
        inputs = self.contact.inputs
        interval, speeds = float(inputs.time[m] - inputs.time[m - 1]), inputs.surface_speeds.T
        done, part, parts, self.steps, self.passes = 0.0, 1.0, 0, 0, 0

        def between(rows: Array, share: float) -> Array:
            return np.asarray(rows[m - 1] + share * (rows[m] - rows[m - 1]))

        while done < 1.0:
            progress = done + part
            ends = between(speeds, done), between(speeds, progress)
            try:
                self.step(part * interval, between(table, progress), ends)
            except _StepFailedError:
                part *= 0.5
                if part < 0.5**halvings:
                    raise
                continue
            done, parts = progress, parts + 1
        return parts


def follow_heated(
    contact: MovingContact, model: ThermalModel, state: State, step_halvings: int, stored: Index,
    outcome: tuple[Array, Array, Array], *, steady: bool,
) -> HeatOverTime:  # fmt: skip
    """Follow a heated contact; fills its record, and pressures and films of stored instants."""
    m, across, table = contact.inputs.time.size, model.nodes_across, contact.table()
    records, pressures, films = outcome
    heat = HeatOverTime(
        np.zeros((stored.size, contact.nodes, across)), np.zeros((m, 3)), np.zeros((m, 7)),
        np.zeros(m), np.zeros(m, dtype=np.int64),
    )  # fmt: skip
    heated = _HeatedContact(contact, model, state)
    places, parts = {int(i): place for place, i in enumerate(stored)}, 0
    for i in range(m):
        try:
            if i == 0:
                heated.start(table[0], steady)
            else:
                parts = heated.advance(i, table, step_halvings)
        except _StepFailedError as failed:
            if i == 0:
                raise contact.start_failure(str(failed)) from None
            heat.failure, heat.instant = str(failed), i
            return heat
        records[i], records[i, 6], records[i, 8] = heated.record, heated.steps, parts
        temperatures = heated.temperatures
        T = temperatures.across.temperature
        heat.highest[i] = T.max(), T[:, 0].max(), T[:, -1].max()
        heat.balance[i, :5], heat.balance[i, 6] = temperatures.balance, temperatures.missing
        heat.balance[i, 5], heat.traction[i] = temperatures.storage.heat[0], heated.traction
        heat.passes[i] = heated.passes
        if i in places:
            place, nodes = places[i], contact.nodes
            pressures[place], films[place] = heated.state.P, heated.state.H
            heat.temperature[place] = temperatures.everywhere(T.T, nodes).T
    return heat
