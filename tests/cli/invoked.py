"""Run one command of `reembody` in this process as from a shell."""

import json
from dataclasses import dataclass
from typing import Any

from typer.testing import CliRunner, Result

from app.cli.commands import app
from app.cli.errors import UNUSABLE


@dataclass(frozen=True)
class Invoked:
    """The command `name`, which is run with arguments as they would be typed."""

    name: str

    def run(self, *arguments: object) -> Result:
        """Run the command and return its output and exit code."""
        return CliRunner().invoke(app, [self.name, *(str(argument) for argument in arguments)])

    def figures(self, *arguments: object) -> dict[str, Any]:
        """Run the command with `--json` and return its output; it must succeed."""
        result = self.run(*arguments, "--json")
        assert result.exit_code == 0, result.output
        figures = json.loads(result.stdout)
        assert isinstance(figures, dict)
        return figures

    def refusal(self, *arguments: object) -> str:
        """Run the command, which must refuse without standard output, and return its error."""
        result = self.run(*arguments)
        assert result.exit_code == UNUSABLE
        assert result.stdout == ""
        return result.stderr
