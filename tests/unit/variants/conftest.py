"""A study whose members cost nothing, with figures that anyone can compute anew."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import ComputationError
from tribodyn.variants import compute as computing
from tribodyn.variants.compute import Kind, Part


def _power(case, columns, progress):
    """Power of both values; a torque above 80 N*m fails together with its neighbours."""
    speed, torque = (np.array(columns[key]) for key in ("operation.speed", "operation.torque"))
    if (torque > 80.0).any():
        raise ComputationError(f"torque of {torque.max():.6g} is too much")
    progress.advance(torque.size)
    return Part({"power": speed * torque}, [""] * torque.size, [""] * torque.size)


@pytest.fixture
def cheap(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let ``compute = "summary"`` be a product."""
    kind = Kind("power", _power, {"power": ("W", "power")}, 200)
    monkeypatch.setitem(computing.KINDS, "summary", kind)
