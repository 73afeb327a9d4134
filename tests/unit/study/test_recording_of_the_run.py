"""A recording of a result, compared with that result, differs by nothing but its sampling."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn
from tribodyn.cli import call
from tribodyn.errors import InputError
from tribodyn.measurement import compare
from tribodyn.study.faults.turning import even_samples, signal_lines

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

#: Changes that make a case quick to compute.
NO_FILM = {"film.model": "none", "friction.law": "none"}
QUICK: dict[str, dict[str, Any]] = {
    "fzg-roughness": {"stiffness.model": "analytic", **NO_FILM},
    "helical-pair": {"stiffness.model": "analytic", **NO_FILM},
    "hypoid-mixed-ehl": {
        "friction.law": "constant",
        "friction.coefficient": 0.05,
        "friction.boundary_friction_coefficient": None,
    },
    "two-stage-spur": {"load_cases": None},
    "planetary-stage": {
        "load_cases": None,
        "film.model": "dowson-higginson",
        "friction.law": "constant",
        "friction.coefficient": 0.05,
        "dynamics.seat_mass": "20 kg",
        "dynamics.seat_frequency": "1.5 kHz",
    },
}


@cache
def result_of(name: str) -> Any:
    return tribodyn.run(tribodyn.load_case(name).replace(QUICK[name]))


def check(name: str, sensor: str, signal: str, teeth: int | None = None, **shaft: str) -> None:
    result = result_of(name)
    recording = result.recording(sensor, 1.0, **shaft)
    options: dict[str, Any] = {"harmonics": 3, "tacho": "tacho", "teeth": teeth}
    comparison = compare(result, recording, {sensor: signal}, **options)
    assert comparison.measure.tolist()[0] == "rms"
    size = float(comparison.computed.max())
    np.testing.assert_allclose(
        comparison.computed, comparison.measured, rtol=4e-3, atol=1e-3 * size
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "sensor", "signal"),
    [
        ("fzg-roughness", "pinion_y", "acceleration_loa_pinion"),
        ("fzg-roughness", "acceleration_loa_wheel", "wheel_y"),
        ("fzg-roughness", "mesh_force", "mesh_force"),
        ("fzg-roughness", "transmission_error", "dynamic_transmission_error"),
        ("fzg-roughness", "pinion_theta", "pinion_theta"),
        ("helical-pair", "pinion_y", "acceleration_loa_pinion"),
        ("helical-pair", "mesh_force", "mesh_force"),
        ("hypoid-mixed-ehl", "acceleration_x_pinion", "pinion_x"),
        ("hypoid-mixed-ehl", "mesh_force", "mesh_force"),
        ("hypoid-mixed-ehl", "dynamic_transmission_error", "transmission_error"),
    ],
)
def test_pairs(name: str, sensor: str, signal: str) -> None:
    check(name, sensor, signal)


@pytest.mark.slow
@pytest.mark.parametrize("sensor", ["acceleration_loa_pinion", "dynamic_transmission_error"])
def test_a_pair_with_a_fault_is_compared_with_its_motion_over_whole_turns(sensor: str) -> None:
    """The sidebands of the run-out count in the rms, of which the sound motion has none."""
    fault = {"kind": "eccentricity", "gear": "pinion", "amplitude": "10 um"}
    case = tribodyn.load_case("fzg-roughness").replace(
        QUICK["fzg-roughness"] | {f"faults.axis.{key}": value for key, value in fault.items()}
    )
    result = tribodyn.run(case)
    recording = result.recording(sensor, 2.0)
    comparison = compare(result, recording, {sensor: sensor}, harmonics=1, tacho="tacho")
    assert comparison.computed[0] == pytest.approx(comparison.measured[0], rel=4e-3)
    if sensor == "dynamic_transmission_error":
        assert comparison.computed[0] == pytest.approx(10e-6 / np.sqrt(2.0), rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize(
    "sensor",
    [
        "housing.middle left.acceleration_y",
        "bearings.C.acceleration_z",
        "bearings.A.force_y",
        "meshes.first.mesh_force",
        "meshes.first.transmission_error",
    ],
)
def test_machines(sensor: str) -> None:
    check("two-stage-spur", sensor, sensor)


def test_names_of_a_pair_are_those_of_its_data() -> None:
    result = result_of("fzg-roughness")
    names = [name for name in result.turning_motion.sensors if "theta" not in name]
    assert {f"{name}_spectrum" for name in names} <= set(result.to_xarray())
    by_name, by_coordinate = (
        result.turning_motion.signal(name)[0] for name in ("acceleration_loa_pinion", "pinion_y")
    )
    np.testing.assert_array_equal(by_name, by_coordinate)


@pytest.mark.slow
@pytest.mark.parametrize(
    "sensor",
    [
        "ring.acceleration",
        "ring.force",
        "planet_1.sun_mesh_force",
        "planet_2.ring_mesh_force",
    ],
)
def test_planetary_stages(sensor: str) -> None:
    case = result_of("planetary-stage").case
    teeth = abs(case.gears["ring"].teeth)
    check("planetary-stage", sensor, sensor, teeth, tacho="carrier")


def test_jumps_are_not_aliased_into_the_low_orders() -> None:
    """Of a jump at any phase: amplitude 2/(pi k) sin(pi k d) of a pulse of the width d."""
    for start in (0.1, 0.30017, 0.70123):
        width = 0.2004
        phase = np.array([0.0, start, start, start + width, start + width, 1.0])
        values = np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
        lines = signal_lines(even_samples(phase, 512)(values), 1.0)[1]
        number = np.arange(1, 30)
        expected = np.abs(2.0 / (np.pi * number) * np.sin(np.pi * number * width))
        np.testing.assert_allclose(np.abs(lines[1:30]), expected, atol=1e-4)
        assert lines[0].real == pytest.approx(width, abs=1e-12)


@pytest.mark.parametrize("name", ["fzg-roughness", "two-stage-spur", "planetary-stage"])
def test_a_wrong_sensor_is_refused_before_the_run(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def no_run(*_: object) -> None:
        raise AssertionError("the motion is computed")

    monkeypatch.setattr("tribodyn.cases.load.run", no_run)
    monkeypatch.setattr("tribodyn.study.machine.run.run_machine", no_run)
    monkeypatch.setattr("tribodyn.study.pipeline.run.prepare_run", no_run)
    out = str(tmp_path / "wave.mat")
    assert call(["recording", name, "--sensor", "bearings.Q.acceleration_y", "--out", out]) == 2
    assert 'no sensor is named "bearings.Q.acceleration_y"' in capsys.readouterr().err
    assert not Path(out).exists()
    case = tribodyn.load_case(name)
    with pytest.raises(InputError, match="no sensor is named"):
        tribodyn.study.record_set(
            case,
            tmp_path / "set",
            {"operation.torque": ["100 N*m", "110 N*m"]},
            sensor="wrong",
            duration=1.0,
        )


def test_the_truth_states_torque_and_speed(tmp_path: Path) -> None:
    out = tmp_path / "wave.mat"
    options = ["--sensor", "acceleration_loa_pinion", "--duration", "0.1 s", "--out", str(out)]
    assert call(["recording", "fzg-roughness", *options]) == 0
    truth = json.loads(out.with_suffix(".json").read_text(encoding="utf-8"))
    assert truth["operation.torque"] == 90.0
    assert truth["operation.speed"] == pytest.approx(900.0 * np.pi / 30.0)


def test_a_tacho_is_on_either_gear_of_a_pair() -> None:
    result = result_of("fzg-roughness")
    edges = {
        gear: np.flatnonzero(
            np.diff(result.recording("mesh_force", 4.0, tacho=gear, seed=1)["tacho"]) > 0.0
        )
        for gear in ("pinion", "wheel")
    }
    turns = {gear: np.diff(at).mean() / 25_600.0 for gear, at in edges.items()}
    assert turns["pinion"] == pytest.approx(1.0 / 15.0, rel=1e-3)
    assert turns["wheel"] == pytest.approx(1.5 / 15.0, rel=1e-3)
    with pytest.raises(InputError, match="Known: pinion, wheel"):
        result.recording("mesh_force", 0.1, tacho="input")
    with pytest.raises(InputError, match="of a sensor on the ring"):
        result.recording("mesh_force", 0.1, sensor_angle=0.3)
