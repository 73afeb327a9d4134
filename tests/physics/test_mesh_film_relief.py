"""Films of relieved and crowned pairs against solutions of the very same contacts.

Load, radius and speed of each contact are worked out here from the gear data and the load share
alone, so that a wrong load, unit or place in the mesh table shows.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import solve_line_contact, solve_line_contacts
from tribodyn.errors import ModelWarning
from tribodyn.gear import FlankModification, Material, SpurPair, spur_pair
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import build, film_over_operation
from tribodyn.plot import FIGURES

#: VG 150 at 70 degC.
OIL = Lubricant(0.0325, 861.0, 1.67e-8)
STEEL = Material()
RPM = math.pi / 30.0
NAMES = ("central_film", "minimum_film", "film_pressure", "film_stiffness")
#: Films that hardly fall with the load count as rigid, with a bound on their stiffness. That is so
#: where the stiffness is a thousand times load over film; half of that is compared here.
RIGID = 500.0


def pair(teeth: tuple[int, int] = (25, 57), **modification: Any) -> SpurPair:
    gears = spur_pair(
        pinion_teeth=teeth[0], wheel_teeth=teeth[1], normal_module=3e-3, pinion_face_width=30e-3,
        normal_pressure_angle=math.radians(20.0), pinion_bore_diameter=30e-3,
        wheel_bore_diameter=30e-3,
    )  # fmt: skip
    change = FlankModification(**modification)
    return replace(
        gears,
        pinion=replace(gears.pinion, modification=change),
        wheel=replace(gears.wheel, modification=change),
    )


def table(gears: SpurPair, torque: float = 120.0, rpm: float = 2500.0, **changes: Any) -> Any:
    conditions = {
        "material": STEEL,
        "stiffness_model": "weber",
        "lubricant": OIL,
        "friction_law": "none",
        "composite_roughness": 0.5e-6,
        "film_model": "newton",
    }
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", r"\[film-stiffness\]", ModelWarning)
        return build(
            gears, pinion_speed=rpm * RPM, pinion_torque=torque, **{**conditions, **changes}
        )


@cache
def relieved(kind: str = "approach") -> Any:
    return table(pair(tip_relief=10e-6), film_options={"stiffness": kind})


def contact(mesh: Any, place: tuple[Any, Any]) -> tuple[Any, Any, Any, float]:
    """Load per width, radius, entrainment speed and modulus by hand."""
    gears = mesh.gear_pair
    pinion = mesh.path[place]
    base = (
        0.5
        * 3e-3
        * math.cos(math.radians(20.0))
        * np.array([gears.pinion.teeth, gears.wheel.teeth])
    )
    wheel = base.sum() * math.tan(math.radians(20.0)) - pinion
    speed = 0.5 * mesh.pinion_speed * (pinion + wheel * base[0] / base[1])
    load = mesh.load_share[place] * mesh.pinion_torque / base[0] / 30e-3
    modulus = STEEL.youngs_modulus / (1.0 - STEEL.poissons_ratio**2)
    return load, pinion * wheel / (pinion + wheel), speed, modulus


def deviations(mesh: Any, places: np.ndarray) -> dict[str, np.ndarray]:
    """Films of the table over those solved in the same places, less one."""
    index = tuple(places.T)
    load, radius, speed, modulus = contact(mesh, index)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        films = solve_line_contacts(
            load, radius, speed, OIL, modulus, nodes=513, length=30e-3, keep_solutions=True,
            stiffness="tangent" if mesh.film_stiffness_kind == "tangent" else "approach",
        )  # fmt: skip
    pressure = np.array([solution.pressure.max() for solution in films.solutions])
    solved = (films.central_film, films.minimum_film, pressure, films.film_stiffness)
    errors = {}
    for name, values in zip(NAMES, solved, strict=True):
        error = getattr(mesh, name)[index] / values - 1.0
        if name == "film_stiffness":
            error = error[(values > 0.0) & (values < RIGID * 30e-3 * load / films.central_film)]
        errors[name] = error[np.isfinite(error)]
    return errors


def touching(mesh: Any) -> np.ndarray:
    return np.argwhere(mesh.in_contact & (mesh.load_share > 1e-3))


def test_relieved_flanks_have_the_pressure_of_their_contacts() -> None:
    mesh = relieved()
    place = np.unravel_index(np.nanargmax(mesh.film_pressure), mesh.film_pressure.shape)
    load, radius, speed, modulus = contact(mesh, place)
    direct = solve_line_contact(load, radius, speed, OIL, modulus, nodes=513)
    assert mesh.film_pressure[place] == pytest.approx(direct.pressure.max(), rel=0.02)
    assert 0.7e9 < mesh.film_pressure[place] < 0.8e9
    assert 0.7e9 < mesh.hertz_pressure.max() < 0.75e9
    for name in ("central_film", "minimum_film"):
        column = np.where(mesh.in_contact, getattr(mesh, name), np.nan)
        least = np.unravel_index(np.nanargmin(column), column.shape)
        load, radius, speed, modulus = contact(mesh, least)
        direct = solve_line_contact(load, radius, speed, OIL, modulus, nodes=513)
        assert column[least] == pytest.approx(getattr(direct, name), rel=2e-3)


def test_relieved_flanks_have_the_films_of_their_contacts_everywhere() -> None:
    mesh = relieved()
    errors = deviations(mesh, touching(mesh)[::9])
    assert all(error.size > 100 for error in errors.values())
    for name, error in errors.items():
        assert np.abs(error).max() < 0.02, name


def test_positions_follow_the_load_without_a_warning(recwarn: pytest.WarningsRecorder) -> None:
    table(pair(tip_relief=10e-6), film_options={"positions": 8})
    assert not [warning for warning in recwarn if "film-positions" in str(warning.message)]


def test_pairs_that_do_not_touch_have_no_film() -> None:
    mesh = relieved("none")
    separated = mesh.in_contact & (mesh.load_share < 1e-3)
    assert separated.sum() > 100
    for name in (*NAMES, "film_ratio"):
        column = getattr(mesh, name)
        assert np.all(np.isnan(column[separated]))
        assert np.all(np.isfinite(column[mesh.in_contact & ~separated]))
        assert np.all(column[~mesh.in_contact] == 0.0)


def test_figures_leave_out_pairs_that_do_not_touch() -> None:
    mesh = relieved("none")
    for name in ("film", "film_pressure", "film_stiffness"):
        figure = FIGURES[name](mesh)
        assert "nan" not in figure.layout.title.text
        assert np.isnan(np.array(figure.data[0].y, dtype=float)).sum() > 100
    assert "reaches 0.7" in FIGURES["film_pressure"](mesh).layout.title.text
    # a pair that is about to leave contact has a film of 50 um: the others must still be seen
    assert FIGURES["film"](mesh).layout.yaxis.type == "log"


def test_films_over_operation_leave_them_out_too() -> None:
    films = film_over_operation(
        pair(tip_relief=10e-6), material=STEEL, stiffness_model="weber", lubricant=OIL,
        film_model="newton", pinion_speed=[261.8], pinion_torque=[120.0, 400.0],
    )  # fmt: skip
    separated = np.isnan(films.central_film[:, 0])
    assert np.all(separated[:, [0, -1]][0])
    assert separated[0].sum() >= separated[1].sum()
    assert np.nanmin(films.central_film) == pytest.approx(4e-7, rel=0.2)


def test_too_few_positions_leave_films_out_with_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    import tribodyn.mesh.film.film_refinement as refinement

    monkeypatch.setattr(refinement, "MOST_ADDED", 40)
    with pytest.warns(
        ModelWarning, match=r"film-positions.*at \d+ of \d+ contacts.*film"
    ) as caught:
        mesh = table(pair(tip_relief=10e-6), film_options={"stiffness": "none", "positions": 8})
    assert sum("film-positions" in str(warning.message) for warning in caught) == 1
    left_out = np.isnan(mesh.film_stiffness) & (mesh.load_share > 1e-3)
    assert left_out.any()
    places = touching(mesh)[::9]
    assert np.abs(deviations(mesh, places)["film_pressure"]).max() < 0.02


def test_flanks_separated_by_relief_are_carried_by_their_film() -> None:
    """A film as thick as the gap carries what keeps it there, at every place of the path."""
    mesh, dry = relieved(), relieved("none")
    separated = mesh.in_contact & (dry.load_share == 0.0)
    assert separated.sum() > 100
    assert np.all((mesh.load_share[separated] > 1e-3) & (mesh.load_share[separated] < 0.06))
    assert mesh.central_film[separated].max() < 10e-6
    assert np.all(mesh.film_stiffness[separated] > 0.0)


@pytest.mark.slow
def test_the_approach_is_smooth_whatever_the_positions() -> None:
    """No kink beyond those of the dry flanks, and no warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", ModelWarning)
        mesh = table(
            pair(tip_relief=10e-6), film_options={"positions": 30},
            stiffness_model="analytic",
        )  # fmt: skip
    dry = table(pair(tip_relief=10e-6), film_model="none", stiffness_model="analytic")
    error, rigid = mesh.static_transmission_error, dry.static_transmission_error
    assert np.ptp(error) == pytest.approx(np.ptp(relieved_analytic()), rel=1e-3)
    assert np.ptp(error) == pytest.approx(np.ptp(rigid), rel=0.05)
    assert np.abs(np.diff(error)).max() < 1.2 * np.abs(np.diff(rigid)).max()
    # at A and E a tip corner takes over what the pair on the path carried
    inside = np.diff(mesh.phase) > 0.0
    steps = [np.abs(np.diff(each.load_share, axis=0)[inside]).max() for each in (mesh, dry)]
    assert steps[0] < 1.2 * steps[1]


@cache
def relieved_analytic() -> Any:
    options = {"positions": 120}
    mesh = table(pair(tip_relief=10e-6), film_options=options, stiffness_model="analytic")
    return mesh.static_transmission_error


@pytest.mark.slow
@pytest.mark.parametrize("positions", [30, 200])
def test_the_film_in_series_with_relief_does_not_depend_on_the_positions(positions: int) -> None:
    mesh = table(
        pair(tip_relief=10e-6), film_options={"stiffness": "tangent", "positions": positions}
    )
    assert np.ptp(mesh.static_transmission_error) == pytest.approx(SERIES_PEAK, rel=5e-3)
    assert mesh.load_share.sum(axis=1) == pytest.approx(1.0, abs=1e-7)
    errors = deviations(mesh, touching(mesh)[::31])
    for name, error in errors.items():
        assert np.abs(error).max() < 0.02, name


#: Peak to peak of the transmission error of that pair with the film in series [m].
SERIES_PEAK = 2.577e-6


def random_mesh(seed: int) -> Any:
    random = np.random.default_rng(seed)
    teeth = (int(random.integers(19, 40)), int(random.integers(40, 80)))
    gears = pair(
        teeth,
        tip_relief=float(random.uniform(0.0, 25e-6)),
        root_relief=float(random.choice([0.0, 8e-6])),
        profile_crowning=float(random.choice([0.0, 6e-6])),
        crowning=float(random.choice([0.0, 5e-6])),
        tip_relief_shape=str(random.choice(["linear", "parabolic"])),
    )
    return table(
        gears, float(random.uniform(40.0, 400.0)), float(random.uniform(300.0, 6000.0)),
        film_options={"positions": int(random.integers(8, 60))},
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_random_modified_pairs_have_the_films_of_their_contacts(seed: int) -> None:
    mesh = random_mesh(seed)
    places = touching(mesh)
    some = np.random.default_rng(seed).choice(places, 40, replace=False)
    errors = deviations(mesh, some)
    assert errors["central_film"].size > 30
    for name, error in errors.items():
        assert np.abs(error).max(initial=0.0) < 0.02, name
