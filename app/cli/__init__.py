"""The `reembody` command."""

from app.gc_tuning import relax_gc

relax_gc()

from app.cli.commands import app as main  # noqa: E402 - what it loads is why

__all__ = ["main"]
