"""Ensembles with every engine: statistics, factors and systems of the lanes, refusals."""

import numpy as np
import pytest

from known_marches import march_adaptive, march_newmark
from known_systems import everything_varies, hysteresis_system, reference_system
from plain.running_statistics import add_record
from tribodyn.dynamics import (
    Contact,
    LaneParameters,
    LoadFriction,
    System,
    simulate,
    simulate_ensemble,
)
from tribodyn.dynamics._engine.blocks import LaneBlock, Run, march
from tribodyn.dynamics._engine.method import RungeKutta4
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.compiled import compile_for, compile_lanes
from tribodyn.errors import ComputationError, InputError

FREQUENCY = 0.4
START = (np.array([0.2, -0.1, 0.15]), np.array([0.3, 0.1, -0.2]))
SCALES = tuple(
    f"{name}_scale" for name in ("stiffness", "damping", "friction", "error", "gap", "force")
)
OUTPUTS = np.eye(6)[[1, 5]]
#: Agreement with Runge-Kutta over the size of a statistic: engine, options, steps, tolerance. Only
#: Runge-Kutta takes the parts of a step in which a contact opens, so that the time apart differs.
ENGINES = [
    pytest.param("newmark", {}, 1024, 3e-3, marks=pytest.mark.slow),  # compiles for many lanes
    ("dormand-prince", {"rtol": 1e-9}, 1024, 8e-4),
]


def _build(stiffness=1.0):
    """Everything varies over the cycle, teeth separate, both kinds of friction act."""
    third = Contact([0.5, 0.0, 1.0], stiffness=9.0, damping=0.1)
    follows = LoadFriction([0.1, 0.3, 0.0], np.array([0.2, 0.1]), 0.5, contacts=(0, 2))
    return everything_varies(stiffness, 0.2, [third], frictions=[follows])


def _parameters(lanes, seed=1):
    values = np.random.default_rng(seed).uniform(0.6, 1.5, (lanes, 6))
    return LaneParameters(**dict(zip(SCALES, values.T, strict=True)))


def _differs(first, second, tolerance):
    """Statistics of two ensembles that are further apart than the tolerance allows."""
    differences = {}
    for name in ("deflection", "contact_force", "acceleration", "output"):
        for part in ("mean", "rms", "minimum", "maximum", "harmonics"):
            values, expected = (getattr(getattr(item, name), part) for item in (first, second))
            if not values.size:
                continue
            size = np.abs(getattr(second, name).maximum).max()
            if not np.abs(values - expected).max() <= tolerance * size:
                differences[f"{name}.{part}"] = float(np.abs(values - expected).max() / size)
    for name in ("position", "velocity", "contact_loss_share"):
        values, expected = getattr(first, name), getattr(second, name)
        if not np.abs(values - expected).max() <= tolerance * np.abs(expected).max():
            differences[name] = float(np.abs(values - expected).max() / np.abs(expected).max())
    return differences


def test_statistics_of_a_record_are_those_of_the_kernel():
    """As near as whole steps come to the parts of those in which a contact opens."""
    systems, steps = [_build(), _build(0.7)] * 3, 4096
    parameters, limit = _parameters(6), 3e-4
    outputs = np.random.default_rng(2).standard_normal((2, 6))
    options = {"steps": steps, "parameters": parameters, "outputs": outputs, "harmonics": 3}
    extra = np.random.default_rng(3).standard_normal((6, 3)) * 0.1
    ensemble = simulate_ensemble(systems, FREQUENCY, 1, START, extra_force=extra, **options)
    assert ensemble.contact_loss_share.max() > 0.1
    compiled = compile_lanes(systems, np.full(6, FREQUENCY), steps, parameters)
    for member in compiled.members:
        lane = int(member.lanes[1])
        compiled_member = compile_lanes(member.system, [FREQUENCY], steps, any_step=True)
        single = LaneParameters(**{name: getattr(parameters, name)[lane] for name in SCALES})
        record = np.empty((steps + 1, 6, 1))
        state, period = np.concatenate(START)[None], np.array([1.0 / FREQUENCY])
        arguments = {"extra_force": extra[lane : lane + 1], "parameters": single, "record": record}
        march(compiled_member, period, state, 1, **arguments)
        gathered, plain = (Statistics.of(compiled_member, outputs, 1, 3) for _ in range(2))
        run = Run(compiled_member, RungeKutta4(), single, period, state, extra[lane : lane + 1])
        run.gather(LaneBlock(np.arange(1), 1), record, gathered, 1)
        (same,) = compiled_member.each(1)
        add_record(
            plain,
            same,
            compiled_member.grid,
            period,
            extra[lane : lane + 1],
            single.table(1),
            record,
        )
        size = np.abs(plain.moments).max()
        assert gathered.moments == pytest.approx(plain.moments, rel=1e-11, abs=1e-14 * size)
        rows = gathered.of_contacts[:, :, 0]
        for name, part in (("deflection", rows[:3]), ("contact_force", rows[3:])):
            values = getattr(ensemble, name)
            assert part[:, 0] == pytest.approx(values.mean[lane], abs=limit)
            assert np.sqrt(part[:, 1]) == pytest.approx(values.rms[lane], rel=limit)
            assert part[:, 2] == pytest.approx(values.minimum[lane], abs=limit)
            assert part[:, 3] == pytest.approx(values.maximum[lane], rel=limit)
            waved = 2.0 * (part[:, 5::2] - 1j * part[:, 6::2])
            assert np.abs(waved - values.harmonics[lane]).max() < limit
        assert rows[3:, 4] == pytest.approx(ensemble.contact_loss_share[lane], abs=limit)
        short = gathered.others[:, :, 0]
        assert short[:3, 0] == pytest.approx(ensemble.acceleration.mean[lane], abs=limit)
        assert np.sqrt(short[:3, 1]) == pytest.approx(ensemble.acceleration.rms[lane], rel=limit)
        assert short[3:, 3] == pytest.approx(ensemble.output.maximum[lane], rel=limit)


@pytest.mark.parametrize(("method", "options", "steps", "tolerance"), ENGINES)
def test_engines_agree_on_lanes_with_factors_and_systems(method, options, steps, tolerance):
    two, lanes = (_build(), _build(0.7)), 19
    systems = [two[number % 2] for number in range(lanes)]
    shared = {"parameters": _parameters(lanes), "averaged": 2, "outputs": OUTPUTS}
    frequency = np.linspace(0.3, 0.5, lanes)
    reference = simulate_ensemble(systems, frequency, 3, START, steps=1024, **shared)
    shared |= {"steps": steps, "method": method, **options}
    ensemble = simulate_ensemble(systems, frequency, 3, START, **shared)
    assert _differs(ensemble, reference, tolerance) == {}
    serial = simulate_ensemble(systems, frequency, 3, START, threads=1, **shared)
    np.testing.assert_array_equal(serial.velocity, ensemble.velocity)
    np.testing.assert_array_equal(serial.contact_force.rms, ensemble.contact_force.rms)


@pytest.mark.parametrize(("method", "options", "steps", "tolerance"), ENGINES)
@pytest.mark.parametrize("number", range(6))
def test_one_factor_at_a_time(method, options, steps, tolerance, number):
    parameters = LaneParameters(**{SCALES[number]: [0.6, 1.0, 1.5]})
    scaled, reference = (
        simulate_ensemble(_build(), FREQUENCY, 1, START, steps=steps, parameters=parameters,
                          **{"method": method, **options} if engine else {})
        for engine in (True, False)
    )  # fmt: skip
    assert not np.allclose(scaled.velocity[0], scaled.velocity[1], rtol=10.0 * tolerance)
    assert _differs(scaled, reference, 4.0 * tolerance) == {}


@pytest.mark.parametrize(("method", "options", "steps", "tolerance"), ENGINES)
def test_statistics_are_near_those_of_the_response(method, options, steps, tolerance):
    """A response parts its samples where a contact opens, these statistics do not."""
    system = reference_system(0.1, gap=2e-5)
    start = (np.full(6, 1e-5), np.zeros(6))
    response = simulate(system, 1800.0, 2, start, steps=256, method=method, **options)
    ensemble = simulate_ensemble(system, 1800.0, 2, start, steps=256, averaged=2, harmonics=2,
                              method=method, **options)  # fmt: skip
    fine = response.fine
    assert ensemble.acceleration.rms[0] == pytest.approx(
        np.sqrt(fine.mean(fine.acceleration**2)), rel=2e-3
    )
    assert ensemble.contact_force.mean[0] == pytest.approx(fine.mean(fine.contact_force), rel=2e-3)
    wave = 2.0 * fine.mean(fine.deflection[:, 0] * np.exp(-2j * np.pi * 2 * fine.phase))
    assert ensemble.deflection.harmonics[0, 0, 1] == pytest.approx(wave, rel=5e-3)
    share = fine.mean((fine.deflection[:, 0] <= 2e-5).astype(float))
    assert ensemble.contact_loss_share[0, 0] == pytest.approx(share, abs=5e-3)


def test_adaptive_and_implicit_engines_take_steps_that_runge_kutta_refuses():
    stiff = System(np.eye(2), np.diag([0.2, 40.0]), np.diag([4.0, 1e7]), [1.0, 1.0])
    start = (np.zeros(2), np.zeros(2))
    with pytest.raises(InputError, match="omega_max"):
        simulate_ensemble(stiff, [1.0, 2.0], 3, start, steps=64)
    for method in ("newmark", "dormand-prince"):
        ensemble = simulate_ensemble(stiff, [1.0, 2.0], 60, start, steps=64, method=method)
        assert ensemble.position[:, 0] == pytest.approx([0.25, 0.25], rel=0.06)
    scale = LaneParameters(stiffness_scale=[1.0, 9.0])
    meshed = System([[1.0]], [[0.0]], [[0.0]], [0.0], [Contact([1.0], 4.0)])
    options = {"method": "newmark", "gamma": 0.5, "beta": 0.0, "parameters": scale}
    with pytest.raises(InputError, match=r"6 rad/s in lane 1"):
        simulate_ensemble(meshed, 1 / 8.0, 1, ([1.0], [0.0]), steps=22, **options)
    simulate_ensemble(meshed, 1 / 8.0, 1, ([1.0], [0.0]), steps=26, **options)


def test_a_preset_is_its_pair_of_numbers():
    options = {"steps": 64, "method": "newmark"}
    named = simulate(hysteresis_system(), 0.1, 2, ([1.5], [0.8]), preset="seed", **options)
    pair = {"gamma": 0.5, "beta": 0.5}
    by_numbers = simulate(hysteresis_system(), 0.1, 2, ([1.5], [0.8]), **pair, **options)
    np.testing.assert_array_equal(named.position, by_numbers.position)
    ensemble = simulate_ensemble(
        hysteresis_system(), 0.1, 2, ([1.5], [0.8]), preset="seed", **options
    )
    assert ensemble.position[0] == pytest.approx(by_numbers.fine.position[-1], rel=1e-12)
    usual = simulate(hysteresis_system(), 0.1, 2, ([1.5], [0.8]), **options)
    assert np.abs(usual.position - by_numbers.position).max() > 1e-4


@pytest.mark.slow
def test_newmark_lanes_have_the_period_of_their_stiffness():
    """Average acceleration turns by 2 arctan(omega h / 2) per step."""
    meshed = System([[1.0]], [[0.0]], [[0.0]], [0.0], [Contact([1.0], 4.0)])
    scale = np.array([0.25, 1.0, 2.25, 4.0])
    ensemble = simulate_ensemble(meshed, 1.0, 3, ([1.0], [0.0]), steps=16, method="newmark",
                              parameters=LaneParameters(stiffness_scale=scale))  # fmt: skip
    turned = 2.0 * np.arctan(np.sqrt(scale) / 16.0) * 48
    assert ensemble.position[:, 0] == pytest.approx(np.cos(turned), abs=1e-11)


def test_wrong_options_and_failures_name_the_lane():
    start = ([1.0], [0.0])
    with pytest.raises(InputError, match='It belongs to "newmark"'):
        simulate_ensemble(hysteresis_system(), [0.1, 0.2], 1, start, beta=0.25)
    with pytest.raises(InputError, match='It belongs to "dormand-prince"'):
        simulate_ensemble(hysteresis_system(), 0.1, 1, start, rtol=1e-6, method="newmark")
    with pytest.raises(InputError, match="Known: rk4, dormand-prince, newmark, modal"):
        simulate_ensemble(hysteresis_system(), 0.1, 1, start, method="euler")
    with pytest.raises(InputError, match='It belongs to "newmark"'):
        simulate_ensemble(hysteresis_system(), 0.1, 1, start, preset="seed")
    for wrong in ({"preset": "trapezoid"}, {"preset": "seed", "beta": 0.3}):
        with pytest.raises(InputError, match='"average acceleration", "linear acceleration"'):
            simulate(hysteresis_system(), 0.1, 1, start, method="newmark", **wrong)
    with pytest.raises(InputError, match="steps = 0"):
        simulate_ensemble(hysteresis_system(), 0.1, 1, start, steps=0, method="newmark")
    system = System([[1.0]], [[1.0]], [[4.0]], [1.0], [Contact([1.0], 10.0, damping=1.0)])
    damping = np.ones(40)
    damping[33] = -300.0
    parameters = LaneParameters(damping_scale=damping)
    for method in ("newmark", "dormand-prince"):
        with pytest.raises(ComputationError, match="lane 33"):
            simulate_ensemble(system, 1.0, 60, start, steps=64, method=method,
                              parameters=parameters)  # fmt: skip


def test_each_lane_has_its_system_with_newmark_and_adaptive_steps():
    systems = [_build(), _build(0.7), _build()]
    compiled = compile_lanes(systems, np.full(3, FREQUENCY), 256)
    state = np.tile(np.concatenate(START), (3, 1))
    period, record = np.full(3, 1.0 / FREQUENCY), np.empty((257, 6, 3))
    for engine, tolerance in ((march_newmark, 1e-2), (march_adaptive, 1e-5)):
        end = engine(compiled, period, state, 1, record=record)
        np.testing.assert_array_equal(record[-1].T, end)
        for lane, system in enumerate(systems):
            single = march(compile_for(system, FREQUENCY, 1024), period[:1], state[:1], 1)
            assert np.abs(end[lane] - single[0]).max() < tolerance * np.abs(single).max()
