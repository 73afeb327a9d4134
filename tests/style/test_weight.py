"""The weight of the package, which only grows with what is new to a user."""

from __future__ import annotations

import weight
from source_tree import modules, read


def test_no_package_is_heavier_than_it_was() -> None:
    lines, files, untyped = weight.measures(modules())
    heavy = weight.overweight(lines, weight.LINES)
    assert not heavy, "\n".join(heavy)
    assert files <= weight.FILES
    assert untyped <= weight.ANY


def test_code_is_counted_without_docstrings_and_comments() -> None:
    text = '"""Page."""\n\n# note\nfrom typing import Any\n\n\ndef f(x: Any) -> Any:\n'
    module = read(text + '    """One.\n\n    Two.\n    """\n    return (\n        x\n    )\n')
    assert weight.lines_of_code(module) == 5
    assert weight.measures([module])[2] == 2
    assert weight.overweight({"gear": 5}, {"gear": 4})
    assert not weight.overweight({"gear": 5}, {"gear": 5})


def test_no_modules_import_each_other() -> None:
    circles = weight.import_circles(modules())
    assert not circles, "\n".join(", ".join(sorted(circle)) for circle in circles)


def test_a_circle_of_imports_is_found() -> None:
    first = read("from tribodyn.b import x\n", "src/tribodyn/a.py")
    second = read("def f():\n    from tribodyn.a import y\n", "src/tribodyn/b.py")
    assert weight.import_circles([first, second]) == [{"tribodyn.a", "tribodyn.b"}]
    assert not weight.import_circles([first, read("import math\n", "src/tribodyn/b.py")])
