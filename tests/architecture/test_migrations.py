"""Tests that the migrations and the models describe the same tables."""

from alembic import command

from app.schema_revisions import alembic_config


def test_migrations_match_the_models(database_url: str) -> None:
    """Alembic finds no difference to the models on a migrated database, on either engine."""
    command.check(alembic_config(database_url))
