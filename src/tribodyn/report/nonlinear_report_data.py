"""Report data of natural modes, of nonlinear studies and of tolerance studies of a case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn import plot
from tribodyn.errors import InputError
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine import machine_modes
from tribodyn.model import Option
from tribodyn.progress import SILENT, Progress
from tribodyn.report.numbers import HEAD, cells
from tribodyn.report.study_report_data import StudyReportData, facts_of, figure_with_caption
from tribodyn.study.case.values import FaultError, read_value
from tribodyn.study.machine.modes import (
    MODES_HEAD,
    axial_notes,
    campbell_of,
    mode_rows,
    modes_facts,
)
from tribodyn.study.machine.run import structure_at_rest
from tribodyn.study.machine.tables import OperationTable
from tribodyn.study.pipeline.summary_figures import figure_of
from tribodyn.study.studies.needs import PAIRS, kind_of
from tribodyn.study.studies.study_axes import Axis
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.analysis import Basins, LyapunovExponents
    from tribodyn.dynamics import Branch
    from tribodyn.study import CaseSensitivity
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase, MachineCase


def any_modes_report_data(
    case: AnyCase, ends: object, progress: Progress = SILENT
) -> StudyReportData:
    """Natural modes of a pair or a machine; ``ends`` limits the speeds."""
    if kind_of(case) in PAIRS:
        return _pair_modes_report_data(case, ends, progress)  # type: ignore[arg-type]
    return _parts_modes_report_data(case, ends, progress)  # type: ignore[arg-type]


def _parts_modes_report_data(
    case: MachineCase, ends: object, progress: Progress = SILENT
) -> StudyReportData:
    """Natural modes of a machine and what excites them; ``ends`` limits the speeds."""
    with single_blas_thread():
        structure = structure_at_rest(case, progress)
        progress.start("Natural modes")
        modes = machine_modes(structure)
        campbell = campbell_of(structure, _diagram_speeds(ends), modes)
    pictures = ((plot.machine_modes, modes), (plot.machine_campbell, campbell))
    figures = [figure_with_caption(*each) for each in pictures if not each[0].missing(each[1])]
    progress.finish()
    statements = [f"{figures[-1][1].layout.title.text}.", *axial_notes(modes)]
    facts = modes_facts(modes, campbell)
    rows = mode_rows(modes)
    return StudyReportData(campbell, figures, statements, MODES_HEAD, rows, facts)


def _diagram_speeds(ends: Any) -> Any:
    """Speeds of a diagram between two ends, given as text or in rad/s."""
    if ends is None:
        return None
    spec = OperationTable.fields["speed"]
    assert isinstance(spec, Option)
    try:
        first, last = (read_value(spec, "speed", end) for end in ends)
    except FaultError as fault:
        raise InputError(replace(fault.problem, where="operation.speed")) from None
    return np.linspace(max(first, 0.0), last, 8)


def _pair_modes_report_data(
    case: PairCase, ends: object, progress: Progress = SILENT
) -> StudyReportData:
    """Natural frequencies and critical speeds; ``ends`` limits the speeds [rad/s]."""
    from tribodyn.dynamics import natural_modes
    from tribodyn.study.pipeline.assembly import ORDERS, diagram_of
    from tribodyn.study.pipeline.tooth_contact import operation_values
    from tribodyn.study.studies.case_grid import build_system
    from tribodyn.study.studies.modes import mode_rows

    speeds = None if ends is None else operation_values("speed", ends, case)
    system, mesh_frequency = build_system(case, progress=progress)
    modes = natural_modes(system)
    diagram = diagram_of(system, case, mesh_frequency, speeds)
    rows = mode_rows(modes, case, mesh_frequency)
    figures = [
        figure_with_caption(plot.mode_shapes, modes),
        figure_with_caption(plot.campbell, diagram),
    ]
    statements = [
        f"{figures[1][1].layout.title.text}; speeds are those of the {case.operation.speed_of}."
    ]
    facts = {
        "mesh_frequency": mesh_frequency,
        "orders": list(ORDERS),
        "modes": [vars(row) for row in rows],
    }
    return StudyReportData(modes, figures, statements, HEAD, [cells(row) for row in rows], facts)


#: Rows of the table of a branch.
_ROWS = 60
_VERDICTS = {
    "physical": "Half the time step gives the same result.",
    "step-limited": "Half the time step gives another response: this result is not physical.",
    "undecided": "Half the time step gives another value: use more mesh cycles or steps.",
}


def lyapunov_report_data(
    case: AnyCase,
    cycles: int | None = None,
    transient: int = 300,
    progress: Progress = SILENT,
) -> StudyReportData:
    """Lyapunov exponents of the response of a case."""
    from tribodyn.study.studies.nonlinear import lyapunov_exponents

    spectrum = lyapunov_exponents(case, cycles=cycles, transient=transient, progress=progress)
    values = zip(spectrum.exponents, spectrum.standard_error, spectrum.free_rotation, strict=True)
    rows = [
        [str(number), f"{value:.6g}", f"{error:.2g}", "free rotation" if free else "vibration"]
        for number, (value, error, free) in enumerate(values, 1)
    ]
    facts = facts_of(
        spectrum,
        "exponents standard_error free_rotation rotating largest largest_error chaotic repeats "
        "divergence kaplan_yorke_dimension mesh_frequency cycles verdict",
    )
    head = ("Exponent", "Value [1/s]", "Standard error [1/s]", "Belongs to")
    figures = [figure_with_caption(plot.lyapunov, spectrum)]
    return StudyReportData(spectrum, figures, _exponent_statements(spectrum), head, rows, facts)


def _exponent_statements(spectrum: LyapunovExponents) -> list[str]:
    kind = "Chaotic" if spectrum.chaotic else "Not chaotic"
    error = "" if np.isnan(spectrum.largest_error) else f" +- {spectrum.largest_error:.1g}"
    statements = [f"{kind}: the largest exponent is {spectrum.largest:.5g}{error} 1/s."]
    if spectrum.repeats:
        cycles = "every mesh cycle" if spectrum.repeats == 1 else f"{spectrum.repeats} mesh cycles"
        statements.append(f"The response has a period of {cycles}."
                    if spectrum.repeats > 1 else f"The response repeats {cycles}.")  # fmt: skip
    if spectrum.left_out:
        statements.append(f"{spectrum.left_out[:1].upper()}{spectrum.left_out[1:]}.")
    return [*statements, *([_VERDICTS[spectrum.verdict]] if spectrum.verdict in _VERDICTS else [])]


def basins_report_data(
    case: AnyCase,
    transmission_error: Any = None,
    rate: Any = None,
    points: int | None = None,
    keep_partial: bool = False,
    progress: Progress = SILENT,
    mesh: str | None = None,
) -> StudyReportData:
    """Basins of attraction of a case over transmission error and its rate."""
    from tribodyn.study.studies.nonlinear import basins

    how: Tree = {"mesh": mesh, "keep_partial": keep_partial, "progress": progress}
    plane = basins(case, transmission_error, rate, points=points, **how)
    if not plane.finished.any():
        raise KeyboardInterrupt
    rows = []
    for number, each in enumerate(plane.attractors, 1):
        assert each.section is not None
        at, moving = each.section[0]
        rows.append([
            str(number), f"{100.0 * each.share:.3g}", str(each.period) if each.period else "none",
            f"{1e6 * each.rms:.4g}", f"{100.0 * each.contact_loss_share:.3g}",
            f"{1e6 * at:.4g}", f"{1e6 * moving:.4g}",
            "" if np.isnan(each.largest_multiplier) else f"{each.largest_multiplier:.4g}",
            each.verdict,
        ])  # fmt: skip
    names = "share period rms contact_loss_share section largest_multiplier verdict"
    facts = {
        **facts_of(plane, "coordinates units mesh_frequency unresolved changed complete"),
        "transmission_error": plane.first[[0, -1]].tolist(),
        "rate": plane.second[[0, -1]].tolist(),
        "points": [plane.first.size, plane.second.size],
        "attractors": [facts_of(each, names) for each in plane.attractors],
    }
    head = ("Attractor", "Share [%]", "Period [mesh cycles]", "Rms [um]", "Contact loss [%]",
            "Transmission error at phase 0 [um]", "Its rate [um/s]", "Largest multiplier",
            "Verdict")  # fmt: skip
    figures = [figure_with_caption(plot.basins, plane)]
    return StudyReportData(plane, figures, _basin_statements(plane), head, rows, facts)


def _basin_statements(plane: Basins) -> list[str]:
    count = len(plane.attractors)
    verb = "s are" if count != 1 else " is"
    statements = [
        f"{count} attractor{verb} possible at a mesh frequency of {plane.mesh_frequency:.5g} Hz."
    ]
    for number, each in enumerate(plane.attractors, 1):
        kind = f"period {each.period}" if each.period else "not periodic"
        loss = f", contact lost for {100.0 * each.contact_loss_share:.3g} % of the time"
        statements.append(
            f"Attractor {number}: {100.0 * each.share:.3g} % of the initial states, {kind}, rms "
            f"{1e6 * each.rms:.3g} um{loss if each.contact_loss_share else ''}."
        )
    if plane.unresolved:
        statements.append(f"{100.0 * plane.unresolved:.3g} % of the initial states reach no "
                    "attractor within the mesh cycles.")  # fmt: skip
    if plane.changed > 0.0:
        statements.append(f"{100.0 * plane.changed:.3g} % of the initial states reach another "
                    "attractor with half the time step.")  # fmt: skip
    if not plane.complete:
        statements.append(
            f"Interrupted: {int(plane.finished.sum())} of {plane.finished.size} initial states."
        )
    return statements


def continuation_report_data(
    case: AnyCase,
    over: str,
    between: tuple[object, object],
    periods: int = 1,
    longest_step: float = 0.02,
    by: str = "",
    progress: Progress = SILENT,
    mesh: str | None = None,
) -> StudyReportData:
    """Branch of periodic orbits of a case over one of its values."""
    from tribodyn.study.studies.nonlinear import continuation

    branch = continuation(
        case,
        over,
        between,
        mesh=mesh, periods=periods, longest_step=longest_step, by=by, progress=progress,
    )  # fmt: skip
    spec = case.option_of(over)
    unit = (spec.unit, spec.display_unit) if spec else ("", "")
    axis = Axis(over, tuple(map(float, branch.parameter)), *unit)
    multiplier = np.abs(branch.floquet_multipliers).max(axis=1, initial=0.0)
    picked = np.unique(np.linspace(0, branch.parameter.size - 1, _ROWS).round().astype(int))
    shown_values = axis.display_values()
    # The ramps of a force law open in sequence; contact is lost when the last one opens.
    loss = 100.0 * branch.contact_loss.min(axis=1)
    rows = [
        [
            f"{shown_values[n]:.6g}",
            f"{1e6 * branch.rms[n, 0]:.5g}",
            f"{1e6 * branch.peak_to_peak[n, 0]:.5g}",
            f"{loss[n]:.3g}",
            f"{multiplier[n]:.4g}",
            "stable" if branch.stable[n] else "unstable",
        ]
        for n in picked
    ]
    name = axis.name.replace("_", " ").capitalize()
    head = (f"{name} [{axis.display_unit}]" if axis.display_unit else name, "Rms [um]",
            "Peak to peak [um]", "Contact loss [%]", "Largest multiplier", "Stability")  # fmt: skip
    facts = {
        "parameter": over,
        "unit": axis.unit,
        "values": branch.parameter.tolist(),
        "rms": branch.rms[:, 0].tolist(),
        "stable": branch.stable.tolist(),
        "largest_multiplier": multiplier.tolist(),
        "special_points": [
            {"kind": p.kind, "value": p.parameter, "rms": float(p.rms[0])}
            for p in branch.special_points
        ],
        "period": branch.period,
        "ending": branch.ending,
        "complete": branch.complete,
    }
    figures = [figure_with_caption(plot.continuation, branch)]
    return StudyReportData(branch, figures, _branch_statements(branch, axis), head, rows, facts)


def _branch_statements(branch: Branch, axis: Axis) -> list[str]:
    low, high = float(branch.parameter.min()), float(branch.parameter.max())
    cycles = f"{branch.period} mesh cycle{'s' if branch.period != 1 else ''}"
    statements = [
        f"{branch.parameter.size} orbits of {cycles} over {axis.key} from "
        f"{axis.show(low)} to {axis.show(high)}, {int(branch.stable.sum())} of them stable."
    ]
    statements += [
        f"{p.kind.capitalize()} at {axis.show(p.parameter)}, rms {1e6 * float(p.rms[0]):.3g} um."
        for p in branch.special_points
    ]
    if not branch.complete:
        statements.append(f"The branch {branch.ending}.")
    return statements


def sobol_report_data(
    case: AnyCase,
    figures: Sequence[str] | None = None,
    size: int = 64,
    seed: int = 0,
    progress: Progress = SILENT,
) -> StudyReportData:
    """Sobol indices of summary figures of a case over its tolerances."""
    from tribodyn.study.uncertain.sensitivity import sobol_indices

    shares = sobol_indices(
        case, list(figures or ()) or None, size=size, seed=seed, progress=progress
    )
    facts = {
        "inputs": [str(key) for key in shares.input],
        "variants": len(shares.value),
        "figures": {
            str(name): {
                name: getattr(shares, name)[n].tolist()
                for name in (
                    *("mean", "standard_deviation", "first_order", "total_order"),
                    *("first_order_band", "total_order_band"),
                )
            }
            for n, name in enumerate(shares.figure)
        },
    }
    rows = [
        [str(name) if not k else "", str(key),
         *(f"{100.0 * v:.3g}" for v in (shares.first_order[n, k], shares.total_order[n, k])),
         f"{100.0 * shares.total_order_band[n, 0, k]:.3g} to "
         f"{100.0 * shares.total_order_band[n, 1, k]:.3g}"]
        for n, name in enumerate(shares.figure)
        for k, key in enumerate(shares.input)
    ]  # fmt: skip
    head = ("Figure", "Input", "Alone [%]", "With interactions [%]", "95 % interval [%]")
    statements = [f"{len(shares.value)} variants over {', '.join(map(str, shares.input))}."]
    statements += [f"{key} = {text}" for key, text in case.uncertain.items()]
    statements += [_spread_statement(shares, n) for n in range(len(shares.figure))]
    figure = figure_with_caption(plot.sensitivity, shares)
    return StudyReportData(shares, [figure], statements, head, rows, facts)


def _spread_statement(sensitivity: CaseSensitivity, number: int) -> str:
    name = str(sensitivity.figure[number])
    figure, largest = figure_of(name), int(sensitivity.total_order[number].argmax())
    spread = figure.show(float(sensitivity.standard_deviation[number]))
    share = min(max(100.0 * float(sensitivity.total_order[number, largest]), 0.0), 100.0)
    return (
        f"{name}: {figure.show(float(sensitivity.mean[number]))}, standard deviation {spread}; "
        f"{share:.0f} % of the variance with {sensitivity.input[largest]}."
    )
