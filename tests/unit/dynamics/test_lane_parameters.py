"""Lanes that scale their system or march one of their own, against systems built one by one."""

import numpy as np
import pytest

from known_systems import reference_system, turning
from tribodyn.dynamics import (
    Contact,
    LaneParameters,
    LoadFriction,
    System,
    simulate,
    simulate_ensemble,
)
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.errors import InputError

NAMES = ("stiffness", "damping", "friction", "error", "gap", "force")
SCALES = tuple(f"{name}_scale" for name in NAMES)
FREQUENCY = 0.4
START = (np.array([0.2, -0.1, 0.15]), np.array([0.3, 0.1, -0.2]))


def _build(stiffness=1.0, damping=1.0, friction=1.0, error=1.0, gap=1.0, force=1.0, *, extra=False):
    """Everything varies over the cycle, teeth separate, both kinds of friction act."""
    rub = np.array([1.0, -1.0, 0.5])
    first = Contact(
        turning,
        stiffness=lambda phase: stiffness * (40.0 + np.where(phase < 0.4, 20.0, 0.0)),
        damping=0.3 * damping,
        error=lambda phase: error * 0.02 * np.sin(4 * np.pi * phase),
        gap=lambda phase: gap * (0.01 + 0.005 * np.cos(2 * np.pi * phase)),
        friction=lambda phase: friction * np.where(phase < 0.55, 0.02, -0.02)[:, None] * rub,
        events=(0.4, 0.55, 0.7) if extra else (0.4, 0.55),
    )
    second = Contact([0.0, 1.0, -1.0], stiffness=25.0 * stiffness, damping=0.2 * damping,
                     gap=0.02 * gap, damping_in_gap=True)  # fmt: skip
    third = Contact([0.5, 0.0, 1.0], stiffness=9.0 * stiffness, damping=0.1 * damping)
    follows = LoadFriction([0.1, 0.3, 0.0], friction * np.array([0.2, 0.1]), 0.5, contacts=(0, 2))

    def pull(phase):
        return force * np.stack([np.sin(2 * np.pi * phase), 0 * phase, 1.0 + 0 * phase], axis=1)

    return System(
        np.array([[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 0.5]]),
        0.5 * np.eye(3),
        np.array([[3.0, -1.0, 0.0], [-1.0, 4.0, -1.0], [0.0, -1.0, 2.0]]),
        pull,
        [first, second, third],
        frictions=[follows],
    )


def _different(lanes, seed=1):
    values = np.random.default_rng(seed).uniform(0.5, 1.6, (lanes, 6))
    return values, LaneParameters(**dict(zip(SCALES, values.T, strict=True)))


def _differs(single, ensemble, lane):
    """Names of what the first lane of an ensemble does not share with a lane of another."""
    names = []
    for name in ("position", "velocity"):
        difference = np.abs(getattr(ensemble, name)[lane] - getattr(single, name)[0]).max()
        if not difference <= 1e-12 * np.abs(getattr(single, name)[0]).max():
            names.append(name)
    for name in ("deflection", "contact_force", "acceleration"):
        for part in ("mean", "rms", "minimum", "maximum", "harmonics"):
            values, expected = (getattr(getattr(item, name), part) for item in (ensemble, single))
            if not np.allclose(values[lane], expected[0], rtol=1e-9, atol=1e-10):
                names.append(f"{name}.{part}")
    if not np.allclose(ensemble.contact_loss_share[lane], single.contact_loss_share[0], atol=1e-9):
        names.append("contact_loss_share")
    return names


@pytest.mark.parametrize("lanes", [3, 9, 40])
def test_each_lane_is_a_system_of_its_own(lanes):
    values, parameters = _different(lanes)
    ensemble = simulate_ensemble(_build(), FREQUENCY, 3, START, steps=176, parameters=parameters,
                             averaged=2)  # fmt: skip
    for lane in (0, 1, lanes - 1):
        system = _build(**dict(zip(NAMES, values[lane], strict=True)))
        single = simulate_ensemble(system, FREQUENCY, 3, START, steps=176, averaged=2)
        assert 0.0 < single.contact_loss_share[0, 0] < 1.0
        assert _differs(single, ensemble, lane) == []


@pytest.mark.parametrize("number", range(6))
def test_one_factor_at_a_time(number):
    factors = np.array([0.6, 1.0, 1.5])
    ensemble = simulate_ensemble(_build(), FREQUENCY, 2, START, steps=176,
                             parameters=LaneParameters(**{SCALES[number]: factors}))  # fmt: skip
    assert not np.allclose(ensemble.velocity[0], ensemble.velocity[1], rtol=1e-6)
    for lane, factor in enumerate(factors):
        system = _build(**{NAMES[number]: factor})
        assert (
            _differs(simulate_ensemble(system, FREQUENCY, 2, START, steps=176), ensemble, lane)
            == []
        )


def test_factors_of_a_gear_pair_without_a_dead_zone():
    values, parameters = _different(8, seed=5)
    system = reference_system(0.1, error=lambda phase: 2e-6 * np.sin(2 * np.pi * phase))
    contact = system.contacts[0]
    at_rest = (np.zeros(6), np.zeros(6))
    ensemble = simulate_ensemble(system, 700.0, 2, at_rest, parameters=parameters)
    for lane in (0, 7):
        k, c, f, e, _, t = values[lane]
        scaled = Contact(
            contact.direction,
            lambda phase, k=k: k * contact.stiffness(phase),
            c * contact.damping,
            lambda phase, e=e: e * contact.error(phase),
            friction=lambda phase, f=f: f * contact.friction(phase),
            events=contact.events,
        )
        force = t * np.asarray(system.force)
        scaled_system = System(system.mass, system.damping, system.stiffness, force, [scaled])
        assert _differs(simulate_ensemble(scaled_system, 700.0, 2, at_rest), ensemble, lane) == []


def test_a_gap_that_shrinks_to_nothing_is_a_contact_without_one():
    first = Contact([1.0], stiffness=4.0, damping=0.2, gap=0.3)
    system = System([[1.0]], [[0.1]], [[0.0]], [0.2], [first])
    plain = System([[1.0]], [[0.1]], [[0.0]], [0.2], [Contact([1.0], 4.0, damping=0.2)])
    ensemble = simulate_ensemble(system, 0.3, 3, ([0.5], [0.0]), steps=400,
                             parameters=LaneParameters(gap_scale=[0.0, 1.0]))  # fmt: skip
    single = simulate_ensemble(plain, 0.3, 3, ([0.5], [0.0]), steps=400)
    np.testing.assert_allclose(ensemble.velocity[0], single.velocity[0], rtol=1e-8)
    assert abs(ensemble.velocity[1, 0] / single.velocity[0, 0] - 1.0) > 0.1


def test_factors_of_one_change_nothing():
    system = _build()
    plain = simulate_ensemble(system, [FREQUENCY] * 5, 2, START, steps=176)
    scaled = simulate_ensemble(system, [FREQUENCY] * 5, 2, START, steps=176,
                               parameters=LaneParameters(stiffness_scale=np.ones(5)))  # fmt: skip
    np.testing.assert_array_equal(plain.velocity, scaled.velocity)


def test_a_step_too_long_for_one_lane_is_refused_by_its_name():
    system = reference_system(0.1)
    scale = np.array([1.0, 40.0, 2.0])
    with pytest.raises(InputError, match=r"in lane 1 \(stiffness_scale = 40\)") as caught:
        simulate_ensemble(system, 240.0, 1, (np.zeros(6), np.zeros(6)), steps=256,
                          parameters=LaneParameters(stiffness_scale=scale))  # fmt: skip
    needed = int(str(caught.value).split("at least ")[1].split()[0])
    parameters = LaneParameters(stiffness_scale=scale)
    simulate_ensemble(system, 240.0, 1, (np.zeros(6), np.zeros(6)), steps=needed,
                      parameters=parameters)  # fmt: skip
    # The stiffest lane may be fast enough: its cycle is shorter.
    beat = np.array([240.0, 240.0 * 7.0, 340.0])
    assert compile_for(system, beat, 256, parameters).step_number <= 2.7


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"stiffness_scale": [1.0, -1.0]}, "stiffness_scale = -1 in lane 1"),
        ({"gap_scale": -0.5}, "gap_scale = -0.5"),
        ({"error_scale": np.nan}, "error_scale holds NaN"),
        ({"error_scale": [1.0, 2.0], "gap_scale": [1.0, 2.0, 3.0]}, "error_scale holds 2"),
        ({"error_scale": np.ones((2, 2))}, "shape (2, 2)"),
        ({"error_scale": [1.0, 2.0]}, "parameters is for 2 lanes"),
    ],
)
def test_wrong_factors(change, part):
    with pytest.raises(InputError) as caught:
        simulate_ensemble(_build(), [0.3, 0.4, 0.5], 1, START, parameters=LaneParameters(**change))
    assert part in str(caught.value)


@pytest.mark.parametrize("lanes", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_each_lane_integrates_its_system(lanes):
    values, _ = _different(lanes, seed=7)
    systems = [_build(**dict(zip(NAMES, row, strict=True)), extra=True) for row in values]
    # The structure differs too: a friction less, a load that does not vary.
    base = systems[1]
    systems[1] = System(2.0 * np.diag([1.0, 2.0, 0.5]), base.damping, np.eye(3), [0.3, 0.0, 0.4],
                        [Contact([1.0, 0.1, 0.2], 30.0, gap=0.02), *base.contacts[1:]],
                        frictions=base.frictions)  # fmt: skip
    frequency = np.linspace(0.3, 0.5, lanes)
    ensemble = simulate_ensemble(systems, frequency, 3, START, steps=176, averaged=2)
    events = (0.4, 0.55, 0.7)
    systems[1] = System(base.mass * 0 + systems[1].mass, base.damping, np.eye(3), [0.3, 0.0, 0.4],
                        [Contact([1.0, 0.1, 0.2], 30.0, gap=0.02, events=events),
                         *base.contacts[1:]], frictions=base.frictions)  # fmt: skip
    for lane in (0, 1, lanes - 1):
        single = simulate_ensemble(systems[lane], frequency[lane], 3, START, steps=176, averaged=2)
        assert _differs(single, ensemble, lane) == []


def test_systems_and_factors_together():
    values, parameters = _different(6, seed=9)
    two = [_build(), _build(stiffness=0.7, error=2.0)]
    systems = [two[number % 2] for number in range(6)]
    ensemble = simulate_ensemble(systems, FREQUENCY, 2, START, steps=176, parameters=parameters)
    for lane in (2, 3):
        row = values[lane].copy()
        if lane % 2:
            row[0], row[3] = 0.7 * row[0], 2.0 * row[3]
        scaled_system = _build(**dict(zip(NAMES, row, strict=True)))
        assert (
            _differs(
                simulate_ensemble(scaled_system, FREQUENCY, 2, START, steps=176), ensemble, lane
            )
            == []
        )


def test_grid_holds_the_events_of_all_lanes():
    """A jump of one lane's table is a grid point of all, so that the order stays four."""

    def jump(place):
        contact = Contact([1.0], lambda phase: np.where(phase < place, 9.0, 4.0), events=(0, place))
        return System([[1.0]], [[0.3]], [[0.0]], [1.0], [contact])

    systems = [jump(place) for place in (0.217, 0.5613)]
    ends = [simulate_ensemble(systems, 0.4, 3, ([0.1], [0.0]), steps=steps).velocity[:, 0]
            for steps in (64, 128, 2048)]  # fmt: skip
    ratio = np.abs(ends[0] - ends[2]) / np.abs(ends[1] - ends[2])
    assert np.all(ratio > 12.0)
    velocity = simulate(systems[0], 0.4, 3, ([0.1], [0.0]), steps=2048).fine.velocity[-1, 0]
    assert ends[2][0] == pytest.approx(velocity, rel=1e-9)


def _other(**change):
    base = _build()
    parts = {"contacts": base.contacts, "frictions": base.frictions} | change
    return System(base.mass, base.damping, base.stiffness, base.force, **parts)


@pytest.mark.parametrize(
    ("other", "part"),
    [
        (lambda: reference_system(), "lane 1 has 6 coordinates, that of lane 0 has 3"),
        (lambda: _other(contacts=_build().contacts[:1], frictions=()), "1 contacts"),
        (lambda: _other(frictions=()), "frictions"),
        (lambda: _other(frictions=[LoadFriction([1.0, 0, 0], 0.1, 1.0, contacts=(0, 2))]),
         "coefficients"),
        (lambda: _other(contacts=[Contact([1.0, 0, 0], 1.0), *_build().contacts[1:]]),
         "contact 0 has a dead zone in lane 0 and none in lane 1"),
        (lambda: "system", "argument systems"),
    ],
)  # fmt: skip
def test_systems_of_different_structure_are_refused(other, part):
    with pytest.raises(InputError) as caught:
        simulate_ensemble([_build(), other()], FREQUENCY, 1, START, steps=176)
    assert part in str(caught.value)


def test_systems_for_another_number_of_lanes():
    with pytest.raises(InputError, match="system is for 2 lanes"):
        simulate_ensemble([_build(), _build()], [0.3, 0.4, 0.5], 1, START)
    with pytest.raises(InputError, match=r"omega_max.*in lane 1"):
        simulate_ensemble([_build(), _build(stiffness=1e6)], FREQUENCY, 1, START, steps=176)
