"""Time integration in modal coordinates while the frequency of the clock changes in steps."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from tribodyn.dynamics.equations.compiled import sample_system
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.modal_march import ModalMarcher
from tribodyn.dynamics.time.response import Response, build_response


def periods_at(
    system: System, frequencies: Iterable[float], start: Response, steps: int, every: int = 1
) -> Iterator[Response | None]:
    """One period of the clock at each frequency [Hz], from the end of the one before.

    The first begins where ``start`` does, whose balancing torque acts all along. Of ``every`` so
    many periods one is recorded, others are None.
    """
    compiled = sample_system(system, steps)
    frequency, extra = np.array([start.mesh_frequency]), start.extra_force
    marcher = ModalMarcher(compiled, frequency, extra[None])
    state = np.concatenate((start.position[0], start.velocity[0]))[None]
    rate = marcher.compiled.step_number * start.mesh_frequency
    for number, hertz in enumerate(frequencies):
        frequency[0] = hertz
        if number % every:
            state = marcher.march(state, 1)
            yield None
            continue
        record = np.empty((compiled.grid.steps + 1, state.size, 1))
        state = marcher.march(state, 1, record=record)
        grid = replace(marcher.compiled, step_number=rate / hertz)
        yield build_response(grid, hertz, record[:, :, 0], extra, engine="modal")
