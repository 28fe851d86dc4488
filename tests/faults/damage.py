"""Damage the files of a real data folder at random and record how a start with it ends.

The folder comes from a server that was killed in the middle of a visit, so its write-ahead log
contains transactions that the database file does not. Each case works on a copy, within the process
that runs it.
"""

import multiprocessing
import shutil
import sys
import traceback
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from io import StringIO
from pathlib import Path
from unittest.mock import patch

import numpy as np
from fastapi.testclient import TestClient
from httpx2 import Response

from app.cli.backups import RestoreOptions, restore_from
from app.cli.progress import Activity
from app.cli.serve.run import why_not
from app.clock import Clock
from app.errors import ReembodyError
from app.features.care.opening import Damaged, prepare_database
from app.main import create_app
from app.settings import Settings
from tests.features.lab import STUDY, ok
from tests.support.server import ADMIN_PASSWORD

DATABASE = "reembody.sqlite"
FILES = (DATABASE, f"{DATABASE}-wal", f"{DATABASE}-shm")
CREDENTIALS = {"username": "admin", "password": ADMIN_PASSWORD}
MOST_FLIPS, MOST_ZEROS = 16, 65_536


@dataclass(frozen=True)
class Folder:
    """The data folder of a killed server, and a backup of nearly all data in it."""

    data: Path
    backup: Path
    sha256: str
    session_id: str


@dataclass(frozen=True)
class Case:
    """The damage done to one copy of the folder, and how the start with it ended.

    `end`: served, quarantined (and a restore brought everything back), refused (with a message, and
    with every file left in place) or traceback. `errors`: responses that a server must not give.
    """

    what: str
    end: str
    said: str = ""
    errors: tuple[str, ...] = ()

    @property
    def has_advice(self) -> bool:
        """Return whether the message says how to recover."""
        return "./run restore FILE" in self.said


def damaged(folder: Path, rng: np.random.Generator) -> str:
    """Flip bits of one file, truncate it or write zeros over a part; describe the damage."""
    file = folder / FILES[rng.integers(len(FILES))]
    data = bytearray(file.read_bytes())
    where = int(rng.integers(len(data)))
    match int(rng.integers(3)):
        case 0:
            places = [where, *rng.integers(len(data), size=int(rng.integers(MOST_FLIPS)))]
            for place in places:
                data[place] ^= 1 << int(rng.integers(8))
            what = f"{len(places)} bits flipped, one at {where}"
        case 1:
            del data[where:]
            what = f"cut at {where}"
        case _:
            length = int(rng.integers(1, MOST_ZEROS))
            data[where : where + length] = bytes(len(data[where : where + length]))
            what = f"{length} zeros from {where}"
    file.write_bytes(data)
    return f"{file.name}: {what}"


def tried(folder: Folder, to: Path, rng: np.random.Generator) -> Case:
    """Start on a copy at `to` after damaging it; if it is quarantined, restore the backup."""
    shutil.copytree(folder.data, to)
    what = damaged(to, rng)
    settings = Settings(data_dir=to)
    try:
        with _no_output():
            try:
                return Case(what, "served", errors=tuple(served(settings, folder.session_id)))
            except Damaged as error:
                said = f"{error.message}. {error.remedy}"
            except ReembodyError as error:
                return Case(what, "refused", f"{error.message}. {error.remedy}")
            return Case(what, "quarantined", said, errors=tuple(_restored(folder, settings)))
    except Exception:  # noqa: BLE001 - whatever it is, it is what was looked for
        return Case(what, "traceback", traceback.format_exc())
    finally:
        shutil.rmtree(to, ignore_errors=True)


def served(settings: Settings, session_id: str) -> Iterator[str]:
    """Start as `reembody serve` does, request the main pages and yield responses that are wrong."""
    prepare_database(settings, Clock(), to_write=True)
    app = create_app(settings)
    try:
        with TestClient(app, raise_server_exceptions=False) as client:
            yield from _looked_around(client, session_id)
    except Exception as error:
        raise why_not(error, settings) from error


def _looked_around(client: TestClient, session_id: str) -> Iterator[str]:
    login = client.post("/api/login", json=CREDENTIALS)
    paths = [
        "/api/health",
        "/api/me",
        "/api/studies",
        f"/api/studies/{STUDY}/sessions",
        f"/api/studies/{STUDY}/participants",
        f"/api/sessions/{session_id}",
        f"/api/sessions/{session_id}/events",
        f"/api/sessions/{session_id}/answers",
        "/api/accounts",
        "/api/audit/check",
    ]
    for answer in (login, *map(client.get, paths)):
        if not answer.is_success and not _says_damaged(answer):
            yield f"{answer.request.url.path}: {answer.status_code} {answer.text[:100]}"


def _says_damaged(answer: Response) -> bool:
    """Return whether a response reports the database as damaged.

    A value can be damaged where no start checks; the request that reads it then gets this response,
    with the remedy.
    """
    return answer.status_code == 503 and "the database is damaged" in answer.text


def _restored(folder: Folder, settings: Settings) -> Iterator[str]:
    with patch("app.cli.backups.read_settings", lambda: settings):
        restore_from(
            folder.backup,
            Activity(""),
            RestoreOptions(
                replace=False, even_though_active=True, even_though_altered=False, erasures=None
            ),
            as_json=True,
        )
    yield from served(settings, folder.session_id)


@contextmanager
def _no_output() -> Iterator[None]:
    with patch.object(sys, "stderr", StringIO()):
        yield


def many(
    folder: Folder, elsewhere: Path, count: int, seed: int, *, processes: int = 1
) -> list[Case]:
    """Try `count` random damages, each drawn with its own seed."""
    if processes == 1:
        return [_numbered(folder, elsewhere, seed, number) for number in range(count)]
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        return list(pool.map(partial(_numbered, folder, elsewhere, seed), range(count)))


def _numbered(folder: Folder, elsewhere: Path, seed: int, number: int) -> Case:
    return tried(folder, elsewhere / str(number), np.random.default_rng([seed, number]))


def left_by_a_killed_server(folder: Path) -> Folder:
    """Create the folder of a server that was killed after a visit, a backup and more data."""
    from app.database import open_database
    from tests.faults.commands import reembody
    from tests.features.care.rights.visit import make_visit
    from tests.features.record.headset.site import Site
    from tests.support.server import LiveServer

    server = LiveServer(folder).start()
    with server.client() as operator:
        ok(operator.post("/api/login", json=CREDENTIALS))
        database = open_database(f"sqlite:///{server.data_dir / DATABASE}")
        site = Site(server, operator, database)
        visit = make_visit(site)
        backup = folder / "all.reembody"
        made = reembody(server, "backup", backup, "--json").json
        make_visit(site, "P-0815")
        database.close()
        # Closing the last connection removes the log; a write of the server's leaves one behind.
        ok(operator.post("/api/login", json=CREDENTIALS))
    server.kill()
    return Folder(server.data_dir, backup, made["sha256"], visit.session_id)
