"""Load sharing over the tolerances of pins and teeth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.machine import load_shares
from tribodyn.machine.planetary.load_sharing import sampled_shares
from tribodyn.record import Record, quantity, record
from tribodyn.study.machine.run import structure_at_rest
from tribodyn.study.planetary.stage_result import plane_data
from tribodyn.study.uncertain.lanes import draw
from tribodyn.types import Array
from tribodyn.uncertainty import distribution, sample

if TYPE_CHECKING:
    from tribodyn.study.machine.case import MachineCase

#: Errors of the planets that may have tolerances.
_KINDS = ("pin_errors", "thickness_errors")


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
    case: MachineCase | None = None,
    *,
    planets: int | None = None,
    pin_errors: Any = "0 um",
    thickness_errors: Any = "0 um",
    samples: int = 256,
    seed: int = 0,
    **stage: Any,
) -> LoadShareStatistics:
    """Compute the load sharing of stages whose errors are sampled within tolerances.

    Parameters
    ----------
    case : MachineCase, optional
        Machine with computed teeth, whose first stage has spreads of ``pin_errors`` and
        ``thickness_errors``; then only ``samples`` and ``seed`` are given besides.
    planets : int, optional
        Number of planets, without a case.
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
        If an argument is wrong, or no error of the case has a spread.

    Notes
    -----
    The loads are those at rest. :func:`ensemble` computes the motion of every variant of a case,
    with other values that have spreads too.
    """
    if case is not None:
        if not case.stages:
            what, remedy = "the case has no planetary stage", "Give a case with [planets.NAME]"
            raise InputError(what, Argument("case"), "", remedy)
        name = next(iter(case.stages))
        structure = structure_at_rest(case)
        data = plane_data(structure, name)
        suns = structure.machine.planets[name].mesh_names(name)["sun"]
        planets = int(data.pop("planets"))
        errors = (data.pop("pin_errors"), data.pop("thickness_errors"))
        stage = {**data, "carrier_speed": 0.0, **stage}
        turn = (structure.machine.kinematics.meshes[suns[0]].sense, 1)
        sampled = draw(case, _spread_errors(case, name), samples, seed=seed)
    else:
        if planets is None:
            what, remedy = "there is no stage", "Give a case, or planets and the data of the stage"
            raise InputError(what, Argument("planets"), "", remedy)
        load_shares(planets=planets, **stage)  # raises with every wrong argument
        errors, turn = (0.0, 0.0), (1, 1)
        tolerances = zip(_KINDS, (pin_errors, thickness_errors), strict=True)
        spreads = {
            f"{kind}.{planet + 1}": distribution(kind, spread, "m")
            for kind, spread in tolerances
            for planet in range(planets)
        }
        sampled = sample(spreads, samples, seed=seed)
    columns = {".".join(key.rsplit(".", 2)[-2:]): values for key, values in sampled.items()}
    pins, thick = (
        np.stack(
            [
                np.broadcast_to(
                    sign * columns[f"{kind}.{i + 1}"] if f"{kind}.{i + 1}" in columns else value,
                    samples,
                )
                for i, value in enumerate(np.broadcast_to(middle, planets))
            ],
            axis=1,
        )
        for kind, middle, sign in zip(_KINDS, errors, turn, strict=True)
    )
    shares = sampled_shares(pins, thick, planets=planets, **stage)
    return LoadShareStatistics(np.arange(1.0, samples + 1.0), pins, thick, shares)


def _spread_errors(case: MachineCase, name: str) -> dict[str, str]:
    """Errors of pins and teeth of a case that have a spread."""
    names = tuple(f"planets.{name}.{kind}." for kind in _KINDS)
    spreads = {key: text for key, text in case.uncertain.items() if key.startswith(names)}
    if not spreads:
        what = f"no error of the pins or teeth of {name} has a spread"
        remedy = f'Write planets.{name}.pin_errors = "0 um +- 10 um"'
        raise InputError(what, Argument("case"), "All stages would be equal", remedy)
    return spreads
