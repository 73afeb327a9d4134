"""The structure with twelve coordinates as a case: options, figures, force laws, reports."""

from __future__ import annotations

import inspect
import warnings

import numpy as np
import pytest

import tribodyn as td
from tribodyn.dynamics import STRUCTURES, fzg12
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES

RIG_KEYS = [name for name in STRUCTURES["fzg-12dof"].options if name.startswith("shaft")]
RIG = {name: STRUCTURES["fzg-12dof"].options[name] for name in (*RIG_KEYS, "bearing_stiffness")}
SHAFTS = ("shaft1", "shaft2")


@pytest.fixture(scope="module")
def case():
    return td.load_case("fzg-12dof").replace({"solver.steps_per_mesh_cycle": 512})


def computed(case):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", td.ModelWarning)
        return td.run(case)


@pytest.fixture(scope="module")
def result(case):
    return computed(case)


def test_defaults_are_those_of_the_benchmark_rig():
    of = {name: p.default for name, p in inspect.signature(fzg12).parameters.items()}
    for number in (1, 2):
        assert RIG[f"shaft{number}_stiffness"] == of["shaft_stiffness"]
        assert RIG[f"shaft{number}_damping"] == of["shaft_damping"]
        assert RIG[f"shaft{number}_mass"] == of["mass"][3 * (number - 1)]
        inertia = RIG[f"shaft{number}_moment_of_inertia"]
        assert inertia == of["moment_of_inertia"][3 * (number - 1)]
    assert RIG["bearing_stiffness"] == of["bearing_stiffness"]


def test_missing_options_take_the_defaults_and_are_listed(case):
    bare = case.replace(dict.fromkeys((*(f"dynamics.{name}" for name in RIG),)))
    system, full = computed(bare).system, computed(case).system
    np.testing.assert_allclose(system.stiffness, full.stiffness, rtol=1e-12)
    np.testing.assert_allclose(system.mass, full.mass, rtol=1e-12)
    listed = {row.key: row for row in computed(bare).assumptions}
    assert listed["dynamics.shaft1_stiffness"].kind == "default"
    assert listed["dynamics.shaft1_stiffness"].value == "75397.3113 N*m/rad"


def test_written_case_reads_back(case, tmp_path):
    bare = case.replace({"dynamics.shaft1_stiffness": None})
    path = tmp_path / "rig.toml"
    path.write_text(bare.to_toml(), encoding="utf-8")
    assert td.load_case(path) == bare


def test_each_option_reaches_its_place(case):
    changes = {f"dynamics.{name}": 1.25 * RIG[name] for name in RIG_KEYS}
    before, after = computed(case).system, computed(case.replace(changes)).system
    names = list(before.names)
    for shaft, gear in zip(SHAFTS, ("wheel", "pinion"), strict=True):
        disc, other = names.index(f"{shaft}_theta"), names.index(f"{gear}_theta")
        for matrix in ("stiffness", "damping"):
            old, new = getattr(before, matrix), getattr(after, matrix)
            assert new[disc, other] == pytest.approx(1.25 * old[disc, other])
            assert old[disc, other] < 0.0
        assert after.mass[disc, disc] == pytest.approx(1.25 * before.mass[disc, disc])
        across = names.index(f"{shaft}_v")
        assert after.mass[across, across] == pytest.approx(1.25 * before.mass[across, across])
        assert after.mass[other, other] == before.mass[other, other]


def test_ratio_damps_each_support_by_its_own_mass(case):
    changes = {"dynamics.bearing_damping": None, "dynamics.bearing_damping_ratio": 0.03}
    system = computed(case.replace(changes)).system
    for body in ("shaft1", "wheel", "pinion", "shaft2"):
        place = list(system.names).index(f"{body}_w")
        critical = 2.0 * np.sqrt(system.stiffness[place, place] * system.mass[place, place])
        assert system.damping[place, place] == pytest.approx(0.03 * critical)


def test_figures_of_supports_and_shafts(result):
    figures, response = result.summary(), result.response
    assert response.names[:3] == ("shaft1_v", "shaft1_w", "shaft1_theta")
    # the support along the line of action carries the mesh force
    force = 3.5e9 * response.fine.mean(response.fine.position[:, response.index("pinion_w")])
    assert abs(force) == pytest.approx(figures["mean_mesh_force"], rel=1e-6)
    assert figures["rms_bearing_force_loa_pinion"] > figures["rms_bearing_force_oloa_pinion"] > 0.0
    assert figures["mean_torque_shaft1"] == pytest.approx(258.0, rel=1e-9)
    assert figures["bearing_damping_wheel"] == 4000.0


def test_figures_are_drawn_and_the_report_has_them(result):
    from tribodyn.report import render_report

    for name in ("acceleration", "bearing_force", "bearing_spectrum", "spectrum"):
        assert FIGURES[name](result).data
    page = render_report(result)
    assert "Torque, mean, shaft1" in page
    assert "fzg-12dof" in page


@pytest.mark.parametrize("law", ["force-law", "tangent"])
def test_teeth_carry_the_torque_of_the_case(case, law):
    changes = {
        "stiffness.model": "analytic", "dynamics.mesh_law": law, "dynamics.backlash": "0.1 mm",
        "friction.law": "none",
    }  # fmt: skip
    result = computed(case.replace(changes))
    assert len(result.system.contacts) > 1
    figures = result.summary()
    assert figures["mean_mesh_force"] == pytest.approx(figures["static_mesh_force"], rel=1e-5)
    loaded = figures["mean_static_transmission_error"]
    assert figures["mean_dynamic_transmission_error"] == pytest.approx(loaded, rel=0.05)


def test_options_of_another_structure_are_refused_or_left_behind(case):
    spur = case.replace({"dynamics.model": "spur-6dof"})
    assert "dynamics.shaft1_mass" not in spur.user_input
    assert "dynamics.bearing_stiffness" in spur.user_input
    with pytest.raises(InputError, match=r"shaft1_mass.*spur-6dof.*fzg-12dof"):
        spur.replace({"dynamics.shaft1_mass": 2.0})
    with pytest.raises(InputError, match=r"bearing_stiffness.*torsional"):
        spur.replace({"dynamics.model": "torsional", "dynamics.bearing_stiffness": 1e9})
