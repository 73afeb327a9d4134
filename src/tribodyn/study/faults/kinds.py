"""Kinds of faults by the part that has them: their keys, and the cases that have them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple


class Kind(NamedTuple):
    """A kind of fault, and its keys besides that of the part."""

    part: str  #: what has it: gear, shaft or bearing
    model: str  #: its class in :mod:`tribodyn.faults`
    meaning: str
    required: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    either: tuple[str, ...] = ()  #: keys among the optional of which one is stated


_BEARING = ("rolling_elements", "element_diameter", "pitch_diameter")
#: Kinds of all cases.
KINDS: dict[str, Kind] = {
    "eccentricity": Kind(
        "gear", "Waviness", "offset of the axis of the toothing from the axis of rotation",
        ("amplitude",), ("phase",),
    ),
    "waviness": Kind(
        "gear", "Waviness", "waves that run on from tooth to tooth, a ghost order",
        ("amplitude", "order"), ("phase", "lead_angle"),
    ),
    "misalignment": Kind(
        "gear", "InclinedFlanks",
        "flanks inclined over the face, constant or turning with the shaft",
        ("amplitude",), ("order", "phase"),
    ),
    "pitch-deviations": Kind(
        "gear", "PitchDeviations", "pitch deviations drawn from an accuracy class",
        ("accuracy_class",), ("seed",),
    ),
    "flank-deviations": Kind(
        "gear", "FlankDeviations", "slopes of profile and helix that differ from tooth to tooth",
        (), ("profile_slopes", "helix_slopes", "accuracy_class", "seed"),
    ),
    "flank-topographies": Kind(
        "gear", "FlankTopographies", "measured flanks or profiles of several teeth",
        ("file",), ("other_teeth", "interpolation"),
    ),
    "spall": Kind(
        "gear", "Spall", "material missing on a part of one flank",
        ("tooth", "depth", "start", "end"), ("face_share",),
    ),
    "broken-tooth": Kind(
        "gear", "BrokenTooth", "a tooth whose upper part is gone", ("tooth",), ("remaining",)
    ),
    "crack": Kind(
        "gear", "Crack", "a crack at the root of one tooth", ("tooth", "depth"),
        ("angle", "root_tangent", "face_share", "face_length", "face_position"),
    ),
    "bearing-defect": Kind(
        "bearing", "BearingDefect", "a local defect of a bearing of the gear's shaft",
        ("place", *_BEARING, "acceleration", "resonance"),
        ("contact_angle", "damping_ratio", "slip"),
    ),
    "torque-ripple": Kind(
        "shaft", "TorqueRipple", "a torque on the gear's shaft that varies over its angle",
        ("orders", "torques"), ("phases",),
    ),
    "speed-fluctuation": Kind(
        "shaft", "SpeedFluctuation", "a speed of the gear's shaft that varies over its angle",
        ("orders", "fluctuations"), ("phases",),
    ),
    "random-load": Kind(
        "shaft", "RandomLoad", "a random torque on the gear's shaft",
        ("frequencies",), ("torque", "densities", "duration", "seed"), ("torque", "densities"),
    ),
    "looseness": Kind(
        "bearing", "", "a seat that is softer while the shaft lifts from it",
        ("stiffness_share",), ("press_angle",),
    ),
}  # fmt: skip
#: Kinds whose keys are others where the parts of a case have names.
_OF_PARTS = {
    "bearing-defect": KINDS["bearing-defect"]._replace(
        model="BearingForce",
        required=("place", "impact_force"),
        optional=(*_BEARING, "contact_angle", "impact_duration", "slip"),
    )
}
#: Kinds that a gear with a constant stiffness has too.
WAVES = ("eccentricity", "waviness")
#: Why a kind of case does not have a kind of fault.
LACKS: dict[str, dict[str, str]] = {
    "pair": {"looseness": "The supports of a pair have no seats, which bearings of a machine have"},
    "machine": {},
}


def kinds_in(case: str) -> Mapping[str, Kind]:
    """Kinds of faults of a ``"pair"`` or a ``"machine"``."""
    changed = {} if case == "pair" else _OF_PARTS
    return {name: kind for name, kind in {**KINDS, **changed}.items() if name not in LACKS[case]}


def keys_in(case: str, name: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Keys of a kind of fault, first that of the part: required, and optional ones."""
    kind = kinds_in(case)[name]
    part = "gear" if case == "pair" else kind.part
    which = ("planet",) if case == "machine" and kind.part == "gear" else ()
    return (part, *kind.required), (*kind.optional, *which)
