"""Recipes: one question and one short script each, for people and for coding assistants.

The scripts lie in folders by topic and use public names only. Each opens with its question, ends
with the figure that it writes, and runs as it stands. The tests run all of them.

| module | what it answers |
|---|---|
| ``recipe`` | which recipes there are, by name |
| ``skill`` | a folder that teaches a coding assistant to use the package (Agent Skills) |
"""

from tribodyn.arguments import guard
from tribodyn.cookbook.recipe import TOPICS, Recipe, find_recipe, recipes
from tribodyn.cookbook.skill import write_skill

__all__ = ["TOPICS", "Recipe", "find_recipe", "recipes", "write_skill"]

guard(__name__)
