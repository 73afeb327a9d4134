"""Meshes whose contacts are slices of the lines of contact: limits, balances, closed forms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tribodyn.contact import effective_modulus, face_contacts, hertz_line, path_of_contact
from tribodyn.dynamics import follow_load, helical12
from tribodyn.ehl import FILM_MODELS
from tribodyn.ehl.traction.traction import FilmState
from tribodyn.errors import InputError, ModelWarning
from tribodyn.friction import LAWS, TribologicalContact
from tribodyn.gear import FlankModification, Material, cylindrical_pair
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import (
    LOADS,
    build,
    comprehensive_stiffness,
    film_over_operation,
    mesh_friction,
    moving_film,
)
from tribodyn.stiffness import (
    MODELS,
    iso6336_single_stiffness,
    load_point,
    loaded_contact,
    weber_banaschek_compression,
)
from tribodyn.stiffness.loaded.contact import contact_problem

OIL = Lubricant(0.05, 880.0, 2e-8)
TORQUE = 600.0


def helical(helix=21.0, hand="right", width=50e-3, **changes):
    arguments = {
        "pinion_teeth": 27,
        "wheel_teeth": 51,
        "normal_module": 4.5e-3,
        "normal_pressure_angle": math.radians(20.0),
        "helix_angle": math.radians(helix),
        "hand": hand,
        "pinion_face_width": width,
        "pinion_bore_diameter": 40e-3,
        "wheel_bore_diameter": 70e-3,
    }
    return cylindrical_pair(**{**arguments, **changes})


def table(pair, **changes):
    arguments = {
        "material": Material(),
        "stiffness_model": "fe2d",
        "lubricant": OIL,
        "friction_law": "benedict-kelly",
        "composite_roughness": 0.4e-6,
        "film_model": "moes",
        "pinion_speed": 150.0,
        "pinion_torque": TORQUE,
    }
    return build(pair, **{**arguments, **changes})


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("hand", ["left", "right"])
def test_slices_have_the_length_of_the_lines_of_contact(driver, hand):
    pair = helical(hand=hand, driver=driver)
    phase = np.linspace(0.0, 0.999, 37)
    contacts = face_contacts(path_of_contact(pair), phase, 31)
    length = contacts.width.sum(axis=1) / math.cos(pair.base_helix_angle)
    assert length == pytest.approx(pair.contact_line_length(phase), rel=1e-12)
    low, high = pair.path_limits
    inside = contacts.path[contacts.in_contact]
    assert inside.min() > low - 1e-12
    assert inside.max() < high + 1e-12


def test_a_right_hand_pinion_enters_at_the_far_end_of_its_axis():
    for hand, end in (("right", 1.0), ("left", -1.0)):
        contacts = face_contacts(path_of_contact(helical(hand=hand)), np.array([0.01]), 10)
        youngest = contacts.width[0, :10]
        assert np.sign(contacts.face_position[:10][youngest > 0.0]).tolist() == [end]


def test_the_middle_of_the_face_is_that_of_a_mirrored_pair():
    """The load falls across the face: neither of the two slices in the middle stands for it."""
    pairs = [
        helical(hand=hand, misalignment=sign * 20e-6) for hand, sign in (("right", 1), ("left", -1))
    ]
    one, other = (table(pair, stiffness_model="iso6336", steps=64) for pair in pairs)
    for name in ("hertz_pressure", "load_per_width", "central_film", "film_stiffness", "path"):
        assert one.at_pitch_point(name) == pytest.approx(other.at_pitch_point(name), rel=1e-9)


@pytest.mark.parametrize("model", ["fe2d", "potential-energy", "iso6336", "weber"])
def test_a_vanishing_helix_angle_gives_the_spur_pair(model):
    options = {"stiffness_options": {"extended_contact": False}} if model == "fe2d" else {}
    spur = table(helical(0.0), stiffness_model=model, steps=256, **options)
    nearly = table(helical(1e-3), stiffness_model=model, steps=256, **options)
    for name in (
        "mean_mesh_stiffness",
        "mean_mesh_stiffness_tangent",
        "mean_friction_coefficient",
        "mean_friction_power",
        "contact_ratio_under_load",
        "maximum_single_pair_stiffness",
    ):
        assert getattr(nearly, name) == pytest.approx(getattr(spur, name), rel=1e-3), name
    for name in ("hertz_pressure", "load_per_width", "central_film", "film_stiffness"):
        expected = spur.at_pitch_point(name)
        assert nearly.at_pitch_point(name) == pytest.approx(expected, rel=1e-3)
    swing = np.ptp(spur.static_transmission_error)
    assert np.ptp(nearly.static_transmission_error) == pytest.approx(swing, rel=5e-3)


def test_the_force_of_all_slices_is_the_torque_over_the_base_radius():
    pair = helical()
    mesh = table(pair)
    force = TORQUE / pair.pinion.base_radius
    assert mesh.normal_force.sum(axis=1) == pytest.approx(force, rel=1e-9)
    carried = mesh.load_per_width * mesh.contact_width
    assert carried.sum(axis=1) == pytest.approx(force, rel=1e-9)


def test_twice_as_many_slices_move_stiffness_and_error_little():
    pair = helical()
    means, swings = [], []
    for slices in (24, 48):
        loaded = loaded_contact(pair, TORQUE, phases=32, slices=slices)
        means.append(loaded.mesh_stiffness_secant.mean())
        swings.append(loaded.peak_to_peak_transmission_error)
    assert means[1] == pytest.approx(means[0], rel=5e-3)
    assert swings[1] == pytest.approx(swings[0], rel=0.02)


def test_helix_slope_loads_independent_slices_as_the_closed_form_says():
    """Full contact: K = 1 + F_beta c b/(2 F); partial contact: sqrt(2 F_beta c b/F)."""
    straight = helical(1e-3)
    for slope in (4e-6, 60e-6):
        lead = FlankModification(lead_slope=slope)
        pair = replace(straight, pinion=replace(straight.pinion, modification=lead))
        mesh = table(pair, stiffness_model="iso6336", film_model="none")
        force = TORQUE / pair.pinion.base_radius
        line = mesh.grid.mean(table(straight, stiffness_model="iso6336").mesh_stiffness) / 50e-3
        ratio = slope * line * 50e-3 / force
        expected = 1.0 + 0.5 * ratio if ratio < 2.0 else math.sqrt(2.0 * ratio)
        # The outermost slice is half of its width away from the end.
        inner = expected - 0.5 * ratio / 24
        if ratio > 2.0:
            inner = expected * (1.0 - 0.25 * expected / 24)
        assert mesh.face_load_factor == pytest.approx(inner, rel=1e-2)
        assert expected > 1.02


def test_the_film_of_a_slice_is_that_of_a_spur_contact():
    mesh = table(helical())
    knot, contact = np.argwhere(mesh.load_share > 0.01)[40]
    pair = mesh.gear_pair
    path = mesh.path[knot, contact]
    wheel = pair.line_of_action_length - path
    radius = path * wheel / pair.line_of_action_length / math.cos(pair.base_helix_angle)
    speed = 0.5 * (150.0 * path + 150.0 / pair.ratio * wheel)
    load = mesh.load_per_width[knot, contact]
    modulus = Material().youngs_modulus / (1.0 - Material().poissons_ratio ** 2)
    films = FILM_MODELS["moes"].films(load, radius, speed, OIL, modulus)
    assert mesh.central_film[knot, contact] == pytest.approx(float(films.central_film), rel=1e-9)
    pressure = hertz_line(load, radius, modulus).maximum_pressure
    assert mesh.hertz_pressure[knot, contact] == pytest.approx(float(pressure), rel=1e-9)


def test_friction_takes_the_power_that_its_moments_take():
    mesh = table(helical())
    force, speed = mesh.total_normal_force, mesh.pinion_speed
    moments = mesh.friction_moment_pinion * speed - mesh.friction_moment_wheel * (
        speed / mesh.gear_pair.ratio
    )
    assert mesh.grid.mean(moments) * force == pytest.approx(mesh.mean_friction_power, rel=1e-3)
    straight = table(
        helical(0.0, width=50e-3),
        film_model="none",
        friction_law="constant",
        friction_options={"coefficient": 0.05},
    )
    leaning = table(
        helical(),
        film_model="none",
        friction_law="constant",
        friction_options={"coefficient": 0.05},
    )
    # The force along the normal is larger than its transverse part.
    ratio = 1.0 / math.cos(leaning.gear_pair.base_helix_angle)
    assert leaning.line_force_ratio == pytest.approx(ratio)
    assert straight.line_force_ratio == 1.0


def test_solved_films_of_slices_agree_with_their_formula():
    pair = helical()
    solved, formula = table(pair, film_model="newton"), table(pair, film_model="moes")
    loaded = solved.load_share > 1e-3
    part = solved.central_film[loaded] / formula.central_film[loaded]
    assert 0.85 < np.nanmin(part) < np.nanmax(part) < 1.15


def test_the_last_slices_of_a_line_have_the_film_of_its_load():
    """However small the helix angle: those that leave last carry more than the spur pair there."""
    options = {"stiffness_model": "iso6336", "film_model": "newton", "friction_law": "none"}
    options["film_options"] = {"stiffness": "none", "nodes": 129}

    def least_at_the_end(helix):
        mesh = table(helical(helix), steps=128, **options)
        sliding, film = mesh.sliding_speed[mesh.in_contact], mesh.minimum_film[mesh.in_contact]
        place = np.nanargmin(np.where(sliding > 0.999 * sliding.max(), film, np.inf))
        names = "minimum_film", "load_per_width", "equivalent_radius", "entrainment_speed"
        return [getattr(mesh, name)[mesh.in_contact][place] for name in names]

    film, load, *motion = least_at_the_end(0.0)
    least, heavy, *slice_motion = least_at_the_end(1e-3)
    assert slice_motion == pytest.approx(motion, rel=1e-3)
    assert heavy > 1.3 * load
    modulus = effective_modulus(Material(), Material())
    films = FILM_MODELS["newton"].films([load, heavy], *motion, OIL, modulus, nodes=129)
    assert [film, least] == pytest.approx(films.minimum_film, rel=1e-3)


def test_a_film_in_series_softens_the_mesh_of_slices():
    pair = helical()
    dry = table(pair)
    wet = table(pair, film_options={"stiffness": "tangent"})
    film, teeth = wet.film_mesh_stiffness, wet.tooth_mesh_stiffness
    assert wet.mean_mesh_stiffness < dry.mean_mesh_stiffness
    assert 1.0 / wet.mesh_stiffness == pytest.approx(1.0 / film + 1.0 / teeth, rel=2e-2)


def test_friction_of_a_slice_that_shears_its_film_is_that_of_a_spur_contact():
    mesh = table(helical(), stiffness_model="iso6336", film_model="newton", friction_law="ehl")
    chosen = tuple(np.argwhere(mesh.load_share > 1e-3)[[40, 500, 1200, 2000, 2700]].T)
    load, radius, entrainment, sliding = (
        getattr(mesh, name)[chosen]
        for name in ("load_per_width", "equivalent_radius", "entrainment_speed", "sliding_speed")
    )
    modulus = Material().youngs_modulus / (1.0 - Material().poissons_ratio ** 2)
    films = FILM_MODELS["newton"].films(load, radius, entrainment, OIL, modulus)
    contact = TribologicalContact(
        load,
        hertz_line(load, radius, modulus).maximum_pressure,
        sliding,
        entrainment,
        sliding / entrainment,
        radius,
        OIL.dynamic_viscosity,
        0.0,
        FilmState.from_solutions(films.solutions),
    )
    expected = LAWS["ehl"](contact)
    assert mesh.friction_coefficient[chosen] == pytest.approx(expected, rel=1e-2, abs=5e-5)
    assert mesh.central_film[chosen] == pytest.approx(films.central_film, rel=1e-3)
    assert mesh.film_pressure[chosen] == pytest.approx(films.film_pressure, rel=2.5e-2)


def test_sheared_films_of_a_vanishing_helix_angle_are_those_of_the_spur_pair():
    options = {"stiffness_model": "iso6336", "film_model": "newton", "friction_law": "ehl"}
    # On finer grids the friction of the spur pair itself ripples by 1e-3.
    options["film_options"] = {"stiffness": "secant", "nodes": 129}
    spur, nearly = (table(helical(helix), steps=128, **options) for helix in (0.0, 1e-3))
    for name in ("mean_friction_coefficient", "mean_friction_power", "mean_mesh_stiffness"):
        assert getattr(nearly, name) == pytest.approx(getattr(spur, name), rel=1e-3), name
    for name in ("central_film", "minimum_film", "film_stiffness"):
        assert nearly.at_pitch_point(name) == pytest.approx(spur.at_pitch_point(name), rel=2e-3)


def test_the_printed_film_sum_is_reported_of_slices():
    options = {"stiffness_model": "iso6336", "film_model": "newton", "steps": 32}
    options["film_options"] = {"stiffness": "seed"}
    with pytest.warns(ModelWarning, match="is shown, and is no spring"):
        spur, nearly = (table(helical(helix), **options) for helix in (0.0, 1e-3))
    expected = spur.at_pitch_point("film_stiffness")
    assert nearly.at_pitch_point("film_stiffness") == pytest.approx(expected, rel=1e-2)


def test_maps_over_the_face_follow_the_table():
    mesh = table(helical())
    chart = mesh.over_face("load_per_width")
    assert chart.sizes["face_position"] == 24
    assert float(chart.max()) == pytest.approx(mesh.load_per_width.max(), rel=2e-2)
    radius = mesh.over_face("equivalent_radius")
    expected = chart["path"] * (mesh.gear_pair.line_of_action_length - chart["path"])
    expected = expected / mesh.gear_pair.line_of_action_length
    expected = expected / math.cos(mesh.gear_pair.base_helix_angle)
    # The path of slices at its ends is the middle of the part that is in contact.
    inner = slice(5, -5)
    assert radius.values[:, inner] == pytest.approx(
        np.broadcast_to(expected, radius.shape)[:, inner], rel=2e-3
    )
    with pytest.raises(InputError, match="no column"):
        mesh.over_face("mesh_stiffness")


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("hand", ["left", "right"])
def test_force_and_moments_in_space_balance(driver, hand):
    pair = helical(hand=hand, driver=driver)
    mesh = table(pair)
    direction = mesh.functions().spatial_direction(mesh.phase)
    assert direction[:, [0, 1, 2]] == pytest.approx(-direction[:, [6, 7, 8]], abs=1e-12)
    sense = 1.0 if driver == "pinion" else -1.0
    lean = math.tan(pair.base_helix_angle) * (-1.0 if hand == "right" else 1.0)
    assert direction[:, 2] == pytest.approx(sense * lean)
    # Moments about the axis of the pinion, in the right-handed frame (-x, y, z) of driving pinions.
    force = direction[:, 6:9] * np.array([-sense, 1.0, 1.0])
    between = np.array(
        [pair.pinion.base_radius + pair.wheel.base_radius, sense * pair.line_of_action_length, 0.0]
    )
    moments = [
        direction[:, columns] * np.array([-sense, 1.0, turn])
        for columns, turn in (([3, 4, 5], 1.0), ([9, 10, 11], -1.0))
    ]
    total = moments[0] + moments[1] + np.cross(between, force)
    assert total == pytest.approx(np.zeros_like(total), abs=1e-9)


def test_force_and_friction_of_a_ring_in_space_balance():
    """The ring turns in the same sense as its pinion, with its axis on the other side."""
    pair = cylindrical_pair(
        pinion_teeth=21,
        wheel_teeth=-72,
        normal_module=2e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(15.0),
        pinion_face_width=25e-3,
    )
    mesh = table(pair, stiffness_model="iso6336", pinion_torque=100.0)
    functions, frame = mesh.functions(), np.array([-1.0, 1.0, 1.0])
    radius = pair.pinion.base_radius - pair.wheel.base_radius
    between = np.array([radius, pair.line_of_action_length, 0.0])
    for columns in (functions.spatial_direction, functions.spatial_friction):
        rows = columns(mesh.phase)
        moments = rows[:, 3:6] * frame + rows[:, 9:12] * frame
        total = moments + np.cross(between, rows[:, 6:9] * frame)
        assert total == pytest.approx(np.zeros_like(total), abs=1e-9)
    lost = mesh.mean_friction_power / (100.0 * 150.0)
    moments = mesh.friction_moment_pinion - mesh.friction_moment_wheel / abs(pair.ratio)
    assert mesh.grid.mean(moments) / pair.pinion.base_radius == pytest.approx(lost, rel=1e-3)


def test_models_of_external_teeth_refuse_a_ring():
    ring = cylindrical_pair(
        pinion_teeth=21,
        wheel_teeth=-72,
        normal_module=2e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=0.0,
        pinion_face_width=25e-3,
    )
    for model in ("potential-energy", "analytic", "weber"):
        with pytest.raises(InputError, match=rf'"{model}" of a pair with internal teeth'):
            table(ring, stiffness_model=model)


def test_friction_in_space_balances():
    mesh = table(helical())
    friction, pair = mesh.functions().spatial_friction(mesh.phase), mesh.gear_pair
    force = friction[:, 6:9] * np.array([-1.0, 1.0, 1.0])
    between = np.array(
        [pair.pinion.base_radius + pair.wheel.base_radius, pair.line_of_action_length, 0.0]
    )
    moments = [
        friction[:, columns] * np.array([-1.0, 1.0, turn])
        for columns, turn in (([3, 4, 5], 1.0), ([9, 10, 11], -1.0))
    ]
    total = moments[0] + moments[1] + np.cross(between, force)
    assert total == pytest.approx(np.zeros_like(total), abs=1e-9)


def test_pitch_deviations_belong_to_their_teeth_at_whole_phases():
    """Lines of contact enter gradually: the error hardly changes within a billionth of a cycle."""
    late = FlankModification(cumulative_pitch_deviation=(8e-6,) + (0.0,) * 26)
    pair = helical(pinion_modification=late)
    phases = np.array([0.0, 1e-9, 1.0, 1.0 + 1e-9, 26.0, 26.0 + 1e-9, 27.0, 27.0 + 1e-9])
    error = loaded_contact(pair, TORQUE, phases=phases, slices=12).transmission_error
    assert error[::2] == pytest.approx(error[1::2], rel=1e-7)
    assert np.ptp(error) > 0.2e-6


@pytest.mark.parametrize("helix", [0.0, 10.0])
def test_the_model_over_the_face_called_by_itself_gives_the_pairs_of_its_contact(helix):
    pair = helical(helix, width=20e-3)
    phase = np.array([0.1, 0.35, 0.8])
    path, in_contact = path_of_contact(pair).pair_paths(phase)
    force = TORQUE / pair.pinion.base_radius
    called = MODELS["fe3d"](pair, Material(), path, in_contact, phase, force)
    loaded = loaded_contact(pair, TORQUE, provider="fe3d", phases=phase)
    expected = np.where(in_contact, loaded.normal_force / loaded.deflection[:, None], 0.0)
    assert called == pytest.approx(expected, rel=1e-9)


def test_slices_out_of_range_are_refused():
    with pytest.raises(InputError, match="slices = 0"):
        contact_problem(
            helical(), phase=np.zeros(1), total_force=1e3, material=Material(), slices=0
        )


def test_stiffness_of_iso_6336_of_a_helical_pair():
    """Method B by hand: z/(cos^2(beta_b) cos(beta)), cos(beta) on the single stiffness."""
    pair = helical(pinion_profile_shift_coefficient=0.2, wheel_profile_shift_coefficient=0.1)
    cosine, x1, x2 = math.cos(math.radians(21.0)), 0.2, 0.1
    base = math.cos(math.asin(math.sin(math.radians(21.0)) * math.cos(math.radians(20.0))))
    z1, z2 = 27 / (base**2 * cosine), 51 / (base**2 * cosine)
    q = 0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1
    q += -0.00193 * x2 - 0.24188 * x2 / z2 + 0.00529 * x1**2 + 0.00182 * x2**2
    rack = 1.0 + 0.5 * (1.2 - pair.pinion.rack.dedendum_coefficient)
    expected = 0.8 * rack * cosine / q * 1e9
    steel = Material(youngs_modulus=206e9)
    found = iso6336_single_stiffness(pair, steel, 50e3)
    assert found == pytest.approx(expected, rel=1e-9)


def test_friction_of_slices_that_follows_the_load_tilts_the_gears_as_under_that_load():
    """All twelve generalized forces at each load are those of the mesh built at that load."""
    pair, options = helical(), {"stiffness_model": "iso6336", "steps": 32}
    tables = [table(pair, pinion_torque=TORQUE * load, **options) for load in LOADS]
    nominal = tables[LOADS.index(1.0)]
    friction = mesh_friction(tables, nominal)
    body = {"mass": 5.0, "moment_of_inertia": 0.01, "torque": (TORQUE, TORQUE * pair.ratio)}
    system = follow_load(helical12(nominal.functions(), **body), friction)
    for load, mesh in zip(LOADS[3:], tables[3:], strict=True):
        expected = mesh.functions().spatial_friction(mesh.phase)
        rows = [
            (rub.coefficients(mesh.phase) @ load ** np.arange(7))[:, None] * rub.direction
            for rub in system.frictions
        ]
        error = np.abs(np.sum(rows, axis=0) - expected).max(axis=0)
        assert np.all(error <= 0.03 * np.abs(expected).max(axis=0))
    assert np.abs(nominal.friction_couple).max() > 1e-5


@pytest.mark.parametrize("model", ["weber", "potential-energy"])
def test_local_compression_of_a_slice_is_that_of_the_normal_section(model):
    """Curvature and depth across the line, 1/cos(beta_b) of the compression along the path."""
    pair, load, material = helical(), 1e5, Material()
    options = {"reference": "rim"}
    problem = contact_problem(pair, provider=model, phase=np.array([0.3]), total_force=9e3,
                              material=material, options=options, slices=5)  # fmt: skip
    parts, places = problem.compliance, problem.places
    cosine = math.cos(pair.base_helix_angle)
    radii = places.pinion_curvature_radius, places.wheel_curvature_radius
    normal = radii[0] * radii[1] / (radii[0] + radii[1]) / cosine
    width = hertz_line(load, normal, effective_modulus(material, material)).half_width
    gears = zip((pair.pinion, pair.wheel), radii, strict=True)
    depths = (load_point(gear, radius).depth * cosine for gear, radius in gears)
    across = sum(weber_banaschek_compression(load, width, depth, material) for depth in depths)
    along = load * (parts.local - parts.logarithm * math.log(load))
    assert along[places.on_path] == pytest.approx((across / cosine)[places.on_path], rel=1e-9)


def test_heat_of_slices_sums_to_the_loss_and_warms_the_flanks_as_blok_says():
    mesh = table(helical(), stiffness_model="iso6336")
    lost = mesh.grid.mean(mesh.friction_power.sum(axis=1))
    assert lost == pytest.approx(mesh.mean_friction_power, rel=1e-12)
    knot, contact = np.argwhere(mesh.load_share > 0.01)[40]
    load, friction, pressure = (
        getattr(mesh, name)[knot, contact]
        for name in ("load_per_width", "friction_coefficient", "hertz_pressure")
    )
    sliding, speed = mesh.sliding_speed[knot, contact], mesh.entrainment_speed[knot, contact]
    width = 4.0 * load / (math.pi * pressure)  # of the contact, twice b
    roots = math.sqrt(speed + 0.5 * sliding) + math.sqrt(speed - 0.5 * sliding)
    expected = 1.1115 * friction * load * abs(sliding) / (13.6e3 * roots * math.sqrt(width))
    assert mesh.flash_temperature[knot, contact] == pytest.approx(expected, rel=1e-3)
    assert 5.0 < float(mesh.over_face("flash_temperature").max()) < 200.0


def test_films_over_torque_and_speed_are_those_of_each_mesh_of_slices():
    pair, loads, speeds = helical(), (300.0, 600.0), (75.0, 150.0)
    settings = {"material": Material(), "stiffness_model": "iso6336", "lubricant": OIL}
    operation = {"pinion_torque": loads, "pinion_speed": speeds}
    films = film_over_operation(
        pair, **settings, composite_roughness=0.4e-6, film_model="moes", **operation
    )
    for row, torque in enumerate(loads):
        for column, speed in enumerate(speeds):
            options = {"pinion_torque": torque, "pinion_speed": speed}
            mesh = table(pair, stiffness_model="iso6336", **options)
            flank = (mesh.in_contact.shape[1] // 24, 24)
            ratio = np.where(mesh.in_contact, mesh.film_ratio, np.nan)
            least = np.nanmin(ratio.reshape(-1, *flank), axis=(0, 1))
            at_point = films.film_ratio[row, column]
            faces = np.unique(films.face_position)
            of_slices = [np.nanmin(at_point[films.face_position == face]) for face in faces]
            assert of_slices == pytest.approx(least, rel=1e-12)
    assert films.hertz_pressure.max() == pytest.approx(mesh.hertz_pressure.max(), rel=1e-12)
    assert np.all(np.diff(films.path[films.face_position == faces[5]]) >= 0.0)


def test_stiffness_over_torque_and_speed_sums_over_the_slices_of_all_pairs():
    settings = {"material": Material(), "stiffness_model": "iso6336", "lubricant": OIL}
    operation = {"pinion_torque": 600.0, "pinion_speed": (75.0, 150.0), "steps": 32}
    stiffness = comprehensive_stiffness(helical(), **settings, film_model="moes", **operation)
    mesh = table(helical(), stiffness_model="iso6336", steps=32,
                 film_options={"stiffness": "tangent"})  # fmt: skip
    assert stiffness.comprehensive_mesh_stiffness[0, 1] == pytest.approx(mesh.mesh_stiffness)
    assert stiffness.pair_stiffness[0].sum(axis=1) == pytest.approx(
        stiffness.comprehensive_mesh_stiffness[0].sum(axis=1), rel=1e-9
    )
    assert np.unique(stiffness.face_position).size == 24


def test_the_film_of_a_flank_line_follows_its_slice_through_the_mesh():
    """It has the load of its slice, and a film near the steady one of its formula."""
    mesh = table(helical(), stiffness_model="iso6336", steps=48)
    face = 0.2 * mesh.common_face_width
    film = moving_film(mesh, OIL, Material(), steps=100, nodes=257, face_position=face)
    number = int(np.argmin(np.abs(mesh.face_position[:24] - face)))
    alive = mesh.in_contact[:, number::24].T
    age = (mesh.phase[None, :] + np.arange(len(alive))[:, None])[alive]
    load = mesh.load_per_width[:, number::24].T[alive]
    middle = film.time * mesh.mesh_frequency
    expected = np.interp(middle, age - age[0], load)
    inside = (middle > 0.1) & (middle < middle[-1] - 0.1)
    assert film.load_per_width[inside] == pytest.approx(expected[inside], rel=1e-9)
    steady = np.interp(middle, age - age[0], mesh.central_film[:, number::24].T[alive])
    part = film.central_film[inside] / steady[inside]
    assert 0.7 < np.nanmin(part) < np.nanmedian(part) < 1.1
    with pytest.raises(InputError, match=r"face_position = 0\.1 m"):
        moving_film(mesh, OIL, Material(), face_position=0.1)
