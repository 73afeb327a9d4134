"""Measured torque losses: friction coefficient and its uncertainty; power flow of the rig."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from tribodyn.errors import InputError, Problem, warn
from tribodyn.losses.gearbox import PARTS, GearboxLosses
from tribodyn.losses.loss_table import PowerLossTable
from tribodyn.nomenclature import require_whole
from tribodyn.record import Labels, Record, fact, quantity, record
from tribodyn.types import Array, Index
from tribodyn.units import RPM

#: Relative standard uncertainty up to which a value is reliable, and above which it is useless.
_SOUND, _LOST = 0.1, 0.3
#: Coefficient above which a measurement of lubricated teeth is none.
_MOST = 0.2
#: Standard uncertainties by which a loss may lie below the loss without load, as scatter.
_SCATTER = 3.0
_SAME_SPEED = 0.01  # relative difference of speeds that count as one


@record
class FrictionFromLoss(Record):
    """Friction coefficients from measured losses: one row for each speed and torque under load.

    Parameters
    ----------
    speed : array [rad/s]
        Speed.
    torque : array [N*m]
        Torque.
    friction_coefficient : array
        Mean friction coefficient.
    standard_uncertainty : array
        Its standard uncertainty of first order, a pure number.
    degrees_of_freedom : array
        Effective degrees of freedom of that uncertainty (Welch and Satterthwaite), a pure number.
    monte_carlo_uncertainty : array
        The same standard uncertainty by drawing every input, a pure number.
    low, high : array
        Band that holds the coefficient with 95 %, pure numbers.
    sensitivity : array [1/(N*m)]
        Change of the coefficient with the torque loss.
    verdict : tuple of str
        How far each row can be trusted.

    Examples
    --------
    >>> table = PowerLossTable([146.6, 146.6], [5.0, 150.0], [1.0, 3.25], gear_loss_factor=0.3,
    ...                        torque_loss_uncertainty=0.05)
    >>> found = friction_from_power_loss(table)
    >>> found.friction_coefficient.round(4).tolist(), found.verdict
    ([0.05], ('sound',))
    """

    speed: Array = quantity("point", axis=True)
    torque: Array = quantity("point", axis=True)
    friction_coefficient: Array = quantity("point")
    standard_uncertainty: Array = quantity("point", unit="1")
    degrees_of_freedom: Array = quantity("point", unit="1")
    monte_carlo_uncertainty: Array = quantity("point", unit="1")
    low: Array = quantity("point", unit="1")
    high: Array = quantity("point", unit="1")
    sensitivity: Array = quantity("point", unit="1/(N*m)")
    verdict: tuple[str, ...] = quantity("point", unit="1")

    def __repr__(self) -> str:
        """One line."""
        sound = sum(verdict == "sound" for verdict in self.verdict)
        return f"FrictionFromLoss({self.torque.size} points, {sound} of them sound)"


@dataclass(frozen=True)
class _Point:
    """Readings of one speed and torque: mean, variance of the mean, its degrees of freedom."""

    rows: list[int]
    mean: float
    variance: float
    freedom: float


def friction_from_power_loss(
    table: PowerLossTable, *, draws: int = 20000, seed: int = 0
) -> FrictionFromLoss:
    """Mean friction coefficient of each loaded point of a table, with its uncertainty.

    ``mu = (T_loss - T_0 - T_other)/(k T H_V)`` with the loss T_0 without load at that speed and k
    gear sets.

    Parameters
    ----------
    table : PowerLossTable
        Measured losses.
    draws : int
        Number of draws of the Monte Carlo propagation.
    seed : int
        Seed of the draws, an index.

    Returns
    -------
    FrictionFromLoss
        One row for each speed and torque under load, in the order of the table.

    Raises
    ------
    InputError
        Naming each row that has no row without load at its speed, or a loss below that by more
        than its scatter; and where neither repeats nor an uncertainty tell the scatter.

    Warns
    -----
    ModelWarning
        Code ``friction-from-loss`` naming the rows whose coefficient is negative or above 0.2.

    Source: power balance of back-to-back rigs; uncertainty after the GUM (JCGM 100) and its
    supplement 1.

    Examples
    --------
    >>> table = PowerLossTable([146.6, 146.6], [5.0, 50.0], [1.0, 1.4], gear_loss_factor=0.3024,
    ...                        torque_loss_uncertainty=0.1)
    >>> found = friction_from_power_loss(table)
    >>> found.sensitivity.round(4).tolist(), found.verdict
    ([0.0661], ('ill-conditioned: 35 % standard uncertainty',))
    """
    require_whole("draws", draws, 2)
    require_whole("seed", seed, 0)
    idle = table.torque <= table.no_load_torque
    points = [_point(table, rows) for rows in _runs(table, np.flatnonzero(~idle))]
    idles = [_point(table, rows) for rows in _runs(table, np.flatnonzero(idle))]
    if not points:
        what = f"no row has more than {table.no_load_torque:g} N*m"
        why = "Rows up to no_load_torque count as without load"
        remedy = "Lower no_load_torque, or add rows under load"
        raise InputError(what, "PowerLossTable", why, remedy)
    pairs = _matched(table, points, idles)
    torque = np.array([table.torque[point.rows].mean() for point in points])
    other = np.array([table.other_loss[point.rows].mean() for point in points])
    loss = np.array([point.mean - idle_point.mean for point, idle_point in pairs])
    slope = 1.0 / (table.gear_sets * torque * table.gear_loss_factor)
    mu = (loss - other) * slope
    parts = _variances(table, pairs, torque, slope, mu)
    uncertainty = np.sqrt(parts.sum(axis=0))
    freedom = _freedom(parts, pairs)
    from scipy.stats import t

    reach = t.ppf(0.975, freedom) * uncertainty
    result = FrictionFromLoss(
        speed=np.array([table.speed[point.rows].mean() for point in points]),
        torque=torque,
        friction_coefficient=mu,
        standard_uncertainty=uncertainty,
        degrees_of_freedom=freedom,
        monte_carlo_uncertainty=_monte_carlo_deviation(table, pairs, torque, other, (draws, seed)),
        low=mu - reach,
        high=mu + reach,
        sensitivity=slope,
        verdict=tuple(_verdict(*row) for row in zip(mu, uncertainty, pairs, strict=True)),
    )
    _warn_of_impossible([table.place(point.rows[0]) for point in points], mu)
    return result


def _runs(table: PowerLossTable, rows: Index) -> list[list[int]]:
    """Rows of one speed and torque, in the order of the table."""
    runs: list[list[int]] = []
    for row in rows:
        for run in runs:
            same_speed = math.isclose(table.speed[row], table.speed[run[0]], rel_tol=_SAME_SPEED)
            if same_speed and math.isclose(table.torque[row], table.torque[run[0]], rel_tol=0.01):
                run.append(int(row))
                break
        else:
            runs.append([int(row)])
    return runs


def _point(table: PowerLossTable, rows: list[int]) -> _Point:
    readings, uncertainty = table.torque_loss[rows], table.torque_loss_uncertainty
    count = len(rows)
    if uncertainty is not None:
        return _Point(rows, float(readings.mean()), uncertainty**2 / count, math.inf)
    if count > 1:
        variance = float(readings.var(ddof=1)) / count
        return _Point(rows, float(readings.mean()), variance, count - 1.0)
    what = f"one reading at {table.torque[rows[0]]:g} N*m and {table.speed[rows[0]] / RPM:.4g} rpm"
    why = "A single reading has no scatter"
    raise InputError(what, table.place(rows[0]), why, "Repeat it, or give torque_loss_uncertainty")


def _matched(
    table: PowerLossTable, points: list[_Point], idles: list[_Point]
) -> list[tuple[_Point, _Point]]:
    """Pair each point with the one without load at its speed; report all missing ones by row."""
    pairs, problems = [], []
    for point in points:
        speed = table.speed[point.rows[0]]
        idle_points = [
            idle
            for idle in idles
            if math.isclose(table.speed[idle.rows[0]], speed, rel_tol=_SAME_SPEED)
        ]
        where = table.place(point.rows[0])
        if not idle_points:
            idle_speeds = sorted({round(table.speed[idle.rows[0]] / RPM, 1) for idle in idles})
            what = f"no run without load at {speed / RPM:.4g} rpm"
            speeds = ", ".join(f"{rpm:g} rpm" for rpm in idle_speeds)
            why = f"Without load there are {speeds or 'no rows'}"
            remedy = f"Measure one there, with at most {table.no_load_torque:g} N*m"
            problems.append(Problem(what, where, why, remedy))
            continue
        scatter = math.sqrt(point.variance + idle_points[0].variance)
        if point.mean < idle_points[0].mean - _SCATTER * scatter:
            problems.append(
                Problem(
                    f"torque_loss = {point.mean:.4g} N*m is below the "
                    f"{idle_points[0].mean:.4g} N*m without load at {speed / RPM:.4g} rpm",
                    where,
                    "A load can only add to the loss",
                    "Check columns, zero of the torque meter and oil temperature of both runs",
                )
            )
        pairs.append((point, idle_points[0]))
    if problems:
        raise InputError(problems)
    return pairs


def _variances(
    table: PowerLossTable,
    pairs: list[tuple[_Point, _Point]],
    torque: Array,
    slope: Array,
    mu: Array,
) -> Array:
    """Variance of the coefficient by loss, loss without load, and all that has no repeats."""
    other = (slope * table.other_loss_uncertainty) ** 2
    other += (mu * table.torque_uncertainty / torque) ** 2
    other += (mu * table.gear_loss_factor_uncertainty / table.gear_loss_factor) ** 2
    loaded, idle = np.array([[point.variance, base.variance] for point, base in pairs]).T
    return np.stack([slope**2 * loaded, slope**2 * idle, other])


def _freedom(parts: Array, pairs: list[tuple[_Point, _Point]]) -> Array:
    """Effective degrees of freedom after Welch and Satterthwaite."""
    freedom = np.array([[point.freedom, base.freedom, math.inf] for point, base in pairs]).T
    spread = np.sum(parts**2 / freedom, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        freedom_welch = parts.sum(axis=0) ** 2 / spread
    return np.where(spread > 0.0, freedom_welch, np.inf)


def _monte_carlo_deviation(
    table: PowerLossTable,
    pairs: list[tuple[_Point, _Point]],
    torque: Array,
    other: Array,
    draws: tuple[int, int],
) -> Array:
    """Standard deviation of the coefficient when every input is sampled at random."""
    random = np.random.default_rng(draws[1])

    def around(value: Any, deviation: Any) -> Array:
        return np.asarray(value + deviation * random.standard_normal((draws[0], len(pairs))))

    loaded = around([p.mean for p, _ in pairs], np.sqrt([p.variance for p, _ in pairs]))
    idle = around([b.mean for _, b in pairs], np.sqrt([b.variance for _, b in pairs]))
    other_loss = around(other, table.other_loss_uncertainty)
    factor = around(table.gear_loss_factor, table.gear_loss_factor_uncertainty)
    load = around(torque, table.torque_uncertainty)
    mu = (loaded - idle - other_loss) / (table.gear_sets * load * factor)
    return np.asarray(mu.std(axis=0, ddof=1))


def _verdict(mu: float, uncertainty: float, pair: tuple[_Point, _Point]) -> str:
    if mu <= 0.0:
        return "negative: what was taken off is more than the load adds"
    if mu > _MOST:
        return f"implausible: lubricated teeth have less than {_MOST:g}"
    if uncertainty == 0.0 and any(math.isfinite(point.freedom) for point in pair):
        return "unknown: the repeats do not differ, give torque_loss_uncertainty"
    relative = uncertainty / mu
    if relative <= _SOUND:
        return "sound"
    kind = "uncertain" if relative <= _LOST else "ill-conditioned"
    return f"{kind}: {100.0 * relative:.0f} % standard uncertainty"


def _warn_of_impossible(places: list[str], coefficients: Array) -> None:
    named = list(zip(places, coefficients, strict=True))
    if high := [f"{place} ({mu:.3g})" for place, mu in named if mu > _MOST]:
        warn(
            "friction-from-loss",
            f"the friction coefficient of {', '.join(high)} is above {_MOST:g}, as of no "
            "lubricated teeth. Check the units of torque and torque_loss, gear_loss_factor, "
            "and whether bearings, seals and slave gears are in other_loss and gear_sets.",
        )
    rows = [place for place, mu in named if mu <= 0.0]
    if rows:
        warn(
            "friction-from-loss",
            f"the friction coefficient of {', '.join(rows)} is not positive: bearings, seals, "
            "slave gears and the loss without load are more than the loss measured. Check "
            "other_loss, which must not hold what is lost without load as well.",
        )


_SAME = 1e-9  # relative difference of torques and speeds that count as one


@record
class RigPowerFlow(Record):
    """Losses of both gearboxes of a closed power loop; made by :func:`rig_power_flow`.

    Parameters
    ----------
    gearbox : tuple of str
        ``"test"`` and ``"slave"``.
    part : tuple of str
        Names of the parts, those of :class:`GearboxLosses`.
    loss : array (2, parts) [W]
        Power that each part of each gearbox loses.
    circulating_power : float [W]
        Power that goes round in the loop.

    Examples
    --------
    >>> RigPowerFlow(("test", "slave"), ("gear",), np.array([[200.0], [150.0]]), 22e3).motor_power
    350.0
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {"motor_power": Labels(())}

    gearbox: tuple[str, ...] = quantity("gearbox", unit="1", axis=True)
    part: tuple[str, ...] = quantity("part", unit="1", axis=True)
    loss: Array = quantity("gearbox", "part", unit="W")
    circulating_power: float = fact()

    @property
    def motor_power(self) -> float:
        """All losses, which the motor brings up [W]."""
        return float(self.loss.sum())

    def __repr__(self) -> str:
        """One line."""
        powers = f"motor {self.motor_power:.5g} W for {self.circulating_power:.5g} W in the loop"
        return f"RigPowerFlow({powers})"


def rig_power_flow(test: GearboxLosses, slave: GearboxLosses) -> RigPowerFlow:
    """Power flow of a back-to-back rig at one torque and speed.

    Parameters
    ----------
    test, slave : GearboxLosses
        Both gearboxes, each at one torque and speed, the same for both.

    Raises
    ------
    InputError
        If they are of several points, or of different ones.

    Notes
    -----
    The losses are some per cent of the power in the loop, so that both gearboxes count as under
    the same torque. Source: power balance of the closed loop.

    Examples
    --------
    >>> one = np.array([1.0])
    >>> box = GearboxLosses(150.0 * one, 100.0 * one, *np.full((8, 1, 1), 10.0))
    >>> rig_power_flow(box, box)
    RigPowerFlow(motor 160 W for 15000 W in the loop)
    """
    points = [(box.transmitted_power, box.pinion_speed) for box in (test, slave)]
    single = all(power.size == 1 for power, _ in points)
    if not (
        single and np.ptp(np.log([[p.item(), n.item()] for p, n in points]), axis=0).max() < _SAME
    ):
        why = "A loop has one torque and one speed at a time, the same in both gearboxes"
        raise InputError(f"{test!r} and {slave!r}", "test, slave", why, "Give one point of both")
    loss = np.array([[float(getattr(box, part)[0, 0]) for part in PARTS] for box in (test, slave)])
    power = float(test.transmitted_power[0, 0])
    return RigPowerFlow(("test", "slave"), tuple(PARTS), loss, power)
