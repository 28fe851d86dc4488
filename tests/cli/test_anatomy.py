"""Tests that the pages' tables of the body are the server's."""

from app.cli.anatomy import TARGET, anatomy
from tests.architecture.trees import REPOSITORY


def test_the_tables_of_the_body_are_up_to_date() -> None:
    """The pages' generated tables of parts, axes, layers and lengths are those of the server."""
    assert (REPOSITORY / TARGET).read_text(encoding="utf-8") == anatomy()
