"""SQLite databases in the state in which a process leaves them on closing or when killed."""

import os
import signal
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

from app.database import open_database
from tests.support.filled import fill
from tests.support.sqlite import fresh_sqlite

KILLED = """
import os, signal, sqlite3, sys
file, page_size, rows = sys.argv[1], sys.argv[2], int(sys.argv[3])
connection = sqlite3.connect(file, isolation_level=None)
connection.execute(f"PRAGMA page_size={page_size}")
connection.execute("PRAGMA journal_mode=WAL")
connection.execute("PRAGMA wal_autocheckpoint=0")
connection.execute("CREATE TABLE IF NOT EXISTS written (number INTEGER, data BLOB)")
for number in range(rows):
    data = os.urandom(100 + 3000 * (number % 4))
    connection.execute("INSERT INTO written VALUES (?, ?)", (number, data))
os.kill(os.getpid(), signal.SIGKILL)
"""
UNDECODABLE = (
    "UPDATE sqlite_master SET sql = CAST(x'435245415445205441424c4520ff' || sql AS TEXT) "
    "WHERE name = 'accounts'"
)
"""SQL that puts invalid UTF-8 into a table definition, which SQLite quotes in errors."""


def filled(file: Path, rows: int = 60) -> Path:
    """Create a closed Reembody database with rows in every table; return its path."""
    opened = open_database(fresh_sqlite(file))
    fill(opened.engine, rows=rows)
    opened.close()
    return file


def killed(file: Path, *, rows: int = 40, page_size: int = 4096) -> Path:
    """Run a process that commits rows and kills itself, which leaves all rows in the WAL."""
    arguments = [sys.executable, "-c", KILLED, str(file), str(page_size), str(rows)]
    assert subprocess.run(arguments, check=False).returncode == -signal.SIGKILL
    return file


def log(file: Path) -> Path:
    """Return the path of a database's write-ahead log."""
    return Path(f"{os.fspath(file)}-wal")


def flip(file: Path, at: int) -> None:
    """Flip the lowest bit of one byte of a file."""
    data = bytearray(file.read_bytes())
    data[at] ^= 1
    file.write_bytes(data)


def edited(file: Path, statement: str) -> None:
    """Execute a statement on a database with SQLite's schema and check protections off."""
    with closing(sqlite3.connect(file, isolation_level=None)) as connection:
        connection.execute("PRAGMA writable_schema=ON")
        connection.execute("PRAGMA ignore_check_constraints=ON")
        connection.execute(statement)
