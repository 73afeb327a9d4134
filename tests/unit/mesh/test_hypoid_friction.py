"""Friction in the cells of hypoid pairs: signs, sums, limits, known figures; the mesh table."""

import math

import numpy as np
import pytest

from known_hypoids import eased, h1043, random_blanks
from tribodyn.dynamics import spur6, torsional
from tribodyn.ehl import hamrock_dowson_minimum
from tribodyn.errors import InputError
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import MeshTable, hypoid_friction, hypoid_loaded_contact
from tribodyn.mesh.hypoid.loaded_contact import wheel_torque_at
from tribodyn.mesh.table_file import read_table_file

OIL = Lubricant(0.01, 769.0, 2e-8)
SPEED = 3000.0 * math.pi / 30.0
pytestmark = pytest.mark.filterwarnings("ignore:\\[friction-range\\]")


def rubbed(loaded, rpm=3000.0, roughness=0.4e-6, **more):
    return hypoid_friction(
        loaded, rpm * math.pi / 30.0, lubricant=OIL, composite_roughness=roughness, **more
    )


@pytest.fixture(scope="module")
def loaded():
    return hypoid_loaded_contact(eased(), 500.0, steps=20)


@pytest.mark.parametrize(
    ("roughness", "expected"),
    [
        (0.07e-6, [0.0129, 0.0110, 0.0105]),
        (0.2e-6, [0.0314, 0.0145, 0.0119]),
        (0.4e-6, [0.0596, 0.0303, 0.0208]),
        (0.6e-6, [0.0772, 0.0471, 0.0341]),
    ],
)
def test_published_coefficients_of_ten_against_43(loaded, roughness, expected):
    frictions = [rubbed(loaded, rpm, roughness) for rpm in (1000.0, 3000.0, 5000.0)]
    assert [each.mean_friction_coefficient for each in frictions] == pytest.approx(
        expected, abs=1.1e-4
    )
    # The coefficient falls with the speed, and the film carries more.
    assert np.all(np.diff([each.mean_coefficient for each in frictions], axis=0) < 0.0)
    assert np.all(np.diff([each.film_load_share for each in frictions], axis=0) >= 0.0)


def test_published_film_ratios_and_loads(loaded):
    for rpm, ratio in ((1000.0, 2.9), (3000.0, 6.2), (5000.0, 8.8)):
        friction = rubbed(loaded, rpm, 0.07e-6)
        force = loaded.cell_force
        ratios = np.where(force > 0.0, friction.film_ratio, 0.0)
        assert (ratios * force).sum() / force.sum() == pytest.approx(ratio, rel=0.025)
    for torque, smooth, rough in ((50.0, 0.0086, 0.0217), (2000.0, 0.0103, 0.0332)):
        other = loaded.under(torque)
        for roughness, expected in ((0.07e-6, smooth), (0.4e-6, rough)):
            friction = rubbed(other, 3000.0, roughness).mean_friction_coefficient
            assert friction == pytest.approx(expected, abs=1.1e-4)
    fixed = rubbed(loaded, 3000.0, 0.07e-6, entrainment="fixed_frame").mean_friction_coefficient
    assert fixed == pytest.approx(0.92 * 0.0110, rel=0.01)


def test_film_of_an_ellipse():
    film = hamrock_dowson_minimum(5000.0, 0.03, 0.5, 5.0, 0.01, 2e-8, 2.2637e11)
    assert film == pytest.approx(3.87441e-7, rel=2e-6)
    line = hamrock_dowson_minimum(5000.0, 0.03, math.inf, 5.0, 0.01, 2e-8, 2.2637e11)
    assert line == pytest.approx(film / (1.0 - math.exp(-0.68 * 1.03 * (0.5 / 0.03) ** 0.64)))
    for wrong in ((0.0, 0.03, 0.5), (5e3, -0.03, 0.5), (5e3, 0.03, 0.0), (5e3, 0.03, math.nan)):
        with pytest.raises(InputError):
            hamrock_dowson_minimum(*wrong, 5.0, 0.01, 2e-8, 2.2637e11)


def test_friction_takes_power_in_every_cell_and_moments_take_the_same():
    for blank, side in zip(random_blanks(2), ("drive", "coast"), strict=True):
        contact = hypoid_loaded_contact(eased(blank, side), 300.0, steps=16, cells=12)
        friction = rubbed(contact)
        cells = contact.cells
        sliding = friction.pinion_speed * cells.flanks.conjugate.sense * cells.touch.sliding
        along = (friction.friction_direction[cells.in_contact] * sliding).sum(axis=-1)
        carries = contact.cell_force[cells.in_contact] > 0.0
        assert np.all(along[carries] < 0.0)
        assert np.all((friction.film_load_share >= 0.0) & (friction.film_load_share <= 1.0))
        turning = friction.pinion_friction[:, 4] + friction.wheel_friction[:, 4] / blank.ratio
        power = -contact.mesh_force * turning * friction.pinion_speed
        assert np.all(friction.power > 0.0)
        assert power == pytest.approx(friction.power, rel=1e-9)


def test_the_film_carries_more_where_it_is_thicker(loaded):
    friction = rubbed(loaded)
    order = np.argsort(friction.film_ratio, axis=None)
    assert np.all(np.diff(friction.film_load_share.ravel()[order]) > -1e-12)
    carries = loaded.cell_force > 0.0
    assert 0.0 < friction.film_load_share[carries].min() < 0.7
    assert set(np.unique(friction.lubrication_regime[carries])) <= {0.0, 1.0, 2.0}
    assert np.all(np.isnan(friction.lubrication_regime[~carries]))
    smooth = rubbed(loaded, roughness=0.0)
    assert np.all(smooth.film_load_share == 1.0)
    assert smooth.mean_friction_coefficient < friction.mean_friction_coefficient


def test_a_constant_coefficient_and_none(loaded):
    friction = rubbed(loaded, friction_law="constant", friction_options={"coefficient": 0.1})
    assert friction.mean_coefficient == pytest.approx(0.1, rel=1e-12)
    without = rubbed(loaded, friction_law="none")
    assert np.all(without.power == 0.0)
    table = without.table()
    assert np.all(table.friction == 0.0)
    # Its direction is still that of one coefficient: 0.1 of it rubs as the constant law does.
    touch = table.load_share > 0.0
    assert table.friction_direction[touch] == pytest.approx(
        friction.table().friction_direction[touch]
    )


def test_film_formulas_of_lines(loaded):
    line, other = (rubbed(loaded, film_model=m) for m in ("dowson-higginson", "pan-hamrock"))
    assert 1.0 < line.minimum_film_ratio / other.minimum_film_ratio < 1.3
    assert line.film_model == "dowson-higginson"


def test_the_table_stores_the_computed_friction(loaded, tmp_path):
    friction = rubbed(loaded)
    table = friction.table()
    sums = np.hstack([friction.pinion_friction, friction.wheel_friction])
    assert table.friction == pytest.approx(-sums, abs=1e-15)
    assert table.direction[:, :6] == pytest.approx(loaded.pinion_direction)
    assert table.direction[:, 6:] == pytest.approx(-loaded.wheel_direction)
    assert table.driver == "pinion"
    assert table.base_radius_pinion / table.base_radius_wheel == pytest.approx(10 / 43, rel=1e-9)
    assert table.mean_mesh_stiffness == pytest.approx(loaded.mean_mesh_stiffness, rel=1e-12)
    lost = loaded.grid.mean(friction.power)
    assert table.mean_friction_power == pytest.approx(lost, rel=5e-3)
    # The law gives the load of the table at its deflection, at every phase.
    deflection = table.static_transmission_error
    law = table.force_law
    assert law.force(table.phase[:-1], deflection[:-1]) == pytest.approx(
        loaded.mesh_force[:-1], rel=1e-9
    )
    for share in (0.25, 0.6, 1.7):
        torque = wheel_torque_at(
            loaded,
            loaded.unloaded_rotation + share * (loaded.loaded_rotation - loaded.unloaded_rotation),
        )
        force = law.force(table.phase[:-1], share * deflection[:-1])
        assert force == pytest.approx((torque / loaded.wheel_lever)[:-1], rel=0.015)
    table.save(tmp_path / "table.nc")
    table.to_csv(tmp_path / "table.csv")
    again = MeshTable.load(tmp_path / "table.nc")
    read = read_table_file(tmp_path / "table.csv").table(
        teeth=10, driver="pinion", pinion_speed=SPEED, pinion_torque=500.0
    )
    for name in ("direction", "friction", "ramp_stiffness", "unloaded_transmission_error"):
        assert np.array_equal(getattr(again, name), getattr(table, name))
        assert np.array_equal(getattr(read, name), getattr(table, name))


def test_structures_in_a_plane_take_the_rotations_or_refuse(loaded):
    mesh = rubbed(loaded).table().functions()
    arguments = {
        "moment_of_inertia": (0.01, 0.9),
        "base_radius": (1.0, 1.0),
        "torque": (500.0, 2150.0),
    }
    contact = torsional(mesh, **arguments).contacts[0]
    phase = loaded.phase[:-1]
    levers = np.stack([loaded.pinion_direction[:-1, 4], -loaded.wheel_direction[:-1, 4]], axis=1)
    assert contact.direction(phase) == pytest.approx(levers, rel=1e-12)
    moments = contact.friction(phase)
    assert moments == pytest.approx(mesh.friction(phase)[:, [4, 10]], rel=1e-12)
    # At rest under the load without friction the compression is that of the loaded contact.
    force = 500.0 / levers[:, 0]
    deflection = force / contact.stiffness(phase) + contact.error(phase)
    assert deflection == pytest.approx(loaded.loaded_transmission_error[:-1], rel=1e-9)
    with pytest.raises(InputError, match="in space"):
        spur6(mesh, mass=1.0, bearing_stiffness=1e9, **arguments)


def test_wrong_arguments_are_refused(loaded):
    arguments = {
        "loaded": loaded,
        "pinion_speed": SPEED,
        "lubricant": OIL,
        "composite_roughness": 0.0,
    }
    for change in (
        {"loaded": h1043()}, {"pinion_speed": 0.0}, {"pinion_speed": "3000 rpm"},
        {"lubricant": 0.01}, {"composite_roughness": 0.4}, {"composite_roughness": -1e-7},
        {"friction_law": "glue"}, {"friction_options": {"slope": 1.0}}, {"friction_options": 0.1},
        {"film_model": "newtonian"}, {"film_options": {"nodes": 513}},
        {"film_model": "none"}, {"entrainment": "moving"}, {"friction_law": "ehl"},
        {"friction_law": "niemann"},
    ):  # fmt: skip
        with pytest.raises(InputError):
            hypoid_friction(**(arguments | change))
