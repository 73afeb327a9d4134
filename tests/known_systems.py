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


def plain_slope(system, frequencies):
    """Right-hand side over time of a system over phases, as its equations are printed."""
    inverse, size = np.linalg.inv(system.mass), system.size

    def value(entry, x):
        result = np.asarray(entry(np.array([x])) if callable(entry) else entry, dtype=float)
        return result.reshape(-1) if result.size > 1 else float(result.reshape(-1)[0])

    def along(function, cycles, offset, time):
        rate = float(np.dot(cycles, frequencies))
        x, step = (rate * time + offset) % 1.0, 1e-5
        slope = (value(function, x + step) - value(function, x - step)) / (2 * step)
        return value(function, x), rate * slope

    def slope(time, state):
        q, v = state[:size], state[size:]
        force = np.asarray(system.force) - system.stiffness @ q - system.damping @ v
        contact_forces = []
        for contact in system.contacts:
            x = (float(np.dot(contact.cycles, frequencies)) * time + contact.offset) % 1.0
            errors = [along(contact.error, contact.cycles, contact.offset, time)]
            errors += [along(term.error, term.cycles, 0.0, time) for term in contact.turning]
            h, gap = value(contact.direction, x), value(contact.gap, x)
            d, rate = np.array([h @ q, h @ v]) - np.sum(errors, axis=0)
            beyond = d - np.sign(d) * gap if abs(d) > gap else 0.0
            touching = abs(d) > gap or gap == 0.0
            normal = value(contact.stiffness, x) * beyond
            normal += value(contact.damping, x) * rate * touching
            rubbing = 0.0 if contact.friction is None else value(contact.friction, x)
            force = force - (h + rubbing) * normal
            contact_forces.append(normal)
        for friction in system.frictions:
            total = sum(contact_forces[j] for j in friction.contacts)
            contact = system.contacts[friction.contacts[0]]
            x = (float(np.dot(contact.cycles, frequencies)) * time + contact.offset) % 1.0
            load = min(abs(total) / friction.load, friction.limit)
            coefficient = np.polyval(np.atleast_1d(value(friction.coefficients, x))[::-1], load)
            force = force - value(friction.direction, x) * coefficient * total
        return np.concatenate((v, inverse @ force))

    return slope
