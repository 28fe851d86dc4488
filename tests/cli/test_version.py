"""The command tells its version."""

from typer.testing import CliRunner

from app import __version__
from app.cli.commands import app


def test_the_version_is_told_and_nothing_else() -> None:
    """`reembody --version`, which `./run --version` hands over; no command is needed."""
    told = CliRunner().invoke(app, ["--version"])
    assert (told.exit_code, told.output) == (0, f"reembody {__version__}\n")
