"""Hypoid pairs in case files: the built-in case, its figures, what is refused and why."""

from __future__ import annotations

import json
import warnings

import numpy as np
import pytest

import tribodyn
from tribodyn.dynamics import steady_state
from tribodyn.errors import InputError, ModelWarning, collected
from tribodyn.exchange import write_tables
from tribodyn.gear import tooth_contact
from tribodyn.gear.hypoid.conjugate import ContactLines, contact_lines
from tribodyn.losses import BEARINGS, bearing_moments
from tribodyn.losses.gearbox import PARTS, turning_bodies
from tribodyn.mesh.hypoid.cells import contact_cells
from tribodyn.plot import FIGURES
from tribodyn.report.figure_blocks import HYPOID_SECTIONS
from tribodyn.study import read_case
from tribodyn.study.case.hypoid import mounting
from tribodyn.study.pipeline.assembly import geometry, whole_system
from tribodyn.study.pipeline.citations import cite
from tribodyn.study.pipeline.preview import gearbox_losses_of
from tribodyn.study.pipeline.run import prepare_run
from tribodyn.study.pipeline.tooth_contact import mesh_of

NAME = "hypoid-mixed-ehl"
RATIO = 10 / 43


def built_in(**changes):
    return tribodyn.load_case(NAME).replace(changes)


def quiet(case):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return tribodyn.run(case)


def rehearsed(case):
    with collected():
        return mesh_of(case, rehearsal=True)


@pytest.fixture(scope="module")
def result():
    return quiet(tribodyn.load_case(NAME))


def text(**changes):
    """Text of a short case file; a change of None takes a key of [gears] away."""
    gears = {
        "kind": '"hypoid"', "driver": '"pinion"', "offset": '"31.7 mm"',
        "outer_pitch_diameter_wheel": '"336 mm"', "face_width_wheel": '"47.7 mm"',
        "mean_spiral_angle_pinion": '"46 deg"', "cutter_radius": '"114.3 mm"',
    }  # fmt: skip
    dynamics = changes.pop("dynamics", '"hypoid-14dof"')
    law, more = changes.pop("law", '"none"'), changes.pop("more", "")
    gears |= changes
    lines = ["[gears]", *(f"{name} = {value}" for name, value in gears.items() if value)]
    lines += ["[gears.pinion]", "teeth = 10", "[gears.wheel]", "teeth = 43", "[operation]",
              'speed = "3000 rpm"', 'torque = "500 N*m"', "[friction]", f"law = {law}",
              "[dynamics]", f"model = {dynamics}", more]  # fmt: skip
    return "\n".join(lines) + "\n"


def refused(written):
    with pytest.raises(InputError) as caught:
        read_case(written, "my.toml")
    return str(caught.value)


def test_a_written_case_reads_back_and_lists_its_assumptions(tmp_path):
    case = built_in(**LOSSES, **{
        "film.model": "newton", "film.nodes": 257, "gears.process": "face-hobbing",
        "gears.blade_groups": 13, "gears.cutter_radius": 0.105, "gears.shaft_angle": 1.5,
    })  # fmt: skip
    (tmp_path / "again.toml").write_text(case.to_toml(), encoding="utf-8")
    assert tribodyn.load_case(tmp_path / "again.toml") == case
    assert "normal_module" not in case.to_toml()
    case = built_in()
    # The source prints no sizes of teeth and bearings: every one of them has its reason.
    assert {"gears.cutter_radius", "gears.ease_off.bias", "dynamics.backlash"} <= set(case.assumed)
    assert "gears.offset" not in case.assumed


def test_only_the_design_is_required():
    case = read_case(text(), "my.toml")
    values = geometry(case)
    assert case.dynamics.bearing_damping_ratio == 0.03
    assert 1.0 < values["mass_pinion"] < 4.0 < values["mass_wheel"] < 20.0
    assert values["pitch_angle_wheel"] == pytest.approx(np.radians(72.7355), abs=1e-5)
    assert case.backlash == 0.0
    played = case.replace({"gears.outer_backlash": 0.2e-3})
    assert played.backlash == pytest.approx(0.2e-3 * values["base_radius_wheel"] / 0.168, rel=2e-3)


@pytest.mark.parametrize(
    ("changes", "place", "reason"),
    [
        ({"cutter_radius": '"25 mm"'}, "gears.cutter_radius", "limit curvature"),
        ({"offset": '"200 mm"'}, "gears.offset", ""),
        ({"cutter_radius": None}, "gears.cutter_radius is missing", "mean radius of the face-mill"),
        ({"normal_module": '"5 mm"'}, "normal_module", "is not used"),
        ({"kind": '"spur"'}, "gears.offset", 'It belongs to kind = "hypoid"'),
        ({"driver": '"wheel"'}, "gears.driver", "The pinion of a hypoid pair must be the driver"),
        ({"dynamics": '"spur-6dof"'}, "dynamics.model", "takes gears of the kind spur or table"),
        ({"law": '"ehl"'}, "friction.law", "needs the pressure of a solved film"),
        (
            {
                "more": '[losses]\noil_volume = "1 l"\n[losses.wheel]\nimmersion = "170 mm"\n'
                '[lubricant]\nname = "80W"\ntemperature = "60 degC"'
            },
            "losses.wheel.immersion",
            "at most its pitch radius, 168 mm",
        ),
        ({"more": '[gears.ease_off]\nbias = "20 um"'}, "gears.ease_off.bias", "cut into"),
        ({"ease_of": "1"}, "ease_of", 'Did you mean "ease_off"'),
    ],
)
def test_impossible_values_are_refused_with_their_line(changes, place, reason):
    message = refused(text(**changes))
    assert message.startswith("my.toml:")
    assert reason in message
    for part in place.split():
        assert part.rpartition(".")[2] in message


def test_a_negative_torque_names_the_other_side_of_the_teeth():
    for side, other in (("drive", "coast"), ("coast", "drive")):
        with pytest.raises(InputError, match=f'gears.side = "{other}"'):
            built_in(**{"gears.side": side, "operation.torque": "-500 N*m"})
    with pytest.raises(InputError, match="without its sign it is in the range"):
        tribodyn.load_case("fzg-roughness").replace({"operation.torque": "-500 N*m"})


@pytest.mark.slow
def test_friction_that_follows_the_load_is_that_of_tables_at_other_loads(result, tmp_path):
    case = built_in(**{"dynamics.friction_load": "dynamic"})
    followed, phase = quiet(case), np.linspace(0.0, 0.97, 23)
    law, names = followed.friction, followed.response.names[1:-1]
    for load in (1.0, 2.05):
        with collected():
            direct = mesh_of(case, load=load).functions().friction(phase)
        force = np.full(phase.size, load * law.load)
        fitted = np.transpose([law.value(f"friction_{name}", phase, force) for name in names])
        largest = np.abs(direct).max(axis=0).reshape(4, 3).max(axis=1).repeat(3)
        assert np.abs((fitted - direct) / largest).max() < 6e-3
    figures, nominal = followed.summary(), result.summary()
    assert figures["friction_fit_error"] < 6e-3
    for name in ("mean_mesh_force", "mean_friction_power", "mean_mesh_force_y"):
        assert figures[name] == pytest.approx(nominal[name], rel=1e-3)
    # without friction the teeth would carry the torque over the lever, 1.2 % more
    assert figures["mean_mesh_force"] < 0.99 * law.load
    again = tribodyn.load_result(followed.save(tmp_path / "followed"))
    np.testing.assert_array_equal(again.friction.wrench, law.wrench)
    assert again.response.contact_force == pytest.approx(followed.response.contact_force, rel=1e-12)


def test_papers_are_those_of_the_models_used():
    sources = cite(built_in())
    assert "Xu, H." in sources
    assert "Weber" not in sources


def test_spur_gears_have_no_axes_that_cross():
    case = tribodyn.load_case("fzg-roughness")
    with pytest.raises(InputError, match="takes gears of the kind hypoid or table"):
        case.replace({"dynamics.model": "hypoid-14dof", "dynamics.bearing_damping": None})
    with pytest.raises(InputError, match="no gear pair"):
        _ = built_in().gear_pair


def test_figures_of_the_run_are_those_of_the_contact_at_rest(result):
    figures, static = result.summary(), result.hypoid_friction
    loaded = static.loaded
    names = ("mean_mesh_stiffness", "unloaded_transmission_error_peak_to_peak",
             "loaded_transmission_error_peak_to_peak", "minimum_film_ratio",
             "mean_friction_coefficient")  # fmt: skip
    expected = (loaded.mean_mesh_stiffness, np.ptp(loaded.unloaded_transmission_error),
                np.ptp(loaded.loaded_transmission_error), static.minimum_film_ratio,
                static.mean_friction_coefficient)  # fmt: skip
    assert [figures[name] for name in names] == pytest.approx(expected, rel=2e-3)
    assert figures["mean_mesh_stiffness"] == pytest.approx(5.69e8, rel=0.02)
    assert figures["transverse_contact_ratio"] == pytest.approx(
        tooth_contact(result.case.hypoid_flanks, rotations_per_pitch=4, cells=5).contact_ratio
    )


def test_bearings_carry_the_force_of_the_teeth(result):
    figures = result.summary()
    for axis in "xyz":
        carried = figures[f"mean_bearing_force_{axis}_pinion"]
        assert carried == pytest.approx(-figures[f"mean_mesh_force_{axis}"], rel=1e-6)
    # The wheel's axes in those of the pinion: x is common, y of one lies along z of the other.
    pinion, wheel = ([figures[f"mean_bearing_force_{a}_{g}"] for a in "xyz"] for g in
                     ("pinion", "wheel"))  # fmt: skip
    assert wheel == pytest.approx([-pinion[0], pinion[2], -pinion[1]], rel=1e-6)


def test_friction_takes_power_that_engine_and_load_account_for(result):
    figures, case = result.summary(), result.case
    torque = np.asarray(result.system.force) + result.response.extra_force
    lost = case.pinion_speed * (torque[0] + RATIO * torque[-1])
    assert lost == pytest.approx(figures["mean_friction_power"], rel=1e-5)
    at_rest = float(result.mesh.grid.mean(result.hypoid_friction.power))
    assert 0.0 < at_rest == pytest.approx(lost, rel=0.03)
    assert figures["efficiency"] == pytest.approx(0.995, abs=1e-3)


LOSSES = {
    "losses.pinion.bearing": "6308", "losses.pinion.seal_diameter": 40e-3,
    "losses.wheel.bearing": "NJ 406", "losses.wheel.bearings": 3,
    "losses.wheel.immersion": 30e-3, "losses.oil_volume": 1.5e-3,
}  # fmt: skip


def test_losses_add_up_and_bearings_carry_the_teeth(result):
    case = built_in(**LOSSES)
    lost = gearbox_losses_of(case, 800.0)
    powers = [float(getattr(lost, part)[0, 0]) for part in PARTS]
    assert all(power > 0.0 for power in powers[:3])
    assert float(lost.total[0, 0]) == pytest.approx(sum(powers), rel=1e-12)
    power = case.pinion_torque * case.pinion_speed
    # The wheel turns its load with what is left.
    load_torque = (power - sum(powers)) / (case.pinion_speed * RATIO)
    assert float(lost.efficiency[0, 0]) == pytest.approx(
        load_torque * case.pinion_speed * RATIO / power, rel=1e-12
    )
    forces = result.hypoid_friction.loaded
    for (name, body), sums in zip(
        turning_bodies(case.hypoid_flanks).items(),
        (forces.pinion_direction, forces.wheel_direction), strict=True,
    ):  # fmt: skip
        sums = forces.grid.mean(forces.mesh_force[:, None] * sums[:, :3])
        assert body.axial * 500.0 == pytest.approx(abs(sums[1]), rel=0.03), name
        assert body.radial * 500.0 == pytest.approx(np.hypot(sums[0], sums[2]), rel=0.06), name
    bodies = turning_bodies(case.hypoid_flanks)
    assert bodies["wheel"].pitch_radius == pytest.approx(0.168, rel=1e-3)
    # The thrust loads one of three bearings.
    args = BEARINGS["NJ 406"], case.pinion_speed * RATIO, 0.01 / 769.0
    radial, axial = (500.0 * each for each in (bodies["wheel"].radial / 3.0, bodies["wheel"].axial))
    moments = [bearing_moments(*args, radial, each).sliding for each in (axial, 0.0, 0.0)]
    pinion = gearbox_losses_of(built_in(**{"losses.pinion.bearing": "6308"}), 0.0)
    assert float((lost.bearing_sliding - pinion.bearing_sliding)[0, 0]) == pytest.approx(
        args[1] * sum(moments), rel=1e-9
    )


def test_heat_and_load_settle_together():
    oil = {"lubricant.name": "ISO VG 220", "lubricant.heat_transfer": 20.0}
    oil |= dict.fromkeys(
        f"lubricant.{n}" for n in ("dynamic_viscosity", "density", "pressure_viscosity_coefficient")
    )
    case = built_in(**LOSSES, **oil, **{"film.model": "moes", "solver.coupling": "static"})
    with collected():
        prepared = prepare_run(case)
    heat, mesh = prepared.heat, prepared.mesh
    assert heat.power_loss[-1] == pytest.approx(heat.dissipated[-1], rel=1e-6)
    assert heat.temperature[-1] > 310.0
    assert prepared.case.contact_models == ("contact lines", "moes")
    # Teeth and friction balance the torque of the gear that has it, at every phase.
    column = 4 if case.operation.torque_balance == "drive" else 10
    pushes, rubs = mesh.direction[:, column], mesh.friction[:, column]
    torque = prepared.coupling.loading * (pushes + rubs) / pushes
    assert torque == pytest.approx(1.0, abs=1e-5)


def test_slow_gears_follow_the_loaded_transmission_error():
    case = built_in(**{"friction.law": "none"})
    mesh = rehearsed(case)
    system = whole_system(case, mesh)
    (contact,) = system.contacts
    # Nothing but the mesh is compliant on the line of action: its force at rest is the torque's.
    phase = mesh.phase[:-1]
    force = case.pinion_torque / contact.direction(phase)[:, 5]
    pressed = force / contact.stiffness(phase) + contact.error(phase)
    loaded = mesh.static_transmission_error + mesh.unloaded_transmission_error
    assert pressed == pytest.approx(loaded[:-1], rel=1e-9)
    assert contact.direction(phase)[:, 5] / -contact.direction(phase)[:, 11] == pytest.approx(RATIO)


def test_both_sides_lose_power_and_the_torsional_pair_runs():
    fewer = {"operation.speed": 314.0}
    coast = rehearsed(built_in(**fewer, **{"gears.side": "coast"}))
    assert 0.0 < coast.mean_friction_power < 0.02 * 500.0 * 314.0
    assert np.all(coast.direction[:, 4] > 0.0)
    simple = built_in(**fewer, **{"dynamics.model": "torsional"})
    mesh = rehearsed(simple)
    orbit = steady_state(whole_system(simple, mesh), mesh.mesh_frequency, steps=256)
    lost = 314.0 * (500.0 + RATIO * (orbit.extra_force[1] - 500.0 / RATIO))
    assert lost == pytest.approx(mesh.mean_friction_power, rel=0.02)


def test_the_report_draws_gears_contact_and_forces_in_space(result):
    names = dir(result)
    assert {"plot_hypoid_pair", "plot_tooth_force", "plot_hypoid_pressure"} <= set(names)
    assert "plot_gear_pair" not in names
    blocks = {name: FIGURES[name](result) for name in HYPOID_SECTIONS if "force" in name}
    panels = {trace.name for trace in blocks["tooth_force"].data}
    assert panels == {"x", "y", "z"}
    mean = result.summary()["mean_mesh_force_y"]
    course = next(trace for trace in blocks["tooth_force"].data if trace.name == "y")
    assert np.mean(course.y) == pytest.approx(mean, rel=0.02)
    assert "along its own axis" in blocks["bearing_force"].layout.title.text
    assert all(not FIGURES[name].missing(result) for name in HYPOID_SECTIONS)


@pytest.mark.slow
def test_tables_and_those_figures_that_its_gears_have_are_exported(result, tmp_path):
    place = write_tables(result, tmp_path / "all")
    written = {path.stem for path in place.glob("figure_*.json")}
    assert {"figure_mesh_force", "figure_ease_off"} <= written
    assert "figure_path_of_contact" not in written
    cells = json.loads((place / "summary.json").read_text(encoding="utf-8"))
    assert dict(zip(cells["figure"], cells["value"], strict=True)) == result.summary()


def test_contact_lines_in_elliptical_contacts_are_its_models():
    case = tribodyn.load_case(NAME)
    assert case.spur_pair is None
    assert case.contact_models == ("contact lines", "hamrock-dowson")


def test_a_position_leaves_the_flanks_and_their_lines() -> None:
    """What only the gap depends on is computed once for all mounting errors and loads."""
    case = tribodyn.load_case(NAME)
    moved = case.replace({"gears.mounting.offset": "30 um", "operation.torque": "20 N*m"})
    assert moved.gears != case.gears
    assert moved.hypoid_flanks is case.hypoid_flanks
    phase = np.array([0.0, 0.3])
    nominal, shifted = (
        contact_cells(each.hypoid_flanks, mounting(each.gears), phase, 8) for each in (case, moved)
    )
    assert shifted.length is nominal.length
    conjugate = case.hypoid_flanks.conjugate
    assert ContactLines(conjugate).span == contact_lines(conjugate).span
    assert np.abs(shifted.gap - nominal.gap).max() > 1e-6
