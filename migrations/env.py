"""Alembic's environment: all migrations in one transaction, with a limit on waiting for locks.

If it is interrupted, the previous schema is intact. Alembic assumes that SQLite cannot roll back
schema changes, because Python's driver used to commit before such statements; here `app.database`
controls transactions, so it can.
"""

from typing import Any

from alembic import context
from sqlalchemy import Connection, Engine, text

import app.models  # noqa: F401 - registers the tables
from app.database import Base, make_engine

LOCK_TIMEOUT = "10s"


def run() -> None:
    """Migrate the database at the address that `alembic_config` put into the attributes.

    An `engine` given there is used instead, and left open: an in-memory database would be lost with
    it.
    """
    attributes = context.config.attributes
    url: Any = attributes.get("url") or context.config.get_main_option("sqlalchemy.url")
    given: Engine | None = attributes.get("engine")
    engine = (given or make_engine(url)).execution_options(reembody_writes=True)
    applied: list[str] = []
    try:
        with engine.connect() as connection:
            _prepare(connection)
            context.configure(
                connection=connection,
                target_metadata=Base.metadata,
                render_as_batch=connection.dialect.name == "sqlite",
                compare_type=True,
                transactional_ddl=True,
                transaction_per_migration=False,
                on_version_apply=lambda step, **_: applied.append(step.up_revision_id),
            )
            with context.begin_transaction():
                context.run_migrations()
                if applied and connection.dialect.name == "sqlite":
                    _check_references(connection)
    finally:
        if given is None:
            engine.dispose()


def _prepare(connection: Connection) -> None:
    if connection.dialect.name == "postgresql":
        connection.execute(text(f"SET lock_timeout = '{LOCK_TIMEOUT}'"))
        connection.commit()
    elif connection.dialect.name == "sqlite":
        # On SQLite, altering a table means recreating it: dropping the old one must not count as
        # deleting referenced rows. This can only be set outside a transaction.
        connection.connection.cursor().execute("PRAGMA foreign_keys=OFF")


def _check_references(connection: Connection) -> None:
    broken = connection.execute(text("PRAGMA foreign_key_check")).all()
    if broken:
        raise RuntimeError(f"migrating left rows that refer to nothing: {broken[:5]}")


run()
