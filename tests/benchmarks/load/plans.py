"""The participants of a load, and the plans of their processes."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.load.consoles import ConsolePlan
from tests.benchmarks.load.generator import GeneratorPlan, Seat
from tests.benchmarks.load.lab import Lab, call_phases
from tests.benchmarks.load.processes import Companion
from tests.support.server import LiveServer


@dataclass(frozen=True)
class Load:
    """The size of a load; `real` sessions use the product's client, `consoles` have a console."""

    sessions: int = 50
    duration_s: float = 600.0
    real: int = 5
    consoles: int = 10
    contact_every_s: float | None = 1.0
    digest_every: int = 5


@dataclass
class Companions:
    """The processes of a run: the generators, by the client they use, and the consoles."""

    generators: dict[str, Companion]
    consoles: Companion | None

    def everybody(self) -> Iterator[Companion]:
        """Return all processes, generators first."""
        yield from self.generators.values()
        if self.consoles is not None:
            yield self.consoles


@contextmanager
def companions(folder: Path, server: LiveServer, lab: Lab, load: Load) -> Iterator[Companions]:
    """Start every process of the load, connected and with its phases running."""
    split = len(lab.seats) - load.real
    groups = {"lean": lab.seats[:split], "real": lab.seats[split:]}
    with ExitStack() as stack:
        generators = {
            name: Companion.start(
                "load.generator", _generator_plan(folder, server, load, name, seats), folder / name
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
            consoles = Companion.start("load.consoles", plan, folder / "consoles")
            stack.callback(consoles.end)
            consoles.wait_for("connected")
        made = Companions(generators, consoles)
        for one in made.everybody():
            one.wait_for("ready")
        yield made


def stream_url(server: LiveServer) -> str:
    """Return the URL at which headsets connect."""
    return f"{server.url.replace('http', 'ws', 1)}/api/vr/stream"


def _generator_plan(
    folder: Path, server: LiveServer, load: Load, client: str, seats: tuple[Seat, ...]
) -> GeneratorPlan:
    return GeneratorPlan(
        url=stream_url(server),
        client=client,
        seats=seats,
        duration_s=load.duration_s,
        contact_every_s=load.contact_every_s,
        digest_every=load.digest_every,
        messages=str(folder / f"{client}.npy"),
    )


def _console_plan(folder: Path, server: LiveServer, lab: Lab, load: Load) -> ConsolePlan:
    """Plan consoles on evenly spread sessions, so that both kinds of clients have some."""
    step = max(1, len(lab.seats) // load.consoles)
    watched = lab.seats[step - 1 :: step][: load.consoles]
    return ConsolePlan(
        url=server.url,
        cookies=lab.cookies,
        sessions=tuple((seat.number, seat.session_id) for seat in watched),
        duration_s=load.duration_s,
        news=str(folder / "news.npy"),
        views=str(folder / "views.npy"),
    )
