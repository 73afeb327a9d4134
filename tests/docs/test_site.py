"""What the documentation site is made of; Sphinx itself runs in the gate."""

import re

from _site.gallery import entries, written
from _site.llms import text as llms_text
from _site.names import homes
from _site.pages import contents
from gallery import EXAMPLES, GALLERY, masked
from generated import packages
from pages import PAGES, ROOT

INDEX = (ROOT / "docs" / "index.md").read_text("utf-8")


def test_every_page_of_the_index_is_in_the_contents() -> None:
    pages = set(re.findall(r"\]\(([\w-]+)\.md\)", INDEX))
    assert len(pages) > 25
    assert pages <= set(contents(INDEX).split())


def test_every_example_has_a_page_with_its_picture_and_output() -> None:
    assert [name for _, name, _ in entries()] == [path.stem for path in EXAMPLES]
    pages = written()
    for path in EXAMPLES:
        page = pages[f"examples/{path.stem}.md"]
        assert f"({'../' * 2}gallery/{path.stem}.png)" in page
        assert (GALLERY / f"{path.stem}.txt").read_text("utf-8") in page


def test_no_picture_is_left_of_a_removed_example() -> None:
    assert {path.stem for path in GALLERY.iterdir()} == {path.stem for path in EXAMPLES}


def test_every_public_name_is_explained_once() -> None:
    names = [(name, n) for name, package in packages().items() for n in package.__all__]
    assert set(homes()) == set(names)
    assert homes()["tribodyn.study", "Case"] == homes()["tribodyn", "Case"] == "tribodyn.Case"
    assert homes()["tribodyn.analysis", "rms"] == "tribodyn.analysis.rms"


def test_names_of_the_package_that_the_pages_mention_are_there() -> None:
    import tribodyn as td

    for page in PAGES:
        for name in re.findall(r"`td\.(\w+)", page.read_text("utf-8")):
            assert hasattr(td, name), f"{page.name}: td.{name}"


def test_texts_are_compared_without_numbers_and_places() -> None:
    text = masked("rms  3.2e-05 N\nfiles in here/report: a.html\n")
    assert text == masked("rms 4 N\nfiles in elsewhere/report: a.html")
    assert text != masked("rms 4 m\nfiles in elsewhere/report: a.html")


def test_llms_file_lists_recipes_pages_and_examples_that_exist() -> None:
    text = llms_text()
    assert text.startswith("# tribodyn\n\n> ")
    linked = re.findall(r"\]\(([\w/-]+)\.html\)", text)
    sources = [name for name in linked if not name.startswith("_generated")]
    assert all((ROOT / "docs" / f"{name}.md").is_file() for name in sources)
    assert {f"_generated/examples/{path.stem}" for path in EXAMPLES} <= set(linked)
    assert set(re.findall(r"\]\(([\w-]+)\.md\)", INDEX.partition("## Conventions")[0])) <= set(
        linked
    )
    assert sum(name.startswith("cookbook/") for name in linked) >= 25
