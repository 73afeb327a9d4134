"""The transient contact against its limits: steady, slow, rigid, travelling, reversed in roles."""

from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import TransientLineContact, solve_line_contact, solve_transient_line_contact
from tribodyn.errors import ComputationError
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
LOAD, RADIUS, SPEED, MODULUS = 147802.0, 8e-3, 3.0722, 2.2e11
HALF_WIDTH = np.sqrt(8.0 * LOAD * RADIUS / (np.pi * MODULUS))
TRANSIT = HALF_WIDTH / SPEED


def solve(time: Any, load: Any = LOAD, speed: Any = SPEED, **options: Any) -> TransientLineContact:
    return solve_transient_line_contact(
        time, load, options.pop("radius", RADIUS), speed, options.pop("oil", OIL), MODULUS,
        **{"nodes": 257, "keep_every": 0, **options},
    )  # fmt: skip


def mesh_cycle(duration: float) -> dict[str, Any]:
    """Load, radius and speed of a tooth engagement, from 2 % of the load to 2 %."""

    def load(time: Any) -> Any:
        ramp = np.clip(np.minimum(time, duration - time) / (0.2 * duration), 0.0, 1.0)
        return LOAD * (0.02 + 0.98 * ramp**2 * (3.0 - 2.0 * ramp))

    return {
        "load": load,
        "radius": lambda time: RADIUS * (1.0 - 1.2 * (time / duration - 0.5) ** 2),
        "speed": lambda time: SPEED * (1.0 + 0.2 * (time / duration - 0.5)),
    }


@pytest.mark.parametrize(
    ("load", "speed"), [(LOAD, SPEED), (0.02 * LOAD, SPEED), (2.0 * LOAD, 0.8)]
)
def test_constant_inputs_stay_steady(load: float, speed: float) -> None:
    contact = solve(np.linspace(0.0, 100 * 0.05 * TRANSIT, 101), load, speed)
    assert np.ptp(contact.central_film) < 1e-8 * contact.central_film[0]
    assert np.ptp(contact.minimum_film) < 1e-8 * contact.central_film[0]
    assert contact.load_per_width == pytest.approx(load, rel=1e-10)
    steady = solve_line_contact(load, RADIUS, speed, OIL, MODULUS, nodes=1025)
    assert contact.central_film[0] == pytest.approx(steady.central_film, rel=2e-2)


@pytest.mark.filterwarnings("ignore:\\[starved-inlet\\]:tribodyn.errors.ModelWarning")
def test_the_start_is_the_steady_solution() -> None:
    """Two Newton methods on one grid; the inlet of a stated length needs no estimate."""
    domain = {"domain": (-4.5, 1.5), "inlet": "zero", "nodes": 257}
    steady = solve_line_contact(
        LOAD, RADIUS, SPEED, OIL, MODULUS, tolerance=1e-9, flux_tolerance=1e-9, **domain
    )
    contact = solve(np.array([0.0, TRANSIT]), keep_every=1, **domain)
    assert contact.film[-1] == pytest.approx(steady.film, rel=1e-8)
    assert contact.pressure[-1] == pytest.approx(steady.pressure, abs=1e-7 * steady.hertz_pressure)


def test_slow_cycle_follows_the_steady_curve() -> None:
    fast, slow, slowest = (
        solve(np.linspace(0.0, period, 101), nodes=513, **mesh_cycle(period))
        for period in (2.4e-3, 0.24, 2.4)
    )
    inside = slice(15, -15)
    fast_deviation = np.abs(fast.central_film / slowest.central_film - 1.0)[inside].max()
    slow_deviation = np.abs(slow.central_film / slowest.central_film - 1.0)[inside].max()
    assert fast_deviation > 0.01  # squeeze matters in a real cycle
    assert slow_deviation == pytest.approx(
        fast_deviation / 100.0, rel=0.5
    )  # and fades as one over the period
    for i in (20, 50, 80):
        steady = solve_line_contact(
            slowest.load_per_width[i], slowest.equivalent_radius[i], slowest.entrainment_speed[i],
            OIL, MODULUS, nodes=1025,
        )  # fmt: skip
        assert slowest.central_film[i] == pytest.approx(steady.central_film, rel=3e-3)


def test_second_order_in_time() -> None:
    duration = 8.0 * TRANSIT

    def load(time: Any) -> Any:
        return LOAD * (1.0 - 0.3 * np.sin(np.pi * time / duration) ** 2)

    films = np.array(
        [
            solve(np.linspace(0.0, duration, steps + 1), load).central_film[:: steps // 4][1:]
            for steps in (80, 160, 320, 640)
        ]
    )
    change = np.diff(films, axis=0)
    ratio = np.linalg.norm(change[:-1], axis=1) / np.linalg.norm(change[1:], axis=1)
    assert np.all((ratio > 3.5) & (ratio < 4.5))


@pytest.mark.parametrize("change", [0.1, -0.1])
def test_a_film_step_travels_with_the_entrainment_speed(change: float) -> None:
    """The speed jumps; the new film reaches one place after the other."""
    speed, load = SPEED * (1.0 + change), 4.0 * LOAD
    half_width = 2.0 * HALF_WIDTH
    dX = 6.0 / 512
    time = np.arange(int(5.0 / dX)) * dX * half_width / speed
    contact = solve(
        time, load, np.where(time > 0.0, speed, SPEED), nodes=513, keep_every=1,
        domain=(-4.5, 1.5),
    )  # fmt: skip
    places = np.array([-0.6, -0.3, 0.0, 0.3, 0.6]) * half_width
    passed = []
    for place in places:
        film = np.array([np.interp(place, contact.position, row) for row in contact.film])
        share = (film - film[0]) / (film[-1] - film[0])
        i = int(np.flatnonzero(share < 0.5)[-1])
        passed.append(np.interp(0.5, share[i : i + 2], time[i : i + 2]))
    travelled = np.polyfit(passed, places, 1)[0]
    assert travelled == pytest.approx(speed, rel=0.02)


def test_pure_squeeze_of_rigid_cylinders() -> None:
    """``w = 3 sqrt(2) pi eta V (R/h)^(3/2)``, less what lies outside of the grid."""
    speed, viscosity, length = 1e-3, 0.082, 1e-3
    time = np.linspace(0.0, 1e-2, 201)
    gap = 20e-6 - speed * time
    reach = 8.0 * np.sqrt(2.0 * RADIUS * gap[0])
    edge = gap + reach**2 / (2.0 * RADIUS)
    wide = np.sqrt(2.0 * RADIUS * gap)
    inner = reach * gap / edge + wide * np.arctan(reach / wide)
    # int (1/h^2 - 1/h_e^2) dx over the grid
    exact = 6.0 * viscosity * speed * RADIUS * (inner / gap**2 - 2.0 * reach / edge**2)
    estimate = 3.0 * np.sqrt(2.0) * np.pi * viscosity * speed * (RADIUS / gap) ** 1.5
    modulus = 3e10
    half_width = np.sqrt(8.0 * estimate[-1] * RADIUS / (np.pi * modulus))
    contact = solve_transient_line_contact(
        time, estimate[-1], RADIUS, 0.0, Lubricant(viscosity, 880.0, 0.0), modulus,
        impose="approach", approach=-gap, start="unloaded", nodes=1025, compressible=False,
        domain=(-reach / half_width, reach / half_width), reference_length=length, keep_every=0,
    )  # fmt: skip
    late = slice(50, None)
    assert contact.load_per_width[late] == pytest.approx(exact[late], rel=3e-3)
    assert exact[-1] == pytest.approx(estimate[-1], rel=5e-3)


def test_viscosity_and_time_scale_together() -> None:
    """Twice the viscosity at half the speeds is the same film at half the pace."""
    time = np.linspace(0.0, 10.0 * TRANSIT, 51)
    load = LOAD * (1.0 - 0.4 * np.sin(np.pi * time / time[-1]) ** 2)
    law = {"viscosity_law": "barus"}
    motion = solve(time, load, SPEED, **law)
    other = solve(2.0 * time, load, 0.5 * SPEED, oil=Lubricant(0.164, 880.0, 2.19e-8), **law)
    assert other.central_film == pytest.approx(motion.central_film, rel=1e-7)


def test_the_imposed_approach_gives_the_load_back() -> None:
    cycle = mesh_cycle(2.4e-3)
    time = np.linspace(0.0, 2.4e-3, 101)
    loaded = solve(time, **cycle)
    answer = solve(time, **cycle, impose="approach", approach=loaded.approach)
    assert answer.load_per_width == pytest.approx(loaded.load_per_width, rel=1e-3)
    assert answer.central_film == pytest.approx(loaded.central_film, rel=1e-4)
    middle = slice(15, -15)
    assert answer.load_per_width[middle] == pytest.approx(loaded.load_per_width[middle], rel=1e-5)


def test_the_reference_length_shifts_the_approach_with_the_load() -> None:
    """``4 w ln(d_2/d_1)/(pi E')``: what a half space yields between two depths."""
    time = np.linspace(0.0, 10.0 * TRANSIT, 11)
    load = LOAD * (1.0 + 0.2 * np.sin(time / TRANSIT))
    short, far = (solve(time, load, reference_length=d, domain=(-9.0, 2.5)) for d in (5e-3, 10e-3))
    shift = 4.0 * load * np.log(2.0) / (np.pi * MODULUS)
    assert far.approach - short.approach == pytest.approx(shift, rel=2e-3)
    assert far.central_film == pytest.approx(short.central_film, rel=1e-12)


def test_a_sudden_unloading_tears_the_film_and_heals() -> None:
    """Load sharing halves the load at once: cavities open, no pressure is negative."""
    time = np.linspace(0.0, 12.0 * TRANSIT, 121)
    load = np.where(time < 2.0 * TRANSIT, LOAD, 0.4 * LOAD)
    contact = solve(time, load, speed=0.6, nodes=513, keep_every=1)
    assert contact.ruptured.max() > 0.0
    assert contact.ruptured[-1] == 0.0
    assert contact.pressure.min() >= 0.0
    assert contact.load_per_width == pytest.approx(load, rel=1e-9)


def test_a_contact_that_cannot_follow_names_the_instant() -> None:
    time = np.linspace(0.0, 10.0 * TRANSIT, 21)
    # the bodies are pressed into each other by a millimetre within half a transit
    approach = np.where(time < 5.0 * TRANSIT, 5e-6, 1e-3)
    with pytest.raises(ComputationError, match=r"approach 0\.001 m.* instant 10 of 20, t ="):
        solve(time, impose="approach", approach=approach, reference_length=8e-3, step_halvings=1)


def test_an_approaching_contact_takes_up_load() -> None:
    """From an open gap under rolling: the load rises from nothing to that of the steady film."""
    time = np.linspace(0.0, 60.0 * TRANSIT, 241)
    closing = np.minimum(time / (30.0 * TRANSIT), 1.0)
    steady = solve(np.array([0.0, TRANSIT]), nodes=513)
    depth = float(steady.approach[0])
    contact = solve(
        time, impose="approach", approach=-4e-6 + (4e-6 + depth) * closing, start="unloaded",
        nodes=513, domain=steady.domain,
    )  # fmt: skip
    assert contact.load_per_width[0] == 0.0
    assert np.all(np.diff(contact.load_per_width[1:100]) > 0.0)
    assert contact.load_per_width[-1] == pytest.approx(LOAD, rel=2e-3)
    assert contact.central_film[-1] == pytest.approx(steady.central_film[0], rel=1e-3)
