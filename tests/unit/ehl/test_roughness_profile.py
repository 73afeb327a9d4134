"""A column of heights: figures, filter, interpolation, refusals."""

import numpy as np
import pytest

from tribodyn.ehl import RoughnessProfile
from tribodyn.ehl.roughness import warn_if_unresolved
from tribodyn.errors import InputError, ModelWarning

X = np.linspace(0.0, 1e-3, 1001)


def sine(wavelength: float, amplitude: float = 1e-6) -> np.ndarray:
    return amplitude * np.sin(2.0 * np.pi * X / wavelength)


def test_figures_of_a_sine() -> None:
    profile = RoughnessProfile(X, sine(1e-4))
    assert profile.rms == pytest.approx(1e-6 / np.sqrt(2.0), rel=1e-3)
    assert profile.mean_roughness == pytest.approx(2e-6 / np.pi, rel=2e-3)
    assert profile.spacing == pytest.approx(1e-6)
    assert profile.length == pytest.approx(1e-3)


def test_tilt_is_taken_away_and_the_profile_is_centred() -> None:
    heights = sine(1e-4) + 3e-6 + 5e-3 * X
    profile = RoughnessProfile.from_heights(1e-6, heights)
    assert profile.position[0] == pytest.approx(-0.5e-3)
    assert profile.rms == pytest.approx(1e-6 / np.sqrt(2.0), rel=0.01)
    tilted = RoughnessProfile.from_heights(1e-6, heights, remove_tilt=False, start=2.0)
    assert np.mean(tilted.height) == pytest.approx(0.0, abs=1e-15)
    assert tilted.rms > 1.2e-6
    assert tilted.position[0] == 2.0


def test_a_peak_makes_the_gap_smaller() -> None:
    profile = RoughnessProfile(X, sine(1e-4))
    assert float(profile(0.25e-4)) == pytest.approx(-1e-6, rel=1e-6)
    # between the points, fourth order
    assert float(profile(0.1234567e-4)) == pytest.approx(
        -1e-6 * np.sin(2.0 * np.pi * 0.1234567), rel=1e-5
    )


def test_beyond_the_ends() -> None:
    period = X[:-1]
    again = RoughnessProfile(period, sine(1e-4)[:-1], "periodic")
    assert float(again(7.25e-4 + 5e-3)) == pytest.approx(float(again(0.25e-4)), rel=1e-9)
    assert float(again(-0.9995e-3)) == pytest.approx(float(again(0.5e-6)), rel=1e-9)
    level = RoughnessProfile(X, sine(1e-4), "level")
    assert float(level(5.0)) == 0.0
    with pytest.raises(InputError, match="measured from 0 to 1 mm"):
        RoughnessProfile(X, sine(1e-4))(1.1e-3)


def test_gaussian_filter_halves_the_cutoff_wavelength() -> None:
    for beyond in ("periodic", "refuse"):
        profile = RoughnessProfile(X[:-1], sine(1e-4)[:-1], beyond)
        middle = slice(300, 700)
        left = profile.filtered(1e-4).height[middle]
        assert left == pytest.approx(0.5 * profile.height[middle], abs=0.01e-6)
    assert profile.filtered(1e-5).rms == pytest.approx(profile.rms, rel=0.02)


def test_share_of_short_waves() -> None:
    profile = RoughnessProfile(X[:-1], (sine(1e-4) + sine(2e-5, 0.5e-6))[:-1], "periodic")
    assert profile.short_wave_share(5e-5) == pytest.approx(0.2, rel=1e-6)
    assert profile.short_wave_share(1e-5) == pytest.approx(0.0, abs=1e-12)
    assert RoughnessProfile(X, 0.0 * X).short_wave_share(1e-5) == 0.0


def test_unresolved_waves_are_reported() -> None:
    profile = RoughnessProfile(X[:-1], sine(1e-4)[:-1], "periodic")
    warn_if_unresolved(profile, 1e-4 / 17.0)
    with pytest.warns(ModelWarning, match="roughness-resolution"):
        warn_if_unresolved(profile, 1e-4 / 15.0)


@pytest.mark.parametrize(
    ("position", "height", "beyond", "message"),
    [
        (X[:5], X[:5], "refuse", "at least 8 heights"),
        (X[:9], X[:8], "refuse", "8 heights and 9 positions"),
        (X**2, sine(1e-4), "refuse", "equal steps"),
        (-X, sine(1e-4), "refuse", "equal steps"),
        (X, np.where(np.arange(X.size) == 7, np.nan, X), "refuse", r"height\[7\]"),
        (X, X, "repeat", "Known: refuse, periodic, level"),
    ],
)
def test_invalid_profiles_are_refused(
    position: object, height: object, beyond: str, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        RoughnessProfile(position, height, beyond)  # type: ignore[arg-type]


def test_spacing_and_cutoff_are_positive() -> None:
    with pytest.raises(InputError, match="spacing"):
        RoughnessProfile.from_heights(0.0, np.zeros(9))
    with pytest.raises(InputError, match="cutoff"):
        RoughnessProfile(X, sine(1e-4)).filtered(-1.0)
