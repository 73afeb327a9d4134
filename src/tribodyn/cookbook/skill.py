"""The recipes as a skill for coding assistants."""

from __future__ import annotations

from pathlib import Path

from tribodyn.cookbook.recipe import TOPICS, recipes
from tribodyn.errors import OutputExistsError
from tribodyn.scope import features, statement

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
