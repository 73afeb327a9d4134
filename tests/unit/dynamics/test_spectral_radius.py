"""The largest modulus of an eigenvalue of many matrices, of which few are looked at closely."""

import numpy as np
import pytest

from tribodyn.dynamics.equations import step_limit

RANDOM = np.random.default_rng(5).standard_normal((4, 9, 6, 6))
FAMILIES = {
    "random": RANDOM,
    "all equal": np.broadcast_to(RANDOM[:1, :1], RANDOM.shape),
    "of very different size": RANDOM * 10.0 ** np.arange(-120, 120, 30)[:, None, None, None][:4],
    "without an eigenvalue but zero": np.triu(RANDOM, 1),
    "far from normal": np.triu(RANDOM, 1) * 1e6 + RANDOM,
}


@pytest.mark.parametrize("name", FAMILIES)
def test_spectral_radius_is_that_of_all_eigenvalues(name: str) -> None:
    matrices = FAMILIES[name]
    every = np.abs(np.linalg.eigvals(matrices)).max(axis=-1)
    assert np.array_equal(step_limit._spectral_radius(matrices), every.max(axis=-1))


def test_few_matrices_need_their_eigenvalues(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes = []
    eigenvalues = np.linalg.eigvals

    def counted(matrices):
        sizes.append(matrices[..., 0, 0].size)
        return eigenvalues(matrices)

    monkeypatch.setattr(np.linalg, "eigvals", counted)
    growing = RANDOM[0, 0] * np.linspace(1.0, 2.0, 40)[None, :, None, None]
    assert step_limit._spectral_radius(growing)[0] == pytest.approx(
        2.0 * np.abs(eigenvalues(RANDOM[0, 0])).max(), rel=1e-12
    )
    assert sum(sizes) == 1


@pytest.mark.parametrize("stronger", [0, 1])
def test_blocks_coupled_one_way_are_treated_separately(stronger: int) -> None:
    matrices = RANDOM.copy()
    matrices[..., :4, 4:] = 0.0
    matrices[..., :4, :4] *= 10.0 if stronger == 0 else 0.1
    order = np.array([5, 0, 3, 1, 4, 2])  # the blocks are found wherever they lie
    matrices = matrices[..., order[:, None], order]
    every = np.abs(np.linalg.eigvals(matrices)).max(axis=-1)
    radii = step_limit._spectral_radius(matrices)
    assert radii == pytest.approx(every.max(axis=-1), rel=1e-12)
