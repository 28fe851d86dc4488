"""Alembic's environment: migrates politely, with a limit on how long it waits for locks."""

from alembic import context
from sqlalchemy import text

import app.models  # noqa: F401 - registers the tables
from app.database import Base, make_engine

LOCK_TIMEOUT = "10s"


def run() -> None:
    """Migrate the database whose address `alembic_config` put into the attributes."""
    url = context.config.attributes.get("url") or context.config.get_main_option("sqlalchemy.url")
    engine = make_engine(url).execution_options(reembody_writes=True)
    with engine.connect() as connection:
        if connection.dialect.name == "postgresql":
            connection.execute(text(f"SET lock_timeout = '{LOCK_TIMEOUT}'"))
            connection.commit()
        context.configure(
            connection=connection,
            target_metadata=Base.metadata,
            render_as_batch=connection.dialect.name == "sqlite",
            compare_type=True,
            transaction_per_migration=False,
        )
        with context.begin_transaction():
            context.run_migrations()
    engine.dispose()


run()
