"""Use oTree as a peer: one page of rated statements, shown repeatedly.

Its production server runs on the loopback, on its own SQLite. That is a database in memory, which
is written to disk when the server ends: an acknowledged submission is not durable there.
"""

import os
import secrets
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx2

from tests.benchmarks.peers.environment import python_peer
from tests.support.server import free_port

VERSION = "5.11.4"
ANSWERS_WITHIN_S = 60.0
SETTINGS = """\
SESSION_CONFIGS = [dict(name="form", app_sequence=["form"], num_demo_participants=1)]
SESSION_CONFIG_DEFAULTS = dict(real_world_currency_per_point=1.0, participation_fee=0.0)
PARTICIPANT_FIELDS = []
SESSION_FIELDS = []
ROOMS = []
LANGUAGE_CODE = "en"
REAL_WORLD_CURRENCY_CODE = "EUR"
USE_POINTS = False
DEMO_PAGE_INTRO_HTML = ""
ADMIN_USERNAME = "admin"
ADMIN_PASSWORD = {secret!r}
SECRET_KEY = {secret!r}
"""
APP = """\
from otree.api import *

STATEMENTS = {statements!r}
STEPS = [[step, str(step)] for step in range(1, 8)]


class C(BaseConstants):
    NAME_IN_URL = "form"
    PLAYERS_PER_GROUP = None
    NUM_ROUNDS = {rounds}


class Subsession(BaseSubsession):
    pass


class Group(BaseGroup):
    pass


class Player(BasePlayer):
    for _number, _text in enumerate(STATEMENTS, start=1):
        locals()["q%d" % _number] = models.IntegerField(
            label=_text, choices=STEPS, widget=widgets.RadioSelectHorizontal
        )
    # Its development server refuses what is neither a field nor a method.
    del _number, _text


class Form(Page):
    form_model = "player"
    form_fields = ["q%d" % number for number in range(1, len(STATEMENTS) + 1)]


page_sequence = [Form]
"""
PAGE = """\
{{ block title }}Questionnaire{{ endblock }}
{{ block content }}
{{ formfields }}
{{ next_button }}
{{ endblock }}
"""


@dataclass(frozen=True)
class OTree:
    """A running server, its process, and the codes of its participants."""

    pid: int
    port: int
    participants: tuple[str, ...]

    @property
    def url(self) -> str:
        """Return the base URL of the server."""
        return f"http://localhost:{self.port}"

    def first_page(self, at: int) -> str:
        """Return the path that leads a participant to their form."""
        return f"/InitializeParticipant/{self.participants[at]}"


@contextmanager
def running_otree(
    folder: Path, statements: Sequence[str], participants: int, rounds: int
) -> Iterator[OTree]:
    """Run a server whose participants answer the same page in every round.

    Raises:
        NoPeer: oTree could not be installed.
        RuntimeError: the server did not start.
    """
    programs = python_peer("otree", f"otree=={VERSION}")
    write_project(folder, statements, rounds)
    port = free_port()
    with (folder / "log").open("w") as log:
        process = subprocess.Popen(
            [programs / "otree", "prodserver1of2", f"127.0.0.1:{port}"],
            cwd=folder,
            # It starts a second process of itself by name.
            env={**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "OTREE_PRODUCTION": "1"},
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
    try:
        yield OTree(process.pid, port, _make_participants(port, participants, folder / "log"))
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def write_project(folder: Path, statements: Sequence[str], rounds: int) -> None:
    """Write a project of one app with one page, as small as oTree accepts."""
    app = folder / "form"
    # It does not start without these two.
    for path in (app, folder / "_static", folder / "_templates" / "global"):
        path.mkdir(parents=True)
    (folder / "settings.py").write_text(SETTINGS.format(secret=secrets.token_hex(16)))
    (app / "__init__.py").write_text(APP.format(statements=list(statements), rounds=rounds))
    (app / "Form.html").write_text(PAGE)


def _make_participants(port: int, count: int, log: Path) -> tuple[str, ...]:
    give_up_s = time.monotonic() + ANSWERS_WITHIN_S
    wish = {"session_config_name": "form", "num_participants": count}
    with httpx2.Client(base_url=f"http://localhost:{port}", timeout=60.0) as client:
        while True:
            try:
                made = client.post("/api/sessions", json=wish)
                break
            except httpx2.TransportError:
                if time.monotonic() > give_up_s:
                    raise RuntimeError(f"oTree did not start:\n{log.read_text()[-3000:]}") from None
                time.sleep(0.1)
        code = made.raise_for_status().json()["code"]
        session = client.get(f"/api/sessions/{code}").raise_for_status().json()
    return tuple(str(one["code"]) for one in session["participants"])
