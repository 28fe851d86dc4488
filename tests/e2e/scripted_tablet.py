"""A scripted tablet that answers immediately, through the interface of the tablet's page."""

import threading
from typing import Any, Self

import httpx2
import numpy as np

from app.rehearsal.answers import agreement, fill_in
from app.simulated_people.body import Person, make_person

LOOK_EVERY_S = 0.1


class ScriptedTablet:
    """Pair with the console's code, then read, agree and answer until the session is over."""

    def __init__(self, url: str, code: str) -> None:
        self.error: BaseException | None = None
        self.person: Person = make_person(np.random.default_rng(7), None)
        self._url, self._code = url, code
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._live, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._over.set()
        self._thread.join(timeout=20.0)

    def _live(self) -> None:
        try:
            with httpx2.Client(base_url=f"{self._url}/api", timeout=30.0) as client:
                body = {"code": self._code, "name": "tablet"}
                client.post("/devices/pair", json=body).raise_for_status()
                while not self._over.wait(LOOK_EVERY_S):
                    state = client.get("/tablet/state").raise_for_status().json()
                    if state["screen"] == "finished":
                        return
                    self._answer(client, state)
        except BaseException as error:  # noqa: BLE001 - the test reads it
            self.error = error

    def _answer(self, client: httpx2.Client, state: dict[str, Any]) -> None:
        step = {"step_index": state["step_index"]}
        match state["screen"]:
            case "consent":
                body = {**step, **agreement(state["consent"])}
                client.post("/tablet/consent", json=body).raise_for_status()
            case "instructions":
                client.post("/tablet/acknowledge", json=step).raise_for_status()
            case "form":
                body = self._filled_in(state["administration"])
                client.post("/tablet/submissions", json=body).raise_for_status()

    def _filled_in(self, form: dict[str, Any]) -> dict[str, Any]:
        rng = np.random.default_rng(11)
        return {
            "idempotency_key": f"scripted-{form['key']}"[:64],
            "administration": form["key"],
            "answers": fill_in(form["instrument"], self.person, 0.0, "hand", rng),
            "shown_order": form["item_order"],
            "seed": form["seed"],
            "language": form["language"],
        }
