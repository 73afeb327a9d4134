"""Write a case as a REXS 1.4 model, together with the complete case as an attribute."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn import units
from tribodyn.errors import InputError, OutputExistsError
from tribodyn.exchange.case_tree import ModelTree, tree_of
from tribodyn.exchange.gearbox import GearboxModel
from tribodyn.exchange.rexs_file import model_of
from tribodyn.exchange.to_case import oil_values, pair_values, same_value
from tribodyn.exchange.to_machine import file_tables
from tribodyn.files import atomic_write
from tribodyn.study.case.checks import DEFAULT_MARK
from tribodyn.study.case.provenance import provenance
from tribodyn.study.case.section import flat_keys
from tribodyn.study.machine.housing_files import copy_housing

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase

_WRITERS = {".rexs": ModelTree.as_xml, ".rexsj": ModelTree.as_json, ".rexsz": ModelTree.as_zip}


def write_rexs(case: AnyCase, path: str | PathLike[str], *, force: bool = False) -> tuple[str, ...]:
    """Write a case as a REXS 1.4 model: a pair of gears, or a machine with its planetary stages.

    Parameters
    ----------
    case : Case
        Case of cylindrical gears.
    path : path
        File to write: ``.rexs`` is XML, ``.rexsj`` JSON, ``.rexsz`` XML in a zip. The files of a
        housing are copied next to it.
    force : bool
        Replace a file.

    Returns
    -------
    tuple of str
        Keys of the case, or whole tables, that another program does not find in the model.

    Raises
    ------
    InputError
        If the case has gears that are not cylindrical, planets of two gears or a mesh without
        teeth, the suffix is unknown, or a file exists.

    Data without a counterpart in REXS (models, structure, flank forms) are stored in an attribute
    of the gear unit, ``custom_tribodyn_case``, from which the case is restored without loss.
    Source: rexs.info, model of REXS 1.4.
    """
    target = Path(path)
    writer = _WRITERS.get(target.suffix.lower())
    if writer is None:
        why = "The suffix determines the format of the model"
        remedy = f"Use a suffix of {', '.join(_WRITERS)}"
        raise InputError(f'the name ends in "{target.suffix}"', str(path), why, remedy)
    tree = tree_of(case.with_files(prefix := f"{target.stem}-"))
    copies = case.with_files(prefix).housing_files.values()
    for file in (target, *(target.parent / name for name in copies)):
        if file.exists() and (file.is_dir() or not force):
            raise OutputExistsError("this exists already", str(file), "", "Choose another name")
    omitted = _omitted(case, tree)
    with atomic_write(target) as place:
        place.write_bytes(writer(tree))
    copy_housing(case, target.parent, prefix)
    return omitted


def _omitted(case: AnyCase, tree: ModelTree) -> tuple[str, ...]:
    """Keys whose stated values the model lacks without the stored case, or their tables."""
    model = GearboxModel(model_of(tree.model, "the model"))
    if not case.lumped:
        written = dict(flat_keys(file_tables(model, model.load(), {})[0]))
        written |= oil_values(model, model.load())[0]
    else:
        written = pair_values(model, model.stage(), model.load())[0]
    origins, unmodelled = provenance(case), ("title", "origin")
    stated = {
        key: value
        for key, value in case.values()
        if value is not None
        and key not in unmodelled
        and origins.get(key, DEFAULT_MARK) != DEFAULT_MARK
    }
    same = {key for key, value in stated.items() if same_value(_si(key, value), written.get(key))}
    expressed = {key.partition(".")[0] for key in same}
    names = (key if (top := key.partition(".")[0]) in expressed else top for key in stated
             if key not in same)  # fmt: skip
    return tuple(dict.fromkeys(names))


def _si(key: str, value: object) -> Any:
    """Value of a key in SI where it is a list of texts, or a percentage."""
    if isinstance(value, tuple | list):
        return [_si(key, item) for item in value]
    unit = {"sections": "m", "share": ""}.get(key.rpartition(".")[2])
    return units.parse(value, unit) if isinstance(value, str) and unit is not None else value
