"""Where the data of a laboratory stand on disk."""

from pathlib import Path

from sqlalchemy import make_url

from app.settings import Settings


def database_file(settings: Settings) -> Path | None:
    """The embedded database's file; None for PostgreSQL, and for one in memory."""
    url = make_url(settings.resolved_database_url)
    if url.get_backend_name() != "sqlite" or url.database in (None, "", ":memory:"):
        return None
    return Path(str(url.database))


def home_of(settings: Settings) -> Path:
    """The folder of what belongs to the database: that of its file, else the data folder."""
    file = database_file(settings)
    return (settings.data_dir if file is None else file.parent).absolute()


def backups_of(settings: Settings) -> Path:
    """The folder for backups that are made without being asked for."""
    return home_of(settings) / "backups"
