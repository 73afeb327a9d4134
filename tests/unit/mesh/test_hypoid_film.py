"""Oil films in the cells of a hypoid pair: solved, in series with the teeth, in the mesh table."""

import math

import numpy as np
import pytest

from known_hypoids import eased
from tribodyn.contact import effective_modulus, hertz_ellipse, hertz_line
from tribodyn.ehl import FILM_MODELS, solve_point_contact
from tribodyn.gear.hypoid.kinematics import cell_motion
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import hypoid_friction, hypoid_loaded_contact
from tribodyn.mesh.hypoid.film import cell_films
from tribodyn.mesh.sharing import ToothContact

OIL = Lubricant(0.01, 769.0, 2e-8)
SPEED = 3000.0 * math.pi / 30.0
pytestmark = pytest.mark.filterwarnings("ignore:\\[(friction|film)-range\\]")


@pytest.fixture(scope="module")
def loaded():
    return hypoid_loaded_contact(eased(), 500.0, steps=16, cells=16)


def films_of(loaded, model, oil=OIL, **options):
    cells = loaded.cells
    motion = cell_motion(cells.flanks.conjugate, cells.touch, cells.curvature, SPEED, "contact")
    settings = ToothContact(loaded.material, oil, film_model=model, film_options=options)
    return cell_films(loaded, motion, settings), motion


def test_the_film_of_a_cell_is_that_of_its_line_contact(loaded):
    solved, motion = films_of(loaded, "newton", nodes=257, stiffness="none")
    assert solved.loaded is loaded
    chosen = np.linspace(0, solved.contact.size - 1, 12).astype(int)
    inputs = (
        solved.contact.load_per_width[chosen],
        motion.equivalent_radius[solved.carries][chosen],
        motion.entrainment_speed[solved.carries][chosen],
    )
    modulus = effective_modulus(loaded.material, loaded.material)
    direct = FILM_MODELS["newton"].films(*inputs, OIL, modulus, nodes=257)
    assert solved.films.central_film[chosen] == pytest.approx(direct.central_film, rel=1e-3)
    assert solved.films.minimum_film[chosen] == pytest.approx(direct.minimum_film, rel=1e-3)


def test_a_slender_ellipse_has_the_film_of_a_slice_through_its_middle(loaded):
    modulus, radius, speed = effective_modulus(loaded.material, loaded.material), 0.0368, 6.93
    ellipse = solve_point_contact(480.0, radius, 30.0 * radius, speed, OIL, modulus, nodes=129)
    pressure = hertz_ellipse(480.0, radius, 30.0 * radius, modulus).maximum_pressure
    load = 1e5 * (pressure / hertz_line(1e5, radius, modulus).maximum_pressure) ** 2
    middle = FILM_MODELS["newton"].films(load, radius, speed, OIL, modulus)
    assert ellipse.central_film == pytest.approx(float(middle.central_film), rel=0.01)
    assert ellipse.minimum_film == pytest.approx(float(middle.minimum_film), rel=0.01)


def assert_springs_meet(loaded, solved, compression, within):
    """The approach of every closed cell is that of its teeth and what its film adds."""
    cells, force = solved.loaded.cells, solved.loaded.line_force
    lag = solved.loaded.loaded_rotation[cells.row, None]
    ends = cells.edge_lever * lag - cells.edge_gap
    # Mean of both ends, as the gap is straight within a cell.
    approach = 0.5 * (ends[:, 1:] + ends[:, :-1])
    width = force / cells.length
    closed = (ends[:, 1:] > 0.0) & (ends[:, :-1] > 0.0) & (width > 0.05 * width.max())
    assert closed.sum() > 100
    teeth = force / (loaded.line_stiffness * cells.length)
    added = np.full(force.shape, np.nan)
    added[solved.carries] = compression(solved.films, force[solved.carries])
    assert (approach - teeth)[closed] == pytest.approx(added[closed], rel=within)
    assert cells.summed((force * cells.touch.lever).sum(axis=1)) == pytest.approx(
        loaded.wheel_torque, rel=1e-9
    )


def test_films_are_in_series_with_the_teeth(loaded):
    tangent, _ = films_of(loaded, "moes", stiffness="tangent")
    assert_springs_meet(loaded, tangent, lambda films, force: force / films.film_stiffness, 1e-3)
    # A film that keeps its distance holds the flanks apart by it.
    distance, _ = films_of(loaded, "newton", nodes=257)
    assert_springs_meet(loaded, distance, lambda films, force: -films.film_distance, 5e-3)
    thin = Lubricant(1e-4, 769.0, 2e-8)
    dry, _ = films_of(loaded, "moes", thin, stiffness="tangent")
    change = [each.loaded.loaded_rotation / loaded.loaded_rotation - 1.0 for each in (dry, tangent)]
    assert np.all(change[0] > 0.0)
    assert np.all(change[0] < 0.07 * change[1])


def test_the_mesh_table_has_films_and_their_springs(loaded):
    def table(**more):
        return hypoid_friction(
            loaded, SPEED, lubricant=OIL, composite_roughness=0.4e-6, film_model="newton", **more
        ).table()

    rigid = table(film_options={"nodes": 257, "stiffness": "none"})
    series = table(film_options={"nodes": 257})
    assert rigid.film_mesh_stiffness is None
    assert rigid.film_offset == 0.0
    assert series.film_offset == pytest.approx(0.8e-6, rel=0.15)
    teeth = series.tooth_mesh_stiffness
    assert teeth == pytest.approx(rigid.mesh_stiffness, rel=1e-12)
    # Films are two orders stiffer than teeth, and hold the flanks apart by their thickness.
    assert np.all(series.film_mesh_stiffness > 100.0 * teeth)
    lead = series.tooth_transmission_error - series.transmission_error_at_rest
    carries = series.load_share > 0.05
    assert np.all(lead > series.central_film[carries].min())
    assert np.all(lead < 3.0 * series.central_film[carries].max())
    # At the load the force law of the table is the balance of torques.
    law = series.force_law
    force = series.pinion_torque / np.abs(series.direction[:, 4])
    assert law.force(series.phase, series.static_transmission_error) == pytest.approx(
        force, rel=2e-3
    )


def test_friction_of_the_sheared_film_is_that_of_the_law_in_each_cell(loaded):
    film = {"film_model": "newton", "film_options": {"nodes": 257, "stiffness": "none"}}
    options = {"shear_model": "ree-eyring", "eyring_stress": 5e6}

    def coefficients(contact, law, **more):
        return hypoid_friction(
            contact, SPEED, lubricant=OIL, composite_roughness=0.4e-6, friction_law=law,
            friction_options=more, **film,
        )  # fmt: skip

    sheared = coefficients(loaded, "ehl", **options)
    # Between the solved cells it is interpolated: a finer choice of cells hardly differs.
    assert 0.01 < sheared.mean_friction_coefficient < 0.06
    finer = hypoid_loaded_contact(eased(), 500.0, steps=16, cells=9)
    assert coefficients(finer, "ehl", **options).mean_friction_coefficient == pytest.approx(
        sheared.mean_friction_coefficient, rel=5e-3
    )
    mixed = coefficients(loaded, "mixed-solved", **options)
    asperities = mixed.asperity_friction_coefficient
    assert np.all(asperities >= 0.0)
    assert asperities.max() > 0.01
    table = mixed.table()
    assert table.asperity_friction_coefficient.max() == pytest.approx(asperities.max(), rel=0.9)
    assert table.mean_friction_coefficient == pytest.approx(
        mixed.mean_friction_coefficient, rel=0.02
    )
