"""One command of `reembody`, run in this process as from a shell."""

import json
from dataclasses import dataclass
from typing import Any

from typer.testing import CliRunner, Result

from app.cli.commands import app
from app.cli.errors import UNUSABLE


@dataclass(frozen=True)
class Invoked:
    """The command `name`; arguments are given as they would be typed."""

    name: str

    def run(self, *arguments: object) -> Result:
        """What it says and how it ends."""
        return CliRunner().invoke(app, [self.name, *(str(argument) for argument in arguments)])

    def figures(self, *arguments: object) -> dict[str, Any]:
        """What it tells as JSON; it must end well."""
        result = self.run(*arguments, "--json")
        assert result.exit_code == 0, result.output
        figures = json.loads(result.stdout)
        assert isinstance(figures, dict)
        return figures

    def refusal(self, *arguments: object) -> str:
        """Why it refuses, with nothing on standard output."""
        result = self.run(*arguments)
        assert result.exit_code == UNUSABLE
        assert result.stdout == ""
        return result.stderr
