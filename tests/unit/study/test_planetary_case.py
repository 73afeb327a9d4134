"""A planetary stage from the case file to the report: faults, figures, files."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

import tribodyn as td
from tribodyn import plot
from tribodyn.cli import main
from tribodyn.errors import InputError
from tribodyn.machine import load_shares, planetary_modes, planetary_plane_model
from tribodyn.study.machine.modes import mode_rows
from tribodyn.study.machine.result import steps_of
from tribodyn.study.pipeline.summary_figures import is_figure
from tribodyn.study.planetary.stage_result import turned_phases

QUICK = {
    "film.model": "dowson-higginson",
    "friction.law": "constant",
    "friction.coefficient": 0.05,
    "load_cases": None,
}


@pytest.fixture(scope="module")
def case():
    return td.load_case("planetary-stage").replace(QUICK, by="test")


@pytest.fixture(scope="module")
def result(case):
    return td.run(case)


@pytest.mark.parametrize(
    ("changes", "location", "finding"),
    [
        ({"planets.low.count": 4}, "planets.low.count", "(61 + 17)/4 = 19.5 is not whole"),
        ({"planets.low.count": 6}, "planets.low.count", "overlap by"),
        (
            {"planets.low.angles": ["0 deg", "100 deg", "240 deg"]},
            "planets.low.angles",
            "planet 2 at 100 deg does not fit",
        ),
        ({"planets.low.sun": "sonne"}, "planets.low.sun", 'no gear "sonne"'),
        ({"planets.low.pin_errors": ["5 um"]}, "planets.low.pin_errors", "1 values for 3"),
        ({"planets.low.pins": 3}, "planets.low.pins", "unknown key"),
        ({"operation.output": None}, "operation.output", "output is missing"),
        ({"operation.output": "shaft"}, "operation.output", "Known: sun, ring, carrier"),
        ({"operation.output": "sun"}, "operation.output", "is the input"),
        ({"operation.speed": "0 rpm"}, "operation.speed", "speed = 0 rpm"),
        ({"gears.ring.teeth": 61}, "gears.ring.teeth", "Write teeth = -61"),
        ({"gears.ring.tip_diameter": "220 mm"}, "gears.ring.tip_diameter", "tip"),
        ({"planets.low.center_distance": "70 mm"}, "planets.low.center_distance", "70 mm"),
    ],
)
def test_wrong_input_names_the_part(case, changes, location, finding):
    with pytest.raises(InputError) as fault:
        case.replace(changes, by="--set")
    assert location in str(fault.value)
    assert finding in str(fault.value)


def test_loads_and_friction_follow_from_the_teeth_and_the_speeds_relative_to_the_carrier(result):
    case, figures = result.case, result.summary()
    pairs = {m: case.pair(f"low_{m}1", case.operating_point) for m in ("sun", "ring")}
    sun, force = pairs["sun"].gear_pair.pinion, 600.0 / 3 / 31.9496e-3
    assert sun.base_radius == pytest.approx(31.9496e-3, rel=1e-5)
    assert figures["meshes.low_sun1.static_mesh_force"] == pytest.approx(force, rel=1e-5)
    # What balances by symmetry is no figure of rounding: equal planets do not push their members.
    for part in ("ring", "carrier"):
        assert figures[f"bearings.low_{part}.mean_radial_force"] == 0.0
        assert figures[f"bearings.low_{part}.rms_radial_force"] > 1.0
        assert figures[f"shafts.{part}.largest_deflection"] == 0.0
    # Friction moves the mean force by the efficiency of the meshes only.
    assert figures["meshes.low_ring1.mean_mesh_force"] == pytest.approx(force, rel=0.02)
    assert result.operation.response.converged
    speeds = [pair.pinion_speed for pair in pairs.values()]
    rpm = np.array([1500.0 - 326.9231, 906.4685]) * np.pi / 30
    np.testing.assert_allclose(speeds, rpm, rtol=1e-6)
    # Power: what enters is what leaves and what all meshes lose.
    lost = figures["machine.input_power"] * (1.0 - figures["machine.efficiency"])
    assert figures["machine.friction_power"] == pytest.approx(lost, rel=0.02)
    flow = result.operation.power_flow.shafts
    left = figures["machine.input_power"] - lost
    assert flow["carrier"].power == pytest.approx(left, rel=1e-9)
    torques = [figures[f"shafts.{name}.torque"] for name in ("sun", "ring", "carrier")]
    assert torques[0] + torques[1] == pytest.approx(torques[2], rel=1e-9)
    assert all(map(is_figure, figures))


def test_power_of_the_motion_is_that_of_the_torques(result):
    """The torque that keeps the mean speed is the output torque with the losses of the teeth."""
    fine, structure = result.operation.response.fine, result.operation.structure
    # Forces on the held ring: its torsional support carries the ring torque.
    held = structure.bearing_load("low_ring", fine.mean(fine.position))[3]
    torque = result.operation.power_flow.shafts["ring"].torque
    assert abs(held) == pytest.approx(torque, rel=0.004)
    # The phases of the planets are thirds of a cycle, which its 200 steps do not meet.
    assert result.operation.stage().motion.load_factor == pytest.approx(1.0, abs=2e-5)


def test_every_choice_of_driving_and_driven_member(case, result):
    """Lines of action are those of the torque on the sun."""
    first = result.operation.stage().phases.ring[0]
    for driver, output in (("carrier", "sun"), ("ring", "carrier"), ("carrier", "ring")):
        other = case.replace({"operation.input": driver, "operation.output": output}, by="test")
        load = other.operating_point
        machine = other.machine()
        sun = machine.kinematics.meshes["low_sun1"]
        drives = sun.torque[0] * sun.speeds[0] > 0.0
        assert (sun.driver == "sun") == drives
        pairs = [other.pair(f"low_{mesh}1", load) for mesh in ("sun", "ring")]
        assert [pair.gears.driver == "pinion" for pair in pairs] == [drives, drives]
        lag = turned_phases(machine, "low").ring[0]
        assert (lag == pytest.approx(first)) == drives


def test_floating_sun_shares_the_load_and_a_held_one_does_not(case):
    for support, floats in (("0 N/m", True), ("1e10 N/m", False)):
        changes = {
            "planets.low.sun_support": support,
            "planets.low.pin_errors": ["30 um", "0 um", "0 um"],
        }
        stage = td.run(case.replace(changes, by="test")).operation.stage()
        assert (abs(stage.shares.load_factor - 1.0) < 1e-9) == floats
        assert (stage.shares.share[0] < 0.99) != floats  # the pin that is ahead carries less
        plane = load_shares(**{**stage.plane_data, "carrier_speed": 0.0})
        np.testing.assert_allclose(stage.shares.share, plane.share, rtol=1e-9)


def test_table_of_modes_lists_the_harmonics_that_excite_each_type(result):
    modes = result.operation.stage().modes
    assert [modes.types.count(each) for each in ("rotational", "translational")] == [5, 12]
    for row in mode_rows(result.modes):
        # 17 teeth and 3 planets: harmonics 3, 6, ... turn the members, the others move them.
        harmonic = int(row[4].split(" x ")[1].split()[0])
        assert row[3].endswith("low rotational" if harmonic % 3 == 0 else "low translational")


def test_the_motion_is_that_of_the_plane_model_of_the_stage(case, result):
    """Natural frequencies of another model with the same masses and springs."""
    stage = result.operation.stage()
    plane = planetary_modes(planetary_plane_model(**stage.plane_data))
    elastic = plane.frequency > 0.0
    np.testing.assert_allclose(stage.modes.frequency, plane.frequency[elastic], rtol=1e-8)
    assert stage.modes.types == tuple(np.array(plane.types)[elastic])


def test_commands(tmp_path, monkeypatch, capsys, result):
    monkeypatch.chdir(tmp_path)
    result.save(tmp_path / "stage", csv=True)
    summary = json.loads((tmp_path / "stage" / "summary.json").read_text())
    assert summary == result.summary()
    report = (tmp_path / "stage" / "report.html").read_text()
    for text in ("mesh low x 6 (R)", "axial motion and tilting", "Sensor on the ring"):
        assert text in report
    with pytest.raises(SystemExit):
        main(["new", "stage.toml", "--from", "planetary-stage"])
    assert td.load_case("stage.toml") == td.load_case("planetary-stage")
    with pytest.raises(SystemExit):
        main(["check", "stage.toml", "--json"])
    printed = capsys.readouterr().out
    figures = json.loads(printed[printed.index("{") :])
    assert figures["planets.low.ratio"] == pytest.approx(4.588235, abs=1e-6)
    with pytest.raises(SystemExit) as refused:
        main(["harris", "stage.toml"])
    assert refused.value.code
    assert "harris is about one mesh" in capsys.readouterr().err


def inside(points, polygon):
    """Which points lie within a closed polygon, by the sum of the angles to its corners."""
    corners = polygon[None, :] - points[:, None]
    turns = np.angle(corners[:, 1:] / corners[:, :-1]).sum(axis=1)
    return np.abs(turns) > np.pi


def test_moving_picture_keeps_the_teeth_in_mesh(case):
    sketch = plot.planetary_stage.draw(case)
    for frame in (sketch.frames[0], sketch.frames[7]):
        ring, planets, sun, _ = (each["x"] + 1j * each["y"] for each in frame["data"])
        planets = planets[~np.isnan(planets)]
        assert not inside(planets, 0.985 * sun).any()
        assert inside(planets, 1.015 * ring).all()
        assert inside(planets, 1.1 * sun).any()


@pytest.mark.parametrize("count", [2, 3, 4, 5, 7])
def test_all_planets_are_sampled_at_the_same_places_of_their_cycle(count):
    structure = SimpleNamespace(
        frame="carrier",
        machine=SimpleNamespace(planets={"low": SimpleNamespace(count=count)}),
    )
    assert steps_of(structure) % (2 * count) == 0
    assert 240 <= steps_of(structure) < 240 + 2 * count


def test_what_a_load_of_a_stage_had_is_read_under_its_old_name(result):
    load = result.operation
    for name in ("shares", "phases"):
        with pytest.warns(DeprecationWarning, match=rf"LoadResult\.stage\(\)\.{name}"):
            assert type(getattr(load, name)) is type(getattr(load.stage(), name))
    with pytest.raises(AttributeError, match="no attribute 'no_such_name'"):
        load.no_such_name  # noqa: B018
