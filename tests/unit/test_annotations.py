"""Annotations as checks of values, those that have a name among them."""

from __future__ import annotations

import types
from collections.abc import Mapping
from fractions import Fraction
from typing import Any, TypeVar

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from tribodyn.arguments.annotations import wanted
from tribodyn.arguments.reading import checked
from tribodyn.errors import InputError
from tribodyn.types import Array, ByName


class _Alias:
    """Named annotation as NumPy has it from 2.5 on, where Python has type aliases."""

    def __init__(self, value: object) -> None:
        self.__value__ = value


def test_named_annotations_are_checked_as_what_they_stand_for() -> None:
    item = TypeVar("item", bound=np.generic)
    shape, kind = tuple[int, ...], np.dtype[item]
    arrays = types.GenericAlias(_Alias(np.ndarray[shape, kind]), (np.float64,))
    for alias, hint in ((_Alias(float), float), (_Alias(_Alias(int)), int), (arrays, Array)):
        assert wanted(alias, 1)[:1] == wanted(hint, 1)[:1]
        assert wanted(alias, 1)[2:] == wanted(hint, 1)[2:]
    # ArrayLike is one name or a union; a class beside None takes no numbers in either.
    assert not wanted(Fraction | None, 2).fits()(3.0)
    assert wanted(ArrayLike | None, 2).fits()(3.0)
    with pytest.raises(TypeError):
        wanted(NDArray[np.float64], 2).read("text")


def _law(options: ByName) -> Any:
    """Friction.

    Parameters
    ----------
    options : dict
        Of the law.
    """
    return options


def _named_law(options: ByName) -> Any:
    return options


def _plain_law(options: Mapping[str, Any]) -> Any:
    return options


def test_options_of_any_name_have_units_of_their_own() -> None:
    import pint

    _named_law.__doc__ = _plain_law.__doc__ = _law.__doc__
    height = pint.UnitRegistry().Quantity(1.0, "um")
    for law in (_law, _named_law, _plain_law):
        with pytest.raises(InputError, match="Wanted: a value without a unit"):
            checked(law)({"height": height})
        assert checked(law)({"height": 1e-6}) == {"height": 1e-6}
