"""The recipes: their form, their pages, and the command that prints them."""

import ast
import json
import re
from pathlib import Path

import pytest
from cookbook import FOLDER, INDEX, written_pages
from pages import ROOT

from registries import as_before
from tribodyn.cli import call
from tribodyn.cookbook import TOPICS, Recipe, find_recipe, recipes, write_skill
from tribodyn.errors import InputError, OutputExistsError

RECIPES = list(recipes().values())
# Each needs more than about three seconds of one core.
SLOW = {"tip-relief"}


def code_lines(recipe: Recipe) -> list[str]:
    return [line for line in recipe.code.splitlines() if line.strip()]


def test_there_is_a_recipe_for_every_topic() -> None:
    assert 25 <= len(RECIPES) <= 40
    assert {recipe.topic for recipe in RECIPES} == set(TOPICS.values())


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: recipe.name)
def test_recipe_is_one_question_and_at_most_twenty_lines(recipe: Recipe) -> None:
    assert recipe.question.endswith("?")
    assert len(code_lines(recipe)) <= 20
    assert recipe.code.rstrip().endswith(f'.write_html("{recipe.figure_name}")')
    for page in recipe.pages:
        assert (ROOT / "docs" / f"{page}.md").is_file()
    picture = FOLDER / "images" / f"{recipe.name}.png"
    assert picture.read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: recipe.name)
def test_recipe_uses_public_names_only(recipe: Recipe) -> None:
    for node in ast.walk(ast.parse(recipe.script)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("tribodyn"):
            assert (node.module or "").count(".") <= 1, node.module
            assert not any(alias.name.startswith("_") for alias in node.names)


@pytest.mark.parametrize(
    "recipe",
    [
        pytest.param(recipe, marks=pytest.mark.slow if recipe.name in SLOW else ())
        for recipe in RECIPES
    ],
    ids=lambda recipe: recipe.name,
)
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_recipe_runs_and_writes_its_figure(
    recipe: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    monkeypatch.chdir(tmp_path)
    with as_before():
        exec(compile(recipe.script, recipe.file_name, "exec"), {"__name__": "__main__"})
    assert capsys.readouterr().out.strip()
    assert "plotly" in (tmp_path / recipe.figure_name).read_text("utf-8")


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: recipe.name)
def test_notebook_is_the_script_and_ends_with_its_figure(recipe: Recipe) -> None:
    cells = json.loads(recipe.notebook)["cells"]
    assert [cell["cell_type"] for cell in cells] == ["markdown", "code", "code"]
    assert "".join(cells[0]["source"]) == f"# {recipe.question}\n\n{recipe.notes}"
    code = "\n".join("".join(cell["source"]) for cell in cells[1:])
    assert f'{code}.write_html("{recipe.figure_name}")\n' == recipe.code
    assert ast.parse("".join(cells[2]["source"]), mode="eval")


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("name", ["speed-sweep", "friction-laws"])
def test_notebook_runs_cell_by_cell(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert call(["cookbook", name, "--out", "my.ipynb"]) == 0
    cells = json.loads(Path("my.ipynb").read_text("utf-8"))["cells"]
    names: dict[str, object] = {}
    with as_before():
        exec("".join(cells[1]["source"]), names)
        figure = eval("".join(cells[2]["source"]), names)
    assert figure.to_dict()["data"]
    assert not [*tmp_path.glob("*.html")]


def test_pages_are_those_of_the_recipes() -> None:
    expected = written_pages()
    stored = {path: path.read_text("utf-8") for path in (INDEX, *FOLDER.glob("*.md"))}
    assert stored == expected, "run: python tests/docs/cookbook.py"


def test_pictures_belong_to_recipes() -> None:
    pictures = {path.stem for path in (FOLDER / "images").iterdir()}
    assert pictures == set(recipes())


def test_command_lists_all_recipes(capsys: pytest.CaptureFixture) -> None:
    assert call(["cookbook", "--json"]) == 0
    assert [entry["name"] for entry in json.loads(capsys.readouterr().out)] == list(recipes())
    assert call(["cookbook"]) == 0
    listing = capsys.readouterr().out
    assert all(recipe.name in listing and recipe.question in listing for recipe in RECIPES)


def test_command_prints_a_recipe_that_python_can_run(capsys: pytest.CaptureFixture) -> None:
    assert call(["cookbook", "film_of_a_contact"]) == 0
    assert capsys.readouterr().out == find_recipe("film-of-a-contact").script


def test_command_writes_a_recipe_and_replaces_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    target = tmp_path / "scripts"
    assert call(["cookbook", "tip-relief", "--out", str(target)]) == 0
    assert (target / "tip_relief.py").read_text("utf-8") == find_recipe("tip-relief").script
    (target / "tip_relief.py").write_text("mine", "utf-8")
    assert call(["cookbook", "tip-relief", "--out", str(target)]) == 2
    assert "exists already" in capsys.readouterr().err
    assert (target / "tip_relief.py").read_text("utf-8") == "mine"
    assert call(["cookbook", "tip-relief", "--out", str(target), "--force"]) == 0
    assert (target / "tip_relief.py").read_text("utf-8") != "mine"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["tip-releif"], "Did you mean tip-relief?"),
        (["oils"], "Did you mean compare-oils?"),
        (["--out", "x.py"], "--out needs the name of a recipe"),
        (["losses", "--skill", "x"], "--skill writes all recipes"),
    ],
)
def test_wrong_input_is_explained(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture
) -> None:
    assert call(["cookbook", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_unknown_recipe_raises_an_input_error() -> None:
    with pytest.raises(InputError, match="no recipe"):
        find_recipe("nothing like it")


def test_skill_follows_the_agent_skills_standard(tmp_path: Path) -> None:
    folder = write_skill(tmp_path)
    text = (folder / "SKILL.md").read_text("utf-8")
    _, front, body = text.split("---\n", 2)
    fields = dict(line.split(": ", 1) for line in front.splitlines())
    assert fields["name"] == folder.name == "tribodyn"
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", fields["name"])
    assert 1 <= len(fields["description"]) <= 1024
    scripts = {path.name: path.read_text("utf-8") for path in (folder / "scripts").iterdir()}
    assert scripts == {recipe.file_name: recipe.script for recipe in RECIPES}
    assert all(f"scripts/{name}" in body for name in scripts)
    with pytest.raises(OutputExistsError):
        write_skill(tmp_path)
    assert write_skill(tmp_path, force=True) == folder


def test_commands_and_names_in_the_skill_exist(tmp_path: Path) -> None:
    text = (write_skill(tmp_path) / "SKILL.md").read_text("utf-8")
    for command in set(re.findall(r"`tribodyn ([a-z-]+)", text)):
        assert call([command, "--help"]) == 0
    import tribodyn as td

    for name in set(re.findall(r"\btd\.(\w+)", text)):
        assert hasattr(td, name)
    assert td.load_case("fzg-roughness").replace({"operation.torque": "120 N*m"})
