"""Compliance of a whole gear: load point, reference body, outline."""

from __future__ import annotations

import importlib

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.stiffness import load_point, tooth_compliance, wind_up_compliance

RHO = np.array([0.012, 0.018, 0.0235])


def total(gear, reference="bore", material=None, width=0.02):
    load = load_point(gear, RHO)
    return tooth_compliance(gear, load, width, material or Material(), reference)


def test_the_load_is_tangent_to_the_base_circle(fzg):
    gear = fzg().wheel
    load = load_point(gear, RHO)
    # Distance of the line of the load from the gear axis.
    lever = load.height * np.cos(load.load_angle) - load.half_thickness * np.sin(load.load_angle)
    assert lever == pytest.approx(np.full(3, gear.base_radius), rel=1e-12)
    assert np.hypot(load.height, load.half_thickness) == pytest.approx(
        np.hypot(gear.base_radius, RHO), rel=1e-12
    )
    crossing = load.height - load.half_thickness * np.tan(load.load_angle)
    assert crossing == pytest.approx(load.axis_height, rel=1e-12)
    to_axis = np.hypot(load.half_thickness, load.height - load.axis_height)
    assert load.depth == pytest.approx(to_axis, rel=1e-12)


def test_the_two_references_differ_by_the_wind_up(fzg):
    gear = fzg().wheel
    ring = wind_up_compliance(gear.base_radius, gear.root_radius, 0.015, 0.02, Material())
    difference = total(gear).total - total(gear, "rim").total
    assert difference == pytest.approx(np.full(3, ring), rel=1e-9)


def test_referred_to_the_rim_the_bore_hardly_matters(fzg):
    bores = (0.0, 10e-3, 20e-3, 40e-3)
    rims = [total(fzg(wheel_bore_diameter=bore).wheel, "rim").total[1] for bore in bores]
    assert np.ptp(rims) < 0.15 * np.mean(rims)
    compliances = [total(fzg(wheel_bore_diameter=bore).wheel).total[1] for bore in bores[1:]]
    assert compliances[0] > 1.5 * compliances[2]


def test_below_a_seventh_of_the_root_radius_only_the_wind_up_grows(fzg):
    gear, smaller = (fzg(wheel_bore_diameter=bore).wheel for bore in (13e-3, 6.5e-3))
    assert 2 * gear.root_radius / 13e-3 > 7.0
    assert total(gear).foundation == pytest.approx(total(smaller).foundation, rel=1e-12)
    assert total(smaller).wind_up > 3.9 * total(gear).wind_up


def test_a_gear_without_bore_is_refused(fzg):
    with pytest.raises(InputError, match=r'bore_diameter, or choose reference = "rim"'):
        total(fzg(wheel_bore_diameter=0.0).wheel)


def test_an_unknown_reference_is_refused(fzg):
    with pytest.raises(InputError, match='"bore" or "rim"'):
        total(fzg().wheel, "hub")


def test_structure_scales_with_modulus_and_width(fzg):
    gear = fzg().pinion
    assert total(gear).total == pytest.approx(
        3.0 * total(gear, material=Material(3 * 206e9)).total, rel=1e-13
    )
    assert total(gear).total == pytest.approx(2.0 * total(gear, width=0.04).total, rel=1e-13)


def test_the_outline_is_fine_enough(fzg, monkeypatch):
    gear = fzg().wheel
    coarse = total(gear).total
    module = importlib.import_module("tribodyn.stiffness.teeth.tooth_bending")
    monkeypatch.setattr(module, "_OUTLINE_POINTS", 6400)
    assert coarse == pytest.approx(total(gear).total, rel=2e-6)
