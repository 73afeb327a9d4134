"""Recipes: where they are found, and a skill for coding assistants with all of them."""

from __future__ import annotations

import ast
import difflib
import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tribodyn.errors import InputError, OutputExistsError
from tribodyn.scope import features, statement
from tribodyn.types import Tree

_FOLDER = Path(__file__).parent
#: Folders of the recipes, in the order in which they are listed, with their headings.
TOPICS = {
    "gears": "Gears and their teeth",
    "film_and_friction": "Oil film, friction and losses",
    "vibration": "Vibration",
    "data_and_studies": "Results, recordings and studies",
}


@dataclass(frozen=True)
class Recipe:
    """A question and the script that answers it.

    Parameters
    ----------
    name : str
        Its name, with hyphens.
    topic : str
        Heading under which it is listed.
    question : str
        What a user wants to know or do.
    notes : str
        What else there is to know, in one paragraph.
    pages : tuple of str
        Pages of the documentation to read on, without their suffix.
    script : str
        The whole file: runs unchanged and writes one figure.
    """

    name: str
    topic: str
    question: str
    notes: str
    pages: tuple[str, ...]
    script: str

    @property
    def code(self) -> str:
        """Return the script without its opening text."""
        return self.script.split('"""', 2)[2].strip("\n") + "\n"

    @property
    def file_name(self) -> str:
        """Return the name of the script file."""
        return f"{self.name.replace('-', '_')}.py"

    @property
    def notebook(self) -> str:
        """Return the recipe as a notebook: its question and notes, the code, and the figure."""
        code, last = self.code.rstrip().rsplit("\n", 1)
        figure = last.removesuffix(f'.write_html("{self.figure_name}")')
        cells: list[Tree] = [_cell("markdown", f"# {self.question}\n\n{self.notes}")]
        cells += [_cell("code", part) | _NOT_RUN for part in (code, figure)]
        kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
        data = {"cells": cells, "metadata": {"kernelspec": kernel}}
        return json.dumps({**data, "nbformat": 4, "nbformat_minor": 4}, indent=1) + "\n"

    @property
    def figure_name(self) -> str:
        """Return the name of the page with the figure that the script writes."""
        return f"{self.name.replace('-', '_')}.html"


#: What a code cell has in addition to its text before it runs.
_NOT_RUN: Tree = {"execution_count": None, "outputs": []}


def _cell(kind: str, text: str) -> Tree:
    return {"cell_type": kind, "metadata": {}, "source": text.splitlines(keepends=True)}


@cache
def recipes() -> dict[str, Recipe]:
    """Read all recipes, in the order of their topics and names.

    Returns
    -------
    dict of str to Recipe

    Examples
    --------
    >>> recipes()["compare-oils"].question
    'What does another oil change?'
    """
    scripts = (path for topic in TOPICS for path in sorted((_FOLDER / topic).glob("*.py")))
    return {recipe.name: recipe for recipe in map(_read_recipe, scripts)}


def _read_recipe(path: Path) -> Recipe:
    script = path.read_text("utf-8")
    docstring = ast.get_docstring(ast.parse(script)) or ""
    question, notes, read_on = docstring.split("\n\n")
    name, topic = path.stem.replace("_", "-"), TOPICS[path.parent.name]
    pages = tuple(read_on.removeprefix("Read on: ").split(", "))
    return Recipe(name, topic, question, " ".join(notes.split()), pages, script)


def find_recipe(name: str) -> Recipe:
    """Return the recipe of a name; hyphens and underscores are the same.

    Parameters
    ----------
    name : str
        For example ``"compare-oils"``.

    Returns
    -------
    Recipe

    Raises
    ------
    InputError
        If no recipe has this name; the message names the nearest ones.

    Examples
    --------
    >>> find_recipe("tip_relief").file_name
    'tip_relief.py'
    """
    key = name.strip().lower().replace("_", "-").removesuffix(".py")
    if key in recipes():
        return recipes()[key]
    similar = difflib.get_close_matches(key, recipes(), n=3, cutoff=0.5)
    similar += [other for other in recipes() if key and key in other and other not in similar]
    remedy = f"Did you mean {' or '.join(similar[:3])}? " if similar else ""
    remedy += f"tribodyn cookbook lists all {len(recipes())}"
    raise InputError(f'there is no recipe "{name}"', "", "", remedy)


_TEMPLATE = Path(__file__).with_name("SKILL.md")
_SKILL_NAME = "tribodyn"


def write_skill(folder: str | Path, *, force: bool = False) -> Path:
    """Write a folder after the open Agent Skills standard: ``SKILL.md`` and all recipes.

    Parameters
    ----------
    folder : str or Path
        Folder of skills; the skill becomes its subfolder ``tribodyn``.
    force : bool
        Overwrite the files of an earlier skill.

    Returns
    -------
    Path
        Folder of the skill.

    Raises
    ------
    OutputExistsError
        If the skill is there and ``force`` is false.
    """
    skill = Path(folder) / _SKILL_NAME
    if skill.exists() and not force:
        raise OutputExistsError(
            "this exists already", str(skill), "", "Choose another folder, or use force (--force)"
        )
    (skill / "scripts").mkdir(parents=True, exist_ok=True)
    for recipe in recipes().values():
        (skill / "scripts" / recipe.file_name).write_text(recipe.script, "utf-8")
    texts = {
        "recipes": "\n".join(_listing()),
        "summary": statement("summary"),
        "gears": statement("gears"),
        "missing": "; ".join(each.text for each in features() if not each.modelled),
    }
    text = _TEMPLATE.read_text("utf-8")
    for mark, listing in texts.items():
        text = text.replace(f"<!-- {mark} -->", listing)
    (skill / "SKILL.md").write_text(text, "utf-8")
    return skill


def _listing() -> list[str]:
    lines: list[str] = []
    for topic in TOPICS.values():
        lines += ["", f"### {topic}", ""]
        lines += [
            f"- {recipe.question} `scripts/{recipe.file_name}`"
            for recipe in recipes().values()
            if recipe.topic == topic
        ]
    return lines[1:]
