"""Load on internal pairs: a ring with many teeth tends to a rack, as a wheel does."""

import math

import pytest

from tribodyn.gear import CylindricalPair, cylindrical_pair
from tribodyn.stiffness import loaded_contact


def _pair(teeth: int, bore: float = 0.0) -> CylindricalPair:
    return cylindrical_pair(
        pinion_teeth=24,
        wheel_teeth=teeth,
        normal_module=3e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(12.0),
        pinion_face_width=30e-3,
        pinion_bore_diameter=30e-3,
        wheel_bore_diameter=bore,
    )


def _mean_error(teeth: int) -> float:
    """Mean transmission error of a wheel whose rim is 3.5 modules thick, as that of a ring [m]."""
    pair = _pair(teeth)
    if teeth > 0:
        pair = _pair(teeth, 2.0 * (pair.wheel.root_radius - 10.5e-3))
    contact = loaded_contact(pair, 200.0, provider="fe2d", reference="bore", phases=8)
    return float(contact.mean_transmission_error)


def test_rings_and_wheels_with_many_teeth_meet_at_the_rack() -> None:
    """The error is linear in one over the teeth of the wheel, through zero, which is the rack."""
    errors = {teeth: _mean_error(teeth) for teeth in (-400, -200, 200, 400)}
    assert errors[-200] < errors[-400] < errors[400] < errors[200]
    from_many, from_few = (0.5 * (errors[-teeth] + errors[teeth]) for teeth in (400, 200))
    assert from_many == pytest.approx(from_few, rel=3e-3)
    rise = (errors[200] - errors[-200]) / (errors[400] - errors[-400])
    assert rise == pytest.approx(2.0, rel=0.05)
