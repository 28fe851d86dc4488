"""The manifest of a backup, stored in a separate table of its file."""

import hashlib
import json
import sqlite3
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from app.features.care.backups.digest import TableDigest, overall
from app.features.care.backups.shapes import MANIFEST_TABLE

FORMAT = "reembody-backup/1"


@dataclass(frozen=True)
class Manifest:
    """The time, engine and program version of a backup, and the checksums of its tables.

    `revision`: that of its schema. `engine`: sqlite or postgresql. `tables`: by name.
    """

    made_at: datetime
    product_version: str
    revision: str
    engine: str
    tables: Mapping[str, TableDigest]

    @property
    def rows(self) -> int:
        """Return the total number of rows."""
        return sum(table.rows for table in self.tables.values())

    @property
    def sha256(self) -> str:
        """Return one checksum over all tables: equal for equal content on either engine."""
        return overall(self.revision, self.tables)


class ManifestError(ValueError):
    """The manifest of a backup is missing or invalid."""


def write_manifest(connection: sqlite3.Connection, manifest: Manifest) -> None:
    """Add the manifest to a backup that is being written."""
    tables = {
        name: {"rows": one.rows, "sha256": one.sha256}
        for name, one in sorted(manifest.tables.items())
    }
    entries = {
        "format": FORMAT,
        "made_at": manifest.made_at.isoformat(),
        "product_version": manifest.product_version,
        "schema_revision": manifest.revision,
        "engine": manifest.engine,
        "tables": json.dumps(tables),
        "sha256": manifest.sha256,
    }
    entries["seal"] = _seal(entries)
    connection.execute(
        f"CREATE TABLE {MANIFEST_TABLE} (entry TEXT PRIMARY KEY, value TEXT NOT NULL)"
    )
    connection.executemany(f"INSERT INTO {MANIFEST_TABLE} VALUES (?, ?)", entries.items())  # noqa: S608 - our own table


def read_manifest(connection: sqlite3.Connection) -> Manifest:
    """Return the manifest of a backup; raise ManifestError, or sqlite3.Error if unreadable."""
    try:
        rows = connection.execute(f"SELECT entry, value FROM {MANIFEST_TABLE}").fetchall()  # noqa: S608 - our own table
    except sqlite3.OperationalError as error:
        raise ManifestError("it has no manifest") from error
    entries = {str(entry): str(value) for entry, value in rows}
    if entries.get("format") != FORMAT:
        raise ManifestError(f"its format is {entries.get('format')!r}, not {FORMAT!r}")
    if entries.pop("seal", None) != _seal(entries):
        raise ManifestError("its manifest was altered")
    manifest = _parsed(entries)
    if manifest.sha256 != entries["sha256"]:
        raise ManifestError("its checksum is not that of its tables' checksums")
    return manifest


def _parsed(entries: Mapping[str, str]) -> Manifest:
    tables: dict[str, dict[str, Any]] = json.loads(entries["tables"])
    return Manifest(
        made_at=datetime.fromisoformat(entries["made_at"]),
        product_version=entries["product_version"],
        revision=entries["schema_revision"],
        engine=entries["engine"],
        tables={name: TableDigest(one["rows"], one["sha256"]) for name, one in tables.items()},
    )


def _seal(entries: Mapping[str, str]) -> str:
    """Return a checksum over the entries, which protects against damage, not against forgery."""
    return hashlib.sha256(json.dumps(sorted(entries.items())).encode()).hexdigest()
