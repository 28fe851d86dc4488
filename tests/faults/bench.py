"""Make identical databases on SQLite or PostgreSQL by copying a template database."""

import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import LiteralString

import psycopg
from psycopg import sql

from tests.support.postgres import Cluster


@dataclass(frozen=True)
class SqliteBench:
    """Create SQLite databases as files in a folder."""

    folder: Path

    @contextmanager
    def empty(self) -> Iterator[str]:
        """Yield the URL of a database file that does not exist yet."""
        yield f"sqlite:///{self.folder / uuid.uuid4().hex}.sqlite"

    @contextmanager
    def copy(self, url: str) -> Iterator[str]:
        """Yield the URL of a copy of a database that has no open connections."""
        with self.empty() as copy:
            shutil.copyfile(url.removeprefix("sqlite:///"), copy.removeprefix("sqlite:///"))
            yield copy


@dataclass(frozen=True)
class PostgresBench:
    """Create databases in a PostgreSQL cluster and drop them after use."""

    cluster: Cluster

    @contextmanager
    def empty(self) -> Iterator[str]:
        """Yield the URL of a new database without tables."""
        with self._made("template0") as url:
            yield url

    @contextmanager
    def copy(self, url: str) -> Iterator[str]:
        """Yield the URL of a copy of a database that has no open connections."""
        with self._made(_name(url)) as copy:
            yield copy

    @contextmanager
    def _made(self, template: str) -> Iterator[str]:
        name = f"bench_{uuid.uuid4().hex}"
        self._execute("CREATE DATABASE {} TEMPLATE {}", name, template)
        try:
            yield self.cluster.url(name)
        finally:
            self._execute("DROP DATABASE {} WITH (FORCE)", name)

    def _execute(self, statement: LiteralString, *names: str) -> None:
        query = sql.SQL(statement).format(*map(sql.Identifier, names))
        folder = str(self.cluster.folder)
        with psycopg.connect(
            host=folder, user="postgres", dbname="postgres", autocommit=True
        ) as connection:
            connection.execute(query)


Bench = SqliteBench | PostgresBench


def _name(url: str) -> str:
    """Return NAME from a URL of the form `postgresql+psycopg://postgres@/NAME?host=...`."""
    return url.partition("?")[0].rpartition("/")[2]
