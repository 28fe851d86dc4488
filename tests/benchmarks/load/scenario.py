"""One run of a load: the real server, the headsets, the consoles, and what became of it all."""

import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.load.consoles import ConsolePlan
from tests.benchmarks.load.generator import GeneratorPlan, Seat
from tests.benchmarks.load.lab import Lab, call_phases, make_lab
from tests.benchmarks.load.processes import Companion
from tests.benchmarks.load.verify import Verdict, verify
from tests.benchmarks.load.watch import Watch
from tests.support.server import LiveServer

BEGINS_IN_S = 1.0


@dataclass(frozen=True)
class Load:
    """How much: `real` of the sessions use the product's own client, `consoles` are watched."""

    sessions: int = 50
    duration_s: float = 600.0
    real: int = 5
    consoles: int = 10
    contact_every_s: float | None = 1.0
    digest_every: int = 5


@dataclass(frozen=True)
class Outcome:
    """What a run has shown.

    `messages` (n, 4): session number, stream, handed over (monotonic s), latency (s, NaN if never
    acknowledged). `news` (m, 3): session number, the headset's clock (s), arrived at the console.
    `views_s`: how long a console waited for a session's view. `told`: the generators' own results.
    """

    load: Load
    begin_s: float
    messages: NDArray[np.float64]
    news: NDArray[np.float64]
    views_s: NDArray[np.float64]
    told: dict[str, dict[str, Any]]
    consoles_cpu_s: float
    watch: Watch
    verdict: Verdict
    database_bytes: int


@dataclass
class Companions:
    """The processes of a run: the generators by the client they use, and the consoles."""

    generators: dict[str, Companion]
    consoles: Companion | None

    def everybody(self) -> Iterator[Companion]:
        """Generators first."""
        yield from self.generators.values()
        if self.consoles is not None:
            yield self.consoles


def run_load(folder: Path, load: Load, environment: dict[str, str] | None = None) -> Outcome:
    """Run it; the database is compared with the generators' counters after the server stopped."""
    folder.mkdir(parents=True, exist_ok=True)
    server = LiveServer(folder, environment=environment)
    url = (environment or {}).get("REEMBODY_DATABASE_URL")
    file = None if url else server.data_dir / "reembody.sqlite"
    with server:
        lab = make_lab(server, load.sessions)
        with companions(folder, server, lab, load) as these:
            begin_s = time.monotonic() + BEGINS_IN_S
            for one in these.everybody():
                one.begin(begin_s)
            time.sleep(max(0.0, begin_s - time.monotonic()))
            with Watch(server.pid, file) as watch:
                time.sleep(load.duration_s)
            told = {name: one.result() for name, one in these.generators.items()}
            seen = {} if these.consoles is None else these.consoles.result()
    sessions = [session for one in told.values() for session in one["sessions"]]
    news = folder / "news.npy"
    return Outcome(
        load=load,
        begin_s=begin_s,
        messages=np.concatenate([np.load(folder / f"{name}.npy") for name in told]),
        news=np.load(news) if news.exists() else np.empty((0, 3)),
        views_s=np.asarray(seen.get("views_s", [])),
        told=told,
        consoles_cpu_s=seen.get("cpu_s", 0.0),
        watch=watch,
        verdict=verify(url or f"sqlite:///{file}", sessions),
        database_bytes=0 if file is None else file.stat().st_size,
    )


@contextmanager
def companions(folder: Path, server: LiveServer, lab: Lab, load: Load) -> Iterator[Companions]:
    """Every process of the load, connected and with its phases running."""
    split = load.sessions - load.real
    groups = {"lean": lab.seats[:split], "real": lab.seats[split:]}
    with ExitStack() as stack:
        generators = {
            name: Companion.start(
                "generator", _generator_plan(folder, server, load, name, seats), folder / name
            )
            for name, seats in groups.items()
            if seats
        }
        for one in generators.values():
            stack.callback(one.end)
        for one in generators.values():
            one.wait_for("connected")
        call_phases(server, lab)
        consoles = None
        if load.consoles:
            plan = _console_plan(folder, server, lab, load)
            consoles = Companion.start("consoles", plan, folder / "consoles")
            stack.callback(consoles.end)
            consoles.wait_for("connected")
        made = Companions(generators, consoles)
        for one in made.everybody():
            one.wait_for("ready")
        yield made


def _generator_plan(
    folder: Path, server: LiveServer, load: Load, client: str, seats: tuple[Seat, ...]
) -> GeneratorPlan:
    return GeneratorPlan(
        url=f"{server.url.replace('http', 'ws', 1)}/api/vr/stream",
        client=client,
        seats=seats,
        duration_s=load.duration_s,
        contact_every_s=load.contact_every_s,
        digest_every=load.digest_every,
        messages=str(folder / f"{client}.npy"),
    )


def _console_plan(folder: Path, server: LiveServer, lab: Lab, load: Load) -> ConsolePlan:
    """Consoles on sessions spread over all, so that both clients are watched."""
    step = max(1, load.sessions // load.consoles)
    watched = lab.seats[step - 1 :: step][: load.consoles]
    return ConsolePlan(
        url=server.url,
        cookies=lab.cookies,
        sessions=tuple((seat.number, seat.session_id) for seat in watched),
        duration_s=load.duration_s,
        news=str(folder / "news.npy"),
    )
