"""The loaded tooth contact as a labelled data set."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.nomenclature import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from tribodyn.stiffness.loaded.result import LoadedContact


#: Array -> its last dimensions and its quantity in the nomenclature.
_ARRAYS: dict[str, tuple[tuple[str, ...], str]] = {
    "transmission_error": (("phase",), "static_transmission_error"),
    "deflection": (("phase",), "static_transmission_error"),
    "mesh_stiffness_secant": (("phase",), "mesh_stiffness_secant"),
    "mesh_stiffness_tangent": (("phase",), "mesh_stiffness_tangent"),
    "normal_force": (("phase", "pair"), "normal_force"),
    "load_share": (("phase", "pair"), "load_share"),
    "pair_deflection": (("phase", "pair"), "static_transmission_error"),
    "load_per_width": (("phase", "slice", "pair"), "load_per_width"),
}
_PLACES: dict[str, str] = {
    "path": "path",
    "gap": "static_transmission_error",
    "pinion_curvature_radius": "curvature_radius",
    "wheel_curvature_radius": "curvature_radius",
}


def to_xarray(result: LoadedContact) -> xarray.Dataset:
    """Convert a loaded tooth contact to a labelled data set with units."""
    import xarray

    before = ("torque",) * result.torque.ndim
    variables: dict[str, Any] = {
        name: ((*before, *dimensions), getattr(result, name), _describe(quantity))
        for name, (dimensions, quantity) in _ARRAYS.items()
    }
    for name, quantity in _PLACES.items():
        variables[name] = (("phase", "pair"), getattr(result, name), _describe(quantity))
    coordinates: dict[str, Any] = {
        "phase": ("phase", result.phase, _describe("mesh_phase")),
        "pair": ("pair", result.number),
        "torque": (before, result.torque, _describe("torque")),
    }
    made = {"provider": result.provider, "reference": result.reference}
    return xarray.Dataset(variables, coordinates, made)


def _describe(quantity: str) -> dict[str, str]:
    found = QUANTITIES[quantity]
    return {"units": found.unit or "1", "long_name": found.meaning}
