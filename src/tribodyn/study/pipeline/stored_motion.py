"""Motion of a pair as a labelled data set, what is stored of it, and the motion from a file."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError
from tribodyn.record import Parts, Record, labels_of
from tribodyn.study.coupling import Coupling
from tribodyn.study.heat_balance import HeatBalance
from tribodyn.study.pipeline.response_series import is_steady, signals
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    import xarray

    from tribodyn.dynamics import Response, System
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.pipeline.result import PairResult

#: Largest size of the series of a motion in a file [bytes].
LARGEST = 64_000_000
#: Highest mesh harmonic that is stored.
_HIGHEST = 80
#: Before the names of the motion with the friction of the nominal load.
NOMINAL = "nominal_friction_"
_STATES = {
    "position": ("m", "rad", "displacement"),
    "velocity": ("m/s", "rad/s", "velocity"),
    "acceleration": ("m/s^2", "rad/s^2", "acceleration"),
}


def _attributes_of(unit: str, meaning: str) -> dict[str, str]:
    return {"units": unit, "long_name": meaning}


def parts_of(result: PairResult) -> Parts:
    """Variables, coordinates and attributes of the data set of a result."""
    response = result.response
    turns = np.array(["theta" in name for name in response.names])
    variables: Tree = {}
    coordinates: Tree = {
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
    text = "compression of every contact, counted from the middle of the play: its flanks touch at "
    attributes = _attributes_of("m", f"{text}the attribute half_backlash")
    variables["deflection"] = (("time", "contact"), pressed, attributes)
    attributes = _attributes_of("N", "force of every contact")
    variables["contact_force"] = (("time", "contact"), force, attributes)
    for name, (values, unit, meaning) in signals(result, response).items():
        if not name.startswith("acceleration_"):  # the variable acceleration holds them
            variables[name] = ("time", values, _attributes_of(unit, meaning))
    if is_steady(response):
        variables |= _spectra(result)
        attributes = _attributes_of("1", "mesh harmonic")
        coordinates["order"] = ("order", variables.pop("order"), attributes)
    facts = {"title": result.case.title, "half_backlash": result.half_backlash}
    additions = [(_ends(response), _facts(response))]
    if result.friction is not None:
        additions.append(_of_friction(result.friction))
    passes = {prefix: getattr(result, prefix) for prefix in _PASSES}
    additions += [of_passes(k, each) for k, each in passes.items() if each is not None]
    for its_variables, its_facts in additions:
        variables |= its_variables
        facts |= its_facts
    return Parts(variables, coordinates, {**facts, **result.summary()})


def _contacts(response: Response) -> tuple[Array, Array]:
    """Compression and force of the contacts; ramps of one force law are one contact."""
    pressed, force = response.deflection, response.contact_force
    if np.ptp(pressed, axis=1).max(initial=0.0) > 0.0:
        return pressed, force
    return pressed[:, :1], force.sum(axis=1, keepdims=True)


def _spectra(result: PairResult) -> Tree:
    """Amplitudes of the mesh harmonics of every signal."""
    from tribodyn.analysis import amplitude_spectrum

    response = result.response
    highest = min(_HIGHEST, response.time.size // response.periods // 8)
    spectra: Tree = {}
    for name, (values, unit, meaning) in signals(result, response.fine).items():
        if name == "static_transmission_error":
            continue
        spectrum = amplitude_spectrum(response, values, highest=highest)
        attributes = _attributes_of(unit, f"peak amplitude of the harmonics: {meaning}")
        spectra[f"{name}_spectrum"] = ("order", spectrum.amplitude, attributes)
        spectra["order"] = spectrum.order
        attributes = _attributes_of("Hz", "frequency of a harmonic")
        spectra["frequency"] = ("order", spectrum.frequency, attributes)
    return spectra


def _ends(response: Response, prefix: str = "") -> Tree:
    """Values from which a motion is rebuilt, in addition to its states at the steps."""
    variables: Tree = {
        f"{prefix}end_{name}": (
            "coordinate",
            getattr(response.fine, name)[-1],
            {"long_name": f"{name} at the end of the record"},
        )
        for name in ("position", "velocity")
    }
    multipliers = response.floquet_multipliers
    if response.extra_force.size:
        attributes = {"long_name": "force or torque that balances the friction [N or N*m]"}
        variables[f"{prefix}extra_force"] = ("coordinate", response.extra_force, attributes)
    if multipliers.size:
        components = np.stack((multipliers.real, multipliers.imag))
        attributes = _attributes_of("1", "Floquet multipliers: real and imaginary part")
        dims = ("part", "multiplier")
        variables[f"{prefix}floquet_multipliers"] = (dims, components, attributes)
    return variables


#: Fields of a response that are numbers or texts, with the type and the name in a file.
_NUMBERS: dict[str, tuple[type, str]] = {
    "mesh_frequency": (float, "mesh_frequency"),
    "periods": (int, "periods"),
    "error": (float, "steady_state_error"),
    "step_error": (float, "step_error"),
    "engine": (str, "engine"),
    "reason": (str, "engine_reason"),
    "step_number": (float, "omega_max_dt"),
    **{name: (int, name) for name in ("converged", "cycles_used", "search_cycles", "period")},
}


def _facts(response: Response, prefix: str = "") -> Tree:
    """Numbers of a response."""
    return {f"{prefix}{k}": kind(getattr(response, n)) for n, (kind, k) in _NUMBERS.items()}


#: Coefficients of the friction over the load: name in a file, further dimension, meaning.
_FRICTION = {
    "coefficients": (
        *("friction_coefficients", ("channel",)),
        "friction over powers of the load: force [1], moments [m]",
    ),
    "wrench": (
        *("friction_wrench_coefficients", ("coordinate_of_gears",)),
        "friction over coordinates, over powers of the load [1, m]",
    ),
    "couple": (
        *("friction_couple_coefficients", ()),
        "tilting moment of friction over powers of the load [m]",
    ),
}
_OF_FIT = ("load", "limit", "fit_error")


def _of_friction(friction: MeshFriction) -> tuple[Tree, Tree]:
    """Variables and facts of the friction over the load."""
    variables = {
        key: (("knot", "power", *dims), values, {"long_name": text})
        for name, (key, dims, text) in _FRICTION.items()
        if (values := getattr(friction, name)) is not None
    }
    return variables, {f"friction_{name}": getattr(friction, name) for name in _OF_FIT}


#: Passes of an iteration: their class, the dimension in the data set, and the meaning.
_PASSES: dict[str, tuple[type[Any], str, str]] = {
    "coupling": (Coupling, "pass", "coupling of load, film, friction and stiffness, pass by pass"),
    "heat": (HeatBalance, "heat_pass", "heat balance, pass by pass"),
}


def of_passes(prefix: str, passes: Record) -> tuple[Tree, Tree]:
    """Variables and facts of the passes of an iteration."""
    kind, dimension, meaning = _PASSES[prefix]
    variables, facts = {}, {}
    for name, labels in labels_of(kind).items():
        if (value := getattr(passes, name)) is None:
            continue
        if labels.dims:
            dim = dimension if labels.dims == ("iteration",) else labels.dims[0]
            variables[f"{prefix}_{name}"] = (
                dim,
                value,
                _attributes_of(labels.unit or "1", meaning),
            )
        else:
            facts[f"{prefix}_{name}"] = value
    return variables, facts


def _stored_cycles(response: Response) -> int:
    """Number of last mesh cycles whose series stay below ``LARGEST``, at least one."""
    columns = 3 * len(response.names) + 2 * _contacts(response)[0].shape[1] + 10
    cycle = 8 * columns * response.time.size // response.periods
    return int(min(response.periods, max(1, LARGEST // cycle)))


def stored(result: PairResult) -> Parts:
    """Return the parts of a result that are saved: of a long run, the last mesh cycles."""
    parts, response, nominal = result._parts(), result.response, result.nominal_friction_response
    periods, cycles = int(response.periods), _stored_cycles(response)
    first = response.time.size // periods * (periods - cycles)

    def last(named: Tree) -> Tree:
        return {
            name: (
                dims,
                values[first:] if np.atleast_1d(dims)[0] == "time" else values,
                *attributes,
            )
            for name, (dims, values, *attributes) in named.items()
        }

    variables, facts = last(parts.variables), {**parts.attributes, "periods": cycles}
    facts["computed_mesh_cycles"] = periods
    if nominal is not None:
        steps = nominal.time.size // nominal.periods
        begin = nominal.time.size - steps * min(cycles, nominal.periods)
        for name in ("position", "velocity"):
            text = {"long_name": f"{name} with the friction of the nominal load"}
            dims = (f"{NOMINAL}time", "coordinate")
            variables[NOMINAL + name] = (dims, getattr(nominal, name)[begin:], text)
        variables[f"{NOMINAL}time"] = (f"{NOMINAL}time", nominal.time[begin:], {"units": "s"})
        variables |= _ends(nominal, NOMINAL)
        facts |= _facts(nominal, NOMINAL)
        facts[f"{NOMINAL}periods"] = min(cycles, nominal.periods)
    return Parts(variables, last(parts.coordinates), facts)


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


def read_friction(mesh: MeshTable, data: xarray.Dataset) -> MeshFriction | None:
    """Friction over the load of a data set, if it has any."""
    from tribodyn.mesh import MeshFriction

    if "friction_coefficients" not in data:
        return None
    values: Tree = {
        **{n: data[key].values for n, (key, *_) in _FRICTION.items() if key in data},
        **{name: float(data.attrs[f"friction_{name}"]) for name in _OF_FIT},
    }
    return MeshFriction(mesh.grid, **values)


def read_passes(prefix: str, mesh: MeshTable | None, data: xarray.Dataset) -> Any:
    """Passes of an iteration of a data set, if it has any."""
    kind, dimension, _ = _PASSES[prefix]
    if dimension not in data.sizes:
        return None
    # An earlier version stored no axes.
    axes = {"iteration": np.arange(1.0, data.sizes[dimension] + 1.0)}
    axes |= {"phase": mesh.phase} if mesh is not None else {}
    keys = {name: f"{prefix}_{name}" for name in labels_of(kind)}
    values = {n: data[key].values if key in data else axes.get(n) for n, key in keys.items()}
    facts = {name: data.attrs[key] for name, key in keys.items() if key in data.attrs}
    return kind(**{name: value for name, value in values.items() if value is not None} | facts)


def read_response(system: System, data: xarray.Dataset, prefix: str = "") -> Response:
    """Motion from its states at the steps, with forces as the structure has them."""
    from tribodyn.dynamics.equations.compiled import compile_for
    from tribodyn.dynamics.time.response import build_response, later

    facts = {
        name: kind(data.attrs[prefix + key])
        for name, (kind, key) in _NUMBERS.items()
        if prefix + key in data.attrs
    }
    names, rows = tuple(data["coordinate"].values), data.sizes[f"{prefix}time"]
    frequency, periods = facts.pop("mesh_frequency"), facts.pop("periods")
    number = facts.pop("step_number", None)
    if names != tuple(system.names) or rows % periods:
        why = f"Its motion has {', '.join(names)}, its case {', '.join(system.names)}"
        raise InputError("these files are of different results", "", why, "")
    states = [
        np.hstack([data[f"{prefix}{end}{name}"].values for name in ("position", "velocity")])
        for end in ("", "end_")
    ]
    extra = data.get(f"{prefix}extra_force")
    if (multipliers := data.get(f"{prefix}floquet_multipliers")) is not None:
        real, imaginary = multipliers.values
        facts["floquet_multipliers"] = real + 1j * imaginary
    response = build_response(
        compile_for(system, frequency, rows // periods),
        frequency,
        np.vstack(states),
        np.zeros(system.size) if extra is None else extra.values,
        **{"step_error": float("nan"), **facts, "converged": bool(facts["converged"])},
    )
    if number is not None:
        response = replace(response, step_number=number)
    return later(response, float(data[f"{prefix}time"].values[0]))
