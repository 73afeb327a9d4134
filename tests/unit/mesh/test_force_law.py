"""The force law of a mesh: sums of ramps against quadrature, root finding and bad input."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from tribodyn.errors import InputError
from tribodyn.mesh import MeshForceLaw, MeshFunctions, PhaseFunction, phase_grid

GRID = phase_grid((0.0, 0.3), 40)
PHASES = np.array([0.0, 0.137, 0.3, 0.62, 0.999])


def _law(columns=(0, 1, 2)):
    """Two ramps that move, one that is there only after the event at 0.3."""
    wave = np.cos(2 * np.pi * GRID.phase)
    second = GRID.middle > 0.3
    place = np.stack((1e-6 + 0.5e-6 * wave, 4e-6 + wave * 1e-6, 9e-6 + 0 * wave), axis=1)
    stiffness = np.stack((1.5e8 + 2e7 * wave, 8e7 - 3e7 * wave, 5e7 * second), axis=1)
    return MeshForceLaw(GRID, place[:, list(columns)], stiffness[:, list(columns)])


def test_ramps_add_up():
    # After the event, at phase 0.3: all three ramps, evaluated by hand.
    wave = np.cos(0.6 * np.pi)
    expected = (1.5e8 + 2e7 * wave) * (20e-6 - 1e-6 - 0.5e-6 * wave)
    expected += (8e7 - 3e7 * wave) * (20e-6 - 4e-6 - 1e-6 * wave) + 5e7 * 11e-6
    assert _law().force(0.3, 20e-6) == pytest.approx(expected, rel=1e-12)
    assert _law().force(0.3 - 1e-9, 20e-6) == pytest.approx(expected - 5e7 * 11e-6, rel=1e-7)


@pytest.mark.parametrize("phase", PHASES)
def test_energy_is_the_integral_of_the_force(phase):
    law = _law()
    knots = list(law.ramps(phase)[0])
    for deflection in (2e-6, 6e-6, 20e-6):
        below = [knot for knot in knots if knot < deflection]
        work = quad(lambda d: float(law.force(phase, d)), 0.0, deflection, points=below)[0]
        assert law.energy(phase, deflection) == pytest.approx(work, rel=1e-9)


def test_tangent_is_the_slope_and_never_falls():
    law = _law()
    deflection = np.linspace(-5e-6, 25e-6, 301)
    for phase in PHASES:
        away = np.abs(deflection[:, None] - law.ramps(phase)[0]).min(axis=1) > 2e-9
        slope = (law.force(phase, deflection + 1e-9) - law.force(phase, deflection - 1e-9)) / 2e-9
        tangent = law.tangent(phase, deflection)
        np.testing.assert_allclose(tangent[away], slope[away], rtol=1e-6, atol=1.0)
        assert np.all(np.diff(tangent) >= 0.0)
        assert np.all(np.diff(law.force(phase, deflection)) >= 0.0)
    assert not law.force(0.1, deflection[deflection < 0.0]).any()


@pytest.mark.parametrize("columns", [(0, 1, 2), (2, 0, 1)])
def test_every_force_has_its_deflection(columns):
    law = _law(columns)
    force = np.array([1.0, 200.0, 700.0, 1500.0, 4000.0])
    deflection = law.deflection(PHASES[:, None], force)
    np.testing.assert_allclose(
        law.force(PHASES[:, None], deflection), np.tile(force, (5, 1)), rtol=1e-12
    )
    root = brentq(lambda d: float(law.force(0.62, d)) - 1500.0, 0.0, 1e-3, xtol=1e-18, rtol=1e-14)
    assert deflection[3, 3] == pytest.approx(root, rel=1e-12)
    np.testing.assert_array_equal(law.deflection(PHASES, 0.0), law.first_touch(PHASES))
    assert law.first_touch(0.0) == pytest.approx(1.5e-6, rel=1e-12)
    with pytest.raises(InputError, match="force"):
        law.deflection(0.0, -1.0)


def test_the_lowest_ramp_is_found_where_it_always_carries():
    assert _law().lowest == 0
    assert _law((2, 1, 0)).lowest == 2
    place = np.stack((GRID.phase, 1.0 - GRID.phase), axis=1)
    crossing = MeshForceLaw(GRID, place, np.ones_like(place))
    assert crossing.lowest is None
    np.testing.assert_allclose(crossing.knot_first_touch, np.minimum(GRID.phase, 1.0 - GRID.phase))
    absent = np.stack((np.zeros(GRID.phase.size), np.ones(GRID.phase.size)), axis=1)
    assert MeshForceLaw(GRID, place, absent).lowest == 1


def test_a_law_goes_through_its_points_and_on():
    points = np.array([1e-6, 2e-6, 5e-6, 9e-6]) + 1e-7 * np.sin(2 * np.pi * GRID.phase)[:, None]
    force = 3e13 * (points - points[:, :1]) ** 1.5 * (1.0 + 0.1 * GRID.phase[:, None])
    law = MeshForceLaw.through(GRID, points, force)
    inside = np.array([3, 9, 20, 31])  # knots on no event
    np.testing.assert_allclose(
        law.force(GRID.phase[inside, None], points[inside]), force[inside], rtol=1e-12, atol=1e-9
    )
    slope = (force[:, 3] - force[:, 2]) / (points[:, 3] - points[:, 2])
    beyond = force[3, 3] + slope[3] * 4e-6
    assert law.force(GRID.phase[3], points[3, 3] + 4e-6) == pytest.approx(beyond, rel=1e-12)
    assert law.lowest == 0


def _points(**change):
    deflection, force = np.tile([0.0, 1.0, 2.0], (42, 1)), np.tile([0.0, 1.0, 3.0], (42, 1))
    return {"deflection": deflection, "force": force} | change


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"force": np.tile([0.0, 2.0, 3.0], (42, 1))}, "convex"),
        ({"force": np.tile([1.0, 2.0, 4.0], (42, 1))}, "first force is 1 N"),
        ({"deflection": np.tile([0.0, 2.0, 1.0], (42, 1))}, "do not increase"),
        ({"force": np.ones((42, 2))}, "force (42, 2)"),
    ],
)
def test_wrong_points_are_named(change, part):
    with pytest.raises(InputError) as caught:
        MeshForceLaw.through(GRID, **_points(**change))
    assert part in str(caught.value)


@pytest.mark.parametrize(
    ("place", "stiffness", "part"),
    [
        (np.zeros((42, 2)), np.ones((42, 3)), "(42, 3)"),
        (np.zeros((40, 2)), np.ones((40, 2)), "(42, ramps)"),
        (np.zeros((42, 1)), np.where(GRID.phase > 0.5, -2.0, 1.0)[:, None], "falls to -2 N/m"),
        (np.full((42, 1), np.nan), np.ones((42, 1)), "NaN"),
        (np.zeros((42, 1)), np.where(GRID.phase > 0.95, 0.0, 1.0)[:, None], "no ramp carries"),
    ],
)
def test_wrong_ramps_are_named(place, stiffness, part):
    with pytest.raises(InputError) as caught:
        MeshForceLaw(GRID, place, stiffness)
    assert part in str(caught.value)


def test_the_tangent_meets_the_law_at_the_nominal_load():
    law, load = _law(), 3000.0
    static = PhaseFunction(GRID, law.deflection(GRID.phase, load))
    zero = PhaseFunction(GRID, np.zeros(42))
    mesh = MeshFunctions(
        zero, zero, zero, zero, GRID.event_phases,
        tangent_stiffness=lambda phase: law.tangent(phase, law.deflection(phase, load)),
        static_transmission_error=static,
        total_normal_force=load,
    )  # fmt: skip
    inner = np.array([0.1, 0.2, 0.5, 0.8])
    force = mesh.tangent_stiffness(inner) * (static(inner) - mesh.tangent_error(inner))
    np.testing.assert_allclose(force, load, rtol=1e-12)
    with pytest.raises(InputError, match="no tangent stiffness"):
        MeshFunctions(zero, zero, zero, zero, GRID.event_phases).tangent_error(0.0)


@pytest.mark.parametrize("steps", [16, 512])
def test_the_tangent_of_a_linear_law_begins_at_zero(steps):
    """Stiffness and deflection are interpolated apart, which leaves no displacement."""
    grid, load = phase_grid((0.0, 0.3), steps), 3000.0
    stiffness = 2e8 + 1e8 * (grid.phase - 0.4) ** 2
    zero = PhaseFunction(grid, np.zeros(grid.phase.size))
    mesh = MeshFunctions(
        zero, zero, zero, zero, grid.event_phases,
        tangent_stiffness=PhaseFunction(grid, stiffness),
        static_transmission_error=PhaseFunction(grid, load / stiffness),
        total_normal_force=load,
    )  # fmt: skip
    assert not mesh.tangent_error(np.linspace(0.0, 1.0, 999)).any()
    displaced = PhaseFunction(grid, load / stiffness + 1e-9)
    assert replace(mesh, static_transmission_error=displaced).tangent_error(0.5) == pytest.approx(
        1e-9, rel=0.1
    )
