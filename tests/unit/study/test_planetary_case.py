"""A planetary stage from the case file to the report: faults, figures, files."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

import tribodyn as td
from tribodyn import plot
from tribodyn.cli import main
from tribodyn.errors import InputError
from tribodyn.study.pipeline.summary_figures import is_figure

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
        ({"operation.output": "shaft"}, "operation.output", "Members: sun, ring, carrier"),
        ({"operation.output": "sun"}, "operation.output", "is the input"),
        ({"operation.torque": "-600 N*m"}, "operation.torque", "brakes the input"),
        ({"operation.speed": "0 rpm"}, "operation.speed", "speed is 0"),
        ({"gears.ring.teeth": 61}, "gears.ring.teeth", "Write teeth = -61"),
        ({"gears.ring.tip_diameter": "220 mm"}, "gears.ring.tip_diameter", "tip"),
        ({"planets.low.center_distance": "70 mm"}, "planets.low.center_distance", "70 mm"),
        ({"meshes.x.gears": ["sun", "ring"]}, "meshes", "unknown key"),
    ],
)
def test_wrong_input_names_the_part(case, changes, location, finding):
    with pytest.raises(InputError) as fault:
        case.replace(changes, by="--set")
    assert location in str(fault.value)
    assert finding in str(fault.value)


def test_loads_and_friction_follow_from_the_teeth_and_the_speeds_relative_to_the_carrier(result):
    case, figures = result.case, result.summary()
    sun, force = case.pairs["sun"].gear_pair.pinion, 600.0 / 3 / 31.9496e-3
    assert sun.base_radius == pytest.approx(31.9496e-3, rel=1e-5)
    assert figures["meshes.sun.static_mesh_force"] == pytest.approx(force, rel=1e-5)
    # Friction moves the mean force by the efficiency of the meshes only.
    assert figures["meshes.ring.mean_mesh_force"] == pytest.approx(force, rel=0.02)
    assert result.operation.response.converged
    speeds = [pair.pinion_speed for pair in case.pairs.values()]
    rpm = np.array([1500.0 - 326.9231, 906.4685]) * np.pi / 30
    np.testing.assert_allclose(speeds, rpm, rtol=1e-6)
    # Power: what enters is what leaves and what all meshes lose.
    stage = result.operation.kinematics
    lost = figures["machine.input_power"] * (1.0 - figures["machine.efficiency"])
    assert figures["machine.friction_power"] == pytest.approx(lost, rel=0.02)
    assert stage.torques["sun"] + stage.torques["ring"] + stage.torques["carrier"] == (
        pytest.approx(0.0, abs=1e-6)
    )
    assert all(map(is_figure, figures))


def test_power_of_the_motion_is_that_of_the_torques(result):
    """The torque that keeps the mean speed is the output torque with the losses of the teeth."""
    system, fine = result.operation.system, result.operation.response.fine
    motion, stage = result.motion, result.operation.kinematics
    # Forces on the held ring: its torsional support carries the ring torque.
    ring = system.names.index("ring_u")
    held = float(np.asarray(system.stiffness)[ring, ring]) * fine.mean(fine.position[:, ring])
    radius = result.case.pairs["ring"].gear_pair.wheel.base_radius
    assert abs(held) * radius == pytest.approx(stage.torques["ring"], rel=0.004)
    assert motion.load_factor == pytest.approx(1.0, abs=1e-3)


def test_every_choice_of_driving_and_driven_member(case, result):
    """Forces at rest and lines of action are those of the torque on the sun."""
    for driver, output in (("carrier", "sun"), ("ring", "carrier"), ("carrier", "ring")):
        other = case.replace({"operation.input": driver, "operation.output": output}, by="test")
        load = other.operating_point
        stage = other.kinematics(load)
        drives = stage.torques["sun"] * stage.relative_speeds["sun"] > 0.0
        assert other.sun_drives(load) == drives
        pairs = other.pairs_under(load)
        assert (pairs["sun"].gears.driver == "pinion") == drives  # the sun is the pinion
        assert (pairs["ring"].gears.driver == "pinion") == drives
        lag = other.phases(load).ring[0]
        assert (lag == pytest.approx(result.operation.phases.ring[0])) == drives


def test_floating_sun_shares_the_load_and_a_held_one_does_not(case):
    for support, floats in (("0 N/m", True), ("1e10 N/m", False)):
        changes = {
            "planets.low.sun_support": support,
            "planets.low.pin_errors": ["30 um", "0 um", "0 um"],
        }
        shares = td.run(case.replace(changes, by="test")).operation.shares
        assert (abs(shares.load_factor - 1.0) < 1e-9) == floats
        assert (shares.share[0] < 0.99) != floats  # the pin that is ahead carries less


def test_table_of_modes_lists_the_harmonics_that_excite_each_type(result):
    rows = result.operation.stage_modes.rows()
    assert sum(int(row[2]) for row in rows) == 18
    by_type = {row[3]: row[4].partition(";")[0] for row in rows}
    # 17 teeth and 3 planets: harmonics 3, 6, ... turn the members, the others move them.
    assert by_type["rotational"] == "3, 6, 9, 12"
    assert by_type["translational"] == "1, 2, 4, 5, 7, 8, 10, 11"


def test_commands(tmp_path, monkeypatch, capsys, result):
    monkeypatch.chdir(tmp_path)
    result.save(tmp_path / "stage", csv=True)
    summary = json.loads((tmp_path / "stage" / "summary.json").read_text())
    assert summary == result.summary()
    report = (tmp_path / "stage" / "report.html").read_text()
    for text in ("Excited by mesh harmonics", "axial motion and tilting"):
        assert text in report
    with pytest.raises(SystemExit):
        main(["new", "stage.toml", "--from", "planetary-stage"])
    assert td.load_case("stage.toml").to_toml() == td.load_case("planetary-stage").to_toml()
    with pytest.raises(SystemExit):
        main(["check", "stage.toml", "--json"])
    printed = capsys.readouterr().out
    figures = json.loads(printed[printed.index("{") :])
    assert figures["planets.low.ratio"] == pytest.approx(4.588235, abs=1e-6)
    with pytest.raises(SystemExit) as refused:
        main(["harris", "stage.toml"])
    assert refused.value.code
    assert "this is a planetary stage" in capsys.readouterr().err


def inside(points, polygon):
    """Which points lie within a closed polygon, by the sum of the angles to its corners."""
    corners = polygon[None, :] - points[:, None]
    turns = np.angle(corners[:, 1:] / corners[:, :-1]).sum(axis=1)
    return np.abs(turns) > np.pi


def test_moving_picture_keeps_the_teeth_in_mesh(case):
    load = case.operating_point
    run = SimpleNamespace(load=load, kinematics=case.kinematics(load), phases=case.phases(load))
    sketch = plot.planetary_stage.draw(SimpleNamespace(case=case, operation=run))
    for frame in (sketch.frames[0], sketch.frames[7]):
        ring, planets, sun, _ = (each["x"] + 1j * each["y"] for each in frame["data"])
        planets = planets[~np.isnan(planets)]
        assert not inside(planets, 0.985 * sun).any()
        assert inside(planets, 1.015 * ring).all()
        assert inside(planets, 1.1 * sun).any()
