"""Everything that the sources contain is there, or it is said why it is not."""

from contents import missing, sources

ROWS = [row for source in sources().values() for row in source["rows"]]
#: Rows of each source.
COUNTS = {"S0": 51, "S1": 23, "S2": 15, "S3": 18, "S4": 17}


def test_every_row_of_every_source_is_compared() -> None:
    named = {f"{name}.{number + 1}" for name, count in COUNTS.items() for number in range(count)}
    assert sorted(row["id"] for row in ROWS) == sorted(named)


def test_tests_and_pages_named_in_a_row_exist() -> None:
    for row in ROWS:
        assert {"tests", "figures", "tables", "reason"} & row.keys(), row["id"]
    lost = {row["id"]: list(missing(row)) for row in ROWS}
    assert {row: names for row, names in lost.items() if names} == {}


def test_references_to_missing_tests_are_detected() -> None:
    row = {
        "tests": ["test_contents.py::test_none"],
        "figures": ["none"],
        "tables": ["fzg-12dof: -"],
    }
    assert len(list(missing(row))) == 3
