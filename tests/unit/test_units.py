"""Text with units: the field's spellings, exactness, refusals, and no pint where none is needed."""

import math
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tribodyn import units
from tribodyn.nomenclature import QUANTITIES
from tribodyn.units import UnitProblemError, convert, format_quantity, parse, readings, split


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("4.5 mm", "m", 0.0045),
        ("4.5mm", "m", 0.0045),
        ("150 Nm", "N*m", 150.0),
        ("150 N·m", "N*m", 150.0),
        ("150 N m", "N*m", 150.0),
        ("1400 r/min", "rad/s", 1400 * math.pi / 30),
        ("1400 rpm", "rad/s", 1400 * math.pi / 30),
        ("1400 1/min", "rad/s", 1400 * math.pi / 30),
        ("1400 min⁻¹", "rad/s", 1400 * math.pi / 30),
        ("2 rev/s", "rad/s", 4 * math.pi),
        ("82 cP", "Pa*s", 0.082),
        ("82 mPa s", "Pa*s", 0.082),
        ("82 mPas", "Pa*s", 0.082),
        ("40 cSt", "m^2/s", 40e-6),
        ("0.53 µm", "m", 0.53e-6),
        ("0.53 μm", "m", 0.53e-6),
        ("14 N/(mm µm)", "N/m^2", 14e9),
        ("407 kg mm2", "kg*m^2", 407e-6),
        ("407 kg·mm²", "kg*m^2", 407e-6),
        ("20 °", "rad", math.radians(20)),
        ("20 deg", "rad", math.radians(20)),
        ("40 °C", "K", 313.15),
        ("-10 degC", "K", 263.15),
        ("50 °F", "K", 283.15),
        ("206 GPa", "Pa", 206e9),
        ("206000 N/mm²", "Pa", 206e9),
        ("21.9 1/GPa", "1/Pa", 21.9e-9),
        ("21.9 GPa⁻¹", "1/Pa", 21.9e-9),
        ("4e3 N s/m", "N*s/m", 4000.0),
        ("4 Ns/mm", "N*s/m", 4000.0),
        ("10 Nm/deg", "N*m/rad", 1800 / math.pi),
        ("3 1/Nm", "1/(N*m)", 3.0),
        ("1 in", "m", 0.0254),
        ("+.5e1 m", "m", 5.0),
        ("12 percent", "", 0.12),
        ("0.3", "", 0.3),
    ],
)
def test_field_spellings_are_read(text: str, unit: str, value: float) -> None:
    assert parse(text, unit) == pytest.approx(value, rel=1e-14)


def test_decimal_multiples_are_the_nearest_floats() -> None:
    assert parse("4.5 mm", "m") == 0.0045
    assert parse("0.991 um", "m") == 0.991e-6
    assert parse("206 GPa", "Pa") == 206e9
    assert parse("407 kg*mm^2", "kg*m^2") == 407e-6


@pytest.mark.parametrize(
    ("text", "unit", "message"),
    [
        ("4.5", "m", 'has no unit; write for example "4.5 m"'),
        ("four mm", "m", "does not begin with a number"),
        ("nan mm", "m", "does not begin with a number"),
        ("1e999 mm", "m", "not a finite number"),
        ("1,5 mm", "m", 'write "1.5 mm"'),
        ("3 parsnips", "m", "not a known unit"),
        ("3 (", "m", "not a known unit"),
        ("3 __import__('os')", "m", "not a known unit"),
        ("3 kg", "m", "wrong kind of quantity"),
        ("150 Nm", "N", "wrong kind of quantity"),
        ("40 C", "K", "wrong kind of quantity"),
        ("3 mm", "", "wrong kind of quantity"),
    ],
)
def test_wrong_text_is_refused_with_a_reason(text: str, unit: str, message: str) -> None:
    with pytest.raises(UnitProblemError) as caught:
        parse(text, unit)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("text", "unit"),
    [("15 Hz", "rad/s"), ("900 rpm", "Hz"), ("2 1/s", "rad/s"), ("20 deg", ""), ("0.3 rad", "")],
)
def test_an_angle_is_no_pure_number(text: str, unit: str) -> None:
    # pint alone reads 15 Hz as 15 rad/s: a factor of 2 pi lost in silence
    with pytest.raises(UnitProblemError, match="angle or a rotational speed"):
        parse(text, unit)


def test_split_preserves_the_spelling() -> None:
    assert split("  -4.5e-3   N·m ") == (-0.0045, "N·m")
    assert split("7") == (7.0, "")


@pytest.mark.parametrize("si", sorted(units._USUAL))
def test_table_of_usual_units_agrees_with_pint(si: str) -> None:
    for unit in units._USUAL[si]:
        assert parse(f"3.7 {unit}", si) == pytest.approx(
            units._by_pint(3.7, unit, si), rel=1e-14
        ), unit
        assert convert(3.7, si, unit) == pytest.approx(units._by_pint(3.7, si, unit), rel=1e-14)


def test_celsius_agrees_with_pint_both_ways() -> None:
    assert parse("40 degC", "K") == pytest.approx(units._by_pint(40.0, "degC", "K"))
    assert convert(313.15, "K", "degC") == pytest.approx(40.0)


def test_every_field_spelling_is_a_unit() -> None:
    for spelling, plain in units.SPELLINGS.items():
        assert parse(f"1 {spelling}", plain) == pytest.approx(1.0), spelling


@given(
    value=st.floats(-1e12, 1e12, allow_subnormal=False).filter(lambda v: v == 0 or abs(v) > 1e-12),
    name=st.sampled_from(sorted(QUANTITIES)),
)
def test_displayed_text_is_read_back(value: float, name: str) -> None:
    quantity = QUANTITIES[name]
    text = format_quantity(value, quantity.unit, quantity.display_unit)
    # ten digits are shown; an offset scale loses digits near its own zero
    assert parse(text, quantity.unit) == pytest.approx(
        value, rel=1e-9, abs=1e-7 * (quantity.unit == "K")
    )


def test_conversion_between_two_display_units() -> None:
    assert convert(1.0, "m/s", "km/h") == pytest.approx(3.6)
    assert convert(2.0, "mm", "um") == pytest.approx(2000.0)
    assert convert(0.25, "", "") == 0.25
    with pytest.raises(UnitProblemError, match="wrong kind"):
        convert(1.0, "N", "m")


def test_usual_units_do_not_load_pint() -> None:
    code = (
        "import sys; from tribodyn.units import parse, format_quantity;"
        "from tribodyn.nomenclature import QUANTITIES;"
        "[parse(format_quantity(1.5, q.unit, q.display_unit), q.unit)"
        " for q in QUANTITIES.values()];"
        "[parse(t, u) for t, u in (('90 Nm', 'N*m'), ('900 r/min', 'rad/s'), ('20 °', 'rad'),"
        " ('40 °C', 'K'), ('82 mPa s', 'Pa*s'), ('407 kg mm2', 'kg*m^2'))];"
        "print('pint' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("2,500 rpm", ["2500 rpm", "2.5 rpm"]),
        ("-1,500 um", ["-1500 um", "-1.5 um"]),
        ("0,250 mm", ["0.250 mm"]),
        ("3,0 mm", ["3.0 mm"]),
        ("2,5e3 N", ["2.5e3 N"]),
        ("1.234,5 N", ["1234.5 N"]),
        ("1,234.5 N", ["1234.5 N"]),
        ("2 500 rpm", ["2500 rpm"]),
        ("2\N{NARROW NO-BREAK SPACE}500 rpm", ["2500 rpm"]),
        ("2'500 rpm", ["2500 rpm"]),
        ("1.234.567 N", ["1234567 N"]),
        ("2.500 rpm", []),
        ("21.9 1/GPa", []),
        ("5 1/min", []),
        ("1,2,3", []),
        ("12,34,5 N", []),
    ],
)
def test_a_number_with_separators_is_read_or_refused(text: str, meant: list[str]) -> None:
    assert readings(text) == meant
    if meant:
        with pytest.raises(UnitProblemError) as caught:
            split(text)
        assert all(f'"{reading}"' in str(caught.value) for reading in meant)
