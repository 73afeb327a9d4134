"""The mesh table: loads, friction, one-sided values, identities, both drivers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.contact import (
    effective_modulus,
    equal_share,
    gear_loss_factor,
    hertz_line,
    path_of_contact,
)
from tribodyn.errors import ComputationError, InputError
from tribodyn.friction import xu_2007
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import build
from tribodyn.stiffness import MODELS, StiffnessModel

# The laws say for themselves where they are used beyond their range.
pytestmark = pytest.mark.filterwarnings(r"ignore:\[friction-range\]")

OIL = Lubricant(0.082, 880.0, 21.9e-9)
CONDITIONS = {
    "material": Material(),
    "lubricant": OIL,
    "friction_law": "xu-2007",
    "composite_roughness": 0.53e-6,
    "pinion_speed": 900.0 * math.pi / 30.0,
    "pinion_torque": 90.0,
}
PHASE = (np.arange(997) + 0.5) / 997


def table(pair, **changes):
    return build(pair, **{**CONDITIONS, **changes})


@pytest.fixture(params=["pinion", "wheel", "high contact ratio"])
def mesh(request, fzg, high_contact_pair):
    if request.param == "high contact ratio":
        return table(high_contact_pair)
    return table(fzg(driver=request.param))


def test_loads_add_up(mesh):
    assert mesh.load_share.sum(axis=1) == pytest.approx(np.ones(mesh.phase.size), rel=1e-14)
    total = mesh.pinion_torque / mesh.gear_pair.pinion.base_radius
    assert mesh.normal_force.sum(axis=1) == pytest.approx(np.full(mesh.phase.size, total))
    assert mesh.total_normal_force == total
    per_width = mesh.normal_force / mesh.common_face_width
    assert mesh.load_per_width == pytest.approx(per_width, rel=1e-14)


def test_pairs_deflect_equally(mesh):
    deflection = (mesh.normal_force / np.where(mesh.in_contact, mesh.stiffness, 1.0)).max(axis=1)
    assert deflection == pytest.approx(mesh.total_normal_force / mesh.mesh_stiffness, rel=1e-11)


def test_columns_are_zero_without_contact(mesh):
    for name in ("stiffness", "load_share", "hertz_pressure", "friction_coefficient",
                 "sliding_speed", "sliding_direction", "equivalent_radius"):  # fmt: skip
        assert np.all(getattr(mesh, name)[~mesh.in_contact] == 0.0)
    assert np.all(mesh.stiffness[mesh.in_contact] > 0.0)


def test_pairs_in_contact_are_those_of_the_path_of_contact(mesh):
    contact = path_of_contact(mesh.gear_pair)
    path, in_contact = contact.pair_paths(PHASE)
    assert np.array_equal(mesh.at("in_contact", PHASE), in_contact)
    assert mesh.at("path", PHASE) == pytest.approx(path, rel=1e-13)
    assert mesh.grid.mean(mesh.in_contact.sum(axis=1)) == pytest.approx(contact.contact_ratio)


def test_both_sides_of_an_event_are_stored(mesh):
    for event in mesh.event_phases[1:]:
        left, right = np.flatnonzero(mesh.phase == event)
        assert right == left + 1
    # A pair leaves at the fraction of the contact ratio, and one enters at phase 0.
    leaving = mesh.transverse_contact_ratio % 1.0
    left, right = np.flatnonzero(np.abs(mesh.phase - leaving) < 1e-12)
    assert mesh.in_contact[left].sum() == mesh.in_contact[right].sum() + 1
    assert mesh.in_contact[0].sum() == mesh.in_contact[-1].sum() + 1
    assert mesh.at("mesh_stiffness", leaving - 1e-10) > 1.2 * mesh.at("mesh_stiffness", leaving)
    assert mesh.at("mesh_stiffness", 1.0 - 1e-10) < mesh.at("mesh_stiffness", 0.0) / 1.2


def test_a_pair_goes_on_smoothly_from_one_cycle_to_the_next(mesh):
    for name in ("path", "sliding_speed", "equivalent_radius"):
        column = getattr(mesh, name)
        carried = mesh.in_contact[-1, :-1] & mesh.in_contact[0, 1:]
        assert np.any(carried)
        assert column[-1, :-1][carried] == pytest.approx(column[0, 1:][carried], rel=1e-12)


def test_the_sliding_direction_turns_at_the_pitch_point(mesh):
    pitch_point = path_of_contact(mesh.gear_pair).C
    expected = np.sign(mesh.path - pitch_point)
    inside = mesh.in_contact & (np.abs(mesh.path - pitch_point) > 1e-9)
    assert np.array_equal(mesh.sliding_direction[inside], expected[inside])
    # Never zero in contact: the pitch point itself is an event with two sides.
    assert np.all(np.abs(mesh.sliding_direction[mesh.in_contact]) == 1.0)
    assert np.sum(np.abs(mesh.path[mesh.in_contact] - pitch_point) < 1e-12) == 2


def test_pressure_and_friction_come_from_the_own_load(mesh):
    load = mesh.load_share * mesh.total_normal_force / mesh.common_face_width
    motion = path_of_contact(mesh.gear_pair).kinematics(
        mesh.path[mesh.in_contact], mesh.pinion_speed
    )
    modulus = effective_modulus(Material(), Material())
    pressure = hertz_line(load[mesh.in_contact], motion.equivalent_radius, modulus).maximum_pressure
    assert mesh.hertz_pressure[mesh.in_contact] == pytest.approx(pressure, rel=1e-13)
    friction = xu_2007(
        motion.slide_to_roll_ratio, pressure, 0.082, 0.53e-6, motion.entrainment_speed,
        motion.equivalent_radius,
    )  # fmt: skip
    assert mesh.friction_coefficient[mesh.in_contact] == pytest.approx(friction, rel=1e-12)


def test_mean_friction_is_the_mean_of_share_times_friction(fzg):
    mesh = table(fzg())
    segments = np.searchsorted(mesh.event_phases, PHASE, side="right")
    assert set(segments) == {1, 2, 3}
    weighted = (mesh.at("load_share", PHASE) * mesh.at("friction_coefficient", PHASE)).sum(axis=1)
    assert mesh.mean_friction_coefficient == pytest.approx(weighted.mean(), rel=2e-3)
    constant = table(fzg(), friction_law="constant", friction_options={"coefficient": 0.07})
    assert constant.mean_friction_coefficient == pytest.approx(0.07, rel=1e-13)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_constant_friction_loses_the_gear_loss_factor_of_the_power(driver, fzg):
    pair = fzg(driver=driver)
    law = {"friction_law": "constant", "friction_options": {"coefficient": 0.06}}
    mesh = table(pair, **law)
    contact = path_of_contact(pair)

    def share(path):
        travel = contact.direction * (path - contact.A) / pair.base_pitch
        columns = mesh.at("load_share", travel)
        return columns[np.arange(path.size), np.floor(travel).astype(int)]

    power = mesh.pinion_torque * mesh.pinion_speed
    assert mesh.mean_friction_power == pytest.approx(
        gear_loss_factor(pair, share) * 0.06 * power, rel=1e-7
    )
    equal = table(
        pair, stiffness_model="rectangular", stiffness_options={"pair_stiffness": 2e8}, **law
    )
    factor = gear_loss_factor(pair, lambda path: equal_share(contact, path))
    assert equal.mean_friction_power == pytest.approx(factor * 0.06 * power, rel=1e-12)


def test_friction_moments_do_the_friction_power(mesh):
    # Virtual work: the moments of both gears at their speeds are the sliding power, always lost.
    wheel_speed = mesh.pinion_speed / mesh.gear_pair.ratio
    power = mesh.total_normal_force * (
        mesh.friction_moment_pinion * mesh.pinion_speed - mesh.friction_moment_wheel * wheel_speed
    )
    assert np.all(power >= 0.0)
    assert mesh.grid.mean(power) == pytest.approx(mesh.mean_friction_power, rel=1e-12)


def test_friction_sums_by_hand(fzg):
    mesh = table(fzg(), friction_law="constant", friction_options={"coefficient": 0.1})
    # One pair after C carries all: recess, the pinion's flank is faster.
    assert mesh.at("friction_sum", 0.6) == pytest.approx(0.1, rel=1e-12)
    radius = mesh.at("pinion_curvature_radius", 0.6)[0]
    length = mesh.gear_pair.line_of_action_length
    assert mesh.at("friction_moment_pinion", 0.6) == pytest.approx(0.1 * radius, rel=1e-12)
    assert mesh.at("friction_moment_wheel", 0.6) == pytest.approx(0.1 * (length - radius))


def test_the_functions_for_the_dynamics_are_the_columns(mesh):
    functions = mesh.functions()
    assert functions.event_phases == mesh.event_phases
    assert np.array_equal(functions.stiffness(PHASE), mesh.at("mesh_stiffness", PHASE))
    for name in ("friction_sum", "friction_moment_pinion", "friction_moment_wheel"):
        assert np.array_equal(getattr(functions, name)(PHASE), mesh.at(name, PHASE))


def test_interpolation_agrees_with_direct_evaluation_to_fourth_order(fzg):
    pair = fzg()
    path, in_contact = path_of_contact(pair).pair_paths(PHASE)
    force = 90.0 / pair.pinion.base_radius
    direct = MODELS["potential-energy"](
        pair, Material(), path, in_contact, PHASE, force
    )  # fmt: skip
    errors = [
        np.abs(table(pair, steps=steps).at("stiffness", PHASE) - direct).max() / direct.max()
        for steps in (64, 128, 256, 512)
    ]
    assert errors[-1] < 3e-8
    assert np.log2(errors[0] / errors[-1]) / 3.0 > 3.5


def test_films_and_film_ratio(fzg):
    mesh = table(fzg(), film_model="dowson-higginson")
    touching = mesh.in_contact
    assert np.all(mesh.minimum_film[touching] < mesh.central_film[touching])
    assert mesh.film_ratio[touching] == pytest.approx(mesh.minimum_film[touching] / 0.53e-6)
    assert np.all(mesh.central_film[~touching] == 0.0)
    only_central = table(fzg(), film_model="moes")
    assert only_central.minimum_film is None
    assert only_central.film_ratio[touching] == pytest.approx(
        only_central.central_film[touching] / 0.53e-6
    )
    assert table(fzg()).central_film is None


def test_ideal_flanks_have_no_film_ratio(fzg):
    mesh = table(fzg(), friction_law="none", composite_roughness=0.0, film_model="dowson-higginson")
    assert mesh.film_ratio is None
    assert np.all(mesh.friction_coefficient == 0.0)
    assert mesh.mean_friction_power == 0.0


def test_benedict_kelly_is_finite_at_the_pitch_point(mesh):
    again = table(mesh.gear_pair, friction_law="benedict-kelly")
    assert np.all(np.isfinite(again.friction_coefficient))
    assert np.all(again.friction_coefficient[again.in_contact] > 0.0)


def test_mesh_frequency_and_repr(fzg):
    mesh = table(fzg())
    assert mesh.mesh_frequency == pytest.approx(240.0, rel=1e-12)
    text = repr(mesh)
    assert "\n" not in text
    for part in ("contact ratio 1.327", "240 Hz", "mean stiffness", "mean friction coefficient"):
        assert part in text


def test_mean_stiffness_does_not_depend_on_the_grid(fzg):
    coarse, fine = (table(fzg(), steps=steps).mean_mesh_stiffness for steps in (64, 1024))
    assert coarse == pytest.approx(fine, rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"pinion_speed": 0.0}, "pinion_speed"),
        ({"pinion_torque": -90.0}, "pinion_torque"),
        ({"composite_roughness": -1e-7}, "composite_roughness"),
        ({"composite_roughness": 0.53}, "composite_roughness"),
        ({"steps": 4}, "at least 16"),
        ({"stiffness_model": "potential-enrgy"}, 'mean "potential-energy"'),
        ({"friction_law": "xu-2008"}, 'mean "xu-2007"'),
        ({"film_model": "mose"}, 'mean "moes"'),
    ],
)
def test_bad_input_is_named(changes, message, fzg):
    with pytest.raises(InputError, match=message):
        table(fzg(), **changes)


def test_an_unknown_column_is_named(fzg):
    with pytest.raises(InputError, match='no column "stifness"'):
        table(fzg()).at("stifness", 0.1)


def test_a_model_that_gives_no_stiffness_is_refused(fzg, monkeypatch):
    nothing = StiffnessModel("nothing", lambda p, m, path, *arguments: np.zeros(path.shape), {})
    monkeypatch.setitem(MODELS._items, "nothing", nothing)
    with pytest.raises(ComputationError, match='"nothing" returned an unusable'):
        table(fzg(), stiffness_model="nothing")


#: Position -> phase, pair, share; v_s, v_e, SR, R, p_H; mu of Xu, mu of Benedict and Kelly.
FIGURES = {
    "A": (
        (0.0, 0, 0.5),
        (-0.471463, 1.269503, -0.371376, 7.523826e-3, 0.569806e9),
        (0.079431, 0.107659),
    ),
    "after B": (
        ("leave", 0, 1.0),
        (0.210801, 1.337729, 0.157581, 8.598883e-3, 0.753772e9),
        (0.063169, 0.122133),
    ),
    "B-D": (
        ("half", 0, 1.0),
        (0.913038, 1.407953, 0.648486, 8.577181e-3, 0.754725e9),
        (0.067992, 0.105843),
    ),
    "E": (
        ("leave", 1, 0.5),
        (2.297540, 1.546403, 1.485731, 5.181786e-3, 0.686604e9),
        (0.060681, 0.087109),
    ),
}


@pytest.mark.parametrize("place", FIGURES)
def test_figures_of_fzg_type_a(place, fzg):
    (where, pair, share), figures, (xu, benedict_kelly) = FIGURES[place]
    shared = {
        "material": Material(210e9),
        "stiffness_model": "rectangular",
        "stiffness_options": {"pair_stiffness": 2e8},
    }
    mesh = table(fzg(), **shared)
    leaving = mesh.transverse_contact_ratio - 1.0
    phase = {"leave": leaving, "half": 0.5 * (1.0 + leaving)}.get(where, where)
    if place == "E":
        phase -= 1e-9
    names = ("sliding_speed", "entrainment_speed", "slide_to_roll_ratio", "equivalent_radius")
    computed = [float(mesh.at(name, phase)[pair]) for name in (*names, "hertz_pressure")]
    assert mesh.at("load_share", phase)[pair] == pytest.approx(share)
    assert computed == pytest.approx(figures, rel=2e-6)
    other = table(fzg(), **shared, friction_law="benedict-kelly")
    assert mesh.at("friction_coefficient", phase)[pair] == pytest.approx(xu, abs=1e-6)
    assert other.at("friction_coefficient", phase)[pair] == pytest.approx(benedict_kelly, abs=1e-6)
