"""Things picked by name, with third parties let in through entry points."""

from importlib import metadata

import pytest

from tribodyn import model as module
from tribodyn.errors import InputError
from tribodyn.model import Registry


class Entry:
    """An entry point without an installed package."""

    def __init__(self, name: str, value: str) -> None:
        self.name = name
        self.value = value
        self.loads = 0

    def load(self) -> str:
        self.loads += 1
        return self.value


def filled() -> Registry[str]:
    laws: Registry[str] = Registry("friction law")
    laws.register("constant")("c")
    laws.register("xu-2007")("x")
    return laws


def test_names_keep_the_order_of_registration() -> None:
    laws = filled()
    assert laws.names() == ["constant", "xu-2007"]
    assert list(laws) == laws.names()
    assert "constant" in laws
    assert "else" not in laws
    assert laws["xu-2007"] == "x"


def test_register_returns_the_decorated_object() -> None:
    def law() -> None: ...

    assert Registry("law").register("a")(law) is law


def test_misspelt_name_names_the_nearest() -> None:
    with pytest.raises(InputError) as caught:
        filled()["xu-2070"]
    message = str(caught.value)
    assert 'no friction law is called "xu-2070"' in message
    assert "Known: constant, xu-2007" in message
    assert 'Did you mean "xu-2007"?' in message


def test_entry_points_extend_but_never_replace(monkeypatch: pytest.MonkeyPatch) -> None:
    entries = [Entry("mine", "third party"), Entry("constant", "impostor")]
    names_loaded = []

    def entry_points(group: str) -> list[Entry]:
        names_loaded.append(group)
        return entries

    monkeypatch.setattr(module, "entry_points", entry_points)
    laws: Registry[str] = Registry("friction law", "tribodyn.friction")
    laws.register("constant")("own")
    assert laws["mine"] == "third party"
    assert laws["constant"] == "own"
    assert laws.names() == ["constant", "mine"]
    assert names_loaded == ["tribodyn.friction"]


def test_without_a_group_nothing_is_searched(monkeypatch: pytest.MonkeyPatch) -> None:
    def entry_points(group: str) -> list[Entry]:
        raise AssertionError("searched")

    monkeypatch.setattr(module, "entry_points", entry_points)
    assert Registry("law").names() == []


def test_installed_packages_are_searched_once(monkeypatch: pytest.MonkeyPatch) -> None:
    every = metadata.EntryPoints(
        metadata.EntryPoint(name, f"math:{name}", group)
        for name, group in (("pi", "tribodyn.one"), ("tau", "tribodyn.other"))
    )
    searches = iter([every])
    monkeypatch.setattr(metadata, "entry_points", lambda: next(searches))
    module.entry_points.cache_clear()
    names = [Registry[float]("number", f"tribodyn.{end}").names() for end in ("one", "other")]
    module.entry_points.cache_clear()
    assert names == [["pi"], ["tau"]]
