"""Teeth and oil film in series: the rule, the load share that follows, and where it ends."""

from __future__ import annotations

import math
import types

import numpy as np
import pytest

from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import ComputationError, InputError
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import MeshTable, build
from tribodyn.mesh.loads import in_series
from tribodyn.mesh.sharing import SpringTeeth
from tribodyn.stiffness import ContactProblem
from tribodyn.stiffness.loaded.problem import Compliance, independent_compliance

OIL = Lubricant(0.082, 880.0, 21.9e-9)
CONDITIONS = {
    "material": Material(),
    "lubricant": OIL,
    "friction_law": "constant",
    "friction_options": {"coefficient": 0.05},
    "composite_roughness": 0.5e-6,
    "pinion_speed": 1400.0 * math.pi / 30.0,
    "pinion_torque": 100.0,
    "steps": 64,
}


def named(row, pair):
    return f"pair {pair} in row {row}"


def table(pair, model="dowson-higginson", kind="tangent", **changes):
    options = {"film_model": model, "film_options": {"stiffness": kind}}
    torque = 400.0 if pair.transverse_contact_ratio > 2.0 else 100.0
    return build(pair, **{**CONDITIONS, "pinion_torque": torque, **options, **changes})


@pytest.fixture(params=["pinion", "wheel", "high contact ratio"])
def pair(request, fzg, high_contact_pair):
    return high_contact_pair if request.param.startswith("high") else fzg(driver=request.param)


@pytest.mark.parametrize("model", ["dowson-higginson", "moes"])
def test_compliances_of_teeth_and_film_add_up_in_each_pair(pair, model):
    mesh = table(pair, model)
    touching = mesh.in_contact
    compliance = 1.0 / mesh.tooth_stiffness[touching] + 1.0 / mesh.film_stiffness[touching]
    assert mesh.stiffness[touching] == pytest.approx(1.0 / compliance, rel=1e-12)
    assert np.all(mesh.stiffness[~touching] == 0.0)
    # per pair, not on the sum: the sum of the pairs is softer than one film on the sum of teeth
    teeth, film = mesh.tooth_stiffness.sum(axis=1), mesh.film_stiffness.sum(axis=1)
    shared = touching.sum(axis=1) > 1
    on_the_sum = teeth * film / (teeth + film)
    assert np.all(mesh.mesh_stiffness[shared] < on_the_sum[shared] * (1.0 + 1e-12))
    assert np.any(mesh.mesh_stiffness[shared] < on_the_sum[shared] * (1.0 - 1e-7))


def test_shares_follow_the_stiffness_of_teeth_and_film(pair):
    mesh, dry = table(pair), table(pair, kind="none")
    expected = mesh.stiffness / mesh.stiffness.sum(axis=1, keepdims=True)
    assert mesh.load_share == pytest.approx(expected, abs=1e-12)
    moved = np.abs(mesh.load_share - dry.load_share).max()
    assert 1e-5 < moved < 5e-3
    assert mesh.tooth_stiffness == pytest.approx(dry.stiffness, rel=1e-14)


def test_the_film_stiffness_is_that_of_the_computed_share(pair):
    mesh = table(pair)
    touching = mesh.in_contact
    films = FILM_MODELS["dowson-higginson"].films(
        mesh.load_per_width[touching], mesh.equivalent_radius[touching],
        mesh.entrainment_speed[touching], OIL, 2.0 * 206e9 / (2.0 * (1.0 - 0.3**2)),
        length=pair.common_face_width,
    )  # fmt: skip
    assert mesh.film_stiffness[touching] == pytest.approx(films.film_stiffness, rel=1e-12)
    assert mesh.central_film[touching] == pytest.approx(films.central_film, rel=1e-12)


def test_the_lighter_pair_has_the_softer_film(fzg):
    mesh = table(fzg())
    lighter = np.argmin(np.where(mesh.in_contact, mesh.load_share, 2.0), axis=1)
    shared = mesh.in_contact.sum(axis=1) == 2
    rows = np.flatnonzero(shared)
    soft = mesh.film_stiffness[rows, lighter[rows]]
    assert np.all(soft <= mesh.film_stiffness[rows][:, :2].max(axis=1))
    assert np.any(soft < 0.9 * mesh.film_stiffness[rows][:, :2].max(axis=1))


def test_a_film_that_does_not_yield_leaves_the_mesh_alone(pair):
    dry = table(pair, kind="none")
    bare = table(pair, model="none", kind="none")
    assert np.array_equal(dry.stiffness, bare.stiffness)
    assert np.array_equal(dry.load_share, bare.load_share)
    assert np.array_equal(dry.tooth_stiffness, dry.stiffness)
    # the warning comes all the same
    assert np.all(dry.film_stiffness[dry.in_contact] > 1e9)
    assert (dry.film_stiffness_kind, table(pair).film_stiffness_kind) == ("none", "tangent")
    assert bare.film_stiffness is None


def test_more_load_stiffens_the_film_and_more_speed_softens_it(fzg):
    stiffness = [
        table(fzg(), pinion_torque=torque, pinion_speed=speed).film_stiffness.max()
        for torque, speed in ((50.0, 100.0), (200.0, 100.0), (200.0, 300.0))
    ]
    assert stiffness[0] < stiffness[2] < stiffness[1]


def test_secant_and_seed_need_the_solved_film(fzg):
    for kind in ("secant", "seed"):
        with pytest.raises(InputError, match=f'stiffness = "{kind}".*none, tangent'):
            table(fzg(), kind=kind)


def test_a_table_with_its_film_is_stored_and_read(fzg, tmp_path):
    mesh = table(fzg())
    mesh.save(tmp_path / "mesh.nc")
    again = MeshTable.load(tmp_path / "mesh.nc")
    for name in ("tooth_stiffness", "film_stiffness", "stiffness", "film_ratio"):
        assert np.array_equal(getattr(again, name), getattr(mesh, name))
    assert again.film_pressure is None
    assert again.film_stiffness_kind == "tangent"
    data = mesh.to_xarray()
    assert data["film_stiffness"].attrs["units"] == "N/m"
    assert "film" in data["tooth_stiffness"].attrs["long_name"]


def test_a_table_draws_its_film(fzg):
    mesh = table(fzg())
    thickness, stiffness = mesh.plot_film(), mesh.plot_film_stiffness()
    least = mesh.minimum_film[mesh.in_contact].min() * 1e6
    assert min(float(np.min(trace.y)) for trace in thickness.data[:2]) == pytest.approx(least)
    assert stiffness.layout.yaxis.type == "log"


def test_a_table_of_the_earlier_format_is_read(fzg, tmp_path):
    mesh = build(fzg(), **CONDITIONS)
    new = ["tooth_stiffness", "corner_share", "static_transmission_error"]
    new += ["mesh_stiffness_tangent", "ramp_deflection", "ramp_stiffness"]
    old = mesh.to_xarray().drop_vars(new)
    old.attrs["format"] = "tribodyn mesh table 1"
    del old.attrs["film_stiffness_kind"], old.attrs["maximum_single_pair_stiffness"]
    old.to_netcdf(tmp_path / "old.nc", engine="h5netcdf")
    again = MeshTable.load(tmp_path / "old.nc")
    assert np.array_equal(again.tooth_stiffness, mesh.stiffness)
    assert (again.film_stiffness_kind, again.film_stiffness) == ("none", None)
    error = mesh.total_normal_force / mesh.mesh_stiffness
    assert again.static_transmission_error == pytest.approx(error, rel=1e-14)
    assert again.force_law.deflection(0.3, mesh.total_normal_force) == pytest.approx(
        again.at("static_transmission_error", 0.3), rel=1e-5
    )


class Film:
    """A film that is solved for any load, with what follows from it."""

    def __init__(self, stiffness_of, distance_of=None):
        self.stiffness_of, self.distance_of = stiffness_of, distance_of
        self.keeps_distance = distance_of is not None

    def __call__(self, load):
        distance = self.distance_of(load) if self.keeps_distance else None
        return types.SimpleNamespace(film_stiffness=self.stiffness_of(load), film_distance=distance)


def _film(stiffness_of, distance_of=None):
    return lambda *_: Film(stiffness_of, distance_of)


def springs(*stiffness):
    """Teeth of one phase that are springs of their own, a metre wide, under 100 kN."""
    each = np.array([stiffness])
    gaps = np.zeros((1, 1, each.size))
    compliance = Compliance(independent_compliance(each, 1.0), np.zeros(each.shape), 0.0)
    contact = types.SimpleNamespace(pair=types.SimpleNamespace(common_face_width=1.0))
    places = types.SimpleNamespace(contact=contact)
    problem = ContactProblem(places, compliance, gaps, np.ones((1, 1, 1)))
    return SpringTeeth(each > 0.0, 1e5, problem, each)


def solved(teeth, film):
    carried, _ = in_series(teeth, film, named)
    # the tangent of springs is their sum, and so is the secant
    assert carried.tangent == pytest.approx(carried.stiffness.sum(axis=1), rel=1e-9)
    assert carried.transmission_error == pytest.approx(1e5 / carried.tangent, rel=1e-9)
    return carried.stiffness, carried.share


def test_two_springs_by_hand():
    stiffness, share = solved(springs(3e8, 1e8), _film(lambda load: np.array([6e8, 1e8])))
    assert stiffness.tolist() == [[pytest.approx(2e8), pytest.approx(0.5e8)]]
    assert share.tolist() == [[pytest.approx(0.8), pytest.approx(0.2)]]


def test_a_film_in_proportion_to_its_load_settles_at_its_fixed_point():
    # K = c w: the film of each pair yields by the same 1/c, so that the teeth share as without it
    c = 1e5
    stiffness, share = solved(springs(3e8, 1e8), _film(lambda load: c * load))
    assert share[0] == pytest.approx([0.75, 0.25], rel=1e-11)
    assert stiffness[0] == pytest.approx(1e5 * share[0] / (1e5 / 4e8 + 1.0 / c), rel=1e-10)


def test_a_film_softer_than_its_teeth_takes_the_load_away():
    # the film of the first pair yields by 10 mm at any load, more than the second ever does
    film = _film(lambda load: np.array([100.0 * load[0], 1e9]))
    with pytest.raises(ComputationError, match=r'pair 0 in row 0 loses.*film\.stiffness = "none"'):
        solved(springs(3e8, 1e8), film)


def test_a_film_that_is_never_the_same_is_refused():
    films = iter(range(1000))

    def restless(*_):
        factor = 1.0 + 0.1 * (next(films) % 2)
        return Film(lambda load: np.array([factor, 1.0]) * 1e8)

    with pytest.raises(ComputationError, match="still moves by"):
        solved(springs(3e8, 1e8), restless)
    assert next(films) < 30  # a solved film takes a second each time


def test_one_pair_alone_carries_its_full_load():
    stiffness, share = solved(springs(2e8, 0.0), _film(lambda load: np.array([2e8])))
    assert stiffness.tolist() == [[pytest.approx(1e8), 0.0]]
    assert share.tolist() == [[1.0, 0.0]]


def power_film(distance, power):
    """Distances that fall with a power of the load per width, and their slopes."""
    film = lambda load: distance * (load / 1e5) ** -power  # noqa: E731
    return _film(lambda load: load / (power * film(load)), film)


@pytest.mark.parametrize("power", [0.03, 0.1, 1.0])
@pytest.mark.parametrize("distance", [1e-6, 3e-5, 1e-3])
def test_films_that_keep_a_distance_share_by_their_approach(distance, power):
    """Both pairs come nearer by ``F/k - h(F)``, whatever their film; found here by bisection."""
    from scipy.optimize import brentq

    pairs = springs(3e8, 1e8)

    def approach(force, stiffness):
        return force / stiffness - distance * (force / 1e5) ** -power

    alone = brentq(lambda f: approach(f, 3e8) - approach(1e5 - f, 1e8), 1e-9, 1e5 - 1e-9, xtol=1e-9)
    carried, _ = in_series(pairs, power_film(distance, power), named)
    assert carried.share[0] == pytest.approx([alone / 1e5, 1.0 - alone / 1e5], abs=1e-8)
    # the approach counts from where the first film begins to carry, on the straight lines
    force = 1e5 * carried.share[0]
    lead = (1.0 + power) * distance * (force / 1e5) ** -power
    expected = approach(force, np.array([3e8, 1e8])) + lead.max()
    assert carried.transmission_error[0] == pytest.approx(expected, rel=1e-6)


def test_a_film_without_distance_leaves_the_teeth_alone():
    carried, _ = in_series(springs(3e8, 1e8), power_film(1e-15, 0.1), named)
    assert carried.share[0] == pytest.approx([0.75, 0.25], abs=1e-9)
    assert carried.transmission_error[0] == pytest.approx(1e5 / 4e8, rel=1e-9)
