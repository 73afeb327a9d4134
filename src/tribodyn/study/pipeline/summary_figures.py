"""Unit, meaning and topic of every figure of a summary, of a pair or of the parts of a machine."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from tribodyn.study.pipeline.summary import MEASURES, SUMMARY, SummaryFigure, summary_entry
from tribodyn.study.pipeline.summary_labels import split_key

#: Figures of each kind of part: key, quantity that gives the unit (empty: a pure number), meaning.
#: Others have the definition of a pair.
_KINDS: dict[str, dict[str, tuple[str, str]]] = {
    "machine": {
        "clock_frequency": ("frequency", "periods of the whole motion per second"),
        "friction_power": (
            "power",
            "power that the friction of all computed teeth at rest takes from the input power",
        ),
        "output_torque": (
            "torque",
            "torque of the output shaft, less the friction of computed teeth; without friction "
            "before teeth are computed",
        ),
    },
    "meshes": {
        "alternating_rms_mesh_force": (
            "mesh_force",
            "root mean square of the dynamic force, its mean left out; of a stage that of the "
            "planet with the greatest",
        ),
        "rms_mesh_force": (
            "mesh_force",
            "deprecated name of alternating_rms_mesh_force; unlike the rms_mesh_force of a pair "
            "it leaves the mean out",
        ),
        "transmission_error_peak_to_peak": (
            "dynamic_transmission_error",
            "rotation of one gear against the other on the line of action, greatest less least",
        ),
        "static_transmission_error_peak_to_peak": (
            "static_transmission_error",
            "of the computed teeth at rest under the load",
        ),
        "offset_error": ("deflection", "V: growth of the offset, by deflected shafts"),
        "pinion_axial_error": ("deflection", "H: pinion away from its mounting distance, likewise"),
        "wheel_axial_error": ("deflection", "J: wheel away from its mounting distance, likewise"),
        "shaft_angle_error": ("angle", "alpha: growth of the shaft angle, likewise"),
        "axial_force": ("mesh_force", "mean force along x on the first gear, against the second"),
        "contact_ratio": ("", "mean number of tooth pairs that carry load at rest"),
        "friction_power": (
            "power",
            "power that the friction of the teeth at rest takes from what reaches the mesh",
        ),
        "minimum_film_thickness": (
            "film_thickness",
            "least film of the computed teeth, central where the model has no minimum film",
        ),
    },
    "planets": {
        "ratio": ("", "speed of the input over that of the output"),
        "rolling_power": ("power", "power that the meshes transmit relative to the carrier"),
        "planet_speed": ("speed", "speed of a planet about its pin"),
        "load_factor": ("", "K_gamma at rest: greatest load of a planet over the mean"),
        "dynamic_load_factor": ("", "K_gamma in motion: of the mean loads over a mesh cycle"),
        "planets_unloaded": ("", "number of planets without load at rest"),
        "mean_pin_force": ("bearing_force", "greatest mean force of a planet on its pin"),
        "peak_pin_force": ("bearing_force", "greatest force of a planet on its pin"),
        "centrifugal_force": ("bearing_force", "part of the pin force by the turning carrier"),
        "sun_orbit": ("deflection", "root mean square of the radial motion of the sun"),
    },
    "shafts": {
        "speed": ("speed", "speed of the shaft, negative where it turns against x"),
        "torque": ("torque", "torque that it transmits, less the friction of teeth before it"),
        "power": ("power", "power that it transmits, less the friction of teeth before it"),
        "largest_deflection": ("deflection", "greatest radial displacement at rest"),
    },
    "bearings": {
        "mean_radial_force": ("bearing_force", "size of the mean radial force"),
        "mean_axial_force": ("bearing_force", "mean force along the shaft"),
        "rms_radial_force": ("bearing_force", "root mean square of the alternating radial force"),
        "peak_radial_force": ("bearing_force", "greatest radial force"),
        "radial_stiffness": ("bearing_stiffness", "mean of y and z at the working load"),
        "maximum_pressure": ("hertz_pressure", "greatest pressure on a raceway"),
    },
    "housing": {
        "rms_acceleration": (
            "acceleration",
            "root mean square of the acceleration, all directions",
        ),
        "peak_acceleration": ("acceleration", "greatest acceleration"),
    },
}
#: Figures of parts that are those of a pair.
_OF_PAIRS = {
    "machine": ("input_power", "efficiency"),
    "meshes": (
        *("mesh_frequency", "static_mesh_force", "mean_mesh_force", "peak_mesh_force"),
        *("minimum_mesh_force", "dynamic_factor_peak", "contact_loss_share", "face_load_factor"),
        *("mean_mesh_stiffness", "misalignment", "overlap_ratio", "mean_friction_coefficient"),
        "maximum_hertz_pressure",
    ),
}
_TOPICS = {
    "machine": "Machine",
    "meshes": "Mesh {0}",
    "planets": "Planetary stage {0}",
    "shafts": "Shaft {0}",
    "bearings": "Bearing {0}",
    "housing": "Housing at {0}",
}
#: Figures that fit on a screen, by kind of part; those of third parties are always among them.
_CHIEF = {
    "": (
        *("static_mesh_force", "line_load", "input_power", "mesh_frequency", "oil_temperature"),
        *("mean_mesh_force", "rms_mesh_force", "peak_mesh_force", "dynamic_factor_peak"),
        *("contact_loss_share", "rms_dynamic_transmission_error", "mean_friction_coefficient"),
        *("peak_to_peak_dynamic_transmission_error", "mean_friction_power", "efficiency"),
        *("total_power_loss", "total_efficiency", "mesh_natural_frequency", "resonance_speed"),
        *("contact_ratio_under_load", "face_load_factor", "mean_mesh_stiffness"),
        *("peak_to_peak_static_transmission_error", "maximum_hertz_pressure", "central_film"),
        *("minimum_film_over_path", "minimum_film_ratio", "rms_bearing_force_loa_pinion"),
        *("rms_bearing_force_oloa_pinion", "steady_state_error", "transverse_contact_ratio"),
        *("overlap_ratio", "backlash"),
    ),
    "machine": ("input_power", "friction_power", "efficiency", "output_torque"),
    "meshes": (
        *("mesh_frequency", "mean_mesh_force", "alternating_rms_mesh_force", "peak_mesh_force"),
        *("dynamic_factor_peak", "contact_loss_share", "transmission_error_peak_to_peak"),
        *("face_load_factor", "maximum_hertz_pressure", "minimum_film_thickness"),
        "friction_power",
    ),
    "planets": (
        *("ratio", "planet_speed", "load_factor", "dynamic_load_factor", "planets_unloaded"),
        *("mean_pin_force", "peak_pin_force"),
    ),
    "shafts": ("speed", "torque", "power", "largest_deflection"),
    "bearings": (
        *("mean_radial_force", "mean_axial_force", "rms_radial_force", "maximum_pressure"),
    ),
    "housing": tuple(_KINDS["housing"]),
}
#: Those by which load cases are compared.
_OF_LOADS = ("output_torque", "efficiency", "peak_mesh_force")


def is_chief(key: str) -> bool:
    """Whether a figure belongs to the summary that fits on a screen."""
    load, kind, _, name = split_key(key)
    return name in (_OF_LOADS if load else _CHIEF[kind]) or name in MEASURES.names()


def figure_of(key: str) -> SummaryFigure:
    """Unit, meaning and topic of a key of a summary; a KeyError if there is no such figure."""
    if key in SUMMARY:
        return SUMMARY[key]
    load, kind, part, name = split_key(key)
    topic = (f"{load}: " if load else "") + _TOPICS[kind].format(part)
    if name in _OF_PAIRS.get(kind, ()):
        return replace(SUMMARY[name], name=key, topic=topic)
    return summary_entry(key, *_KINDS[kind][name], topic)


def part_figures() -> dict[str, list[str]]:
    """Names of the figures of each kind of part."""
    return {kind: [*figures, *_OF_PAIRS.get(kind, ())] for kind, figures in _KINDS.items()}


def is_figure(key: str) -> bool:
    """Whether a key is one of a summary."""
    try:
        return bool(figure_of(key))
    except KeyError:
        return False


def in_order(names: Iterable[str], first: Collection[str] = SUMMARY) -> list[str]:
    """Names of figures, each once, in the order of those of a pair; others as they come."""
    names = dict.fromkeys(names)
    return [name for name in first if name in names] + [n for n in names if n not in first]


def by_topic(names: Iterable[str]) -> dict[str, list[str]]:
    """Names of figures under their topics."""
    topics: dict[str, list[str]] = {}
    for name in in_order(names):
        topics.setdefault(figure_of(name).topic, []).append(name)
    return topics


def summary_rows(values: Mapping[str, float]) -> list[tuple[str, str, str, str]]:
    """Topic, name, value with unit and meaning of each figure, by topic."""
    return [
        (topic, name, figure_of(name).show(values[name]), figure_of(name).meaning)
        for topic, names in by_topic(values).items()
        for name in names
    ]
