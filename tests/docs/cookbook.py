"""Pages and pictures of the recipes: ``python tests/docs/cookbook.py [NAME ...]``.

Without a name only the pages are written; with names, or ``all``, their pictures too.
"""

import contextlib
import runpy
import sys
import tempfile
import warnings
from pathlib import Path

from pages import ROOT

from tribodyn.cookbook import TOPICS, Recipe, recipes

FOLDER = ROOT / "docs" / "cookbook"
INDEX = ROOT / "docs" / "cookbook.md"

_HEAD = """# Cookbook: how do I ...

After this page you have a script for your question: each recipe is a question, a script of at most
20 lines that runs unchanged, and the figure that it writes. On the command line:

```text
tribodyn cookbook                          list all recipes
tribodyn cookbook tip-relief               print one
tribodyn cookbook tip-relief --out my.py   write it, ready to run
tribodyn cookbook --skill skills           write all of them as a skill for a coding assistant
```

`tribodyn explain WORDS` answers questions of the kind "what is this": symbols, keys, models, laws
and warnings. The skill follows the open Agent Skills standard; with it, scripts written by an
assistant use names that exist.
"""


def index_page() -> str:
    """The list of recipes by topic."""
    lines = [_HEAD]
    for topic in TOPICS.values():
        lines += [f"## {topic}", "", "| question | recipe |", "|---|---|"]
        lines += [
            f"| {recipe.question} | [{recipe.name}](cookbook/{recipe.name}.md) |"
            for recipe in recipes().values()
            if recipe.topic == topic
        ]
        lines.append("")
    return "\n".join(lines)


def recipe_page(recipe: Recipe) -> str:
    """The page of one recipe."""
    links = (f"[{_heading(page)}](../{page}.md)" for page in recipe.pages)
    return (
        f"# {recipe.question}\n\n{recipe.notes}\n\n```python\n{recipe.code}```\n\n"
        f"![{recipe.question}](images/{recipe.name}.png)\n\n"
        f"Read on: {', '.join(links)}. On the command line: `tribodyn cookbook {recipe.name}`.\n"
    )


def _heading(page: str) -> str:
    first = (ROOT / "docs" / f"{page}.md").read_text("utf-8").partition("\n")[0]
    return first.removeprefix("# ")


def written_pages() -> dict[Path, str]:
    """All pages of the cookbook by path."""
    pages = {FOLDER / f"{name}.md": recipe_page(recipe) for name, recipe in recipes().items()}
    return {INDEX: index_page(), **pages}


def draw(recipe: Recipe, browser_page: object) -> None:
    """Run a recipe and store a picture of its figure."""
    from gallery import save_screenshot

    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        Path(recipe.file_name).write_text(recipe.script, "utf-8")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            runpy.run_path(recipe.file_name)
        target = FOLDER / "images" / f"{recipe.name}.png"
        save_screenshot(browser_page, Path(recipe.figure_name).resolve(), target)


if __name__ == "__main__":
    (FOLDER / "images").mkdir(parents=True, exist_ok=True)
    for path, text in written_pages().items():
        path.write_text(text, "utf-8")
    names = sys.argv[1:]
    if names:
        from gallery import open_browser

        with open_browser() as browser_page:
            for recipe in recipes().values():
                if recipe.name in names or names == ["all"]:
                    draw(recipe, browser_page)
                    print(recipe.name)
