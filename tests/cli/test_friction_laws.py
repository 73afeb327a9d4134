"""The friction laws in case files and on the command line."""

from __future__ import annotations

import json

import numpy as np
import pytest

import tribodyn
from tribodyn.cli import call
from tribodyn.errors import InputError, ModelWarning
from tribodyn.friction import LAWS, pitch_point, schlenk
from tribodyn.study.pipeline.citations import papers
from tribodyn.study.pipeline.tooth_contact import mesh_of

NEW = [
    "exponential", "schlenk", "iso-14179", "iso-6336-22", "niemann", "matsumoto", "drozdov",
    "misharin", "odonoghue-cameron", "mixed-ehl", "measured",
]  # fmt: skip


def case_of(law, **options):
    base = tribodyn.load_case("fzg-roughness").replace({"friction.variant": None})
    return base.replace(
        {"friction.law": law, **{f"friction.{name}": value for name, value in options.items()}}
    )


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("law", NEW)
def test_every_law_runs_in_a_case(law):
    mesh = mesh_of(case_of(law))
    mu = mesh.friction_coefficient[mesh.in_contact]
    assert mesh.friction_law == law
    assert np.all((mu >= 0.0) & (mu < 0.3))
    assert mu.max() > 0.03


def test_mean_law_of_a_case_is_its_formula_at_the_pitch_point():
    case = case_of("schlenk", roughness_ra="0.3 um", lubricant_factor=0.8)
    mesh = mesh_of(case)
    point = pitch_point(case.gear_pair, case.pinion_speed, case.pinion_torque)
    state = (point.load_per_width, point.sum_velocity, point.equivalent_radius)
    wanted = schlenk(*state, 0.082, 0.3e-6, 0.8)
    assert mesh.friction_coefficient[mesh.in_contact] == pytest.approx(wanted, rel=1e-12)


def test_mixed_friction_of_a_case_follows_its_film():
    mesh = mesh_of(case_of("mixed-ehl", ehl_friction_coefficient=0.0))
    ratio = mesh.film_ratio[mesh.in_contact]
    mu = mesh.friction_coefficient[mesh.in_contact]
    order = np.argsort(ratio)
    assert np.ptp(ratio) > 0.05
    assert np.all(np.diff(mu[order]) <= 1e-12)  # the thicker the film, the fewer asperities


def test_a_law_of_the_film_requires_a_film_model():
    case = case_of("mixed-ehl", ehl_friction_coefficient=0.05).replace({"film.model": "none"})
    with pytest.raises(
        InputError, match=r'film_thickness is not known.*model, for example "dowson'
    ):
        mesh_of(case)


def test_measured_points_in_a_case_file_have_units():
    case = case_of(
        "measured",
        measured_torques=["60 N*m", "120 N*m"],
        measured_speeds=["900 rpm", "900 rpm"],
        measured_coefficients=[0.04, 0.08],
    )
    mesh = mesh_of(case)
    wanted = 0.04 * 2.0 ** (np.log(1.5) / np.log(2.0))
    assert mesh.friction_coefficient[mesh.in_contact] == pytest.approx(wanted)
    with pytest.raises(InputError, match="has no unit"):
        case_of("measured", measured_torques=["60", "120 N*m"])


def test_options_of_another_law_are_refused():
    with pytest.raises(InputError, match="roughness_ra"):
        case_of("xu-2007", roughness_ra="0.3 um")


@pytest.mark.parametrize("law", [law for law in NEW if law != "measured"])
def test_citations_of_every_law(law):
    names = [paper["title"] for paper in papers(case_of(law)).values()]
    before = [paper["title"] for paper in papers(case_of("none")).values()]
    assert len(names) >= len(before) + 1


def test_explain_friction_compares_all_laws(capsys):
    assert call(["explain", "friction"]) == 0
    output = capsys.readouterr().out
    table = output[output.index("FZG type A") :]
    for law in LAWS:
        assert f"\n{law}: " in f"\n{output}"
        assert f"  {law} " in table
    assert 'option "coefficient" is missing' in table
    row = next(line.split() for line in table.splitlines() if line.split()[:1] == ["xu-2007"])
    assert row[2] == "0.0000"  # C: nothing slides
    assert row[-1] == "*"  # E: the slide-to-roll ratio is above 1


def test_explain_friction_as_json(capsys):
    assert call(["explain", "friction", "--json"]) == 0
    laws = {law["law"]: law for law in json.loads(capsys.readouterr().out)}
    assert set(laws) == set(LAWS)
    assert len(laws["schlenk"]["coefficients"]) == len(laws["schlenk"]["places"]) == 6
    assert laws["schlenk"]["in_range"] is True
    assert laws["ehl"]["coefficients"] is None
    assert "roughness_ra" in laws["schlenk"]["options"]


def test_explain_a_law_and_its_option(capsys):
    assert call(["explain", "mixed-ehl"]) == 0
    assert "Castro" in capsys.readouterr().out
    assert call(["explain", "lubricant_factor"]) == 0
    assert "polyglycols" in capsys.readouterr().out


def test_warnings_of_a_law_reach_the_case():
    with pytest.warns(ModelWarning, match="misharin"):
        mesh_of(case_of("misharin"))
