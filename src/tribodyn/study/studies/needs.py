"""What each study needs of a case, and the pair of gears of a study about one mesh.

Kinds of cases are refused here alone: messages, help and the table of the documentation follow
from :data:`STUDIES`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from tribodyn.errors import Argument, InputError, did_you_mean
from tribodyn.nomenclature import PAIR_MESH

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase

#: Kinds of cases: pairs of gears, and cases of parts with names.
PAIRS = ("cylindrical pair", "hypoid pair", "mesh table")
PARTS = ("machine", "planetary stage")
KINDS = (*PAIRS, *PARTS)
_CYLINDRICAL, _TOOTHED = PAIRS[:1], PAIRS[:2]


class Need(NamedTuple):
    """What a study needs of a case."""

    what: str
    kinds: tuple[str, ...] = KINDS  #: that have it; of a study about one mesh those of its pair
    why: str = ""  #: reason why the other kinds do not do
    of_mesh: bool = False  #: whether the study is about one mesh, which --mesh names
    most: float = math.inf  #: values of the derivatives of a motion over a period at most


_ANY = Need("a case")
_TEETH = Need("a pair of gears with computed teeth", _TOOTHED, "", True)
_PLANE = Need("a pair of cylindrical gears with computed teeth", _CYLINDRICAL, "", True)
_PAIR = "the case of one pair of gears"
_REXS = "Models of other programs are written of cylindrical gears with computed teeth"
_MOTION = Need("a structure that moves", of_mesh=True)
_DERIVATIVES = (
    "Steps in a period of the clock times the square of the number of positions and velocities are "
    "2e8 at most, for its derivatives"
)
_BRANCH = _MOTION._replace(why=_DERIVATIVES, most=2e8)

#: What the studies need, by the names of their commands.
STUDIES: dict[str, Need] = {
    **dict.fromkeys(("run", "sweep", "ensemble", "sobol", "study", "modes", "run-up"), _ANY),
    "bifurcation": _MOTION,
    "continuation": _BRANCH,
    "basins": _MOTION,
    "lyapunov": _ANY._replace(why=_DERIVATIVES, most=2e8),
    **dict.fromkeys(("harris", "losses", "film"), _TEETH),
    "relief": _PLANE._replace(why="Flanks of hypoid gears are relieved by their cutter"),
    "lead": _PLANE._replace(why="The face of hypoid gears is crowned by their cutter"),
    "experiment": Need(_PAIR, _CYLINDRICAL, "Its claims are about spur gears on their supports"),
    "friction-from-loss": _PLANE._replace(why="Its loss factor is that of plane teeth"),
    "losses --rig": Need(_PAIR, _TOOTHED, "A rig tests the gears of one pair"),
    "surrogate": _ANY,
    "export": Need("a case of cylindrical gears", (*_CYLINDRICAL, *PARTS), _REXS),
    **dict.fromkeys(("recording", "compare"), _ANY),
}


def kind_of(case: AnyCase) -> str:
    """Kind of a case, of :data:`KINDS`."""
    if case.lumped:
        return dict(zip(("spur", "hypoid", "table"), PAIRS, strict=True))[case.gears.kind]
    return case.kind.lower()


def takes(study: str, case: AnyCase) -> bool:
    """Whether a case, or one of its meshes, has what a study needs."""
    kind, need = kind_of(case), STUDIES[study]
    return kind in need.kinds or (need.of_mesh and kind in PARTS)


def require(study: str, case: AnyCase, where: Any = None) -> None:
    """Refuse a case that lacks what a study needs."""
    if takes(study, case):
        return
    kind, need = kind_of(case), STUDIES[study]
    others = [name for name in STUDIES if takes(name, case)]
    remedy = f"Take such a case (tribodyn cases). Studies of a {kind}: {', '.join(others)}"
    why = f"It needs {need.what}. {need.why}" if need.why else f"It needs {need.what}"
    what = f"this is a {kind}, and {study} does not take one"
    raise InputError(what, where or Argument("case"), why, remedy)


def require_short(study: str, steps: int, coordinates: int) -> None:
    """Refuse a motion whose derivatives over a period are too many for a study."""
    need, values = STUDIES[study], steps * (2.0 * coordinates) ** 2
    if values > need.most:
        what = f"{study} would follow {values:.2g} derivatives over each period"
        remedy = (
            "Follow the motions with bifurcation, which needs none, or choose numbers of teeth "
            "whose meshes come back earlier, fewer steps or a model of fewer coordinates"
        )
        raise InputError(what, Argument("case"), need.why, remedy)


class MeshPair(NamedTuple):
    """A mesh of a case: its pair of gears, and the tables of both gears in the case."""

    pair: PairCase
    gears: tuple[str, str]  #: tables of pinion and wheel, such as ``gears.z1``


def mesh_names(case: AnyCase) -> tuple[str, ...]:
    """Names of the meshes with computed teeth; of equal planets the first of each kind."""
    parts: Any = case
    if kind_of(case) in PAIRS:
        return (PAIR_MESH,)
    if planets := _planet_meshes(parts):
        return tuple(planets)
    groups = {parts.tooth_group(name): name for name in reversed(parts.meshes_with_teeth)}
    return tuple(reversed(groups.values()))


def _planet_meshes(parts: Any) -> dict[str, tuple[str, ...]]:
    """Names of the meshes of a lone stage, by the name of their kind; none of other cases."""
    stage = parts.lone_stage
    return {} if stage is None else parts.machine().planets[stage].mesh_names(stage)


def motion_meshes(case: AnyCase) -> tuple[str, ...]:
    """Names of the meshes that a study of motions can follow; of equal planets the first."""
    parts: Any = case
    if kind_of(case) in PAIRS:
        return (PAIR_MESH,)
    return tuple(_planet_meshes(parts)) or tuple(parts.machine().meshes)


def study_meshes(study: str, case: AnyCase) -> tuple[str, ...]:
    """Meshes of a case that have what a study of one mesh needs."""
    parts: Any = case
    if STUDIES[study].what == _MOTION.what:
        return motion_meshes(case)
    names = mesh_names(case)
    if kind_of(case) in PAIRS:
        return names
    pairs: Any = zip(parts.meshes_with_teeth, parts.mesh_pairs(), strict=True)
    unfit = [mesh for mesh, (_, pair, _) in pairs if kind_of(pair) not in STUDIES[study].kinds]
    return tuple(name for name in names if name not in unfit)


def mesh_pair(study: str, case: AnyCase, mesh: str | None = None) -> MeshPair:
    """Pair of gears of the mesh that a study is about, misaligned as its shafts deflect."""
    require(study, case)
    parts: Any = case
    names = mesh_names(case)
    if not names:
        why, remedy = "The stiffness of all meshes is given", "Remove the stiffness of a mesh"
        raise InputError("no mesh has computed teeth", Argument("case"), why, remedy)
    every = (*names, *getattr(parts, "meshes_with_teeth", ()))
    name = _named_mesh(study, mesh, names, every, " with computed teeth")
    if kind_of(case) in PAIRS:
        return MeshPair(parts, ("gears.pinion", "gears.wheel"))
    name = _planet_meshes(parts).get(name, (name,))[0]
    meshes = parts.meshes_with_teeth
    listed = {m: MeshPair(p, g) for m, (_, p, g) in zip(meshes, parts.mesh_pairs(), strict=True)}
    pair, gears = listed[name]
    kind, need = kind_of(pair), STUDIES[study]
    if kind not in need.kinds:
        what, remedy = f"mesh {name} is a {kind}", "Name a mesh of another kind"
        raise InputError(what, Argument("mesh"), f"It needs {need.what}. {need.why}", remedy)
    return MeshPair(_deflected(parts, name, pair), (f"gears.{gears[0]}", f"gears.{gears[1]}"))


def _named_mesh(
    study: str, mesh: str | None, names: Sequence[str], every: Sequence[str], kind: str = ""
) -> str:
    """Mesh that a study is about: the only one of ``names``, or one of ``every`` by its name."""
    listed_names = f"Meshes{kind}: {', '.join(names)}"
    if mesh is None and len(names) > 1:
        remedy = f'Name it: mesh = "{names[0]}", of a command --mesh {names[0]}'
        raise InputError(f"{study} is about one mesh", Argument("mesh"), listed_names, remedy)
    if mesh not in (None, *every):
        remedy = did_you_mean(str(mesh), names, "Name one of these")
        raise InputError(f'there is no mesh "{mesh}"{kind}', Argument("mesh"), listed_names, remedy)
    return mesh or names[0]


def mesh_in_motion(study: str, case: AnyCase, mesh: str | None = None) -> str:
    """Mesh of a case that a study of its motions is about, by its name in the machine."""
    require(study, case)
    parts: Any = case
    names = motion_meshes(case)
    if kind_of(case) in PAIRS:
        return _named_mesh(study, mesh, names, names)
    name = _named_mesh(study, mesh, names, (*names, *parts.machine().meshes))
    return str(_planet_meshes(parts).get(name, (name,))[0])


def _deflected(case: Any, mesh: str, pair: PairCase) -> PairCase:
    """Pair of a mesh with the misalignment by the shafts of its machine."""
    from tribodyn.study.machine.run import balanced_machine

    load = case.operating_point
    balanced = balanced_machine(case, load, rehearsal=True)
    deflected: PairCase = case.pair(mesh, load, balanced.misalignment[mesh])
    return deflected


def help_line(study: str) -> str:
    """What a study that does not take every case needs, for its help."""
    need = STUDIES.get(study, _ANY)
    if need.of_mesh:
        return " Of a machine or a stage: one mesh."
    return "" if need == _ANY else " Takes one pair of gears."
