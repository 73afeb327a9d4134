"""Pages of public names, which load each name when it is first used."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

from tribodyn.aliases import names_of_stub, old_module
from tribodyn.arguments.reading import guarded

#: Page and public names of each module that has some.
_public: dict[str, list[tuple[str, str]]] = {}


class _Guarding(MetaPathFinder):
    """Lets a module check the arguments of its public classes from when it is loaded on."""

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Find the module as usual; None where it has no public names."""
        spec = PathFinder.find_spec(name, path, target) if name in _public else None
        if spec is None or spec.loader is None:
            return None
        execute = spec.loader.exec_module

        def exec_module(module: ModuleType) -> None:
            execute(module)
            for page, each in _public[name]:
                if isinstance(vars(module).get(each), type):
                    guarded(vars(module)[each], page)

        spec.loader.exec_module = exec_module  # type: ignore[method-assign]
        return spec


def _part(page: str, name: str) -> ModuleType | None:
    """Module of a package, which is there without an import of its own too."""
    if name.startswith("_") or find_spec(f"{page}.{name}") is None:
        return None
    return import_module(f"{page}.{name}")


def public_page(
    page: str, file: str
) -> tuple[list[str], Callable[[str], object], Callable[[], list[str]]]:
    """Names of a page by its stub, each loaded and checking its arguments when it is first used.

    Parameters
    ----------
    page : str
        Name of the page.
    file : str
        Its path.

    Returns
    -------
    tuple
        Its ``__all__``, ``__getattr__`` and ``__dir__``.
    """
    homes, old = names_of_stub(file), old_module(page)
    names = sorted(homes)
    if not _public:
        sys.meta_path.insert(0, _Guarding())
    for name, module in homes.items():
        _public.setdefault(module, []).append((page, name))

    def find(name: str) -> object:
        if name not in homes:
            return _part(page, name) or old(name)
        value = guarded(getattr(import_module(homes[name]), name), page)
        setattr(sys.modules[page], name, value)
        return value

    for name in sorted(homes.keys() & {path.stem for path in Path(file).parent.glob("*.py")}):
        find(name)  # or the page would show the module under this name
    return names, find, lambda: sorted({*vars(sys.modules[page]), *names})
