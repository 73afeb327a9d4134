"""Analytic influence of one gear: consistency, limits, convergence, refusals."""

from __future__ import annotations

import dataclasses
import importlib
import math

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness import load_point, tooth_compliance, wind_up_compliance
from tribodyn.stiffness.teeth.analytic import analytic_influence
from tribodyn.stiffness.teeth.tooth_bending import flank_nodes


def standard_gear(teeth: int, bore: float, shift: float = 0.0) -> SpurGear:
    """A gear of 4 mm module whose bore is a part of its root circle."""
    root = teeth - 2.5 + 2.0 * shift
    return SpurGear(
        teeth=teeth,
        normal_module=4e-3,
        normal_pressure_angle=math.radians(20.0),
        profile_shift_coefficient=shift,
        tip_diameter=(teeth + 2.0 + 2.0 * shift) * 4e-3,
        face_width=0.02,
        bore_diameter=bore * root * 4e-3,
    )


def test_a_contact_of_larger_radius_is_on_the_clockwise_tooth(fzg):
    gear = fzg().pinion
    rho = np.array([0.014, 0.014 + gear.base_pitch])
    load = load_point(gear, rho)
    turn = np.array([0.0, -2.0 * math.pi / gear.teeth])
    cosine, sine = np.cos(turn), np.sin(turn)
    x = cosine * load.half_thickness - sine * load.height
    y = sine * load.half_thickness + cosine * load.height
    # Loads on both lie on one line, the line of action.
    along = np.array([-np.cos(load.load_angle[0]), -np.sin(load.load_angle[0])])
    offset = np.array([x[0] - x[1], y[0] - y[1]])
    assert offset == pytest.approx(gear.base_pitch * along, rel=1e-9)


def test_the_side_of_the_larger_radius_gives_way_more(fzg, steel):
    # The clockwise tooth is where the load presses the body down, near its line of action.
    gear = fzg().pinion
    influence = analytic_influence(gear, steel)
    ahead = influence.between(0.014, 0.014 + gear.base_pitch, 1)
    mirrored = influence.between(0.014, 0.014 + gear.base_pitch, -1)
    assert ahead > 1.08 * mirrored


def test_rim_leaves_the_wind_up_out_everywhere(fzg, steel):
    gear = fzg().wheel
    bore, rim = (analytic_influence(gear, steel, reference=name) for name in ("bore", "rim"))
    ring = wind_up_compliance(gear.base_radius, gear.root_radius, 0.015, 1.0, steel)
    assert bore.self_compliance - rim.self_compliance == pytest.approx(ring, rel=1e-9)
    difference = bore.cross_compliance - rim.cross_compliance
    assert difference == pytest.approx(np.full(difference.shape, ring), rel=1e-9)


@pytest.mark.parametrize("foundation", ["ring", "sainsot"])
def test_compliance_goes_with_the_inverse_of_the_modulus(fzg, foundation):
    gear = fzg().pinion
    soft, hard = (
        analytic_influence(gear, Material(modulus), foundation=foundation)
        for modulus in (70e9, 210e9)
    )
    assert soft.self_compliance == pytest.approx(3.0 * hard.self_compliance, rel=1e-11)
    assert soft.cross_compliance == pytest.approx(3.0 * hard.cross_compliance, rel=1e-11)


@pytest.mark.parametrize("bore", [0.2, 0.6, 0.9])
def test_the_whole_gear_takes_energy_under_any_loads(steel, bore):
    gear = standard_gear(17, bore, 0.2)
    influence = analytic_influence(gear, steel, neighbours=8)
    rho = np.linspace(influence.curvature_radius[0], influence.curvature_radius[-1], 5)
    self_compliance = influence.at(rho)
    matrix = np.zeros((17, 5, 17, 5))
    for loaded in range(17):
        for seed in range(17):
            on = (seed - loaded + 8) % 17 - 8
            if on == 0:
                # The places on one flank see each other at least as the ring carries them.
                matrix[loaded, :, seed, :] = np.diag(self_compliance)
            else:
                matrix[loaded, :, seed, :] = influence.between(rho[:, None], rho[None, :], on)
    one_load_per_tooth = matrix[:, 2, :, 2]
    assert one_load_per_tooth == pytest.approx(one_load_per_tooth.T, rel=1e-9)
    assert np.linalg.eigvalsh(one_load_per_tooth).min() > 0.3 * (
        self_compliance[2] - matrix[0, 2, 1, 2]
    )


def test_cubic_splines_between_the_nodes_are_enough(fzg, steel):
    for gear in (fzg().pinion, fzg().wheel, standard_gear(80, 0.4)):
        coarse, fine = (analytic_influence(gear, steel, nodes=count) for count in (24, 150))
        low, high = coarse.curvature_radius[[0, -1]]
        rho = np.linspace(low, high, 400)
        assert coarse.at(rho) == pytest.approx(fine.at(rho), rel=1e-4)
        mates = rho[::-1]
        assert coarse.between(rho, mates, 1) == pytest.approx(fine.between(rho, mates, 1), rel=1e-6)


def test_more_waves_and_points_change_little(fzg, steel, monkeypatch):
    gear = fzg().pinion
    before = analytic_influence(gear, steel)
    ring = importlib.import_module("tribodyn.stiffness.teeth.analytic")
    tooth = importlib.import_module("tribodyn.stiffness.teeth.tooth_bending")
    monkeypatch.setattr(ring, "_RESOLUTION", 800.0)
    monkeypatch.setattr(tooth, "_OUTLINE_POINTS", 3200)
    after = analytic_influence(gear, steel)
    assert before.self_compliance == pytest.approx(after.self_compliance, rel=2e-4)
    scale = after.cross_compliance.max()
    assert before.cross_compliance == pytest.approx(after.cross_compliance, abs=3e-5 * scale)


@pytest.mark.parametrize(("teeth", "bore"), [(20, 0.35), (32, 0.5), (60, 0.25)])
def test_the_ring_agrees_with_the_fitted_foundation_formula(steel, teeth, bore):
    gear = standard_gear(teeth, bore)
    ring, formula = (
        analytic_influence(gear, steel, foundation=name) for name in ("ring", "sainsot")
    )
    assert ring.self_compliance == pytest.approx(formula.self_compliance, rel=0.06)
    assert np.array_equal(ring.cross_compliance, formula.cross_compliance)


def test_the_formula_is_that_of_the_tooth_compliance(steel):
    gear = standard_gear(32, 0.1)
    for reference in ("bore", "rim"):
        influence = analytic_influence(gear, steel, foundation="sainsot", reference=reference)
        load = load_point(gear, influence.curvature_radius)
        parts = tooth_compliance(gear, load, 1.0, steel, reference)
        beam = influence.self_compliance - parts.foundation - parts.wind_up
        # The beam of the other ends under the load and not where the load crosses the axis.
        compliance = parts.bending + parts.shear + parts.axial
        assert np.all((beam > 0.2 * compliance) & (beam < 1.001 * compliance))


def test_a_thinner_rim_is_stiffer_in_torsion_and_its_neighbours_matter_less(steel):
    bores = (0.3, 0.6, 0.9)
    influences = [analytic_influence(standard_gear(40, bore), steel) for bore in bores]
    self_compliance = [gear.self_compliance[12] for gear in influences]
    cross = [gear.cross_compliance[0, 12, 12] for gear in influences]
    assert self_compliance == sorted(self_compliance, reverse=True)
    assert cross == sorted(cross, reverse=True)
    assert cross[2] / self_compliance[2] < 0.25 * cross[0] / self_compliance[0]


def test_a_gear_without_bore_can_be_referred_to_its_rim(steel):
    solid = standard_gear(24, 0.0)
    bored = dataclasses.replace(solid, bore_diameter=2.0 * solid.root_radius / 7.0)
    influence, same = (analytic_influence(gear, steel, reference="rim") for gear in (solid, bored))
    assert influence.self_compliance == pytest.approx(same.self_compliance, rel=1e-9)
    with pytest.raises(InputError, match='reference = "rim"'):
        analytic_influence(solid, steel)


def test_few_teeth_have_few_neighbours(steel, fzg):
    assert analytic_influence(standard_gear(12, 0.3, 0.3), steel, neighbours=9).neighbours == 5
    assert analytic_influence(fzg().pinion, steel, neighbours=0).neighbours == 0


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("reference", "hub", '"bore" or "rim"'),
        ("foundation", "clay", '"ring" or "sainsot"'),
        ("neighbours", -1, "neighbours"),
        ("nodes", 3, "nodes"),
    ],
)
def test_invalid_options_are_refused(fzg, steel, option, value, message):
    with pytest.raises(InputError, match=message):
        analytic_influence(fzg().pinion, steel, **{option: value})


def test_nodes_span_the_flank(fzg):
    for gear in (fzg().pinion, fzg().wheel):
        nodes = flank_nodes(gear, 9)
        ends = np.hypot(gear.base_radius, nodes[[0, -1]])
        assert ends == pytest.approx([gear.form_radius, gear.tip_radius], rel=1e-12)
        assert np.diff(nodes)[0] < 0.3 * np.diff(nodes)[4]
