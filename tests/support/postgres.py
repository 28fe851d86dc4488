"""A real PostgreSQL for the tests: one cluster for a test run, one database for each test.

The first test that needs the cluster starts it, in whichever xdist worker it runs; the others join
it. A template database is migrated once and each test gets a copy of it, which is much faster than
a migration. The cluster listens only on a unix socket in a private folder.
"""

import json
import os
import signal
import sys
import time
import uuid
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import LiteralString

import psycopg
from psycopg import sql

from tests.support.postgres_binaries import Account, runnable_binaries
from tests.support.postgres_cleaning import emptied
from tests.support.shared_run import once, owner_pid, run_folder
from tests.support.unit_tests import needs

STARTS_WITHIN_S = 60.0
STOPS_WITHIN_S = 30.0
TEMPLATE = "migrated"
# A test database need not survive a power loss, and syncing would take most of its time.
SETTINGS = {
    "fsync": "off",
    "full_page_writes": "off",
    "synchronous_commit": "off",
    "max_connections": "100",
    "shared_buffers": "64MB",
    # Compiling a query about the schema takes longer than answering it.
    "jit": "off",
    "listen_addresses": "",
    "timezone": "UTC",
}


@dataclass(frozen=True)
class Cluster:
    """A running PostgreSQL; `folder` contains its socket, its data and its log."""

    folder: Path

    def url(self, database: str) -> str:
        """Return the URL of a database for SQLAlchemy."""
        return f"postgresql+psycopg://postgres@/{database}?host={self.folder}"

    def execute(self, statement: LiteralString, *databases: str) -> None:
        """Run a statement outside any transaction; each `{}` becomes the name of a database."""
        query = sql.SQL(statement).format(*map(sql.Identifier, databases))
        with psycopg.connect(
            host=str(self.folder), user="postgres", dbname="postgres", autocommit=True
        ) as connection:
            connection.execute(query)


@contextmanager
def fresh_postgres() -> Iterator[str]:
    """Yield the URL of a migrated, empty database that nothing else uses meanwhile.

    Copying the template takes a quarter of a second, so the database is emptied afterwards and
    reused, unless a test left it different from a fresh one.
    """
    cluster = migrated_cluster()
    database = _renamed(cluster, _idle.pop()) if _idle else _copied(cluster)
    try:
        yield cluster.url(database)
    finally:
        if is_like_new(cluster, database):
            _idle.append(database)
        else:
            cluster.execute("DROP DATABASE {} WITH (FORCE)", database)


_idle: list[str] = []
"""Databases of this process that are like new."""


def _renamed(cluster: Cluster, database: str) -> str:
    """Rename a database: the product caches data about a database by its URL."""
    name = _new_name()
    cluster.execute("ALTER DATABASE {} RENAME TO {}", database, name)
    return name


def _new_name() -> str:
    return f"test_{uuid.uuid4().hex}"


def _copied(cluster: Cluster) -> str:
    database = _new_name()
    cluster.execute(f"CREATE DATABASE {{}} TEMPLATE {TEMPLATE}", database)
    return database


def is_like_new(cluster: Cluster, database: str) -> bool:
    """Empty a database and return whether it then equals the template."""
    return emptied(cluster.folder, database) == _template_marks(cluster)


@lru_cache
def _template_marks(cluster: Cluster) -> str | None:
    """Return the marks of a copy of the template, because the template allows no connections."""
    database = _copied(cluster)
    try:
        return emptied(cluster.folder, database)
    finally:
        cluster.execute("DROP DATABASE {} WITH (FORCE)", database)


def migrated_cluster() -> Cluster:
    """Return the cluster of this run with its migrated template; the first caller starts it."""
    cluster = running_cluster()
    with once("postgres-template") as mark:
        if mark:
            from app.schema_revisions import migrate

            cluster.execute("CREATE DATABASE {}", TEMPLATE)
            migrate(cluster.url(TEMPLATE))
            # A template can be copied only while it has no connections. No test has a database
            # yet, so any remaining connection comes from the migration.
            cluster.execute("ALTER DATABASE {} ALLOW_CONNECTIONS false", TEMPLATE)
            cluster.execute(
                "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
                "WHERE datname IS NOT NULL AND pid <> pg_backend_pid()"
            )
            mark.touch()
    return cluster


def running_cluster() -> Cluster:
    """Return the cluster of this run, without a template or test databases."""
    needs("PostgreSQL")
    folder = run_folder() / "postgres"
    with once("postgres") as mark:
        if mark:
            keeper_pid = start_keeper(folder, SETTINGS)
            mark.write_text(json.dumps({"keeper_pid": keeper_pid}))
    return Cluster(folder)


def stop_cluster() -> None:
    """Stop the cluster of this run if there is one; the controller calls it last."""
    mark = run_folder() / "postgres.done"
    if mark.exists():
        stop_keeper(json.loads(mark.read_text())["keeper_pid"], run_folder() / "postgres")


def stop_keeper(keeper_pid: int, folder: Path) -> None:
    """Stop the cluster in `folder` through its keeper."""
    try:
        os.kill(keeper_pid, signal.SIGTERM)
    except ProcessLookupError:
        return
    _wait_for(folder / "stopped", STOPS_WITHIN_S)


def start_keeper(folder: Path, settings: Mapping[str, str]) -> int:
    """Create and start a cluster in `folder`; return the pid of its keeper, PostgreSQL's parent."""
    account = Account.for_postgres()
    folder.mkdir(mode=0o700)
    programs = folder / "programs"
    programs.mkdir()
    account.own(folder)
    binaries = runnable_binaries(account, programs)
    data = folder / "data"
    made = account.run(
        [
            str(binaries / "initdb"),
            *("--pgdata", str(data), "--username", "postgres", "--auth", "trust"),
            *("--encoding", "UTF8", "--locale", "C", "--no-sync"),
        ],
        cwd=folder,
    )
    if made.returncode != 0:
        raise RuntimeError(f"initdb from {binaries} failed:\n{made.stdout}{made.stderr}")
    options = [f"--{name}={value}" for name, value in settings.items()]
    server = [str(binaries / "postgres"), "-D", str(data), "-k", str(folder), *options]
    keeper = [str(owner_pid()), str(account.uid), str(account.gid), str(folder), *server]
    script = Path(__file__).with_name("postgres_keeper.py")
    # In a session of its own, so that Ctrl-C reaches the tests and not their database.
    pid = os.posix_spawn(
        sys.executable,
        [sys.executable, "-P", str(script), *keeper],
        os.environ,
        setsid=True,
    )
    _wait_until_it_answers(Cluster(folder))
    return pid


def _wait_until_it_answers(cluster: Cluster) -> None:
    deadline = time.monotonic() + STARTS_WITHIN_S
    while True:
        try:
            cluster.execute("SELECT 1")
        except psycopg.OperationalError:
            stopped = (cluster.folder / "stopped").exists()
            if stopped or time.monotonic() > deadline:
                log = (cluster.folder / "postgres.log").read_text(errors="replace")
                raise RuntimeError(f"PostgreSQL did not start; its log:\n{log[-2000:]}") from None
            time.sleep(0.05)
        else:
            return


def _wait_for(path: Path, timeout_s: float) -> None:
    deadline = time.monotonic() + timeout_s
    while not path.exists() and time.monotonic() < deadline:
        time.sleep(0.05)
