"""Store how people reach as a file: the tables of its reaches, and how it was fitted.

The file is an archive that notices damage (`hashed_archive`). It contains maps, dependencies and
durations, but no paths of hands; it names the people as their recordings did. The blended space and
people's levels are not stored, because tables and seed reproduce them.
"""

from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Final

from app.adapters.hashed_archive import ArchiveKind
from app.adapters.map_tables import TABLES, database_from, header_of, tables_of
from app.science.reaching import (
    FittedReaching,
    ReachFitOptions,
    ReachingError,
    ReachRules,
    restored_reaching,
)
from app.science.walking.maps import SuitabilityOptions

_KIND: Final = ArchiveKind(
    "reembody-reaching", 1, TABLES, "a file of how people reach", "./run reach fit", ReachingError
)


def write_reaching(path: Path, fit: FittedReaching) -> FittedReaching:
    """Write a model atomically, and return it with its content hash; raise OSError."""
    digest = _KIND.write(path, _header(fit), tables_of(fit.database))
    return replace(fit, content_hash=digest)


def is_reaching(path: Path) -> bool:
    """Return whether a file is such a model, of any version; raise OSError."""
    return _KIND.is_one(path)


def read_reaching(path: Path) -> FittedReaching:
    """Read a model; it draws the same people and movements as the one that was written.

    Raises:
        ReachingError: the file is not such a model, of a later version, or damaged.
        OSError: it cannot be opened.
    """
    header, tables, digest = _KIND.read(path)
    try:
        return _fit_of(header, tables, digest)
    except (LookupError, TypeError, AttributeError) as error:
        raise ReachingError(f"{path}: incomplete ({error}); fit it again.") from error


def _header(fit: FittedReaching) -> dict[str, Any]:
    return {
        **header_of(fit.database),
        "rules": asdict(fit.rules),
        "options": asdict(fit.options),
        "reading": asdict(fit.reading),
    }


def _fit_of(header: dict[str, Any], tables: dict[str, Any], digest: str) -> FittedReaching:
    return restored_reaching(
        database_from(header, tables),
        ReachRules(**header["rules"]),
        ReachFitOptions(**header["options"]),
        SuitabilityOptions(**header["reading"]),
        digest,
    )
