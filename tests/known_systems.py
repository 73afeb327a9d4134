"""The pair of the reference cases D1 and D2, built by hand from exact geometry.

z 16/24, m 4.5 mm, 20 deg, x 0.8635/-0.5103, a 91.5 mm, pinion driving at 900 rpm; 2e8 N/m per
tooth pair over the whole path, load shared equally, constant friction coefficient.
"""

from __future__ import annotations

import math

import numpy as np

from tribodyn.dynamics import Contact, System

MESH_FREQUENCY = 240.0

_M, _Z = 4.5e-3, (16, 24)
_ALPHA, _A = math.radians(20.0), 91.5e-3
_X = (0.8635, -0.5103)
BASE_RADIUS = tuple(0.5 * _M * z * math.cos(_ALPHA) for z in _Z)
_ALPHA_W = math.acos(0.5 * _M * sum(_Z) * math.cos(_ALPHA) / _A)
LINE = _A * math.sin(_ALPHA_W)
_PITCH = math.pi * _M * math.cos(_ALPHA)
_SHORT = sum(_X) - (_A - 0.5 * _M * sum(_Z)) / _M
_TIP = [0.5 * _M * z + _M * (1.0 + x - _SHORT) for z, x in zip(_Z, _X, strict=True)]
_START = LINE - math.sqrt(_TIP[1] ** 2 - BASE_RADIUS[1] ** 2)
_END = math.sqrt(_TIP[0] ** 2 - BASE_RADIUS[0] ** 2)
_PITCH_POINT = BASE_RADIUS[0] * math.tan(_ALPHA_W)
DOUBLE = (_END - _START) / _PITCH - 1.0
EVENTS = (0.0, (_PITCH_POINT - _START) / _PITCH, DOUBLE)

MASS = np.diag([0.676, 0.676, 407e-6, 1.084, 1.084, 1168e-6])
SUPPORT = np.diag([1.0, 1.0, 0.0, 1.0, 1.0, 0.0])
DIRECTION = np.array([0.0, 1.0, BASE_RADIUS[0], 0.0, -1.0, -BASE_RADIUS[1]])


def pairs_in_contact(phase):
    return np.where(phase < DOUBLE, 2.0, 1.0)


def friction_vector(phase, coefficient):
    """Generalized friction force per unit mesh force, (p, 6)."""
    out = np.zeros((phase.size, 6))
    for pair in (0, 1):
        lever = _START + (phase + pair) * _PITCH
        share = np.where(lever < _END, 1.0 / pairs_in_contact(phase), 0.0)
        pull = np.sign(lever - _PITCH_POINT) * coefficient * share
        out += pull[:, None] * np.stack(
            [
                np.ones_like(phase), np.zeros_like(phase), lever,
                -np.ones_like(phase), np.zeros_like(phase), -(LINE - lever),
            ],
            axis=1,
        )  # fmt: skip
    return out


def reference_system(coefficient=0.0, **contact):
    options = {
        "direction": DIRECTION,
        "stiffness": lambda phase: 2e8 * pairs_in_contact(phase),
        "damping": 900.0,
        "friction": (lambda phase: friction_vector(phase, coefficient)) if coefficient else None,
        "events": EVENTS,
    } | contact
    return System(
        MASS,
        4e3 * SUPPORT,
        3.5e9 * SUPPORT,
        [0.0, 0.0, 90.0, 0.0, 0.0, -135.0],
        [Contact(**options)],
        names=("pinion_x", "pinion_y", "pinion_theta", "wheel_x", "wheel_y", "wheel_theta"),
    )


def hysteresis_system():
    """Case H1: one degree of freedom with a dead zone and a pulsating stiffness."""
    contact = Contact([1.0], stiffness=lambda phase: 1.0 + 0.2 * np.cos(2 * np.pi * phase), gap=1.0)
    return System([[1.0]], [[0.1]], [[0.0]], [0.5], [contact])


def turning(phase):
    """Direction of a contact of three coordinates that turns with the phase."""
    angle = 2 * np.pi * phase
    return np.stack([1.0 + 0 * phase, 0.2 * np.sin(angle), 0.3 * np.cos(angle)], axis=1)


def everything_varies(stiffness=1.0, friction=0.02, more=(), **loads):
    """Two contacts with dead zones and more, directions and loads that move with the phase."""
    first = Contact(
        turning,
        stiffness=lambda phase: stiffness * (40.0 + np.where(phase < 0.4, 20.0, 0.0)),
        damping=0.3,
        error=lambda phase: 0.02 * np.sin(4 * np.pi * phase),
        gap=lambda phase: 0.01 + 0.005 * np.cos(2 * np.pi * phase),
        friction=lambda phase: (
            np.where(phase < 0.55, friction, -friction)[:, None] * [1.0, -1.0, 0.5]
        ),
        events=(0.4, 0.55),
    )
    second = Contact([0.0, 1.0, -1.0], stiffness=25.0, damping=0.2, gap=0.02, damping_in_gap=True)
    return System(
        np.array([[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 0.5]]),
        0.5 * np.eye(3),
        np.array([[3.0, -1.0, 0.0], [-1.0, 4.0, -1.0], [0.0, -1.0, 2.0]]),
        lambda phase: np.stack([np.sin(2 * np.pi * phase), 0 * phase, 1.0 + 0 * phase], axis=1),
        [first, second, *more],
        **loads,
    )
