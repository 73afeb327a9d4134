"""Phase portraits: velocity over position of a motion that is known."""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.response import Response
from tribodyn.errors import InputError
from tribodyn.nonlinear.poincare import poincare
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array


@record
class PhasePortrait(Record):
    """One coordinate, or the compression of a contact, in its phase plane.

    Parameters
    ----------
    name : str
        Name of the coordinate, or ``contact 0``.
    position, velocity : (points,) array
        The motion [m or rad, m/s or rad/s]; a motion that repeats is closed.
    section_position, section_velocity : (cycles,) array
        The same at the mesh phase 0.
    period : int
        Mesh cycles after which the motion repeats; 0 if it does not.
    gap : float
        Half of the backlash of the contact [m]; -1 for a coordinate.
    mesh_frequency : float
        Mesh frequency [Hz].
    verdict : "physical", "step-limited", "undecided" or ""
        What half the step says of it; empty where it was not asked.
    """

    name: str = fact()
    position: Array = quantity("point", unit="m or rad")
    velocity: Array = quantity("point", unit="m/s or rad/s")
    section_position: Array = quantity("mesh_cycle", unit="m or rad")
    section_velocity: Array = quantity("mesh_cycle", unit="m/s or rad/s")
    period: int = fact()
    gap: float
    mesh_frequency: float = fact()
    verdict: str = fact(default="")

    def __repr__(self) -> str:
        """One line."""
        return (
            f"PhasePortrait(name={self.name!r}, period={self.period!r}, "
            f"mesh_frequency={self.mesh_frequency!r}, verdict={self.verdict!r})"
        )


def phase_portrait(
    motion: Response,
    of: int | str = 0,
    *,
    gap: float = -1.0,
    transient: int = 0,
    system: System | None = None,
) -> PhasePortrait:
    """Take one coordinate or one contact of a motion into its phase plane.

    Parameters
    ----------
    motion : Response
        From :func:`tribodyn.dynamics.steady_state` or :func:`tribodyn.dynamics.simulate`.
    of : int or str
        Number of a contact, whose compression is looked at, or name of a coordinate.
    gap : float
        Half of the backlash of the contact [m], which the figure then shows.
    transient : int
        First mesh cycles to leave out.
    system : System, optional
        That of the motion: it is then marched again with half the step, for the verdict.

    Returns
    -------
    PhasePortrait

    Raises
    ------
    InputError
        If there is no such contact or coordinate, or nothing is left of the motion.

    Notes
    -----
    The rate of a compression is taken by differences of second order over the rows, since a
    Response holds no exact one.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[(2.0 * np.pi) ** 2]], [0.0])
    >>> turn = phase_portrait(simulate(free, 1.0, 4, ([1.0], [0.0]), steps=256), "q0")
    >>> turn.period, float(abs(turn.velocity).max().round(4))
    (1, 6.2832)
    """
    cycles = motion.periods - transient
    known = isinstance(of, str) and of in motion.names
    contact = not isinstance(of, str) and 0 <= of < motion.deflection.shape[1]
    if cycles < 1 or not (known or contact):
        raise InputError(
            f"{of!r} after {transient} of {motion.periods} mesh cycles",
            where="argument of",
            why=f"A contact from 0 to {motion.deflection.shape[1] - 1}, or one of "
            f"{', '.join(motion.names)}, over at least one mesh cycle",
        )
    steps = len(motion.position) // motion.periods
    rows = slice(transient * steps, None)
    if isinstance(of, str):
        column = motion.names.index(of)
        place, speed = motion.position[rows, column], motion.velocity[rows, column]
    else:
        place = motion.deflection[rows, of]
        speed = np.asarray(np.gradient(place, motion.time[rows]))
    section = poincare(motion, transient=transient, system=system)
    mark = slice(0, None, steps)
    points = place[mark], speed[mark]
    if motion.floquet_multipliers.size:
        place, speed = np.append(place, place[0]), np.append(speed, speed[0])
    return PhasePortrait(
        name=of if isinstance(of, str) else f"contact {of}",
        position=place,
        velocity=speed,
        section_position=points[0],
        section_velocity=points[1],
        period=section.period,
        gap=max(gap, 0.0) if not isinstance(of, str) else -1.0,
        mesh_frequency=motion.mesh_frequency,
        verdict=section.verdict,
    )
