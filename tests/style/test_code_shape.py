"""The shape of the code: sizes, public names, imports, errors. Each check is shown to fail."""

import statistics
from collections.abc import Callable

import code_checks
import pytest
from source_tree import Module, modules, read

CHECKS = [getattr(code_checks, name) for name in code_checks.__all__]

BAD = {
    "long_file": "x = 1\n" * 501,
    "constants_bound_twice": "_SHARE, _LEAST = 0.5, 2\n_SHARE = 0.7\n",
    "long_functions": "def f():\n" + "    x = 1\n" * 60,
    "star_imports": "from math import *\n",
    "broad_errors": "try:\n    x = 1\nexcept:\n    raise\n",
    "left_overs": "x = 1  # TO" + "DO: later\n",
    "prints": "def f():\n    print(1)\n",
    "exports": '__all__ = ["f"]\n\n\ndef f():\n    return 1\n',
    "top_level_imports": "import scipy.optimize\n",
}


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_code_shape(check: Callable[[Module], list[str]]) -> None:
    complaints = [complaint for module in modules() for complaint in check(module)]
    assert not complaints, "\n".join(complaints)


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_check_can_fail(check: Callable[[Module], list[str]]) -> None:
    assert check(read(BAD[check.__name__]))
    assert not check(read('"""Room."""\n'))


@pytest.mark.parametrize(
    "text",
    [
        "raise Exception('x')\n",
        "raise NotImplementedError\n",
        "try:\n    x = 1\nexcept Exception:\n    pass\n",
        "try:\n    x = 1\nexcept BaseException:\n    x = 2\n",
    ],
)
def test_each_kind_of_broad_error_is_detected(text: str) -> None:
    assert code_checks.broad_errors(read(text))


def test_cleaning_up_is_no_broad_error() -> None:
    text = "try:\n    x = 1\nexcept BaseException:\n    x = 2\n    raise\n"
    assert not code_checks.broad_errors(read(text))


def test_kernels_may_be_long_and_docstrings_do_not_count() -> None:
    body = "    x = 1\n" * 70
    assert not code_checks.long_functions(read(f"@numba.njit(cache=True)\ndef f():\n{body}"))
    inner = "".join(f"    {line}\n" for line in f"@njit\ndef g():\n{body}".splitlines())
    assert not code_checks.long_functions(read(f"def f():\n{inner}    return g\n"))
    assert code_checks.long_functions(read(f"def f():\n{inner.replace('@njit', '@wraps')}"))
    text = "words\n" * 70
    assert not code_checks.long_functions(read(f'def f():\n    """{text}"""\n    return 1\n'))


def test_pages_may_list_their_names() -> None:
    page = '__all__ = ["g"]\n'
    assert not code_checks.exports(read(page, "src/tribodyn/gear/__init__.py"))
    assert not code_checks.exports(read(page, "src/tribodyn/errors.py"))
    assert code_checks.exports(read(page, "src/tribodyn/gear/involute.py"))


def test_allowed_imports_depend_on_the_part() -> None:
    assert code_checks.top_level_imports(read("import pydantic\n"))
    assert not code_checks.top_level_imports(
        read("import pydantic\n", "src/tribodyn/study/case.py")
    )
    assert code_checks.top_level_imports(read("from rich import print\n"))
    assert not code_checks.top_level_imports(read("def f():\n    import scipy\n"))


def test_median_sizes(record_property: Callable[[str, object], None]) -> None:
    files = [len(module.text.splitlines()) for module in modules()]
    functions = [f.code_lines for module in modules() for f in module.functions()]
    record_property("median_lines_of_a_file", statistics.median(files))
    record_property("median_lines_of_a_function", statistics.median(functions))
    assert 100 <= statistics.median(files) <= 250
    assert statistics.median(functions) <= 16
