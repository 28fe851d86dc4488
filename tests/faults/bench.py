"""Many databases that are all alike, on either engine: copies of one that was made once."""

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
    """Files in a folder."""

    folder: Path

    @contextmanager
    def empty(self) -> Iterator[str]:
        """The address of a database that is not there yet."""
        yield f"sqlite:///{self.folder / uuid.uuid4().hex}.sqlite"

    @contextmanager
    def copy(self, url: str) -> Iterator[str]:
        """A copy of a database that nobody has open."""
        with self.empty() as copy:
            shutil.copyfile(url.removeprefix("sqlite:///"), copy.removeprefix("sqlite:///"))
            yield copy


@dataclass(frozen=True)
class PostgresBench:
    """Databases of a cluster, dropped after use."""

    cluster: Cluster

    @contextmanager
    def empty(self) -> Iterator[str]:
        """The address of a database without tables."""
        with self._made("template0") as url:
            yield url

    @contextmanager
    def copy(self, url: str) -> Iterator[str]:
        """A copy of a database that nobody is connected to."""
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
    """The database in `postgresql+psycopg://postgres@/NAME?host=...`."""
    return url.partition("?")[0].rpartition("/")[2]
