"""The part of a response that is measured: a whole orbit, or the second half of a transient."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from tribodyn.dynamics import FineSamples, Response, System
    from tribodyn.study.result import Result

__all__ = [
    "centre_column",
    "compression",
    "first_touch",
    "is_steady",
    "measured",
    "mesh_force",
    "one_sided_phase",
    "support_forces",
    "transmission_error",
]

#: Distance from an event that tells its two sides apart [mesh cycles].
_SIDE = 1e-11
#: What structures with shafts call the directions across and along the line of action.
_LETTERS = {"x": "v", "y": "w"}


def is_steady(response: Response) -> bool:
    """Tell a periodic orbit from a transient.

    Parameters
    ----------
    response : Response
        Any motion.

    Returns
    -------
    bool
    """
    return response.floquet_multipliers.size > 0


def centre_column(names: Sequence[str], gear: str, axis: str) -> int | None:
    """Find the coordinate of a gear's centre.

    Parameters
    ----------
    names : sequence of str
        Coordinates of the structure.
    gear : str
        ``"pinion"`` or ``"wheel"``.
    axis : str
        ``"y"`` along the line of action, ``"x"`` across it.

    Returns
    -------
    int or None
        Its column; None where the structure only turns.

    Examples
    --------
    >>> centre_column(("pinion_x", "pinion_y"), "pinion", "y")
    1
    >>> centre_column(("wheel_v", "wheel_w"), "wheel", "x")
    0
    """
    known = [f"{gear}_{letter}" for letter in (axis, _LETTERS[axis])]
    return next((column for column, name in enumerate(names) if name in known), None)


def measured(response: Response) -> FineSamples:
    """Samples over which the figures of a summary are taken.

    Parameters
    ----------
    response : Response
        Orbit or transient.

    Returns
    -------
    FineSamples
        Of whole mesh cycles, with weights that sum to one.
    """
    fine = response.fine
    first = 0 if is_steady(response) else response.periods // 2
    skipped = fine.phase.size * first // response.periods
    part = replace(fine, **{f.name: getattr(fine, f.name)[skipped:] for f in fields(fine)})
    return replace(part, phase=part.phase - first, weight=part.weight / part.weight.sum())


def one_sided_phase(samples: FineSamples) -> NDArray[np.float64]:
    """Phase of each sample moved by a hair into its own step, so that events have two sides.

    Parameters
    ----------
    samples : FineSamples
        Both ends and the middle of every step.

    Returns
    -------
    (3 * steps,) array
        Mesh phase [cycles].
    """
    steps = samples.phase.reshape(-1, 3) + np.array([_SIDE, 0.0, -_SIDE])
    return np.asarray(steps.reshape(-1))


def mesh_force(samples: FineSamples) -> NDArray[np.float64]:
    """Force of the mesh: the sum over the ramps of its force law, damping included.

    Parameters
    ----------
    samples : FineSamples
        Samples of a gear pair.

    Returns
    -------
    (3 * steps,) array
        Force along the line of action, positive where the driving flanks push [N].
    """
    return np.asarray(samples.contact_force.sum(axis=1))


def compression(samples: FineSamples) -> NDArray[np.float64]:
    """Compression of the mesh, which all ramps of its force law share.

    Parameters
    ----------
    samples : FineSamples
        Samples of a gear pair.

    Returns
    -------
    (3 * steps,) array
        Counted from the middle of the play [m].
    """
    return samples.deflection[:, 0]


def first_touch(system: System, samples: FineSamples) -> NDArray[np.float64]:
    """Compression at which the driving flanks begin to touch; its negative is that of the others.

    Parameters
    ----------
    system : System
        The structure and the contacts of its mesh; the first of them is the last to open.
    samples : FineSamples
        Samples of its motion.

    Returns
    -------
    (3 * steps,) array
        Half of the play, and what the flanks have been relieved by there [m].
    """
    gap = system.contacts[0].gap
    values = gap(one_sided_phase(samples)) if callable(gap) else gap
    return np.broadcast_to(np.asarray(values, dtype=float), samples.phase.shape)


def transmission_error(result: Result, samples: FineSamples) -> NDArray[np.float64]:
    """Dynamic transmission error, counted from first contact of the driving flank.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` made.
    samples : FineSamples
        Samples of its response.

    Returns
    -------
    (3 * steps,) array
        Compression of the mesh, errors included [m].
    """
    error = compression(samples) + result.static_error(samples.phase)
    return np.asarray(error - result.half_backlash)


def support_forces(system: System, samples: FineSamples) -> NDArray[np.float64]:
    """Forces of the bodies on their supports, from springs and dampers together.

    Parameters
    ----------
    system : System
        The structure.
    samples : FineSamples
        Samples of its response.

    Returns
    -------
    (3 * steps, n) array
        Generalized force of each coordinate [N or N*m].
    """
    stiffness, damping = np.asarray(system.stiffness), np.asarray(system.damping)
    return np.asarray(samples.position @ stiffness.T + samples.velocity @ damping.T)
