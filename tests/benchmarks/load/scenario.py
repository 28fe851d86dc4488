"""Run a load once, with the real server, headsets and consoles, and evaluate it."""

import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.load.lab import Lab, make_lab
from tests.benchmarks.load.plans import Load, companions
from tests.benchmarks.load.processes import Companion
from tests.benchmarks.load.verify import Verdict, database_bytes, verify
from tests.benchmarks.load.watch import Watch
from tests.support.server import LiveServer

BEGINS_IN_S = 1.0


@dataclass(frozen=True)
class Store:
    """Where the server keeps its data: `url` of a database, or None for SQLite in its own folder.

    `processes` are the names of the database's processes, which are watched too.
    """

    url: str | None = None
    processes: Mapping[str, int] | None = None


@dataclass(frozen=True)
class Course:
    """A completed load: when it started (monotonic s), its duration, and its results."""

    begin_s: float
    lasted: tuple[datetime, datetime]
    told: dict[str, dict[str, Any]]
    consoles_cpu_s: float
    watch: Watch
    beside: dict[str, Watch]


@dataclass(frozen=True)
class Outcome:
    """The results of a run of the load.

    `messages` (n, 4): session number, stream, sent (monotonic s), latency (s, NaN if never
    acknowledged). `news` (m, 3): session number, the headset's clock (s), arrival at the console.
    `views` (k, 2): when a console requested a session's view (monotonic s), and how long it waited.
    `told`: the generators' own results. `beside`: the processes of the database.
    """

    load: Load
    begin_s: float
    messages: NDArray[np.float64]
    news: NDArray[np.float64]
    views: NDArray[np.float64]
    told: dict[str, dict[str, Any]]
    consoles_cpu_s: float
    watch: Watch
    beside: dict[str, Watch]
    verdict: Verdict
    database_bytes: int


def run_load(folder: Path, load: Load, store: Store | None = None) -> Outcome:
    """Run a load, then stop the server and compare its database with the generators' counters."""
    store = store or Store()
    with live_server(folder, store) as server:
        lab = make_lab(server, load.sessions)
        course = run_course(folder, server, lab, load, store)
    return outcome_of(folder, load, course, database_url(server, store))


def live_server(folder: Path, store: Store) -> LiveServer:
    """Return the product's server, which has not been started."""
    folder.mkdir(parents=True, exist_ok=True)
    environment = {} if store.url is None else {"REEMBODY_DATABASE_URL": store.url}
    return LiveServer(folder, environment=environment)


def database_url(server: LiveServer, store: Store) -> str:
    """Return the URL of the server's database."""
    return store.url or f"sqlite:///{server.data_dir / 'reembody.sqlite'}"


def run_course(
    folder: Path,
    server: LiveServer,
    lab: Lab,
    load: Load,
    store: Store,
    guests: Sequence[Companion] = (),
) -> Course:
    """Start all processes at the same moment, including the caller's own ones in `guests`."""
    file = None if store.url else server.data_dir / "reembody.sqlite"
    with companions(folder, server, lab, load) as these:
        begin_s = time.monotonic() + BEGINS_IN_S
        for one in (*these.everybody(), *guests):
            one.begin(begin_s)
        time.sleep(max(0.0, begin_s - time.monotonic()))
        begun_at = datetime.now(UTC)
        with ExitStack() as stack:
            watch = stack.enter_context(Watch(server.pid, file))
            beside = {
                name: stack.enter_context(Watch(pid, None))
                for name, pid in (store.processes or {}).items()
            }
            time.sleep(load.duration_s)
            lasted = (begun_at, datetime.now(UTC))
        told = {name: one.result() for name, one in these.generators.items()}
        seen = {} if these.consoles is None else these.consoles.result()
    return Course(begin_s, lasted, told, seen.get("cpu_s", 0.0), watch, beside)


def outcome_of(
    folder: Path, load: Load, course: Course, url: str, guests: Sequence[dict[str, Any]] = ()
) -> Outcome:
    """Combine the results that the processes left in `folder`, and verify the database.

    `guests`: the results of the caller's own processes.
    """
    tellers = (*course.told.values(), *guests)
    sessions = [session for one in tellers for session in one["sessions"]]
    return Outcome(
        load=load,
        begin_s=course.begin_s,
        messages=np.concatenate([np.load(folder / f"{name}.npy") for name in course.told]),
        news=_loaded(folder / "news.npy", 3),
        views=_loaded(folder / "views.npy", 2),
        told=course.told,
        consoles_cpu_s=course.consoles_cpu_s,
        watch=course.watch,
        beside=course.beside,
        verdict=verify(url, sessions, course.lasted),
        database_bytes=database_bytes(url),
    )


def _loaded(path: Path, columns: int) -> NDArray[np.float64]:
    """Return the rows of a console's file, or no rows if there was no console."""
    rows: NDArray[np.float64] = np.load(path) if path.exists() else np.empty((0, columns))
    return rows
