"""The repository as the style tests see it: modules as syntax trees, functions, docstrings."""

from __future__ import annotations

import ast
import os
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path

from tribodyn.drawing import figure_text
from tribodyn.ehl.formulas.dimensionless_groups import full_text

__all__ = [
    "PACKAGE",
    "ROOT",
    "TESTS",
    "Function",
    "Module",
    "expected_files",
    "listed_names",
    "modules",
    "parse_entries",
    "read",
    "repository_files",
    "text_files",
    "tracked_files",
]

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "src" / "tribodyn"
TESTS = ROOT / "tests"

#: Folders and files of the repository; anything else in the folder was left there by its user.
_FOLDERS = (".ci", ".github", "benchmarks", "docs", "examples", "src", "tests")
_FILES = (
    ".gitignore", ".pre-commit-config.yaml", "CHANGELOG.md", "CITATION.cff", "CODE_OF_CONDUCT.md",
    "CONTRIBUTING.md", "LICENSE", "README.md", "SECURITY.md", "noxfile.py", "pyproject.toml",
)  # fmt: skip
_GENERATED = {"__pycache__", "_generated"}
_TEXT = {
    ".py",
    ".pyi",
    ".toml",
    ".md",
    ".cff",
    ".yml",
    ".yaml",
    ".j2",
    ".html",
    ".css",
    ".js",
    ".txt",
    "",
}

FunctionNode = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Function:
    """One function or method with what the checks ask of it."""

    node: FunctionNode
    name: str
    owner: ast.ClassDef | None
    nested: bool

    @property
    def public(self) -> bool:
        """Whether a user may call it: no leading underscore anywhere, not inside a function."""
        names = [self.node.name, *([self.owner.name] if self.owner else [])]
        return not self.nested and not any(name.startswith("_") for name in names)

    @cached_property
    def decorators(self) -> list[str]:
        """Text of the decorators."""
        return [ast.unparse(decorator) for decorator in self.node.decorator_list]

    @property
    def compiled(self) -> bool:
        """Whether it is a compiled kernel."""
        return any(
            re.search(r"\b(njit|jit|cached_njit|guvectorize|vectorize|intrinsic)\b", d)
            for d in self.decorators
        )

    @property
    def shared(self) -> bool:
        """Whether it is a film formula, whose arguments and their texts a decorator completes."""
        return bool({"film_formula", "shared_arguments"} & set(self.decorators))

    @cached_property
    def docstring(self) -> str:
        """Cleaned docstring as a user reads it, empty if there is none."""
        text = ast.get_docstring(self.node) or ""
        if any(re.match(r"(\w+_)?drawing\(", decorator) for decorator in self.decorators):
            return figure_text(text, self.node.args.args[0].arg)
        return full_text(text) if self.shared and text else text

    @property
    def code_lines(self) -> int:
        """Lines of the function without its docstring, decorators and the kernels that it makes."""
        first = self.node.body[0]
        has_docstring = ast.get_docstring(self.node, clean=False) is not None
        documented = (first.end_lineno or 0) - first.lineno + 1 if has_docstring else 0
        inner = (Function(node, node.name, None, nested=True) for node in self._inside())
        kernels = sum(_length(function.node) for function in inner if function.compiled)
        return _length(self.node) - documented - kernels

    def _inside(self) -> list[FunctionNode]:
        nodes = (node for statement in self.node.body for node in ast.walk(statement))
        return [node for node in nodes if isinstance(node, FunctionNode)]

    @property
    def parameters(self) -> list[str]:
        """Names of the parameters in order, without self and cls."""
        if "film_formula" in self.decorators:
            return list(parse_entries(self.docstring, "Parameters"))
        arguments = self.node.args
        named = [*arguments.posonlyargs, *arguments.args]
        if self.owner and "staticmethod" not in self.decorators:
            named = named[1:]
        starred = [arguments.vararg] if arguments.vararg else []
        last = [arguments.kwarg] if arguments.kwarg else []
        return [argument.arg for argument in (*named, *starred, *arguments.kwonlyargs, *last)]


def _length(node: FunctionNode) -> int:
    return (node.end_lineno or 0) - node.lineno + 1


@dataclass(frozen=True)
class Module:
    """One Python file."""

    path: str
    text: str
    tree: ast.Module
    surface: frozenset[str] = frozenset()  #: its names that are on a page of public names

    @property
    def package(self) -> str:
        """Name of the part it belongs to: ``gear``, ``dynamics``, or its own for single files."""
        parts = Path(self.path).parts
        return parts[2] if len(parts) > 3 else Path(self.path).stem

    @cached_property
    def nodes(self) -> list[ast.AST]:
        """All nodes of the tree."""
        return list(ast.walk(self.tree))

    @cached_property
    def _all_functions(self) -> list[Function]:
        return list(_functions(self.tree, "", None, nested=False))

    def functions(self) -> list[Function]:
        """All functions with their qualified names."""
        return self._all_functions

    def classes(self) -> Iterator[ast.ClassDef]:
        """Classes at the top level."""
        return (node for node in self.tree.body if isinstance(node, ast.ClassDef))


def _functions(
    node: ast.AST, prefix: str, owner: ast.ClassDef | None, *, nested: bool
) -> Iterator[Function]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, FunctionNode):
            yield Function(child, f"{prefix}{child.name}", owner, nested)
            yield from _functions(child, f"{prefix}{child.name}.", None, nested=True)
        elif isinstance(child, ast.ClassDef):
            yield from _functions(child, f"{prefix}{child.name}.", child, nested=nested)
        else:
            yield from _functions(child, prefix, owner, nested=nested)


def read(text: str, path: str = "src/tribodyn/gear/example.py", page: str = "") -> Module:
    """Make a module of text, so that each check can be shown to fail."""
    return Module(path, text, ast.parse(text), frozenset(listed_names(ast.parse(page)) or ()))


def listed_names(tree: ast.Module) -> list[str] | None:
    """Return what ``__all__`` lists, None if there is none."""
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        if any(isinstance(target, ast.Name) and target.id == "__all__" for target in targets):
            leaves = ast.walk(node)
            return [
                leaf.value
                for leaf in leaves
                if isinstance(leaf, ast.Constant) and isinstance(leaf.value, str)
            ]
    return None


def _surfaces() -> dict[str, set[str]]:
    """Names that the pages of public names take from each module."""
    names: dict[str, set[str]] = {}
    for page in PACKAGE.rglob("__init__.py*"):
        for node in ast.walk(ast.parse(page.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                names.setdefault(node.module, set()).update(alias.name for alias in node.names)
    return names


@lru_cache(maxsize=4)
def modules(folder: Path = PACKAGE) -> tuple[Module, ...]:
    """All modules under a folder; recipes are scripts, in folders that are no packages."""
    surfaces = _surfaces()
    modules_read = []
    for path in sorted(folder.rglob("*.py")):
        if folder == PACKAGE and not (path.parent / "__init__.py").exists():
            continue
        text, place = path.read_text("utf-8"), path.relative_to(ROOT)
        dotted = ".".join(place.with_suffix("").parts[1:])
        surface = frozenset(surfaces.get(dotted, ()))
        modules_read.append(Module(place.as_posix(), text, ast.parse(text), surface))
    return tuple(modules_read)


def tracked_files(root: Path = ROOT) -> list[Path] | None:
    """All files under version control; None outside of a clone, as in an unpacked archive."""
    if not (root / ".git").exists():
        return None
    command = ["git", "-c", "safe.directory=*", "ls-files", "-z"]
    try:
        listing = subprocess.run(command, cwd=root, capture_output=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return None
    paths = (root / os.fsdecode(name) for name in listing.split(b"\0") if name)
    return sorted(path for path in paths if path.is_file())


def repository_files(root: Path = ROOT) -> list[Path]:
    """All files of the repository, without what users and programs left in its folder."""
    tracked = tracked_files(root)
    return expected_files(root) if tracked is None else tracked


def expected_files(root: Path) -> list[Path]:
    """All files at the places where the repository has its files."""
    files = [root / name for name in _FILES if (root / name).is_file()]
    for folder in _FOLDERS:
        for path in (root / folder).rglob("*"):
            parts = path.relative_to(root).parts
            generated = any(part in _GENERATED or part.endswith(".egg-info") for part in parts)
            if path.is_file() and not generated:
                files.append(path)
    return sorted(files)


def text_files(root: Path = ROOT) -> list[Path]:
    """All text files of the repository."""
    return [path for path in repository_files(root) if path.suffix in _TEXT]


def parse_entries(docstring: str, section: str) -> dict[str, str]:
    """Return the entries of a NumPy-style section: name to the text of its entry."""
    pattern = rf"^{section}\n-+\n(.*?)(?=^\S[^\n]*\n---+$|\Z)"
    match = re.search(pattern, docstring, re.DOTALL | re.MULTILINE)
    entries: dict[str, str] = {}
    names: list[str] = []
    for line in match.group(1).splitlines() if match else []:
        head = re.match(r"^(\*{0,2}\w+(?:, \*{0,2}\w+)*)(?= :|$)", line)
        if head:
            names = [name.strip(" *") for name in head.group(1).split(",")]
            line = line[head.end() :]
        for name in names:
            entries[name] = f"{entries.get(name, '')} {line.strip()}"
    return entries
