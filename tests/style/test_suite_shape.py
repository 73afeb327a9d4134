"""The tests themselves: unique names, no clock, nothing that cannot fail, no silent skip."""

from collections.abc import Callable

import pytest
import suite_checks
from source_tree import TESTS, Module, modules, read

CHECKS = [suite_checks.clocks, suite_checks.idle_tests, suite_checks.silent_skips]

BAD = {
    "clocks": [
        "import time\nstart = time.perf_counter()\n",
        "from time import monotonic\n",
        "import time\nnow = time.time_ns()\n",
        "import datetime\nnow = datetime.now()\n",
    ],
    "idle_tests": [
        "def test_x():\n    x = 1\n",
        "def test_x():\n    assert True\n",
        "class TestX:\n    def test_x(self):\n        x = 1\n",
    ],
    "silent_skips": [
        "@pytest.mark.skip\ndef test_x():\n    assert x\n",
        "@pytest.mark.skipif(True)\ndef test_x():\n    assert x\n",
        "def test_x():\n    pytest.skip()\n",
    ],
}
GOOD = (
    "@pytest.mark.skipif(True, reason='y')\n"
    "def test_x():\n    pytest.skip('z')\n    time.sleep(1)\n    assert x == 1\n"
)


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_suite(check: Callable[[Module], list[str]]) -> None:
    complaints = [complaint for module in modules(TESTS) for complaint in check(module)]
    assert not complaints, "\n".join(complaints)


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_check_can_fail(check: Callable[[Module], list[str]]) -> None:
    for text in BAD[check.__name__]:
        assert check(read(text)), text
    assert check(read(GOOD)) == []


def test_names_of_test_modules_are_unique() -> None:
    paths = [module.path for module in modules(TESTS) if not module.path.endswith("conftest.py")]
    assert not suite_checks.doubled_names(paths)
    assert suite_checks.doubled_names(["a/test_x.py", "b/test_x.py", "test_y.py"]) == [
        "a/test_x.py",
        "b/test_x.py",
    ]


def test_test_folders_are_no_packages() -> None:
    assert not list(TESTS.rglob("__init__.py"))
