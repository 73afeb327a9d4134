"""``tribodyn surrogate``."""

from __future__ import annotations

import math
from json import loads
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import Flag, Output, Words, changed_case, read_changes
from tribodyn.drawing import finite
from tribodyn.errors import InputError, Problem, collected
from tribodyn.files import check_new
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.surrogate import Surrogate


def surrogate(
    action: Literal["train", "predict"],
    source: str,
    /,
    *values: str,
    size: int = 256,
    seed: int = 1,
    out: Output = None,
    set_: Words = None,
    json: Flag = False,
) -> None:
    """Learn the steady response of a case from computed operating points, or predict with it.

    Parameters
    ----------
    action : str
        train computes operating points of a case and learns from them; predict evaluates a model.
    source : str
        Of train a built-in case or path of a case file; of predict the file of a model.
    values : str
        Of train ranges, such as "operation.speed=400 rpm .. 3000 rpm"; by default torque, speed,
        friction, stiffness and roughness from 0.7 to 1.3 times those of the case. Of predict
        values, such as "operation.speed=1400 rpm".
    size : int
        Operating points that are computed, best a power of two.
    seed : int
        The same seed gives the same model.
    out : Path
        File of the model; by default that of the case with "-surrogate.nc".
    set_ : list of str
        Values of the case to change, for example "friction.law=xu-2007".
    json : bool
        Write errors or predictions in SI as one JSON object to stdout.
    """
    if action == "predict":
        _predict(source, values, json)
    else:
        _train(source, values, (size, seed), (out, set_ or []), json)


def _train(
    source: str,
    values: tuple[str, ...],
    draw: tuple[int, int],
    places: tuple[Path | None, list[str]],
    json: bool,
) -> None:
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.study.uncertain.operating_data import operating_data
    from tribodyn.surrogate import Training, train

    (size, seed), (out, settings) = draw, places
    place = out if out is not None else Path(f"{Path(source).stem}-surrogate.nc")
    path = check_new(place, "--out")
    over = {key: str(value) for key, value in read_changes(values).items()} or None
    case = changed_case(source, settings, "surrogate")
    with collected() as warnings, progress_bar() as progress:
        data = operating_data(case, over, size, seed=seed, progress=progress)
        inputs = list(loads(data.settings)["over"])
        response = [name for name in data.columns if name not in inputs]
        varied = [name for name in response if np.ptp(data[name]) > 1e-9 * abs(data[name]).max()]
        shares = Training(shares=(7.0, 1.0, 2.0))
        model = train(
            data, features=inputs, targets=varied, seed=seed, training=shares, progress=progress
        )
    show_warnings(warnings)
    model.save(path)
    if json:
        facts = {
            name: {**vars(error_of), "band": finite(half), "unit": str(unit)}
            for (name, error_of), half, unit in zip(
                model.errors.items(), model.band, model.target_unit, strict=True
            )
        }
        say_json({"model": str(path), "features": inputs, "level": model.level, "errors": facts})
    else:
        say("\n".join([case.title, *_error_lines(model)]))
    tell(f"Model: {path}")


def _error_lines(model: Surrogate) -> list[str]:
    """Errors over the held-out points, one line for each target."""
    head = ["target", "R^2", "mean relative error", "largest error", f"{model.level:.0%} band"]
    rows = [
        [
            name,
            f"{error_of.determination:.5f}",
            f"{100.0 * error_of.mean_absolute_relative:.3g} %",
            f"{error_of.largest:.3g} {_unit(unit)}",
            f"+- {half:.3g} {_unit(unit)}" if math.isfinite(half) else "open",
        ]
        for (name, error_of), half, unit in zip(
            model.errors.items(), model.band, model.target_unit, strict=True
        )
    ]
    count = model.true.shape[1]
    least = math.ceil(model.level / (1.0 - model.level))
    too_few_note = f" A band of {model.level:.0%} takes {least} of them; give --size more."
    return [
        f"Learned from {model.training_rows} operating points, errors over {count} others."
        + (too_few_note if count < least else ""),
        table([head, *rows]),
    ]


def _unit(text: str) -> str:
    """Return the unit for display; none for a pure number."""
    return "" if text == "1" else str(text)


def _predict(source: str, values: tuple[str, ...], json: bool) -> None:
    from tribodyn.surrogate import load

    model = load(source)
    inputs = _inputs(model, read_changes(values))
    with collected() as warnings:
        predictions, bands = model.predict(inputs), model.predict_band(inputs)
    show_warnings(warnings)
    rows, facts = [["target", "prediction", f"{model.level:.0%} band"]], {}
    for name, unit in zip(model.targets, model.target_unit, strict=True):
        value, (low, high) = float(predictions[name]), map(float, bands[name])
        band = f"{low:.6g} to {high:.6g} {_unit(unit)}" if math.isfinite(high) else "open"
        rows.append([str(name), f"{value:.6g} {_unit(unit)}", band])
        ends = {"low": finite(low), "high": finite(high)}
        facts[str(name)] = {"value": value, **ends, "unit": str(unit)}
    say_json(facts) if json else say(table(rows))


def _inputs(model: Surrogate, values: Tree) -> dict[str, float]:
    """Values of the features in SI."""
    from tribodyn.units import UnitProblemError, parse

    units = dict(zip(map(str, model.features), map(str, model.feature_unit), strict=True))
    problems = [
        Problem(f"{name} is no input of this model", name, f"It has {', '.join(units)}", "Use one")
        for name in values
        if name not in units
    ]
    problems += [
        Problem(f"{name} is missing", name, "", f'Write "{name}=VALUE {_unit(unit)}'.strip() + '"')
        for name, unit in units.items()
        if name not in values
    ]
    inputs = {}
    for name, value in values.items():
        try:
            inputs[name] = parse(str(value), units.get(name, "1").removeprefix("1"))
        except UnitProblemError as error:
            problems.append(Problem(str(error), name, "", "Give a number with its unit"))
    if problems:
        raise InputError(problems)
    return inputs
