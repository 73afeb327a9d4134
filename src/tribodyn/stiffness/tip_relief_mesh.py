"""A mesh that is asked for many tip reliefs: compliances are found once, gaps alone change."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tribodyn.errors import ModelWarning
from tribodyn.gear import FlankModification, SpurGear, SpurPair, flank_ranges, profile_gap
from tribodyn.stiffness.loaded.prepare import contact_problem
from tribodyn.stiffness.loaded.problem import ContactProblem
from tribodyn.stiffness.model import MODELS
from tribodyn.types import Array


def with_tip_relief(
    pair: SpurPair, amount: float, length: float, *, gears: str = "both", shape: str = "linear"
) -> SpurPair:
    """Give a pair a tip relief; everything else that its flanks have stays.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position.
    amount : float [m]
        Material taken away at the tip; zero for no relief.
    length : float [m]
        Roll length of the relief.
    gears : str
        ``"both"``, ``"pinion"`` or ``"wheel"``.
    shape : str
        ``"linear"`` or ``"parabolic"``.

    Returns
    -------
    SpurPair

    Raises
    ------
    InputError
        If a value is out of range, or the relief longer than the flank.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> with_tip_relief(pair, 10e-6, 2e-3, gears="wheel").wheel.modification
    FlankModification(tip_relief 10 um, tip_relief_length 2 mm)
    """
    changed: dict[str, Any] = {}
    for name in _named(gears):
        gear = getattr(pair, name)
        relief = replace(
            gear.modification,
            tip_relief=amount,
            tip_relief_length=length if amount > 0.0 else None,
            tip_relief_shape=shape if amount > 0.0 else "linear",
        )
        changed[name] = _shaped(gear, relief)
    with warnings.catch_warnings():
        # What is to be said of the teeth was said when the pair was made.
        warnings.simplefilter("ignore", ModelWarning)
        return replace(pair, **changed)


def _named(gears: str) -> tuple[str, ...]:
    return ("pinion", "wheel") if gears == "both" else (gears,)


def _shaped(gear: SpurGear, modification: FlankModification) -> SpurGear:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return replace(gear, modification=modification)


@dataclass(frozen=True, eq=False)
class ReliefMesh:
    """The loaded tooth contact of a pair without the relief that is searched."""

    pair: SpurPair  #: the pair
    gears: str
    shape: str
    problems: list[ContactProblem]
    totals: list[Array]  #: normal forces of each problem, increasing [N]

    def error(self, amount: float, length: float) -> Array:
        """Transmission error with a relief."""
        gap = self._gap(amount, length) if amount > 0.0 else 0.0
        rows = [
            replace(problem, gaps=problem.gaps + gap).at_loads(totals).approach
            for problem, totals in zip(self.problems, self.totals, strict=True)
        ]
        return np.concatenate(rows)

    def _gap(self, amount: float, length: float) -> Array:
        """What the relief adds to the gaps (p, 1, n) [m]."""
        places = self.problems[0].places
        gap = np.zeros(places.path.shape)
        alone = FlankModification(
            tip_relief=amount, tip_relief_length=length, tip_relief_shape=self.shape
        )
        for name, flank in zip(("pinion", "wheel"), flank_ranges(self.pair), strict=True):
            if name in _named(self.gears):
                gear = _shaped(getattr(self.pair, name), alone)
                radius = getattr(places, f"{name}_curvature_radius")
                gap = gap + profile_gap(gear, radius, flank, length)
        return gap[:, None, :]


def relief_mesh(
    pair: SpurPair, gears: str, shape: str, torque: Array, settings: dict[str, Any]
) -> ReliefMesh:
    """Prepare a mesh to be asked for many tip reliefs."""
    total = torque / pair.pinion.base_radius
    one = MODELS[settings["provider"]].influence is not None
    totals = [total] if one else [total[k : k + 1] for k in range(total.size)]
    problems = [contact_problem(pair, total_force=float(part[0]), **settings) for part in totals]
    return ReliefMesh(pair, gears, shape, problems, totals)
