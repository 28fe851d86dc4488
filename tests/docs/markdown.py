"""Parse the repository's Markdown as GitHub does, as far as tests need it.

A page's text is its lines outside fenced and indented code; headings give anchors by GitHub's rule;
links are relative, absolute or within the page.
"""

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from urllib.parse import unquote

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "docs"
MAP = DOCS / "README.md"

FENCE = re.compile(r"^ {0,3}```(?P<language>[\w-]*)[^`]*$")
HEADING = re.compile(r"^(?P<hashes>#{1,6}) +(?P<text>.+?)\s*$")
LINK = re.compile(r"!?\[(?P<text>(?:[^\[\]]|\[[^\]]*\])*)\]\((?P<target>[^()\s]+)\)")
CODE_SPAN = re.compile(r"`[^`]*`")


@dataclass(frozen=True)
class Code:
    """A block of code: its language ("" if it has none), its text, and its first line number."""

    language: str
    text: str
    line: int


@dataclass(frozen=True)
class Page:
    """One Markdown file of the repository."""

    path: Path

    @property
    def name(self) -> str:
        """Return the page's path in the repository."""
        return self.path.relative_to(REPOSITORY).as_posix()

    @cached_property
    def _parts(self) -> tuple[tuple[str, ...], tuple[Code, ...]]:
        return _split(self.path.read_text(encoding="utf-8").splitlines())

    @property
    def lines(self) -> tuple[str, ...]:
        """Return the page's lines, with code replaced by empty lines."""
        return self._parts[0]

    @property
    def code(self) -> tuple[Code, ...]:
        """Return the page's blocks of code, fenced and indented."""
        return self._parts[1]

    @cached_property
    def anchors(self) -> frozenset[str]:
        """Return the anchors that a link may name after `#`: one for each heading."""
        seen: dict[str, int] = {}
        found = set()
        for line in self.lines:
            if not (heading := HEADING.match(line)):
                continue
            slug = anchor(heading["text"])
            number = seen.get(slug, 0)
            seen[slug] = number + 1
            found.add(f"{slug}-{number}" if number else slug)
        return frozenset(found)

    @cached_property
    def links(self) -> tuple[tuple[int, str], ...]:
        """Return the line number and target of every link and picture."""
        return tuple(
            (number, link["target"])
            for number, line in enumerate(self.lines, 1)
            for link in LINK.finditer(CODE_SPAN.sub("`code`", line))
        )

    def file_of(self, target: str) -> tuple[Path, str] | None:
        """Return the file and anchor that a link leads to; None if it leaves the repository."""
        if re.match(r"[a-z][a-z0-9+.-]*:", target):
            return None
        place, _, fragment = unquote(target).partition("#")
        return (self.path.parent / place).resolve() if place else self.path, fragment


def anchor(heading: str) -> str:
    """Return GitHub's anchor of a heading: lower case, no punctuation, spaces as hyphens."""
    text = LINK.sub(lambda link: link["text"], heading)
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


def pages() -> list[Page]:
    """Return README, CONTRIBUTING, the guide to writing a study, and everything in docs/."""
    front = [REPOSITORY / name for name in ("README.md", "CONTRIBUTING.md")]
    front.append(REPOSITORY / "study_configs" / "README.md")
    return [Page(path) for path in [*front, *sorted(DOCS.rglob("*.md"))]]


def _split(lines: list[str]) -> tuple[tuple[str, ...], tuple[Code, ...]]:
    """Return the text with code blanked out, and the blocks of code."""
    text: list[str] = []
    blocks: list[Code] = []
    block: list[str] | None = None
    language, start, fenced = "", 0, False
    for number, line in enumerate([*lines, ""], 1):
        is_fence = FENCE.match(line)
        indented = line.startswith("    ") and line.strip()
        if block is not None and fenced:
            if is_fence:
                blocks.append(Code(language, "\n".join(block), start))
                block = None
            else:
                block.append(line)
            text.append("")
        elif block is not None and indented:
            block.append(line[4:])
            text.append("")
        else:
            if block is not None:
                blocks.append(Code("", "\n".join(block), start))
                block = None
            if is_fence:
                block, language, start, fenced = [], is_fence["language"], number + 1, True
                text.append("")
            elif indented and not (text and text[-1].strip()):
                # Indented code cannot interrupt a paragraph: that is a wrapped line.
                block, start, fenced = [line[4:]], number, False
                text.append("")
            else:
                text.append(line)
    return tuple(text[: len(lines)]), tuple(blocks)
