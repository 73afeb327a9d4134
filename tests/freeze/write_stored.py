"""Write files that later states must still read: ``python tests/freeze/write_stored.py FOLDER``.

``stored.zip`` holds them as the state that was frozen wrote them. It is not written anew: files of
a new format are added to it, in an archive of their own.
"""

from __future__ import annotations

import contextlib
import io
import sys
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import tribodyn as td
from tribodyn.cli import call
from tribodyn.gear import FlankModification, ProfileMap
from tribodyn.mesh import MeshTable, build

#: What a stored folder of a command is made with: command, words after it, values that are set.
COMMANDS: dict[str, tuple[str, tuple[str, ...], tuple[str, ...]]] = {
    "result": ("run", (), ()),
    "transient": (
        "run",
        (),
        ("solver.method=transient", "solver.cycles=2", "dynamics.model=torsional"),
    ),
    "sweep": ("sweep", ("operation.speed=2000,2100 rpm",), ()),
    "bifurcation": (
        "bifurcation",
        ("operation.speed=2000..2100 rpm:2", "--cycles", "4", "--transient", "10"),
        (),
    ),
}

#: A pair that is soon computed: uniform stiffness, few steps.
COARSE = (
    "stiffness.model=rectangular",
    "stiffness.pair_stiffness=2e8 N/m",
    "operation.speed=2000 rpm",
    "solver.steps_per_mesh_cycle=64",
)


def write_cases(folder: Path) -> None:
    """Write each built-in case as a case file."""
    folder.mkdir()
    for name in td.cases():
        (folder / f"{name}.toml").write_text(td.load_case(name).to_toml(), "utf-8")


def write_results(folder: Path) -> None:
    """Run the commands; what is large and read by nothing more is left out."""
    for name, (command, arguments, settings) in COMMANDS.items():
        changed_keys = {setting.partition("=")[0]: setting for setting in (*COARSE, *settings)}
        options = [argument for setting in changed_keys.values() for argument in ("--set", setting)]
        place = folder / name
        with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
            warnings.simplefilter("ignore", td.ModelWarning)
            assert call([command, "fzg-roughness", *arguments, *options, "--out", str(place)]) == 0
        for report in place.glob("*.html"):
            report.unlink()
    (folder / "transient" / "mesh.nc").unlink()


def write_meshes(folder: Path) -> None:
    """Write mesh tables of gears that a short result does not have."""
    folder.mkdir()
    for name, make in MESHES.items():
        make().save(folder / f"{name}.nc")


def measured_flank() -> MeshTable:
    """Pair whose wheel has a map of its flank."""
    chart = ProfileMap((0.0, 0.01, 0.03), (0.0,), ((0.0,), (2e-6,), (5e-6,)))
    return _mesh(
        wheel=FlankModification(profile_map=chart),
        stiffness_model="rectangular",
        stiffness_options={"pair_stiffness": 2e8},
    )


def force_law() -> MeshTable:
    """Pair with tip relief: teeth and film in series, contact before A, the whole force law."""
    return _mesh(
        pinion=FlankModification(tip_relief=12e-6, tip_relief_length=4e-3),
        stiffness_model="analytic",
        stiffness_options={"extended_contact": True},
        film_model="moes",
        film_options={"stiffness": "tangent"},
        force_law=True,
    )


#: Mesh tables by the names of their files.
MESHES = {"measured-flank": measured_flank, "force-law": force_law}


def _mesh(
    pinion: FlankModification | None = None, wheel: FlankModification | None = None, **models: Any
) -> MeshTable:
    case = td.load_case("fzg-roughness")
    pair = case.gear_pair
    pair = replace(
        pair,
        pinion=replace(pair.pinion, modification=pinion or FlankModification()),
        wheel=replace(pair.wheel, modification=wheel or FlankModification()),
    )
    return build(
        pair,
        material=case.material_properties,
        lubricant=case.lubricant_properties,
        friction_law="constant",
        friction_options={"coefficient": 0.05},
        composite_roughness=0.5e-6,
        pinion_speed=94.0,
        pinion_torque=90.0,
        steps=64,
        **models,
    )


if __name__ == "__main__":
    target = Path(sys.argv[1])
    target.mkdir()
    write_cases(target / "cases")
    write_results(target)
    write_meshes(target / "meshes")
