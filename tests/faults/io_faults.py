"""Inject disk errors into a start, a restore, a backup, an export, an upload and an erasure.

A traced run first finds every call that an operation makes to a file of the installation
(tests/faults/tracing). Then each call is made to fail, one per run on a fresh copy of a real data
folder, and the operation is repeated without a fault, as an operator would. The test checks that no
acknowledged data is lost, no healthy database is moved, no unknown file is left, and the message is
a sentence and not a traceback.

`main` must run in a process that has neither threads nor children (tests/benchmarks/io_faults.py).
"""

import errno
import json
import os
import pickle
import re
import shutil
import sqlite3
import tempfile
import traceback
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing, contextmanager, redirect_stderr
from dataclasses import asdict, dataclass
from functools import partial
from io import StringIO
from pathlib import Path
from typing import Any

from fastapi.testclient import TestClient

from app.cli.backups import RestoreOptions, back_up_to, restore_from
from app.cli.errors import reported
from app.cli.progress import Activity
from app.cli.record import export_to_folder
from app.cli.serve.run import why_not
from app.clock import Clock
from app.database import open_database
from app.features.care.opening import prepare_database
from app.main import create_app
from app.settings import Settings
from tests.faults.commands import reembody
from tests.faults.damage import CREDENTIALS, DATABASE
from tests.faults.tracing.injecting import (
    BEGIN,
    Fault,
    Injector,
    Site,
    followed,
    injecting_machine,
)
from tests.features.care.rights.visit import make_visit
from tests.features.lab import STUDY, ok
from tests.features.movement.captures.files import walk_bvh
from tests.features.record.headset.site import Site as Installation
from tests.support.forked_workers import use_fork_server
from tests.support.nursery import make_passwords_cheap
from tests.support.server import LiveServer

FAULTS = {
    "read": (errno.EIO,),
    "open": (errno.EACCES, errno.EIO),
    "open to write": (errno.EROFS, errno.ENOSPC),
    "write": (errno.ENOSPC, errno.EIO),
    "fsync": (errno.EIO,),
    "truncate": (errno.EIO,),
    "rename": (errno.EIO, errno.EACCES),
    "unlink": (errno.EACCES,),
    "mkdir": (errno.ENOSPC, errno.EROFS),
}
KNOWN = tuple(
    map(
        re.compile,
        (
            r"all\.reembody",
            r"data/reembody\.sqlite(-wal|-shm)?",
            r"data/(owner\.lock|reserve)",
            r"data/erasures\.jsonl",
            r"data/erasure-unfinished",
            r"data/backups/before-(restore|migration)-[^/]*\.reembody",
            r"out/made\.reembody",
            r"out/export/.*",
        ),
    )
)
"""Files that may exist after an operation, once a server has started."""


@dataclass(frozen=True)
class Source:
    """The starting point of every run: a data folder, and the participant who is erased in it."""

    folder: Path
    participant_id: str
    code: str


@dataclass
class Outcome:
    """How an operation ended: `ok` means acknowledged, `trace` is a program error's traceback."""

    ok: bool
    said: str = ""
    trace: str = ""


@dataclass
class Found:
    """The problems found after one run; every list is empty if all checks passed."""

    operation: str
    site: Site
    error: str
    hit: bool
    outcome: Outcome
    lost: list[str]
    unknown: list[str]
    moved: list[str]


def settings_in(folder: Path) -> Settings:
    """Return the settings of the installation in a folder."""
    return Settings(data_dir=folder / "data")


def begin(folder: Path) -> None:
    """Create the file that tells the tracer to count calls from now on."""
    os.close(os.open(folder / BEGIN, os.O_CREAT | os.O_WRONLY))


@contextmanager
def serving(folder: Path, *, counted: bool) -> Iterator[TestClient]:
    """Start a server on the folder as `reembody serve` does; `counted` includes its start."""
    settings = settings_in(folder)
    if counted:
        begin(folder)
    prepare_database(settings, Clock(), to_write=True)
    app = create_app(settings)
    started = False
    try:
        with TestClient(app, raise_server_exceptions=False) as client:
            started = True
            yield client
    except Exception as error:
        if started:
            raise
        raise why_not(error, settings) from error


def start(folder: Path, _: Source) -> None:
    """Start a server and request its health."""
    with serving(folder, counted=True) as client:
        ok(client.get("/api/health"))


def back_up(folder: Path, _: Source) -> None:
    """Back up to a file outside the data folder."""
    begin(folder)
    back_up_to(folder / "out" / "made.reembody", Activity(""), as_json=True)


def export(folder: Path, _: Source) -> None:
    """Export the data to a folder outside the data folder."""
    begin(folder)
    export_to_folder(STUDY, folder / "out" / "export", Activity(""), "all")


def restore(folder: Path, _: Source, *, replace: bool = False) -> None:
    """Restore the backup into an empty folder, or with `replace` over the existing data."""
    begin(folder)
    restore_from(
        folder / "all.reembody",
        Activity(""),
        RestoreOptions(
            replace=replace, even_though_active=True, even_though_altered=False, erasures=None
        ),
        as_json=True,
    )


def upload(folder: Path, _: Source) -> None:
    """Upload a capture to a server on the folder."""
    with serving(folder, counted=False) as client:
        ok(client.post("/api/login", json=CREDENTIALS))
        begin(folder)
        _taken(client.post("/api/captures?name=walk.bvh", content=walk_bvh(40)))


def erase(folder: Path, source: Source) -> None:
    """Erase the participant through a server on the folder."""
    with serving(folder, counted=False) as client:
        ok(client.post("/api/login", json=CREDENTIALS))
        begin(folder)
        path = f"/api/studies/{STUDY}/participants/{source.participant_id}/erasure"
        _taken(client.post(path, json={"confirm": source.code, "reason_code": "requested"}))


class Refused(Exception):
    """A response that rejects the request with a message."""


def _taken(answer: Any) -> None:
    if answer.status_code == 500:
        raise RuntimeError(answer.text)
    if not answer.is_success:
        raise Refused(answer.text)


OPERATIONS: dict[str, Callable[[Path, Source], None]] = {
    "start": start,
    "first start": start,
    "restore": restore,
    "restore --replace": partial(restore, replace=True),
    "backup": back_up,
    "export": export,
    "upload": upload,
    "erasure": erase,
}
EMPTY = {"first start", "restore"}
"""Operations that begin without any data."""


def prepared(operation: str, source: Source, to: Path) -> Path:
    """Copy the source to a fresh folder for one run of an operation."""
    shutil.copytree(source.folder, to)
    if operation in EMPTY:
        shutil.rmtree(to / "data")
        (to / "data").mkdir()
    (to / "out").mkdir()
    os.environ["REEMBODY_DATA_DIR"] = str(to / "data")
    return to


def done(operation: str, folder: Path, source: Source) -> Outcome:
    """Run an operation and return how it ended, with the messages that an operator would read."""
    said = StringIO()
    try:
        with redirect_stderr(said), reported(ValueError, OSError):
            OPERATIONS[operation](folder, source)
    except (SystemExit, Refused) as error:
        return Outcome(ok=False, said=said.getvalue() or str(error))
    except BaseException:  # noqa: BLE001 - whatever it is, it is what was looked for
        return Outcome(ok=False, said=said.getvalue(), trace=traceback.format_exc())
    return Outcome(ok=True, said=said.getvalue())


def source_in(folder: Path) -> Source:
    """Create the data folder of a killed server, with a backup next to it."""
    server = LiveServer(folder).start()
    with server.client() as operator:
        ok(operator.post("/api/login", json=CREDENTIALS))
        database = open_database(f"sqlite:///{server.data_dir / DATABASE}")
        site = Installation(server, operator, database)
        visit = make_visit(site)
        site.command(visit.session_id, "withdraw", reason="enough")
        assert reembody(server, "backup", folder / "all.reembody").code == 0
        make_visit(site, "P-0815")
        database.close()
    server.kill()
    (folder / "server.log").unlink()
    return Source(folder, visit.participant_id, visit.code)


def facts(data: Path) -> set[str]:
    """Return what must never be lost: each event, submission, stream position and account."""
    file = data / DATABASE
    if not file.is_file():
        return set()
    with closing(sqlite3.connect(file)) as connection:
        queries = (
            "SELECT 'event ' || hash FROM session_events",
            "SELECT 'form ' || id FROM submissions",
            "SELECT 'account ' || id FROM accounts",
            "SELECT 'frames' || session_id || stream || frames_stored FROM telemetry_streams",
        )
        return {str(row[0]) for query in queries for row in connection.execute(query)}


def erased_away(fact: str) -> bool:
    """Return whether the erasure of the participant removes this fact."""
    return fact.startswith(("frames", "form"))


def looked_at(operation: str, folder: Path, source: Source, outcome: Outcome) -> dict[str, Any]:
    """Start a server after a run, or repeat the operation if no data exist; return problems."""
    lost, before = [], facts_of_source(source)
    again = operation if operation in EMPTY and not outcome.ok else "start"
    recovered = done(again, folder, source)
    if not recovered.ok:
        lost.append(f"{again} afterwards: {recovered.said}{recovered.trace}")
    elif operation == "first start":
        before = set()
    elif operation == "restore":
        done("start", folder, source)
    if recovered.ok:
        now = facts(folder / "data")
        # A restore goes back to the backup; later data are retained in a separate backup.
        kept = operation != "restore" and not (operation == "restore --replace" and outcome.ok)
        missing = before - now if kept else backed_up(source) - now
        if operation == "erasure":
            missing = {fact for fact in missing if not erased_away(fact)}
        lost += sorted(missing)[:3]
        if operation == "erasure" and outcome.ok:
            lost += [f"canary in {path}" for path in _holding(folder / "data", source.code)]
    files = [path for path in folder.rglob("*") if path.is_file() and path.name != BEGIN]
    names = [str(path.relative_to(folder)) for path in files]
    moved = [name for name in names if "/quarantine/" in name]
    unknown = [
        name
        for name in names
        if name not in moved and not any(known.fullmatch(name) for known in KNOWN)
    ]
    if operation.startswith("restore") and not outcome.ok and operation != "restore":
        unknown += [name for name in names if "before-restore" in name]
    if not outcome.ok:
        unknown += [name for name in names if name.startswith("out/")]
    return {"lost": lost, "unknown": unknown, "moved": moved}


def facts_of_source(source: Source) -> set[str]:
    """Return the facts of the source folder, read from a copy: reading empties the log."""
    with tempfile.TemporaryDirectory() as copy:
        shutil.copytree(source.folder / "data", Path(copy) / "data")
        return facts(Path(copy) / "data")


def backed_up(source: Source) -> set[str]:
    """Return the facts that the backup of the source contains."""
    with tempfile.TemporaryDirectory() as copy:
        shutil.copyfile(source.folder / "all.reembody", Path(copy) / DATABASE)
        return facts(Path(copy))


def _holding(data: Path, code: str) -> Iterable[Path]:
    needle = code.encode()
    return [path for path in data.rglob("*") if path.is_file() and needle in path.read_bytes()]


def chosen(sites: list[Site]) -> list[Site]:
    """Return the first, a middle and the last call of each kind to each file."""
    last = {(site.kind, site.path, site.writes): site.nth for site in sites}
    wanted = {
        Site(kind, path, nth, writes)
        for (kind, path, writes), most in last.items()
        for nth in {0, most // 2, most}
    }
    return [site for site in dict.fromkeys(sites) if site in wanted]


def faults_at(site: Site) -> Iterator[Fault]:
    """Yield the errors that can occur at a call."""
    kind = "open to write" if site.kind == "open" and site.writes else site.kind
    for number in FAULTS[kind]:
        yield Fault(site, number)


def in_a_child(work: Callable[[], Any], result: Path) -> Any:
    """Return the result of `work`, run in a child: this process must never open a database."""
    child = os.fork()
    if child == 0:
        try:
            result.write_bytes(pickle.dumps(work()))
        finally:
            os._exit(0)
    os.waitpid(child, 0)
    answer = pickle.loads(result.read_bytes())  # noqa: S301 - written above
    result.unlink()
    return answer


def run_once(
    operation: str, source: Source, fault: Fault | None, elsewhere: Path
) -> tuple[Injector, Outcome, dict[str, Any]]:
    """Run an operation once with a fault, then check the state that it left."""
    machine = injecting_machine()
    if machine is None:
        raise OSError("system calls of this machine cannot be made to fail")
    folder = prepared(operation, source, elsewhere / "run")
    result = elsewhere / "result"
    injector = Injector(machine, folder.resolve(), fault)

    def work() -> int:
        outcome = done(operation, folder, source)
        result.write_bytes(pickle.dumps(outcome))
        return 0

    try:
        followed(injector, work)
        outcome: Outcome = pickle.loads(result.read_bytes())  # noqa: S301 - written above
        result.unlink()
        look = partial(looked_at, operation, folder, source, outcome)
        return injector, outcome, in_a_child(look, result)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def sites_of(operation: str, source: Source, elsewhere: Path) -> list[Site]:
    """Trace an operation without a fault and return its calls to files."""
    injector, outcome, wrong = run_once(operation, source, None, elsewhere)
    if not outcome.ok or any(wrong.values()):
        raise RuntimeError(f"{operation} without any fault: {outcome} {wrong}")
    return injector.sites


def all_of(operation: str, source: Source, elsewhere: Path, most: int | None) -> dict[str, Any]:
    """Inject every fault at every call of one operation, or about `most` faults, evenly spread."""
    sites = chosen(sites_of(operation, source, elsewhere))
    faults = [fault for site in sites for fault in faults_at(site)]
    if most is not None and len(faults) > most:
        faults = faults[:: -(-len(faults) // most)]
    found = []
    for fault in faults:
        injector, outcome, wrong = run_once(operation, source, fault, elsewhere)
        name = errno.errorcode[fault.errno]
        found.append(Found(operation, fault.site, name, injector.hit, outcome, **wrong))
    return {"sites": len(sites), "found": [asdict(one) for one in found]}


def main(source: str, operation: str, workers: str, most: str, to: str) -> None:
    """Run all faults of one operation and write the findings as JSON."""
    use_fork_server(lambda: bytes.fromhex(workers))
    make_passwords_cheap()
    with tempfile.TemporaryDirectory() as elsewhere:
        given: Source = pickle.loads(Path(source).read_bytes())  # noqa: S301 - our own
        told = all_of(operation, given, Path(elsewhere), int(most) or None)
    Path(to).write_text(json.dumps(told), encoding="utf-8")
