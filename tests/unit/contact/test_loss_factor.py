"""Gear loss factor against time averages and the closed form where that holds."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tribodyn.contact import equal_share, gear_loss_factor, path_of_contact
from tribodyn.errors import ComputationError
from tribodyn.gear import BasicRack, CylindricalPair, SpurPair, cylindrical_pair, spur_pair

TALL = BasicRack(1.35, 1.6, 0.25)


def plain(**changes: Any) -> SpurPair:
    defaults = {
        "pinion_teeth": 20,
        "wheel_teeth": 30,
        "normal_module": 4e-3,
        "normal_pressure_angle": math.radians(20.0),
        "pinion_face_width": 20e-3,
    }
    return spur_pair(**{**defaults, **changes})


TALL_PAIR = {
    "pinion_teeth": 60,
    "wheel_teeth": 80,
    "normal_pressure_angle": math.radians(17.5),
    "pinion_rack": TALL,
    "wheel_rack": TALL,
}


def ohlendorf(pair: SpurPair) -> float:
    contact = path_of_contact(pair)
    pitch = pair.base_pitch
    recess, approach = abs(contact.E - contact.C) / pitch, abs(contact.C - contact.A) / pitch
    bracket = 1.0 - contact.contact_ratio + recess**2 + approach**2
    return math.pi * (pair.ratio + 1.0) / (pair.pinion.teeth * pair.ratio) * bracket


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_closed_form_holds_with_the_pitch_point_in_single_contact(driver: str) -> None:
    pair = plain(driver=driver)
    assert gear_loss_factor(pair) == pytest.approx(ohlendorf(pair), rel=1e-12)


@pytest.mark.parametrize("changes", [{}, TALL_PAIR, {"driver": "wheel"}])
def test_integral_over_the_path_is_the_mean_over_the_mesh_cycle(changes: dict[str, Any]) -> None:
    pair = plain(**changes)
    contact = path_of_contact(pair)
    count = 40000
    path, touching = contact.pair_paths((np.arange(count) + 0.5) / count)
    sliding = np.abs(contact.kinematics(path, 1.0).sliding_speed)
    share = touching / touching.sum(axis=1, keepdims=True)
    mean = (share * sliding).sum(axis=1).mean() / pair.pinion.base_radius
    assert gear_loss_factor(pair) == pytest.approx(mean, rel=2e-4)


def test_equal_share_is_the_default_and_sums_to_one() -> None:
    pair = plain(**TALL_PAIR)
    contact = path_of_contact(pair)

    def share(path: NDArray[np.float64]) -> NDArray[np.float64]:
        return equal_share(contact, path)

    assert gear_loss_factor(pair, share) == gear_loss_factor(pair)
    start = contact.A + 0.4 * contact.pair.base_pitch
    path = start + np.arange(float(contact.pairs)) * contact.pair.base_pitch
    path = path[path < contact.E]
    assert equal_share(contact, path).sum() == pytest.approx(1.0, rel=1e-15)


def test_load_on_a_single_point_weighs_its_sliding() -> None:
    """A share that grows with the distance from C, integrated by hand."""
    pair = plain()
    contact = path_of_contact(pair)
    loss = gear_loss_factor(pair, lambda path: np.abs(path - contact.C) / pair.base_pitch)
    cubes = abs(contact.E - contact.C) ** 3 + abs(contact.C - contact.A) ** 3
    scale = (1.0 + 1.0 / pair.ratio) / (3.0 * pair.base_pitch**2 * pair.pinion.base_radius)
    assert loss == pytest.approx(scale * cubes, rel=1e-12)


def test_share_without_a_value_is_an_error() -> None:
    with pytest.raises(ComputationError, match="load share"):
        gear_loss_factor(plain(), lambda path: np.full_like(path, np.nan))


def helical(helix: float, width: float, wheel: int = 51) -> CylindricalPair:
    return cylindrical_pair(
        pinion_teeth=27,
        wheel_teeth=wheel,
        normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(helix),
        pinion_face_width=width,
    )


@pytest.mark.parametrize(("helix", "width", "wheel"), [(21.0, 50e-3, 51), (9.0, 60e-3, -90)])
def test_loss_factor_of_a_helical_pair_by_slices(helix: float, width: float, wheel: int) -> None:
    """Friction of equal line loads, summed over slices and phases without any closed form."""
    pair = helical(helix, width, wheel)
    contact = path_of_contact(pair)
    places = (np.arange(400) + 0.5) / 400 * pair.common_face_width
    path, in_contact = contact.face_paths((np.arange(800) + 0.5) / 800, places)
    speed = np.abs(contact.kinematics(path, 1.0).sliding_speed) / pair.pinion.base_radius
    mean = np.where(in_contact, speed, 0.0).sum(axis=(1, 2)) / in_contact.sum(axis=(1, 2))
    expected = float(mean.mean()) / math.cos(pair.base_helix_angle)
    assert gear_loss_factor(pair) == pytest.approx(expected, rel=3e-4)
    shares = equal_share(contact, contact.A + np.linspace(0.05, 0.95, 9) * pair.base_pitch)
    assert np.all((shares > 0.0) & (shares <= 1.0))


def test_loss_factor_tends_to_that_of_the_spur_pair() -> None:
    assert gear_loss_factor(helical(1e-4, 50e-3)) == pytest.approx(
        gear_loss_factor(helical(0.0, 50e-3)), rel=1e-5
    )


def test_closed_form_of_a_whole_overlap() -> None:
    """With a whole overlap ratio all lengths are equal, and the line load is constant."""
    pair = helical(21.0, math.pi * 4.5e-3 / math.sin(math.radians(21.0)))
    assert pair.overlap_ratio == pytest.approx(1.0, rel=1e-12)
    approach = (path_of_contact(pair).C - pair.path_limits[0]) / pair.base_pitch
    recess = pair.transverse_contact_ratio - approach
    squares = (approach**2 + recess**2) / pair.transverse_contact_ratio
    expected = math.pi * (1.0 + 27.0 / 51.0) / 27.0 * squares / math.cos(pair.base_helix_angle)
    assert gear_loss_factor(pair) == pytest.approx(expected, rel=1e-9)
