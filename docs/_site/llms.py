"""The file ``llms.txt`` at the root of the site: which page answers what, for language models."""

import re
from pathlib import Path
from typing import Any

from _site.gallery import DOCS, entries
from tribodyn.cookbook import recipes
from tribodyn.scope import features, statement

_HEAD = f"""# tribodyn

> Gear tribo-dynamics in Python: {statement("summary")}.
> Gears: {statement("gears")}.

Not in this version: {"; ".join(each.text for each in features() if not each.modelled)}.

Start from the recipe nearest to the question: each is a script that runs unchanged and uses
public names only. `tribodyn cookbook NAME` prints it; `tribodyn explain WORDS` explains any key,
model or symbol.
"""


def text() -> str:
    """Return the file: a heading, a summary, and a list of links by section."""
    lines = [_HEAD, "## Recipes", ""]
    lines += [
        f"- [{recipe.question}](cookbook/{name}.html): {recipe.notes}"
        for name, recipe in recipes().items()
    ]
    index = (DOCS / "index.md").read_text("utf-8")
    pages = index.partition("\n## Pages\n")[2].partition("\n## ")[0]
    for group in re.split(r"^### ", pages, flags=re.MULTILINE)[1:]:
        heading, _, body = group.partition("\n")
        links = re.findall(r"- \[(.*?)\]\(([\w-]+)\.md\)", body)
        lines += ["", f"## {heading}", "", *(f"- [{title}]({name}.html)" for title, name in links)]
    lines += ["", "## Examples", ""]
    lines += [
        f"- [{title}](_generated/examples/{name}.html): {line}" for title, name, line in entries()
    ]
    return "\n".join(lines) + "\n"


def write(app: Any, error: Exception | None) -> None:
    """Write the file next to the pages once the site is built."""
    if error is None and app.builder.format == "html":
        (Path(app.outdir) / "llms.txt").write_text(text(), "utf-8")
