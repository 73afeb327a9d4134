"""The friction experiment: what is shared changes nothing, and claims follow from the figures."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.cases.papers import friction_experiment as module
from tribodyn.checkpoints import Checkpoints
from tribodyn.study import friction_experiment
from tribodyn.study.studies import sweep as sweeps

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_FEW = {"roughness": ["0.325 um", "0.991 um"], "coefficients": [0.035, 0.05, 0.25]}


@pytest.fixture(scope="module")
def case() -> Any:
    return td.load_case("fzg-roughness")


@pytest.fixture(scope="module")
def experiment(case: Any) -> Any:
    laws = ["constant", "benedict-kelly", "xu-2007", "mixed", "mixed-ehl"]
    return friction_experiment(case, laws=laws, **_FEW)


@pytest.mark.parametrize(
    ("driver", "balance", "friction", "changes"),
    [
        ("pinion", "both", "benedict-kelly 0.991 um",
         {"friction.law": "benedict-kelly", "gears.composite_roughness": "0.991 um"}),
        ("wheel", "load", "constant 0.25",
         {"friction.law": "constant", "friction.coefficient": 0.25,
          "gears.composite_roughness": "0.325 um"}),
        ("wheel", "drive", "mixed 0.325 um",
         {"friction.law": "mixed", "gears.composite_roughness": "0.325 um"}),
    ],
)  # fmt: skip
def test_every_state_is_that_of_a_run_of_its_own(
    case: Any, experiment: Any, driver: str, balance: str, friction: str, changes: dict[str, Any]
) -> None:
    alone = td.run(case.replace(
        {"gears.driver": driver, "operation.torque_balance": balance, **changes}
    )).summary()  # fmt: skip
    place = tuple(
        axis.values.index(value)
        for axis, value in zip(experiment.axes, (driver, balance, friction), strict=True)
    )
    for name in ("rms_mesh_force", "dynamic_transmission_error_harmonic_5",
                 "rms_bearing_force_oloa_pinion", "mean_friction_coefficient"):  # fmt: skip
        assert experiment[name][place] == pytest.approx(alone[name], rel=1e-10)


@pytest.mark.slow
def test_a_solved_film_is_shared_by_all_laws(case: Any) -> None:
    solved = case.replace({"film.model": "newton", "film.positions": 8})
    experiment = friction_experiment(solved, laws=["ehl"], roughness=["0.4 um", "0.8 um"])
    assert [rubbing.name for rubbing in experiment.rubbing] == [
        "none",
        "ehl",
    ]  # no law of roughness
    alone = td.run(solved.replace({"friction.law": "ehl", "gears.driver": "wheel"})).summary()
    assert experiment["mean_friction_power"][1, 2, 1] == pytest.approx(
        alone["mean_friction_power"], rel=1e-12
    )


@pytest.mark.slow
def test_tabled_films_of_helical_teeth_are_sheared_by_the_law_of_each_state() -> None:
    pair = td.load_case("helical-pair").replace(
        {"film.model": "newton", "film.positions": 8, "friction.law": "none"}
    )
    experiment = friction_experiment(pair, laws=["ehl"], roughness=["0.4 um"])
    alone = td.run(pair.replace({"friction.law": "ehl", "gears.composite_roughness": "0.4 um"}))
    place = (("pinion", "wheel").index(pair.gears.driver), 0, experiment.index("ehl"))
    assert experiment["mean_friction_coefficient"][place] == pytest.approx(
        alone.summary()["mean_friction_coefficient"], rel=1e-9
    )


def test_a_law_of_the_film_gets_a_solved_one(case: Any) -> None:
    chosen = module._with_film(case, ("none", "ehl"))
    assert (case.film.model, chosen.film.model) == ("dowson-higginson", "newton")
    assert module._with_film(case, ("none", "xu-2007")).film.model == "dowson-higginson"
    dry = case.replace({"film.model": "none"})
    films = [module._with_film(dry, ("none", law)).film.model for law in ("xu-2007", "mixed")]
    assert films == ["none", "dowson-higginson"]


def test_effects_are_those_of_each_law_at_the_roughness_of_the_case(
    case: Any, experiment: Any
) -> None:
    # 0.325 um is nearer to the 0.53 um of the case than 0.991 um.
    names = [experiment.rubbing[k].name for k in experiment.nearest()]
    assert names[1:] == [f"{law} 0.325 um" for law in ("benedict-kelly", "xu-2007", "mixed",
                                                       "mixed-ehl")]  # fmt: skip
    rows = {row[0]: row[1:] for row in experiment.effect_rows()}
    assert list(rows) == ["none", *names]
    place = (0, 2, experiment.index("mixed"))
    printed = [float(text) for text in rows["mixed 0.325 um"]]
    wanted = [experiment["mean_friction_coefficient"][place], experiment["mean_mesh_force"][place]]
    assert printed[:2] == pytest.approx(wanted, rel=1e-3)
    assert printed[6] == pytest.approx(experiment["rms_bearing_force_oloa_pinion"][place], rel=1e-3)


def test_without_friction_no_setting_differs(experiment: Any) -> None:
    plain = experiment["rms_mesh_force"][:, :, experiment.index("none")]
    for row in plain:  # the torque that is held matters only where friction acts
        assert np.ptp(row) < 1e-9 * row[0]


def test_constant_twins_have_the_mean_of_the_mixed_friction(experiment: Any) -> None:
    for place, rubbing in enumerate(experiment.rubbing):
        if rubbing.as_mixed:
            mixed = experiment.index("mixed-ehl", roughness=rubbing.roughness)
            mu = experiment["mean_friction_coefficient"]
            np.testing.assert_allclose(mu[..., place], mu[..., mixed], rtol=1e-12)


def test_friction_across_is_in_proportion_at_small_coefficients(case: Any) -> None:
    experiment = friction_experiment(case, laws=["constant"], coefficients=[0.002, 0.004])
    across = experiment["rms_bearing_force_oloa_pinion"]
    np.testing.assert_allclose(across[..., 2] / across[..., 1], 2.0, rtol=5e-3)
    effect = experiment.change("mean_mesh_force")
    np.testing.assert_allclose(effect[..., 2] / effect[..., 1], 2.0, rtol=5e-3)


def test_constant_torque_bounds_the_mean_force(experiment: Any) -> None:
    # Both torques held: the mean force lies between those of either torque held alone.
    mean = experiment["mean_mesh_force"][:, :, 1:]
    low, high = mean[:, :2].min(axis=1), mean[:, :2].max(axis=1)
    assert np.all((low < mean[:, 2]) & (mean[:, 2] < high))


def test_claims_follow_from_the_figures(experiment: Any) -> None:
    claims = {claim.case: claim for claim in experiment.claims}
    rough = claims["fzg-roughness"]
    ends = [experiment.index("benedict-kelly", roughness=r * 1e-6) for r in (0.325, 0.991)]
    peak = (
        experiment["peak_mesh_force"][..., ends[1]] / experiment["peak_mesh_force"][..., ends[0]]
        - 1.0
    )
    np.testing.assert_array_equal(rough.holds, [[True] * 3, [False] * 3])  # (driver, held torque)
    assert not np.any(rough.holds & (peak > 0.0))
    assert f"{100.0 * peak[0, 2]:+.2g} %" in rough.computed
    assert rough.where == "pinion drives"
    assert claims["time-varying-friction"].verdict == "fails"
    assert claims["hypoid pair"].verdict == "holds"


def _with_figures(experiment: Any, change: Any) -> Any:
    points = tuple(
        dataclasses.replace(p, figures={**p.figures, **change(p)}) for p in experiment.points
    )
    return dataclasses.replace(experiment, points=points)


def test_verdicts_turn_with_the_figures(experiment: Any) -> None:
    # A fifth harmonic that doubles with friction makes the claim of the rig hold everywhere.
    name = "dynamic_transmission_error_harmonic_5"
    turned = _with_figures(
        experiment, lambda p: {name: p.figures[name] * (1.0 if p.values[2] == "none" else 2.0)}
    )
    assert {c.case: c.verdict for c in experiment.claims}["fzg-12dof"] == "fails"
    claim = {c.case: c for c in turned.claims}["fzg-12dof"]
    assert (claim.verdict, claim.where) == ("holds", "any gear drives and any torque is held")
    # A twin that moves 5 % more than its mixed friction makes that of the hypoid pair fail.
    swing = "peak_to_peak_dynamic_transmission_error"
    turned = _with_figures(
        experiment, lambda p: {swing: p.figures[swing] * (1.05 if " as " in p.values[2] else 1.0)}
    )
    assert {c.case: c.verdict for c in turned.claims}["hypoid pair"] == "fails"


def test_missing_results_are_reported(case: Any) -> None:
    experiment = friction_experiment(case, laws=["xu-2007"], roughness=["0.4 um"])
    assert {claim.verdict for claim in experiment.claims} == {"not computed"}
    assert all(claim.why for claim in experiment.claims)
    with pytest.raises(td.InputError, match="constant"):
        experiment.index("constant")


@pytest.mark.slow
def test_an_experiment_that_ended_early_reports_its_results(
    case: Any, experiment: Any, tmp_path: Any
) -> None:
    lacks = {}
    for count in (1, 3, 40, len(experiment.points)):
        part = dataclasses.replace(experiment, points=experiment.points[:count])
        part.save(tmp_path / str(count))
        names = ("friction_effect", "friction_claims", "friction_harmonics")
        lacks[count] = [bool(td.plot.FIGURES[name].missing(part)) for name in names]
        drawable = [name for name, lack in zip(names, lacks[count], strict=True) if not lack]
        assert all(part.plot(name).layout.title.text for name in drawable)
    assert lacks[1] == [True, True, True]
    assert lacks[3] == [False, True, True]  # drive torque held, as it is not in the case
    assert lacks[len(experiment.points)] == [False, False, False]


def test_a_roughness_beyond_a_law_fails_alone(case: Any) -> None:
    experiment = friction_experiment(case, laws=["benedict-kelly", "xu-2007"],
                                     roughness=["0.4 um", "1.2 um"])  # fmt: skip
    bad = experiment.index("benedict-kelly", roughness=1.2e-6)
    assert all(text for text in experiment.failed[..., bad].flat)
    good = experiment.index("xu-2007", roughness=1.2e-6)
    assert np.isfinite(experiment["rms_mesh_force"][..., good]).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"laws": ["xu-2008"]}, "xu-2007"),
        ({"roughness": "0.4 um"}, "list"),
        ({"roughness": []}, "list"),
        ({"roughness": ["0.4 N"]}, "0.4 N"),
        ({"roughness": ["4 mm"]}, "composite_roughness"),
        ({"laws": ["constant"], "coefficients": [math.nan]}, "coefficient"),
    ],
)
def test_wrong_arguments_are_refused(case: Any, options: dict[str, Any], message: str) -> None:
    if "coefficients" in options:
        experiment = friction_experiment(case, **options)
        assert message in experiment.failed[0, 0, 1]
        return
    with pytest.raises(td.InputError, match=message):
        friction_experiment(case, **options)


@pytest.mark.slow
def test_it_is_stored_and_goes_on(experiment: Any, case: Any, tmp_path: Any) -> None:
    import xarray

    place = experiment.save(tmp_path / "friction")
    data = xarray.open_dataset(place / "sweep.nc")
    assert data["rms_mesh_force"].shape == experiment.shape
    assert list(data["claim_verdict"].values) == [claim.verdict for claim in experiment.claims]
    assert data["composite_roughness"].units == "m"
    rows = (place / "sweep.csv").read_text().splitlines()
    assert len(rows) == 1 + len(experiment.points)
    report = (place / "report.html").read_text()
    assert experiment.claims[3].why.split(";")[0] in report
    requests: list[Any] = []
    options = {"laws": ["xu-2007"], "roughness": ["0.4 um"]}
    with Checkpoints(tmp_path / "m") as members:
        complete = friction_experiment(case, **options, checkpoints=members)
    with Checkpoints(tmp_path / "m") as members, pytest.MonkeyPatch.context() as patch:
        patch.setattr(sweeps, "prepare_run", lambda *a, **k: requests.append(a))
        again = friction_experiment(case, **options, checkpoints=members)
    assert not requests
    assert again.to_csv() == complete.to_csv()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["time-varying-friction", "fzg-roughness"])
def test_a_film_for_a_law_leaves_the_teeth_of_the_case(name: str) -> None:
    case = td.load_case(name)
    roughness = ["0.4 um", "0.53 um"]
    experiment = friction_experiment(case, laws=["ehl", "xu-2007"], roughness=roughness)
    changes = {"friction.law": "xu-2007", "gears.composite_roughness": roughness[1]}
    alone = td.run(case.replace(changes)).summary()
    values = (case["gears.driver"], case["operation.torque_balance"], f"xu-2007 {roughness[1]}")
    place = tuple(
        axis.values.index(value) for axis, value in zip(experiment.axes, values, strict=True)
    )
    for figure in ("rms_mesh_force", "rms_bearing_force_loa_pinion"):
        assert experiment[figure][place] == pytest.approx(alone[figure], rel=1e-10)
