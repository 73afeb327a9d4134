"""All losses of a gear stage: the sum of the single laws, both efficiencies, and the rig."""

from __future__ import annotations

import math

import numpy as np
import pytest

from known_pairs import pair_of
from tribodyn.errors import InputError
from tribodyn.losses import (
    BEARINGS,
    Gearbox,
    ShaftParts,
    bearing_moments,
    churning_loss,
    gearbox_losses,
    rig_power_flow,
    seal_loss,
    windage_loss,
)
from tribodyn.losses.gearbox import PARTS
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2e-8)
NU = 0.082 / 880.0
SHAFT = {"bearing": BEARINGS["NJ 406"], "seal_diameter": 30e-3, "bearing_drag_factor": 5e-4}
BOX = Gearbox(
    pinion=ShaftParts(**SHAFT, seals=2),
    wheel=ShaftParts(**SHAFT, immersion=30e-3, bearings=3, bearing_oil_level=20e-3),
    oil_volume=1.2e-3,
)
TORQUE, SPEED = np.array([50.0, 150.0, 300.0]), np.array([40.0, 150.0])


def stage(box=BOX, gear=0.0, torque=TORQUE, speed=SPEED, oil=OIL, **more):
    return gearbox_losses(
        pair_of(), box, gear, pinion_torque=torque, pinion_speed=speed, lubricant=oil, **more
    )


def test_every_part_is_its_law_at_the_speed_of_its_shaft():
    pair, losses = pair_of(), stage()
    for i, torque in enumerate(TORQUE):
        for j, speed in enumerate(SPEED):
            slow, force = speed / 1.5, torque / pair.pinion.base_radius
            fast_one = bearing_moments(BEARINGS["NJ 406"], speed, NU, force / 2, drag_factor=5e-4)
            slow_one = bearing_moments(
                BEARINGS["NJ 406"], slow, NU, force / 3, drag_factor=5e-4, oil_level=20e-3
            )
            for part in ("rolling", "sliding", "seal", "drag"):
                wanted = 2 * speed * getattr(fast_one, part) + 3 * slow * getattr(slow_one, part)
                assert getattr(losses, f"bearing_{part}")[i, j] == pytest.approx(wanted, rel=1e-12)
            seals = 2 * seal_loss(30e-3, speed) + seal_loss(30e-3, slow)
            assert losses.seal[i, j] == pytest.approx(float(seals), rel=1e-12)
            # 91.5 mm between centres: pitch radii of 36.6 and 54.9 mm.
            bath = churning_loss(54.9e-3, 20e-3, 4.5e-3, 30e-3, slow, 1.2e-3, 880.0, NU)
            assert losses.churning[i, j] == pytest.approx(bath, rel=1e-12)
            air = windage_loss(36.6e-3, 20e-3, speed, 0.082) + windage_loss(
                54.9e-3, 20e-3, slow, 0.082
            )
            assert losses.windage[i, j] == pytest.approx(air, rel=1e-12)
    parts = sum(getattr(losses, part) for part in PARTS)
    assert losses.total == pytest.approx(parts, rel=1e-14)


@pytest.mark.parametrize("balance", ["drive", "load", "both"])
def test_efficiency_is_output_over_input_whoever_pays(balance):
    lost = np.arange(1.0, 7.0).reshape(3, 2)
    losses = stage(gear=lost, torque_balance=balance)
    power = np.outer(TORQUE, SPEED)
    power_in, power_out = (
        (power, power - losses.total) if balance != "load" else (power + losses.total, power)
    )
    assert losses.efficiency == pytest.approx(power_out / power_in, rel=1e-14)
    alone = power / (power + lost) if balance == "load" else 1.0 - lost / power
    assert losses.gear_efficiency == pytest.approx(alone, rel=1e-14)


def test_without_shafts_the_teeth_are_all():
    losses = stage(Gearbox(windage=False), 7.0, oil=None)
    assert np.all(losses.total == 7.0)
    assert np.array_equal(losses.efficiency, losses.gear_efficiency)
    mist, dry = (stage(Gearbox(), oil=oil).windage for oil in (OIL, None))
    assert mist == pytest.approx(dry * ((0.028 * 82 + 0.019) / 0.019) ** 0.2, rel=1e-12)


def test_seals_and_oil_matter_most_under_little_load():
    losses = stage(gear=0.02 * np.outer(TORQUE, SPEED))
    assert np.all(np.diff(losses.efficiency, axis=0) > 0.0)
    assert losses.gear_efficiency == pytest.approx(0.98)


@pytest.mark.parametrize(
    ("box", "oil", "message"),
    [
        (Gearbox(pinion=ShaftParts(BEARINGS["6206"])), None, "pinion_bearing: there is no oil"),
        (Gearbox(wheel=ShaftParts(immersion=1e-2), oil_volume=1e-3), None, "wheel_immersion"),
        (
            Gearbox(pinion=ShaftParts(immersion=40e-3), oil_volume=1e-3), OIL,
            r"pinion_immersion: immersion = 40 mm.*36\.6 mm",
        ),
    ],
)  # fmt: skip
def test_invalid_boxes_are_refused(box, oil, message):
    with pytest.raises(InputError, match=message):
        stage(box, oil=oil)


def test_bad_shafts_and_boxes():
    for bad in ({"bearings": 0}, {"seals": 0}, {"seal_diameter": -1.0}, {"immersion": math.nan},
                {"bearing_drag_factor": 1.0}):  # fmt: skip
        with pytest.raises(InputError, match=next(iter(bad))):
            ShaftParts(**bad)
    with pytest.raises(InputError, match=r"oil_volume is missing.*1\.2 litres"):
        Gearbox(wheel=ShaftParts(immersion=1e-2))
    for gear in (np.ones(3), -1.0, math.nan):
        with pytest.raises(InputError, match="gear has the shape"):
            stage(gear=gear)


def test_the_motor_of_a_rig_brings_up_the_losses_of_both_boxes():
    point = {"torque": 150.0, "speed": 146.6}
    test, slave = stage(gear=200.0, **point), stage(Gearbox(windage=False), 150.0, **point)
    flow = rig_power_flow(test, slave)
    assert flow.motor_power == pytest.approx(test.total.item() + 150.0, rel=1e-14)
    assert flow.circulating_power == pytest.approx(150.0 * 146.6)
    assert flow.loss[:, flow.part.index("gear")].tolist() == [200.0, 150.0]
    assert flow.to_xarray().loss.sel(gearbox="slave", part="gear") == 150.0
    for other in (stage(), stage(torque=150.0, speed=147.0), stage(torque=151.0, speed=146.6)):
        with pytest.raises(InputError, match="the same in both gearboxes"):
            rig_power_flow(test, other)
