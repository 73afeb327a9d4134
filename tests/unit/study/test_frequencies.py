"""Kinematic frequencies against figures by hand, published ones and identities."""

from __future__ import annotations

import json
from fractions import Fraction

import numpy as np
import pytest

import tribodyn as td
from tribodyn.analysis.part_frequencies import bearing_frequencies, mesh_frequencies
from tribodyn.cli.entry import call
from tribodyn.faults import BearingImpacts


def _of(lines, part: str) -> dict[str, float]:
    rows = zip(lines.part, lines.symbol, lines.frequency, strict=True)
    return {symbol: value for name, symbol, value in rows if name == part}


def test_bearing_of_published_recordings() -> None:
    # 6205 at 1797 rpm as listed with the recordings of Case Western Reserve University
    bearing = BearingImpacts(
        place="outer", rolling_elements=9, element_diameter=7.94e-3, pitch_diameter=39.04e-3
    )
    turn = 1797 / 60
    orders = {
        line.symbol: line.frequency / turn for line in bearing_frequencies("b", bearing, -turn)
    }
    published = {"BPFO": 3.5848, "BPFI": 5.4152, "FTF": 0.39828, "BSF": 4.7135 / 2.0}
    assert orders == pytest.approx(published, rel=2e-3)
    assert orders["BPFO"] + orders["BPFI"] == pytest.approx(9.0, rel=1e-14)
    assert orders["FTF"] * 9 == pytest.approx(orders["BPFO"], rel=1e-14)


@pytest.mark.parametrize(("first", "second"), [(16, 24), (17, 24), (22, -80)])
def test_the_same_teeth_meet_with_the_hunting_tooth_frequency(first: int, second: int) -> None:
    turn = Fraction(15)
    mesh = turn * first
    other = mesh / abs(second)
    gears = {"a": (first, float(turn)), "b": (second, -float(other))}
    lines = {l.symbol: l.frequency for l in mesh_frequencies("m", float(mesh), gears, 2)}  # noqa: E741
    hunting = Fraction(lines["HTF"]).limit_denominator(10_000)
    for speed in (turn, other):  # both gears make whole turns, and no shorter time has whole ones
        assert (speed / hunting).denominator == 1
    assert np.gcd(int(turn / hunting), int(other / hunting)) == 1
    assert lines["GMF + 2 f(b)"] == pytest.approx(float(mesh + 2 * other))
    assert lines["APF"] * np.gcd(first, second) == pytest.approx(float(mesh))


def test_stage_by_willis() -> None:
    lines = td.kinematic_frequencies(td.load_case("planetary-stage"))
    stage, ratio = _of(lines, "stage low"), Fraction(17, 17 + 61)  # ring held, driven by the sun
    carrier = float(25 * ratio)
    assert _of(lines, "shaft carrier")["f(carrier)"] == pytest.approx(carrier, rel=1e-12)
    assert stage["PPF"] == pytest.approx(3 * carrier, rel=1e-12)
    assert stage["TF(ring)"] == pytest.approx(3 * carrier, rel=1e-12)
    assert stage["TF(sun)"] == pytest.approx(3 * (25 - carrier), rel=1e-12)
    assert stage["TF(planet)"] == pytest.approx(carrier * 61 / 22, rel=1e-12)
    assert set(lines.without_elements) == {"low_sun", "low_carrier", "low_pin1"}


def test_pair_and_machine_of_its_gears_have_the_same_lines() -> None:
    pair = td.kinematic_frequencies(td.load_case("hypoid-mixed-ehl"), sidebands=3)
    axle = td.kinematic_frequencies(td.load_case("hypoid-axle"), sidebands=3)
    alone, carried = _of(pair, "mesh mesh"), _of(axle, "mesh axle")
    assert list(alone.values()) == pytest.approx(list(carried.values()), rel=1e-12)
    bearings = [part for part in axle.part if part.startswith("bearing")]
    assert len(set(bearings)) == 4
    assert not axle.without_elements


def test_lines_near_a_peak() -> None:
    lines = td.kinematic_frequencies(td.load_case("fzg-roughness"))
    close = lines.near(481.0)
    assert close[0].symbol == "2 GMF"
    assert all(abs(line.frequency - 481.0) <= 4.81 for line in close)
    assert not lines.near(7.1)


def test_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["frequencies", "two-stage-spur", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    lines = td.kinematic_frequencies(td.load_case("two-stage-spur"))
    assert [row["frequency"] for row in rows] == lines.frequency.tolist()
    assert call(["frequencies", "fzg-roughness", "--near", "481 Hz"]) == 0
    assert "2 GMF" in capsys.readouterr().out
    for wrong in (["--near", "481"], ["--near", "3 mm"], ["--sidebands", "-1"]):
        assert call(["frequencies", "fzg-roughness", *wrong]) == 2
        assert "sidebands" in (error := capsys.readouterr().err) or "--near" in error


def test_figure_shows_every_line() -> None:
    lines = td.kinematic_frequencies(td.load_case("hypoid-axle"))
    figure = lines.plot()
    assert sum(len(trace.x) for trace in figure.data) == len(lines.symbol)
    assert list(lines.to_xarray().frequency.values) == lines.frequency.tolist()
