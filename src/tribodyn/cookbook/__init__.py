"""Recipes: one question and one short script each, for people and for coding assistants.

The scripts lie in folders by topic and use public names only. Each opens with its question, ends
with the figure that it writes, and runs unchanged. The tests run all of them.

| module | what it answers |
|---|---|
| ``recipe`` | recipes by name, also as a folder for coding assistants (Agent Skills) |
"""

from tribodyn.arguments import guard
from tribodyn.cookbook.recipe import TOPICS, Recipe, find_recipe, recipes, write_skill

__all__ = ["TOPICS", "Recipe", "find_recipe", "recipes", "write_skill"]

guard(__name__)
