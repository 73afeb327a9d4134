"""Public functions and classes, each with arguments that it takes, read off the documentation.

The examples in the docstrings are run once; the calls written there, and the objects that come of
them, give every function and constructor a call that works.
"""

from __future__ import annotations

import ast
import contextlib
import doctest
import functools
import importlib
import inspect
import io
import os
import sys
import tempfile
import tomllib
import warnings
from collections.abc import Callable, Iterator, Mapping
from inspect import getattr_static
from pathlib import Path
from typing import Any

import numpy as np

from freeze.frozen_surface import PAGES
from tribodyn.aliases import Alias
from tribodyn.cases import case_files, run
from tribodyn.contact import path_of_contact
from tribodyn.drawing import FIGURES, Drawing
from tribodyn.dynamics import ENGINES, STRUCTURES
from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import ModelWarning, TribodynError
from tribodyn.friction import LAWS
from tribodyn.stiffness import MODELS

#: What reports errors and progress is called by programs, with texts of their own.
NO_PAGES = {"tribodyn.errors", "tribodyn.progress"}

#: Names of types for annotations, and what changes the registries of all that follows.
NO_CALLS = {
    "dynamics.Entry",
    "dynamics.MeshForce",
    "plot.drawing",
    "study.compare_results",
    "study.summary_figure",
    "cli.main",
}

#: Those whose examples need more than half a second, and what only these examples make.
_SLOW = """
cases.PaperComparison cases.compare_with_paper dynamics.Branch dynamics.HypoidSupports
dynamics.SpecialPoint dynamics.continuation exchange.write_tables gear.HypoidKinematics
gear.MisalignmentStudy gear.ToothContact gear.hypoid_kinematics gear.misalignment_study
gear.tooth_contact mesh.hypoid_loaded_contact
ehl.MixedLineContact ehl.mixed_line_contact plot.tooth_force mesh.moving_film
plot.continuation plot.flank_modification plot.friction_claims
plot.friction_effect plot.friction_harmonics plot.hypoid_contact plot.surrogate
plot.tip_relief_map stiffness.TipReliefOptimum stiffness.optimize_tip_relief study.DataSet
study.bifurcation study.friction_experiment study.load_data study.operating_data
study.optimize_tip_relief study.speed_sweep study.vibration_data variants.StudyState
surrogate.Squares surrogate.Training surrogate.bpnn_pl surrogate.load
variants.load_study variants.open_study variants.run_study variants.study_state
"""
SLOW = set(_SLOW.split())

#: Pages whose examples need no run, and no compiled solver: those of the draws in a hurry.
_PAGES = "contact ehl friction gear losses lubricant mesh stiffness surrogate uncertainty units"
_HEAVY = """
ehl.balanced_load_share ehl.solve_line_contact ehl.solve_line_contacts ehl.solve_line_contact_moes
ehl.solve_transient_line_contact mesh.build mesh.comprehensive_stiffness mesh.hypoid_friction
surrogate.train
"""

REGISTRIES: list[Any] = [ENGINES, STRUCTURES, FILM_MODELS, LAWS, MODELS, FIGURES]
_LOSSES = "speed [rpm], torque [N*m], torque_loss [N*m]\n1400, 50, 2.5\n"

Call = tuple[Callable[..., Any], dict[str, Any]]


def public() -> dict[str, Any]:
    """Functions, classes and figures of the pages by name, each once."""
    public_objects: dict[int, tuple[str, Any]] = {}
    for page in (page for page in PAGES if page not in NO_PAGES):
        module = importlib.import_module(page)
        for name in sorted(module.__all__):
            public_object = getattr(module, name)
            full_name = f"{page.removeprefix('tribodyn.')}.{name}"
            if (
                callable(public_object)
                and full_name not in NO_CALLS
                and not is_error(public_object)
            ):
                public_objects[id(public_object)] = full_name, public_object
    return dict(public_objects.values())


def is_error(public_object: Any) -> bool:
    """Whether a public name is an exception."""
    return isinstance(public_object, type) and issubclass(public_object, Exception)


def parameters(function: Any) -> list[inspect.Parameter]:
    """Parameters of a callable that take one value each."""
    every = inspect.signature(function).parameters.values()
    return [parameter for parameter in every if not parameter.kind.name.startswith("VAR")]


def quick(name: str) -> bool:
    """Whether a public name has an example that needs no time."""
    heavy = name in SLOW or name in _HEAVY.split()
    return not heavy and name.partition(".")[0] in _PAGES.split()


@functools.cache
def working_calls(every: bool = True) -> dict[str, Call]:
    """Public callables, each with named arguments of a call that works; all, or the quick ones."""
    public_objects = {
        name: public_object for name, public_object in public().items() if every or quick(name)
    }
    calls: dict[str, Call] = {}
    objects: dict[type, list[Any]] = {}
    _collect([dict(registry.all()) for registry in REGISTRIES], objects)
    with tempfile.TemporaryDirectory() as folder, _inside(folder), warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        for name, public_object in public_objects.items():
            arguments, left = _examples(name, public_object)
            _collect(left, objects)
            if arguments is not None:
                calls[name] = public_object, arguments
    for name, public_object in public_objects.items():
        arguments = (
            _figure_arguments(public_object, objects)
            if isinstance(public_object, Drawing)
            else _object_arguments(public_object, objects)
        )
        if name not in calls and arguments is not None:
            calls[name] = public_object, arguments
    kinds = {
        public_object
        for public_object in public_objects.values()
        if isinstance(public_object, type)
    }
    _RESULTS[:] = [instances[0] for kind, instances in objects.items() if kind in kinds]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return calls | _others(public_objects, objects, calls) if every else calls


_RESULTS: list[Any] = []


def results() -> list[Any]:
    """Objects that the examples made, of public classes."""
    return _RESULTS


def methods(kind: type) -> list[str]:
    """Public methods of a class that neither show nor open anything."""
    names = [name for name in dir(kind) if not name.startswith("_") or name == "__call__"]
    left = {"show", "open", "write_image"}.union(dir(tuple))
    left |= {name for name in names if isinstance(getattr_static(kind, name), Alias)}
    return [name for name in names if name not in left and callable(getattr(kind, name))]


def _others(
    public_objects: Mapping[str, Any], objects: Mapping[type, list[Any]], calls: Mapping[str, Call]
) -> dict[str, Call]:
    """Calls whose arguments are files, or what no example leaves behind."""
    of = {kind.__name__: instances for kind, instances in objects.items()}
    case, result, film = of["PairCase"][0], of["PairResult"][0], of["LineContactSolution"][0]
    functions = result.mesh.functions()
    build, pair = calls["mesh.build"]
    mesh = build(**pair | {"film_model": "newton", "film_options": {"nodes": 65}, "steps": 16})
    text = case_files()["fzg-roughness"].read_text("utf-8")
    folder = Path(tempfile.mkdtemp())
    result.save(folder / "result")
    (folder / "loss.csv").write_text(_LOSSES, "utf-8")
    motion = path_of_contact(of["SpurPair"][0]).kinematics(np.array([0.0]), 100.0)
    rexs = folder / "gears.rexs"
    public_objects["exchange.write_rexs"](case, rexs)
    gearbox = public_objects["exchange.read_rexs"](rexs)
    time = np.arange(4000) / 1000.0
    wave = np.sin(300.0 * time)
    spread = {"operation.speed": "500 rpm +- 1 %"}
    study = {"case": case, "path": "study.html", "told": ["one line"], "head": ["a", "b"],
             "rows": [["1", "2"]]}  # fmt: skip
    arguments_by_name: dict[str, dict[str, Any]] = {
        "analysis.Peak": {"frequency": 1.0, "amplitude": 2.0, "phase": 0.5},
        "cases.load_result": {"directory": folder / "result"},
        "cli.call": {"arguments": ["cases"]},
        "contact.Kinematics": _fields(motion),
        "exchange.GearboxModel": _constructor_arguments(
            public_objects["exchange.GearboxModel"], gearbox
        ),
        "exchange.Load": _constructor_arguments(public_objects["exchange.Load"], gearbox.loads[0]),
        "exchange.Stage": _constructor_arguments(
            public_objects["exchange.Stage"], gearbox.stages[0]
        ),
        "exchange.StageGear": _constructor_arguments(
            public_objects["exchange.StageGear"], gearbox.stages[0].gear_1
        ),
        "exchange.case_from_rexs": {"model": gearbox, "stage": gearbox.stages[0].id},
        "exchange.read_rexs": {"path": rexs},
        "exchange.write_rexs": {"case": case, "path": "gears.rexs", "force": True},
        "ehl.asperity_integral": {"separation_ratio": [0.0, 1.0]},
        "ehl.film_load_share": {"film_ratio": [0.5, 2.0]},
        "gear.MeshGeometry": _constructor_arguments(
            public_objects["gear.MeshGeometry"], of["SpurPair"][0]
        ),
        "gear.SpurPair": _constructor_arguments(public_objects["gear.SpurPair"], of["SpurPair"][0]),
        "losses.read_power_loss_table": {"path": folder / "loss.csv", "gear_loss_factor": 0.19},
        "measurement.order_map": {
            "signal": wave,
            "angle": 100.0 * time,
            "max_order": 4.0,
            "sample_rate": 1000.0,
        },
        "mesh.MeshColumns": _constructor_arguments(public_objects["mesh.MeshColumns"], result.mesh),
        "mesh.MeshFunctions": _fields(functions),
        "mesh.PhaseFunction": _fields(functions.stiffness),
        "plot.bands": {"result": public_objects["study.ensemble"](case, spread, 3, seed=1)},
        "plot.coupling": {"result": run(case.replace({"solver.coupling": "static"}))},
        "plot.compare_line_contacts": {"solutions": [film], "labels": ["one"]},
        "plot.film_along_path": {"contacts": [film, film], "path": [0.0, 1e-3]},
        "plot.film_over_time": {"transient": of["TransientLineContact"][0]},
        "plot.film_pressure": {"result": mesh},
        "plot.film_response": {"solution": film, "frequencies": [1.0, 10.0]},
        "report.render_report": {"result": result},
        "report.write_report": {"result": result, "path": "run.html"},
        "report.write_sweep_report": {"found": of["Sweep"][0], "path": "sweep.html"},
        "report.write_study_report": {**study, "kind": "A study", "figures": []},
        "report.write_bifurcation_report": {**study, "found": of["Bifurcation"][0], "lead": "One"},
        "tribodyn.cases": {},
        "study.Case": tomllib.loads(text),
        "study.read_case": {"text": text, "name": "my.toml"},
    }
    return {
        name: (public_objects[name], arguments)
        for name, arguments in arguments_by_name.items()
        if name in public_objects
    }


def _constructor_arguments(constructor: Any, source: Any) -> dict[str, Any]:
    """Arguments of a constructor, of the attributes of an object that has them."""
    names = [parameter.name for parameter in parameters(constructor)]
    return {name: getattr(source, name) for name in names if hasattr(source, name)}


@contextlib.contextmanager
def _inside(folder: str) -> Iterator[None]:
    before = os.getcwd()
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            yield
    finally:
        os.chdir(before)


def _examples(name: str, public_object: Any) -> tuple[dict[str, Any] | None, dict[str, Any]]:
    """Arguments of the first call in the examples of a docstring, and the names left by them."""
    function = getattr(public_object, "__wrapped__", public_object)
    module = sys.modules.get(getattr(function, "__module__", ""))
    names = dict(vars(module)) if module else {}
    before, arguments = set(names), None
    for example in doctest.DocTestParser().get_examples(inspect.getdoc(public_object) or ""):
        with contextlib.suppress(Exception):
            for call in ast.walk(ast.parse(example.source)):
                if arguments is None and isinstance(call, ast.Call) and _calls(call, name):
                    arguments = _bound(public_object, call, names)
        with contextlib.suppress(Exception):
            exec(example.source, names)
    return arguments, {key: value for key, value in names.items() if key not in before}


def _calls(call: ast.Call, name: str) -> bool:
    return ast.unparse(call.func).rpartition(".")[2] == name.rpartition(".")[2]


def _bound(function: Any, call: ast.Call, names: dict[str, Any]) -> dict[str, Any] | None:
    """Arguments of a call as it is written, by name; None if the call does not work."""
    text = ast.unparse(ast.Call(ast.Name("_given"), call.args, call.keywords))
    bind = inspect.signature(function).bind
    bound = eval(text, names | {"_given": bind})
    try:
        result = function(*bound.args, **bound.kwargs)
    except TribodynError:
        return None
    names["_result"] = result
    several = [parameter.name for parameter in inspect.signature(function).parameters.values()
               if parameter.kind.name.startswith("VAR")]  # fmt: skip
    return {key: value for key, value in bound.arguments.items() if key not in several}


def _collect(values: Any, objects: dict[type, list[Any]], depth: int = 4) -> None:
    """Keep the objects of the package, and what they hold, by class."""
    if depth < 0:
        return
    if isinstance(values, Mapping):
        values = list(values.values())
    if isinstance(values, list | tuple):
        for value in values[:50]:
            _collect(value, objects, depth - 1)
    kind = type(values)
    if not kind.__module__.startswith("tribodyn") or len(objects.get(kind, ())) > 3:
        return
    if not any(values is other for other in objects.setdefault(kind, [])):
        objects[kind].append(values)
        _collect(_fields(values), objects, depth - 1)


def _fields(value: Any) -> dict[str, Any]:
    """What an object was made of."""
    return _constructor_arguments(type(value), value)


def _object_arguments(kind: Any, objects: Mapping[type, list[Any]]) -> dict[str, Any] | None:
    """Arguments of the constructor of a class of which there is an object."""
    return _fields(objects[kind][0]) if kind in objects else None


def _figure_arguments(drawing: Drawing, objects: Mapping[type, list[Any]]) -> dict[str, Any] | None:
    """Result that a figure draws."""
    for values in objects.values():
        for value in values:
            with contextlib.suppress(AttributeError):
                if not drawing.missing(value):
                    return {"result": value}
    return None
