"""A test of the command's version."""

from typer.testing import CliRunner

from app import __version__
from app.cli.commands import app


def test_the_version_is_printed() -> None:
    """`reembody --version` prints only the version."""
    result = CliRunner().invoke(app, ["--version"])
    assert (result.exit_code, result.output) == (0, f"reembody {__version__}\n")
