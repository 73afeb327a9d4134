"""Kernels read no memory that was given back or never written.

The C library fills memory with a byte when it is taken, and with another when it is given back, if
``MALLOC_PERTURB_`` asks for it. Where it does not know that variable nothing is filled.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from known_systems import reference_system
from tribodyn.dynamics import simulate, simulate_ensemble, steady_state
from tribodyn.ehl import solve_line_contact_moes


def digest_of_motions() -> str:
    """Bits of motions by every engine, of statistics, of an orbit and of a film."""
    system, start = reference_system(0.1, gap=1e-5), (np.full(6, 1e-5), np.zeros(6))
    parts = []
    for engine in ("rk4", "newmark", "dormand-prince"):
        parts.append(simulate(system, 1800.0, 2, start, steps=256, method=engine).fine.position)
        for lanes in (1, 5, 17):
            ensemble = simulate_ensemble(
                system, [1800.0] * lanes, 2, start, steps=256, averaged=1, harmonics=3,
                method=engine,
            )  # fmt: skip
            parts += [ensemble.position, ensemble.velocity, ensemble.contact_force.rms]
            parts += [ensemble.contact_force.harmonics, ensemble.acceleration.maximum]
    parts.append(steady_state(system, 1800.0, steps=256).position)
    for method in ("newton", "multigrid"):
        parts.append(solve_line_contact_moes(5.0, 8.0, nodes=513, method=method).pressure)
    return hashlib.sha256(b"".join(np.asarray(part).tobytes() for part in parts)).hexdigest()


@pytest.mark.slow
@pytest.mark.parametrize("fill", [90, 165])
def test_kernels_do_not_depend_on_uninitialised_memory(fill: int) -> None:
    this_file = Path(__file__)
    paths = os.pathsep.join([str(this_file.parent), str(this_file.parents[2]), *sys.path])
    environment = os.environ | {"MALLOC_PERTURB_": str(fill), "PYTHONPATH": paths}
    call = [
        sys.executable,
        "-W",
        "ignore",
        "-c",
        f"from {this_file.stem} import digest_of_motions; print(digest_of_motions())",
    ]
    done = subprocess.run(call, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split() == [digest_of_motions()]
