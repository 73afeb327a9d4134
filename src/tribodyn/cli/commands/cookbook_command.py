"""``tribodyn cookbook``."""

from __future__ import annotations

from pathlib import Path

from tribodyn.cli.console import say, say_json, table, tell
from tribodyn.cli.settings import Flag
from tribodyn.cookbook import TOPICS, Recipe, find_recipe, recipes, write_skill
from tribodyn.errors import InputError, OutputExistsError


def cookbook(
    name: str = "",
    /,
    *,
    out: Path | None = None,
    skill: Path | None = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """List the recipes, print one, or write it to a file.

    Parameters
    ----------
    name : str
        Name of a recipe. Without one, all are listed.
    out : Path
        File that the script is written to, or a folder for it.
    skill : Path
        Folder in which to write a skill for coding assistants, with all recipes.
    force : bool
        Overwrite existing files.
    json : bool
        Write one JSON value to stdout.
    """
    if skill is not None:
        if name or out is not None:
            remedy = "Leave out the name and --out, or leave out --skill."
            raise InputError("--skill writes all recipes", "", "", remedy)
        folder = write_skill(skill, force=force)
        say_json({"skill": str(folder)}) if json else tell(f"Skill: {folder / 'SKILL.md'}")
    elif not name:
        if out is not None:
            remedy = "Name one: tribodyn cookbook tip-relief --out my.py. --skill writes all."
            raise InputError("--out needs the name of a recipe", "", "", remedy)
        _list_recipes(json)
    else:
        _show_recipe(find_recipe(name), out, force=force, json=json)


def _list_recipes(json: bool) -> None:
    if json:
        say_json([_as_dict(recipe) for recipe in recipes().values()])
        return
    for topic in TOPICS.values():
        rows = [[r.name, r.question] for r in recipes().values() if r.topic == topic]
        say(f"{topic}\n{table(rows)}\n")
    tell("tribodyn cookbook NAME prints a recipe; --out FILE writes it, ready to run.")


def _show_recipe(recipe: Recipe, out: Path | None, *, force: bool, json: bool) -> None:
    if out is not None:
        path = out / recipe.file_name if out.is_dir() or out.suffix != ".py" else out
        if path.exists() and not force:
            remedy = "Choose another name, or add --force."
            raise OutputExistsError("this exists already", str(path), "", remedy)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(recipe.script, "utf-8")
        tell(f"Run it with: python {path}")
    if json:
        say_json(_as_dict(recipe))
    elif out is None:
        say(recipe.script.rstrip("\n"))


def _as_dict(recipe: Recipe) -> dict[str, str]:
    return {
        "name": recipe.name,
        "topic": recipe.topic,
        "question": recipe.question,
        "notes": recipe.notes,
        "script": recipe.script,
    }
