"""`python -m app.cli` is the `reembody` command."""

from app.cli import main

main()
