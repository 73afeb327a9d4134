"""Hypoid pairs that tests share."""

import math

import numpy as np

from tribodyn.errors import InputError
from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks


def h1043(**more):
    """10 teeth against 43, offset 31.7 mm, a cutter of 9 in."""
    return hypoid_blank(10, 43, 31.7e-3, 336e-3, 47.7e-3, math.radians(46.0), 114.3e-3, **more)


def eased(blank=None, side="drive", along=0.5e-4, across=2e-4, twist=0.3e-4, scale=1.0):
    """Flanks, of 10 x 43 by default, with coefficients [1/mm] of an ease-off about P = -2.2 mm."""
    blank = blank or h1043()
    width = 0.5 * blank.face_width_wheel
    depth = 0.5 * (blank.mean_addendum_pinion + blank.mean_addendum_wheel)
    ease = EaseOff(
        lengthwise_crowning=scale * 1e3 * along * width**2,
        profile_crowning=scale * 1e3 * across * depth**2,
        bias=scale * 1e3 * twist * width * depth,
        center=(0.0, -2.2e-3),
    )
    return hypoid_flanks(blank, side, ease, points=9)


def random_blanks(number, seed=0, **more):
    """Blanks of random designs: teeth, offset of both signs, spiral angle and cutter."""
    random_generator, blanks, refused = np.random.default_rng(seed), [], 0
    while len(blanks) < number:
        diameter = random_generator.uniform(0.15, 0.4)
        offset = diameter * random_generator.uniform(0.05, 0.15)
        try:
            blanks.append(
                hypoid_blank(
                    int(random_generator.integers(8, 16)),
                    int(random_generator.integers(30, 46)),
                    offset,
                    diameter,
                    0.14 * diameter,
                    math.radians(random_generator.uniform(42.0, 50.0)),
                    random_generator.uniform(0.33, 0.4) * diameter,
                    hand_pinion=("left", "right")[len(blanks) % 2],
                    **more,
                )
            )
        except InputError:
            refused += 1
    assert refused <= number // 10
    return blanks


def contact_rows(flanks, places):
    """Direction and sliding direction (p, 12) of contacts at places on the wheel's flank.

    Worked out in the fixed frame and written in those of the gears: x common, y along the axis of
    each gear in its running sense.
    """
    touch, sense = flanks.touch(np.asarray(places)), flanks.sense
    position, normal = touch.contact.wheel[:2]
    sliding = sense * touch.sliding
    tangent = sliding / np.linalg.norm(sliding, axis=-1, keepdims=True)
    frames = (sense * np.array([[sense, 0, 0], [0, 1, 0], [0, 0, 1]]),
              np.array([[1, 0, 0], [0, 0, -sense], [0, sense, 0]]))  # fmt: skip
    rows = []
    for way in (normal, tangent):
        parts = [
            sign * np.hstack([way @ frame.T, np.cross(position - origin, way) @ frame.T])
            for sign, frame, origin in zip(
                (1.0, -1.0), frames, (flanks.axes.origin, np.zeros(3)), strict=True
            )
        ]
        rows.append(np.hstack(parts))
    return rows[0], rows[1], np.linalg.norm(sliding, axis=-1)
