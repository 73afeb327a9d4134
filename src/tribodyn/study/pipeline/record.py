"""The part of a response that is measured: a whole orbit, or the second half of a transient."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import FineSamples, Response, System
    from tribodyn.study.pipeline.result import Result


#: Distance from an event that tells its two sides apart [mesh cycles].
_SIDE = 1e-11
#: What structures with shafts call the directions across and along the line of action.
_LETTERS = {"x": "v", "y": "w"}


def is_steady(response: Response) -> bool:
    """Tell a periodic orbit from a transient."""
    return response.floquet_multipliers.size > 0


def centre_column(names: Sequence[str], gear: str, axis: str) -> int | None:
    """Find the coordinate of a gear's centre."""
    known = [f"{gear}_{letter}" for letter in (axis, _LETTERS[axis])]
    return next((column for column, name in enumerate(names) if name in known), None)


def measured(response: Response) -> FineSamples:
    """Samples over which the figures of a summary are taken."""
    fine = response.fine
    first = 0 if is_steady(response) else response.periods // 2
    skipped = fine.phase.size * first // response.periods
    part = replace(fine, **{f.name: getattr(fine, f.name)[skipped:] for f in fields(fine)})
    return replace(part, phase=part.phase - first, weight=part.weight / part.weight.sum())


def one_sided_phase(samples: FineSamples) -> Array:
    """Phase of each sample moved by a hair into its own step, so that events have two sides."""
    steps = samples.phase.reshape(-1, 3) + np.array([_SIDE, 0.0, -_SIDE])
    return np.asarray(steps.reshape(-1))


def mesh_force(samples: FineSamples) -> Array:
    """Force of the mesh: the sum over the ramps of its force law, damping included."""
    return np.asarray(samples.contact_force.sum(axis=1))


def compression(samples: FineSamples) -> Array:
    """Compression of the mesh, which all ramps of its force law share."""
    return samples.deflection[:, 0]


def first_touch(system: System, samples: FineSamples) -> Array:
    """Compression at which the driving flanks touch; its negative is that of the others."""
    gap = system.contacts[0].gap
    values = gap(one_sided_phase(samples)) if callable(gap) else gap
    return np.broadcast_to(np.asarray(values, dtype=float), samples.phase.shape)


def transmission_error(result: Result, samples: FineSamples) -> Array:
    """Dynamic transmission error, counted from first contact of the driving flank."""
    error = compression(samples) + result.static_error(samples.phase)
    return np.asarray(error - result.half_backlash)


def support_forces(system: System, samples: FineSamples) -> Array:
    """Forces of the bodies on their supports, from springs and dampers together."""
    stiffness, damping = np.asarray(system.stiffness), np.asarray(system.damping)
    return np.asarray(samples.position @ stiffness.T + samples.velocity @ damping.T)
