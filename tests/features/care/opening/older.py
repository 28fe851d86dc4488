"""Filled databases with older schemas, made once per test run; tests work on copies of them."""

import pickle
from dataclasses import dataclass

import pytest

from app.database import open_database
from tests.faults.bench import Bench, SqliteBench
from tests.faults.interrupted import Found, found, steps, upgrade
from tests.support.filled import fill
from tests.support.shared_run import once, run_folder

NEWEST = steps()[-1][1]
OLDER = [after for _, after in steps()][:-1]
FEW = (OLDER[0], OLDER[len(OLDER) // 2], OLDER[-1])
EACH_OLDER = [
    pytest.param(revision, marks=() if revision in FEW else pytest.mark.long) for revision in OLDER
]
"""Every older revision, as test parameters; a short run uses the first, a middle one and the last,
whose migrations pass through all others."""


@dataclass(frozen=True)
class Older:
    """A database with an older schema.

    Attributes:
        url: its address; tests copy it with `Bench.copy` and must not open it.
        old: its contents and schema.
        new: its contents and schema after the migrations.
    """

    url: str
    old: Found
    new: Found


def older_database(bench: Bench, revision: str) -> Older:
    """Return the database of that revision on the engine of `bench`; make it if it is missing."""
    engine = "sqlite" if isinstance(bench, SqliteBench) else "postgresql"
    with once(f"older-{engine}-{revision}") as mark:
        if mark:
            mark.write_bytes(pickle.dumps(_made(bench, revision)))
    made = (run_folder() / f"older-{engine}-{revision}.done").read_bytes()
    older: Older = pickle.loads(made)  # noqa: S301 - written above
    return older


def _made(bench: Bench, revision: str) -> Older:
    if isinstance(bench, SqliteBench):
        url = f"sqlite:///{run_folder() / f'older-{revision}.sqlite'}"
    else:
        bench.cluster.execute("CREATE DATABASE {} TEMPLATE template0", f"older_{revision}")
        url = bench.cluster.url(f"older_{revision}")
    upgrade(url, revision)
    database = open_database(url)
    fill(database.engine)
    database.close()
    with bench.copy(url) as copy:
        upgrade(copy, NEWEST)
        return Older(url, found(url), found(copy))
