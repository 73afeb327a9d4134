"""Numbers from Python are written to case files with the unit of their key, and read back equal."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Context, Decimal
from pathlib import Path
from typing import Any

import hypothesis
import numpy as np
import pint
import pytest
from hypothesis import strategies as st

import tribodyn as td
from tribodyn.exchange import case_from_rexs, machine_from_rexs, read_rexs, write_rexs
from tribodyn.machine import ROLLING_BEARINGS
from tribodyn.study import MachineCase
from tribodyn.units import parse, shortest_quantity, usual_units

Q: Any = pint.UnitRegistry(cache_folder=None).Quantity
MODELS = Path(__file__).parents[2] / "references" / "rexs"
PARTS = [name for name in td.cases(machines=True) if name not in td.cases()]
RING = {"bore_diameter": 0.03, "outer_diameter": 0.062, "width": 0.016}


def in_si(case: Any, make: Callable[[float, str], Any]) -> dict[str, Any]:
    """Nested tables of a case, its dimensions as ``make`` gives them."""
    values, tables = dict(case.values()), {}
    for key, value in values.items():
        *path, name = key.split(".")
        table = tables
        for each in path:
            table = table.setdefault(each, {})
        option = case.option_of(key)
        unit = "m" if name == "sections" else (option.unit if option else "")

        def number(item: Any, unit: str = unit) -> Any:
            if isinstance(item, list | tuple):
                return [number(each, unit) for each in item]
            item = parse(item, unit) if unit and isinstance(item, str) else item
            return make(item, unit) if isinstance(item, float) and unit else item

        table[name] = number(value)
    tables.pop("housing", None)  # its files are named beside the case
    for bearing in tables["bearings"].values() if "bearings" in tables else ():
        bearing.pop("node", None)
    tables.pop("load_cases", None)
    return tables


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize(
    "make",
    [
        lambda value, unit: value,
        lambda value, unit: np.float64(value),
        lambda value, unit: Q(value, unit.replace("^", "**")),
    ],
    ids=["float", "numpy", "pint"],
)
def test_parts_from_python_are_written_with_their_units(name, make, tmp_path):
    case = td.load_case(name)
    other = type(case)(**in_si(case, make))
    (tmp_path / "case.toml").write_text(other.to_toml(), "utf-8")
    back = td.load_case(tmp_path / "case.toml")
    values, expected = dict(back.values()), dict(other.values())
    assert values.keys() == expected.keys()
    for key, value in expected.items():
        if isinstance(value, float):
            assert values[key] == pytest.approx(value, rel=1e-15), key
    assert back.to_toml() == other.to_toml()


@pytest.mark.parametrize("kind", [k for k in ROLLING_BEARINGS if k not in ("cylindrical-roller",)])
def test_rolling_bearings_from_python_are_read_back(kind, tmp_path):
    angle = {} if kind == "deep-groove" else {"contact_angle": 0.35}
    bearings = {
        name: {"shaft": "a", "position": place, "type": kind, "preload": 200.0, **RING, **angle}
        for name, place in {"A": 0.02, "B": 0.18}.items()
    }
    if angle:
        bearings["B"]["direction"] = -1
    case = MachineCase(
        shafts={"a": {"sections": [[0.2, 0.03]]}, "b": {}},
        bearings=bearings,
        gears={
            "z1": {"shaft": "a", "position": 0.1, "teeth": 27, "face_width": 0.03},
            "z2": {"shaft": "b", "teeth": 51, "face_width": 0.03},
        },
        meshes={"m": {"gears": ["z1", "z2"], "normal_module": 3e-3, "stiffness": 4e8}},
        material={"density": 7850.0},
        dynamics={"backlash": 1e-4},
        operation={"input": "a", "output": "b", "speed": 120.0, "torque": 50.0},
    )
    text = case.to_toml()
    assert 'bore_diameter = "30 mm"' in text
    assert 'density = "7850 kg/m^3"' in text
    (tmp_path / "case.toml").write_text(text, "utf-8")
    back = td.load_case(tmp_path / "case.toml")
    assert back.bearings["A"].rolling == case.bearings["A"].rolling


def test_decimals_stay_decimals():
    """A text is read as the float nearest to it: 0.4 um as 4e-7."""
    for count in range(1, 400):
        text = f"{count / 10:.10g} um"
        assert parse(text, "m") == float(f"{count}e-7")
        assert shortest_quantity(float(f"{count}e-7"), "m", "um") == text


UNITS = [(si, unit) for si in ("m", "rad", "rad/s", "Pa", "m/s^2", "K") for unit in usual_units(si)]


@hypothesis.given(
    value=st.floats(allow_nan=False, allow_infinity=False),
    units=st.sampled_from(
        [*UNITS, ("m/s^2", "g"), ("m", "inch"), ("K", "degF"), ("N*m", "lbf*ft")]
    ),
)
def test_every_number_is_read_back_from_every_unit(value: float, units: tuple[str, str]):
    text = shortest_quantity(value, *units)
    assert parse(text, units[0]) == value
    if units[0] != "K" and (value == 0.0 or 1e-290 < abs(value) < 1e290):
        assert text.endswith(f" {units[1]}")


@hypothesis.given(number=st.floats(-1e12, 1e12).filter(lambda n: n == 0.0 or abs(n) > 1e-12))
def test_text_is_read_as_the_nearest_number(number: float):
    """Compared with decimals of sixty digits."""
    context = Context(prec=60)
    for unit, si, scale in (
        ("um", "m", "1e-6"),
        ("g", "m/s^2", "9.80665"),
        ("inch", "m", "0.0254"),
    ):
        expected = float(context.multiply(Decimal(repr(number)), Decimal(scale)))
        assert parse(f"{number!r} {unit}", si) == expected
    half_turn = Decimal("3.14159265358979323846264338327950288419716939937510")
    expected = float(context.divide(context.multiply(Decimal(repr(number)), half_turn), 180))
    assert parse(f"{number!r} deg", "rad") == expected


def test_an_import_writes_decimals(tmp_path: Path):
    case = td.load_case("fzg-ehl-vibration")
    write_rexs(case, tmp_path / "case.rexs")
    exported = (tmp_path / "case.rexs").read_text("utf-8")
    assert ">0.35<" in exported
    machine = machine_from_rexs(read_rexs(MODELS / "two_stages.rexs"))
    pair = case_from_rexs(read_rexs(MODELS / "two_stages.rexs"), 19)
    for text in (exported, machine.to_toml(), pair.to_toml()):
        lengths = [line for line in text.splitlines() if " um" in line or " mm" in line]
        assert lengths
        assert not [line for line in lengths if re.search(r"\d\.\d{11,} [um]m", line)]
    assert 'roughness_ra = "0.4 um"' in pair.to_toml()
    assert machine.to_toml().count('roughness_ra = "0.4 um"') == 4
