"""Effect of friction on a gear pair, and a verdict on five published claims."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from tribodyn.drawing import draw
from tribodyn.errors import InputError
from tribodyn.record import Parts, record
from tribodyn.study.studies.sweep_result import Sweep
from tribodyn.types import Array, Mask

#: Relative change of a figure that counts as none, and share of a printed rise that confirms it.
MARGINAL, ENOUGH = 0.02, 0.5
#: Roughness near the upper limit of the fit of Benedict and Kelley, 0.75 um [m].
_FITTED = 0.7e-6
#: Labels of the driving gear and of the torque that is held constant.
DRIVING = ("pinion drives", "wheel drives")
HELD = ("drive torque held", "load torque held", "both torques held")
_UNKNOWN = "not computed"
_RMS, _MEAN, _PEAK = "rms_mesh_force", "mean_mesh_force", "peak_mesh_force"
_DTE = "dynamic_transmission_error"
_SWING = f"peak_to_peak_{_DTE}"
_MU = "mean_friction_coefficient"
NONE, CONSTANT, MIXED = "none", "constant", "mixed-ehl"
#: Figures of the table of effects, each with its factor from SI to the unit of the table.
_EFFECTS = {
    "mean_friction_coefficient": 1.0,
    "mean_mesh_force": 1.0,
    "rms_mesh_force": 1.0,
    "peak_to_peak_dynamic_transmission_error": 1e6,
    "dynamic_transmission_error_harmonic_1": 1e6,
    "rms_bearing_force_loa_pinion": 1.0,
    "rms_bearing_force_oloa_pinion": 1.0,
}


@dataclass(frozen=True)
class Claim:
    """A published claim and the verdict of the experiment."""

    case: str  #: built-in case of the source, or the gear pair of the claim
    statement: str
    printed: str
    computed: str
    holds: Mask | None  #: by driving gear and held torque (2, 3); None if not computed
    why: str

    @property
    def verdict(self) -> str:
        """Whether the claim holds, and in how many settings."""
        if self.holds is None:
            return _UNKNOWN
        count, settings = int(self.holds.sum()), self.holds.size
        return (
            "holds"
            if count == settings
            else f"holds in {count} of {settings}"
            if count
            else "fails"
        )

    @property
    def where(self) -> str:
        """Settings of driving gear and held torque under which the claim holds."""
        return _UNKNOWN if self.holds is None else _settings(self.holds)


class Rubbing(NamedTuple):
    """Friction law of the teeth with its roughness and coefficient."""

    law: str
    roughness: float  #: composite roughness [m]
    coefficient: float | None = None  #: of the law "constant"
    as_mixed: bool = False  #: constant at the mean of the mixed friction of this roughness
    varies: bool = True  #: whether the law depends on the roughness

    @property
    def name(self) -> str:
        """Label in tables."""
        if self.coefficient is not None:
            return f"{self.law} {self.coefficient:g}"
        label = f"{self.law} as {MIXED}" if self.as_mixed else self.law
        return f"{label} {self.roughness * 1e6:g} um" if self.varies else label


@record
class FrictionExperiment(Sweep):
    """What :func:`tribodyn.friction_experiment` returns: a sweep whose last key is the friction.

    Parameters
    ----------
    case : PairCase
        The case that was varied.
    axes : tuple of Axis
        Driving gear, torque that is held, and friction by name.
    points : tuple of SweepPoint
        Finished points; all of the grid unless the experiment was interrupted.
    rubbing : tuple of Rubbing
        Law, roughness and coefficient behind the names of the friction.
    """

    rubbing: tuple[Rubbing, ...] = ()
    CLAIM_HEAD: ClassVar[tuple[str, ...]] = (
        "Source of",
        "Claim",
        "Printed",
        "Computed",
        "Verdict",
        "Holds where",
        "Why",
    )

    EFFECT_HEAD: ClassVar[tuple[str, ...]] = (
        "Friction",
        "mu",
        "mean force [N]",
        "rms force [N]",
        "error p-p [um]",
        "harmonic 1 [um]",
        "bearing along, rms [N]",
        "across, rms [N]",
    )

    @cached_property
    def claims(self) -> tuple[Claim, ...]:
        """Claims of five sources about friction, each with the verdict of this experiment."""
        return judge_claims(self)

    def claim_rows(self) -> Iterator[tuple[str, ...]]:
        """Table of the claims under ``CLAIM_HEAD``."""
        names = ("case", "statement", "printed", "computed", "verdict", "where", "why")
        yield from (tuple(getattr(each, name) for name in names) for each in self.claims)

    def nearest(self) -> list[int]:
        """Index of each law with friction, at the roughness nearest to that of the case."""
        case_roughness, closest = self.case.composite_roughness or 0.0, dict[str, int]()
        for k, friction in enumerate(self.rubbing):
            previous = self.rubbing[closest.get(friction.law, k)]
            nearer = abs(friction.roughness - case_roughness) < abs(
                previous.roughness - case_roughness
            )
            if friction.law not in closest or nearer:
                closest[friction.law] = k
        return [k for law, k in closest.items() if law != NONE]

    def effect_rows(self) -> Iterator[tuple[str, ...]]:
        """Table under ``EFFECT_HEAD``: figures by law, driver and held torque as in the case."""
        row, column = (
            axis.values.index(value)
            for axis, value in zip(
                self.axes,
                (self.case.gears.driver, self.case.operation.torque_balance),
                strict=False,
            )
        )
        for k in (self.index(NONE), *self.nearest()):
            values = [self[name][row, column, k] * scale for name, scale in _EFFECTS.items()]
            if np.isfinite(values).all():
                yield (self.rubbing[k].name, *(f"{round(value, 9):.4g}" for value in values))

    @property
    def lead(self) -> str:
        """Number of computed and failed steady states, in one line."""
        failed = sum(bool(point.failed) for point in self.points)
        lost = f", {failed} failed" if failed else ""
        return f"{len(self.points)} of {self.failed.size} steady states{lost}"

    def plot(self, figure: str = "friction_effect", **options: object) -> Any:
        """Draw ``"friction_effect"``, ``"friction_claims"`` or ``"friction_harmonics"``."""
        return draw(self, figure, **options)

    def change(self, figure: str) -> Array:
        """Relative change of a figure of the summary by friction, over the grid."""
        values = self[figure]
        plain = values[:, :, self.index(NONE)]
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(values / plain[:, :, None] - 1.0)

    def index(self, law: str, **wanted: object) -> int:
        """Index of the first friction of a law whose :class:`Rubbing` has the wanted properties."""
        for place, friction in enumerate(self.rubbing):
            if friction.law == law and all(getattr(friction, k) == v for k, v in wanted.items()):
                return place
        laws = ", ".join(dict.fromkeys(friction.law for friction in self.rubbing))
        what, why = f'friction "{law}" was not computed', f"The experiment has {laws}"
        raise InputError(what, "argument law", why, "Choose one of these")

    def _parts(self) -> Parts:
        parts = super()._parts()
        rows = {
            "law": (np.array([friction.law for friction in self.rubbing], dtype=object), "1"),
            "composite_roughness": (
                np.array([friction.roughness for friction in self.rubbing]),
                "m",
            ),
        }
        for name, (values, unit) in rows.items():
            parts.variables[name] = ("friction", values, {"units": unit})
        for name, texts in zip(self.CLAIM_HEAD, zip(*self.claim_rows(), strict=True), strict=True):
            key = f"claim_{name.lower().replace(' ', '_')}"
            parts.variables[key] = ("claim", np.array(texts, dtype=object), {"units": "1"})
        return parts

    def __repr__(self) -> str:
        """Summarize steady states and verdicts in one line."""
        verdicts = ", ".join(f"{claim.case} {claim.verdict}" for claim in self.claims)
        return f"FrictionExperiment({self.lead}; claims: {verdicts})"


def judge_claims(experiment: FrictionExperiment) -> tuple[Claim, ...]:
    """Compare all published claims with an experiment."""
    return tuple(_judge(experiment, *row) for row in _CLAIMS)


#: Result of the test of a claim: computed figures, settings in which it holds, and the reason.
_Judgement = tuple[str, Mask, str]


def _judge(
    experiment: FrictionExperiment,
    case: str,
    statement: str,
    printed: str,
    judge: Callable[[FrictionExperiment], _Judgement],
) -> Claim:
    try:
        computed, holds, why = judge(experiment)
    except InputError as error:
        computed, holds, why = _UNKNOWN, None, error.problems[0].what
    return Claim(case, statement, printed, computed, holds, why)


def _of(experiment: FrictionExperiment, figure: str, place: int) -> Array:
    """Return a figure of one friction by driving gear and held torque; all must be computed."""
    values = experiment[figure][:, :, place]
    if not np.isfinite(values).all():
        what = f"{experiment.rubbing[place].name} was not computed in every setting"
        why = "A claim is judged in all settings of driving gear and held torque"
        raise InputError(what, why=why, remedy="Run the experiment again with all settings")
    return np.asarray(values)


def _ends(experiment: FrictionExperiment, law: str, *wanted: float) -> tuple[int, int]:
    """Indices of the roughnesses of a law that are nearest to two wanted ones [m]."""
    experiment.index(law)
    places = [k for k, friction in enumerate(experiment.rubbing) if friction.law == law]
    heights = np.array([experiment.rubbing[k].roughness for k in places])
    first, last = (places[int(np.argmin(np.abs(heights - height)))] for height in wanted)
    if first == last:
        what = f"{law} needs roughnesses next to two that were printed"
        why = "A claim between two printed roughnesses is judged next to them"
        raise InputError(what, why=why, remedy="Run the experiment with the printed roughnesses")
    return first, last


def _change(experiment: FrictionExperiment, figure: str, ends: tuple[int, int]) -> Array:
    first, last = (_of(experiment, figure, place) for place in ends)
    return last / first - 1.0


def _by_friction(experiment: FrictionExperiment, figure: str, place: int) -> Array:
    return _change(experiment, figure, (experiment.index("none"), place))


def _vibration(experiment: FrictionExperiment) -> _Judgement:
    ends = [experiment.index("constant", coefficient=value) for value in (0.05, 0.25)]
    along, across = (
        np.array([_of(experiment, f"rms_acceleration_{way}_pinion", place) for place in ends])
        for way in ("loa", "oloa")
    )
    resultant = np.hypot(along, across)
    rise, share = resultant[1] / resultant[0], (across[1] / resultant[1]) ** 2
    power = np.log(across[1] / across[0]) / np.log(5.0)
    # a^2 along, (b mu)^2 across: the printed rise of 1.6 requires this share across
    needed = 25.0 / (25.0 + (25.0 - 1.6**2) / (1.6**2 - 1.0))
    rises = _times(across[1] / across[0]), _times(along[1] / along[0])
    return (
        f"{_times(rise)} (across the line of action {rises[0]}, along {rises[1]})",
        rise > 1.0,
        f"Across the line of action friction itself excites, with the power {_span(power)} of the "
        f"coefficient; at 0.25 that is {_percent(share, sign=False)} of the squared vibration, "
        f"and the printed rise requires {100.0 * needed:.0f} %",
    )


def _rms_force(experiment: FrictionExperiment) -> _Judgement:
    smooth, rough = _ends(experiment, "xu-2007", 0.4e-6, 3.2e-6)
    change = np.array([_by_friction(experiment, _RMS, place) for place in (smooth, rough)])
    falls = np.array((change < 0.0).all(axis=0))
    mean, mu = _by_friction(experiment, _MEAN, rough), _of(experiment, _MU, rough)
    per_tenth = 0.1 * change[1] / mu
    most = float(np.min(per_tenth))
    needed = (
        f"12.5 % would need a mean coefficient of {0.1 * -0.125 / most:.2g}"
        if most < 0.0
        else "no coefficient gives 12.5 %"
    )
    return (
        f"{_percent(change[0])} at {_height(experiment, smooth)}, {_percent(change[1])} at "
        f"{_height(experiment, rough)}; it falls where {_settings(falls)}",
        falls & (change[0] < change[1]),
        f"The force follows the torque that is not held: its mean changes by {_percent(mean)}. The "
        f"change grows with the coefficient, {_percent(per_tenth)} for each 0.1, and so with the "
        f"roughness; {needed}",
    )


def _fifth(experiment: FrictionExperiment) -> _Judgement:
    place = experiment.index("constant", coefficient=0.035)
    first, second, fifth = (
        _by_friction(experiment, f"{_DTE}_harmonic_{order}", place) for order in (1, 2, 5)
    )
    names = [name for name in experiment.figures if name.startswith("natural_frequency_")]
    modes = np.array([_of(experiment, name, place)[0, 0] for name in names])
    meshing = 5.0 * float(_of(experiment, "mesh_frequency", place)[0, 0])
    nearest = float(modes[np.argmin(np.abs(modes / meshing - 1.0))]) if modes.size else np.inf
    return (
        f"fifth {_percent(fifth)}, first {_percent(first)}, second {_percent(second)}",
        fifth > ENOUGH * 0.62,
        "Only a lightly damped mode at the fifth harmonic has this effect; the nearest mode of "
        f"this pair is at {nearest / meshing:.3g} times its frequency",
    )


def _roughness(experiment: FrictionExperiment) -> _Judgement:
    ends = _ends(experiment, "benedict-kelly", 0.325e-6, 0.991e-6)
    peak, mean, swing = (_change(experiment, name, ends) for name in (_PEAK, _MEAN, _SWING))
    across, along = (
        _change(experiment, f"rms_bearing_force_{way}_pinion", ends) for way in ("oloa", "loa")
    )
    mu = [float(_of(experiment, _MU, place)[0, 2]) for place in ends]
    fitted = _ends(experiment, "benedict-kelly", 0.325e-6, _FITTED)
    within = _change(experiment, _PEAK, fitted)[0, 2]
    printed = [_percent(change[0, 2]) for change in (peak, swing, along)]
    return (
        f"{DRIVING[0]}, {HELD[2]}: peak force {printed[0]}, transmission error {printed[1]}, "
        f"bearing force across {_times(1.0 + across[0, 2])}, along {printed[2]}; {DRIVING[1]}: "
        f"peak force {_percent(peak[1])}",
        (peak < 0.0) & (swing < 0.0) & (across > 1.0) & (along < MARGINAL),
        f"No damping: the mean force changes by {_percent(mean[0, 2])}, since friction after the "
        f"pitch point carries part of the torque. The mean coefficient goes from {mu[0]:.3f} at "
        f"{_height(experiment, ends[0])} to {mu[1]:.3f} at {_height(experiment, ends[1])}; near "
        f"the end of the fit of the law, to {_height(experiment, fitted[1])}, the peak changes by "
        f"{_percent(within)}",
    )


def _constant_instead(experiment: FrictionExperiment) -> _Judgement:
    pairs = [
        (k, experiment.index("mixed-ehl", roughness=friction.roughness))
        for k, friction in enumerate(experiment.rubbing)
        if friction.as_mixed
    ]
    if not pairs:
        what, why = "mixed-ehl and constant were not compared", "The claim compares the two laws"
        raise InputError(what, why=why, remedy="Run the experiment with both laws")
    difference = np.array(
        [[_change(experiment, name, ends) for ends in pairs] for name in (_RMS, _SWING)]
    )
    effect = np.array(
        [[_by_friction(experiment, name, ends[1]) for ends in pairs] for name in (_RMS, _SWING)]
    )
    worst, influence = np.abs(difference).max(axis=1), np.abs(effect).max(axis=1)
    return (
        f"rms force differs by up to {_percent(worst[0].max(), sign=False)}, transmission error by "
        f"{_percent(worst[1].max(), sign=False)}",
        (worst < MARGINAL).all(axis=0),
        f"Friction itself changes them by up to {_percent(influence[0].max(), sign=False)} and "
        f"{_percent(influence[1].max(), sign=False)}: with the same mean, the variation "
        "along the path adds little",
    )


_CLAIMS: tuple[tuple[Any, ...], ...] = (
    (
        "fzg-film", "Vibration grows with the friction coefficient",
        "acceleration 1.5, 1.9 and 2.4 m/s^2 at 0.05, 0.15 and 0.25 (x1.6)", _vibration,
    ),
    (
        "time-varying-friction", "Friction lowers the rms mesh force, most on smooth flanks",
        "-12.5 % at 0.4 um to -4.1 % at 3.2 um", _rms_force,
    ),
    (
        "fzg-12dof", "Friction raises the fifth harmonic of the transmission error",
        "fifth +62 %, first +1.6 %, second -27 % at 0.035", _fifth,
    ),
    (
        "fzg-roughness", "Roughness lowers force and transmission error, and shows across the "
        "line of action, not along it", "peak force -16.7 % from 0.325 to 0.991 um", _roughness,
    ),
    (
        "hypoid pair", "A constant mean coefficient does as well as one that varies",
        "mesh force nearly, transmission error entirely the same", _constant_instead,
    ),
)  # fmt: skip


def _height(experiment: FrictionExperiment, place: int) -> str:
    return f"{experiment.rubbing[place].roughness * 1e6:g} um"


def _span(values: Any, form: str = ".2f") -> str:
    low, high = (format(float(end(values)), form) for end in (np.min, np.max))
    return low if low == high else f"{low} to {high}"


def _percent(values: object, *, sign: bool = True) -> str:
    return f"{_span(100.0 * np.asarray(values), '+.2g' if sign else '.2g')} %"


def _times(values: object) -> str:
    return "x" + _span(values, ".3g").replace("to ", "to x")


def _settings(holds: Mask) -> str:
    """Describe the settings of driving gear and held torque in which a claim holds."""
    if holds.all() or not holds.any():
        return "any gear drives and any torque is held" if holds.all() else "nowhere"
    phrases = []
    for driving, row in zip(DRIVING, holds, strict=True):
        if row.any():
            balances = [name for name, applies in zip(HELD, row, strict=True) if applies]
            phrases.append(driving if row.all() else f"{driving}, {' or '.join(balances)}")
    return "; ".join(phrases)
