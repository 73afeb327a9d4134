"""Orders of a run-up: synthetic orders come out exactly, peaks meet their modes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tribodyn.analysis import order_cut, overall_level, resonances, run_up_order_map
from tribodyn.dynamics import Contact, RunUp, System, run_up, speed_ramp
from tribodyn.errors import InputError


@pytest.fixture(scope="module")
def bare() -> RunUp:
    """100 to 300 Hz and back in 2 s, 16 teeth; its signals are replaced by known ones."""
    spring = System([[1.0]], [[1.0]], [[0.0]], [0.0], [Contact([1.0], stiffness=1.0)])
    return run_up(spring, speed_ramp(100.0, 300.0, 1.0, down=True), teeth=16, samples=32)


def synthetic(run: RunUp, *orders: tuple[float, float]) -> RunUp:
    """A contact force of orders of the mesh with amplitudes, and a mean of 5 N."""
    force = 5.0 + sum(a * np.cos(2 * np.pi * k * run.phase + k) for k, a in orders)
    return replace(run, contact_force=np.asarray(force)[:, None])


def test_cuts_of_synthetic_orders_are_exact(bare: RunUp) -> None:
    run = synthetic(bare, (1.0, 3.0), (2.0, 0.5), (3.5, 0.25))
    for order, amplitude in ((1.0, 3.0), (2.0, 0.5), (3.5, 0.25), (3.0, 0.0), (5.0, 0.0)):
        cut = order_cut(run, order)
        assert cut.amplitude == pytest.approx(amplitude, abs=1e-11)
        assert cut.order == 16.0 * order
    of_shaft = synthetic(bare, (1.5 / 16, 2.0), (1.0, 7.0))
    cut = order_cut(of_shaft, 1.5, of="shaft")
    assert cut.order == 1.5
    assert cut.amplitude == pytest.approx(2.0, abs=1e-11)
    assert cut.unit == "N"


def test_cuts_tell_the_speed_and_the_way(bare: RunUp) -> None:
    grows = replace(
        bare, contact_force=(bare.mesh_frequency * np.cos(2 * np.pi * bare.phase))[:, None]
    )
    for part, sign in (("up", 1.0), ("down", -1.0)):
        cut = order_cut(grows, 1, part=part)
        assert np.all(np.sign(np.diff(cut.speed)) == sign)
        # amplitude = mesh frequency = speed * 16 / 2 pi
        assert cut.amplitude == pytest.approx(cut.speed * 16 / (2 * np.pi), rel=1e-3)
    with pytest.raises(InputError, match="never goes down"):
        order_cut(
            replace(bare, cycles=replace(bare.cycles, rate=np.abs(bare.cycles.rate))),
            1,
            part="down",
        )
    with pytest.raises(InputError, match="mesh order 16"):
        order_cut(bare, 16)


def test_order_maps_count_per_revolution(bare: RunUp) -> None:
    orders_map = run_up_order_map(synthetic(bare, (1.0, 3.0), (2.5, 0.5)), cycles=8)
    assert float(orders_map.order[orders_map.strongest()[0]]) == 16.0
    assert orders_map.cut(40.0).amplitude == pytest.approx(0.5, abs=1e-11)
    assert order_cut(orders_map, 40.0).amplitude == pytest.approx(0.5, abs=1e-11)
    assert orders_map.speed[0] == pytest.approx(2 * np.pi * 100 / 16, rel=0.1)


def test_the_overall_level_is_the_rms_without_the_mean(bare: RunUp) -> None:
    acceleration = 7.0 + 2.0 * np.sin(2 * np.pi * bare.phase)
    moments = bare.cycles.acceleration
    figures = replace(moments, mean=0 * moments.mean + 7.0, rms=0 * moments.rms + np.sqrt(51.0))
    run = replace(
        bare,
        acceleration=acceleration[:, None],
        cycles=replace(bare.cycles, acceleration=figures),
    )
    assert overall_level(run, "q0").rms == pytest.approx(np.sqrt(2.0), rel=1e-12)
    two = np.stack((acceleration, acceleration), axis=1)
    scaled = replace(run, contact_force=two, deflection=two)  # sum of two contacts: from samples
    assert overall_level(scaled).rms == pytest.approx(2.0 * np.sqrt(2.0), rel=1e-12)


def test_peaks_lie_where_orders_meet_modes() -> None:
    natural = 2000.0
    teeth = Contact(
        [1.0],
        stiffness=(2 * np.pi * natural) ** 2,
        damping=2 * 0.01 * 2 * np.pi * natural,
        error=lambda p: 1e-6 * np.cos(2 * np.pi * p) + 1e-6 * np.cos(6 * np.pi * p),
    )
    system = System([[1.0]], [[0.0]], [[0.0]], [0.0], [teeth])
    run = run_up(system, speed_ramp(600.0, 2200.0, 6.0), teeth=20, samples=16)
    peaks = resonances(run, "deflection", orders=(1, 2, 3), prominence=0.3)
    assert [each.order for each in sorted(peaks, key=lambda peak: peak.order)] == [1.0, 3.0]
    for each in peaks:
        assert each.mode == 0
        assert each.mode_frequency == pytest.approx(natural, rel=1e-9)
        assert each.frequency == pytest.approx(natural, rel=0.015)
        assert each.speed == pytest.approx(2 * np.pi * natural / each.order / 20, rel=0.015)
        # at resonance the compression is the error over twice the damping ratio
        assert each.amplitude == pytest.approx(1e-6 / 0.02, rel=0.06)
        assert each.mains == 0.0
    assert "resonance" in {trace.name for trace in run.plot().data}
    assert run.plot_map().layout.xaxis.title.text == "Speed [rpm]"


def test_peaks_at_mains_frequency_are_flagged() -> None:
    # order 1.5 at 2017 rpm is 50.4 Hz, which may be the mains; here 49.8 Hz, passed late
    natural = 49.8
    teeth = Contact([1.0], (2 * np.pi * natural) ** 2, 0.04 * np.pi * natural * 2,
                    error=lambda p: np.cos(2 * np.pi * p))  # fmt: skip
    system = System([[1.0]], [[0.0]], [[0.0]], [0.0], [teeth])
    run = run_up(system, speed_ramp(30.0, 80.0, 20.0), samples=16)
    (peak,) = resonances(run, "deflection", orders=[1])
    assert peak.mains == 50.0
