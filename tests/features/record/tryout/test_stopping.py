"""Tests that a stopped rehearsal ends its session, whatever commands still arrive."""

from dataclasses import dataclass
from typing import Any

from httpx2 import ASGITransport, AsyncClient

from app.client.http import Operator
from app.rehearsal.__main__ import end_session
from tests.features.lab import Lab

Json = dict[str, Any]


@dataclass(frozen=True)
class Overtaken(Operator):
    """An operator who is overtaken: after each view another pending command arrives."""

    lab: Lab
    on_the_way: list[str]
    tries: list[str]

    async def view(self) -> Json:
        """Return the view, and then send a pending command that makes it outdated."""
        seen = await super().view()
        if self.on_the_way:
            await super().command(seen, self.on_the_way.pop(0), reason="on its way")
        return seen

    async def stop(self, kind: str, **fields: Any) -> Json:
        """Stop the session and count the attempt."""
        self.tries.append(kind)
        return await super().stop(kind, **fields)


def test_a_stopped_rehearsal_aborts_a_session_that_moves_on(lab: Lab) -> None:
    """A stopped rehearsal aborts its session once, although a command arrives in between."""
    session_id = lab.command(lab.join(kind="simulated"), "start")["id"]
    late: list[str] = ["skip"]
    tries: list[str] = []

    async def stop() -> None:
        transport = ASGITransport(app=lab.app)
        headers = {"authorization": lab.operator.headers["authorization"]}
        async with AsyncClient(
            transport=transport, base_url="http://localhost", headers=headers
        ) as client:
            await end_session(Overtaken(client, session_id, lab, late, tries))

    portal = lab.operator.portal
    assert portal is not None
    portal.call(stop)
    assert (late, tries) == ([], ["abort"])
    assert lab.view(session_id)["status"] == "aborted"
    ends = [one for one in lab.events(session_id) if one["type"] == "session_ended"]
    assert len(ends) == 1
