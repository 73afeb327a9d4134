"""One definition of each summary figure over pairs, machines and stages."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from tests.unit.study.test_cautions_of_meshes import pair_and_machine
from tests.unit.study.test_machine_run import GEARED

import tribodyn as td
from tribodyn.cli import main
from tribodyn.study import SUMMARY, read_case
from tribodyn.study.machine.first_look import kinematic_figures
from tribodyn.study.machine.summary import peak_over_mean, without_rounding
from tribodyn.study.pipeline.assembly import geometry
from tribodyn.study.pipeline.response_series import measured, mesh_force
from tribodyn.study.pipeline.summary_figures import figure_of, part_figures
from tribodyn.study.studies.sweep_result import level_keys

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
QUICK = {
    "film.model": "dowson-higginson",
    "friction.law": "constant",
    "friction.coefficient": 0.05,
    "load_cases": None,
}
RMS = "alternating_rms_mesh_force"


def levels(force: Any, weight: Any) -> dict[str, Any]:
    """Figures of the force of each mesh (samples, meshes) by their definitions."""
    mean = weight @ force
    return {
        "mean_mesh_force": mean,
        "peak_mesh_force": force.max(axis=0),
        "minimum_mesh_force": force.min(axis=0),
        "dynamic_factor_peak": force.max(axis=0) / mean,
        RMS: np.sqrt(weight @ (force - mean) ** 2),
        "rms": np.sqrt(weight @ force**2),
    }


def same(figures: dict[str, float], expected: dict[str, Any], prefix: str = "") -> None:
    for name, value in expected.items():
        assert figures[prefix + name] == pytest.approx(np.asarray(value).item(), rel=1e-6, abs=1e-6)


def test_forces_of_a_pair() -> None:
    result = td.run(td.load_case("fzg-stiffness"))
    samples = measured(result.response)
    expected = levels(mesh_force(samples)[:, None], samples.weight / samples.weight.sum())
    mean = expected["mean_mesh_force"]
    assert expected.pop("rms") ** 2 == pytest.approx(mean**2 + expected.pop(RMS) ** 2)
    figures = result.summary()
    same(figures, expected)
    square = figures["rms_mesh_force"] ** 2 - figures["mean_mesh_force"] ** 2
    assert figures["dynamic_factor_rms"] ** 2 == pytest.approx(1.0 + square / mean.item() ** 2)


#: Figures of a pair that its mesh in a machine has not, by the first words of their names.
OF_LUMPED = (
    "rms_mesh_force", "mean_dynamic", "rms_dynamic", "peak_to_peak_dynamic", "dynamic_trans",
    "mesh_damping", "rms_friction", "rms_film", "rms_asperity", "mean_friction_power", "gear_power",
    "mesh_natural", "resonance", "natural_frequency", "iso_mesh", "gear_body",
    "mean_static_transmission_error", "peak_to_peak_static_transmission_error",
    "static_transmission_error_harmonic", "steps_per", "omega", "steady_state", "step_error",
    "input_power", "efficiency", "oil_temperature",
)  # fmt: skip


@pytest.mark.parametrize("helix", [{}, {"helix_angle": "12 deg"}])
def test_a_mesh_of_a_machine_has_the_figures_of_its_pair(helix: dict[str, str]) -> None:
    gear = {"face_width": "20 mm", "modification": {"tip_relief": "10 um"}, "roughness_ra": "1 um"}
    parts = {"teeth": 20, **gear}, {"teeth": 41, **gear, "mass": "1.5 kg"}
    point = {"speed": "1500 rpm", "torque": "90 N*m"}
    oil = {"lubricant": {"name": "ISO VG 100", "temperature": "60 degC"}, "film": {"model": "moes"}}
    cases = pair_and_machine(*parts, point, geometry=helix, models=oil, backlash="0.1 mm")
    of_pair, of_machine = (td.run(case).summary() for case in cases)
    left = {key for key in of_pair if not key.startswith(OF_LUMPED)}
    assert left <= {key.removeprefix("meshes.m.") for key in of_machine}
    for key in left:
        moving = key.startswith("dynamic_factor") or key.endswith("mesh_force")
        expected = pytest.approx(of_pair[key], rel=1e-2 if moving else 1e-4, abs=1e-12)
        assert of_machine[f"meshes.m.{key}"] == expected, key


def test_a_hypoid_mesh_has_the_geometry_of_its_pair() -> None:
    case = td.load_case("hypoid-axle")
    blank = geometry(case.pair("axle", case.operating_point))
    figures = kinematic_figures(case)
    assert {key: figures[f"meshes.axle.{key}"] for key in blank} == pytest.approx(blank)
    assert figures["meshes.axle.pitch_angle_pinion"] > 0.0


def test_forces_of_a_machine() -> None:
    result = td.run(read_case(GEARED, "geared.toml"))
    motion, figures = result.motion, result.summary()
    expected = levels(motion.mesh_force[:, :1], motion.weight)
    del expected["rms"]
    same(figures, expected, "meshes.first.")
    for start in ("meshes.first", "load_cases.light.meshes.first"):
        old, new = f"{start}.rms_mesh_force", f"{start}.{RMS}"
        with pytest.warns(DeprecationWarning, match=new):
            assert figures[old] == figures[new]
        assert old in figures
        assert old not in list(figures)
    assert "meshes.first.no_such_figure" not in figures
    assert figures.get("meshes.sun.peak_mesh_force") is None


@pytest.mark.slow
def test_forces_of_a_stage_leave_load_sharing_to_the_load_factor() -> None:
    uneven = {"planets.low.pin_errors": ["40 um", "0 um", "0 um"],
              "planets.low.sun_support": "1e9 N/m"}  # fmt: skip
    result = td.run(td.load_case("planetary-stage").replace({**QUICK, **uneven}, by="test"))
    motion, figures = result.operation.stage().motion, result.summary()
    assert figures["planets.low.dynamic_load_factor"] > 1.05
    for mesh in ("sun", "ring"):
        each = levels(getattr(motion, f"{mesh}_mesh_force"), motion.weight)
        del each["rms"]
        for number in range(3):
            of_planet = {name: values[number] for name, values in each.items()}
            same(figures, of_planet, f"meshes.low_{mesh}{number + 1}.")
        expected = {
            "mean_mesh_force": each["mean_mesh_force"].mean(),
            "minimum_mesh_force": each["minimum_mesh_force"].min(),
            **{n: each[n].max() for n in ("peak_mesh_force", "dynamic_factor_peak", RMS)},
        }
        for name, value in expected.items():
            with pytest.warns(DeprecationWarning, match=rf"meshes\.low_{mesh}1\.{name}"):
                assert figures[f"meshes.{mesh}.{name}"] == pytest.approx(value, rel=1e-6, abs=1e-6)
        shared = each["peak_mesh_force"].max() / each["mean_mesh_force"].mean()
        assert each["dynamic_factor_peak"].max() < shared


@pytest.mark.slow
@pytest.mark.parametrize("name", ["planetary-stage", "two-stage-spur"])
def test_each_mesh_is_listed_once(name: str) -> None:
    figures = td.run(td.load_case(name).replace(QUICK, by="test")).summary()
    for kind in ("friction_power", "static_mesh_force"):
        listed = {k: v for k, v in figures.items() if k.startswith("meshes.") and k.endswith(kind)}
        assert len(listed) == (6 if name == "planetary-stage" else 2)
    lost = sum(v for k, v in figures.items() if k.startswith("meshes.") and "friction_power" in k)
    assert lost == pytest.approx(figures["machine.friction_power"], rel=1e-12)


def test_idle_meshes_have_no_dynamic_factor() -> None:
    force = np.array([[4.0, 0.0, 3.0], [2.0, 0.0, 1.0]])
    assert peak_over_mean(force, force.mean(axis=0)) == 1.5
    assert peak_over_mean(force[:, 1:2], np.zeros(1)) is None
    assert peak_over_mean(force[:, 0], 3.0) == 4.0 / 3.0
    assert peak_over_mean(force[:, 1], 0.0) is None


def test_rounding_is_no_figure() -> None:
    figures = {"bearings.a.mean_axial_force": 2e-9, "meshes.m.mean_mesh_force": 2e3,
               "bearings.a.mean_radial_force": -2e-7, "meshes.m.misalignment": 1e-12,
               "shafts.s.largest_deflection": 3e-24, "shafts.s.speed": 1e-9}  # fmt: skip
    rounded = without_rounding(figures)
    zeros = {"bearings.a.mean_axial_force", "shafts.s.largest_deflection"}
    assert rounded == {key: 0.0 if key in zeros else value for key, value in figures.items()}


def test_a_name_has_one_meaning() -> None:
    for kind, names in part_figures().items():
        assert len(names) == len(set(names))
        for name in names:
            part = figure_of(f"{kind}.x.{name}")
            if name in SUMMARY:
                pair = SUMMARY[name]
                same_unit = (pair.unit, pair.display_unit) == (part.unit, part.display_unit)
                assert same_unit
                assert part.meaning == pair.meaning
    assert figure_of("meshes.x.rms_mesh_force").meaning == figure_of(f"meshes.x.{RMS}").meaning


def test_the_dictionary_tells_figures_apart(capsys: pytest.CaptureFixture[str]) -> None:
    for name, text in (
        (RMS, "its mean left out"),
        ("rms_mesh_force", "its mean included"),
        ("mean_friction_power", "in the running mesh"),
        ("friction_power", "teeth at rest"),
    ):
        with pytest.raises(SystemExit):
            main(["explain", name, "--json"])
        assert text in str(json.loads(capsys.readouterr().out)[0]), name


def test_older_files_name_the_level_as_before() -> None:
    old = ["meshes.a.rms_mesh_force", "meshes.a.peak_mesh_force"]
    assert level_keys(old, RMS) == old[:1]
    assert level_keys([*old, f"meshes.a.{RMS}"], RMS) == [f"meshes.a.{RMS}"]


@pytest.mark.parametrize(
    "name",
    ["two-stage-helical", "planetary-stage",
     pytest.param("wind-turbine-gearbox", marks=pytest.mark.slow)],
)  # fmt: skip
def test_meshes_have_the_geometry_of_their_pairs(name: str) -> None:
    """What check shows of a mesh is what it shows of the pair of its gears."""
    case = td.load_case(name)
    figures = kinematic_figures(case)
    for mesh in case.meshes:
        pair = geometry(case.pair(mesh, case.operating_point))
        for key in ("center_distance", "operating_pressure_angle", "transverse_contact_ratio"):
            assert figures[f"meshes.{mesh}.{key}"] == pytest.approx(pair[key], rel=1e-12), key
        if pair.get("overlap_ratio"):
            overlap = figures[f"meshes.{mesh}.overlap_ratio"]
            assert overlap == pytest.approx(pair["overlap_ratio"], rel=1e-12)


def test_a_mesh_of_constant_stiffness_has_its_place_without_teeth() -> None:
    case = td.load_case("two-stage-spur")
    first = case.replace({"meshes.first.stiffness": 5e8, "load_cases": None})
    before, after = kinematic_figures(case), kinematic_figures(first)
    for key in ("center_distance", "operating_pressure_angle"):
        name = f"meshes.second.{key}"
        assert after[name] == before[name]
        assert f"meshes.first.{key}" in after
    assert "meshes.first.transverse_contact_ratio" not in after
    reduced = first.replace({"meshes.second.stiffness": 5e8, "film": None, "friction": None,
                             "lubricant": None, "stiffness": None})  # fmt: skip
    summary = td.run(reduced).summary()
    for name, value in kinematic_figures(reduced).items():
        if name.endswith(("center_distance", "pressure_angle")):
            assert summary[name] == value


def test_a_mesh_of_a_machine_has_the_dynamic_transmission_error_of_pairs() -> None:
    """Without damping the force of a constant stiffness is proportional to it."""
    case = td.load_case("two-stage-spur")
    constant = {f"meshes.{name}.stiffness": 4e8 for name in case.meshes}
    constant |= {f"meshes.{name}.mesh_damping_ratio": 0.0 for name in case.meshes}
    result = td.run(case.replace({**constant, "meshes.second.transmission_error_amplitude": 2e-6}))
    figures, key = result.summary(), "meshes.first."
    rms = figures[f"{key}rms_dynamic_transmission_error"]
    assert rms == pytest.approx(figures[f"{key}alternating_rms_mesh_force"] / 4e8, rel=1e-9)
    sizes = [figures[f"{key}dynamic_transmission_error_harmonic_{n}"] for n in range(1, 6)]
    force = result.mesh_spectra("first")["meshes.first.mesh_force_spectrum"]
    harmonics = force.sel(order=np.arange(1.0, 6.0), method="nearest").to_numpy()
    assert sizes == pytest.approx(harmonics / 4e8, rel=1e-9)
    assert "meshes.second.rms_dynamic_transmission_error" not in figures
