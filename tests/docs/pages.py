"""The pages of the documentation: their code blocks and their links."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
_AT_THE_TOP = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")
PAGES = sorted(
    page
    for page in (*(ROOT / name for name in _AT_THE_TOP), *(ROOT / "docs").rglob("*.md"))
    if "_generated" not in page.parts
)


def blocks(text: str, language: str) -> list[str]:
    """Fenced code blocks of one language.

    >>> blocks("```toml\\na = 1\\n```\\n", "toml")
    ['a = 1\\n']
    """
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


def anchors(text: str) -> set[str]:
    """Anchors that the headings of a page make."""
    headings = re.findall(r"^#+ +(.*)$", text, re.MULTILINE)
    cleaned = (re.sub(r"[^\w\- ]", "", heading.lower()) for heading in headings)
    return {heading.strip().replace(" ", "-") for heading in cleaned}


def broken_links(page: Path, text: str) -> list[str]:
    """Relative links of a page that lead nowhere."""
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    broken = []
    for target in re.findall(r"\]\(([^)\s]+)\)", prose):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = (page.parent / name) if name else page
        if name and not file.exists():
            broken.append(f"{page.name}: {target}")
        elif anchor and anchor not in anchors(text if not name else file.read_text("utf-8")):
            broken.append(f"{page.name}: {target} has no such heading")
    return broken
