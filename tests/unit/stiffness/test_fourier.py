"""The Fourier series of the mesh stiffness."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.stiffness import fourier_mesh_stiffness

PHASE = np.arange(256) / 256


def test_coefficients_are_recovered_by_a_transform():
    cosine, sine = [2e7, -1e7, 3e6], [5e6, 4e6]
    spectrum = np.fft.rfft(fourier_mesh_stiffness(PHASE, 2.5e8, cosine, sine)) / PHASE.size
    assert spectrum[0].real == pytest.approx(2.5e8)
    assert 2.0 * spectrum[1:4].real == pytest.approx(np.array(cosine))
    assert -2.0 * spectrum[1:4].imag == pytest.approx(np.array([*sine, 0.0]), abs=1e-6)
    assert np.abs(spectrum[4:]).max() < 1e-6


def test_without_harmonics_it_is_constant():
    assert np.all(fourier_mesh_stiffness(PHASE, 2e8) == 2e8)


def test_a_series_that_falls_to_zero_is_refused_even_between_the_phases():
    with pytest.raises(InputError, match="the mesh stiffness is -"):
        fourier_mesh_stiffness(np.array([0.0]), 1e8, cosine=[1.2e8])


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_coefficient_that_is_no_number_is_refused(bad):
    with pytest.raises(InputError, match="not a finite number"):
        fourier_mesh_stiffness(PHASE, 1e8, sine=[bad])
