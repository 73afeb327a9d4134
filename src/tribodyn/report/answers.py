"""What studies of one case answer: data, figures, sentences and a table; how they are kept."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from tribodyn import plot
from tribodyn.progress import SILENT, Progress
from tribodyn.report.study import write_bifurcation_report, write_study_report
from tribodyn.study.pipeline.save import new_directory

if TYPE_CHECKING:
    from tribodyn.drawing import Drawing
    from tribodyn.losses import GearboxLosses
    from tribodyn.nonlinear.bifurcation import Bifurcation
    from tribodyn.study.case.case import Case
    from tribodyn.study.studies.bifurcation import Findings

#: Rows of the table of a run-up.
_ROWS = 40
_ALONE = "Counted are the teeth alone; bearings, seals and oil are where the case has [losses]."


#: Heading, figure and caption.
Picture = tuple[str, Any, str]


class Answer(NamedTuple):
    """What a study tells: its data, figures, sentences and a table."""

    data: Any  #: result whose data set is stored
    figures: Sequence[Picture]
    told: Sequence[str]
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    facts: dict[str, Any]  #: in SI
    best: Case | None = None  #: a case that the study made


def pictured(figure: Drawing, found: Any) -> Picture:
    """A figure of what a study found, with what stands above and below it."""
    return figure.heading, figure(found), figure.caption_of(found)


def _title(picture: Picture) -> str:
    return str(picture[1].layout.title.text)


def save_answer(kind: str, case: Case, target: Path, found: Answer, force: bool = False) -> None:
    """Write the directory of a study."""
    from tribodyn.validated_files import write_dataset

    with new_directory(target, force=force) as place:
        (place / "case.toml").write_text(case.to_toml(), encoding="utf-8")
        if found.best is not None:
            (place / "best.toml").write_text(found.best.to_toml(), encoding="utf-8")
        write_dataset(found.data.to_xarray(), place / "study.nc")
        write_study_report(
            case,
            place / "report.html",
            kind=kind,
            told=found.told,
            figures=found.figures,
            head=found.head,
            rows=found.rows,
        )


def save_bifurcation(
    found: Bifurcation, case: Case, findings: Findings, target: Path, force: bool = False
) -> None:
    """Write the directory of a bifurcation diagram."""
    from tribodyn.validated_files import write_dataset

    head, rows = findings.rows()
    with new_directory(target, force=force) as place:
        (place / "case.toml").write_text(case.to_toml(), encoding="utf-8")
        write_dataset(found.to_xarray(), place / "bifurcation.nc")
        write_bifurcation_report(
            found,
            case,
            place / "bifurcation.html",
            lead=findings.lead(),
            told=findings.sentences(),
            head=head,
            rows=rows,
        )


def modes_answer(case: Case, ends: Any, progress: Progress = SILENT) -> Answer:
    """Natural frequencies and critical speeds, over speeds in SI if they are given."""
    from tribodyn.dynamics import natural_modes
    from tribodyn.report.numbers import HEAD, cells
    from tribodyn.study.studies.axes import operation_values
    from tribodyn.study.studies.modes import ORDERS, diagram_of, mode_rows
    from tribodyn.study.studies.structure import build_system

    speeds = None if ends is None else operation_values("speed", ends, case)
    system, mesh_frequency = build_system(case, progress=progress)
    found = natural_modes(system)
    diagram = diagram_of(system, case, mesh_frequency, speeds)
    rows = mode_rows(found, case, mesh_frequency)
    figures = [pictured(plot.mode_shapes, found), pictured(plot.campbell, diagram)]
    told = [f"{_title(figures[1])}; speeds are those of the {case.operation.speed_of}."]
    facts = {
        "mesh_frequency": mesh_frequency,
        "orders": list(ORDERS),
        "modes": [vars(row) for row in rows],
    }
    return Answer(found, figures, told, HEAD, [cells(row) for row in rows], facts)


def harris_answer(case: Case, torque: Sequence[Any] | None) -> Answer:
    """Static transmission error over the torque."""
    from tribodyn.study.studies.static import harris_map

    found = harris_map(case, torque)
    columns = {
        "torque": found.torque,
        "mean_transmission_error": found.mean_transmission_error,
        "peak_to_peak_transmission_error": found.peak_to_peak_transmission_error,
        "mean_mesh_stiffness_secant": found.mean_mesh_stiffness_secant,
    }
    rows = [
        [f"{t:.4g}", f"{m * 1e6:.4g}", f"{p * 1e6:.4g}", f"{k * 1e-6:.4g}"]
        for t, m, p, k in zip(*columns.values(), strict=True)
    ]
    head = ["Pinion torque [N*m]", "Mean error [um]", "Peak to peak [um]", "Stiffness [N/um]"]
    figure = pictured(plot.harris_map, found)
    facts = {name: values.tolist() for name, values in columns.items()}
    return Answer(found, [figure], [f"{_title(figure)}."], head, rows, facts)


def relief_answer(case: Case, torque: Sequence[Any] | None, gears: str) -> Answer:
    """Tip relief that leaves least transmission error, and the case with it."""
    from tribodyn.study.studies.static import optimize_tip_relief

    found = optimize_tip_relief(case, torque, gears=gears)
    before, after = found.peak_to_peak_before, found.peak_to_peak_after
    rows = [
        [f"{t:.4g}", f"{b * 1e6:.4g}", f"{a * 1e6:.4g}"]
        for t, b, a in zip(found.torque, before, after, strict=True)
    ]
    head = ["Pinion torque [N*m]", "Peak to peak before [um]", "Peak to peak after [um]"]
    told = [
        f"A relief of {found.amount * 1e6:.4g} um over {found.length * 1e3:.4g} mm of roll "
        f"length; best.toml is the case with it."
    ]
    if found.on_edge:
        told.append("It lies at the edge of what was searched: a wider range may hold a better.")
    figures = [pictured(plot.tip_relief_map, found)]
    facts = {
        "amount": found.amount,
        "length": found.length,
        "torque": found.torque.tolist(),
        "peak_to_peak_before": before.tolist(),
        "peak_to_peak_after": after.tolist(),
        "on_edge": bool(found.on_edge),
    }
    return Answer(found, figures, told, head, rows, facts, found.case)


def run_up_answer(
    case: Case, ends: Any, duration: float, down: bool = False, progress: Progress = SILENT
) -> Answer:
    """Levels over the speed while it rises."""
    from tribodyn.analysis import overall_level
    from tribodyn.study.studies.run_up import run_up
    from tribodyn.units import convert

    found = run_up(case, ends, duration, down=down, progress=progress)
    level = overall_level(found, "contact_force")
    picked = range(0, level.rms.size, max(1, level.rms.size // _ROWS))
    rpm = convert(1.0, "rad/s", "rpm") * level.speed
    rows = [[f"{rpm[k]:.5g}", f"{level.rms[k]:.4g}"] for k in picked]
    figures = [pictured(plot.run_up, found), pictured(plot.run_up_map, found)]
    facts = {"speed": level.speed.tolist(), "rms_mesh_force": level.rms.tolist()}
    head = ["Speed [rpm]", "Mesh force, rms [N]"]
    return Answer(found, figures, [f"{_title(figures[0])}."], head, rows, facts)


def losses_answer(
    case: Case, torque: Any = None, speed: Any = None, progress: Progress = SILENT
) -> Answer:
    """Losses and efficiency over torque and speed."""
    from tribodyn.losses.gearbox import PARTS
    from tribodyn.study.studies.losses import loss_map

    found = loss_map(case, torque=torque, speed=speed, progress=progress)
    figure = pictured(plot.losses, found)
    counted = [words for part, words in PARTS.items() if getattr(found, part).any()]
    told = _ALONE if counted == ["teeth"] else f"Counted are {', '.join(counted)}."
    names = ("pinion_torque", "pinion_speed", *PARTS, "total", "gear_efficiency", "efficiency")
    facts = {name: getattr(found, name).tolist() for name in names}
    return Answer(found, [figure], [f"{_title(figure)}.", told], *_losses(found), facts)


def _losses(found: GearboxLosses) -> tuple[list[str], list[list[str]]]:
    """Efficiency over torque and speed, or all parts where one of them has one value."""
    from tribodyn.losses.gearbox import PARTS
    from tribodyn.units import convert

    torque, speed = found.pinion_torque, found.pinion_speed * convert(1.0, "rad/s", "rpm")
    percent = 100.0 * found.efficiency
    if torque.size > 1 and speed.size > 1:
        head = ["Efficiency [%]: torque of the pinion", *(f"{n:.4g} rpm" for n in speed)]
        rows = [
            [f"{load:.4g} N*m", *(f"{value:.5g}" for value in line)]
            for load, line in zip(torque, percent, strict=True)
        ]
        return head, rows
    parts = {words: getattr(found, part) for part, words in PARTS.items()}
    parts = {words: lost for words, lost in parts.items() if lost.any()} | {"all": found.total}
    head = ["Torque [N*m]", "Speed [rpm]", *(f"{words} [W]" for words in parts), "Efficiency [%]"]
    rows = [
        [
            f"{torque[i]:.4g}",
            f"{speed[j]:.4g}",
            *(f"{lost[i, j]:.4g}" for lost in parts.values()),
            f"{percent[i, j]:.5g}",
        ]
        for i in range(torque.size)
        for j in range(speed.size)
    ]
    return head, rows


def film_answer(
    case: Case, torque: Any = None, speed: Any = None, progress: Progress = SILENT
) -> Answer:
    """Least film, and the regime of lubrication, over torque and speed."""
    import numpy as np

    from tribodyn.study.studies.losses import STEPS
    from tribodyn.study.studies.static import film_over_operation
    from tribodyn.units import convert

    operation = case.operation
    torque = list(STEPS * operation.torque) if torque is None else torque
    speed = list(STEPS * operation.speed) if speed is None else speed
    found = film_over_operation(case, torque=torque, speed=speed, progress=progress)
    drawn = (plot.film_over_operation, plot.lubrication_map)
    figures = [pictured(each, found) for each in drawn if not each.missing(found)]
    known = found.central_film if found.minimum_film is None else found.minimum_film
    least = np.nanmin(np.asarray(known), axis=2)
    rpm = found.pinion_speed * convert(1.0, "rad/s", "rpm")
    head = ["Least film [um]: torque of the pinion", *(f"{n:.4g} rpm" for n in rpm)]
    rows = [
        [f"{load:.4g} N*m", *(f"{film * 1e6:.4g}" for film in line)]
        for load, line in zip(found.pinion_torque, least, strict=True)
    ]
    facts = {
        "pinion_torque": found.pinion_torque.tolist(),
        "pinion_speed": found.pinion_speed.tolist(),
        "least_film": least.tolist(),
    }
    return Answer(found, figures, [f"{_title(figures[0])}."], head, rows, facts)
