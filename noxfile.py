#!/usr/bin/env -S uv run --script

# /// script
# dependencies = ["nox>=2025.2.9"]
# ///

"""Tasks of development: ``nox`` runs the checks and the suite, ``nox --list`` names all."""

import nox

nox.needs_version = ">=2025.2.9"
nox.options.default_venv_backend = "uv|virtualenv"


@nox.session
def lint(session: nox.Session) -> None:
    """Run the linters, the types and the layers of imports."""
    session.install("-e", ".[dev]")
    session.run("ruff", "check", ".")
    session.run("ruff", "format", "--check", ".")
    session.run("mypy")
    session.run("lint-imports", "--no-logo")


@nox.session(python=["3.11", "3.12", "3.13", "3.14"])
def tests(session: nox.Session) -> None:
    """Run the suite, or the tests that are named after ``--``."""
    session.install("-e", ".[test]")
    session.run("pytest", *(session.posargs or ["-q", "-n", "auto", "--dist", "worksteal"]))


@nox.session(default=False)
def docs(session: nox.Session) -> None:
    """Build the documentation site in ``site``."""
    session.install("-e", ".[docs]")
    session.run("sphinx-build", "-q", "-W", "-n", "--keep-going", "docs", "site")


@nox.session(default=False)
def benchmarks(session: nox.Session) -> None:
    """Run all benchmarks, or try them with ``-- --quick``."""
    session.install("-e", ".[dev]")
    session.run("python", "benchmarks/run_all.py", *session.posargs)


@nox.session(default=False)
def build(session: nox.Session) -> None:
    """Build and check the wheel and the source distribution."""
    session.install("build", "twine")
    session.run("python", "-m", "build")
    session.run("twine", "check", "--strict", "dist/*")


if __name__ == "__main__":
    nox.main()
