"""Networks and their least squares: derivatives, linear problems, starts."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.surrogate import Network, Squares, levenberg_marquardt


@pytest.mark.parametrize(
    "network",
    [
        Network(4, (11, 11), ("tansig", "relu")),
        Network(3, (5,), ("tansig",)),
        Network(1, (2, 3, 4), ("relu", "tansig", "relu")),
    ],
)
def test_the_jacobian_is_that_of_a_complex_step(network):
    random = np.random.default_rng(3)
    weights, inputs = network.start(random), random.random((40, network.inputs))
    value, slope = network.jacobian(weights, inputs)
    assert np.array_equal(value, network.evaluate(weights, inputs))
    step = 1e-30
    for place in range(network.size):
        moved = weights.astype(complex)
        moved[place] += 1j * step
        derivative = network.evaluate(moved, inputs).imag / step
        assert np.abs(slope[:, place] - derivative).max() <= 1e-10 * max(1.0, np.abs(slope).max())


def test_a_relu_at_its_kink_has_no_slope():
    network = Network(1, (1,), ("relu",))
    weights = np.array([1.0, -0.5, 2.0, 0.0])  # max(x - 1/2, 0) times two
    _, slope = network.jacobian(weights, np.array([[0.5], [0.75]]))
    assert slope[0].tolist() == [0.0, 0.0, 0.0, 1.0]
    assert slope[1].tolist() == [1.5, 2.0, 0.25, 1.0]


def test_a_linear_problem_takes_one_step():
    random = np.random.default_rng(1)
    matrix, wanted = random.random((30, 5)), random.random(5)
    right = matrix @ wanted

    def mean_square(w):
        return float(np.mean((matrix @ w - right) ** 2))

    def squares(w):
        error = matrix @ w - right
        return Squares(mean_square(w), matrix.T @ error / 30, matrix.T @ matrix / 30)

    fit = levenberg_marquardt(squares, mean_square, np.zeros(5), damping=0.0)
    assert (fit.epochs, fit.stopped) == (1, "gradient")
    assert np.allclose(fit.weights, wanted, atol=1e-12)
    damped = levenberg_marquardt(squares, mean_square, np.zeros(5), damping=0.01)
    assert damped.epochs > 1
    assert np.allclose(damped.weights, wanted, atol=1e-6)


def test_the_best_weights_of_the_validation_are_used():
    def mean_square(w):
        return float(w[0] ** 2)

    def squares(w):
        return Squares(float(w[0] ** 2), w.copy(), np.eye(1))

    # The fit goes to 0; the other data want 0.6, and are passed after the second step or so.
    epochs = []

    def validation(w):
        epochs.append(float(w[0]))
        return float((w[0] - 0.6) ** 2)

    fit = levenberg_marquardt(
        squares, mean_square, np.ones(1), validation=validation, damping=1.0, patience=3
    )
    assert fit.stopped == "validation"
    assert fit.weights[0] == min(epochs, key=lambda w: abs(w - 0.6))
    assert fit.epochs == epochs.index(fit.weights[0]) + 3


def test_starts_of_nguyen_and_widrow_spread_over_the_inputs():
    network = Network(2, (9, 4), ("tansig", "tansig"))
    first, bias = next(network.layers(network.start(np.random.default_rng(5))))
    assert np.allclose(np.linalg.norm(first, axis=1), 2 * 0.7 * 9**0.5)
    # Seen over the range -1 to 1, biases are even between the lengths of the rows.
    centred = bias + first.sum(axis=1) / 2
    assert np.allclose(np.sort(np.abs(centred)), np.sort(np.abs(2.1 * np.linspace(-1, 1, 9))))


@pytest.mark.parametrize(
    ("hidden", "activations"),
    [((), ()), (11, "tansig"), ((3,), ("tansig", "relu")), ((0,), ("tansig",)), ((3,), ("sine",)),
     ((200, 200), ("relu", "relu"))],
)  # fmt: skip
def test_layers_that_do_not_fit_are_refused(hidden, activations):
    with pytest.raises(InputError):
        Network(2, hidden, activations)
