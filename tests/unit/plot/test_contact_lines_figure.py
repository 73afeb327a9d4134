"""Lines of contact in space: they lie in the plane of action, and are as long as computed."""

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.gear import CylindricalPair, cylindrical_pair
from tribodyn.plot import contact_lines
from tribodyn.plot.gear.flanks import line_points
from tribodyn.plot.gear.gear_pair import on_line_of_action, tooth_angles, wheel_center


def _pair(wheel: int = 51, helix: float = 21.0, **changes: Any) -> CylindricalPair:
    return cylindrical_pair(
        pinion_teeth=27,
        wheel_teeth=wheel,
        normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(helix),
        pinion_face_width=50e-3,
        **changes,
    )


PAIRS = [
    _pair(),
    _pair(hand="left", driver="wheel"),
    _pair(wheel=-80, helix=12.0),
    _pair(helix=0.0),
]


@pytest.mark.parametrize("pair", PAIRS, ids=repr)
def test_lines_lie_in_the_plane_of_action(pair: CylindricalPair) -> None:
    base = 1e3 * pair.pinion.base_radius
    normals = []
    for phase in (0.1, 0.35, 0.6):
        lines = line_points(pair, phase)
        lengths = [float(np.linalg.norm(line[:, -1] - line[:, 0])) for line in lines]
        assert sum(lengths) == pytest.approx(1e3 * float(pair.contact_line_length(phase)), rel=1e-9)
        # The plane that all lines touch is tangent to the base cylinder.
        points = np.hstack(lines)[1:]
        angles = np.linspace(0.0, 2.0 * math.pi, 72001)
        misfit = np.abs(
            np.outer(np.cos(angles), points[0]) + np.outer(np.sin(angles), points[1]) - base
        )
        best = int(misfit.max(axis=1).argmin())
        assert misfit[best].max() < 2e-3
        normals.append(angles[best])
        # A line crosses the face under the base helix angle.
        for line in lines:
            along = abs(line[0, -1] - line[0, 0])
            tilt = along / np.linalg.norm(line[:, -1] - line[:, 0])
            assert tilt == pytest.approx(math.cos(pair.base_helix_angle), rel=1e-9)
    # In the frame of the pinion the plane turns back while the pinion turns on.
    pitch = 2.0 * math.pi / pair.pinion.teeth
    turned = np.diff(np.unwrap(normals))
    assert turned == pytest.approx(-pitch * np.diff([0.1, 0.35, 0.6]), abs=3e-4)


def test_figure_plays_a_mesh_cycle() -> None:
    figure = contact_lines(PAIRS[0])
    assert len(figure.frames) == 24
    assert "72.0 mm to 83.2 mm" in contact_lines(_pair(center_distance=190e-3, **{
        "pinion_profile_shift_coefficient": 0.231415, "wheel_profile_shift_coefficient": 0.231415,
    })).layout.title.text  # fmt: skip
    steps = figure.layout.sliders[0].steps
    assert steps[6].label.startswith("Mesh phase 0.25: ")


@pytest.mark.parametrize("pair", PAIRS, ids=repr)
def test_outlines_touch_on_the_line_of_action(pair: CylindricalPair) -> None:
    """Teeth placed for the drawing: both flanks pass the point, and neither overlaps there."""
    path = float(np.mean(pair.path_limits))
    x, y = on_line_of_action(pair, path)
    for gear, center, angle in zip(
        pair.gears.values(), (0.0, wheel_center(pair)), tooth_angles(pair, path), strict=True
    ):
        radius = math.hypot(x - center, y)
        place = math.atan2(y, x - center)
        assert abs(place - angle) == pytest.approx(gear.half_tooth_angle(radius), rel=1e-9)
        # The flank is on the side towards which the pinion turns, of a ring on the other.
        assert (place - angle > 0.0) == (not gear.is_ring)
    assert math.hypot(x, y) == pytest.approx(math.hypot(pair.pinion.base_radius, path))
    reach = abs(pair.line_of_action_length - path)
    assert math.hypot(x - wheel_center(pair), y) == pytest.approx(
        math.hypot(pair.wheel.base_radius, reach)
    )
