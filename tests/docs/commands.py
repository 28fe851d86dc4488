"""Find every command line in the docs, in blocks of code and in sentences.

`python -m tests.docs.commands` lists them with the treatment of each in
tests/docs/test_commands.py.
"""

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from tests.docs.markdown import Page, pages

SETTINGS = r"(?:[A-Z_]+=(?:'[^']*'|\S+) +)*"
"""Variables that are set for one command."""
PROGRAM = r"(?:\./run|reembody|curl|python -m|npm|adb|cd \S+ && \S+|cat [^|]+\|)(?= |$)"
COMMAND = re.compile(rf"^{SETTINGS}{PROGRAM}")
IN_SCRIPT = re.compile(r"(?:^|\$\()(?:\./run|curl) ")
EXPLANATION = re.compile(r"(?: {2,}| +#).*$")
OPTIONAL = re.compile(r" *\[[^\]]*\]")
SPAN = re.compile(r"`([^`]+)`")


class Fate(StrEnum):
    """How a test treats a command of a block."""

    RUN = "runs"
    SCRIPT = "runs in tests/docs/test_scripting_page.py"
    LONG = "runs in the long form"
    NOT_RUN = "is not run"


@dataclass(frozen=True)
class Command:
    """One command line of a page, without explanations and optional parts.

    `script`: it is part of a block that is a script and runs as a whole.
    """

    page: str
    line: int
    text: str
    script: bool = False

    @property
    def fate(self) -> Fate:
        """Return how a test treats the command."""
        if self.script:
            return Fate.SCRIPT
        if any(re.search(pattern, self.text) for pattern in NOT_RUN):
            return Fate.NOT_RUN
        return Fate.LONG if any(re.search(pattern, self.text) for pattern in LONG) else Fate.RUN

    @property
    def settings(self) -> dict[str, str]:
        """Return the environment variables that the command line sets."""
        return dict(word.split("=", 1) for word in self._words[: self._program])

    @property
    def words(self) -> list[str]:
        """Return the program and its arguments, without redirections."""
        return _without_redirection(self._words[self._program :])

    @property
    def _words(self) -> list[str]:
        return shlex.split(self.text)

    @property
    def _program(self) -> int:
        settings = re.match(SETTINGS, self.text)
        return len(shlex.split(settings[0])) if settings else 0


NOT_RUN = {
    r"^\./run (test|check)\b": "it would run every test, this one too; its paths and options are "
    "checked instead",
    r"^\./run bench\b": "it measures for minutes; its name and options are checked instead",
    r"^cd frontend && npm run": "it serves pages until it is stopped; the script's name is checked "
    "instead",
    r"^python -m tests\.architecture walks": "it takes the product through four walks, as "
    "tests/architecture/test_walks.py does",
    r"^adb ": "it needs a headset on a cable",
}
"""Commands that no test can run, with the reason."""
LONG = {
    r"^REEMBODY_DATABASE_URL='postgresql:": "it needs a cluster",
    r"^python -m tests\.architecture$": "tests/architecture measures the same",
}
"""Commands that run in the long form, with the reason."""


def commands() -> list[Command]:
    """Return the commands of blocks of code, in the order of the pages."""
    return [command for page in pages() for command in _of_blocks(page)]


def mentions() -> list[Command]:
    """Return the commands in sentences and tables, with placeholders and optional parts."""
    return [
        Command(page.name, number, span.replace("\\|", "|"))
        for page in pages()
        for number, line in enumerate(page.lines, 1)
        for span in SPAN.findall(line)
        if COMMAND.match(span)
    ]


def _of_blocks(page: Page) -> Iterator[Command]:
    for block in page.code:
        if block.language == "sh":
            for at, line in enumerate(block.text.splitlines(), block.line):
                if IN_SCRIPT.search(line):
                    yield Command(page.name, at, line, script=True)
        elif not block.language:
            yield from _of_lines(page, block.text.splitlines(), block.line)


def _of_lines(page: Page, lines: list[str], start: int) -> Iterator[Command]:
    whole: list[str] = []
    for at, line in enumerate(lines, start):
        whole.append(line.removesuffix("\\").strip())
        if line.endswith("\\"):
            continue
        text = " ".join(whole)
        if COMMAND.match(text):
            text = text if len(whole) > 1 else EXPLANATION.sub("", text)
            yield Command(page.name, at - len(whole) + 1, OPTIONAL.sub("", text))
        whole = []


def _without_redirection(words: list[str]) -> list[str]:
    return words[: words.index(">")] if ">" in words else words


def main() -> None:
    """Print every command with its fate, and the number of commands for each fate."""
    found = commands()
    for command in found:
        print(f"{command.page}:{command.line}: {command.text}\n    {command.fate}")  # noqa: T201
    for fate in Fate:
        print(f"{sum(command.fate is fate for command in found):4} {fate}")  # noqa: T201
    print(f"{len(found):4} in blocks, {len(mentions())} in sentences")  # noqa: T201


if __name__ == "__main__":
    main()
