"""A PostgreSQL database that was lent to one test is lent to the next only when it is like new."""

import pytest

from app.database import Database, open_database
from tests.support.filled import contents, fill
from tests.support.postgres import fresh_postgres


def number_of(database: Database) -> int:
    """By which PostgreSQL tells a database, whatever its name."""
    with database.engine.connect() as connection:
        query = "SELECT oid FROM pg_database WHERE datname = current_database()"
        return int(connection.exec_driver_sql(query).scalar_one())


def test_rows_go() -> None:
    """Whoever comes next finds none, though somebody stayed connected, and a name of its own."""
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
def test_a_database_that_differs_is_not_lent_again(change: str) -> None:
    """Neither another schema, nor another revision, nor anything else that is made."""
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
