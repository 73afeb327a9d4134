"""Messages answer what, where, why and what next; validators let no bad number through."""

import math
import warnings

import numpy as np
import pytest

from tribodyn.dynamics import Resonance
from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    ModelOption,
    ModelWarning,
    OutputExistsError,
    Problem,
    TribodynError,
    require_between,
    require_one_of,
    require_positive,
    warn,
)
from tribodyn.nomenclature import require_flag, require_number, require_whole


def test_problem_reads_as_one_paragraph() -> None:
    problem = Problem(
        "teeth = 2", "case.toml:7: gears.pinion.teeth", "At least 5.", "Use more teeth"
    )
    assert str(problem) == (
        "case.toml:7: gears.pinion.teeth: teeth = 2. At least 5. Use more teeth."
    )


def test_empty_parts_leave_no_trace() -> None:
    assert str(Problem("no gears")) == "no gears."


def test_one_error_carries_several_problems() -> None:
    error = InputError([Problem("first"), Problem("second")])
    assert [problem.what for problem in error.problems] == ["first", "second"]
    assert str(error) == "first.\nsecond."


def test_a_sentence_is_a_problem() -> None:
    assert InputError("wrong").problems == (Problem("wrong"),)


@pytest.mark.parametrize(
    ("kind", "builtin", "code"),
    [
        (InputError, ValueError, 2),
        (OutputExistsError, ValueError, 2),
        (ComputationError, RuntimeError, 1),
    ],
)
def test_kinds_and_exit_codes(
    kind: type[TribodynError], builtin: type[Exception], code: int
) -> None:
    error = kind("x")
    assert isinstance(error, builtin)
    assert isinstance(error, TribodynError)
    assert error.exit_code == code


@pytest.mark.parametrize(
    "bad", [0.0, -1.0, np.nan, np.inf, [1.0, -2.0], np.array([[1.0], [np.nan]])]
)
def test_require_positive_refuses(bad: object) -> None:
    with pytest.raises(InputError) as caught:
        require_positive("load", bad, "N", remedy="Give a load")
    message = str(caught.value)
    assert "argument load: load = " in message
    assert " N." in message
    assert "finite and greater than zero" in message
    assert message.endswith("Give a load.")


def test_require_positive_names_the_offending_element() -> None:
    with pytest.raises(InputError, match="load = -2 N"):
        require_positive("load", [3.0, -2.0, 5.0], "N")


def test_require_positive_accepts() -> None:
    require_positive("load", [1e-300, 1.0])


@pytest.mark.parametrize("bad", [-0.01, 0.51, np.nan])
def test_require_between_refuses(bad: float) -> None:
    with pytest.raises(InputError, match=r"between 0 and 0\.5"):
        require_between("poissons_ratio", bad, 0.0, 0.5)


@pytest.mark.parametrize("good", [0.0, 0.5, [0.0, 0.3]])
def test_limits_are_inclusive(good: object) -> None:
    require_between("poissons_ratio", good, 0.0, 0.5)


def test_warning_carries_code_and_the_place_of_the_caller() -> None:
    def model() -> None:
        warn("friction-range", "p = 3 GPa is above 2.5 GPa")

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model()
    (record,) = caught
    assert isinstance(record.message, ModelWarning)
    assert record.message.code == "friction-range"
    assert str(record.message) == "[friction-range] p = 3 GPa is above 2.5 GPa"
    assert record.filename == __file__


def test_a_path_is_reported_as_the_caller_writes_it() -> None:
    assert str(Argument("teeth")) == "argument teeth"
    assert str(Argument("modification.run_out", gear="wheel")) == (
        "argument wheel_modification.run_out"
    )
    assert str(ModelOption("stiffness", "table", "phase")) == "table stiffness: phase"
    assert str(ModelOption("stiffness", "table")) == "table stiffness"
    assert str(ModelOption("stiffness", name="reference")) == "stiffness option reference"


def test_an_error_is_made_of_its_parts() -> None:
    parts = {"where": Argument("nodes"), "why": "At least 4 are needed", "remedy": "Give 30"}
    error = InputError("nodes = 3", **parts)
    assert error.problems == (Problem("nodes = 3", **parts),)
    assert str(error) == "argument nodes: nodes = 3. At least 4 are needed. Give 30."


def test_the_argument_at_fault_needs_no_reading() -> None:
    with pytest.raises(InputError) as caught:
        require_positive("load_per_width", -1.0, "N/m")
    assert caught.value.problems[0].where == Argument("load_per_width")


@pytest.mark.parametrize("unit", ["", "m", "Pa", "rad/s", "mol"])
@pytest.mark.parametrize("value", ["x", [], -1.0, math.nan, None, [[1.0], [2.0, 3.0]]])
def test_every_refused_value_has_a_remedy(value, unit):
    with pytest.raises(InputError) as caught:
        require_positive("width", value, unit)
    assert all(problem.why and problem.remedy for problem in caught.value.problems)


@pytest.mark.parametrize("check", [require_whole, require_number, require_flag])
def test_whole_numbers_numbers_and_flags_have_one_too(check):
    for value in ("x", None, [1.0, 2.0], math.inf):
        with pytest.raises(InputError) as caught:
            check("nodes", value)
        assert caught.value.problems[0].remedy
    with pytest.raises(InputError, match="Choose one of these"):
        require_one_of("inlet", "dry", ("flooded", "zero"))


def test_a_resonance_is_printed_in_engineering_units():
    met = Resonance(100.0 * math.pi, 1250.0, 2500.0, 2, 3, 0.4, 0.02)
    assert repr(met) == "Resonance(order 2 meets mode 3 of 2500 Hz at 3000 rpm)"


def test_text_after_a_quoted_word_is_not_shortened():
    names = ", ".join(f"figure_{number}" for number in range(60))
    message = str(InputError("no figure", why=f'compute = "summary" gives {names}'))
    assert message.endswith("figure_59.")


def test_a_long_value_is_shortened_visibly():
    message = str(InputError(f'name = "{"ab " * 200}"'))
    assert len(message) < 230
    assert message.endswith("...")
