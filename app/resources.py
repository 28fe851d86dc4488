"""Locate the files that are read but not imported: migrations, studies, bodies, built pages.

A checkout has migrations and study configs, bodies among them, in top-level folders, where people
look for them. A wheel has no top level of its own, so the build puts copies under `app/_bundled/`.
The built pages are in `app/static/` in both.
"""

from pathlib import Path

_APP = Path(__file__).resolve().parent


def migrations_dir() -> Path:
    """Return the Alembic folder, with `env.py` and `versions/`."""
    return _shipped("migrations")


def study_configs_dir() -> Path:
    """Return the folder of the shipped studies, instruments and bodies."""
    return _shipped("study_configs")


def bodies_dir() -> Path:
    """Return the folder of the shipped bodies, as models with their measures."""
    return study_configs_dir() / "bodies"


def static_dir() -> Path:
    """Return the folder of the built pages; it does not exist until the frontend was built once."""
    return _APP / "static"


def _shipped(name: str) -> Path:
    bundled = _APP / "_bundled" / name
    return bundled if bundled.is_dir() else _APP.parent / name
