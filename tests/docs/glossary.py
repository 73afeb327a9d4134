"""Write docs/nomenclature.md from the table of quantities: ``python tests/docs/glossary.py``."""

from pathlib import Path

from tribodyn.nomenclature import QUANTITIES, Quantity

PAGE = Path(__file__).resolve().parents[2] / "docs" / "nomenclature.md"

HEAD = """# Names, symbols and units

Every quantity of tribodyn once. The name is what case fields, arguments, arrays and summaries are
called; numbers are in the SI unit, figures and reports show the other one. Symbols follow ISO 21771
and ISO 6336 where they have one. `tribodyn explain NAME` prints a line of this table.

| Name | Symbol | SI unit | Shown in | Meaning |
|---|---|---|---|---|
"""


def row(quantity: Quantity) -> str:
    """One line of the table."""
    symbol = f"`{quantity.symbol}`" if quantity.symbol else ""
    units = [f"`{unit}`" if unit else "1" for unit in (quantity.unit, quantity.display_unit)]
    cells = (f"`{quantity.name}`", symbol, *units)
    return f"| {' | '.join(cells)} | {quantity.meaning} |"


def page() -> str:
    """The whole page."""
    return HEAD + "\n".join(row(quantity) for quantity in QUANTITIES.values()) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
