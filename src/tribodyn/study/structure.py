"""The sections ``[stiffness]``, ``[friction]``, ``[dynamics]`` and ``[solver]`` of a case."""

from __future__ import annotations

from tribodyn.study.fields import choice, flag, integer, number, numbers
from tribodyn.study.section import Section

_GUARD = "guards against a wrong unit"
_TWO_PI = 6.283185307179586


def _stiffness_models() -> list[str]:
    from tribodyn.stiffness import MODELS

    return MODELS.names()


def _friction_laws() -> list[str]:
    from tribodyn.friction import LAWS

    return LAWS.names()


def _shear_models() -> list[str]:
    from tribodyn.ehl.traction.shear_models import SHEAR_MODELS

    return list(SHEAR_MODELS)


class Stiffness(Section):
    """The ``[stiffness]`` table: a model and its options; None where the model does not use one."""

    model: str = choice(
        "fe2d", _stiffness_models, meaning="tooth stiffness model"
    )  # fmt: skip
    reference: str | None = choice(
        None, ("bore", "rim"), meaning="body against which deflection is measured"
    )
    extended_contact: bool | None = flag(
        None, meaning="let tip corners of bent teeth touch before A and after E"
    )
    pair_stiffness: float | None = number(None, 1e3, 1e13, _GUARD, of="pair_stiffness")
    single_pair_stiffness: float | None = number(
        None, 1e3, 1e13, _GUARD, of="pair_stiffness", meaning="stiffness with one pair in contact"
    )
    double_pair_stiffness: float | None = number(
        None, 1e3, 1e13, _GUARD, of="mesh_stiffness", meaning="stiffness with two pairs in contact"
    )
    mean_stiffness: float | None = number(
        None, 1e3, 1e13, _GUARD, of="mesh_stiffness", meaning="mean of the mesh stiffness"
    )
    cosine: tuple[float, ...] | None = numbers(
        -1e13,
        1e13,
        _GUARD,
        of="mesh_stiffness",
        meaning="cosine amplitudes of harmonics 1, 2..",
    )
    sine: tuple[float, ...] | None = numbers(
        -1e13, 1e13, _GUARD, of="mesh_stiffness", meaning="sine amplitudes of harmonics 1, 2.."
    )
    phase: tuple[float, ...] | None = numbers(
        0.0, 1.0, "one mesh cycle", of="mesh_phase", meaning="mesh phases of the table"
    )
    roll_angle: tuple[float, ...] | None = numbers(
        0.0, _TWO_PI, "less than one turn", of="roll_angle", meaning="roll angles of the table"
    )
    values: tuple[float, ...] | None = numbers(
        0.0, 1e13, _GUARD, of="mesh_stiffness", meaning="stiffness values of the table"
    )


class Friction(Section):
    """The ``[friction]`` table: a law and its options; None where the law does not use one."""

    law: str = choice(
        "none",
        _friction_laws,
        later=("exponential", "schlenk", "mixed-ehl", "measured"),
        meaning="friction law of the tooth contact",
    )
    coefficient: float | None = number(
        None, 0.0, 1.0, "lubricated steel lies below 0.2", of="friction_coefficient"
    )
    variant: str | None = choice(
        None, ("benedict-kelly", "he-singh"), meaning="published form of the Benedict-Kelly law"
    )
    rolling_speed: str | None = choice(
        None, ("mean", "sum"), meaning="rolling speed of the Benedict-Kelly law: half sum or sum"
    )
    minimum_sliding_speed: float | None = number(
        None, 1e-9, 10.0, _GUARD, of="sliding_speed", meaning="floor that keeps the law finite"
    )
    shear_model: str | None = choice(
        None, _shear_models, meaning="how the oil film shears under the solved pressure"
    )
    eyring_stress: float | None = number(
        None, 1e5, 1e8, "oils lie between 2 and 10 MPa", of="eyring_stress"
    )
    inlet_heating: bool | None = flag(
        None, meaning="thin the film by the heat that shear makes in the inlet"
    )
    flash_temperature: bool | None = flag(
        None, meaning="take the viscosity at the mean temperature of the film"
    )
    rolling: bool | None = flag(None, meaning="add the rolling traction to the sliding one")


class Dynamics(Section):
    """The ``[dynamics]`` table: the vibrating structure."""

    model: str = choice(
        "spur-6dof",
        ("spur-6dof", "torsional", "fzg-12dof"),
        later=("hypoid-14dof",),
        meaning="structure that vibrates",
    )
    mesh_law: str | None = choice(
        None,
        ("stiffness", "tangent", "force-law"),
        meaning="k(t) times deflection, linearized about the load, or the whole force law",
    )
    friction_load: str = choice(
        "nominal",
        ("nominal", "dynamic"),
        meaning="load that friction coefficients and load shares belong to",
    )
    bearing_stiffness: float | None = number(None, 1e3, 1e13, _GUARD, of="bearing_stiffness")
    bearing_damping: float | None = number(None, 0.0, 1e9, _GUARD, of="bearing_damping")
    bearing_damping_ratio: float = number(
        0.02, 0.0, 2.0, "supports lie between 0.01 and 0.1",
        meaning="damping of each gear on its bearing over its critical value",
    )  # fmt: skip
    shaft1_stiffness: float | None = number(
        None, 1.0, 1e12, _GUARD, of="shaft_stiffness",
        meaning="torsional stiffness of shaft 1, between its disc and the wheel",
    )  # fmt: skip
    shaft1_damping: float | None = number(
        None, 0.0, 1e6, _GUARD, of="shaft_damping", meaning="torsional damping of shaft 1"
    )
    shaft1_moment_of_inertia: float | None = number(
        None, 1e-14, 1e7, _GUARD, of="moment_of_inertia",
        meaning="polar moment of inertia of the disc of shaft 1",
    )  # fmt: skip
    shaft1_mass: float | None = number(
        None, 1e-7, 1e6, _GUARD, of="mass", meaning="mass of the disc of shaft 1"
    )
    shaft2_stiffness: float | None = number(
        None, 1.0, 1e12, _GUARD, of="shaft_stiffness",
        meaning="torsional stiffness of shaft 2, between its disc and the pinion",
    )  # fmt: skip
    shaft2_damping: float | None = number(
        None, 0.0, 1e6, _GUARD, of="shaft_damping", meaning="torsional damping of shaft 2"
    )
    shaft2_moment_of_inertia: float | None = number(
        None, 1e-14, 1e7, _GUARD, of="moment_of_inertia",
        meaning="polar moment of inertia of the disc of shaft 2",
    )  # fmt: skip
    shaft2_mass: float | None = number(
        None, 1e-7, 1e6, _GUARD, of="mass", meaning="mass of the disc of shaft 2"
    )
    mesh_damping: float | None = number(None, 0.0, 1e9, _GUARD, of="mesh_damping")
    mesh_damping_ratio: float = number(
        0.04, 0.0, 2.0, "meshes lie between 0.03 and 0.17", of="mesh_damping_ratio"
    )
    damping_in_gap: bool = flag(False, meaning="keep the mesh damping while the flanks are apart")
    backlash: float | None = number(None, 0.0, 0.01, _GUARD, of="backlash")
    transmission_error_amplitude: float = number(
        0.0, 0.0, 1e-3, _GUARD, of="transmission_error",
        meaning="amplitude of the static transmission error at mesh frequency",
    )  # fmt: skip
    transmission_error_phase: float = number(
        0.0, -_TWO_PI, _TWO_PI, "one turn", of="angle",
        meaning="phase of the static transmission error where a pair enters contact",
    )  # fmt: skip


class Solver(Section):
    """The ``[solver]`` table."""

    method: str = choice(
        "steady", ("steady", "transient"),
        meaning="periodic motion, or motion from the static equilibrium",
    )  # fmt: skip
    steps_per_mesh_cycle: int | None = integer(
        None, 64, 262144, "fewer do not resolve the mesh, more only cost time", example="1024",
        meaning="integration steps per mesh cycle",
    )  # fmt: skip
    cycles: int | None = integer(
        None,
        1,
        100000,
        "more only cost time",
        example="50",
        meaning="mesh cycles of a transient run",
    )
