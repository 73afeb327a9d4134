"""What a published study claims of friction in hypoid gears, judged by the pair of a case."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.run import computed
from tribodyn.study.pipeline.tooth_contact import hypoid_friction_of

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.types import Array

#: Loads and speeds of the pinion in that study [N*m], [rad/s]; the middle ones are moved as well.
TORQUES, SPEEDS = (50.0, 500.0, 2000.0), tuple(rpm * np.pi / 30.0 for rpm in (1000, 3000, 5000))
#: Coefficient that the study calls typical, and change that counts as none.
TYPICAL, MARGINAL, STEADY = 0.1, 0.02, 0.1
_FORCES = tuple(f"mean_mesh_force_{axis}" for axis in "xyz")
_DTE = ("mean_dynamic_transmission_error", "rms_dynamic_transmission_error")


class HypoidClaim(NamedTuple):
    """One claim, whether it holds for this pair, and the figures that say so."""

    statement: str
    holds: bool
    computed: str


class HypoidFigures(NamedTuple):
    """Figures by torque and speed (3, 3), and changes of the motion by the friction law."""

    coefficient: Array  #: mean over the cycle
    spread: Array  #: greatest less least of the cycle over the mean
    swing: Array  #: greatest angle between two directions of the friction force [rad]
    film_ratio: Array  #: least
    of_mean: Array  #: change of forces and transmission errors (5, 3) with the own mean coefficient
    of_typical: Array  #: the same with the typical coefficient


def hypoid_figures(case: Case, progress: Progress = SILENT) -> HypoidFigures:
    """Compute contacts at nine loads and speeds, and nine motions at the middle load."""
    rest: list[list[tuple[float, ...]]] = []
    changes: dict[bool, list[Array]] = {True: [], False: []}
    progress.start("Hypoid pair", 9)
    for torque in TORQUES:
        row = []
        for speed in SPEEDS:
            at = case.replace({"operation.torque": torque, "operation.speed": speed})
            with collected():
                row.append(_at_rest(at))
            if torque == TORQUES[1]:
                varying = _motion(at)
                for own in (True, False):
                    value = row[-1][0] if own else TYPICAL
                    law = {"friction.law": "constant", "friction.coefficient": value}
                    changes[own].append(_motion(at.replace(law)) / varying - 1.0)
            progress.advance()
        rest.append(row)
    progress.finish()
    found = np.moveaxis(np.array(rest), -1, 0)
    both = (np.array(changes[own]).T for own in (True, False))
    return HypoidFigures(*found, *both)


def _at_rest(case: Case) -> tuple[float, ...]:
    rubbed = hypoid_friction_of(case)
    course, force = rubbed.mean_coefficient, rubbed.pinion_friction[:, :3]
    way = force / np.linalg.norm(force, axis=1)[:, None]
    turn = float(np.arccos(np.clip(way @ way.T, -1.0, 1.0)).max())
    mean = rubbed.mean_friction_coefficient
    return mean, float(np.ptp(course)) / mean, turn, rubbed.minimum_film_ratio


def _motion(case: Case) -> Array:
    figures = computed(case).summary()
    return np.array([figures[name] for name in (*_FORCES, *_DTE)])


def hypoid_claims(found: HypoidFigures) -> tuple[HypoidClaim, ...]:
    """Judge the claims of the study by the figures of one pair."""
    mu, by_speed = found.coefficient, found.coefficient[1]
    load = [abs(mu[row, 1] / mu[1, 1] - 1.0) for row in (0, 2)]
    speed = abs(by_speed[-1] / by_speed[0] - 1.0)
    own, typical = (np.abs(each).max(axis=1) for each in (found.of_mean, found.of_typical))
    rows: Sequence[tuple[str, Any, str]] = (
        ("The friction coefficient hardly varies over a mesh cycle", (found.spread < STEADY).all(),
         f"by {_span(100.0 * found.spread)} % of its mean, most under the least torque"),
        ("Its direction swings a little and never turns round", (found.swing < 0.5 * np.pi).all(),
         f"by {_span(np.degrees(found.swing))} deg"),
        ("It falls with the speed", (np.diff(mu, axis=1) < 0.0).all(),
         f"from {by_speed[0]:.4f} to {by_speed[-1]:.4f} at {TORQUES[1]:g} N m"),
        ("The load changes it less than the speed", max(load) < speed,
         f"{100.0 * load[0]:.0f} and {100.0 * load[1]:.0f} % from the middle to the least and "
         f"greatest torque, {100.0 * speed:.0f} % over the speed"),
        ("The flanks run in mixed lubrication", (found.film_ratio < 2.0).all(),
         f"least film ratios of {_span(found.film_ratio)}"),
        ("A constant mean coefficient moves the gears alike", (own < MARGINAL).all(),
         f"forces apart by up to {100.0 * own[:3].max():.2g} %, transmission error by "
         f"{100.0 * own[3:].max():.2g} %"),
        (f"So does a coefficient of {TYPICAL:g}", (typical < MARGINAL).all(),
         f"forces apart by up to {100.0 * typical[:3].max():.2g} %, the mean transmission error by "
         f"{100.0 * typical[3]:.2g} %, its alternating part by {100.0 * typical[4]:.2g} %"),
        ("Friction shows most in the direction x", int(np.argmax(typical[:3])) == 0,
         ", ".join(f"{a} {100.0 * v:.2g} %" for a, v in zip("xyz", typical, strict=False))),
    )  # fmt: skip
    return tuple(HypoidClaim(statement, bool(holds), told) for statement, holds, told in rows)


def _span(values: Array) -> str:
    return f"{values.min():.2g} to {values.max():.2g}"
