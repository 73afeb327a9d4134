"""Attractors, basins, maps over two parameters and the backbone of an oscillator with backlash."""

from __future__ import annotations

import math

import numpy as np
import pytest

from known_systems import hysteresis_system, reference_system
from references.backlash_orbits import HIGH, LOW
from tribodyn.analysis import basins, bifurcation, parameter_map, phase_portrait
from tribodyn.dynamics import Contact, System, continuation, simulate, steady_state
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.errors import InputError
from tribodyn.nonlinear.attractors import Motions, settle
from tribodyn.nonlinear.survey import step_verdict

TURN = 2.0 * np.pi


class Interrupting:
    """Progress that is interrupted after some motions."""

    def __init__(self, after: int) -> None:
        self.left = after

    def start(self, task: str, total: int | None = None) -> None:
        """Begin."""

    def advance(self, steps: int = 1) -> None:
        """Count down to the interruption."""
        self.left -= steps
        if self.left <= 0:
            raise KeyboardInterrupt

    def finish(self) -> None:
        """End."""


def linear_system():
    return System([[1.0]], [[0.1]], [[1.0]], [0.0], [Contact([1.0], 0.1)])


@pytest.fixture(scope="module")
def plane():
    return basins(
        hysteresis_system(), 0.88 / TURN, between=((-3.0, 3.0), (-2.0, 2.0)), points=(31, 31)
    )


def test_settled_states_keep_the_certified_distance():
    compiled = compile_for(hysteresis_system(), 0.7 / TURN, 128)
    motions = Motions(compiled, np.full(3, 0.7 / TURN), np.tile(static_start(compiled), (3, 1)))
    exact = steady_state(hysteresis_system(), 0.7 / TURN, steps=128)
    orbit = np.concatenate((exact.position[0], exact.velocity[0]))
    for tolerance in (1e-3, 1e-6):
        settle(motions, [0, 1, 2], 400, tolerance=tolerance)
        deviation = np.abs(motions.coordinates.reduce(motions.state - orbit)).max()
        size = np.abs(motions.coordinates.reduce(orbit)).max()
        assert 0.0 < deviation < 2.0 * tolerance * size
        assert motions.period.tolist() == [1, 1, 1]
        expected = np.abs(exact.floquet_multipliers).max()
        assert motions.rate[0] == pytest.approx(expected, rel=0.1)


def test_a_sweep_in_stretches_is_the_sweep_one_by_one():
    turns = np.linspace(0.82, 0.92, 21)
    options = {"sweep": "both", "steps": 128, "transient": 200, "verdict": False}
    side_by_side = bifurcation(hysteresis_system(), turns / TURN, **options)
    systems = [hysteresis_system() for _ in turns]
    one_by_one = bifurcation(systems, turns / TURN, **options)
    assert side_by_side.rms == pytest.approx(one_by_one.rms, rel=1e-6)
    assert np.abs(np.diff(side_by_side.rms, axis=0)).max() > 0.3


def test_a_balanced_sweep_finds_the_torque_of_every_value():
    pair = reference_system(0.1, gap=20e-6)
    system = System(
        pair.mass, pair.damping, pair.stiffness, pair.force, pair.contacts,
        balance=[0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
    )  # fmt: skip
    beats = [1600.0, 2000.0, 3000.0]
    diagram = bifurcation(system, beats, steps=256, verdict=False)
    for rms, beat in zip(diagram.rms[0], beats, strict=True):
        orbit = steady_state(system, beat, steps=256)
        d = orbit.fine.deflection[:, 0]
        spread = orbit.fine.mean(d**2) - orbit.fine.mean(d) ** 2
        assert rms == pytest.approx(math.sqrt(spread), rel=1e-6)


def test_longer_periods_end_the_transient_early():
    pair = Contact([1.0], lambda p: 1.0 + 0.3 * np.cos(TURN * p), damping=0.05, gap=1.0)
    system = System([[1.0]], [[0.05]], [[0.0]], [0.3], [pair])
    compiled = compile_for(system, 2.0 / TURN, 128)
    motions = Motions(compiled, np.array([2.0 / TURN]), np.array([[1.3, 0.1]]))
    settle(motions, [0], 100000, width=1)
    assert motions.period[0] == 2


@pytest.mark.parametrize("kind", ["up", "independent"])
def test_an_interruption_preserves_finished_results(kind):
    turns = np.linspace(0.6, 0.95, 600)
    options = {"sweep": kind, "steps": 1024, "transient": 400, "verdict": True}
    diagram = bifurcation(
        hysteresis_system(), turns / TURN, keep_partial=True, progress=Interrupting(1), **options
    )
    assert not diagram.complete
    assert diagram.verdicts() == {}
    assert np.array_equal(np.isfinite(diagram.rms), diagram.finished)
    assert "interrupted" in repr(diagram)
    with pytest.raises(KeyboardInterrupt):
        bifurcation(hysteresis_system(), turns / TURN, progress=Interrupting(1), **options)


def test_hysteresis_has_two_attractors(plane):
    large, small = plane.attractors
    assert large.rms == pytest.approx(HIGH, abs=2e-6)
    assert small.rms == pytest.approx(LOW, abs=2e-6)
    assert [each.period for each in plane.attractors] == [1, 1]
    assert large.largest_multiplier == pytest.approx(0.699773, abs=1e-5)
    assert large.stable
    assert small.stable
    assert [each.verdict for each in plane.attractors] == ["physical", "physical"]
    assert large.share + small.share == pytest.approx(1.0)
    assert plane.unresolved == 0.0
    assert plane.changed < 0.01


def test_every_start_comes_to_its_attractor(plane):
    for i, j in ((0, 0), (16, 22), (30, 15)):
        start = ([plane.first[i]], [plane.second[j]])
        motion = simulate(hysteresis_system(), 0.88 / TURN, 80, start, steps=256)
        last = np.array([motion.position[-256, 0], motion.velocity[-256, 0]])
        nearest = [
            np.abs(last - np.array([a.position[0, 0], a.velocity[0, 0]])).max()
            for a in plane.attractors
        ]
        assert int(np.argmin(nearest)) == plane.attractor[i, j]


def test_shares_are_those_of_a_finer_plane(plane):
    finer = basins(
        hysteresis_system(), 0.88 / TURN, between=((-3.0, 3.0), (-2.0, 2.0)), points=(61, 61),
        verdict=False,
    )  # fmt: skip
    assert finer.attractors[0].share == pytest.approx(plane.attractors[0].share, abs=0.02)
    assert math.isnan(finer.changed)
    assert np.mean(finer.attractor[::2, ::2] == plane.attractor) > 0.99


def test_a_linear_system_has_one_basin():
    calm = basins(linear_system(), 0.3, between=((-3.0, 3.0), (-2.0, 2.0)), points=(9, 7))
    (only,) = calm.attractors
    assert (only.period, only.rms, only.share, only.verdict) == (1, 0.0, 1.0, "physical")
    assert np.all(calm.attractor == 0)


def test_two_wells_share_a_symmetric_plane_evenly():
    # A stiff contact without load: it rests at either flank, or anywhere in between at no speed.
    pair = Contact([1.0], 4.0, gap=1.0, damping=0.0)
    system = System([[1.0]], [[0.2]], [[-0.5]], [0.0], [pair])
    wells = basins(system, 0.2, between=((-2.0, 2.0), (-1.0, 1.0)), points=(20, 20), steps=64)
    assert [each.share for each in wells.attractors] == [0.5, 0.5]
    positions = sorted(float(each.position[0, 0]) for each in wells.attractors)
    # 4 (x - 1) = 0.5 x
    assert positions == pytest.approx([-8.0 / 7.0, 8.0 / 7.0], rel=1e-4)
    assert np.array_equal(wells.attractor, 1 - wells.attractor[::-1, ::-1])


def test_a_map_equals_single_motions():
    system = reference_system(0.1, gap=20e-6)
    beats, forces = [2000.0, 3000.0], [0.6, 1.2]
    parameter_map_ = parameter_map(
        system, over=(("mesh_frequency", beats), ("force_scale", forces))
    )
    assert parameter_map_.verdicts() == {"physical": 4}
    for i, beat in enumerate(beats):
        for j, factor in enumerate(forces):
            scaled = System(
                system.mass, system.damping, system.stiffness,
                factor * np.asarray(system.force), system.contacts, names=system.names,
            )  # fmt: skip
            orbit = steady_state(scaled, beat, steps=512)
            assert parameter_map_.period[i, j] == 1
            d = orbit.fine.deflection[:, 0]
            spread = orbit.fine.mean(d**2) - orbit.fine.mean(d) ** 2
            assert parameter_map_.rms[i, j] == pytest.approx(math.sqrt(spread), rel=2e-3)
    assert np.all(parameter_map_.step_number <= 0.5)


def test_a_map_of_a_function_and_its_rows():
    def system(c):
        pair = Contact([1.0], lambda p: 1.0 + 0.2 * np.cos(TURN * p), gap=1.0)
        return System([[1.0]], [[c]], [[0.0]], [0.5], [pair])

    over = (("damping", [0.1, 0.3]), ("mesh_frequency", np.array([0.7, 0.8, 0.9]) / TURN))
    parameter_map_ = parameter_map(system, over=over, units=("N*s/m", "Hz"))
    orbit = steady_state(system(0.3), 0.8 / TURN)
    d = orbit.fine.deflection[:, 0]
    spread = orbit.fine.mean(d**2) - orbit.fine.mean(d) ** 2
    assert parameter_map_.rms[1, 1] == pytest.approx(math.sqrt(spread), rel=1e-4)
    assert parameter_map_.rms[1, 1] < parameter_map_.rms[0, 1]
    assert parameter_map_.to_xarray()["damping"].attrs["units"] == "N*s/m"


@pytest.mark.parametrize(
    ("over", "message"),
    [
        ((("mesh_frequency", [1.0]), ("mesh_frequency", [1.0])), "Two different ones"),
        ((("mesh_frequency", [1.0]), ("nose", [1.0])), "nose"),
        ((("mesh_frequency", [-1.0]), ("force_scale", [1.0])), "mesh_frequency"),
    ],
)
def test_bad_axes_of_a_map_are_refused(over, message):
    with pytest.raises(InputError, match=message):
        parameter_map(hysteresis_system(), over=over)


def test_a_map_needs_a_mesh_frequency():
    over = (("damping", [0.1]), ("force_scale", [1.0]))
    with pytest.raises(InputError, match="no mesh frequency"):
        parameter_map(lambda c: hysteresis_system(), over=over, units=("N*s/m", "-"))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"between": ((0.0, 1.0),)}, "two ranges"),
        ({"between": ((0.0, 1.0), (0.0, 1.0)), "coordinates": ("q0", "nose")}, "nose"),
        ({"between": ((0.0, 1.0), (0.0, 1.0)), "points": (1, 5)}, "points"),
    ],
)
def test_bad_planes_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        basins(hysteresis_system(), 0.14, **options)


def test_a_motion_that_has_not_settled_is_no_fault_of_the_step():
    assert step_verdict(0.2, 0, 0.31, 1, 0.305) == "undecided"
    assert step_verdict(0.2, 0, 0.31, 1, 0.1) == "step-limited"


@pytest.mark.slow
def test_peak_of_light_damping_lies_on_the_backbone():
    """The free oscillation over the edge of a dead zone: a sine in contact, a parabola off it."""
    load = 0.5

    def force(phase):
        return (load + 0.012 * np.cos(TURN * phase))[:, None]

    system = System([[1.0]], [[0.012]], [[0.0]], force, [Contact([1.0], 1.0, gap=1.0)])
    branch = continuation(system, between=(1.02 / TURN, 0.75 / TURN), steps=256, longest_step=0.02)
    top = int(np.argmax(branch.peak_to_peak[:, 0]))
    swing, beat = branch.peak_to_peak[top, 0], TURN * branch.mesh_frequency[top]
    # swing = R + load + v^2 / (2 load) with R^2 = load^2 + v^2; solved for the speed v at the edge
    low, high = 0.0, 2.0
    for _ in range(80):
        v = 0.5 * (low + high)
        full = math.hypot(load, v) + load + v * v / (2.0 * load)
        low, high = (v, high) if full < swing else (low, v)
    contact = 2.0 * (math.pi - math.acos(load / math.hypot(load, v)))
    backbone = TURN / (contact + 2.0 * v / load)
    assert v > 0.3
    assert backbone < 0.97
    assert beat == pytest.approx(backbone, rel=3e-3)


def test_phase_portrait_closes_where_the_motion_repeats():
    orbit = steady_state(hysteresis_system(), 0.88 / TURN)
    portrait = phase_portrait(orbit, 0, gap=1.0)
    assert portrait.period == 1
    assert portrait.position[0] == portrait.position[-1]
    # Area enclosed = integral of the velocity over the position = twice the mean kinetic energy
    # times the duration.
    exact = phase_portrait(orbit, "q0")
    area = np.trapezoid(exact.velocity, exact.position)
    energy = orbit.fine.mean(orbit.fine.velocity[:, 0] ** 2) * orbit.duration
    assert area == pytest.approx(energy, rel=1e-3)
    assert portrait.velocity[5:-5] == pytest.approx(exact.velocity[5:-5], abs=1e-3)
    with pytest.raises(InputError, match="nose"):
        phase_portrait(orbit, "nose")
