"""Arguments of every wrong kind end in an error of the package, in every argument of a function."""

import inspect
import warnings

import numpy as np
import pytest

from tribodyn.dynamics import (
    Contact,
    LaneParameters,
    LoadFriction,
    System,
    recommended_steps,
    simulate,
    solve_adaptive,
    steady_state,
)
from tribodyn.ehl import solve_line_contact, solve_line_contact_moes, solve_line_contacts
from tribodyn.errors import ModelWarning, TribodynError
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
SYSTEM = System([[1.0]], [[0.5]], [[0.0]], [1.0], [Contact([1.0], 9.0, gap=0.1)])
START = ([0.1], [0.0])

#: Functions and classes with arguments that they take.
SOUND = {
    Contact: {"direction": [1.0], "stiffness": 1.0},
    LoadFriction: {"direction": [1.0], "coefficients": 0.1, "load": 1.0},
    System: {"mass": [[1.0]], "damping": [[0.1]], "stiffness": [[1.0]], "force": [1.0]},
    LaneParameters: {},
    steady_state: {"system": SYSTEM, "mesh_frequency": 1.0, "steps": 64},
    simulate: {"system": SYSTEM, "mesh_frequency": 1.0, "cycles": 1, "start": START, "steps": 64},
    solve_adaptive: {"system": SYSTEM, "mesh_frequency": 1.0, "cycles": 1, "start": START},
    recommended_steps: {"system": SYSTEM, "mesh_frequency": 1.0},
    solve_line_contact: {"load_per_width": 1e5, "equivalent_radius": 8e-3, "entrainment_speed": 3.0,
                         "lubricant": OIL, "effective_modulus": 2.2e11, "nodes": 65},
    solve_line_contacts: {"load_per_width": 1e5, "equivalent_radius": 8e-3,
                          "entrainment_speed": 3.0, "lubricant": OIL,
                          "effective_modulus": 2.2e11, "nodes": 65},
    solve_line_contact_moes: {"M": 20.0, "L": 5.0, "nodes": 65},
}  # fmt: skip

WRONG = [
    "x", b"x", 1j, {}, np.nan, np.inf, -1.0, 0.0, 10**400, 1e308, [], [1.0, 2.0, 3.0],
    [[1.0], [2.0, 3.0]],
    np.array(["a"]), np.zeros((0, 2)), object(), lambda phase: "text", 2.5, "800 Hz", None,
]  # fmt: skip


def _is_told(function, arguments):
    """A call ends with a result or with an error of the package."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        try:
            function(**arguments)
        except TribodynError as error:
            return bool(str(error))
    return True


def _places():
    return [
        (function, name)
        for function, sound in SOUND.items()
        for name, each in inspect.signature(function).parameters.items()
        if name in sound or each.default is not each.empty
        if name not in ("progress", "threads", "system", "keep_solutions")
    ]


def test_arguments_of_wrong_kinds(draws):
    places = _places()
    every = [(place, value) for place in range(len(places)) for value in range(len(WRONG))]
    failed = []
    for drawn in draws(150):
        place, wrong = drawn.choice(every)
        (function, name), value = places[place], WRONG[wrong]
        try:
            assert _is_told(function, SOUND[function] | {name: value})
        except Exception as error:
            failed.append(f"{function.__name__}({name}={str(value)[:30]}): {error!r}"[:200])
    assert not failed, "\n".join(failed)


@pytest.mark.parametrize("function", SOUND)
def test_the_sound_arguments_are_taken(function):
    # A refusal of what is sound would raise here, and the draws above would prove nothing.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        assert function(**SOUND[function]) is not None
