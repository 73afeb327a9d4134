"""The pages as the site reads them."""

import re
from typing import Any

from _site.gallery import DOCS
from _site.names import packages
from tribodyn.nomenclature import QUANTITIES, Quantity

_EXAMPLE = re.compile(r"\]\(\.\./examples/(\w+)\.py\)")
_PACKAGE = re.compile(r"\]\(\.\./src/tribodyn/(\w+)/?\)")
_SOURCE = re.compile(r"\[([^\]]+)\]\(\.\./src/[^)]+\)")


def rewrite(_: Any, name: str, source: list[str]) -> None:
    """Lead links to the site's own pages, and give the index its tree of contents."""
    text = source[0]
    text = _EXAMPLE.sub(r"](/_generated/examples/\1.md)", text)
    text = text.replace("](../src/tribodyn/cli)", "](command-line.md)")
    text = text.replace("](../src/tribodyn/app)", "](app.md)")
    text = _PACKAGE.sub(_to_api, text)
    text = _SOURCE.sub(r"\1", text)
    if name == "index":
        text += contents((DOCS / "index.md").read_text("utf-8"))
    if name == "cookbook":
        text += _tree("Recipes", re.findall(r"\]\((cookbook/[\w-]+)\.md\)", text))
    if name == "nomenclature":
        text = text[: text.index("| Name |")] + _glossary()
    source[0] = text


def _to_api(link: re.Match[str]) -> str:
    """Lead to the page of a public package; links to other packages become names."""
    name = f"tribodyn.{link[1]}"
    return f"](/_generated/api/{name}.md)" if name in packages() else link[0]


def contents(index: str) -> str:
    """Trees of contents, one for each heading under *Pages*."""
    pages = index.partition("\n## Pages\n")[2].partition("\n## ")[0]
    trees = [_tree("Examples", ["_generated/gallery"])]
    for group in re.split(r"^### ", pages, flags=re.MULTILINE)[1:]:
        caption, _, links = group.partition("\n")
        names = re.findall(r"\]\(([\w-]+)\.md\)", links)
        trees.append(_tree(caption, names))
    trees.append(_tree("API", ["_generated/api/index"]))
    return "".join(trees)


def _tree(caption: str, names: list[str]) -> str:
    return "\n".join(
        ["", "```{toctree}", ":hidden:", f":caption: {caption}", "", *names, "```", ""]
    )


def _glossary() -> str:
    terms = "\n\n".join(_term(quantity) for quantity in QUANTITIES.values())
    return f"```{{glossary}}\n{terms}\n```\n"


def _term(quantity: Quantity) -> str:
    units = [
        f"in `{quantity.unit}`" if quantity.unit else "a number",
        f"shown in `{quantity.display_unit}`"
        if quantity.display_unit and quantity.display_unit != quantity.unit
        else "",
    ]
    symbol = [f"symbol `{quantity.symbol}`"] if quantity.symbol else []
    definition = "; ".join([quantity.meaning, *symbol, *(unit for unit in units if unit)])
    return f"{quantity.name}\n   {definition}"
