"""Friction that follows the dynamic load, by the case: power balance, comparison, bad input."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest

import tribodyn
from tribodyn.errors import InputError, ModelWarning
from tribodyn.study.pipeline.cautions import friction_cautions

DYNAMIC = {"dynamics.friction_load": "dynamic"}


def _run(**changes):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        case = tribodyn.load_case("fzg-roughness")
        return tribodyn.run(case.replace({key.replace("__", "."): v for key, v in changes.items()}))


def test_a_constant_coefficient_changes_nothing():
    # Pairs of equal stiffness, so that their load shares stay too.
    constant = {"friction__law": "constant", "friction__coefficient": 0.08}
    constant |= {"stiffness__model": "rectangular", "stiffness__pair_stiffness": "2e8 N/m"}
    figures = _run(**constant, dynamics__friction_load="dynamic").summary()
    compared = [name for name in figures if name.endswith("_nominal_friction")]
    assert len(compared) == 5
    for name in compared:
        nominal = figures[name.removesuffix("_nominal_friction")]
        assert nominal == pytest.approx(figures[name], rel=1e-6)


@pytest.mark.parametrize("model", ["spur-6dof", "torsional", "fzg-12dof"])
def test_the_torque_that_friction_takes_is_the_power_that_it_loses(model):
    structure = {"dynamics__model": model, "operation__torque_balance": "drive"}
    if model == "torsional":
        structure |= {"dynamics__bearing_stiffness": None, "dynamics__bearing_damping": None}
    result = _run(friction__law="xu-2007", dynamics__friction_load="dynamic", **structure)
    figures = result.summary()
    extra = result.response.extra_force
    speed = result.mesh.pinion_speed / result.case.gear_pair.ratio
    lost = float(np.abs(extra).max()) * speed
    assert lost == pytest.approx(figures["mean_friction_power"], rel=2e-5)
    # The load matters by less than a hundredth here, which is far more than the balance allows.
    nominal = figures["mean_friction_power_nominal_friction"]
    assert 2e-4 < abs(lost / nominal - 1.0) < 1e-2


def test_the_comparison_is_the_run_with_nominal_friction():
    law = {"friction__law": "xu-2007"}
    dynamic, nominal = (
        _run(**law, dynamics__friction_load="dynamic").summary(),
        _run(**law).summary(),
    )
    for name in ("rms_mesh_force", "rms_friction_force", "mean_friction_power"):
        assert dynamic[f"{name}_nominal_friction"] == pytest.approx(nominal[name], rel=1e-9)
        assert f"{name}_nominal_friction" not in nominal
    assert dynamic["friction_fit_error"] < 5e-3


def test_loads_beyond_the_table_are_reported():
    friction = SimpleNamespace(load=100.0, limit=3.0)
    force = np.zeros(24)
    force[3] = -480.0
    (warning,) = friction_cautions(friction, force)
    assert warning.code == "friction-load"
    assert "4.8 times their nominal load of 100 N" in str(warning)
    assert friction_cautions(SimpleNamespace(load=100.0, limit=5.0), force) == ()


def test_without_friction_nothing_follows():
    case = tribodyn.load_case("fzg-roughness")
    with pytest.raises(InputError, match="without friction"):
        case.replace({"friction.law": "none", **DYNAMIC})


def test_light_loads_that_have_no_film_are_left_out(monkeypatch):
    from tribodyn.errors import ComputationError
    from tribodyn.study.mesh_inputs import mesh_inputs
    from tribodyn.study.pipeline import tooth_contact

    case = tribodyn.load_case("fzg-roughness").replace({**DYNAMIC, "friction.law": "xu-2007"})
    plain, refused = tooth_contact.mesh_table, []
    inputs = mesh_inputs(case)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        nominal = plain(inputs)
        friction_of_all = tooth_contact.load_friction_of(inputs, nominal)

        def mesh_table(inputs, *, load, **_):
            if load in refused:
                raise ComputationError("the film is softer than the teeth")
            return plain(inputs, load=load)

        monkeypatch.setattr(tooth_contact, "mesh_table", mesh_table)
        refused.append(0.12)
        friction = tooth_contact.load_friction_of(inputs, nominal)
        refused.append(2.05)
        with pytest.raises(ComputationError):
            tooth_contact.load_friction_of(inputs, nominal)
    force = 1.2 * nominal.total_normal_force
    assert friction.value("friction_sum", 0.3, force) == pytest.approx(
        friction_of_all.value("friction_sum", 0.3, force), rel=1e-3
    )
