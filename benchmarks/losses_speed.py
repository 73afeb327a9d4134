"""What a loss map of 8 x 8 points and the coupled fixed point of one operating point cost.

The rival of the map is a loop over the same points with ``tribodyn.run``, as one would write it
without a map: it finds the steady motion of each besides. The rival of the fixed point at rest is
Anderson's method of SciPy, to the same tolerance; that of the one in motion is
the run without coupling, which is solved once and not in every pass.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from race import Goal, Runner, arguments, machine, print_goals, print_table, race
from tribodyn import load_case, loss_map, run
from tribodyn.errors import ModelWarning
from tribodyn.mesh.build import loaded_mesh
from tribodyn.study.coupling import balanced_load
from tribodyn.study.mesh_inputs import contact_settings
from tribodyn.study.pipeline.tooth_contact import mesh_of

_BOX = {
    "losses.pinion.bearing": "NJ 406", "losses.wheel.bearing": "NJ 406",
    "losses.pinion.seal_diameter": "30 mm", "losses.wheel.immersion": "30 mm",
    "losses.oil_volume": "1.2 l",
}  # fmt: skip


def main(words: Sequence[str] | None = None) -> None:
    """Print the time of the map and of the fixed point over that of their rivals."""
    quick = arguments(__doc__, words).quick
    rounds, count = (1, 2) if quick else (5, 8)
    print(machine())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        times = race(_map(count), rounds) | race(_coupling(), rounds)
    pairs = (("loss map", "loop of runs"), ("static", "SciPy"), ("dynamic", "plain run"))
    rows = [
        (own, f"{times[own].median:.3g}", f"{min(times[own].wall):.3g}", rival,
         f"{times[own].faster_than(times[rival]):.3g}")
        for own, rival in pairs
    ]  # fmt: skip
    head = ("what", "CPU s", "wall s, best", "rival", "x rival")
    print_table((f"{head[0]} ({count} x {count} points)", *head[1:]), rows)
    if not quick:
        goals = [Goal(f"coupled fixed point, {kind}", 1.0, min(times[kind].wall), "s",
                      at_least=False) for kind in ("static", "dynamic")]  # fmt: skip
        print_goals(goals)


def _map(count: int) -> dict[str, Runner]:
    case = load_case("fzg-roughness").replace({"friction.law": "mixed", **_BOX})
    torques, speeds = np.linspace(50.0, 300.0, count), np.linspace(40.0, 300.0, count)

    def one_by_one() -> float:
        corners = [(t, s) for t in torques[[0, -1]] for s in speeds[[0, -1]]]
        for torque, speed in corners:
            run(case.replace({"operation.torque": torque, "operation.speed": speed})).summary()
        return len(corners) / count**2

    def whole() -> float:
        loss_map(case, torque=list(torques), speed=list(speeds))
        return 1.0

    return {"loss map": whole, "loop of runs": one_by_one}


def _coupling() -> dict[str, Runner]:
    case = load_case("fzg-roughness").replace(
        {"film.stiffness": "tangent", "friction.law": "mixed"}
    )
    settings = contact_settings(case)

    def coupled(kind: str) -> float:
        run(case.replace({"solver.coupling": kind}))
        return 1.0

    def answer(over: np.ndarray) -> np.ndarray:
        mesh = loaded_mesh(
            case.gear_pair, settings, (case.pinion_speed, case.pinion_torque), loading=over
        ).table(settings)
        return balanced_load(case, mesh) - over

    def anderson() -> float:
        from scipy.optimize import anderson as find

        find(answer, np.ones(mesh_of(case).phase.size), f_tol=case.solver.coupling_tolerance)
        run(case)
        return 1.0

    return {
        "static": lambda: coupled("static"), "SciPy": anderson,
        "dynamic": lambda: coupled("dynamic"), "plain run": lambda: coupled("none"),
    }  # fmt: skip


if __name__ == "__main__":
    main()
