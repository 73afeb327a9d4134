"""A page for each numbered example: what it is about, its picture, its code, what it prints."""

import ast
import re
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1]
#: Lines of the index on examples: title, file and what it shows.
_ENTRY = re.compile(r"^\d+\. \[(.*?)\]\(\.\./examples/(\w+)\.py\): (.*)$", re.MULTILINE)


def entries() -> list[tuple[str, str, str]]:
    """Title, file and line of each example, from the index."""
    return _ENTRY.findall((DOCS / "index.md").read_text("utf-8"))


def written() -> dict[str, str]:
    """The gallery and its pages by file name."""
    cards = ["# Examples", "", "::::{grid} 1 2 2 3", ":gutter: 3", ""]
    pages = {}
    for title, name, line in entries():
        picture = DOCS / "gallery" / f"{name}.png"
        image = [f":img-top: ../gallery/{name}.png"] if picture.exists() else []
        number = f"{int(name[:2])}. {title}"
        cards += [
            f":::{{grid-item-card}} {number}",
            f":link: examples/{name}",
            ":link-type: doc",
            *image,
            line,
            ":::",
        ]
        pages[f"examples/{name}.md"] = _page(number, name, picture.exists())
    names = [name for _, name, _ in entries()]
    tree = ["```{toctree}", ":hidden:", "", *(f"examples/{name}" for name in names), "```"]
    return {"gallery.md": "\n".join([*cards, "::::", "", *tree, ""]), **pages}


def _page(title: str, name: str, picture: bool) -> str:
    code = (DOCS.parent / "examples" / f"{name}.py").read_text("utf-8")
    description = (ast.get_docstring(ast.parse(code)) or "").replace("``", "`")
    body = code.split('"""', 2)[2].lstrip("\n")
    image = f"![{title}](../../gallery/{name}.png)\n\n" if picture else ""
    printed = DOCS / "gallery" / f"{name}.txt"
    output = printed.read_text("utf-8") if printed.exists() else ""
    code = f"```python\n{body}```\n\n## What it prints\n\n```text\n{output}```\n"
    return f"# {title}\n\n{description}\n\n{image}{code}"
