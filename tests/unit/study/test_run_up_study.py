"""A case that runs up: tables follow the speed, supports are outputs, bad ranges are refused."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import tribodyn
from tribodyn.analysis import alternating_rms
from tribodyn.errors import InputError
from tribodyn.study.pipeline.assembly import rotation_of
from tribodyn.study.studies.run_up import speed_systems


@pytest.fixture(scope="module")
def case() -> tribodyn.Case:
    return tribodyn.load_case("fzg-roughness")


def test_a_run_up_at_constant_speed_is_the_run_at_that_speed(case: tribodyn.Case) -> None:
    low = case.operation.speed
    run = tribodyn.run_up(case, (low, 1.002 * low), 0.1, tables=1, samples=64)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tribodyn.ModelWarning)
        steady = tribodyn.run(case)
    force = steady.response.fine.contact_force.sum(axis=1)
    rms = run.cycles.contact_force.alternating_rms[-1, 0]
    assert rms == pytest.approx(float(alternating_rms(steady.response.fine, force)), rel=0.03)
    names = run.output_names
    assert {"bearing_force_pinion_y", "bearing_force_wheel_x"} <= set(names)
    # the supports carry the mesh force on average
    mean = run.cycles.output.mean[-1, names.index("bearing_force_wheel_y")]
    assert abs(mean) == pytest.approx(run.cycles.contact_force.mean[-1, 0], rel=1e-3)
    assert run.teeth == case.gear_pair.pinion.teeth or case.operation.speed_of == "wheel"
    assert run.speed[0] == pytest.approx(low, rel=1e-3)


def test_friction_and_inertia_follow_the_speed(case: tribodyn.Case) -> None:
    systems, per_speed = speed_systems(case, [50.0, 300.0])
    slow, quick = (systems[each] for each in sorted(systems))
    phase = np.array([0.1, 0.6])
    less = np.abs(slow.contacts[0].friction(phase)).max()
    assert less != pytest.approx(np.abs(quick.contacts[0].friction(phase)).max(), rel=0.02)
    cycle = rotation_of(case, slow.names)
    turning = per_speed * cycle
    by_name = dict(zip(slow.names, turning, strict=True))
    # both gears roll on each other: teeth times angle agree
    pair = case.gear_pair
    rolled = [by_name[f"{g}_theta"] * getattr(pair, g).teeth for g in ("pinion", "wheel")]
    assert rolled[0] == pytest.approx(rolled[1])
    assert 2 * np.pi * per_speed == pytest.approx(rolled[0])


@pytest.mark.slow
def test_a_run_up_with_faults_is_the_motion_over_whole_turns(case: tribodyn.Case) -> None:
    faults = {
        "axis": {"kind": "eccentricity", "gear": "pinion", "amplitude": "10 um"},
        "motor": {
            "kind": "torque-ripple",
            "gear": "pinion",
            "orders": [2.0],
            "torques": ["0.1 N*m"],
        },
    }
    faulty = case.replace(
        {"stiffness.model": "analytic", "dynamics.backlash": "0.2 mm"}
        | {f"faults.{name}.{key}": v for name, table in faults.items() for key, v in table.items()}
    )
    low = case.operation.speed
    run = tribodyn.run_up(faulty, (low, (1.0 + 1e-6) * low), 0.06, tables=1, samples=256)
    assert run.samples == 256
    assert run.cycles.time.size == 16
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tribodyn.ModelWarning)
        motion = tribodyn.run(faulty).turning_motion
    force = run.signal("contact_force")[0][-16 * 256 :]
    lines = np.abs(np.fft.rfft(force)) / force.size
    expected = np.abs(motion.harmonics("mesh_force")[1][: lines.size])
    expected[1:] /= 2.0
    # turn, mesh, its sidebands by the rotation that the ripple causes (2 % of it), and the ripple
    away = np.abs(lines - expected)[[0, 16, 32, 14, 18, 2]]
    assert np.all(away < 0.01 * expected[16]), away
    assert expected[[14, 18]].min() > 0.02 * expected[16]
    # ramps of the force law open in every mesh cycle, the teeth do not come apart
    assert run.cycles.contact_loss_share.max() > 0.1
    assert "separate" not in repr(run)
    road = {"kind": "random-load", "gear": "wheel", "frequencies": ["9 Hz", "90 Hz"]}
    changes = {f"faults.road.{key}": value for key, value in road.items()}
    with pytest.raises(InputError, match="a random load in a run-up"):
        tribodyn.run_up(faulty.replace({**changes, "faults.road.torque": "1 N*m"}), (low, 2 * low))


@pytest.mark.parametrize(
    ("between", "message"),
    [
        (None, "from one speed"),
        (("900 rpm", "400 rpm"), "the lowest"),
        (("0 rpm", "9 rpm"), '^argument between: .*"0 rpm".* 0.01 rpm to 200000 rpm.*standstill'),
        (("9 rpm", "9e6 rpm"), '^argument between: .*"9e6 rpm".* to 200000 rpm.*Correct the value'),
        (("9 rpm", "9 mm"), '^argument between: .*"9 mm".*wrong kind'),
    ],
)
def test_bad_ranges_are_refused(case: tribodyn.Case, between: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        tribodyn.run_up(case, between)  # type: ignore[arg-type]
