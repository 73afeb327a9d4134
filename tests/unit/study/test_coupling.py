"""Two-way coupling: what agrees at the end, what it reduces to, and how fast it gets there."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from registries import as_before
from tribodyn.contact import effective_modulus, hertz_line
from tribodyn.ehl import FILM_MODELS
from tribodyn.friction import LAWS, benedict_kelly
from tribodyn.progress import SILENT
from tribodyn.study import coupling as module
from tribodyn.study import run
from tribodyn.study.case.reference import start_toml
from tribodyn.study.pipeline.assembly import geometry, whole_system
from tribodyn.study.pipeline.motion import motion_of
from tribodyn.study.pipeline.tooth_contact import mesh_of

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_TIGHT = {"solver.coupling_tolerance": 1e-10}


def _run(**changes: Any) -> Any:
    case = td.load_case("fzg-roughness")
    return td.run(case.replace({key.replace("__", "."): v for key, v in changes.items()}))


@pytest.fixture(scope="module")
def static() -> Any:
    return _run(solver__coupling="static", operation__torque_balance="drive",
                solver__coupling_tolerance=1e-10)  # fmt: skip


@pytest.fixture(scope="module")
def dynamic() -> Any:
    return _run(solver__coupling="dynamic", film__stiffness="tangent",
                solver__coupling_tolerance=1e-9)  # fmt: skip


def _recomputed(result: Any) -> dict[str, Any]:
    """Film and friction from the loads in the mesh alone, by the plain functions of the package."""
    case, mesh = result.case, result.mesh
    touch = mesh.load_per_width > 0.0
    load, radius = mesh.load_per_width[touch], mesh.equivalent_radius[touch]
    speed, oil = mesh.entrainment_speed[touch], case.lubricant_properties
    modulus = effective_modulus(case.material_properties, case.material_properties)
    film = FILM_MODELS["dowson-higginson"].films(
        load, radius, speed, oil, modulus, length=mesh.common_face_width
    )
    mu = benedict_kelly(
        load, mesh.sliding_speed[touch], speed, oil.dynamic_viscosity, case.composite_roughness,
        variant="he-singh",
    )  # fmt: skip
    pressure = hertz_line(load, radius, modulus).maximum_pressure
    return {"touch": touch, "film": film, "mu": mu, "pressure": pressure}


@pytest.mark.parametrize("which", ["static", "dynamic"])
def test_at_the_end_everything_belongs_to_one_load(
    which: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(which)
    mesh, recomputed = result.mesh, _recomputed(result)
    touch = recomputed["touch"]
    np.testing.assert_allclose(mesh.friction_coefficient[touch], recomputed["mu"], rtol=1e-12)
    np.testing.assert_allclose(
        mesh.minimum_film[touch], recomputed["film"].minimum_film, rtol=1e-12
    )
    np.testing.assert_allclose(mesh.hertz_pressure[touch], recomputed["pressure"], rtol=1e-12)
    # the pairs carry the load between them
    carried = mesh.load_per_width.sum(axis=1) * mesh.common_face_width / mesh.total_normal_force
    np.testing.assert_allclose(carried, result.coupling.loading, rtol=1e-9)
    np.testing.assert_allclose(mesh.load_share.sum(axis=1), 1.0, rtol=1e-9)


def test_films_in_series_belong_to_the_same_load(dynamic: Any) -> None:
    mesh, recomputed = dynamic.mesh, _recomputed(dynamic)
    touch = recomputed["touch"]
    film = recomputed["film"].film_stiffness
    np.testing.assert_allclose(mesh.film_stiffness[touch], film, rtol=1e-12)
    series = 1.0 / (1.0 / mesh.tooth_stiffness[touch] + 1.0 / film)
    np.testing.assert_allclose(mesh.stiffness[touch], series, rtol=1e-8)
    share = mesh.stiffness / mesh.stiffness.sum(axis=1)[:, None]
    np.testing.assert_allclose(mesh.load_share, share, atol=1e-8)


def test_at_rest_the_load_holds_the_torque(static: Any) -> None:
    mesh, over = static.mesh, static.coupling.loading
    # T = N (r_b + sum of direction, coefficient, share and lever), pair by pair
    moment = (mesh.sliding_direction * mesh.friction_coefficient * mesh.load_share
              * mesh.pinion_curvature_radius).sum(axis=1)  # fmt: skip
    force = static.case.pinion_torque / (mesh.base_radius_pinion + moment)
    np.testing.assert_allclose(over * mesh.total_normal_force, force, rtol=1e-9)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("balance", ["drive", "load"])
def test_balance_of_torques_by_virtual_power(driver: str, balance: str) -> None:
    result = _run(gears__driver=driver, operation__torque_balance=balance,
                  solver__coupling="static", solver__coupling_tolerance=1e-10)  # fmt: skip
    mesh, over = result.mesh, result.coupling.loading
    balanced = driver if balance == "drive" else {"pinion": "wheel", "wheel": "pinion"}[driver]
    force = over * mesh.total_normal_force
    moment, other = (
        force * getattr(mesh, f"friction_moment_{gear}") for gear in ("pinion", "wheel")
    )
    sign = 1.0 if driver == "pinion" else -1.0
    pinion = sign * force * mesh.base_radius_pinion + moment
    wheel = sign * force * mesh.base_radius_wheel + other
    nominal = sign * result.case.pinion_torque
    ratio = result.case.gear_ratio
    torque = pinion if balanced == "pinion" else wheel / ratio
    np.testing.assert_allclose(torque, nominal, rtol=1e-9)
    # what one gear gives and the other does not get is the sliding power of the contacts
    lost = mesh.pinion_speed * (pinion - wheel / ratio)
    sliding = force * mesh.by_share(mesh.friction_coefficient * np.abs(mesh.sliding_speed))
    np.testing.assert_allclose(lost, sliding, rtol=1e-8, atol=1e-8 * sliding.max())


def test_with_both_torques_constant_both_gears_accelerate_equally() -> None:
    result = _run(solver__coupling="static", solver__coupling_tolerance=1e-10)
    mesh, body = result.mesh, geometry(result.case)
    force, torque = result.coupling.loading * mesh.total_normal_force, result.case.pinion_torque
    rates = [
        (sign * torque * ratio - sign * force * getattr(mesh, f"base_radius_{gear}")
         - sign * force * getattr(mesh, f"friction_moment_{gear}"))
        / body[f"moment_of_inertia_{gear}"] * getattr(mesh, f"base_radius_{gear}")
        for gear, sign, ratio in (("pinion", 1.0, 1.0), ("wheel", -1.0, 1.5))
    ]  # fmt: skip
    # r_p theta_p'' = r_g theta_g'': nothing accelerates along the line of action
    np.testing.assert_allclose(rates[0], rates[1], atol=1e-7 * np.abs(rates[0]).max())
    assert np.abs(rates[0]).max() > 1.0


def test_the_load_of_the_motion_is_the_load_of_the_mesh(dynamic: Any) -> None:
    again = motion_of(
        dynamic.case, whole_system(dynamic.case, dynamic.mesh), dynamic.mesh.mesh_frequency, SILENT
    )
    force = module.force_at_knots(dynamic.mesh, again) / dynamic.mesh.total_normal_force
    np.testing.assert_allclose(force, dynamic.coupling.loading, atol=1e-8)


@pytest.mark.parametrize("kind", ["static", "dynamic"])
def test_without_film_and_friction_it_is_the_plain_run(kind: str) -> None:
    bare = {"friction__law": "none", "film__model": "none"}
    plain, coupled = _run(**bare), _run(**bare, solver__coupling=kind)
    for name in ("position", "velocity", "contact_force"):
        np.testing.assert_array_equal(
            getattr(coupled.response, name), getattr(plain.response, name)
        )
    np.testing.assert_array_equal(coupled.mesh.stiffness, plain.mesh.stiffness)
    assert coupled.coupling.film_change.max() == coupled.coupling.friction_change.max() == 0.0
    if kind == "static":
        assert np.all(coupled.coupling.loading == 1.0)
        assert coupled.mesh == plain.mesh
        assert coupled.summary() == plain.summary()


def test_a_constant_coefficient_on_linear_teeth_moves_no_stiffness() -> None:
    constant = {"friction__law": "constant", "friction__coefficient": 0.08, "film__model": "none"}
    coupled = _run(**constant, solver__coupling="dynamic")
    plain = _run(**constant)
    for name in ("rms_mesh_force", "mean_friction_power"):
        assert coupled.summary()[name] == pytest.approx(plain.summary()[name], rel=1e-12)


def test_friction_that_follows_the_load_is_the_same_motion() -> None:
    # Teeth that are springs of their own and a coefficient in proportion to the load, of which the
    # polynomials of the load are exact: friction couples in two ways that share nothing.
    with as_before():

        @LAWS.define("in-proportion", source="test", meaning="in proportion", needs_oil=False)
        def in_proportion(contact: Any) -> Any:
            return 1e-6 * contact.load_per_width

        law = {"friction__law": "in-proportion", "film__model": "none"}
        shares = [mesh_of(td.load_case("fzg-roughness"), load=x).load_share for x in (1.0, 1.6)]
        # The loop has shares of the momentary load, the coupling those of linear teeth: 4e-3.
        assert np.abs(shares[1] - shares[0]).max() > 5e-4
        law |= {"stiffness__model": "rectangular", "stiffness__pair_stiffness": 2e8,
                "stiffness__reference": None}  # fmt: skip
        followed = _run(**law, dynamics__friction_load="dynamic").summary()
        coupled = _run(**law, solver__coupling="dynamic", solver__coupling_tolerance=1e-9).summary()
        plain = _run(**law).summary()
    assert followed["friction_fit_error"] < 1e-5
    for name in ("mean_friction_power", "rms_friction_force", "rms_mesh_force"):
        assert abs(followed[name] / plain[name] - 1.0) > 1e-4
        # The load is known at the knots of the mesh here, at the steps of the motion there.
        assert coupled[name] - plain[name] == pytest.approx(followed[name] - plain[name], rel=1e-3)


def test_the_contraction_is_that_of_the_derivative(static: Any) -> None:
    # x = 1/(1 + m(x)), m = r sum(s mu rho); for Benedict and Kelley d mu / d ln x = C/ln(10).
    mesh, over = static.mesh, static.coupling.loading
    slope = 0.0137 * 1.13 / (1.13 - 0.53) / np.log(10.0)
    levers = mesh.sliding_direction * mesh.load_share * mesh.pinion_curvature_radius
    moment = levers.sum(axis=1) / mesh.base_radius_pinion
    # dg/dx = -x^2 dm/dx, with dm/dx = slope * moment / x at x = over
    factor = np.abs(over * slope * moment).max()
    ratio = static.coupling.load_change[2] / static.coupling.load_change[1]
    assert ratio == pytest.approx(factor, rel=0.05)
    # each pass gains the same: first order
    ratios = static.coupling.load_change[1:4] / static.coupling.load_change[0:3]
    assert np.all(ratios[1:] < 0.02)


def test_both_sides_of_an_event_are_stored(dynamic: Any) -> None:
    mesh, over = dynamic.mesh, dynamic.coupling.loading
    response = dynamic.response
    stiffness = mesh.mesh_stiffness
    jumps = [(s.stop - 1, t.start) for s, t in zip(mesh.segments, mesh.segments[1:], strict=False)]
    deflection = response.fine.deflection[:, 0] - dynamic.half_backlash
    for before, after in jumps:
        place = int(np.argmin(np.abs(response.fine.phase - mesh.phase[after])))
        jump = (stiffness[after] - stiffness[before]) * deflection[place]
        # the displacement goes on where the stiffness jumps: so does the damping force
        assert (over[after] - over[before]) * mesh.total_normal_force == pytest.approx(
            jump, abs=2e-3 * mesh.total_normal_force
        )


def test_a_quantity_of_the_mesh_can_be_replaced() -> None:
    # Oil that is thinner where more power is lost: nu = nu0/(1 + P/500 W).
    case = td.load_case("fzg-roughness").replace(
        {"lubricant.name": None, "lubricant.dynamic_viscosity": 0.082, "lubricant.density": 880.0,
         "lubricant.pressure_viscosity_coefficient": 2.19e-8, "solver.coupling": "static",
         "friction.law": "xu-2007", "solver.coupling_tolerance": 1e-9}
    )  # fmt: skip

    def thinner(changed: Any, mesh: Any) -> Any:
        viscosity = 0.082 / (1.0 + mesh.mean_friction_power / 500.0)
        return changed.replace({"lubricant.dynamic_viscosity": viscosity})

    result = run(case, follow=thinner)
    viscosity = result.case.lubricant.dynamic_viscosity
    assert viscosity == pytest.approx(
        0.082 / (1.0 + result.mesh.mean_friction_power / 500.0), rel=1e-8
    )
    assert 0.3 * 0.082 < viscosity < 0.9 * 0.082
    change = result.coupling.oil_change
    assert change[0] > 0.1
    assert change[-1] < 1e-9
    assert result.mesh.mean_friction_power != pytest.approx(td.run(case).mesh.mean_friction_power)


def test_a_coupling_that_does_not_settle_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    balanced = module.balanced_load
    swings = iter(range(1000))

    def thrown(case: Any, mesh: Any) -> Any:
        return balanced(case, mesh) * (1.0 + 1e-3 * 3.0 ** next(swings))

    monkeypatch.setattr(module, "balanced_load", thrown)
    with pytest.raises(td.ComputationError, match="do not settle") as caught:
        _run(solver__coupling="static")
    (problem,) = caught.value.problems
    assert problem.where == "solver.coupling"
    assert "pass" in problem.what
    assert 'solver.coupling = "none"' in problem.remedy


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"solver.coupling": "both"}, "static"),
        ({"solver.coupling": "dynamic", "dynamics.friction_load": "dynamic"}, "friction follow"),
        ({"solver.coupling": "dynamic", "solver.method": "transient"}, "steady motion"),
        ({"solver.coupling": "static", "solver.coupling_tolerance": 0.5}, "coupling_tolerance"),
    ],
)
def test_wrong_keys_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(td.InputError, match=message):
        td.load_case("fzg-roughness").replace(changes)


def test_it_is_drawn_reported_and_read_back(dynamic: Any, tmp_path: Any) -> None:
    figure = dynamic.plot_coupling()
    assert figure.layout.title.text.startswith(
        "Load, load share, film, friction coefficient and stiffness converge"
    )
    place = dynamic.save(tmp_path / "r")
    assert "Coupling of load, film and friction" in (place / "report.html").read_text()
    again = td.load_result(place)
    assert again.summary() == dynamic.summary()
    assert again.mesh == dynamic.mesh
    assert again.coupling == dynamic.coupling
    assert again.plot_coupling().to_dict() == figure.to_dict()
    plain = _run()
    assert plain.coupling is None
    with pytest.raises(AttributeError, match=r"solver\.coupling"):
        plain.plot_coupling()


def test_loads_may_differ_from_phase_to_phase() -> None:
    from tribodyn.gear import Material
    from tribodyn.stiffness.loaded.contact import contact_problem

    pair = td.load_case("fzg-roughness").gear_pair
    phase = np.array([0.05, 0.4, 0.8])
    problem = contact_problem(pair, provider="analytic", phase=phase, total_force=2000.0,
                              material=Material(), options={"reference": "rim"})  # fmt: skip
    totals = np.array([500.0, 2000.0, 4000.0])
    loads = problem.at_loads(totals[None, :])
    for place, total in enumerate(totals):
        alone = problem.at_loads(np.array([total]))
        assert loads.approach[0, place] == alone.approach[0, place]
        np.testing.assert_array_equal(loads.load[0, place], alone.load[0, place])
        assert loads.tangent[0, place] == alone.tangent[0, place]


def test_teeth_that_are_solved_together_follow_the_load_too() -> None:
    from tribodyn.study import read_case

    text = start_toml()
    case = read_case(text).replace({"stiffness.model": "analytic", "solver.coupling": "dynamic"})
    result = td.run(case)
    mesh, over = result.mesh, result.coupling.loading
    force = over * mesh.total_normal_force
    # the law of the mesh has this force at the deflection of the secant stiffness
    deflection = force / mesh.mesh_stiffness
    law = np.array([
        (k * np.maximum(d - place, 0.0)).sum()
        for k, d, place in zip(mesh.ramp_stiffness, deflection, mesh.ramp_deflection, strict=True)
    ])  # fmt: skip
    np.testing.assert_allclose(law, force, rtol=5e-3)
    assert dataclasses.asdict(result.coupling)["kind"] == "dynamic"


def test_tangent_and_secant_have_one_orbit_where_they_follow_its_load(dynamic: Any) -> None:
    """Both go through force and deflection of every phase, with the films of that force."""
    law = {"dynamics__mesh_law": "tangent", "film__stiffness": "tangent"}
    apart = _run(**law).summary()["peak_mesh_force"]
    tangent = _run(**law, solver__coupling="dynamic")
    peak = dynamic.summary()["peak_mesh_force"]
    assert tangent.summary()["peak_mesh_force"] == pytest.approx(peak, rel=1e-3)
    assert abs(apart / peak - 1.0) > 1e-2
    mesh, nominal = tangent.mesh, mesh_of(tangent.case)
    assert not np.allclose(mesh.mesh_stiffness_tangent, nominal.mesh_stiffness_tangent, rtol=1e-4)
