"""Solved films of a mesh cycle: between the positions, in series with the teeth, over operation."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.contact import path_of_contact
from tribodyn.ehl import FILM_MODELS, FilmState
from tribodyn.errors import ComputationError, InputError, ModelWarning
from tribodyn.friction import LAWS, pitch_point
from tribodyn.gear import BasicRack, FlankModification, Material, SpurPair, spur_pair
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import build, film_columns, film_over_operation
from tribodyn.mesh.cycle import mesh_cycle, pairs_in_contact
from tribodyn.mesh.loads import tribological_contact
from tribodyn.stiffness import loaded_contact

OIL = Lubricant(0.082, 880.0, 2.19e-8)
STEEL = Material(youngs_modulus=200.2e9)
RPM = math.pi / 30.0


def fzg(driver: str) -> SpurPair:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return spur_pair(
            pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3, center_distance=91.5e-3,
            normal_pressure_angle=math.radians(20.0), pinion_face_width=20e-3, driver=driver,
            pinion_profile_shift_coefficient=0.8532, wheel_profile_shift_coefficient=-0.5,
            pinion_bore_diameter=30e-3, wheel_bore_diameter=30e-3,
        )  # fmt: skip


def high_contact_ratio() -> SpurPair:
    rack = BasicRack(1.4, 1.65, 0.2)
    return spur_pair(
        pinion_teeth=45, wheel_teeth=60, normal_module=3e-3, pinion_face_width=30e-3,
        normal_pressure_angle=math.radians(20.0), pinion_bore_diameter=60e-3,
        wheel_bore_diameter=60e-3, pinion_rack=rack, wheel_rack=rack,
    )  # fmt: skip


PITCH = pitch_point(fzg("pinion"), 900.0 * RPM, 100.0)
PAIRS = {
    "pinion drives": (fzg("pinion"), 100.0),
    "wheel drives": (fzg("wheel"), 100.0),
    "contact ratio above two": (high_contact_ratio(), 1200.0),
}


def table(name: str = "pinion drives", **changes: Any) -> Any:
    pair, torque = PAIRS[name]
    pair = changes.pop("pair", pair)
    conditions = {
        "material": STEEL,
        "lubricant": OIL,
        "friction_law": "none",
        "composite_roughness": 0.5e-6,
        "film_model": "newton",
        "pinion_speed": 2100.0 * RPM,
        "pinion_torque": torque,
        "steps": 32,
    }
    return build(pair, **{**conditions, **changes})


@cache
def with_film(stiffness: str = "approach", name: str = "pinion drives") -> Any:
    """Table that several tests look at."""
    return table(name, film_options={"stiffness": stiffness})


def touching(mesh: Any) -> Any:
    cycle = mesh_cycle(path_of_contact(mesh.gear_pair), 32)
    motion = cycle.motion(mesh.pinion_speed)
    return pairs_in_contact(cycle, motion, OIL, STEEL), motion


@pytest.mark.parametrize("name", PAIRS)
def test_films_between_the_positions_are_those_solved_at_the_knots(name: str) -> None:
    mesh = with_film("tangent", name)
    in_contact = mesh.in_contact
    loads = mesh.load_per_width[in_contact]
    direct = touching(mesh)[0].films("newton", loads, stiffness="tangent")
    assert mesh.central_film[in_contact] == pytest.approx(direct.central_film, rel=5e-5)
    assert mesh.minimum_film[in_contact] == pytest.approx(direct.minimum_film, rel=3e-4)
    # the tangent moves with the node of the outlet, the spike with every node
    assert mesh.film_stiffness[in_contact] == pytest.approx(direct.film_stiffness, rel=4e-2)
    assert mesh.film_pressure[in_contact] == pytest.approx(direct.film_pressure, rel=0.15)
    assert np.all(mesh.film_pressure[in_contact] > 0.9 * mesh.hertz_pressure[in_contact])


def test_more_positions_are_nearer_to_the_knots() -> None:
    mesh = with_film()
    direct = touching(mesh)[0].films("newton", mesh.load_per_width[mesh.in_contact])
    errors = [
        np.abs(
            table(film_options={"positions": count}).central_film[mesh.in_contact]
            / direct.central_film
            - 1.0
        ).max()
        for count in (16, 40)
    ]
    assert errors[1] < 0.5 * errors[0]


def test_film_columns_solve_every_contact() -> None:
    mesh = with_film()
    contacts, motion = touching(mesh)
    some = slice(0, 3)
    motion = replace(motion, **{name: getattr(motion, name)[some] for name in vars(motion)})
    loads = mesh.load_per_width[mesh.in_contact][some]
    films = contacts.films("none", loads)
    contact = tribological_contact(motion, contacts, loads, 0.5e-6, PITCH, films)
    columns = film_columns("newton", contact, STEEL, OIL, common_face_width=20e-3)
    assert set(columns) == {
        "central_film", "minimum_film", "film_ratio", "film_pressure", "film_stiffness"
    }  # fmt: skip
    expected = mesh.central_film[mesh.in_contact][some]
    assert columns["central_film"] == pytest.approx(expected, rel=5e-5)


@pytest.mark.parametrize("kind", ["tangent", "secant"])
def test_the_film_in_series_is_solved_at_the_share_that_it_makes(kind: str) -> None:
    mesh = with_film(kind)
    in_contact = mesh.in_contact
    # films solved anew at the final loads give the stiffness that is in series
    direct = touching(mesh)[0].films("newton", mesh.load_per_width[in_contact], stiffness=kind)
    tolerance = 4e-2 if kind == "tangent" else 5e-3
    assert mesh.film_stiffness[in_contact] == pytest.approx(direct.film_stiffness, rel=tolerance)
    again = 1.0 / (1.0 / mesh.tooth_stiffness[in_contact] + 1.0 / mesh.film_stiffness[in_contact])
    assert mesh.stiffness[in_contact] == pytest.approx(again, rel=1e-12)
    share = mesh.stiffness / mesh.stiffness.sum(axis=1, keepdims=True)
    assert np.abs(mesh.load_share - share).max() < 1e-6


@pytest.mark.slow
def test_kinds_of_stiffness_keep_their_order() -> None:
    # the film falls with a tenth power of the load, which is what tangent and secant differ by
    stiffness = {
        kind: with_film(kind).at_pitch_point("film_stiffness")
        for kind in ("none", "approach", "tangent", "secant")
    }
    assert stiffness["none"] == pytest.approx(stiffness["approach"], rel=0.02)
    assert stiffness["approach"] == pytest.approx(stiffness["tangent"], rel=0.15)
    assert 6.0 < stiffness["tangent"] / stiffness["secant"] < 14.0
    assert 5e9 < stiffness["tangent"] < 4e10


def test_the_printed_sum_doubles_with_the_grid_and_warns() -> None:
    sums = []
    for nodes in (257, 513):
        with pytest.warns(ModelWarning, match="seed-film-stiffness"):
            films = FILM_MODELS["newton"].films(
                147802.0, 8e-3, 3.0722, OIL, 2.2e11, length=0.02, stiffness="seed", nodes=nodes
            )
        sums.append(float(films.film_stiffness))
    assert sums[1] / sums[0] == pytest.approx(2.0, rel=0.02)


def test_multigrid_finds_the_same_mesh_cycle() -> None:
    newton, multigrid = with_film(), table(film_model="multigrid")
    in_contact = newton.in_contact
    assert multigrid.central_film[in_contact] == pytest.approx(
        newton.central_film[in_contact], rel=3e-4
    )
    assert multigrid.film_model == "multigrid"


@pytest.mark.filterwarnings(r"ignore:\[film-stiffness\]")
def test_a_starved_inlet_thins_the_film_and_more_so_at_light_load() -> None:
    starved = {"inlet": "zero", "domain": (-2.5, 1.5)}
    loss = []
    for torque in (100.0, 250.0):
        flooded = table(pinion_torque=torque).at_pitch_point("central_film")
        thin = table(pinion_torque=torque, film_options=starved).at_pitch_point("central_film")
        loss.append(1.0 - thin / flooded)
    assert 0.05 < loss[1] < loss[0] < 0.6


def test_a_film_that_rises_with_the_load_counts_as_rigid_and_is_reported() -> None:
    with pytest.warns(ModelWarning, match=r"film-stiffness.*counts as rigid"):
        mesh = table("wheel drives", pinion_torque=33.0, film_options={"stiffness": "tangent"})
    in_contact = mesh.in_contact
    assert np.all(mesh.film_stiffness[in_contact] > 0.0)
    assert np.all(mesh.stiffness[in_contact] <= mesh.tooth_stiffness[in_contact])
    rigid = mesh.film_stiffness[in_contact] > 500.0 * mesh.tooth_stiffness[in_contact]
    assert 0.0 < rigid.mean() < 1.0


def test_a_load_too_light_for_the_film_in_series_names_the_place() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        with pytest.raises(ComputationError, match=r'roll angle 0\.\d+ rad.*"none"'):
            table("wheel drives", pinion_torque=10.0, film_options={"stiffness": "tangent"})


@pytest.mark.slow
@pytest.mark.filterwarnings(r"ignore:\[film-stiffness\]")
def test_a_nearly_unloaded_entry_is_solved() -> None:
    # a given pair stiffness that rises from next to nothing at A and E
    pair, _ = PAIRS["pinion drives"]
    angles = td.contact.path_of_contact(pair).roll_angles
    middle = 0.5 * (angles["A"] + angles["E"])
    entry = {"roll_angle": [angles["A"], middle, angles["E"]], "pair_stiffness": [4e7, 3e8, 4e7]}
    options = {"stiffness_model": "table", "stiffness_options": entry}
    mesh = table(**options)
    in_contact = mesh.in_contact
    assert mesh.load_share[in_contact].min() < 0.2
    direct = touching(mesh)[0].films("newton", mesh.load_per_width[in_contact])
    assert mesh.central_film[in_contact] == pytest.approx(direct.central_film, rel=0.05)
    fine = table(**options, film_options={"positions": 200})
    assert fine.central_film[in_contact] == pytest.approx(direct.central_film, rel=1e-3)


def test_a_film_that_cannot_be_solved_names_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    import tribodyn.ehl.steady.batch as batch

    solve = batch.solve_case

    def fail(case: Any, options: Any) -> Any:
        if case.equivalent_radius > 8.0e-3:
            raise ComputationError("no solution was found")
        return solve(case, options)

    monkeypatch.setattr(batch, "solve_case", fail)
    with pytest.raises(ComputationError, match=r"contact at the roll angle 0\.\d{4} rad with"):
        table()
    with pytest.raises(ComputationError, match=r"under 100 N\*m at 200 rad/s and the roll angle"):
        film_over_operation(
            PAIRS["pinion drives"][0], material=STEEL, lubricant=OIL,
            pinion_speed=[200.0], pinion_torque=[100.0],
        )  # fmt: skip


def test_films_over_operation_are_those_of_each_mesh() -> None:
    pair, _ = PAIRS["wheel drives"]
    torques, speeds = [80.0, 160.0], [100.0, 200.0, 300.0]
    films = film_over_operation(
        pair, material=STEEL, lubricant=OIL, composite_roughness=0.5e-6,
        pinion_torque=torques, pinion_speed=speeds,
    )  # fmt: skip
    assert films.central_film.shape == (2, 3, 30)
    rigid = {"stiffness": "none"}
    mesh = table("wheel drives", pinion_torque=160.0, pinion_speed=300.0, film_options=rigid)
    last = np.flatnonzero(mesh.in_contact[:, 1])[-1]
    for name in ("central_film", "minimum_film", "film_ratio", "film_stiffness", "film_pressure"):
        column, value = getattr(mesh, name), getattr(films, name)[1, 2]
        assert value[0] == pytest.approx(column[0, 0], rel=1e-6)
        assert value[-1] == pytest.approx(column[last, 1], rel=1e-6)
    # flooded films fall with the torque and rise with the speed
    assert np.all(np.diff(films.central_film, axis=0) < 0.0)
    assert np.all(np.diff(films.central_film, axis=1) > 0.0)


def test_progress_is_reported_for_every_position() -> None:
    reports: list[tuple[str, int]] = []

    class Listener:
        def start(self, task: str, total: int | None = None) -> None:
            reports.append((task, total or 0))

        def advance(self, steps: int = 1) -> None:
            reports.append(("step", steps))

        def finish(self) -> None:
            reports.append(("end", 0))

    table(film_options={"positions": 20}, progress=Listener())
    assert reports[0][1] == 20
    # the positions, then the contacts in between that are checked
    promised = sum(total for task, total in reports if task not in ("step", "end"))
    assert sum(steps for task, steps in reports if task == "step") == promised
    assert reports[-1][0] == "end"


@pytest.mark.parametrize("options", [{}, {"rolling": True}])
def test_friction_of_the_film_between_positions_is_that_at_the_knots(options: Any) -> None:
    mesh = table("wheel drives", friction_law="ehl", friction_options=options)
    in_contact = mesh.in_contact
    contacts, motion = touching(mesh)
    films = contacts.films("newton", mesh.load_per_width[in_contact])
    loads = mesh.load_per_width[in_contact]
    contact = tribological_contact(motion, contacts, loads, 0.5e-6, PITCH, films)
    direct = LAWS["ehl"](
        replace(contact, film=FilmState.from_solutions(films.solutions)), **options
    )
    assert mesh.friction_coefficient[in_contact] == pytest.approx(direct, rel=0.03, abs=3e-4)
    if not options:
        at_rest = np.abs(mesh.sliding_speed[in_contact]) == 0.0
        assert at_rest.sum() == 2
        assert np.all(mesh.friction_coefficient[in_contact][at_rest] < 1e-6)
    assert 0.02 < mesh.mean_friction_coefficient < 0.08
    assert mesh.mean_friction_power > 0.0


def test_friction_of_the_film_needs_a_solved_film() -> None:
    with pytest.raises(InputError, match=r"film is not known.*newton"):
        table(friction_law="ehl", film_model="moes")


def test_the_printed_sum_is_plotted_once_and_is_no_spring() -> None:
    with pytest.warns(ModelWarning, match="seed-film-stiffness") as caught:
        mesh = table(film_options={"stiffness": "seed"})
    assert len(caught) == 1
    assert np.array_equal(mesh.stiffness, mesh.tooth_stiffness)
    assert mesh.film_stiffness_kind == "seed"
    assert np.all(mesh.film_stiffness[mesh.in_contact] < 1e6)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["approach", "tangent", "secant"])
def test_coupled_pairs_with_tip_contact_need_no_more_positions(kind: str) -> None:
    # Zones end where a tip corner begins or ceases to carry: no warning, and more change nothing.
    options = {"stiffness_model": "analytic", "film_options": {"stiffness": kind}, "steps": 512}
    mesh = table(**options)
    assert mesh.corner_share.max() > 0.1
    options["film_options"] = {"stiffness": kind, "positions": 60}
    finer = table(**options)
    on = mesh.in_contact
    assert mesh.central_film[on] == pytest.approx(finer.central_film[on], rel=2e-3)
    assert mesh.static_transmission_error == pytest.approx(
        finer.static_transmission_error, rel=5e-4
    )
    assert mesh.load_share == pytest.approx(finer.load_share, abs=5e-4)


@pytest.mark.slow
def test_a_pair_separated_by_its_relief_settles() -> None:
    pair = fzg("pinion")
    relief = FlankModification(tip_relief=40e-6)
    relieved = replace(pair, pinion=replace(pair.pinion, modification=relief))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        mesh = table(
            pair=relieved, stiffness_model="analytic", film_options={"stiffness": "tangent"},
            steps=128,
        )  # fmt: skip
    total = mesh.load_share.sum(axis=1) + mesh.corner_share.sum(axis=1)
    assert total == pytest.approx(1.0, abs=1e-8)
    assert (mesh.in_contact & (mesh.load_share == 0.0)).any()
    # One pair alone: its film in series with its teeth, by hand.
    alone = mesh.load_share.max(axis=1) > 1.0 - 1e-12
    dry = loaded_contact(
        relieved, mesh.pinion_torque, provider="analytic", phases=mesh.phase[alone], material=STEEL
    )
    film = mesh.film_stiffness[alone][np.arange(alone.sum()), mesh.load_share[alone].argmax(axis=1)]
    added = mesh.static_transmission_error[alone] - dry.transmission_error
    assert added == pytest.approx(mesh.total_normal_force / film, rel=1e-5)
