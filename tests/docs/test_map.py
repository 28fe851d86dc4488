"""Tests that docs/README.md lists every page and that no link in the docs is broken."""

import re

from tests.docs.markdown import DOCS, MAP, REPOSITORY, Page, pages

PARTS = ["Start", "Run a study", "Analyse", "Write studies", "Operate and build"]
# One screen: what it is, a picture, two commands, the first study, the link to the map.
SCREEN = 50


def test_the_map_has_its_five_parts() -> None:
    """The map has its five parts, named after tasks."""
    assert [line[3:] for line in Page(MAP).lines if line.startswith("## ")] == PARTS


def test_every_page_is_on_the_map_with_a_sentence() -> None:
    """Each page of docs/ is on the map once with a sentence; decisions have a separate list."""
    entries = [line for line in Page(MAP).lines if line.startswith("- ")]
    targets = [re.match(r"- \[[^\]]+\]\(([^)]+)\): \S.{15,}\.$", entry) for entry in entries]
    assert [entry for entry, found in zip(entries, targets, strict=True) if not found] == []
    named = [(DOCS / found[1]).resolve() for found in targets if found]
    assert len(named) == len(set(named)), "a page is on the map twice"
    there = {path for path in DOCS.glob("*.md") if path != MAP} | {DOCS / "decisions" / "README.md"}
    there |= {REPOSITORY / "CONTRIBUTING.md", REPOSITORY / "study_configs" / "README.md"}
    assert sorted(there - set(named)) == []


def test_every_decision_is_on_the_list_of_decisions() -> None:
    """Every decision record is on the list of decisions."""
    index = Page(DOCS / "decisions" / "README.md")
    listed = {found[0] for _, target in index.links if (found := index.file_of(target))}
    assert sorted(set((DOCS / "decisions").glob("*.md")) - listed - {index.path}) == []


def test_no_link_is_broken() -> None:
    """Every relative link names a file of the repository, and every anchor an existing heading."""
    anchors = {page.path: page.anchors for page in pages()}
    broken = []
    for page in pages():
        for number, target in page.links:
            found = page.file_of(target)
            if found is None:
                continue
            file, fragment = found
            missing = fragment and file in anchors and fragment not in anchors[file]
            if not file.exists() or not file.is_relative_to(REPOSITORY) or missing:
                broken.append(f"{page.name}:{number}: {target}")
    assert broken == []


def test_every_picture_is_shown_somewhere() -> None:
    """Every picture in docs/ is shown on a page."""
    shown = {
        found[0]
        for page in pages()
        for _, target in page.links
        if (found := page.file_of(target)) and found[0].suffix == ".png"
    }
    assert sorted(set((DOCS / "images").rglob("*.png")) - shown) == []


def test_the_front_page_is_one_screen() -> None:
    """README.md fits on one screen and links to every part of the map."""
    front = Page(REPOSITORY / "README.md")
    assert len(front.path.read_text(encoding="utf-8").splitlines()) <= SCREEN
    assert {f"docs/README.md#{part.lower().replace(' ', '-')}" for part in PARTS} <= {
        target for _, target in front.links
    }
