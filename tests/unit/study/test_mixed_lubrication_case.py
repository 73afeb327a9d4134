"""Mixed lubrication as a user meets it: case file, check, columns, summary words, figures."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.friction import LAWS
from tribodyn.mesh import MeshTable
from tribodyn.mesh.grid import PhaseFunction
from tribodyn.plot import FIGURES
from tribodyn.study.pipeline.cautions import mesh_cautions
from tribodyn.study.pipeline.response_series import mesh_force, one_sided_phase, signals
from tribodyn.study.pipeline.run import rehearse
from tribodyn.study.pipeline.tooth_contact import mesh_of

_CASE = """
[gears]
normal_module = "3 mm"
normal_pressure_angle = "20 deg"
driver = "pinion"
[gears.pinion]
teeth = 25
face_width = "30 mm"
roughness_ra = "0.4 um"
[gears.wheel]
teeth = 57
roughness_ra = "0.4 um"
[operation]
speed = "2500 rpm"
torque = "120 N*m"
[lubricant]
name = "ISO VG 150"
temperature = "70 degC"
[film]
model = "dowson-higginson"
[stiffness]
model = "rectangular"
pair_stiffness = "400 N/um"
[friction]
law = "mixed"
[dynamics]
model = "torsional"
"""


def case_of(folder: Path, **friction: str) -> Any:
    path = folder / "gear.toml"
    more = "".join(f"{key} = {value}\n" for key, value in friction.items())
    path.write_text(_CASE.replace("[dynamics]", f"{more}[dynamics]"), "utf-8")
    return td.load_case(path)


def profile(folder: Path, rows: str) -> str:
    (folder / "flank.csv").write_text(rows, "utf-8")
    return '"flank.csv"'


def wavy(height: float) -> str:
    """Points of a profile of Gaussian heights [um], smoothed over some micrometres."""
    random = np.random.default_rng(3)
    smooth = np.convolve(random.standard_normal(4100), np.hanning(20), mode="valid")
    smooth *= height / np.std(smooth)
    rows = "\n".join(f"{i * 1e-3:.6f},{z:.6f}" for i, z in enumerate(smooth))
    return f"# a flank\nposition,height\nmm,um\n{rows}\n"


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> MeshTable:
    with pytest.warns(td.ModelWarning, match="xu-2007"):
        return mesh_of(case_of(tmp_path_factory.mktemp("case")))


def test_a_normal_gear_has_friction_between_film_and_gear_tests(mesh: MeshTable) -> None:
    assert mesh.mean_friction_coefficient == pytest.approx(0.033, abs=1e-3)
    share = np.asarray(mesh.film_load_share)[mesh.in_contact]
    regime = np.asarray(mesh.lubrication_regime)
    assert np.all((share > 0.8) & (share < 1.0))
    assert set(regime[mesh.in_contact]) == {1.0}
    assert np.isnan(regime[~mesh.in_contact]).all()
    (mixed_caution,) = (
        caution for caution in mesh_cautions(mesh) if caution.code == "mixed-lubrication"
    )
    assert "and so is the friction" not in mixed_caution.message


def test_columns_of_mixed_lubrication_are_stored(mesh: MeshTable, tmp_path: Path) -> None:
    again = MeshTable.load(mesh.save(tmp_path / "mesh.nc"))
    assert again == mesh
    assert "lubrication_regime" in mesh.to_xarray()


def test_laws_without_asperities_have_the_share_of_the_film_ratio(tmp_path: Path) -> None:
    case = case_of(tmp_path).replace({"friction.law": "constant", "friction.coefficient": 0.05})
    table = mesh_of(case)
    ratio = np.asarray(table.film_ratio)[table.in_contact]
    wanted = 1.21 * ratio**0.64 / (1.0 + 0.37 * ratio**1.26)
    assert np.asarray(table.film_load_share)[table.in_contact] == pytest.approx(wanted)
    assert table.asperity_friction_coefficient is None
    assert table.mean_asperity_friction_coefficient is None
    panels = FIGURES["lubrication"](table)
    assert "yaxis3" not in panels.layout.to_plotly_json()


def test_figure_shows_shares_and_parts_of_the_friction(mesh: MeshTable) -> None:
    figure = mesh.plot_lubrication()
    assert figure.layout.title.text == "Mixed lubrication: the oil film carries at least 85.1 %"
    curves = {(curve.name, curve.yaxis): np.asarray(curve.y) for curve in figure.data}
    assert curves["oil film", "y2"] + curves["asperities", "y2"] == pytest.approx(1.0)
    parts = curves["oil film", "y3"] + curves["asperities", "y3"]
    assert parts == pytest.approx(curves["total", "y3"])
    assert {note.text for note in figure.layout.annotations} >= {"boundary", "mixed", "full film"}


def test_figure_without_film_names_the_key(tmp_path: Path) -> None:
    case = case_of(tmp_path).replace({"friction.law": "none", "film.model": "none"})
    with pytest.raises(td.InputError, match=r"no film ratio.*film\.model"):
        mesh_of(case).plot_lubrication()


def test_map_of_the_regimes(tmp_path: Path) -> None:
    case = case_of(tmp_path).replace({"film.model": "moes"})
    films = td.film_over_operation(case, torque=[20.0, 200.0], speed=[20.0, 200.0, 2000.0])
    figure = films.plot_lubrication_map()
    least = np.nanmin(films.film_ratio, axis=2)
    np.testing.assert_allclose(figure.data[0].z, least)
    assert [curve.name for curve in figure.data[:3]] == [
        "boundary, below 0.2", "mixed, 0.2 to 2", "full film, from 2 on",
    ]  # fmt: skip
    with pytest.raises(td.InputError, match="several torques and speeds"):
        td.film_over_operation(case, torque=20.0, speed=[20.0, 200.0]).plot_lubrication_map()


def test_profile_gives_height_slope_and_summits(tmp_path: Path) -> None:
    path = profile(tmp_path, wavy(0.5))
    with pytest.warns(td.ModelWarning, match="xu-2007"):
        mesh = mesh_of(case_of(tmp_path, roughness_profile=path))
    flanks = td.ehl.Asperities.from_profiles(td.ehl.RoughnessProfile.read(tmp_path / "flank.csv"))
    # Both flanks of 0.5 um; their straight line is taken away.
    assert flanks.rms_height == pytest.approx(0.7071e-6, rel=5e-3)
    share, _ = td.ehl.balanced_load_share(
        np.asarray(mesh.central_film)[mesh.in_contact],
        mesh.hertz_pressure[mesh.in_contact],
        2.0 / (2.0 * (1.0 - 0.3**2) / 206e9),
        flanks,
    )
    assert np.asarray(mesh.film_load_share)[mesh.in_contact] == pytest.approx(share, rel=1e-9)


def test_profile_of_another_height_is_reported(tmp_path: Path) -> None:
    path = profile(tmp_path, wavy(0.3))
    with pytest.warns(td.ModelWarning) as caught:
        mesh_of(case_of(tmp_path, roughness_profile=path))
    (message,) = (str(each.message) for each in caught if "roughness-differs" in str(each.message))
    assert "composite rms roughness of 0.4227 um" in message
    assert 'roughness_rms = "0.2989 um"' in message


@pytest.mark.parametrize(
    ("friction", "rows", "says"),
    [
        ({"rms_slope": "0.6", "summit_density": '"1000 1/mm^2"'}, "", r"rms_slope: m0 m4/m2\^2"),
        ({"rms_slope": "0"}, "", r"rms_slope = 0\. Allowed: 0.005 to 2"),
        ({"roughness_profile": '"absent.csv"'}, "", "there is no such file"),
        ({}, "position,height\nmm,um\n0,0\n1,1\n2,0\n", "3 heights and 3 positions"),
        ({}, "position,height\nmm,um\n0,0\n1,high\n", '"1,high" is not a position.*line 4'),
        ({}, "position,height\nmm,kg\n0,0\n", "kg.*line 2"),
        ({}, "z\num\n0\n", "columns are not position and height"),
        ({}, "", "columns are not position and height"),
        ({}, "position,height\nmm,um\n" + "".join(f"{i},0\n" for i in range(9)), "without rough"),
        ({}, "position,height\nmm,um\n" + "".join(f"{i * i},{i}\n" for i in range(9)), "equal"),
    ],
)
def test_wrong_asperities_are_reported_by_check(
    tmp_path: Path, friction: dict[str, str], rows: str, says: str
) -> None:
    friction = friction or {"roughness_profile": profile(tmp_path, rows)}
    with pytest.raises(td.InputError, match=rf"friction\.(?s:.*){says}"):
        rehearse(case_of(tmp_path, **friction))


@pytest.mark.parametrize("law", [name for name in LAWS if name != "constant"])
def test_check_refuses_a_law_for_its_film_only_where_there_is_none(
    tmp_path: Path, law: str
) -> None:
    film = "newton" if LAWS[law].needs_film else "dowson-higginson"
    needs = LAWS[law].needs_film or law in ("mixed", "mixed-ehl", "matsumoto")
    refused = []
    for model in (film, "none"):
        try:
            rehearse(case_of(tmp_path).replace({"friction.law": law, "film.model": model}))
            refused.append(False)
        except td.InputError:
            refused.append(True)
    assert refused == [False, needs]


def test_smooth_flanks_have_no_asperities(tmp_path: Path) -> None:
    smooth = {f"gears.{gear}.roughness_ra": "0 um" for gear in ("pinion", "wheel")}
    with pytest.warns(td.ModelWarning, match="xu-2007"):
        mesh = mesh_of(case_of(tmp_path).replace(smooth))
    assert mesh.film_ratio is None
    assert mesh.lubrication_regime is None
    assert np.all(np.asarray(mesh.film_load_share)[mesh.in_contact] == 1.0)
    assert mesh.mean_asperity_friction_coefficient == 0.0


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("load", ["nominal", "dynamic"])
def test_friction_force_of_the_motion_is_that_of_film_and_asperities(
    load: str, tmp_path: Path
) -> None:
    case = case_of(tmp_path).replace({"dynamics.friction_load": load})
    result = td.run(case)
    fine = result.response.fine
    computed, force = signals(result, fine), mesh_force(fine)
    names = ("friction_force", "film_friction_force", "asperity_friction_force")
    total, film, metal = (computed[name][0] for name in names)
    np.testing.assert_allclose(film + metal, total, atol=1e-12 * np.abs(total).max())
    # Pair by pair, as the law itself has it: nothing of it comes from the sum of both.
    mesh, phase = result.mesh, one_sided_phase(fine)
    pairs = mesh.sliding_direction * mesh.asperity_friction_coefficient * mesh.load_share
    wanted = PhaseFunction(mesh.grid, pairs)(phase).sum(axis=1) * force
    deviation = np.abs(metal - wanted).max() / np.abs(metal).max()
    if load == "nominal":
        assert deviation < 1e-9
        directions = np.zeros((*mesh.path.shape, 6))
        directions[:, :, 0] = mesh.sliding_direction
        table = dataclasses.replace(mesh, friction_direction=directions)
        np.testing.assert_allclose(table.asperity_friction_sum, mesh.asperity_friction_sum)
    else:  # the share of the asperities grows with the momentary load, by the whole law
        assert 1e-3 < deviation < 0.2
        heavy = mesh_of(case, load=1.3)
        name, places = "asperity_friction_sum", np.linspace(0.003, 0.993, 200)
        value = result.friction.value(name, places, np.full(200, heavy.total_normal_force))
        np.testing.assert_allclose(value, heavy.at(name, places), atol=5e-3 * np.abs(value).max())
    figures = result.summary()
    for name, signal in (("film", film), ("asperity", metal)):
        rms = float(np.sqrt(np.sum(fine.weight * signal**2) / fine.weight.sum()))
        assert figures[f"rms_{name}_friction_force"] == pytest.approx(rms, rel=1e-6)
    assert [trace.name for trace in result.plot_friction_force().data] == [
        "total", "oil films", "asperities"
    ]  # fmt: skip
    if load == "dynamic":
        again = td.load_result(result.save(tmp_path / "r"))
        assert again.friction.splits
        assert again.summary() == figures
