"""Alembic's environment: all steps in one transaction, with a limit on how long it waits for locks.

Whoever is interrupted finds the schema from before, whole. Alembic believes that SQLite cannot undo
a changed schema, because Python's driver used to commit before such statements; ours leaves
transactions to `app.database`, so it can.
"""

from typing import Any

from alembic import context
from sqlalchemy import Connection, Engine, text

import app.models  # noqa: F401 - registers the tables
from app.database import Base, make_engine

LOCK_TIMEOUT = "10s"


def run() -> None:
    """Migrate the database whose address `alembic_config` put into the attributes.

    An `engine` there is used instead, and left open: what is in memory would be gone with it.
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
        # Changing a table on SQLite is making it anew: dropping the old one must not count as
        # deleting what others refer to. It can only be set outside of a transaction.
        connection.connection.cursor().execute("PRAGMA foreign_keys=OFF")


def _check_references(connection: Connection) -> None:
    broken = connection.execute(text("PRAGMA foreign_key_check")).all()
    if broken:
        raise RuntimeError(f"migrating left rows that refer to nothing: {broken[:5]}")


run()
