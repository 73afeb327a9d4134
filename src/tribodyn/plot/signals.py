"""Signals of a result on the fine samples of its response: three a step, jumps on both sides."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.study.pipeline import record
from tribodyn.types import Array


def mesh_force(result: Any) -> Array:
    """Dynamic force along the line of action, all ramps of a force law together."""
    return record.mesh_force(result.response.fine)


def transmission_error(result: Any) -> Array:
    """Dynamic transmission error, counted from first contact of the driving flank."""
    return record.transmission_error(result, result.response.fine)


def acceleration(result: Any, gear: str, axis: str) -> Array:
    """Acceleration of a gear's centre."""
    column = record.centre_column(result.response.names, gear, axis)
    return np.asarray(result.response.fine.acceleration[:, column])


def bearing_force(result: Any, gear: str, axis: str) -> Array:
    """Force of a gear on its support, from spring and damper together."""
    column = record.centre_column(result.response.names, gear, axis)
    return record.support_forces(result.system, result.response.fine)[:, column]
