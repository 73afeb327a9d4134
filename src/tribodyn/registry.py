"""Small registries: laws and methods picked by name, open to third parties."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterator
from importlib.metadata import entry_points
from typing import Generic, TypeVar

from tribodyn.errors import InputError, Problem

__all__ = ["Registry"]

T = TypeVar("T")


class Registry(Generic[T]):
    """Named things of one kind, extended by the entry-point group of the same name.

    Parameters
    ----------
    kind : str
        What the things are, for messages: ``"friction law"``.
    group : str, optional
        Entry-point group that third parties use, for example ``"tribodyn.friction"``.

    Examples
    --------
    >>> laws = Registry("law")
    >>> @laws.register("twice")
    ... def twice(x):
    ...     return 2 * x
    >>> laws["twice"](3)
    6
    """

    def __init__(self, kind: str, group: str | None = None) -> None:
        self.kind = kind
        self.group = group
        self._items: dict[str, T] = {}
        self._searched = group is None

    def register(self, name: str) -> Callable[[T], T]:
        """Decorate a thing to make it known as ``name``.

        Parameters
        ----------
        name : str
            What the user writes.

        Returns
        -------
        callable
            Decorator that returns the thing unchanged.
        """

        def keep(item: T) -> T:
            self._items[name] = item
            return item

        return keep

    def _search(self) -> None:
        if not self._searched and self.group is not None:
            self._searched = True
            for entry in entry_points(group=self.group):
                self._items.setdefault(entry.name, entry.load())

    def names(self) -> list[str]:
        """All names, in order of registration.

        Returns
        -------
        list of str
        """
        self._search()
        return list(self._items)

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names."""
        return iter(self.names())

    def __contains__(self, name: object) -> bool:
        """Tell whether ``name`` is known."""
        return name in self.names()

    def __getitem__(self, name: str) -> T:
        """Return the thing called ``name`` or raise :class:`InputError` naming the nearest."""
        self._search()
        if name in self._items:
            return self._items[name]
        near = difflib.get_close_matches(name, self._items, n=1)
        raise InputError(
            Problem(
                what=f'no {self.kind} is called "{name}"',
                why=f"Known: {', '.join(self._items)}",
                remedy=f'Did you mean "{near[0]}"?' if near else "",
            )
        )
