"""The built-in cases of three sources: identities that each must meet, and what they are for."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import tribodyn as td
from tribodyn.dynamics import energy_audit, fzg12, natural_modes, steady_state

PRESETS = ("fzg-stiffness", "time-varying-friction", "fzg-12dof", "fzg-12dof-light")


def computed(name, changes=None):
    case = td.load_case(name).replace(changes or {})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", td.ModelWarning)
        return td.run(case)


@pytest.fixture(scope="module")
def results():
    return {name: computed(name) for name in PRESETS}


@pytest.mark.parametrize("name", PRESETS)
def test_preset_is_bundled_and_lists_its_assumptions(name, results):
    case = results[name].case
    assert td.cases()[name] == case.title
    assert case.origin
    assert all(reason for reason in case.assumed.values())
    assert "dynamics.bearing_stiffness" in case.assumed  # no source prints one


@pytest.mark.parametrize("name", PRESETS)
def test_power_is_in_balance(name, results):
    result = results[name]
    assert result.response.stable
    # the drive gives what friction and dampers take, over one period
    assert energy_audit(result.system, result.response).imbalance < 1e-4


@pytest.mark.parametrize("name", PRESETS)
def test_mean_force_without_friction_is_torque_over_base_radius(name):
    result = computed(name, {"friction.law": "none"})
    pair, torque = result.case.gear_pair, result.case.pinion_torque
    figures = result.summary()
    assert figures["mean_mesh_force"] == pytest.approx(torque / pair.pinion.base_radius, rel=1e-6)
    assert figures["mean_friction_power"] == 0.0


@pytest.mark.parametrize(("balance", "balanced"), [("drive", "shaft1"), ("load", "shaft2")])
def test_torques_of_the_shafts(balance, balanced):
    figures = computed("fzg-12dof", {"operation.torque_balance": balance}).summary()
    nominal = {"shaft1": 258.0, "shaft2": 172.0}
    assert figures[f"mean_torque_{balanced}"] == pytest.approx(nominal[balanced], rel=1e-9)
    # what is lost is lost between the shafts: the loss factor of the pair times friction
    ratio = figures["mean_torque_shaft1"] / figures["mean_torque_shaft2"]
    lost = 1.0 - 1.5 / ratio
    assert lost == pytest.approx(0.035 * figures["gear_loss_factor"], rel=0.02)
    power = figures["mean_torque_shaft1"] * 1000.0 * np.pi / 30.0 / 1.5
    assert figures["mean_friction_power"] == pytest.approx(lost * power, rel=0.02)


def test_rig_of_the_case_is_the_benchmark(results):
    result = results["fzg-12dof"]
    assert natural_modes(result.system).frequency[1] == pytest.approx(492.0, abs=1e-3)
    assert result.summary()["mesh_frequency"] == pytest.approx(800.0 / 3.0, rel=1e-12)
    response = result.response
    steps = response.time.size
    benchmark = steady_state(
        fzg12(friction_coefficient=0.035), response.mesh_frequency, steps=steps
    )
    # a third of the cycle to four digits, and the path of contact of the same tips
    for column in ("pinion_v", "pinion_w", "pinion_theta", "shaft1_theta"):
        swing = [np.ptp(r.fine.position[:, r.index(column)]) for r in (response, benchmark)]
        assert swing[0] == pytest.approx(swing[1], rel=5e-3)


def harmonics(name, changes):
    figures = computed(name, changes).summary()
    return np.array([figures[f"dynamic_transmission_error_harmonic_{k}"] for k in range(1, 6)])


def test_fifth_harmonic_is_a_coincidence(results):
    light = [harmonics("fzg-12dof-light", c) for c in ({"friction.law": "none"}, {})]
    change = light[1] / light[0] - 1.0
    # printed: the fifth is the largest, and they change by 2, -27, 16, 27 and 62 %
    assert light[0].argmax() == 4
    np.testing.assert_array_equal(np.sign(change), [1, -1, 1, 1, 1])
    assert change[4] == pytest.approx(0.62, abs=0.02)
    usual = [harmonics("fzg-12dof", c) for c in ({"friction.law": "none"}, {})]
    assert abs(usual[1][4] / usual[0][4] - 1.0) < 0.01
    modes = natural_modes(results["fzg-12dof-light"].system)
    meshing = results["fzg-12dof-light"].summary()["mesh_frequency"]
    assert np.min(np.abs(modes.frequency / (5.0 * meshing) - 1.0)) < 0.0035


@pytest.mark.regression
def test_local_friction_of_the_rig_has_the_measured_mean():
    result = computed("fzg-12dof", {"friction.law": "xu-2007"})
    # the measured one is 0.035; 0.032, weighted with load and sliding, is our own figure
    assert result.summary()["mean_friction_coefficient"] == pytest.approx(0.032, abs=0.006)


def test_friction_varies_and_vanishes_at_the_pitch_point(results):
    mesh = results["time-varying-friction"].mesh
    mu = mesh.friction_coefficient[mesh.in_contact]
    assert mu.min() < 0.05 * mu.max()
    rougher = computed("time-varying-friction", {"gears.composite_roughness": "1.4 um"})
    assert (
        rougher.summary()["mean_friction_coefficient"]
        > 1.3 * results["time-varying-friction"].summary()["mean_friction_coefficient"]
    )
    # friction changes the rms force by less than 1 %, not by the printed 4 to 12.5 %
    plain = computed("time-varying-friction", {"friction.law": "none"}).summary()
    with_friction = results["time-varying-friction"].summary()
    assert abs(with_friction["rms_mesh_force"] / plain["rms_mesh_force"] - 1.0) < 0.01


@pytest.mark.regression
def test_force_without_friction_is_unchanged():
    plain = computed("time-varying-friction", {"friction.law": "none"}).summary()
    assert plain["rms_mesh_force"] == pytest.approx(283.0, abs=2.0)  # our own figure


def test_chaos_over_the_stiffness_is_made_by_the_step():
    pair = td.load_case("fzg-stiffness")
    case = pair.replace({"dynamics.mesh_damping_ratio": None, "dynamics.mesh_damping": "8 N*s/m"})
    ends = ("1.45e7 N/mm", "1.85e7 N/mm")
    options = {"over": "stiffness.mean_stiffness", "between": ends, "points": 5, "cycles": 32,
               "keep": 16}  # fmt: skip
    long = td.bifurcation(case, steps=200, **options)
    # mode of both rotations on a spring, m_e = 0.16986 kg: omega dt = 2.7 at 1.51e7 N/mm
    assert (long.verdict[0] == "step-limited").tolist() == [False, True, True, True, True]
    assert long.step_number[1] == pytest.approx(
        np.sqrt(1.55e10 / 0.16986) / 560.0 / 200.0, rel=0.02
    )
    # printed: one period up to 1.731e7 N/mm, another motion from 1.741e7 N/mm on
    assert (long.period[0] == 1).tolist() == [True, True, True, False, False]
    assert np.all(long.refined_period == 1)
    short = td.bifurcation(case, steps=800, **options)
    assert np.all(short.period == 1)
    assert "step-limited" not in short.verdicts()
    for stiffness in ("1.1e5 N/mm", "1.9e7 N/mm"):
        orbit = computed("fzg-stiffness", {"stiffness.mean_stiffness": stiffness}).response
        assert orbit.period == 1
        assert np.abs(orbit.floquet_multipliers).max() < 0.36
