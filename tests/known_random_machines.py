"""Random machines: chains of bodies with several meshes on one clock."""

import numpy as np

from tribodyn.dynamics import Contact, LoadFriction, System


def _wave(generator, size, orders=3):
    """Random Fourier series over a mesh phase with a mean of ``size`` or zero."""
    amplitude = generator.normal(size=orders) / np.arange(1, orders + 1) ** 2
    shift = generator.uniform(0.0, 2.0 * np.pi, orders)

    def wave(phase):
        angles = 2.0 * np.pi * np.multiply.outer(phase, np.arange(1, orders + 1)) + shift
        return size * np.cos(angles) @ amplitude

    return wave


def random_machine(seed: int, *, depth: float = 0.1, gap: float | None = None, **parts) -> System:
    """A machine of 3 to 12 coordinates and 2 to 4 contacts with 1 to 9 cycles, scaled to one.

    ``depth`` is the size of errors and of the variation of stiffness; ``gap`` half of a dead zone
    or None. ``parts`` switch ``friction``, ``turning`` directions, ``gyroscopic``, ``torque`` over
    the clock and ``jumps`` on.
    """
    g = np.random.default_rng(seed)
    contacts = int(g.integers(2, 5))
    size = int(g.integers(max(3, contacts + 1), 13))
    links = np.diff(np.eye(size), axis=0) if size > 1 else np.zeros((0, 1))
    support = np.diag(g.uniform(0.05, 0.3, size))
    stiffness = support + links.T @ np.diag(g.uniform(0.2, 2.0, size - 1)) @ links
    mass = np.diag(g.uniform(0.5, 2.0, size))
    damping = 0.05 * stiffness + np.diag(g.uniform(0.05, 0.2, size))
    skew = np.triu(g.normal(size=(size, size)), 1) * 0.1
    ends = np.array([[j, j + 1] for j in g.choice(size - 1, contacts, replace=False)])
    force = np.zeros(size)
    meshes = []
    for j, (left, right) in enumerate(ends):
        direction = np.zeros(size)
        direction[[left, right]] = 1.0, -1.0
        force += direction * g.uniform(0.8, 1.2)
        meshes.append(_contact(g, direction, j, depth, gap, parts))
    load = force
    if parts.get("torque"):
        swing = _wave(g, 0.1)
        load = lambda clock: np.multiply.outer(1.0 + swing(clock), force)  # noqa: E731
    drags = ()
    if parts.get("load_friction"):
        across = g.normal(size=size)
        drags = (LoadFriction(across, [0.05, 0.02, -0.005], load=1.0, contacts=(0,)),)
    return System(
        mass,
        damping,
        stiffness,
        load,
        meshes,
        frictions=drags,
        gyroscopic=skew - skew.T if parts.get("gyroscopic") else None,
    )


def _contact(g, direction, number, depth, gap, parts):
    rigidity = g.uniform(2.0, 6.0)
    swing, shake, turn = _wave(g, depth), _wave(g, depth / 4.0), _wave(g, 0.1)
    along = direction
    if parts.get("turning") and number == 0:
        other = g.normal(size=direction.size)
        along = lambda phase: direction + np.multiply.outer(turn(phase), other)  # noqa: E731
    events = (0.0,)
    stiffness = lambda phase: rigidity * (1.0 + swing(phase))  # noqa: E731
    if parts.get("jumps"):
        events = (0.0, 0.45)
        stiffness = lambda phase: rigidity * np.where(phase < 0.45, 1.0, 1.0 - depth)  # noqa: E731
    return Contact(
        along,
        stiffness,
        damping=0.05 * rigidity,
        error=shake,
        gap=0.0 if gap is None else gap * g.uniform(0.8, 1.2),
        friction=0.05 * g.normal(size=direction.size) if parts.get("friction") else None,
        events=events,
        cycles=int(g.integers(1, 10)),
        offset=float(g.uniform(0.0, 1.0)),
    )
