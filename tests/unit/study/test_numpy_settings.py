"""What a script asks of NumPy for itself does not reach what is computed here."""

import numpy as np
import pytest

import tribodyn as td


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_a_script_that_forbids_underflow_gets_the_same_figures():
    usual = td.run("fzg-stiffness").summary()
    with np.errstate(all="raise"):
        strict = td.run("fzg-stiffness").summary()
        with pytest.raises(FloatingPointError):
            np.array([1e-300]) * 1e-300
    assert strict == pytest.approx(usual, rel=1e-12, nan_ok=True)
