"""Arguments of every wrong kind end in an error of the package, in every public function."""

from __future__ import annotations

import contextlib
import datetime
import io
import math
import pickle
import traceback
import types
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike

from fuzz.damage import HangError, at_most
from fuzz.public_calls import SLOW, methods, parameters, public, results, working_calls
from registries import as_before
from tribodyn.arguments.reading import checked
from tribodyn.ehl import dowson_1968_minimum
from tribodyn.errors import ComputationError, InputError, ModelWarning, TribodynError
from tribodyn.units import UnitProblemError

#: Seconds of processor time that a call may take that is refused or small.
PATIENCE = 5.0

WRONG: list[Any] = [
    None, "", "x", "3 mm", "800 Hz", "y" * 20000, b"x", True, False, 0, 0.0, -1, -1.0, 0.5, 2.5, 3,
    10**400, 1e308, 1e-320, 1j, math.nan, math.inf, -math.inf, [], (), {}, {"x": 1}, set(), [1.0],
    [1.0, 2.0, 3.0], (0.0, 0.0), [math.nan, 1.0], [[1.0], [2.0, 3.0]], ["a", "b"], [None],
    np.array(["a"]), np.array(1.0), np.zeros((0, 2)), np.ones((2, 3)), np.ones(3, dtype=complex),
    np.array([object()]), np.float32(2.0), np.nan * np.ones(4), object(), object, lambda: 1.0,
    lambda phase: "text", lambda phase: None, datetime.datetime(2020, 1, 1), Path("nowhere"),
    types.SimpleNamespace(),
]  # fmt: skip

#: No value of an annotation of a single type.
_NO_NUMBER = (str, bytes, complex, list, dict, type(None), type)
NONSENSE = {
    # an array may stand for a number where a function computes with it
    "float": lambda value: isinstance(value, tuple({*_NO_NUMBER, bool} - {list})),
    "int": lambda value: isinstance(value, (*_NO_NUMBER, bool)),
    "bool": lambda value: not isinstance(value, bool | int | float | np.generic),
    "str": lambda value: not isinstance(value, str),
}


def fault(function: Any, sound: dict[str, Any], wrong: dict[str, Any]) -> str:
    """Return what is wrong with a call; empty after a sound message or a finite result."""
    kinds = {each.name: each.annotation for each in parameters(function)}
    try:
        with quietly(), at_most(PATIENCE):
            result = call(function, sound | wrong)
    except TribodynError as error:
        lacks = [problem for problem in error.problems if not problem.remedy or not problem.why]
        return f"no cause or no remedy: {lacks[0]}" if lacks else ""
    except UnitProblemError:
        return ""
    except HangError:
        return f"needs more than {PATIENCE} s"
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__} at {Path(place.filename).name}:{place.lineno}: {error}"
    for key, value in wrong.items():
        if kinds[key] in NONSENSE and NONSENSE[kinds[key]](value):
            return f"{key} is a {kinds[key]} and took {value!r:.30}"
    # A function may document NaN as a missing value, as that of the lubrication regime.
    documented = "NaN" in (function.__doc__ or "")
    return "" if documented or is_finite(result) else "a result that is not finite"


def call(function: Any, arguments: dict[str, Any]) -> Any:
    """Call a function that may take some of its arguments by position only."""
    first = [
        parameter.name
        for parameter in parameters(function)
        if parameter.kind is parameter.POSITIONAL_ONLY
    ]
    positional = [arguments[key] for key in first if key in arguments]
    return function(*positional, **{k: v for k, v in arguments.items() if k not in first})


@contextlib.contextmanager
def quietly() -> Iterator[None]:
    silent = contextlib.redirect_stdout(io.StringIO())
    with warnings.catch_warnings(), silent, contextlib.redirect_stderr(io.StringIO()):
        warnings.simplefilter("ignore", RuntimeWarning)
        warnings.simplefilter("ignore", ModelWarning)
        yield


def is_finite(result: Any) -> bool:
    if isinstance(result, float | np.ndarray) and np.asarray(result).dtype.kind in "fc":
        return bool(np.isfinite(result).all())
    return True


@pytest.fixture(scope="module")
def calls(request):
    """Each public callable with sound arguments; the quick ones alone without --runs."""
    return working_calls(bool(request.config.getoption("--runs")))


def test_every_public_callable_has_a_call_that_works(calls, request, tmp_path, monkeypatch):
    # The draws below would prove nothing of one that no sound argument reaches.
    monkeypatch.chdir(tmp_path)
    every = bool(request.config.getoption("--runs"))
    assert {name for name in public() if name not in calls} <= SLOW if every else len(calls) > 140
    failed = {}
    for name, (function, sound) in calls.items():
        try:
            with quietly(), as_before():
                call(function, sound) if name != "tribodyn.compare_results" else None
        except Exception as error:
            failed[name] = str(error)
    assert failed == {}


def test_arguments_of_wrong_kinds(calls, draws, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    every = [(name, each.name) for name, (f, _) in calls.items() for each in parameters(f)]
    failed = []
    for random in draws(200):
        name, first = random.choice(every)
        wrong = {first: random.choice(WRONG)}
        if random.random() < 0.2:
            second = random.choice([key for owner, key in every if owner == name])
            wrong[second] = random.choice(WRONG)
        with as_before():
            message = fault(*calls[name], wrong)
        if message:
            arguments = ", ".join(f"{key}={value!r:.30}" for key, value in wrong.items())
            failed.append(f"{name}({arguments}): {message}"[:300])
    assert not failed, "\n".join(failed)


def test_methods_of_results_with_arguments_of_wrong_kinds(calls, draws, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    every = [(instance, name) for instance in results() for name in methods(type(instance))]
    failed = []
    for random in draws(60):
        instance, name = random.choice(every)
        method = getattr(instance, name)
        wanted = [each for each in parameters(method) if each.default is each.empty]
        optional = [each for each in parameters(method) if each not in wanted]
        wanted += random.sample(optional, min(len(optional), random.choice((0, 1, 2))))
        wrong = {each.name: random.choice(WRONG) for each in wanted}
        message = fault(method, {}, wrong)
        if message:
            arguments = ", ".join(f"{key}={value!r:.30}" for key, value in wrong.items())
            failed.append(f"{type(instance).__name__}.{name}({arguments}): {message}"[:300])
    assert not failed, "\n".join(failed)


def documented_film(load_per_width: ArrayLike, effective_modulus: ArrayLike) -> Any:
    """Film of a contact.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Normal load per face width.
    effective_modulus : float or array [Pa]
        That of both bodies.
    """
    return np.asarray(load_per_width) * effective_modulus


@pytest.mark.parametrize(("value", "part"), [
    ("1 N/mm", "not texts"), (math.nan, "not NaN"), (True, "Wanted: numbers"),
    ([[1.0], [1.0, 2.0]], "even rows"), (2j, "Give load_per_width in N/m"),
])  # fmt: skip
def test_errors_use_the_unit_of_the_documentation(value, part):
    with pytest.raises(InputError) as refused:
        checked(documented_film)(value, "2 GPa")
    assert part in str(refused.value)
    places = [str(problem.where) for problem in refused.value.problems]
    assert places == ["argument load_per_width", "argument effective_modulus"]


def test_an_error_inside_a_function_is_reported_with_its_cause():
    names: dict[str, Any] = {}
    exec('def broken(size: float):\n    return size + "x"', names)
    broken = names["broken"]
    with pytest.raises(ComputationError, match="TypeError: unsupported operand") as caught:
        checked(broken)(1.0)
    assert isinstance(caught.value.__cause__, TypeError)
    with pytest.raises(InputError, match="missing a required argument: 'size'"):
        checked(broken)()


def test_what_the_package_itself_calls_is_not_read_again_but_what_its_user_calls_is():
    film = checked(documented_film)
    inside: dict[str, Any] = {"__name__": "tribodyn.somewhere", "film": film}
    exec(
        "def call(value): return film(value, 2.0)\ndef back(function): return function(1j)", inside
    )
    assert inside["call"](1j) == 2j  # the package answers for what it computes
    with pytest.raises(InputError, match="load_per_width"):
        inside["back"](lambda value: film(value, 2.0))  # a function that the user gave


def test_an_error_of_a_callback_is_reported_with_its_location():
    def calls(function: Callable[[float], float]) -> float:
        return function(1.0)

    class EndedError(Exception):
        pass

    def end(_):
        raise EndedError

    with pytest.raises(InputError, match="passed raised ZeroDivisionError") as caught:
        checked(calls)(lambda value: value / 0.0)
    assert "test_arguments.py:" in str(caught.value)
    with pytest.raises(EndedError):  # what the user raises on purpose is left
        checked(calls)(end)
    with pytest.raises(InputError, match="a function of 1 value"):
        checked(calls)(lambda: 1.0)


def test_positional_and_keyword_arguments_reach_their_parameters():
    def several(first: int, *others: float, last: str = "") -> tuple[object, ...]:
        return first, others, last

    assert checked(several)(1.0, 2, 3.0, last="x") == (1, (2, 3.0), "x")
    with pytest.raises(InputError) as refused:
        checked(several)("a", 2.0, "b", last=5)
    places = [str(problem.where).split()[-1] for problem in refused.value.problems]
    assert places == ["first", "others", "last"]


def test_functions_that_read_their_arguments_are_pickled_by_name():
    assert pickle.loads(pickle.dumps(dowson_1968_minimum)) is dowson_1968_minimum
