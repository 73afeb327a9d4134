"""The registry of stiffness models: names, options, what every model must give."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError
from tribodyn.stiffness import MODELS

OPTIONS = {
    "rectangular": {"pair_stiffness": 2e8},
    "fourier": {"mean_stiffness": 3e8, "cosine": [2e7, 1e7], "sine": [5e6]},
    "table": {"phase": [0.0, 0.4, 1.0], "mesh_stiffness": [3e8, 2e8, 3e8]},
    "iso6336": {},
    "potential-energy": {},
}


def cycle(pair):
    phase = (np.arange(64) + 0.5) / 64
    path, in_contact = path_of_contact(pair).pair_paths(phase)
    return path, in_contact, phase


def test_the_names_are_those_of_the_case_file():
    assert set(MODELS.names()) >= set(OPTIONS)


@pytest.mark.parametrize("name", OPTIONS)
@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_positive_in_contact_and_zero_elsewhere(name, driver, fzg, steel):
    pair = fzg(driver=driver)
    path, in_contact, phase = cycle(pair)
    stiffness = MODELS[name](pair, steel, path, in_contact, phase, 2660.0, **OPTIONS[name])
    assert stiffness.shape == path.shape
    assert np.all(stiffness[in_contact] > 0.0)
    assert np.all(stiffness[~in_contact] == 0.0)


@pytest.mark.parametrize("name", OPTIONS)
def test_contact_ratio_above_two(name, high_contact_pair, steel):
    path, in_contact, phase = cycle(high_contact_pair)
    assert in_contact.sum(axis=1).max() == 3
    stiffness = MODELS[name](
        high_contact_pair, steel, path, in_contact, phase, 5000.0, **OPTIONS[name]
    )
    assert np.all((stiffness > 0.0) == in_contact)


def test_a_misspelt_option_names_the_nearest(fzg, steel):
    pair = fzg()
    with pytest.raises(InputError, match=r'no option "pair_stifness".*mean "pair_stiffness"'):
        MODELS["rectangular"](pair, steel, *cycle(pair), 2660.0, pair_stifness=2e8)


@pytest.mark.parametrize(
    ("name", "wanted"),
    [("rectangular", "pair_stiffness"), ("fourier", "mean_stiffness"), ("table", "roll_angle")],
)
def test_a_missing_option_is_named(name, wanted, fzg, steel):
    pair = fzg()
    with pytest.raises(InputError, match=wanted):
        MODELS[name](pair, steel, *cycle(pair), 2660.0)
