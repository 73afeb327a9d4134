"""Verdicts on recordings: closed forms of the severity, and parts that are named or not."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.measurement import Recording, analyse_signal
from tribodyn.study import RecordingVerdict, judge_recordings, kinematic_frequencies
from tribodyn.study.faults.recording_verdict import Finding

RATE = 12_800.0
TIME = np.arange(round(4.0 * RATE)) / RATE


@pytest.fixture(scope="module")
def lines():
    return kinematic_frequencies(td.load_case("two-stage-spur"))


def frequency(lines, part: str, symbol: str) -> float:
    rows = zip(lines.part, lines.symbol, lines.frequency, strict=True)
    return float(next(f for p, s, f in rows if (p, s) == (part, symbol)))


def recorded(signal, unit: str = "m/s^2"):
    return analyse_signal(Recording({"acc": signal}, RATE, {"acc": unit}), "acc")


def sound(lines, seed: int = 1, speed: float = 1.0) -> np.ndarray:
    """Both meshes with three harmonics and noise."""
    signal = np.random.default_rng(seed).normal(0.0, 0.3, TIME.size)
    for part in ("mesh first", "mesh second"):
        mesh = speed * frequency(lines, part, "GMF")
        for k in (1, 2, 3):
            signal += 3.0 / k * np.cos(2.0 * np.pi * k * mesh * TIME + k)
    return signal


def struck(rate: float, size: float = 2.0, seed: int = 3) -> np.ndarray:
    """Ringing at 4.3 kHz after impacts that slip."""
    rng, signal = np.random.default_rng(seed), np.zeros(TIME.size)
    ringing = size * np.exp(-900.0 * TIME[:250]) * np.sin(2.0 * np.pi * 4300.0 * TIME[:250])
    for strike in np.arange(0.01, TIME[-1] - 0.05, 1.0 / rate):
        first = round((strike + rng.normal(0.0, 5e-5)) * RATE)
        signal[first : first + 250] += ringing
    return signal


@pytest.mark.parametrize(
    ("millimetres", "zone"), [(1.1, "A"), (1.13, "B"), (2.79, "B"), (2.81, "C"), (7.2, "D")]
)
def test_the_zone_is_that_of_the_velocity_of_a_sine(millimetres: float, zone: str) -> None:
    """A sine of 80 Hz with this rms velocity, measured as acceleration and as velocity."""
    turns = 2.0 * np.pi * 80.0
    wave = 1e-3 * millimetres * math.sqrt(2.0) * np.cos(turns * TIME)
    slow = 0.5 * np.cos(2.0 * np.pi * 3.0 * TIME)  # below the band
    for signal, unit in ((turns * wave + slow, "m/s^2"), (wave, "m/s")):
        verdict = judge_recordings([recorded(signal, unit)], limits="II")
        assert verdict.velocity[0] == pytest.approx(1e-3 * millimetres, rel=2e-3)
        assert verdict.zone == zone
    own = judge_recordings([recorded(turns * wave)], limits=[1e-3, 2e-3, 3e-3])
    assert own.zone == "ABCD"[sum(millimetres > end for end in (1.0, 2.0, 3.0))]


@pytest.mark.parametrize(
    ("rating", "ends"), [("VR3.15", (2.0, 3.15, 5.0)), ("VR 5", (3.15, 5.0, 8.0)),
                         ("VR20", (12.5, 20.0, 31.5))]
)  # fmt: skip
def test_a_rating_of_a_gear_unit_names_its_zones(rating: str, ends: tuple[float, ...]) -> None:
    """Rows of table 3 of ISO 20816-9, whose rating is the end of zone B."""
    for millimetres, zone in zip(
        (0.99 * ends[0], *(1.01 * end for end in ends)), "ABCD", strict=True
    ):
        wave = 1e-3 * millimetres * math.sqrt(2.0) * np.cos(2.0 * np.pi * 80.0 * TIME)
        assert judge_recordings([recorded(wave, "m/s")], limits=rating).zone == zone


def test_a_severity_needs_an_acceleration_and_limits_that_rise() -> None:
    verdict = judge_recordings([recorded(np.cos(500.0 * TIME), "N")], limits="I")
    assert verdict.zone == ""
    assert "needs an acceleration or velocity" in verdict.statements[0]
    for limits in ("V", "VR4", [1e-3, 1e-3, 2e-3], [1e-3]):
        with pytest.raises(InputError, match="a class of ISO 10816-1, a rating of ISO 20816-9"):
            judge_recordings([recorded(np.cos(500.0 * TIME))], limits=limits)
    with pytest.raises(InputError, match="there is no analysis"):
        judge_recordings([])


@pytest.mark.parametrize(
    ("part", "symbol", "name"),
    [
        ("bearing C", "BPFO", "bearing C, outer ring"),
        ("bearing D", "BPFI", "bearing D, inner ring"),
        ("bearing C", "BSF", "bearing C, rolling elements"),
    ],
)
def test_a_damaged_bearing_is_named_with_its_evidence_and_trend(lines, part, symbol, name) -> None:
    """Impacts 1 % slower than the line, twice as strong as in the first recording."""
    rate = 0.99 * frequency(lines, part, symbol) * (2.0 if symbol == "BSF" else 1.0)
    records = [recorded(sound(lines, n) + struck(rate, size)) for n, size in ((1, 1.0), (2, 2.0))]
    verdict = judge_recordings(records, lines)
    (finding,) = (each for each in verdict.findings if "bearing" in each.part)
    assert finding.part.startswith(name)
    assert finding.frequency == pytest.approx(rate, rel=3e-3)
    assert finding.amplitudes[1] > 1.5 * finding.amplitudes[0]
    text = " ".join(verdict.statements)
    assert "since the first recording. Next: look at" in text


def test_bearings_whose_lines_are_as_near_are_all_named(lines) -> None:
    """BPFO of A at 158.3 Hz and BPFI of D at 156.4 Hz are 1.2 % apart, which slip may be."""
    verdict = judge_recordings([recorded(sound(lines) + struck(157.0))], lines)
    (finding,) = (each for each in verdict.findings if "bearing" in each.part)
    assert finding.part == "bearing D, inner ring, or bearing A, outer ring"


def test_an_inner_ring_that_turns_through_the_load_names_no_other_bearing(lines) -> None:
    """Its sidebands at the turns of the shaft lie at the rate of another ring."""
    turns = frequency(lines, "shaft input", "f(input)")
    ring = 0.9878 * frequency(lines, "bearing A", "BPFI")
    other = frequency(lines, "bearing B", "BPFO")
    assert abs(ring + turns - other) < 0.02 * other
    load = np.maximum(0.0, 0.5 + 0.7 * np.cos(2.0 * np.pi * turns * TIME))
    impacts = load * struck(ring, 12.0)
    findings = judge_recordings([recorded(sound(lines) + impacts)], lines).findings
    assert [each.part for each in findings if "bearing" in each.part] == ["bearing A, inner ring"]


def test_bursts_at_the_edge_of_the_slip_are_named(lines) -> None:
    """Noise that swells with the line of the spectrum which is just 2 % below the rate."""
    ring, rate = frequency(lines, "bearing B", "BPFO"), 283.75
    assert 0.98 * ring <= rate < ring / 1.02
    swells = 1.0 + np.cos(2.0 * np.pi * rate * TIME) + 0.5 * np.cos(4.0 * np.pi * rate * TIME)
    noise = np.random.default_rng(2).normal(0.0, 2.0, TIME.size)
    (finding,) = judge_recordings([recorded(swells * noise)], lines).findings
    assert finding.part == "bearing B, rolling elements, or bearing B, outer ring"
    assert finding.frequency == rate


@pytest.mark.parametrize("seed", range(4))
def test_sound_machines_and_noise_name_no_bearing_and_no_gear(lines, seed: int) -> None:
    noise = np.random.default_rng(seed).normal(0.0, 1.0, TIME.size)
    for signal in (noise, sound(lines, seed)):
        findings = judge_recordings([recorded(signal)], lines).findings
        assert [f.part for f in findings if not f.part.startswith("mesh")] == []


def test_computed_recordings_without_noise_name_no_bearing(lines) -> None:
    """Meshes up to half the sampling rate over an eccentric shaft whose tooth is cracked."""
    middle = frequency(lines, "shaft middle", "f(middle)")
    tones = np.zeros(TIME.size)
    for part in ("mesh first", "mesh second"):
        mesh = frequency(lines, part, "GMF")
        for k in range(1, int(0.49 * RATE / mesh)):
            tones += 3.0 / k**1.5 * np.cos(2.0 * np.pi * k * mesh * TIME + k**2)
    turn = middle * TIME % 1.0
    signal = tones * (1.0 + 0.02 * np.cos(2.0 * np.pi * turn)) + np.exp(-((turn - 0.5) ** 2) / 1e-4)
    findings = judge_recordings([recorded(signal)], lines).findings
    assert [each.part for each in findings if "bearing" in each.part] == []


def test_sidebands_name_the_gear_and_a_strong_turn_its_shaft(lines) -> None:
    mesh = 2.0 * np.pi * frequency(lines, "mesh first", "GMF") * TIME
    middle = 2.0 * np.pi * frequency(lines, "shaft middle", "f(middle)") * TIME
    signal = sound(lines) + 3.0 * 0.5 * np.cos(middle) * np.cos(mesh + 1.0)
    parts = [each.part for each in judge_recordings([recorded(signal)], lines).findings]
    assert "mesh first, gear z2" in parts
    assert "mesh first, gear z1" not in parts
    unbalance = sound(lines) + 3.0 * np.cos(middle)
    (finding,) = judge_recordings([recorded(unbalance)], lines).findings
    assert finding.part == "shaft middle"
    assert "check the balance" in judge_recordings([recorded(unbalance)], lines).statements[-1]


def test_the_lines_follow_the_speed_of_the_recording(lines) -> None:
    """The machine runs 3 % slower than its case; the mesh of 23 teeth says so."""
    slower = 0.97
    signal = np.random.default_rng(1).normal(0.0, 0.3, TIME.size)
    mesh = 2.0 * np.pi * slower * frequency(lines, "mesh first", "GMF")
    signal += sum(3.0 / k * np.cos(k * mesh * TIME + k) for k in (1, 2, 3))
    rate = slower * 0.995 * frequency(lines, "bearing B", "BPFO")
    rig = Recording({"acc": signal + struck(rate)}, RATE, {"acc": "m/s^2"})
    analysis = analyse_signal(rig, "acc", speed=2.0 * np.pi * 50.0, teeth=23, mate_teeth=57)
    parts = [each.part for each in judge_recordings([analysis], lines).findings]
    assert any(part.startswith("bearing B, outer ring") for part in parts)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.968, 1.027])
def test_a_speed_that_nobody_states_is_that_of_the_mesh_lines(lines, speed: float) -> None:
    healthy = judge_recordings([recorded(sound(lines, speed=speed))], lines)
    assert healthy.speed_ratio == pytest.approx(speed, rel=2e-4)
    assert not [each for each in healthy.findings if each.part.startswith("bearing")]
    rate = speed * 0.995 * frequency(lines, "bearing B", "BPFO")
    damaged = judge_recordings([recorded(sound(lines, speed=speed) + struck(rate))], lines)
    assert any(each.part.startswith("bearing B, outer ring") for each in damaged.findings)
    assert not any("not known" in each for each in damaged.statements)


def test_a_record_without_mesh_lines_says_that_its_speed_is_not_known(lines) -> None:
    noise = np.random.default_rng(5).normal(0.0, 0.1, TIME.size)
    turns = 2.0 * np.pi * frequency(lines, "shaft middle", "f(middle)")
    verdict = judge_recordings([recorded(noise + 3.0 * np.cos(turns * TIME))], lines)
    assert math.isnan(verdict.speed_ratio)
    assert [each.part for each in verdict.findings] == ["shaft middle"]
    assert "Speed: not known; that of the lines is taken." in verdict.statements


@pytest.mark.parametrize("bearing", ["bearing C", "bearing D"])
def test_turns_of_a_shaft_that_stands_out_nowhere_hide_no_bearing(lines, bearing) -> None:
    """Impacts half a hertz, two lines, beside a high multiple of the turns of the slow shaft."""
    turns, ring = frequency(lines, "shaft output", "f(output)"), frequency(lines, bearing, "BPFO")
    rate = round(ring / turns) * turns + 0.5
    assert abs(rate / ring - 1.0) < 0.02
    findings = judge_recordings([recorded(sound(lines) + struck(rate, 4.0))], lines).findings
    assert any(f"{bearing}, outer ring" in each.part for each in findings)


@pytest.mark.parametrize(("size", "named"), [(0.04, False), (0.4, True)])
def test_the_turns_of_a_slow_shaft_are_looked_at_below_ten_hertz(lines, size, named) -> None:
    """Named where its velocity alone leaves zone A: 0.04 and 0.4 m/s^2 are 0.65 and 6.5 mm/s."""
    turns = 2.0 * np.pi * frequency(lines, "shaft output", "f(output)")
    assert turns < 2.0 * np.pi * 10.0
    shaking = size * np.cos(turns * TIME) + np.random.default_rng(2).normal(0.0, 0.01, TIME.size)
    findings = judge_recordings([recorded(shaking)], lines, limits="III").findings
    assert ("shaft output" in [each.part for each in findings]) == named


def test_the_figure_shows_severity_and_growth_of_the_lines() -> None:
    parts = (Finding("bearing A, outer ring", "stands out", "look", 100.0, (2.0, 6.0)),)
    values = np.array([1.0e-3, 3.0e-3]), np.array([1.0, 2.0]), np.array([3.0, 5.0])
    figure = RecordingVerdict(*values, (1e-3, 2e-3, 4e-3), "C", parts).plot()
    curves = {trace.name: np.asarray(trace.y, dtype=float) for trace in figure.data}
    assert curves["velocity"] == pytest.approx([1.0, 3.0])
    assert [curves[f"end of zone {zone}"][0] for zone in "ABC"] == pytest.approx([1.0, 2.0, 4.0])
    assert curves["bearing A, outer ring"] == pytest.approx([1.0, 3.0])
    assert figure.layout.title.text == "Zone C; bearing A, outer ring"


def test_a_channel_in_volts_is_told_what_it_lacks(lines):
    verdict = judge_recordings([recorded(sound(lines), "V")], lines, limits="II")
    assert verdict.zone == ""
    assert "needs the sensitivity of its sensor" in verdict.statements[0]
