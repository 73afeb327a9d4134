"""The figures of all built-in cases, and how closely they must stay what they were."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import tribodyn as td

#: Relative change that is allowed.
TOLERANCE = 1e-9

#: Below this, in SI, a figure counts as zero.
_ZERO = 1e-15

#: What is zero by symmetry and holds nothing but rounding: the uniform stiffness of this case has
#: no harmonics.
_FLOORS = {
    ("fzg-stiffness", name): 1e-12
    for name in (
        "peak_to_peak_static_transmission_error",
        *(f"static_transmission_error_harmonic_{order}" for order in range(1, 6)),
    )
}

#: Distance of two orbits over their size, each of which is known to about 1e-12: the linear
#: algebra of another processor rounds differently.
_APART = {"step_error": 1e-11}

#: Size of an error that was left, which may become smaller: the most that it may be.
_LEFT_OVER = {"steady_state_error": 1e-9}


def case_figures() -> dict[str, dict[str, Any]]:
    """Summary and warning codes of every built-in case."""
    figures = {}
    for name in td.cases():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", td.ModelWarning)
            result = td.run(name)
        codes = sorted({warning.code for warning in result.warnings})
        figures[name] = {"summary": result.summary(), "warnings": codes}
    return figures


def differences(
    case: str,
    frozen: Mapping[str, float],
    current: Mapping[str, float],
    tolerance: float = TOLERANCE,
) -> list[str]:
    """Say which frozen figures of a case are gone or differ."""
    changes = []
    for name, old in frozen.items():
        if name not in current:
            changes.append(f"{case}: {name} is gone")
        elif not _same(case, name, old, current[name], tolerance):
            change = abs(current[name] / old - 1.0) if old else abs(current[name])
            changes.append(f"{case}: {name} was {old!r}, is {current[name]!r} ({change:.1e})")
    return changes


def _same(case: str, name: str, old: float, new: float, tolerance: float) -> bool:
    if name in _LEFT_OVER:
        return 0.0 <= new <= _LEFT_OVER[name]
    floor = _FLOORS.get((case, name), _APART.get(name, _ZERO))
    return abs(new - old) <= max(tolerance * abs(old), floor)
