"""What studies of nonlinear motions and of tolerances answer: sentences, table, figures, facts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn import plot
from tribodyn.progress import SILENT, Progress
from tribodyn.report.answers import Answer, pictured
from tribodyn.study.case.provenance import spec_of
from tribodyn.study.pipeline.summary import SUMMARY
from tribodyn.study.studies.axes import Axis

if TYPE_CHECKING:
    from tribodyn.analysis import Basins, LyapunovExponents
    from tribodyn.dynamics import Branch
    from tribodyn.study import CaseSensitivity
    from tribodyn.study.case.case import Case

#: Rows of the table of a branch.
_ROWS = 60
_VERDICTS = {
    "physical": "Half the step gives the same.",
    "step-limited": "Half the step gives another motion: this one is made by the step.",
    "undecided": "Half the step gives another value: take more mesh cycles or steps.",
}


def lyapunov_answer(
    case: Case,
    cycles: int = 1000,
    transient: int = 300,
    progress: Progress = SILENT,
) -> Answer:
    """Lyapunov exponents of the motion of a case."""
    from tribodyn.study.studies.nonlinear import lyapunov_exponents

    found = lyapunov_exponents(case, cycles=cycles, transient=transient, progress=progress)
    values = zip(found.exponents, found.standard_error, found.free_rotation, strict=True)
    rows = [
        [str(number), f"{value:.6g}", f"{error:.2g}", "free rotation" if free else "vibration"]
        for number, (value, error, free) in enumerate(values, 1)
    ]
    facts = {
        "exponents": found.exponents.tolist(),
        "standard_error": _numbers(found.standard_error),
        "free_rotation": found.free_rotation.tolist(),
        "rotating": list(found.rotating),
        "largest": found.largest,
        "largest_error": _number(found.largest_error),
        "chaotic": found.chaotic,
        "repeats": found.repeats,
        "divergence": found.divergence,
        "kaplan_yorke_dimension": found.kaplan_yorke_dimension,
        "mesh_frequency": found.mesh_frequency,
        "cycles": found.cycles,
        "verdict": found.verdict,
    }
    head = ("Exponent", "Value [1/s]", "Standard error [1/s]", "Belongs to")
    figures = [pictured(plot.lyapunov, found)]
    return Answer(found, figures, _exponents_told(found), head, rows, facts)


def _exponents_told(found: LyapunovExponents) -> list[str]:
    kind = "Chaotic" if found.chaotic else "Not chaotic"
    error = "" if np.isnan(found.largest_error) else f" +- {found.largest_error:.1g}"
    told = [f"{kind}: the largest exponent is {found.largest:.5g}{error} 1/s."]
    if found.repeats:
        cycles = "every mesh cycle" if found.repeats == 1 else f"{found.repeats} mesh cycles"
        told.append(f"The motion repeats after {cycles}."
                    if found.repeats > 1 else f"The motion repeats {cycles}.")  # fmt: skip
    if found.left_out:
        told.append(f"{found.left_out[:1].upper()}{found.left_out[1:]}.")
    return [*told, *([_VERDICTS[found.verdict]] if found.verdict in _VERDICTS else [])]


def basins_answer(
    case: Case,
    transmission_error: Any = None,
    rate: Any = None,
    points: int = 31,
    keep_partial: bool = False,
    progress: Progress = SILENT,
) -> Answer:
    """Which motion of a case a disturbed start comes to."""
    from tribodyn.study.studies.nonlinear import basins

    found = basins(
        case,
        transmission_error,
        rate,
        points=points,
        keep_partial=keep_partial,
        progress=progress,
    )
    if not found.finished.any():
        raise KeyboardInterrupt
    rows, attractors = [], []
    for number, each in enumerate(found.attractors, 1):
        assert each.section is not None
        at, moving = each.section[0]
        rows.append([
            str(number), f"{100.0 * each.share:.3g}", str(each.period) if each.period else "none",
            f"{1e6 * each.rms:.4g}", f"{100.0 * each.contact_loss_share:.3g}",
            f"{1e6 * at:.4g}", f"{1e6 * moving:.4g}",
            "" if np.isnan(each.largest_multiplier) else f"{each.largest_multiplier:.4g}",
            each.verdict,
        ])  # fmt: skip
        attractors.append({
            "share": each.share, "period": each.period, "rms": each.rms,
            "contact_loss_share": each.contact_loss_share, "section": each.section.tolist(),
            "largest_multiplier": _number(each.largest_multiplier), "verdict": each.verdict,
        })  # fmt: skip
    facts = {
        "coordinates": list(found.coordinates),
        "units": list(found.units),
        "transmission_error": [float(found.first[0]), float(found.first[-1])],
        "rate": [float(found.second[0]), float(found.second[-1])],
        "points": [int(found.first.size), int(found.second.size)],
        "mesh_frequency": found.mesh_frequency,
        "attractors": attractors,
        "unresolved": found.unresolved,
        "changed": _number(found.changed),
        "complete": found.complete,
    }
    head = ("Motion", "Share [%]", "Period [mesh cycles]", "Rms [um]", "Contact loss [%]",
            "Transmission error at phase 0 [um]", "Its rate [um/s]", "Largest multiplier",
            "Verdict")  # fmt: skip
    return Answer(found, [pictured(plot.basins, found)], _basins_told(found), head, rows, facts)


def _basins_told(found: Basins) -> list[str]:
    count = len(found.attractors)
    verb = "s are" if count != 1 else " is"
    told = [f"{count} motion{verb} possible at a mesh frequency of {found.mesh_frequency:.5g} Hz."]
    for number, each in enumerate(found.attractors, 1):
        kind = f"period {each.period}" if each.period else "does not repeat"
        loss = f", teeth apart for {100.0 * each.contact_loss_share:.3g} % of the time"
        told.append(
            f"Motion {number}: {100.0 * each.share:.3g} % of the starts, {kind}, rms "
            f"{1e6 * each.rms:.3g} um{loss if each.contact_loss_share else ''}."
        )
    if found.unresolved:
        told.append(f"{100.0 * found.unresolved:.3g} % of the starts come to no motion within the "
                    "mesh cycles.")  # fmt: skip
    if found.changed > 0.0:
        told.append(f"{100.0 * found.changed:.3g} % of the starts come to another motion with half "
                    "the step.")  # fmt: skip
    if not found.complete:
        told.append(f"Interrupted: {int(found.finished.sum())} of {found.finished.size} starts.")
    return told


def continuation_answer(
    case: Case,
    over: str,
    between: tuple[Any, Any],
    periods: int = 1,
    longest_step: float = 0.02,
    by: str = "",
    progress: Progress = SILENT,
) -> Answer:
    """Branch of periodic motions of a case over one of its values."""
    from tribodyn.study.studies.nonlinear import continuation

    found = continuation(
        case,
        over,
        between,
        periods=periods,
        longest_step=longest_step,
        by=by,
        progress=progress,
    )
    spec = spec_of(case, over)
    unit = (spec.unit, spec.display_unit) if spec else ("", "")
    axis = Axis(over, tuple(map(float, found.parameter)), *unit)
    multiplier = np.abs(found.floquet_multipliers).max(axis=1, initial=0.0)
    picked = np.unique(np.linspace(0, found.parameter.size - 1, _ROWS).round().astype(int))
    shown = axis.shown()
    # The ramps of a force law open one after the other; flanks part where the last of them does.
    loss = 100.0 * found.contact_loss.min(axis=1)
    rows = [
        [f"{shown[n]:.6g}", f"{1e6 * found.rms[n, 0]:.5g}", f"{1e6 * found.peak_to_peak[n, 0]:.5g}",
         f"{loss[n]:.3g}", f"{multiplier[n]:.4g}",
         "stable" if found.stable[n] else "unstable"]
        for n in picked
    ]  # fmt: skip
    name = axis.name.replace("_", " ").capitalize()
    head = (f"{name} [{axis.display_unit}]" if axis.display_unit else name, "Rms [um]",
            "Peak to peak [um]", "Contact loss [%]", "Largest multiplier", "Stability")  # fmt: skip
    facts = {
        "parameter": over,
        "unit": axis.unit,
        "values": found.parameter.tolist(),
        "rms": found.rms[:, 0].tolist(),
        "stable": found.stable.tolist(),
        "largest_multiplier": multiplier.tolist(),
        "special_points": [
            {"kind": p.kind, "value": p.parameter, "rms": float(p.rms[0])}
            for p in found.special_points
        ],
        "period": found.period,
        "ending": found.ending,
        "complete": found.complete,
    }
    figures = [pictured(plot.continuation, found)]
    return Answer(found, figures, _branch_told(found, axis), head, rows, facts)


def _branch_told(found: Branch, axis: Axis) -> list[str]:
    low, high = float(found.parameter.min()), float(found.parameter.max())
    cycles = f"{found.period} mesh cycle{'s' if found.period != 1 else ''}"
    told = [f"{found.parameter.size} orbits of {cycles} over {axis.key} from {axis.show(low)} to "
            f"{axis.show(high)}, {int(found.stable.sum())} of them stable."]  # fmt: skip
    told += [
        f"{p.kind.capitalize()} at {axis.show(p.parameter)}, rms {1e6 * float(p.rms[0]):.3g} um."
        for p in found.special_points
    ]
    if not found.complete:
        told.append(f"The branch {found.ending}.")
    return told


def sobol_answer(
    case: Case,
    figures: Sequence[str] | None = None,
    size: int = 64,
    seed: int = 0,
    progress: Progress = SILENT,
) -> Answer:
    """Which tolerance of a case the spread of its figures comes from."""
    from tribodyn.study.uncertain.sensitivity import sobol_indices

    found = sobol_indices(
        case, list(figures or ()) or None, size=size, seed=seed, progress=progress
    )
    facts = {
        "inputs": [str(key) for key in found.input],
        "variants": len(found.value),
        "figures": {
            str(name): {
                "mean": float(found.mean[n]),
                "standard_deviation": float(found.standard_deviation[n]),
                "first_order": found.first_order[n].tolist(),
                "total_order": found.total_order[n].tolist(),
                "first_order_band": found.first_order_band[n].tolist(),
                "total_order_band": found.total_order_band[n].tolist(),
            }
            for n, name in enumerate(found.figure)
        },
    }
    rows = [
        [str(name) if not k else "", str(key),
         *(f"{100.0 * v:.3g}" for v in (found.first_order[n, k], found.total_order[n, k])),
         f"{100.0 * found.total_order_band[n, 0, k]:.3g} to "
         f"{100.0 * found.total_order_band[n, 1, k]:.3g}"]
        for n, name in enumerate(found.figure)
        for k, key in enumerate(found.input)
    ]  # fmt: skip
    head = ("Figure", "Input", "Alone [%]", "With interactions [%]", "95 % interval [%]")
    told = [f"{len(found.value)} variants over {', '.join(map(str, found.input))}."]
    told += [f"{key} = {text}" for key, text in case.uncertain.items()]
    told += [_spread_told(found, n) for n in range(len(found.figure))]
    return Answer(found, [pictured(plot.sensitivity, found)], told, head, rows, facts)


def _spread_told(found: CaseSensitivity, number: int) -> str:
    name = str(found.figure[number])
    figure, largest = SUMMARY[name], int(found.total_order[number].argmax())
    spread = figure.show(float(found.standard_deviation[number]))
    share = min(max(100.0 * float(found.total_order[number, largest]), 0.0), 100.0)
    return (
        f"{name}: {figure.show(float(found.mean[number]))}, standard deviation {spread}; "
        f"{share:.0f} % of the variance with {found.input[largest]}."
    )


def _number(value: float) -> float | None:
    """A number for JSON, which has no word for one that is none."""
    return float(value) if np.isfinite(value) else None


def _numbers(values: Any) -> list[float | None]:
    return [_number(value) for value in values]
