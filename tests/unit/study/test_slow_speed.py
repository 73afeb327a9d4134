"""Gears so slow that an integration over time takes too many steps move by harmonic balance."""

from __future__ import annotations

import pytest

import tribodyn as td
from tribodyn.study.pipeline.run import rehearse

SLOW = {"operation.speed": "2.5 rpm", "dynamics.model": "torsional"}
STATED = "solver.steps_per_mesh_cycle"


def slow_warnings(warnings):
    return [str(each) for each in warnings if each.code == "slow-speed"]


def test_the_motion_is_that_of_an_integration():
    case = td.load_case("fzg-stiffness").replace(SLOW)
    with pytest.warns(td.ModelWarning, match=r"operation.speed = 2\.5 rpm .* 1.61e\+05 steps"):
        result = td.run(case)
    integrated = td.run(case.replace({STATED: 98304}))
    assert not slow_warnings(integrated.warnings)
    motion, exact = result.response.fine, integrated.response.fine
    assert result.response.step_error < 1e-3
    force, expected = motion.contact_force.sum(axis=1), exact.contact_force.sum(axis=1)
    assert motion.mean(force) == pytest.approx(exact.mean(expected), rel=1e-5)
    assert motion.mean(force**2) == pytest.approx(exact.mean(expected**2), rel=1e-5)
    extremes = force.min(), force.max()
    assert extremes == pytest.approx((expected.min(), expected.max()), rel=1e-3)


def test_check_says_so_before_a_run():
    case = td.load_case("fzg-stiffness").replace(SLOW)
    assert slow_warnings(rehearse(case))
    assert not slow_warnings(rehearse(case.replace({"operation.speed": "25 rpm"})))
    assert not slow_warnings(rehearse(case.replace({"solver.method": "transient"})))
