"""The built-in cases. The module itself can be called: ``tribodyn.cases()`` lists them."""

from __future__ import annotations

import sys
from types import ModuleType

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)


class _Catalogue(ModuleType):
    """A module that lists the cases when called, since both go by the same name."""

    def __call__(self, *, machines: bool = False) -> dict[str, str]:
        """Names and one-line descriptions of all named cases."""
        from tribodyn.cases.catalogue import cases

        return cases(machines=machines)


sys.modules[__name__].__class__ = _Catalogue
