"""A scripted wearer of a headset: a real headset client on a thread, at real speed."""

import asyncio
import json
import threading
from typing import Self

import httpx2
import numpy as np

from app.client.telemetry import TelemetryClient
from app.protocol import Tasks
from app.rehearsal.frame_clock import FrameClock
from app.rehearsal.headset import FromServer, Headset
from app.simulated_people.body import make_person


class Wearer:
    """Pair with the console's code and perform whatever the session asks for."""

    def __init__(self, url: str, code: str) -> None:
        self.error: BaseException | None = None
        self._url, self._code = url, code
        self._thread = threading.Thread(target=self._live, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._thread.join(timeout=20.0)

    def _live(self) -> None:
        try:
            asyncio.run(self._wear())
        except BaseException as error:  # noqa: BLE001 - the test reads it
            self.error = error

    async def _wear(self) -> None:
        paired = httpx2.post(
            f"{self._url}/api/devices/pair", json={"code": self._code, "name": "headset"}
        ).json()
        clock = FrameClock(1.0)
        device = httpx2.AsyncClient(
            base_url=self._url, headers={"authorization": f"Bearer {paired['token']}"}, timeout=30.0
        )
        async with (
            device,
            TelemetryClient(
                url=f"{self._url.replace('http', 'ws', 1)}/api/vr/stream",
                token=paired["token"],
                name="test headset",
                avatars=("delayed_copy", "physics"),
                changes_avatar=True,
                monotonic_s=clock.now_s,
            ) as client,
        ):
            assert client.welcome is not None
            tasks = Tasks.model_validate_json(json.dumps(client.welcome.tasks))
            person = make_person(np.random.default_rng(7), None)
            physics = FromServer(device) if client.welcome.avatar == "physics" else None
            await Headset(client, person, tasks, clock, physics).run()
