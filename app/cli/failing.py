"""How a command says that it cannot go on."""

import sys
from typing import NoReturn

import typer

UNUSABLE = 2


def fail(message: str) -> NoReturn:
    """Say what is wrong and leave with the status for unusable input."""
    print(f"reembody: {message}", file=sys.stderr)
    raise typer.Exit(UNUSABLE)
