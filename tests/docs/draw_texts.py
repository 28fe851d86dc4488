"""Draw a random sample of the product's English, to be judged by a reader who wrote none of it.

`python -m tests.docs.draw_texts [COMMIT]` prints a hundred texts of the pages (with their German
versions) and a hundred docstrings of `app` and `tests`. The commit's hash is the seed, so that a
sample can be reproduced and nobody can choose it; without a commit the seed is HEAD's hash, and the
texts are drawn from the working tree.
"""

# ruff: noqa: T201  # what it prints is what it is for

import ast
import json
import random
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.architecture.trees import REPOSITORY, tree_of

SAMPLE = 100
FEWEST_WORDS = 3
"""Shorter texts are labels: a name rather than a sentence."""
TABLE = re.compile(
    r"^(?:export )?const (?P<name>\w*?)(?P<language>En|De|en|de)\b[^=\n]*= \{\n(?P<body>.*?)^\}",
    re.M | re.S,
)
ENTRY = re.compile(r'^\s+"?(?P<key>[\w.-]+)"?:\s*(?P<text>"(?:[^"\\]|\\.)*")', re.M)


@dataclass(frozen=True)
class Text:
    """A text, its place, and its German version if there is one."""

    place: str
    english: str
    german: str = ""


def page_texts(root: Path) -> list[Text]:
    """Return every text of the pages' tables of at least `FEWEST_WORDS` words, in file order."""
    return [
        Text(f"{file} {key}", english, german)
        for file, key, english, german in _entries(root)
        if len(english.split()) >= FEWEST_WORDS
    ]


def docstrings(root: Path) -> list[Text]:
    """Return every docstring of `app` and `tests`, in file order."""
    found = []
    for folder in ("app", "tests"):
        for path in sorted((root / folder).rglob("*.py")):
            if not {"static", "__pycache__"}.intersection(path.parts):
                for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                    if isinstance(
                        node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
                    ):
                        text = ast.get_docstring(node)
                        name = getattr(node, "name", "the module")
                        if text:
                            place = f"{path.relative_to(root).as_posix()} {name}"
                            found.append(Text(place, text))
    return found


def drawn(texts: list[Text], seed: str) -> list[Text]:
    """Return `SAMPLE` of the texts; the same seed gives the same ones."""
    # Anybody must be able to draw the sample again, so it is not a secret.
    generator = random.Random(seed)  # noqa: S311 - reproducible, not secret
    chosen = generator.sample(range(len(texts)), min(SAMPLE, len(texts)))
    return [texts[at] for at in chosen]


def _entries(root: Path) -> Iterator[tuple[str, str, str, str]]:
    """Yield file, key, English and German of every text of the pages."""
    german: dict[str, str] = {}
    english: list[tuple[str, str, str]] = []
    for path in sorted((root / "frontend/src").rglob("*.ts")):
        app = path.relative_to(root / "frontend/src").parts[0]
        for table in TABLE.finditer(path.read_text(encoding="utf-8")):
            for entry in ENTRY.finditer(table["body"]):
                text = json.loads(entry["text"])
                if table["language"].lower() == "de":
                    german[f"{app} {entry['key']}"] = text
                else:
                    english.append((path.relative_to(root).as_posix(), entry["key"], text))
    for file, key, text in english:
        app = Path(file).parts[2]
        yield file, key, text, german.get(f"{app} {key}", "")


def main(arguments: list[str]) -> int:
    """Print the sample; return the exit code."""
    commit = arguments[0] if arguments else None
    seed = subprocess.run(
        ["git", "rev-parse", commit or "HEAD"],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()
    print(f"seed {seed}")
    with tree_of(commit) as root:
        for title, texts in (("page texts", page_texts(root)), ("docstrings", docstrings(root))):
            print(f"\n{title}: {SAMPLE} of {len(texts)}\n")
            for number, text in enumerate(drawn(texts, seed), start=1):
                print(f"{number}. {text.place}\n{text.english}")
                if text.german:
                    print(f"[de] {text.german}")
                print()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
