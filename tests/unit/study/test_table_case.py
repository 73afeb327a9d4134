"""Cases whose mesh is a table of another program: the way there and back, closed forms, faults."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tribodyn
from tribodyn.errors import InputError, ModelWarning
from tribodyn.mesh import MeshTable
from tribodyn.study import Case, bifurcation, sweep

TEETH = (16, 24)
INERTIA = (4.07e-4, 1.168e-3)
RADII = (0.0338289, 0.05074335)
SPEED, TORQUE = 94.2, 90.0
MEAN, SWING, DAMPING = 3.0e8, 0.9e8, 900.0
SPEEDS = {"over": "operation.speed", "between": ("800 rpm", "1000 rpm"), "points": 3}


def table_case(path, **changes):
    """Torsional case on a mesh table; changes by dotted key."""
    gears = {
        name: {"teeth": teeth, "mass": 1.0, "moment_of_inertia": inertia}
        for name, teeth, inertia in zip(("pinion", "wheel"), TEETH, INERTIA, strict=True)
    }
    case = Case(
        gears={"kind": "table", "table": str(path), "driver": "pinion", **gears},
        operation={"speed": SPEED, "torque": TORQUE},
        dynamics={"model": "torsional", "mesh_damping": DAMPING},
        solver={"steps_per_mesh_cycle": 512},
    )
    return case.replace(changes) if changes else case


def written(path, columns, facts=None, events=()):
    """Write a CSV table."""
    facts = {"base_radius_pinion": "33.8289 mm", "base_radius_wheel": "50.74335 mm"} | (facts or {})
    lines = [f"# {name} = {value}" for name, value in facts.items()]
    lines += [f"# events = {', '.join(map(repr, events))}"] if events else []
    lines.append(",".join(columns))
    lines += [",".join(repr(float(v)) for v in row) for row in np.stack([*columns.values()], 1)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def sinusoid(count=257):
    phase = np.linspace(0.0, 1.0, count)
    return {
        "phase": phase,
        "stiffness [N/um]": 1e-6 * (MEAN + SWING * np.cos(2.0 * np.pi * phase)),
    }


def quiet(case):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return tribodyn.run(case)


@pytest.fixture(scope="module")
def spur():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return tribodyn.run(tribodyn.load_case("fzg-roughness"))


def of_spur(result, path):
    """The table case with everything else as in a spur case."""
    case, summary = result.case, result.summary()
    bodies = {
        name: {
            "teeth": getattr(case.gears, name).teeth,
            "mass": summary[f"mass_{name}"],
            "moment_of_inertia": summary[f"moment_of_inertia_{name}"],
        }
        for name in ("pinion", "wheel")
    }
    dynamics = ("bearing_stiffness", "bearing_damping_ratio", "mesh_damping_ratio")
    return Case(
        gears={"kind": "table", "table": str(path), "driver": case.gears.driver, **bodies},
        operation={
            "speed": case.pinion_speed,
            "torque": case.pinion_torque,
            "torque_balance": case.operation.torque_balance,
        },
        dynamics={
            "model": "spur-6dof",
            "backlash": case.backlash,
            **{name: getattr(case.dynamics, name) for name in dynamics},
        },
        solver={"steps_per_mesh_cycle": result.response.time.size // result.response.periods},
    )


@pytest.mark.parametrize("name", ["mesh.nc", "mesh.csv"])
def test_a_spur_table_that_is_written_and_read_has_the_same_orbit(spur, tmp_path, name):
    path = tmp_path / name
    spur.mesh.save(path) if name.endswith("nc") else spur.mesh.to_csv(path)
    again = quiet(of_spur(spur, path))
    scale = np.abs(spur.response.position).max(axis=0)
    difference = np.abs(again.response.position - spur.response.position).max(axis=0)
    assert np.all(difference <= 1e-9 * scale)
    before, after = spur.summary(), again.summary()
    same = [key for key in after if key not in ("omega_max_dt", "steady_state_error")]
    assert {key: after[key] for key in same} == pytest.approx(
        {key: before[key] for key in same}, rel=1e-9
    )
    assert before["rms_friction_force"] > 1.0  # friction goes the same way


def test_a_sinusoidal_stiffness_obeys_the_equation_of_mathieu(tmp_path):
    result = quiet(table_case(written(tmp_path / "k.csv", sinusoid())))
    mass = math.prod(INERTIA) / (INERTIA[0] * RADII[1] ** 2 + INERTIA[1] * RADII[0] ** 2)
    omega = SPEED * TEETH[0]
    force = TORQUE / RADII[0]

    def motion(t, y):
        stiffness = MEAN + SWING * math.cos(omega * t)
        return [y[1], (force - DAMPING * y[1] - stiffness * y[0]) / mass]

    period = 2.0 * math.pi / omega
    cycles = math.ceil(60.0 / (DAMPING / (2.0 * mass)) / period)
    at = cycles * period + result.response.time
    exact = solve_ivp(
        motion, (0.0, at[-1]), [force / MEAN, 0.0], "DOP853", at, rtol=1e-11, atol=1e-16
    )
    deflection = result.response.deflection[:, 0]
    assert deflection == pytest.approx(exact.y[0], abs=1e-7 * np.ptp(exact.y[0]))


def test_an_unloaded_error_displaces_the_compression(tmp_path):
    columns = sinusoid() | {"stiffness [N/um]": np.full(257, 300.0)}
    plain = quiet(table_case(written(tmp_path / "k.csv", columns)))
    error = 2e-6 * np.cos(2.0 * np.pi * columns["phase"])
    columns["unloaded_transmission_error [um]"] = 1e6 * error
    result = quiet(table_case(written(tmp_path / "e.csv", columns)))
    stated = quiet(
        table_case(tmp_path / "k.csv", **{"dynamics.transmission_error_amplitude": "2 um"})
    )
    name = "peak_to_peak_dynamic_transmission_error"
    assert result.summary()[name] == pytest.approx(stated.summary()[name], rel=1e-5)
    assert result.summary()[name] != pytest.approx(plain.summary()[name], rel=1e-2)


def test_a_force_law_gives_its_deflection_at_any_torque(tmp_path):
    phase = np.linspace(0.0, 1.0, 33)
    columns = {"phase": phase}
    for ramp, (place, stiffness) in enumerate(((0.0, 200.0), (10.0, 150.0)), 1):
        columns[f"ramp_deflection_{ramp} [um]"] = np.full(33, place)
        columns[f"ramp_stiffness_{ramp} [N/um]"] = np.full(33, stiffness)
    path = written(tmp_path / "law.csv", columns, {"pinion_torque": "90 N*m"})
    for torque in (30.0, 150.0):
        result = quiet(table_case(path, **{"operation.torque": torque}))
        force = torque / RADII[0]
        deflection = force / 2e8 if force < 2000.0 else 1e-5 + (force - 2000.0) / 3.5e8
        assert result.mesh.static_transmission_error == pytest.approx(deflection, rel=1e-12)
        assert result.summary()["mean_dynamic_transmission_error"] == pytest.approx(
            deflection, rel=1e-6
        )


def test_a_stiffness_for_one_torque_holds_for_that_torque_alone(tmp_path):
    path = written(tmp_path / "k.csv", sinusoid(), {"pinion_torque": "90 N*m"})
    with pytest.raises(InputError, match="belongs to 90 N\\*m"):
        table_case(path, **{"operation.torque": "120 N*m"})


def test_directions_of_contacts_may_vary(tmp_path):
    columns = sinusoid()
    towards = {"pinion_y": 1.0, "pinion_theta": RADII[0], "wheel_y": -1.0, "wheel_theta": -RADII[1]}
    vectors = {f"direction_{name}": np.full(257, value) for name, value in towards.items()}
    plain = quiet(table_case(written(tmp_path / "k.csv", columns)))
    result = quiet(table_case(written(tmp_path / "h.csv", columns | vectors)))
    assert result.response.position == pytest.approx(plain.response.position, rel=1e-9, abs=1e-18)


def test_friction_of_each_contact_acts_in_its_direction(tmp_path):
    columns = sinusoid() | {
        "friction_coefficient": np.full(257, 0.06),
        "sliding_direction": np.where(np.arange(257) < 128, -1.0, 1.0),
        "pinion_curvature_radius [mm]": np.full(257, 12.0),
        "wheel_curvature_radius [mm]": np.full(257, 18.0),
    }
    spur = quiet(table_case(written(tmp_path / "s.csv", columns)))
    push = {"pinion_x": 1.0, "pinion_theta": 12e-3, "wheel_x": -1.0, "wheel_theta": -18e-3}
    sign = columns.pop("sliding_direction")
    for name in ("pinion_curvature_radius [mm]", "wheel_curvature_radius [mm]"):
        del columns[name]
    columns |= {f"friction_direction_{name}": sign * value for name, value in push.items()}
    vectors = quiet(table_case(written(tmp_path / "v.csv", columns)))
    assert vectors.response.position == pytest.approx(spur.response.position, rel=1e-9, abs=1e-18)
    assert vectors.summary()["rms_friction_force"] == pytest.approx(
        spur.summary()["rms_friction_force"], rel=1e-9
    )
    smooth = quiet(
        table_case(tmp_path / "s.csv", **{"friction.law": "constant", "friction.coefficient": 0.0})
    )
    assert smooth.summary()["rms_friction_force"] == 0.0


def test_events_cut_the_cycle(tmp_path):
    half = np.linspace(0.0, 0.5, 17)
    columns = {
        "phase": np.concatenate([half, half + 0.5]),
        "stiffness_1 [N/m]": np.full(34, 2e8),
        "stiffness_2 [N/m]": np.repeat([1e8, 0.0], 17),
    }
    mesh = table_case(written(tmp_path / "two.csv", columns)).mesh_table
    assert mesh.grid.event_phases == (0.0, 0.5)
    single = sinusoid(33)
    mesh = table_case(written(tmp_path / "one.csv", single, events=(0.25,))).mesh_table
    assert mesh.grid.event_phases == (0.0, 0.25)


def test_uneven_rows_are_followed(tmp_path):
    phase = np.sort(np.append(np.random.default_rng(3).random(400), [0.0, 1.0]))
    columns = {"phase": phase, "stiffness [N/m]": MEAN + SWING * np.cos(2.0 * np.pi * phase)}
    mesh = table_case(written(tmp_path / "k.csv", columns)).mesh_table
    exact = MEAN + SWING * np.cos(2.0 * np.pi * mesh.grid.phase)
    assert mesh.columns["stiffness"][:, 0] == pytest.approx(exact, rel=1e-3)


def broken(name):
    columns, facts, events = sinusoid(33), {}, ()
    if name == "no stiffness":
        del columns["stiffness [N/um]"]
    elif name == "no phase":
        del columns["phase"]
    elif name == "NaN":
        columns["stiffness [N/um]"][7] = math.nan
    elif name == "order":
        columns["phase"][[4, 5]] = columns["phase"][[5, 4]]
    elif name == "end":
        columns["phase"] *= 0.9
    elif name == "unit":
        columns["stiffness [kg]"] = columns.pop("stiffness [N/um]")
    elif name == "unknown":
        columns["stifness"] = columns.pop("stiffness [N/um]")
    elif name == "event":
        events = (0.2,)
    elif name == "ramp":
        columns["ramp_stiffness_1 [N/m]"] = np.full(33, 1e8)
    elif name == "negative":
        columns["stiffness [N/um]"][3] = -1.0
    elif name == "torque unit":
        facts = {"pinion_torque": "90 m"}
    elif name == "friction":
        columns["friction_coefficient"] = np.full(33, 0.05)
    return columns, facts, events


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("no stiffness", "stiffness is missing"),
        ("no phase", "phase is missing"),
        ("NaN", "stiffness is nan in row 8"),
        ("order", "phase falls to"),
        ("end", "runs from 0 to 0.9"),
        ("unit", "unit of stiffness \\[kg\\]"),
        ("unknown", '"stifness" is unknown'),
        ("event", "no row has the phase of the event 0.2"),
        ("ramp", "ramp_deflection is missing"),
        ("negative", "stiffness falls to"),
        ("torque unit", "pinion_torque = 90 m"),
        ("friction", "sliding_direction is missing"),
    ],
)
def test_a_faulty_file_is_refused_with_the_key_of_the_case(tmp_path, name, message):
    columns, facts, events = broken(name)
    path = written(tmp_path / "bad.csv", columns, facts, events)
    with pytest.raises(InputError, match=message) as error:
        table_case(path)
    assert "gears.table" in str(error.value)


def test_paths_that_are_no_file_are_refused(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        table_case(tmp_path / "none.csv")
    with pytest.raises(InputError, match="is not a regular file"):
        table_case(tmp_path)
    (tmp_path / "text.nc").write_text("no netCDF")
    with pytest.raises(InputError, match="cannot be read"):
        table_case(tmp_path / "text.nc")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"film.model": "moes"}, "film"),
        ({"friction.law": "benedict-kelly"}, "friction"),
        ({"dynamics.friction_load": "dynamic"}, "friction_load"),
        ({"stiffness.model": "iso6336"}, "stiffness of the teeth"),
        ({"gears.pinion.moment_of_inertia": None}, "moment_of_inertia is missing"),
        ({"gears.table": None}, "table is missing"),
    ],
)
def test_keys_that_a_table_cannot_have_are_refused(tmp_path, change, message):
    path = written(tmp_path / "k.csv", sinusoid())
    with pytest.raises(InputError, match=message):
        table_case(path, **change)


def test_a_table_case_is_written_swept_and_reported(tmp_path):
    case = table_case(written(tmp_path / "k.csv", sinusoid()))
    file = tmp_path / "case.toml"
    file.write_text(case.to_toml(), encoding="utf-8")
    assert tribodyn.load_case(file) == case
    result = quiet(case)
    target = result.save(tmp_path / "out")
    assert "no gear pair" in (target / "report.html").read_text(encoding="utf-8")
    stored = MeshTable.load(target / "mesh.nc")
    assert np.array_equal(stored.mesh_stiffness, result.mesh.mesh_stiffness)
    with pytest.raises(InputError, match="no gear pair"):
        case.gear_pair  # noqa: B018
    with pytest.raises(InputError, match="no gear pair"):
        stored.gear_pair.driver  # noqa: B018
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        swept = sweep(case, **SPEEDS)
    assert np.all(np.isfinite(swept["peak_mesh_force"]))


def test_a_table_case_has_a_bifurcation_diagram(tmp_path):
    case = table_case(written(tmp_path / "k.csv", sinusoid()))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        assert "3" in repr(bifurcation(case, **SPEEDS))


def test_a_table_has_no_spur_pair_and_is_its_own_stiffness_model(spur, tmp_path):
    path = written(tmp_path / "k.csv", sinusoid())
    case = table_case(path)
    assert case.spur_pair is None
    assert case.contact_models[0] == f"table {path}"
    assert spur.case.spur_pair is spur.case.gear_pair
    assert spur.case.contact_models == (spur.case.stiffness.model, spur.case.film.model)
