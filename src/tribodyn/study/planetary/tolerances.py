"""Load sharing over the tolerances of pins and teeth."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.machine import load_shares
from tribodyn.record import Record, quantity, record
from tribodyn.types import Array
from tribodyn.uncertainty import distribution, sample


@record
class LoadShareStatistics(Record):
    """Load sharing of many stages whose errors lie within tolerances.

    Parameters
    ----------
    stage : (n,) array
        Number of each stage.
    pin_errors, thickness_errors : (n, N) array
        Errors of each stage [m].
    share : (n, N) array
        Load of each planet over the mean.
    """

    stage: Array = quantity("stage", unit="1", axis=True)
    pin_errors: Array = quantity("stage", "planet", unit="m")
    thickness_errors: Array = quantity("stage", "planet", unit="m")
    share: Array = quantity("stage", "planet", unit="1")

    @property
    def load_factor(self) -> Array:
        """Mesh load factor K_gamma of each stage (n,)."""
        return np.asarray(self.share.max(axis=1))

    def quantile(self, part: float) -> float:
        """Load factor that a part of the stages does not exceed.

        Parameters
        ----------
        part : float
            Between 0 and 1.

        Returns
        -------
        float
        """
        return float(np.quantile(self.load_factor, part))


def load_share_statistics(
    *,
    planets: int,
    pin_errors: Any = "0 um",
    thickness_errors: Any = "0 um",
    samples: int = 256,
    seed: int = 0,
    **stage: Any,
) -> LoadShareStatistics:
    """Compute the load sharing of stages whose errors are drawn from tolerances.

    Parameters
    ----------
    planets : int
        Number of planets.
    pin_errors, thickness_errors : str, float or distribution
        Spread of each error, independent from planet to planet: ``"0 um +- 10 um"`` or
        ``"normal 0 um +- 4 um"``, as :func:`tribodyn.uncertainty.distribution` takes it.
    samples : int
        Number of stages.
    seed : int
        Seed of the samples.
    **stage
        Other arguments of :func:`load_shares`.

    Returns
    -------
    LoadShareStatistics

    Raises
    ------
    InputError
        If an argument is wrong.
    """
    inputs = {
        f"{kind}_{planet}": distribution(f"{kind}_errors", spread, "m")
        for kind, spread in (("pin", pin_errors), ("thickness", thickness_errors))
        for planet in range(planets)
    }
    drawn = sample(inputs, samples, seed=seed)
    pins, thick = (
        np.stack([np.broadcast_to(drawn[f"{kind}_{i}"], samples) for i in range(planets)], axis=1)
        for kind in ("pin", "thickness")
    )
    shares = [
        load_shares(planets=planets, pin_errors=p, thickness_errors=t, **stage).share
        for p, t in zip(pins, thick, strict=True)
    ]
    return LoadShareStatistics(np.arange(1.0, samples + 1.0), pins, thick, np.array(shares))
