"""Data set of repeated runs of a case: over time as published, or over the mesh cycle."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

import tribodyn
from tribodyn.errors import Argument, InputError, collected, require_one_of, require_positive, warn
from tribodyn.nomenclature import require_flag, require_whole
from tribodyn.nonlinear.parameter_map import SCALES
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.motion import engine_arguments
from tribodyn.study.uncertain.cycles import SIGNALS, signals_at, steady_cycles
from tribodyn.study.uncertain.data_set import DataSet
from tribodyn.study.uncertain.lanes import Lanes, draw, lanes_of
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.dynamics.time.engines import FixedMarcher
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase

#: Stiffness and friction as the source of the data set spreads them.
SPREAD = {"stiffness_scale": "1 +- 0.83 %", "friction_scale": "1 +- 0.83 %"}
#: Columns in addition to those of the motion, with their units.
_TIME_COLUMNS = {"trajectory": "1", "time": "s", "phase": "1", "cos_phase": "1", "sin_phase": "1"}


def vibration_data(
    case: PairCase,
    *,
    seed: int,
    distributions: Mapping[str, object] | None = None,
    trajectories: int = 100,
    over: Literal["time", "cycle"] = "time",
    samples: int = 100,
    interval: float = 0.01,
    redraw: bool = True,
    progress: Progress = SILENT,
) -> DataSet:
    """Rows of repeated runs of a case with spread inputs, to learn vibrations from.

    Parameters
    ----------
    case : PairCase
        From :func:`tribodyn.load_case`.
    seed : int
        The same seed gives the same table.
    distributions : mapping, optional
        Inputs that are spread, as :func:`tribodyn.uncertainty.sample` reads them: keys of the
        case, or the factors ``stiffness_scale``, ``damping_scale``, ``friction_scale``,
        ``error_scale``, ``gap_scale`` and ``force_scale`` [-]. By default those that the case
        itself spreads; where it has none, stiffness and friction with a standard deviation of
        0.83 %, cut at three of them.
    trajectories : int
        Repeated runs.
    over : {"time", "cycle"}
        ``"time"``: every ``interval`` of the motion from rest under load, its transient included.
        ``"cycle"``: evenly over one mesh cycle of the motion that repeats.
    samples : int
        Rows of every run.
    interval : float
        Time between two rows [s].
    redraw : bool
        Over time: draw new factors for every row, not once for every run.
    progress : Progress
        Receives the progress of the computation; silent by default.

    Returns
    -------
    DataSet
        Columns ``trajectory``, ``time`` [s], ``phase``, ``cos_phase``, ``sin_phase``, the drawn
        inputs, ``mesh_stiffness`` [N/m], ``friction_coefficient``, ``backlash_function`` [m],
        ``transmission_error`` [m], ``dynamic_transmission_error`` [m], ``mesh_force`` [N] and the
        ``acceleration`` of the smaller gear along the line of action [m/s^2].

    Raises
    ------
    InputError
        If an input cannot be spread, an argument is out of its range, or the interval is shorter
        than a mesh cycle.

    Warns
    -----
    ModelWarning
        ``data-aliased`` where rows over time are further apart than a quarter of a mesh cycle.
    """
    require_one_of("over", over, ("time", "cycle"))
    require_flag("redraw", redraw)
    require_positive("interval", interval, "s")
    count, rows = require_whole("trajectories", trajectories), require_whole("samples", samples)
    spread = dict((case.uncertain or SPREAD) if distributions is None else distributions)
    draws = rows if over == "time" and redraw else 1
    sampled = draw(case, spread, count * draws, seed=seed)
    first = {name: values.reshape(count, draws)[:, 0] for name, values in sampled.items()}
    lanes = lanes_of(case, first, progress)
    if over == "cycle":
        columns = _over_cycle(lanes, rows, progress)
    else:
        if draws > 1 and (keys := sorted(set(spread) - set(SCALES))):
            what = f"{', '.join(keys)} cannot change while the gears turn"
            why = "A key is that of a whole run"
            remedy = "Give redraw=False, or spread the factors "
            raise InputError(what, Argument("redraw"), why, remedy + ", ".join(SPREAD))
        columns = _over_time(case, lanes, sampled, (rows, float(interval)), progress)
    inputs = {
        name: np.repeat(values, count * rows // values.size) for name, values in sampled.items()
    }
    columns = {
        "trajectory": np.repeat(np.arange(count, dtype=float), rows),
        **inputs,
        **columns,
        "cos_phase": np.cos(2.0 * np.pi * columns["phase"]),
        "sin_phase": np.sin(2.0 * np.pi * columns["phase"]),
    }
    settings = {
        "distributions": {k: str(v) for k, v in spread.items()},
        "seed": int(seed),
        "trajectories": count,
        "over": over,
        "samples": rows,
        "interval": float(interval),
        "redraw": bool(redraw),
    }
    return data_set("vibration_data", case, columns, settings)


def data_set(kind: str, case: AnyCase, columns: dict[str, Array], settings: Tree) -> DataSet:
    """Columns with their units and their origin."""
    signal_units = {**_TIME_COLUMNS, **SIGNALS}
    specs = {name: case.option_of(name) for name in columns}
    units = {
        name: signal_units.get(name) or (spec.unit if spec else "") or "1"
        for name, spec in specs.items()
    }
    description = json.dumps({"made_by": kind, **settings}, sort_keys=True)
    return DataSet(columns, units, case.to_toml(), description, tribodyn.__version__)


def _over_cycle(lanes: Lanes, rows: int, progress: Progress) -> dict[str, Array]:
    cycles = steady_cycles(lanes, rows, progress)
    phase = np.tile(cycles.phase, lanes.count)
    time = phase / np.repeat(lanes.mesh_frequency, rows)
    return {
        "time": time,
        "phase": phase,
        **{name: values.reshape(-1) for name, values in cycles.signals.items()},
    }


def _over_time(
    case: PairCase,
    lanes: Lanes,
    sampled: Mapping[str, Array],
    places: tuple[int, float],
    progress: Progress,
) -> dict[str, Array]:
    """Simulate all lanes from rest, and sample them at even times."""
    frequency = float(lanes.mesh_frequency[0])
    if np.ptp(lanes.mesh_frequency) > 0.0 or len({id(each) for each in lanes.members}) > 1:
        what, why = "runs that differ in speed or tooth contact", "Rows over time share one grid"
        raise InputError(what, Argument("distributions"), why, 'Give over="cycle"')
    rows, interval = places
    at = frequency * interval * np.arange(1, rows + 1)
    cycle = np.floor(at * (1.0 + 1e-12)).astype(int)
    if np.any(np.diff(cycle, prepend=-1) < 1):
        what, why = f"interval = {interval:g} s", f"A mesh cycle takes {1.0 / frequency:.3g} s"
        raise InputError(what, Argument("interval"), why, 'Give over="cycle"')
    if interval * frequency > 0.25:
        warn(
            "data-aliased",
            f"{interval * frequency:.3g} mesh cycles lie between two rows: the "
            'mesh vibration between them is lost. over="cycle" resolves it.',
            stacklevel=4,
        )
    marched = _March(case, lanes)
    signals = {name: np.empty((lanes.count, rows)) for name in SIGNALS}
    factors = {
        name: np.asarray(values).reshape(lanes.count, -1) for name, values in sampled.items()
    }
    progress.start("Rows over time", rows)
    for row, (cycle_number, place) in enumerate(zip(cycle, at, strict=True)):
        if factors and next(iter(factors.values())).shape[1] > 1:
            marched.change({name: values[:, row] for name, values in factors.items()})
        values_by_name = marched.at(
            int(cycle_number), float(np.clip(place - cycle_number, 0.0, 1.0))
        )
        for name, values in values_by_name.items():
            signals[name][:, row] = values
        progress.advance()
    progress.finish()
    time = np.tile(at / frequency, lanes.count)
    phase = np.tile(np.clip(at - cycle, 0.0, 1.0), lanes.count)
    return {
        "time": time,
        "phase": phase,
        **{name: values.reshape(-1) for name, values in signals.items()},
    }


class _March:
    """Time integration of lanes of one structure from their static state, with samples."""

    def __init__(self, case: PairCase, lanes: Lanes) -> None:
        from tribodyn.dynamics import LaneParameters, steady_state
        from tribodyn.dynamics.equations.orbit_coordinates import static_start
        from tribodyn.dynamics.time.engines import Setting, prepare

        self.lanes, self.member = lanes, lanes.members[0]
        system, steps = self.member.system, int(lanes.steps.max())
        extra = np.zeros((lanes.count, system.size))
        if system.balance is not None:
            with collected():
                extra += steady_state(
                    system, float(lanes.mesh_frequency[0]), steps=steps
                ).extra_force
        widest = {
            name: np.full(lanes.count, 1.1 * values.max()) for name, values in lanes.factors.items()
        }
        setting = Setting(system, lanes.mesh_frequency, 1, steps, extra, LaneParameters(**widest))
        backend = engine_arguments(case).get("backend")
        self.marcher = cast("FixedMarcher", prepare("rk4", setting, backend=backend))
        self.parameters, self.elapsed = lanes.parameters(), 0
        self.state = np.tile(static_start(self.marcher.compiled), (lanes.count, 1))

    def change(self, factors: dict[str, Array]) -> None:
        """Give the lanes other factors from the next mesh cycle on."""
        from tribodyn.dynamics import LaneParameters

        self.parameters = LaneParameters(**factors)

    def at(self, cycle: int, phase: float) -> dict[str, Array]:
        """Integrate to a mesh cycle, and return its signals at a phase."""
        from tribodyn.dynamics.equations.motion import Scales, forces, rows_within

        self.marcher.setting = self.marcher.setting._replace(parameters=self.parameters)
        if cycle > self.elapsed:
            self.state = self.marcher.march(self.state, cycle - self.elapsed, elapsed=self.elapsed)
        compiled = self.marcher.compiled
        states = np.empty((compiled.grid.steps + 1, self.state.shape[1], self.lanes.count))
        self.state = self.marcher.march(self.state, 1, record=states, elapsed=cycle)
        self.elapsed = cycle + 1
        edges = np.append(compiled.grid.left, 1.0)
        step = min(int(np.searchsorted(edges, phase, side="right")) - 1, compiled.grid.steps - 1)
        tau = (phase - edges[step]) / compiled.grid.width[step]
        h = compiled.grid.width[step] / float(self.lanes.mesh_frequency[0])
        q, v = _hermite(states[step : step + 2], tau, h)
        rows = rows_within(compiled.nodes, np.array([step]), np.array([tau]))
        table = self.parameters.table(self.lanes.count)
        scales, system = Scales(*(column[:, None, None] for column in table.T)), self.member.system
        beat = self.lanes.mesh_frequency[:, None, None]
        law = forces(system, rows, beat, q[:, None], v[:, None], scales=scales,
                     extra=self.marcher.setting.extra_force[:, None])  # fmt: skip
        values_by_name = signals_at(system, self.member.mesh, rows, law, table[:, None, :])
        return {
            name: np.broadcast_to(values, (self.lanes.count, 1))[:, 0]
            for name, values in values_by_name.items()
        }


def _hermite(ends: Array, tau: float, h: float) -> tuple[Array, Array]:
    """Position and velocity (lanes, n) of the cubic through both ends of a step (2, 2 n, lanes)."""
    (q0, v0), (q1, v1) = (np.split(end.T, 2, axis=1) for end in ends)
    a, b = (1.0 + 2.0 * tau) * (1.0 - tau) ** 2, tau**2 * (3.0 - 2.0 * tau)
    q = a * q0 + b * q1 + h * tau * (1.0 - tau) * ((1.0 - tau) * v0 - tau * v1)
    slope = 6.0 * tau * (1.0 - tau) / h
    v = slope * (q1 - q0) + (1.0 - tau) * (1.0 - 3.0 * tau) * v0 + tau * (3.0 * tau - 2.0) * v1
    return q, v
