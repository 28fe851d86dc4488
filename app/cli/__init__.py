"""The `reembody` command."""

from app.collecting import start_unhurried

start_unhurried()

from app.cli.commands import app as main  # noqa: E402 - what it loads is why

__all__ = ["main"]
