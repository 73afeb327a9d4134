"""Registry of the time integration engines: their options, preparation and integration of lanes."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from tribodyn.dynamics._engine.adaptive_engine import (
    LaneGroup,
    Tolerance,
    adaptive_lanes,
    lane_groups,
)
from tribodyn.dynamics._engine.blocks import Backend, LaneBlock, Run, march, marching_on
from tribodyn.dynamics._engine.method import Newmark, RungeKutta4
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.compiled import Compiled, compile_lanes, sample_system
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.modal.modal_march import ModalMarcher, is_modal
from tribodyn.dynamics.time.newmark import newmark_law, newmark_method
from tribodyn.errors import InputError, require_one_of
from tribodyn.interrupt import in_threads
from tribodyn.model import Model, Registry, choice, number
from tribodyn.types import Array

#: Methods of time integration.
Method = Literal["rk4", "dormand-prince", "newmark", "modal"]


class Setting(NamedTuple):
    """Lanes to integrate."""

    systems: System | Sequence[System]
    frequency: Array  #: mesh frequency of every lane [Hz]
    cycles: int
    steps: int
    extra_force: Array  #: of every lane (lanes, n)
    parameters: LaneParameters | None = None


class FixedMarcher:
    """Integrate lanes with the fixed steps of the grid."""

    def __init__(
        self,
        setting: Setting,
        compiled: Compiled,
        method: RungeKutta4 | Newmark,
        backend: Backend | None = None,
    ) -> None:
        self.setting, self.compiled, self.method = setting, compiled, method
        self.backend: Backend | None = backend

    def march(self, state: Array, cycles: int, **options: Any) -> Array:
        """Integrate over ``cycles`` mesh cycles."""
        setting = self.setting
        options |= {"extra_force": setting.extra_force, "parameters": setting.parameters}
        period = 1.0 / setting.frequency
        with marching_on(self.backend):
            return march(self.compiled, period, state, cycles, method=self.method, **options)


class AdaptiveMarcher:
    """Integrate lanes with adaptive steps of their own; the grid defines the samples."""

    def __init__(
        self, setting: Setting, compiled: Compiled, rtol: float, atol: Tolerance | None
    ) -> None:
        self.setting, self._compiled, self._step_number = setting, compiled, 0.0
        self.lanes = adaptive_lanes(
            [(member.system, member.lanes) for member in compiled.each(setting.frequency.size)],
            setting.frequency, setting.cycles, setting.extra_force, rtol, atol, setting.parameters,
        )  # fmt: skip

    @property
    def compiled(self) -> Compiled:
        """The systems on the grid of the samples, with the widest step so far."""
        return replace(self._compiled, step_number=self._step_number)

    def march(
        self,
        state: Array,
        cycles: int,
        *,
        record: Array | None = None,
        statistics: Statistics | None = None,
        threads: int | None = None,
        elapsed: int = 0,
    ) -> Array:
        """Integrate over ``cycles`` mesh cycles; with statistics, record one cycle at a time."""
        setting, points, new = self.setting, self._compiled.grid.left, state.copy()
        facts = 1.0 / setting.frequency, state, setting.extra_force
        run = Run(self._compiled, RungeKutta4(), setting.parameters, *facts)
        at_once, threads = cycles if statistics is None else 1, threads or os.cpu_count() or 1

        def march_group(group: LaneGroup) -> float:
            states, widest, rows = new[group.numbers], 0.0, None
            if record is not None or statistics is not None:
                rows = np.empty((len(states), at_once * points.size + 1, state.shape[1]))
            for before in range(elapsed, elapsed + cycles, at_once):
                courses = group.march(states, at_once, points, before, rows)
                rates = [lane.rate for lane in group.lanes]
                widest = max(widest, float(np.max(rates * courses.period * courses.widest)))
                if rows is not None and statistics is not None:
                    for number, lane_rows in zip(group.numbers, rows, strict=True):
                        block = LaneBlock(np.array([number]), 1)
                        run.gather(block, lane_rows[:, :, None], statistics, cycles)
                if rows is not None and record is not None:
                    first = (before - elapsed) * points.size
                    lanes = slice(first, first + rows.shape[1]), slice(None), group.numbers
                    record[lanes] = rows.transpose(1, 2, 0)
            new[group.numbers] = states
            return widest

        numbers = in_threads(march_group, lane_groups(self.lanes, threads), threads)
        self._step_number = max([self._step_number, *numbers])
        return new


#: Lanes whose integration continues from call to call.
Marcher = FixedMarcher | AdaptiveMarcher | ModalMarcher


def _runge_kutta(setting: Setting, backend: Backend | None = None) -> Marcher:
    with marching_on(backend):
        pass  # a missing processor is reported before anything is computed
    compiled = compile_lanes(setting.systems, setting.frequency, setting.steps, setting.parameters)
    return FixedMarcher(setting, compiled, RungeKutta4(), backend)


def _dormand_prince(
    setting: Setting, rtol: float | None = None, atol: Tolerance | None = None
) -> Marcher:
    compiled = _any_step(setting)
    return AdaptiveMarcher(setting, compiled, 1e-6 if rtol is None else rtol, atol)


def _newmark(
    setting: Setting,
    gamma: float | None = None,
    beta: float | None = None,
    preset: str | None = None,
) -> Marcher:
    gamma, beta = newmark_law(gamma, beta, preset)
    compiled = _any_step(setting)
    period, parameters = 1.0 / setting.frequency, setting.parameters
    method = newmark_method(compiled, period, gamma, beta, parameters=parameters)
    return FixedMarcher(setting, compiled, method)


def _modal(setting: Setting) -> Marcher:
    if not isinstance(setting.systems, System) or setting.parameters is not None:
        why = "Modal coordinates belong to one system"
        remedy = 'Use method = "rk4" for an ensemble of systems'
        raise InputError('method = "modal" with several systems', "argument method", why, remedy)
    compiled = sample_system(setting.systems, setting.steps)
    return ModalMarcher(compiled, setting.frequency, setting.extra_force)


def _any_step(setting: Setting) -> Compiled:
    return compile_lanes(
        setting.systems, setting.frequency, setting.steps, setting.parameters, any_step=True
    )


#: Preparation of each method from a :class:`Setting`, and the options of this method.
_BEGIN: Mapping[str, tuple[Callable[..., Marcher], tuple[str, ...]]] = {
    "rk4": (_runge_kutta, ("backend",)),
    "dormand-prince": (_dormand_prince, ("rtol", "atol")),
    "newmark": (_newmark, ("gamma", "beta", "preset")),
    "modal": (_modal, ()),
}


def automatic_method(system: System) -> Method:
    """Method for a system: large structures and ramps are integrated in modal coordinates."""
    return "modal" if is_modal(system) else "rk4"


def engine_name(method: str) -> str:
    """Name of the engine of a method."""
    return next((name for name in ENGINES if ENGINES[name].method == method), method)


def prepare(method: str, setting: Setting, **options: Any) -> Marcher:
    """Prepare the integration with a method or an engine of a case file; check its options."""
    engine = ENGINES[method].method if isinstance(method, str) and method in ENGINES else None
    name = require_one_of("method", engine or method, _BEGIN)
    begin, allowed = _BEGIN[name]
    chosen = {option: value for option, value in options.items() if value is not None}
    for option in [each for each in chosen if each not in allowed]:
        if chosen[option] == "cpu":
            del chosen[option]  # all engines run there
            continue
        owner = next(each for each, (_, others) in _BEGIN.items() if option in others)
        what = f'{option} = {chosen[option]} with method = "{method}"'
        remedy = f'Omit it, or set method = "{owner}"'
        raise InputError(what, f"argument {option}", f'It belongs to "{owner}"', remedy)
    return begin(setting, **chosen)


@dataclass(frozen=True)
class Engine(Model):
    """An engine that computes motions.

    Parameters
    ----------
    name : str
        Name in a case file.
    method : str, optional
        Its name in :func:`tribodyn.dynamics.simulate`; None for the one that suits the system.
    options : mapping of str to Option or default
        Its options; ``argument`` of each is the argument of that function.
    meaning : str
        Description in one line.
    papers : tuple of str
        Keys of the bibliography of the package.
    source : str
        Source of an engine without such a key.

    Examples
    --------
    >>> ENGINES["newmark"].arguments({"gamma": 0.5, "beta": 0.25})
    {'method': 'newmark', 'gamma': 0.5, 'beta': 0.25}
    """

    name: str
    method: Method | None
    options: Mapping[str, Any] = field(default_factory=dict)
    meaning: str = ""
    papers: tuple[str, ...] = ()
    source: str = ""

    def arguments(self, options: Mapping[str, Any]) -> dict[str, Any]:
        """Arguments of :func:`tribodyn.dynamics.simulate`.

        Parameters
        ----------
        options : mapping of str to object
            Options of this engine.

        Returns
        -------
        dict of str to object
        """
        named = {self.declared[name].argument or name: value for name, value in options.items()}
        return {"method": self.method, **named}


ENGINES: Registry[Engine] = Registry("engine", model=Engine, part="method")

for _engine in (
    Engine(
        "runge-kutta-4",
        "rk4",
        {
            "backend": choice(
                "cpu",
                {
                    "cpu": "this processor",
                    "cuda": "a graphics processor of NVIDIA, for thousands of motions at a time",
                },
                meaning="processor that marches the motions",
            ),
        },
        "steps of one length, of fourth order",
    ),
    Engine(
        "dormand-prince",
        "dormand-prince",
        {
            "relative_tolerance": number(
                1e-6, 1e-12, 1e-2, "a double carries 15 digits", argument="rtol",
                meaning="error of each state over its largest size so far", example="1e-6",
            ),
        },
        "steps as long as a tolerance allows, of fifth order",
        ("dormand-prince",),
    ),
    Engine(
        "newmark",
        "newmark",
        {
            "gamma": number(
                0.5, 0.5, 1.0, "below 1/2 it feeds energy in, above 1/2 it damps",
                meaning="weight of the acceleration at the end of a step in the velocity",
                example="0.5",
            ),
            "beta": number(
                0.25, 0.0, 0.5, "from constant to linear acceleration and beyond",
                meaning="weight of the acceleration at the end of a step in the position",
                example="0.25",
            ),
        },
        "implicit steps of one length, of second order: average acceleration",
        ("newmark",),
    ),
    Engine(
        "modal",
        "modal",
        {},
        "exact steps of every linear mode, of fourth order, for structures of many coordinates",
        source="exponential collocation with a parabola of the contact forces over each step",
    ),
    Engine(
        "harmonic-balance",
        None,
        {},
        "the periodic motion from the harmonics of the contact forces",
        source="Newton's method on the compressions of the contacts over a period",
    ),
    Engine(
        "auto",
        None,
        {},
        "harmonic balance where forces have no jumps and teeth stay in touch, else the march",
        source="the step error that harmonic balance states",
    ),
):  # fmt: skip
    ENGINES.register(_engine.name)(_engine)
