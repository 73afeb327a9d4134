"""Motion of a result as labelled series with units and meanings, for figures and files."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.mesh.functions import WRENCH
from tribodyn.mesh.gears import SPATIAL_COORDINATES
from tribodyn.nomenclature import GEARS
from tribodyn.record import Parts, labels_of
from tribodyn.study.case.to_models import mesh_law_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import FineSamples, Response, System
    from tribodyn.study.pipeline.computed import Computed


#: Distance from an event that separates its two sides [mesh cycles].
_SIDE = 1e-11
#: Coordinates of structures with shafts across and along the line of action.
_LETTERS = {"x": "v", "y": "w"}


def is_steady(response: Response) -> bool:
    """Whether a response is a periodic orbit, not a transient."""
    return response.floquet_multipliers.size > 0


def centre_column(names: Sequence[str], gear: str, axis: str) -> int | None:
    """Return the column of a coordinate of a gear's centre, or None if there is none."""
    candidates = [f"{gear}_{letter}" for letter in (axis, _LETTERS.get(axis, axis))]
    return next((column for column, name in enumerate(names) if name in candidates), None)


def measured(response: Response) -> FineSamples:
    """Return the samples from which the figures of a summary are computed."""
    fine = response.fine
    if is_steady(response):
        return replace(fine, weight=fine.weight / fine.weight.sum())
    first = response.periods // 2
    skipped = fine.phase.size * first // response.periods
    part = replace(fine, **{f.name: getattr(fine, f.name)[skipped:] for f in fields(fine)})
    return replace(part, phase=part.phase - first, weight=part.weight / part.weight.sum())


def one_sided_phase(samples: FineSamples) -> Array:
    """Phase of each sample, moved slightly into its step so that events have two sides."""
    steps = samples.phase.reshape(-1, 3) + np.array([_SIDE, 0.0, -_SIDE])
    return np.asarray(steps.reshape(-1))


def mesh_force(samples: FineSamples) -> Array:
    """Force of the mesh: the sum over the ramps of its force law, damping included."""
    force = samples.contact_force
    return force[:, 0] if force.shape[1] == 1 else np.asarray(force.sum(axis=1))


def compression(samples: FineSamples) -> Array:
    """Compression of the mesh, which all ramps of its force law share."""
    return samples.deflection[:, 0]


def first_touch(system: System, samples: FineSamples) -> Array:
    """Compression at which the driving flanks touch; its negative is that of the back flanks."""
    gap = system.contacts[0].gap
    values = gap(one_sided_phase(samples)) if callable(gap) else gap
    return np.broadcast_to(np.asarray(values, dtype=float), samples.phase.shape)


def transmission_error(result: Computed, samples: FineSamples) -> Array:
    """Dynamic transmission error, counted from where perfect rigid driving flanks touch."""
    error = compression(samples) + result.static_error(samples.phase)
    return np.asarray(error - result.half_backlash - film_offset(result))


def film_offset(result: Computed) -> float:
    """Distance before the flanks touch from which the compression of the mesh is counted.

    A force law and its tangent count from where the first oil film in series carries; a plain
    stiffness from where its mean deflection is zero.
    """
    mesh = result.mesh
    if mesh.film_offset == 0.0 or mesh_law_of(result.case) != "stiffness":
        return mesh.film_offset
    deflection = mesh.total_normal_force / mesh.mesh_stiffness
    return float(mesh.grid.mean(deflection - mesh.transmission_error_at_rest))


def tooth_force(result: Computed, phase: Array, force: Array) -> Array | None:
    """Force of the teeth with friction in the axes of the first gear; None in a plane."""
    functions = result.mesh.functions()
    if functions.direction is None or result.mesh.direction.shape[-1] != len(SPATIAL_COORDINATES):
        return None
    rows = functions.direction(phase)
    law = result.friction
    if law is not None and law.wrench is not None:
        rubs = [law.value(name, phase, force) for name in WRENCH[:3]]
        return np.asarray((rows[:, :3] + np.stack(rubs, axis=-1)) * force[:, None])
    if functions.friction is not None:
        rows = rows + functions.friction(phase)
    return np.asarray(rows[:, :3] * force[:, None])


def support_force(system: System, samples: FineSamples, number: int) -> Array:
    """Force of the bodies on the support of a coordinate, from springs and dampers together."""
    return np.asarray(support_forces(system, samples, [number])[0])


def support_forces(system: System, samples: FineSamples, numbers: Sequence[int]) -> Array:
    """Forces of the bodies on the supports of several coordinates, a row for each."""
    springs, dampers = (
        np.asarray(matrix)[numbers] for matrix in (system.stiffness, system.damping)
    )
    return np.asarray(springs @ samples.position.T + dampers @ samples.velocity.T)


#: Largest size of the series of a motion in a file [bytes].
LARGEST = 64_000_000
#: Highest mesh harmonic that is stored.
_HIGHEST = 80
_IN_PLANE = {"loa": ("y", "along the line of action"), "oloa": ("x", "across it")}
_ALONG_AXES = {**_IN_PLANE, "axial": ("z", "along the axes")}
_IN_SPACE = {
    "x": ("x", "along the common perpendicular of the axes"),
    "y": ("y", "along its own axis"),
    "z": ("z", "across both"),
}


def directions_of(names: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Directions in the names of figures, each with its coordinate and its description."""
    if f"{GEARS[0]}_z" not in names:
        return _IN_PLANE
    return _ALONG_AXES if f"{GEARS[0]}_theta_y" in names else _IN_SPACE


_STATES = {
    "position": ("m", "rad", "displacement"),
    "velocity": ("m/s", "rad/s", "velocity"),
    "acceleration": ("m/s^2", "rad/s^2", "acceleration"),
}


def _attributes_of(unit: str, meaning: str) -> dict[str, str]:
    return {"units": unit, "long_name": meaning}


def _sided(samples: Any) -> Array:
    """Phase of samples; fine samples are on their side of an event."""
    fine = hasattr(samples, "weight")
    return one_sided_phase(samples) if fine else np.asarray(samples.phase)


def friction_forces(result: Computed, samples: Any) -> dict[str, tuple[Array, str, str]]:
    """Friction force of all pairs, and its parts from films and asperities if split."""
    from tribodyn.mesh.functions import ASPERITIES

    force, phase, law = mesh_force(samples), _sided(samples), result.friction
    if law is None:
        channels: Any = result.mesh.functions()
        rubbing = channels.friction_sum(phase) * force
        split = result.mesh.asperity_friction_coefficient is not None
        metal = result.mesh.at(ASPERITIES, phase) * force if split else None
    else:
        rubbing = law.value("friction_sum", phase, force) * force
        metal = law.value(ASPERITIES, phase, force) * force if law.splits else None
    forces = {"friction_force": (rubbing, "N", "friction force of all tooth pairs")}
    if metal is not None:
        forces["film_friction_force"] = (
            rubbing - metal,
            "N",
            "part of it that the oil films cause",
        )
        forces["asperity_friction_force"] = (metal, "N", "part of it that the asperities cause")
    return forces


def signals(result: Computed, samples: Any) -> dict[str, tuple[Array, str, str]]:
    """Signals of figures on the samples: values, unit and meaning by name."""
    force, phase = mesh_force(samples), _sided(samples)
    static = result.transmission_error_at_rest(phase)
    series = {
        "mesh_force": (force, "N", "force along the line of action of all tooth pairs"),
        "dynamic_transmission_error": (
            transmission_error(result, samples),
            "m",
            "lag of the driven gear on the line of action, from first contact of the flanks",
        ),
        "static_transmission_error": (static, "m", "the same at rest under the nominal load"),
        **friction_forces(result, samples),
    }
    if (in_space := tooth_force(result, phase, force)) is not None:
        for axis, values in zip("xyz", in_space.T, strict=True):
            first, second = GEARS
            meaning = f"force of the teeth on the {second} along the {axis} axis of the {first}"
            series[f"mesh_force_{axis}"] = (values, "N", meaning)
    for gear in GEARS:
        for direction, (axis, direction_text) in directions_of(result.response.names).items():
            column = centre_column(result.response.names, gear, axis)
            if column is not None:
                meaning = f"force of the {gear} on its bearing {direction_text}"
                force = support_force(result.system, samples, column)
                series[f"bearing_force_{direction}_{gear}"] = (force, "N", meaning)
                meaning = f"acceleration of the {gear}'s centre {direction_text}"
                signal = samples.acceleration[:, column]
                series[f"acceleration_{direction}_{gear}"] = (signal, "m/s^2", meaning)
    return series


def parts_of(result: Computed, summary: dict[str, float]) -> Parts:
    """Variables, coordinates and attributes of the data set of a result."""
    response = result.response
    turns = np.array(["theta" in name for name in response.names])
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {
        "time": ("time", response.time, _attributes_of("s", "time")),
        "phase": ("time", response.phase, _attributes_of("1", "mesh phase")),
        "coordinate": ("coordinate", list(response.names)),
    }
    for name, (straight, turning, meaning) in _STATES.items():
        attributes = {
            "long_name": f"{meaning} of every coordinate, in the unit named by {name}_unit"
        }
        variables[name] = (("time", "coordinate"), getattr(response, name), attributes)
        coordinates[f"{name}_unit"] = ("coordinate", np.where(turns, turning, straight))
    pressed, force = _contacts(response)
    variables["deflection"] = (
        ("time", "contact"),
        pressed,
        _attributes_of(
            "m",
            "compression of every contact, counted from the middle of the play: its flanks touch "
            "at the attribute half_backlash",
        ),
    )
    variables["contact_force"] = (
        ("time", "contact"),
        force,
        _attributes_of("N", "force of every contact"),
    )
    for name, (values, unit, meaning) in signals(result, response).items():
        if not name.startswith("acceleration_"):  # the variable acceleration holds them
            variables[name] = ("time", values, _attributes_of(unit, meaning))
    if is_steady(response):
        variables |= _spectra(result)
        coordinates["order"] = (
            "order",
            variables.pop("order"),
            _attributes_of("1", "mesh harmonic"),
        )
    variables |= _ends(result)
    return Parts(variables, coordinates, _facts(result, summary))


def _contacts(response: Response) -> tuple[Array, Array]:
    """Compression and force of the contacts; ramps of one force law are one contact."""
    pressed, force = response.deflection, response.contact_force
    if np.ptp(pressed, axis=1).max(initial=0.0) > 0.0:
        return pressed, force
    return pressed[:, :1], force.sum(axis=1, keepdims=True)


def _spectra(result: Computed) -> dict[str, Any]:
    """Amplitudes of the mesh harmonics of every signal."""
    from tribodyn.analysis import amplitude_spectrum

    response = result.response
    highest = min(_HIGHEST, response.time.size // response.periods // 8)
    spectra: dict[str, Any] = {}
    for name, (values, unit, meaning) in signals(result, response.fine).items():
        if name == "static_transmission_error":
            continue
        spectrum = amplitude_spectrum(response, values, highest=highest)
        attributes = _attributes_of(unit, f"peak amplitude of the harmonics: {meaning}")
        spectra[f"{name}_spectrum"] = ("order", spectrum.amplitude, attributes)
        spectra["order"] = spectrum.order
        spectra["frequency"] = (
            "order",
            spectrum.frequency,
            _attributes_of("Hz", "frequency of a harmonic"),
        )
    return spectra


def _ends(result: Computed) -> dict[str, Any]:
    """Values from which a motion is rebuilt, in addition to its states at the steps."""
    response, friction = result.response, result.friction
    variables: dict[str, Any] = {
        f"end_{name}": (
            "coordinate",
            getattr(response.fine, name)[-1],
            {"long_name": f"{name} at the end of the record"},
        )
        for name in ("position", "velocity")
    }
    multipliers = response.floquet_multipliers
    if response.extra_force.size:
        attributes = {"long_name": "force or torque that balances the friction [N or N*m]"}
        variables["extra_force"] = ("coordinate", response.extra_force, attributes)
    if multipliers.size:
        components = np.stack((multipliers.real, multipliers.imag))
        attributes = _attributes_of("1", "Floquet multipliers: real and imaginary part")
        variables["floquet_multipliers"] = (("part", "multiplier"), components, attributes)
    if friction is not None:
        attributes = {"long_name": "friction over powers of the load: force [1], moments [m]"}
        dims = ("knot", "power", "channel")
        variables["friction_coefficients"] = (dims, friction.coefficients, attributes)
        if friction.wrench is not None:
            attributes = {"long_name": "friction over coordinates, over powers of the load [1, m]"}
            dims = ("knot", "power", "coordinate_of_gears")
            variables["friction_wrench_coefficients"] = (dims, friction.wrench, attributes)
        if friction.couple is not None:
            attributes = {"long_name": "tilting moment of friction over powers of the load [m]"}
            variables["friction_couple_coefficients"] = (dims[:2], friction.couple, attributes)
    if (coupling := result.coupling) is not None:
        attributes = _attributes_of(
            "1", "change of each quantity from one pass of the coupling to the next"
        )
        variables |= {
            f"coupling_{field.name}": ("pass", getattr(coupling, field.name), attributes)
            for field in fields(coupling)
            if field.name.endswith("_change")
        }
        attributes = _attributes_of(
            "1", "force of all pairs over that of the torque alone, by phase of the mesh"
        )
        variables["coupling_loading"] = ("knot", coupling.loading, attributes)
    if (heat := result.heat) is not None:
        labels = labels_of(type(heat))
        variables |= {
            f"heat_{name}": (
                "heat_pass",
                getattr(heat, name),
                _attributes_of(label.unit or "", "heat balance, pass by pass"),
            )
            for name, label in labels.items()
            if label.dims and getattr(heat, name) is not None
        }
    return variables


def _facts(result: Computed, summary: dict[str, float]) -> dict[str, Any]:
    response = result.response
    facts: dict[str, Any] = {
        "mesh_frequency": response.mesh_frequency,
        "periods": response.periods,
        "steady_state_error": response.error,
        "omega_max_dt": response.step_number,
        "title": result.case.title,
        "half_backlash": result.half_backlash,
        "warnings": json.dumps([[warning.code, warning.message] for warning in result.warnings]),
        **{
            name: int(getattr(response, name))
            for name in ("converged", "cycles_used", "search_cycles", "period")
        },
    }
    if result.friction is not None:
        names = ("load", "limit", "fit_error")
        facts |= {f"friction_{name}": getattr(result.friction, name) for name in names}
    if result.coupling is not None:
        facts |= {
            f"coupling_{name}": getattr(result.coupling, name) for name in ("kind", "tolerance")
        }
    if result.heat is not None:
        values = {
            name: getattr(result.heat, name)
            for name, label in labels_of(type(result.heat)).items()
            if not label.dims
        }
        facts |= {f"heat_{name}": value for name, value in values.items() if value is not None}
    facts["case"] = hashlib.sha256(result.case.to_toml().encode()).hexdigest()
    facts["figures"] = len(summary)
    return {**facts, **summary}


def _stored_cycles(response: Response) -> int:
    """Number of last mesh cycles whose series stay below ``LARGEST``, at least one."""
    columns = 3 * len(response.names) + 2 * _contacts(response)[0].shape[1] + 10
    cycle = 8 * columns * response.time.size // response.periods
    return int(min(response.periods, max(1, LARGEST // cycle)))


def stored(parts: Parts, response: Response) -> Parts:
    """Return the parts of a result that are saved: of a long run, the last mesh cycles."""
    periods, cycles = int(response.periods), _stored_cycles(response)
    first = response.time.size // periods * (periods - cycles)

    def last(named: dict[str, Any]) -> dict[str, Any]:
        return {
            name: (
                dims,
                values[first:] if np.atleast_1d(dims)[0] == "time" else values,
                *attributes,
            )
            for name, (dims, values, *attributes) in named.items()
        }

    facts = {**parts.attributes, "periods": cycles, "computed_mesh_cycles": periods}
    return Parts(last(parts.variables), last(parts.coordinates), facts)


def describe_stored_cycles(response: Response) -> str:
    """Describe which mesh cycles of the motion the file contains."""
    computed, stored_count = int(response.periods), _stored_cycles(response)
    if stored_count == computed:
        return f"all {computed} mesh cycles" if computed > 1 else "the complete mesh cycle"
    return (
        f"the last {stored_count} of {computed} mesh cycles, which are {LARGEST / 1e6:g} MB; the "
        "figures of the summary are those of the complete run"
    )


def to_csv(parts: Parts) -> str:
    """Write the time series as comma-separated values in SI, units in the first line."""
    import io

    heads, columns = [], []
    axes = parts.coordinates
    for name, (dims, values, attributes) in {"time": axes["time"], **parts.variables}.items():
        if np.atleast_1d(dims)[0] != "time":
            continue
        rows = values.reshape(len(values), -1)
        for number, column in enumerate(rows.T):
            unit, label = attributes.get("units", ""), name
            if "coordinate" in dims:
                label = f"{name}_{axes['coordinate'][1][number]}"
                unit = str(axes[f"{name}_unit"][1][number])
            elif rows.shape[1] > 1:
                label = f"{name}_{number}"
            heads.append(f"{label} [{unit}]")
            columns.append(column)
    text = io.StringIO()
    np.savetxt(text, np.column_stack(columns), "%.9g", ",", header=",".join(heads), comments="")
    return text.getvalue()
