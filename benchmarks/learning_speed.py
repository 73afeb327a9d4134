"""What do the data set of a published study, its networks and a million predictions cost?

The rival of the training is MINPACK by ``scipy.optimize.least_squares``, with the same network, the
same derivatives and the same start; both errors are those of the rows that were trained.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from scipy.optimize import least_squares

from race import arguments
from tribodyn import load_case, vibration_data
from tribodyn.errors import quiet
from tribodyn.surrogate import BPNN_PL, Network, levenberg_marquardt, prepare, train
from tribodyn.surrogate.training import _Residuals

FEATURES = ["mesh_stiffness", "friction_coefficient", "backlash_function", "transmission_error"]
TARGETS = ["acceleration", "mesh_force"]
#: Evaluations of MINPACK, and epochs of ours.
STEPS = 10


def main(words: Sequence[str] | None = None) -> None:
    """Print seconds of the table, of the training beside MINPACK, and of the predictions."""
    quick = arguments(__doc__, words).quick
    case = load_case("fzg-film").replace({"film.model": "none"})
    lanes, rows, count = (4, 100, 1000) if quick else (100, 100, 10**6)
    with quiet():
        vibration_data(case, seed=1, trajectories=lanes, samples=1)  # what is compiled once
        start = time.perf_counter(), time.process_time()
        data = vibration_data(case, seed=1, trajectories=lanes, samples=rows)
        told("rows", data.rows, start)
        start = time.perf_counter(), time.process_time()
        model = train(data, features=FEATURES, targets=TARGETS, seed=1, training=BPNN_PL)
        told("both networks at 11 neurons, epochs", int(model.epochs.sum()), start)
        beside_minpack(data, 5 if quick else STEPS)
        points = np.random.default_rng(0).uniform(*model.feature_range, (count, len(FEATURES)))
        start = time.perf_counter(), time.process_time()
        model.predict(points)
        told("predictions of both targets", count, start)


def beside_minpack(data: object, steps: int) -> None:
    """Print what both searches make of the mesh force with the same number of derivatives."""
    ready = prepare(data, FEATURES[:3], TARGETS[1:], seed=1)
    kept = ready.split.training
    network = Network(3, (11, 11), ("tansig", "relu"))
    inputs = ready.feature_scaling.scaled(ready.features[kept])
    target = ready.target_scaling.scaled(ready.targets[kept])[:, 0]
    problem, first = _Residuals(network, inputs, target), network.start(np.random.default_rng(3))
    start = time.perf_counter(), time.process_time()
    fit = levenberg_marquardt(problem.squares, problem.mean_square, first, epochs=steps)
    told(f"tribodyn, mean square {problem.mean_square(fit.weights):.2e}, epochs", fit.epochs, start)
    start = time.perf_counter(), time.process_time()
    rival = least_squares(
        lambda w: network.evaluate(w, inputs) - target, first,
        jac=lambda w: network.jacobian(w, inputs)[1], method="lm", max_nfev=steps,
    )  # fmt: skip
    told(f"MINPACK, mean square {2 * rival.cost / target.size:.2e}, derivatives", rival.njev, start)


def told(words: str, count: int | None, start: tuple[float, float]) -> None:
    """Print wall and processor seconds since a start."""
    wall, used = time.perf_counter() - start[0], time.process_time() - start[1]
    print(f"{count or 0:8d} {words:60} {wall:7.2f} s, of processors {used:7.2f} s", flush=True)


if __name__ == "__main__":
    main()
