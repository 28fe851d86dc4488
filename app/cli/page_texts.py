"""Writes the texts that pages take from the registries: `python -m app.cli.page_texts`.

Run it after a change of any words that stand in Python. `tests/cli/test_page_texts.py` fails while
the generated file is out of date.
"""

import sys
from pathlib import Path

from app.features.record.preflight.checks import check_texts
from app.words import Words, typescript_table

TARGET = "frontend/src/console/i18n/registryTexts.generated.ts"
"""Below the folder of the repository."""
COMMAND = "python -m app.cli.page_texts"


def texts() -> dict[str, Words]:
    """Every text of every registry, by its key in the pages; raises ValueError for a key twice."""
    found: dict[str, Words] = {}
    for registry in (check_texts(),):
        if twice := found.keys() & registry.keys():
            raise ValueError(
                f"The texts {sorted(twice)} stand in two registries; give one of them another key."
            )
        found |= registry
    return found


def page_texts() -> str:
    """The whole file."""
    about = "Words of what the server's registries hold."
    return typescript_table(texts(), name="registry", about=about, command=COMMAND)


def main() -> None:
    """Write the file below the working directory."""
    Path(TARGET).write_text(page_texts(), encoding="utf-8")
    sys.stdout.write(f"{TARGET}\n")


if __name__ == "__main__":
    main()
