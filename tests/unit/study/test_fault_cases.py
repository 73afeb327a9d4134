"""Faults in a case: keys and their errors, the motion over whole turns, recordings."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import tribodyn
from tribodyn.errors import InputError
from tribodyn.measurement import read
from tribodyn.study import Case, Result
from tribodyn.study.faults.clock import turning_clock
from tribodyn.study.faults.motion import turning_mesh_of, turning_system_of

CRACK = {
    "faults.crack.kind": "crack", "faults.crack.gear": "pinion", "faults.crack.tooth": 3,
    "faults.crack.depth": "2 mm",
}  # fmt: skip
WHEEL = {
    "faults.run-out.kind": "eccentricity", "faults.run-out.gear": "wheel",
    "faults.run-out.amplitude": "5 um",
}  # fmt: skip


@pytest.fixture(scope="module")
def healthy() -> Case:
    return tribodyn.load_case("fzg-roughness").replace(
        {"stiffness.model": "analytic", "dynamics.mesh_law": "force-law"}
    )


@pytest.fixture(scope="module")
def result(healthy: Case) -> Result:
    with pytest.warns(tribodyn.ModelWarning):
        return tribodyn.run(healthy.replace({**CRACK, **WHEEL}))


def test_a_case_with_faults_reads_back(healthy: Case, tmp_path: Path) -> None:
    case = healthy.replace({**CRACK, **WHEEL})
    assert case != healthy
    file = tmp_path / "case.toml"
    file.write_text(case.to_toml(), encoding="utf-8")
    assert tribodyn.load_case(file) == case
    without = case.replace({"faults.crack": None})
    assert without == healthy.replace(WHEEL)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"faults.crack.kind": "crak"}, 'Did you mean "crack"'),
        ({"faults.crack.tooth": 17}, "16 teeth"),
        ({"faults.crack.start": 0.5}, "has: gear, tooth, depth"),
        ({"faults.crack.depth": None}, 'Add for example depth = "1 mm"'),
        ({"faults.crack.depht": "1 mm"}, 'Did you mean "depth"'),
        ({"faults.crack.depth": "9 mm"}, "at most 8.59 mm"),
        ({"faults.crack.orders": [1.0]}, "has: gear, tooth, depth"),
    ],
)
def test_a_wrong_fault_names_its_key(
    healthy: Case, change: dict[str, object], expected: str
) -> None:
    with pytest.raises(InputError, match=expected) as raised:
        healthy.replace({**CRACK, **change})
    assert f"faults.crack.{next(iter(change)).rpartition('.')[2]}" in str(raised.value)


def test_a_ripple_is_in_the_motion_and_its_clock(healthy: Case) -> None:
    ripple = {"kind": "torque-ripple", "gear": "wheel", "orders": [1.5], "torques": ["1 N*m"]}
    case = healthy.replace({f"faults.motor.{key}": value for key, value in ripple.items()})
    clock = turning_clock(case)
    assert (clock.cycles, clock.turns_wheel) == (16, 2 / 3)  # one period of the ripple
    with pytest.warns(tribodyn.ModelWarning):
        result = tribodyn.run(case)
    motion = result.turning_motion
    assert motion.cycles == 16
    turned = np.fft.rfft(motion.position[:, motion.names.index("wheel_theta")]) / motion.time.size
    inertia = result.summary()["moment_of_inertia_wheel"]
    inertia += result.summary()["moment_of_inertia_pinion"] * 1.5**2
    omega = 2.0 * np.pi / motion.period
    # far below the first mode the drive turns as one: J theta'' = T
    assert abs(2.0 * turned[1] / (-1.0 / (inertia * omega**2)) - 1.0) < 0.02
    random = {"kind": "random-load", "gear": "wheel", "frequencies": ["20 Hz", "90 Hz"]}
    changes = {f"faults.road.{key}": value for key, value in random.items()}
    with pytest.raises(InputError, match="torque and densities are missing"):
        healthy.replace(changes)
    road = healthy.replace({**changes, "faults.road.torque": "1 N*m"})
    assert turning_clock(road).period == 1.0
    for speed, duration in (("1125 rpm", "0.4 s"), ("1500 rpm", "0.7 s"), ("1234 rpm", "0.3 s")):
        change = {"operation.speed": speed, "faults.road.duration": duration}
        other = road.replace(change)
        period = turning_clock(other).period
        assert float(duration.split()[0]) <= period <= float(duration.split()[0]) + 0.1
    # a long load has a phase of its own, until its lines need too much memory
    slow = road.replace({"faults.road.frequencies": ["20 Hz", "30 Hz"]})
    long = turning_clock(slow.replace({"faults.road.duration": "60 s"}))
    assert long.phases is not None
    assert (long.period, [name for name, _ in long.phases.phases]) == (
        60.0,
        ["mesh", "random load"],
    )
    with pytest.raises(tribodyn.ComputationError, match="At most 4 GB"):
        turning_clock(road.replace({"faults.road.duration": "60 s"}))


def test_low_orders_of_the_acceleration_are_those_of_the_sound_motion(healthy: Case) -> None:
    """Jumps of the friction must not alias into them."""
    with pytest.warns(tribodyn.ModelWarning):
        result = tribodyn.run(healthy.replace({**WHEEL, "faults.run-out.amplitude": "0 um"}))
    fine, motion = result.response.fine, result.turning_motion
    for name in ("pinion_x", "pinion_y"):
        place = fine.position[:, result.response.names.index(name)]
        frequency, lines = motion.harmonics(name)
        for order in (1, 2, 3):
            wave = fine.weight * np.exp(-2j * np.pi * order * fine.phase)
            expected = -2.0 * (wave @ place) * (2.0 * np.pi * frequency[24 * order]) ** 2
            assert abs(lines[24 * order] / expected - 1.0) < 0.02, (name, order)


def test_measured_teeth_from_a_file(healthy: Case, tmp_path: Path) -> None:
    file = tmp_path / "teeth.csv"
    rows = ["tooth,diameter,deviation", "1,mm,um", "5,60,0", "5,90,4", "2,60,-1", "2,90,2"]
    file.write_text("\n".join(rows), encoding="utf-8")
    stated = {"kind": "flank-topographies", "gear": "pinion", "file": str(file)}
    changes = {f"faults.flanks.{key}": value for key, value in stated.items()}
    case = healthy.replace(changes)
    mesh = turning_mesh_of(case)
    assert mesh.cycles == 16
    saved = tmp_path / "case.toml"
    saved.write_text(case.to_toml().replace(str(tmp_path) + "/", ""), encoding="utf-8")
    assert tribodyn.load_case(saved) == case
    nearest = turning_mesh_of(case.replace({"faults.flanks.other_teeth": "nearest"}))
    assert nearest.peak_to_peak_transmission_error > mesh.peak_to_peak_transmission_error
    for line, message in (
        ("17,60,0\n17,90,1", "The pinion has 16 teeth"),
        ("1.5,60,0", r"tooth = 1\.5 \(teeth\.csv, line 7\)"),
        ("3,75,0\n3,90,1", "not extrapolated"),
    ):
        file.write_text("\n".join([*rows, line]), encoding="utf-8")
        with pytest.raises(InputError, match=message) as raised:
            healthy.replace(changes)
        assert "faults.flanks.file" in str(raised.value)
    with pytest.raises(InputError, match='give the file to a fault of kind = "flank-topographies"'):
        healthy.replace({"gears.pinion.modification.profile_map": str(file)})


def test_the_cost_of_a_motion_is_in_proportion_to_its_cycles(healthy: Case) -> None:
    axis = {f"faults.axis.{k}": v for k, v in (("kind", "eccentricity"), ("amplitude", "5 um"))}
    one, two = (healthy.replace({**axis, "faults.axis.gear": g}) for g in ("pinion", "wheel"))
    short, long = (turning_clock(case) for case in (one, two))
    assert (short.cycles, long.cycles) == (16, 24)
    per_cycle = (long.cost - short.cost) / 8
    assert 1.0 < short.cost / (16 * per_cycle) < 2.5  # 0.2 s in 16 cycles, 2.5 s in 408
    cracked = turning_clock(one.replace(CRACK))
    assert cracked.cost - short.cost > 1.0  # finite elements of the tooth


def test_hypoid_gears_have_no_such_faults() -> None:
    with pytest.raises(InputError, match=r"faults\.crack.*hypoid"):
        tribodyn.load_case("hypoid-mixed-ehl").replace(CRACK)


def test_motion_without_faults_is_that_of_the_mesh_cycle(healthy: Case) -> None:
    with pytest.warns(tribodyn.ModelWarning):
        sound = tribodyn.run(healthy)
    assert sound.turns is None
    motion, force = sound.turning_motion, sound.response.fine.contact_force.sum(axis=1)
    assert motion.cycles == 1
    # ten ramps about the load in place of the whole law
    swing = np.ptp(force)
    assert abs(motion.mesh_force.mean() / sound.response.fine.mean(force) - 1.0) < 1e-4
    assert abs(motion.mesh_force.max() - force.max()) < 0.03 * swing
    assert abs(motion.mesh_force.min() - force.min()) < 0.03 * swing


@pytest.mark.slow
def test_a_slow_motion_follows_the_error_at_rest(result: Result) -> None:
    from tribodyn.dynamics import harmonic_balance

    mesh = turning_mesh_of(result.case)
    system = turning_system_of(result.case, result.mesh, result.damping, mesh)
    slow = harmonic_balance(system, 1.0, steps=256 * mesh.cycles)
    at_rest = np.interp(slow.phase, mesh.phase / mesh.cycles, mesh.transmission_error)
    # friction takes a part of the torque, so that the load is not that of the torque alone
    lag = slow.deflection[:, 0] - result.half_backlash - at_rest
    assert np.abs(lag).max() < 0.08 * np.ptp(mesh.transmission_error)


def test_lines_stand_at_the_turns_of_the_faulty_gear(healthy: Case) -> None:
    sound_pinion = {**CRACK, "faults.crack.depth": "0 mm"}
    with pytest.warns(tribodyn.ModelWarning):
        motion = tribodyn.run(healthy.replace({**sound_pinion, **WHEEL})).turning_motion
    assert motion.cycles == 48
    frequency, lines = motion.harmonics("pinion_y")
    size = np.abs(lines)
    order = np.round(frequency * motion.period).astype(int)  # 3 turns of the pinion, 2 of the wheel
    assert size[order % 2 == 1].max() < 1e-6 * size.max()
    mesh = int(np.argmax(size))
    assert order[mesh] % 48 == 0
    # damping follows the flanks, so that a slow run-out hardly modulates the mesh
    near = np.r_[size[mesh - 20 : mesh], size[mesh + 1 : mesh + 21]]
    sidebands = size[mesh - 2], size[mesh + 2]
    assert sorted(near)[-2:] == pytest.approx(sorted(sidebands))
    assert 1e-6 * size[mesh] < min(sidebands) < 1e-4 * size[mesh]


@pytest.fixture(scope="module")
def hunting(healthy: Case) -> Case:
    """17 and 24 teeth: a cracked pinion, an eccentric wheel."""
    return healthy.replace({
        "gears.pinion.teeth": 17, "gears.center_distance": "94 mm", "dynamics.backlash": "0.2 mm",
        "operation.speed": "1500 rpm", **CRACK, **WHEEL,
    })  # fmt: skip


@pytest.mark.slow
def test_a_hunting_pair_moves_over_phases_of_its_shafts(hunting: Case) -> None:
    from tribodyn.dynamics import PhaseResponse

    with pytest.warns(tribodyn.ModelWarning):
        motion = tribodyn.run(hunting).turning_motion
    assert isinstance(motion.response, PhaseResponse)
    assert (motion.repeats_after, motion.cycles) == (408, 408)
    lines = {line.cause: line for line in motion.lines("mesh_force", 3000)}
    mesh, pinion = 17 * 25.0, 25.0
    assert lines["1 x mesh"].frequency == pytest.approx(mesh, rel=1e-12)
    for turns in (1, 2, 3):  # of the cracked pinion
        for sign, side in (("+", 1.0), ("-", -1.0)):
            line = lines[f"1 x mesh {sign} {turns} x pinion"]
            assert line.frequency == pytest.approx(mesh + side * turns * pinion, rel=1e-12)
    error = {line.cause: abs(line.amplitude) for line in motion.lines("transmission_error", 3000)}
    assert error["1 x wheel"] == pytest.approx(5e-6, rel=1e-3)
    # the motion in time is that of the phases, all zero at the time zero
    at = motion.response.at(motion.time[::5000])
    contact = motion.response.lines("contact_force")
    waves = np.exp(2j * np.pi * np.multiply.outer(at.time, contact.frequency))
    force = (waves @ contact.amplitude).real.sum(axis=1)
    assert motion.mesh_force[::5000] == pytest.approx(force, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("points", "accuracy"), [(128, 1e-2), (512, 2e-3)])
def test_lines_of_a_crack_are_those_of_one_clock(
    hunting: Case, monkeypatch: pytest.MonkeyPatch, points: int, accuracy: float
) -> None:
    """Where the wheel is sound, 17 mesh cycles are a period."""
    from tribodyn.dynamics import harmonic_balance
    from tribodyn.errors import collected
    from tribodyn.study.faults import motion as of_pairs
    from tribodyn.study.faults.clock import PairTurns
    from tribodyn.study.faults.turning import response_lines
    from tribodyn.study.pipeline.run import prepare_run

    monkeypatch.setattr(of_pairs, "MESH_POINTS", points)
    with collected():
        prepared = prepare_run(hunting)
        motion = of_pairs.turning_motion(prepared)
    cracked = hunting.replace({"faults.run-out": None})
    driven = of_pairs.driven_system(
        cracked, prepared.mesh, prepared.damping, PairTurns.of(cracked), motion.teeth
    )
    clock = harmonic_balance(driven.system, motion.rotation_frequency("pinion"), steps=1024)
    expected = response_lines(clock, "contact_force", 17)[1].sum(axis=1)[: 17 * 25]
    lines = motion.sensed("mesh_force")
    still = lines.numbers[:, 1] == 0  # nothing of the wheel
    total = np.zeros_like(expected)
    number = lines.numbers[still, 0]
    inside = (number >= 0) & (number < total.size)
    total[number[inside]] = lines.amplitude[still][inside]
    error = np.abs(total - expected)[1:] / np.abs(expected[1:]).max()
    sides = np.arange(1, expected.size) % 17 > 0
    assert error[sides][: 17 * 10].max() < 1e-4
    assert error.max() < accuracy


def test_recordings_are_sampled_motions(result: Result, tmp_path: Path) -> None:
    motion = result.turning_motion
    recording = result.recording("transmission_error", 0.5, 20_000.0, seed=4)
    samples = recording["transmission_error"]
    frequency, lines = motion.harmonics("transmission_error")
    seconds = 2.0 * motion.period  # two periods of 0.2 s
    of_recording = np.fft.rfft(samples[: round(seconds * 20_000.0)])[::2]
    size = 2.0 * np.abs(of_recording) / round(seconds * 20_000.0)
    passed = np.flatnonzero((frequency > 0.0) & (frequency < 0.4 * 20_000.0))
    expected = np.abs(lines)[passed]
    np.testing.assert_allclose(size[passed], expected, atol=1e-4 * expected.max())
    turns = np.diff(np.flatnonzero(np.diff(recording["tacho"]) > 0.0)) / 20_000.0
    assert np.abs(turns * motion.rotation_frequency("pinion") - 1.0).max() < 1e-3
    noisy = result.recording("pinion_y", 0.5, 20_000.0, noise=2.0, seed=4)
    quiet = result.recording("pinion_y", 0.5, 20_000.0, seed=4)
    assert abs(np.std(noisy["pinion_y"] - quiet["pinion_y"]) / 2.0 - 1.0) < 0.05
    assert noisy.units["pinion_y"] == "m/s^2"
    for name in ("a.wav", "a.mat", "a.h5", "a.uff", "a.csv"):
        if name == "a.uff":
            pytest.importorskip("pyuff")
        saved = read(noisy.save(tmp_path / name, truth={"fault": "crack", "depth": 2e-3}))
        first = next(iter(saved.channels))
        np.testing.assert_allclose(
            saved[first], noisy["pinion_y"], atol=1e-6 * np.abs(noisy["pinion_y"]).max()
        )
        assert abs(saved.sample_rate / 20_000.0 - 1.0) < 1e-6
    truth = json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))
    assert truth["fault"] == "crack"
    with pytest.raises(InputError, match="no ending of a recording"):
        noisy.save(tmp_path / "a.xyz")
    vars(result).pop("turning_motion")
    with pytest.raises(InputError, match="The sensors are pinion_x"):
        result.recording("pinion_z", 0.5)
    assert "turning_motion" not in vars(result), "a wrong name does not wait for the motion"
    vars(result)["turning_motion"] = motion
    with pytest.raises(InputError, match="16 to"):
        result.recording("pinion_y", 1e-4)


def test_impacts_of_a_bearing_are_in_the_recording_of_its_gear(healthy: Case) -> None:
    bearing = {
        "kind": "bearing-defect", "gear": "pinion", "place": "outer", "rolling_elements": 9,
        "element_diameter": "7.94 mm", "pitch_diameter": "39.04 mm", "acceleration": 2000.0,
        "resonance": "6000 Hz",
    }  # fmt: skip
    changes = {f"faults.bearing.{key}": value for key, value in bearing.items()}
    with pytest.warns(tribodyn.ModelWarning):
        damaged = tribodyn.run(healthy.replace(changes))
    pinion, wheel = (
        damaged.recording(f"{gear}_y", 1.0)[f"{gear}_y"] for gear in ("pinion", "wheel")
    )
    assert np.abs(pinion).max() > 1000.0 > np.abs(wheel).max()


def test_the_report_shows_the_turns(result: Result) -> None:
    figure = result.plot_turning_motion()
    assert "48 mesh cycles" in figure.layout.title.text
    assert [trace.name for trace in figure.data] == ["at rest", "mesh force", "orders"]


def test_the_report_has_the_turns_of_a_case_with_faults(result: Result) -> None:
    from tribodyn.report.figure_blocks import figure_blocks

    names = [block.name for block in figure_blocks(result)]
    assert names.index("turning_motion") == names.index("spectrum") + 1


def test_a_sound_pair_with_jumps_of_the_friction_records_its_mesh_harmonics_alone() -> None:
    with pytest.warns(tribodyn.ModelWarning):
        sound = tribodyn.run(tribodyn.load_case("fzg-roughness"))
    signal = sound.recording("pinion_y", 1.0)["pinion_y"]
    power = np.abs(np.fft.rfft(signal * np.hanning(signal.size))) ** 2
    harmonic = round(sound.mesh.mesh_frequency)
    distance = np.abs((np.arange(power.size) + harmonic // 2) % harmonic - harmonic // 2)
    assert power[distance > 6].sum() < 1e-6 * power.sum()
