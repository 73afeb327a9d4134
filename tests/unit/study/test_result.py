"""The result of a run: figures, warnings, files."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.errors import ComputationError, OutputExistsError
from tribodyn.study import SUMMARY, read_case
from tribodyn.study.pipeline.run import rehearse
from tribodyn.study.pipeline.save import RESULT_FILES

_NAMED = """
mesh_frequency mean_mesh_force rms_mesh_force peak_mesh_force mean_dynamic_transmission_error
peak_to_peak_dynamic_transmission_error dynamic_transmission_error_harmonic_1
dynamic_transmission_error_harmonic_5 rms_bearing_force_loa_pinion rms_bearing_force_oloa_pinion
rms_acceleration_loa_pinion rms_acceleration_oloa_pinion mean_friction_coefficient
contact_loss_share steady_state_error
"""


@pytest.fixture(scope="module")
def case() -> Any:
    # Stiff, well damped and with play, so that no warning but that of the geometry arises.
    return read_case(SOUND, "pair.toml").replace(
        {"dynamics.backlash": "0.05 mm", "solver.steps_per_mesh_cycle": 256}
    )


def _run(case: Any) -> Any:
    with pytest.warns(td.ModelWarning):
        return td.run(case)


@pytest.fixture(scope="module")
def result(case: Any) -> Any:
    return _run(case)


def test_summary_holds_all_names_as_floats(result: Any) -> None:
    figures = result.summary()
    assert set(_NAMED.split()) <= set(figures) <= set(SUMMARY)
    assert all(type(value) is float and np.isfinite(value) for value in figures.values())
    json.dumps(figures, allow_nan=False)


def test_summary_is_a_copy(result: Any) -> None:
    result.summary().clear()
    assert result.summary()


def test_forces_balance_the_torque_without_friction(case: Any) -> None:
    changes = {"friction.coefficient": 0.0, "solver.steps_per_mesh_cycle": 4096}
    figures = _run(case.replace(changes)).summary()
    assert figures["mean_mesh_force"] == pytest.approx(figures["static_mesh_force"], rel=1e-8)
    assert figures["mean_friction_power"] == 0.0


def test_transmission_error_counts_from_first_contact(case: Any) -> None:
    # Bodies of their own, since a larger backlash thins the teeth and makes them lighter.
    fixed = {
        f"gears.{gear}.{name}": value
        for gear, mass, inertia in (("pinion", 0.6, 5e-4), ("wheel", 1.1, 1.5e-3))
        for name, value in (("mass", mass), ("moment_of_inertia", inertia))
    }
    swings = [
        _run(case.replace({"dynamics.backlash": play} | fixed)).summary()
        for play in (0.05e-3, 0.2e-3)
    ]
    name = "mean_dynamic_transmission_error"
    assert swings[0][name] == pytest.approx(swings[1][name], rel=1e-6)


def test_static_error_is_part_of_the_transmission_error(case: Any) -> None:
    changes = {
        "dynamics.transmission_error_amplitude": "1 um",
        "dynamics.transmission_error_phase": "90 deg",
        "operation.speed": "10 rpm",
        "stiffness.pair_stiffness": None,
        "stiffness.model": "fourier",
        "stiffness.mean_stiffness": "3e8 N/m",
        "friction.coefficient": 0.0,
        "dynamics.bearing_stiffness": "1e12 N/m",
        "dynamics.model": "torsional",
    }
    changes["dynamics.bearing_stiffness"] = None
    figures = _run(case.replace({**changes, "solver.steps_per_mesh_cycle": 8192})).summary()
    # So slow that the compression is constant: the rotation follows the error alone.
    name = "dynamic_transmission_error_harmonic_1"
    assert figures[name] == pytest.approx(1e-6, rel=1e-3)
    assert figures["rms_mesh_force"] == pytest.approx(figures["static_mesh_force"], rel=1e-3)


def test_torsional_model_has_no_bearing_figures(case: Any) -> None:
    changes = {"dynamics.model": "torsional", "dynamics.bearing_stiffness": None}
    figures = _run(case.replace(changes)).summary()
    assert not [name for name in figures if "bearing" in name or "acceleration" in name]
    assert figures["mean_mesh_force"] > 0.0


def test_transient_settles_to_the_steady_state(case: Any, result: Any) -> None:
    transient = _run(case.replace({"solver.method": "transient", "solver.cycles": 60}))
    assert transient.response.time.size == 60 * 256
    figures, steady = transient.summary(), result.summary()
    assert "steady_state_error" not in figures
    for name in ("mean_mesh_force", "rms_mesh_force", "rms_acceleration_loa_pinion"):
        assert figures[name] == pytest.approx(steady[name], rel=1e-6)


def test_speed_and_torque_of_the_wheel_are_the_same_operation(case: Any, result: Any) -> None:
    turned = case.replace(
        {"operation.speed_of": "wheel", "operation.speed": "600 rpm", "operation.torque": 135.0}
    )
    figures = _run(turned).summary()
    for name, value in result.summary().items():
        if name != "steady_state_error":
            assert figures[name] == pytest.approx(value, rel=1e-9)


def test_each_warning_is_recorded_and_issued_once(case: Any) -> None:
    rough = td.load_case("fzg-roughness").replace({"gears.composite_roughness": "0.991 um"})
    with pytest.warns(td.ModelWarning) as issued:
        result = td.run(rough)
    codes = [warning.code for warning in result.warnings]
    assert "friction-roughness" in codes
    assert len(set(map(str, result.warnings))) == len(codes) == len(issued)


def test_a_pulling_linear_mesh_is_reported(case: Any) -> None:
    light = {"dynamics.backlash": 0.0, "operation.torque": "1 N*m", "operation.speed": "6000 rpm",
             "dynamics.transmission_error_amplitude": "5 um"}  # fmt: skip
    result = _run(case.replace(light))
    assert "mesh-tension" in [warning.code for warning in result.warnings]


def test_no_steady_state_is_a_failure_with_a_remedy(
    case: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    import tribodyn.dynamics

    def lost(*_: Any, **__: Any) -> Any:
        from types import SimpleNamespace

        return SimpleNamespace(
            converged=False, stable=False, error=1.0, floquet_multipliers=np.array([1.2])
        )

    monkeypatch.setattr(tribodyn.dynamics, "steady_state", lost)
    with pytest.raises(ComputationError, match=r'solver\.method = "transient"'):
        td.run(case)


def test_saved_result_is_complete(result: Any, tmp_path: Path) -> None:
    import xarray

    place = result.save(tmp_path / "out")
    assert {file.name for file in place.iterdir()} == set(RESULT_FILES)
    assert json.loads((place / "summary.json").read_text()) == result.summary()
    assert td.load_case(place / "case.toml") == result.case
    assert td.mesh.MeshTable.load(place / "mesh.nc").mesh_frequency == result.mesh.mesh_frequency
    with xarray.open_dataset(place / "response.nc", engine="h5netcdf") as motion:
        assert np.array_equal(motion["contact_force"], result.response.contact_force)
        assert motion["deflection"].attrs["units"] == "m"
    with pytest.raises(OutputExistsError):
        result.save(tmp_path / "out")
    assert result.save(tmp_path / "out", force=True) == place


def test_figures_are_methods(result: Any) -> None:
    assert "plot_mesh_force" in dir(result)
    assert result.plot_mesh_force().data
    with pytest.raises(AttributeError, match="plot_mesh_force"):
        result.plot_mesh_farce()
    with pytest.raises(AttributeError, match="has no sumary"):
        _ = result.sumary


def test_only_figures_of_a_run_are_methods(result: Any) -> None:
    offered = [name for name in dir(result) if name.startswith("plot_")]
    assert "plot_film" in offered
    assert {"plot_campbell", "plot_mode_shapes"} <= set(offered)
    assert "plot_forced_response" not in offered
    with pytest.raises(
        AttributeError, match=r"draws a ForcedResponse. Call tribodyn\.dynamics\.forced_response"
    ):
        _ = result.plot_forced_response


def test_a_figure_of_somebody_else_is_a_method_too(result: Any) -> None:
    from tribodyn.drawing import FIGURES, drawing

    @drawing("torque-of-test", heading="Torque", caption="Look.", of="Result")
    def torque(run: Any, scale: float = 1.0) -> float:
        return scale * float(run.case.operation.torque)

    try:
        assert getattr(result, "plot_torque-of-test")(scale=2.0) == torque(result, scale=2.0)
        assert "plot_torque-of-test" in dir(result)
    finally:
        FIGURES._items.pop("torque-of-test")


def test_citations_name_the_models(result: Any) -> None:
    assert "Kahraman" in result.cite()
    assert result.cite("bibtex").count("@") == len(result.cite().splitlines())
    with pytest.raises(td.InputError, match="bibtex"):
        result.cite("ris")


def test_repr_is_one_line(result: Any) -> None:
    assert "\n" not in repr(result)
    assert "peak mesh force" in repr(result)


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        (
            'method = "steady"',
            'method = "steady"\nsteps_per_mesh_cycle = 64',
            "pair.toml:30: solver.steps_per_mesh_cycle: ",
        ),
        (
            'model = "rectangular"\npair_stiffness = "2e8 N/m"',
            'model = "table"\nphase = [0.0, 0.6, 0.5]\nvalues = ["2e8 N/m", "2e8 N/m", "2e8 N/m"]',
            "pair.toml:22: stiffness.phase: ",
        ),
        (
            'law = "constant"\ncoefficient = 0.05',
            'law = "benedict-kelly"',
            "replace: gears.composite_roughness: ",
        ),
    ],
)
def test_errors_of_a_run_name_their_key(old: str, new: str, place: str) -> None:
    case = read_case(SOUND.replace(old, new), "pair.toml")
    if place.startswith("replace"):
        case = case.replace({"gears.composite_roughness": "1.2 um"})
    for study in (rehearse, td.run):
        with pytest.raises(td.InputError) as caught:
            study(case)
        assert str(caught.value).startswith(place)


def test_a_result_refuses_to_be_pickled(result: Any) -> None:
    assert pickle.loads(pickle.dumps(result.case)) == result.case
    with pytest.raises(TypeError, match="save"):
        pickle.dumps(result)


def test_a_case_is_run_by_its_path(tmp_path: Path, case: Any, result: Any) -> None:
    file = tmp_path / "pair.toml"
    file.write_text(case.to_toml(), encoding="utf-8")
    assert _run(file).summary() == result.summary()
    assert _run(str(file)).summary() == result.summary()
