"""Factors of a rating: value, unit, source and branch, and values that the caller gives."""

from __future__ import annotations

from collections.abc import Mapping

from tribodyn.errors import Argument, InputError, did_you_mean, warn


class Factor(float):
    """One factor of a standard: a number that carries its unit, its source and the branch taken.

    Parameters
    ----------
    value : float
        Value in ``unit`` (the unit of the factor).
    unit : str
        SI unit; empty for a pure number.
    source : str
        Standard and clause, or paper.
    branch : str
        Which of the rules of the source applied; ``"given"`` for a value of the caller.

    Examples
    --------
    >>> factor = Factor(1.016, source="ISO 6336-1, K_v", branch="subcritical")
    >>> factor * 2.0, factor.branch
    (2.032, 'subcritical')
    """

    def __new__(cls, value: float, unit: str = "", source: str = "", branch: str = "") -> Factor:
        """Make a number that carries its origin."""
        factor = super().__new__(cls, value)
        factor.unit, factor.source, factor.branch = unit, source, branch
        return factor

    unit: str
    source: str
    branch: str

    @property
    def value(self) -> float:
        """The number alone."""
        return float(self)

    def to_dict(self) -> dict[str, float | str]:
        """Value, unit, source and branch, as JSON has them.

        Returns
        -------
        dict of str
        """
        return {
            "value": float(self), "unit": self.unit, "source": self.source, "branch": self.branch,
        }  # fmt: skip


class Factors(dict[str, Factor]):
    """Factors by the names of the standard, where values of the caller replace computed ones."""

    def __init__(
        self, replacements: Mapping[str, float] | None = None, common: Factors | None = None
    ) -> None:
        super().__init__(common or {})
        self.replacements = dict(replacements or {})

    def record(
        self, name: str, value: float, source: str, *, unit: str = "", branch: str = ""
    ) -> float:
        """Store a factor and return the value that counts: the caller's, if there is one."""
        if name in self.replacements:
            value, branch = self.replacements[name], "given"
        self[name] = Factor(value, unit, source, branch)
        return float(value)

    @property
    def overridden(self) -> tuple[str, ...]:
        """Names of the factors that the caller gave."""
        return tuple(name for name in self.replacements if name in self)


def split_replacements(
    factors: Mapping[str, float], parts: tuple[str, ...]
) -> dict[str, dict[str, float]]:
    """Values of the caller by part: ``pinion.Y_F`` is of one part, ``Y_F`` is of all."""
    split: dict[str, dict[str, float]] = {part: {} for part in parts}
    for name, value in sorted(factors.items(), key=lambda item: "." in item[0]):
        owner, _, short = name.rpartition(".")
        for part in (owner,) if owner in split else parts:
            split[part][short if owner in split else name] = float(value)
    return split


def refuse_unknown(factors: Mapping[str, float], in_use: Mapping[str, object]) -> None:
    """Raise an error for a factor of the caller that no rating uses."""
    for name in factors:
        if name.rpartition(".")[2] not in in_use:
            what, why = f'factors has "{name}"', f"Factors of this rating: {', '.join(in_use)}"
            remedy = did_you_mean(name, in_use, "Use one of these names")
            raise InputError(what, Argument("factors"), why, remedy)


def check_range(
    name: str, value: float, low: float, high: float, source: str, *, limited: bool = False
) -> None:
    """Warn where a rule is used outside of the range of its source, or at the end of it."""
    if not low <= value <= high:
        used = "value at its end is used" if limited else "formula is used beyond it"
        warn(
            "rating-range",
            f"{name} = {value:.6g} lies outside of the range {low:g} to {high:g} of {source}; the "
            f"{used}, compare with a computed or measured value",
        )
