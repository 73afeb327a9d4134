"""Quantities of unit libraries are converted to the unit of the parameter, or refused."""

from __future__ import annotations

import dataclasses
import inspect
import math
import re
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pint
import pytest

from fuzz.public_calls import methods, parameters, public, working_calls
from fuzz.test_arguments import call, quietly
from registries import as_before
from tribodyn import load_case
from tribodyn.arguments.annotations import angle_power
from tribodyn.arguments.reading import _unit
from tribodyn.contact import hertz_line
from tribodyn.drawing import Drawing
from tribodyn.ehl import solve_line_contact
from tribodyn.errors import InputError, TribodynError
from tribodyn.gear import spur_pair
from tribodyn.lubricant import Lubricant
from tribodyn.machine import Operation
from tribodyn.nomenclature import QUANTITIES

REGISTRY: Any = pint.UnitRegistry(cache_folder=None)
Q = REGISTRY.Quantity
#: Pages whose functions take cases and results, with quantities of their keys.
CASES = ("study", "cases", "exchange", "variants", "plot", "report", "tribodyn")


@pytest.fixture(scope="module")
def calls(request):
    return working_calls(bool(request.config.getoption("--runs")))


@pytest.fixture(autouse=True)
def _stripped_units_are_errors(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error", pint.UnitStrippedWarning)
        yield


def documents(function: Any) -> Any:
    return function if isinstance(function, type) else inspect.unwrap(function)


def is_number(value: Any) -> bool:
    kind = value.dtype.kind if isinstance(value, np.ndarray) else ""
    return kind == "f" or (isinstance(value, float) and math.isfinite(value))


def equal(first: Any, second: Any, depth: int = 3) -> bool:
    """Whether all numbers of two results are equal but for rounding."""
    if isinstance(first, float | np.ndarray):
        if np.asarray(first).dtype.kind not in "fc":
            return True
        size = float(np.max(np.abs(first), initial=0.0, where=np.isfinite(first)))
        return np.allclose(first, second, rtol=1e-6, atol=1e-9 * size, equal_nan=True)
    if dataclasses.is_dataclass(first) and depth:
        pairs = [(getattr(r, f.name) for r in (first, second)) for f in dataclasses.fields(first)]
        return all(equal(*pair, depth - 1) for pair in pairs)
    if isinstance(first, list | tuple) and depth:
        return all(equal(*pair, depth - 1) for pair in zip(first, second, strict=True))
    return True


@pytest.mark.slow
def test_quantities_are_converted_by_the_unit_of_the_parameter_or_refused(calls):
    converted, failed = 0, []
    for name, (function, sound) in calls.items():
        expected: Any = None
        for key in (each.name for each in parameters(function)):
            unit = _unit(documents(function), key)
            if not is_number(sound.get(key)) or unit is None:
                continue
            try:
                quantity = Q(100.0 * sound[key], f"({unit or '1'}) * percent".replace("^", "**"))
            except Exception:
                continue  # words such as "mesh cycles"
            try:
                with quietly(), as_before():
                    result = call(function, sound | {key: quantity})
                    expected = call(function, sound) if expected is None else expected
            except TribodynError:
                continue
            converted += 1
            if not equal(result, expected):
                failed.append(f"{name}({key}={quantity})")
    assert not failed
    assert converted > 250


def every_function() -> Iterator[tuple[str, Any, Any]]:
    """Public functions, constructors and methods, each with what documents it."""
    for name, public_object in public().items():
        if isinstance(public_object, Drawing) or inspect.isabstract(public_object):
            continue  # figures take results
        yield name, public_object, documents(public_object)
        for method in methods(public_object) if isinstance(public_object, type) else ():
            function = getattr(public_object, method)
            if inspect.isfunction(inspect.unwrap(function)):
                yield f"{name}.{method}", function, inspect.unwrap(function)


@pytest.mark.slow
def test_quantities_of_another_dimension_are_refused_by_every_public_function():
    failed, count = [], 0
    for name, function, document in every_function():
        for each in parameters(function):
            # Cases read quantities themselves.
            cases = name.partition(".")[0] in CASES
            if each.name == "self" or (cases and not _unit(document, each.name)):
                continue
            wrong = (Q(1.0, "candela"), [1.0, Q(1.0, "candela")], Q([1.0, 2.0], "mol"))[count % 3]
            count += 1
            try:
                function(**{each.name: wrong})
            except Exception as error:
                reason = "its unit is" in str(error) or "without a unit" in str(error)
                if not (isinstance(error, InputError) and reason and each.name in str(error)):
                    failed.append(f"{name}({each.name}): {error!r}"[:300])
            else:
                failed.append(f"{name}({each.name}={wrong!r})")
    assert not failed, "\n".join(failed)
    assert count > 2000


@dataclasses.dataclass
class AstropyLike:
    """A value with a unit that converts itself, and nothing else of pint."""

    value: Any
    unit: str

    def to(self, unit: str) -> AstropyLike:
        quantity = Q(self.value, self.unit)
        if angle_power(quantity) != angle_power(Q(1.0, unit)):
            raise ValueError("an angle is a dimension")
        return AstropyLike(quantity.to(unit).magnitude, unit)

    def __array__(self, *_: Any, **__: Any) -> Any:
        return np.asarray(self.value)


class UnytLike(np.ndarray):
    """An array with units, of a subclass of NumPy's."""

    units = "mm"

    @property
    def value(self) -> Any:
        return self.view(np.ndarray)

    def to(self, unit: str) -> Any:
        return AstropyLike(Q(self.value, self.units).to(unit).magnitude, unit)


def test_quantities_of_other_libraries():
    expected = hertz_line(147802.0, 8e-3, 2.2e11)
    radius = np.array(8.0).view(UnytLike)
    converted = hertz_line(AstropyLike(147.802, "N/mm"), radius, AstropyLike(220.0, "GPa"))
    assert equal(converted, expected)
    for wrong in (AstropyLike(8.0, "N"), np.array([8.0]).view(UnytLike)):
        with pytest.raises(InputError, match=r"load_per_width = .*Wanted: a quantity in N/m"):
            hertz_line(wrong, 8e-3, 2.2e11)
    with pytest.raises(InputError, match="rad/s"):
        Operation("a", "b", AstropyLike(15.0, "Hz"), 10.0)
    assert Operation("a", "b", AstropyLike(900.0, "rpm"), 10.0).speed == pytest.approx(30 * math.pi)


@pytest.mark.parametrize("kind", [list, tuple, np.array, Q.from_list, iter])
def test_quantities_in_containers(kind):
    items = [Q(8.0, "mm"), Q(9.0, "mm")] if kind is not np.array else [8.0, 9.0]
    radii = kind(items) if kind is not np.array else np.array([Q(8.0, "mm"), Q(9e-3, "m")], object)
    if kind is iter:
        with pytest.raises(InputError):
            hertz_line(147802.0, radii, 2.2e11)
        return
    expected = hertz_line(147802.0, [8e-3, 9e-3], 2.2e11)
    assert equal(hertz_line(147802.0, radii, 2.2e11), expected)


@pytest.mark.parametrize("speed", [Q(15, "Hz"), Q(15, "1/s"), Q(15, "becquerel"), Q(15, "")])
def test_a_rotational_speed_is_no_frequency(speed):
    with pytest.raises(InputError, match="speed"):
        Operation("a", "b", speed, 10.0)
    for name in ("fzg-12dof-light", "two-stage-helical", "planetary-stage", "hypoid-mixed-ehl"):
        case = load_case(name)
        with pytest.raises(InputError, match=r"operation\.speed"):
            case.replace({"operation.speed": speed})
        same = case.replace({"operation.speed": Q(15.0, "turn/s")})
        assert same.to_toml() == case.replace({"operation.speed": "900 rpm"}).to_toml()


def test_film_of_a_line_contact_from_quantities():
    oil = Lubricant(Q(82, "mPa*s"), Q(0.88, "g/cm**3"), Q(21.9, "1/GPa"))
    film = solve_line_contact(Q(147.802, "N/mm"), Q(8, "mm"), Q(3.07, "m/s"), oil, Q(220, "GPa"))
    si = solve_line_contact(147802.0, 8e-3, 3.07, oil, 2.2e11)
    assert film.central_film == pytest.approx(si.central_film, rel=1e-9)
    assert film.central_film == pytest.approx(1.024e-6, rel=1e-3)


def test_face_widths_of_a_pair_from_quantities():
    pair = spur_pair(
        pinion_teeth=20, wheel_teeth=30, normal_module=Q(4, "mm"),
        normal_pressure_angle=Q(20, "deg"), pinion_face_width=Q(20, "mm"),
        wheel_face_width=Q(2, "cm"),
    )  # fmt: skip
    assert pair.common_face_width == pytest.approx(0.02, rel=1e-12)
    assert pair.pinion.normal_pressure_angle == pytest.approx(math.radians(20.0), rel=1e-12)


def test_documented_units_are_those_of_the_nomenclature():
    """Parameters named like a quantity are in its unit: others would be converted wrongly."""
    failed = []
    for name, function, document in every_function():
        for each in parameters(function):
            unit, quantity = _unit(document, each.name), QUANTITIES.get(each.name)
            if quantity is None or not unit or each.name == "path" or re.search("or |,", unit):
                continue
            try:
                Q(1.0, unit.replace("^", "**")).to(quantity.unit or "")
            except Exception:
                failed.append(f"{name}({each.name}) [{unit}], not [{quantity.unit}]")
    assert not failed, "\n".join(failed)
