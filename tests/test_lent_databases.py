"""Tests that a PostgreSQL database is reused for the next test only if it is like new."""

import pytest

from app.database import Database, open_database
from tests.support.filled import contents, fill
from tests.support.postgres import fresh_postgres


def number_of(database: Database) -> int:
    """Return PostgreSQL's number (OID) of a database, which does not depend on its name."""
    with database.engine.connect() as connection:
        query = "SELECT oid FROM pg_database WHERE datname = current_database()"
        return int(connection.exec_driver_sql(query).scalar_one())


def test_a_reused_database_has_no_rows() -> None:
    """A reused database has no rows and a new name, even if a connection stayed open."""
    with fresh_postgres() as first:
        stayed = open_database(first)
        fill(stayed.engine)
        number = number_of(stayed)
    with fresh_postgres() as second:
        assert second != first
        database = open_database(second)
        assert number_of(database) == number
        assert set(map(len, contents(database.engine).values())) == {0}
        database.close()
    stayed.close()


@pytest.mark.parametrize(
    "change",
    [
        "ALTER TABLE sessions ADD COLUMN left_behind INTEGER",
        "CREATE TABLE left_behind (id INTEGER)",
        "DROP INDEX ix_ledgers_study_id",
        "UPDATE alembic_version SET version_num = '0001'",
        "CREATE SEQUENCE left_behind",
    ],
)
def test_a_database_that_differs_is_not_reused(change: str) -> None:
    """A database with another schema, revision or object is not reused."""
    with fresh_postgres() as first:
        database = open_database(first)
        with database.engine.connect() as connection:
            connection.exec_driver_sql(change)
            connection.commit()
        number = number_of(database)
        database.close()
    with fresh_postgres() as second:
        database = open_database(second)
        assert number_of(database) != number
        database.close()
