"""Films of a case over torques and speeds, and warnings about the film."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.study import read_case
from tribodyn.study.pipeline.cautions import case_cautions, mesh_cautions

RPM = math.pi / 30.0


@pytest.fixture(scope="module")
def case() -> Any:
    return read_case(SOUND, "pair.toml").replace({"film.model": "moes"})


def test_every_torque_meets_every_speed(case: Any) -> None:
    films = td.film_over_operation(
        case, torque=["50 N*m", 100.0, "150 Nm"], speed=["900 rpm", 1800.0 * RPM]
    )
    assert films.pinion_torque == pytest.approx([50.0, 100.0, 150.0])
    assert films.pinion_speed == pytest.approx([900.0 * RPM, 1800.0 * RPM])
    assert films.central_film.shape == (3, 2, films.path.size)
    assert np.all(np.diff(films.central_film, axis=0) < 0.0)
    assert np.all(np.diff(films.central_film, axis=1) > 0.0)
    assert films.minimum_film is None


def test_they_are_those_of_the_mesh(case: Any) -> None:
    films = td.film_over_operation(case)
    with pytest.warns(td.ModelWarning):
        mesh = td.run(case.replace({"solver.steps_per_mesh_cycle": 256})).mesh
    # the first position is the entry, the last the exit of a pair
    assert films.central_film[0, 0, 0] == pytest.approx(mesh.central_film[0, 0], rel=1e-8)
    assert films.film_ratio[0, 0, 0] == pytest.approx(mesh.film_ratio[0, 0], rel=1e-8)
    leaving = np.flatnonzero(mesh.in_contact[:, 1])[-1]
    assert films.central_film[0, 0, -1] == pytest.approx(mesh.central_film[leaving, 1], rel=1e-8)
    assert films.load_per_width[0].max() == pytest.approx(mesh.load_per_width.max(), rel=1e-8)
    assert films.film_stiffness[0, 0, 0] == pytest.approx(mesh.film_stiffness[0, 0], rel=1e-7)


def test_torque_and_speed_belong_to_the_gear_that_the_case_names(case: Any) -> None:
    of_wheel = case.replace(
        {"operation.speed_of": "wheel", "operation.speed": "600 rpm", "operation.torque": 135.0}
    )
    of_pinion_, two = td.film_over_operation(case), td.film_over_operation(of_wheel)
    assert two.pinion_speed == pytest.approx(of_pinion_.pinion_speed)
    assert two.central_film == pytest.approx(of_pinion_.central_film, rel=1e-12)


def test_a_labelled_data_set_has_units(case: Any) -> None:
    data = td.film_over_operation(case, torque=[50.0, 100.0]).to_xarray()
    assert data["central_film"].dims == ("torque", "speed", "position")
    assert data["hertz_pressure"].dims == ("torque", "position")
    assert data["film_stiffness"].attrs["units"] == "N/m"
    assert "2 torques, 1 speeds, 30 positions" in repr(
        td.film_over_operation(case, torque=[50.0, 100.0])
    )


@pytest.mark.parametrize(
    ("value", "says"),
    [
        ({"torque": [-1.0]}, ("argument torque", "torque = -1.0")),
        ({"torque": ["5 kg"]}, ("argument torque", "5 kg")),
        ({"torque": []}, ("pinion_torque", "list of values")),
        ({"speed": "0 rpm"}, ("argument speed", "0 rpm")),
        ({"speed": [[90.0, 95.0]]}, ("argument speed", "number")),
    ],
)
def test_faults_name_the_argument(case: Any, value: Any, says: tuple[str, ...]) -> None:
    with pytest.raises(td.InputError) as refused:
        td.film_over_operation(case, **value)
    for part in says:
        assert part in str(refused.value)


def test_a_case_without_film_is_refused(case: Any) -> None:
    with pytest.raises(td.InputError, match=r'film\.model = "none".*"newton"'):
        td.film_over_operation(case.replace({"film.model": "none"}))


def test_a_film_below_the_roughness_is_reported() -> None:
    steel = np.full((2, 1), 1e9)
    touching = np.ones((2, 1), dtype=bool)
    mesh: Any = SimpleNamespace(
        hertz_pressure=steel,
        film_ratio=None,
        in_contact=touching,
        gears=None,
        film_load_share=None,
        asperity_friction_coefficient=None,
        contact_ratio_under_load=1.0,
        transverse_contact_ratio=1.0,
        load_per_width=np.full((2, 1), 1e5),
        film_stiffness=None,
        friction_law="constant",
    )
    assert mesh_cautions(mesh) == ()
    mesh.film_ratio = np.array([[1.2], [1.01]])
    assert mesh_cautions(mesh) == ()
    mesh.film_ratio = np.array([[1.2], [0.43]])
    (caution,) = mesh_cautions(mesh)
    assert caution.code == "mixed-lubrication"
    assert "falls to 0.43" in caution.message
    # 1.21 0.43^0.64/(1 + 0.37 0.43^1.26) is 0.625.
    assert "up to 37% of the load" in caution.message
    assert 'friction.law = "mixed"' in caution.message
    mesh.film_load_share, mesh.asperity_friction_coefficient = np.array([[1.0], [0.8]]), touching
    (caution,) = mesh_cautions(mesh)
    assert "up to 20% of the load" in caution.message
    assert "friction" not in caution.message


def test_zeros_without_contact_are_no_thin_film() -> None:
    mesh: Any = SimpleNamespace(
        hertz_pressure=np.ones((1, 2)),
        film_ratio=np.array([[1.5, 0.0]]),
        in_contact=np.array([[True, False]]),
        gears=None,
        contact_ratio_under_load=1.0,
        transverse_contact_ratio=1.0,
    )
    assert mesh_cautions(mesh) == ()


def test_a_starved_inlet_is_reported(case: Any) -> None:
    starved = {"film.model": "newton", "film.inlet": "zero", "film.domain": [-2.5, 1.5]}
    codes = {warning.code: warning.message for warning in case_cautions(case.replace(starved))}
    assert "2.5 Hertzian half widths" in codes["starved-inlet"]
    assert "starved-inlet" not in {warning.code for warning in case_cautions(case)}
