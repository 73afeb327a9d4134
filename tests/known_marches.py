"""Compiled systems marched by each engine, without the checks and the record of `simulate`."""

import numpy as np

from tribodyn.dynamics._engine.adaptive_engine import adaptive_lanes, lane_groups
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import compile_lanes
from tribodyn.dynamics.time.engines import AdaptiveMarcher, Setting
from tribodyn.dynamics.time.newmark import newmark_method
from tribodyn.interrupt import in_threads


def compile_newmark(system, mesh_frequency, steps, *, gamma=0.5, beta=0.25):
    """A system on its grid, whose steps the scheme can take at its lowest mesh frequency."""
    compiled = compile_lanes(system, mesh_frequency, steps, any_step=True)
    slowest = np.array([1.0 / np.min(np.asarray(mesh_frequency, dtype=float))])
    newmark_method(compiled, slowest, gamma, beta)
    return compiled


def march_newmark(
    compiled, period, state, cycles, *, gamma=0.5, beta=0.25, tolerance=1e-12, **options
):
    """March lanes by Newmark's scheme."""
    parameters = options.get("parameters")
    method = newmark_method(compiled, period, gamma, beta, tolerance, parameters)
    return march(compiled, period, state, cycles, method=method, **options)


def march_adaptive(
    compiled, period, state, cycles, *, rtol=1e-6, extra_force=None, parameters=None, **options
):
    """March lanes in adaptive steps, with records on the grid of the compiled system."""
    frequency = 1.0 / np.asarray(period, dtype=float)
    extra = np.zeros((frequency.size, compiled.system.size)) if extra_force is None else extra_force
    setting = Setting(compiled.system, frequency, cycles, compiled.grid.steps, extra, parameters)
    return AdaptiveMarcher(setting, compiled, rtol, None).march(state, cycles, **options)


def march_one(system, frequency, state, cycles, *, rtol=1e-6, points=None, record=None):
    """March one lane in adaptive steps; returns steps, rejections and crossings."""
    lanes = np.array([float(frequency)]), cycles, np.zeros((1, system.size))
    (lane,) = adaptive_lanes([(system, np.arange(1))], *lanes, rtol)
    grid = np.zeros(1) if points is None else np.ascontiguousarray(points)
    rows = None if record is None else np.ascontiguousarray(record[None, :, :, 0])

    def run(state):
        return lane_groups([lane], 1)[0].march(state[None], cycles, grid, 0, rows)

    (courses,) = in_threads(run, [state.copy()], 1)
    if rows is not None:
        record[:, :, 0] = rows[0]
    return courses.steps[0], courses.rejections[0], courses.crossings[0]
