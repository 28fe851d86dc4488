"""A server with no empty page: sessions of every status, movement, bodies, walks and devices."""

import re
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
from sqlalchemy import select

from app.database import Database
from app.features.design.studies import add_version, newest_version, study_by_key
from app.features.movement.avatar import SHIPPED
from app.models import Phase
from app.protocol.plan import Step
from tests.benchmarks.session_desk.site import Desk
from tests.benchmarks.thousand import shipped_database
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.features.latency_builders import HISTORY_S, measured, store_movement
from tests.features.movement.captures.files import walk_bvh
from tests.features.movement.walking.walkers import FLOOR, SMALL
from tests.protocol.test_preregistration import SECTION
from tests.support.humanoid_files import humanoid_file
from tests.support.server import ADMIN_PASSWORD, LiveServer

SESSIONS = 12
REPLAYED_S = 3.0
CAPTURE_FRAMES = 60
PATIENCE_S = 60.0
COMPUTED_WITHIN_S = 300.0
AGAINST = frozenset({"q2", "q3", "q5", "q9", "q11"})
"""Items of the embodiment questionnaire with which one agrees who feels no embodiment."""
RULES = re.compile(r"^valid_when:\n(?:[ #].*\n|\n)*", re.MULTILINE)


@dataclass(frozen=True)
class FilledLab:
    """A running server and what the addresses of its pages need."""

    server: LiveServer
    places: dict[str, str]
    """What stands for `:session`, `:capture` and the like in a route."""
    cookies: dict[str, str]
    """The Cookie header of each reader: the operator, and tablets at different screens."""


@contextmanager
def filled_lab(folder: Path) -> Iterator[FilledLab]:
    """Run a server with twelve simulated sessions, as many of kind people, and one of the rest."""
    server = LiveServer(folder)
    database = shipped_database(server.data_dir)
    with database.writing() as db:
        study = study_by_key(db, STUDY)
        shipped = newest_version(db, study).source_yaml
        # The builder's sessions have no log of phases, which the shipped study's rules look for.
        add_version(db, study, RULES.sub("", shipped) + SECTION, NOW)
    completed = _sessions(database)
    database.close()
    with server, server.client() as admin:
        _post(admin, "/api/login", {"username": "admin", "password": ADMIN_PASSWORD})
        cookies = {"operator": _header(admin)}
        planned = _session(admin)
        running = _session(admin)
        cookies["tablet, consent"] = _tablet(server, admin, running)
        _command(admin, running, "start")
        desk = Desk(server, admin)
        desk.add_forms_study(1)
        cookies["tablet, form"] = desk.tablet_at_form()
        # Computed once beforehand: a page that is looked at should not wait for it.
        for result in ("dashboard", "statistics"):
            path = f"/api/studies/{STUDY}/{result}"
            admin.get(path, params={"kind": "simulated"}, timeout=COMPUTED_WITHIN_S)
        places = {
            "study": STUDY,
            "instrument": "karas2020",
            "avatar": SHIPPED,
            "completed": completed,
            "planned": planned,
            "running": running,
            "invitation": _post(admin, "/api/invitations", {"role": "operator"})["url"].rpartition(
                "/"
            )[2],
            **_movement(admin),
        }
        yield FilledLab(server, places, cookies)


def _person(kind: str, at: int) -> SessionSpec:
    """Return somebody whose ratings fall with the added latency, unlike others in all they say."""
    rng = np.random.default_rng(at)
    lower = int(rng.integers(3))

    def rated(step: Step, item: str) -> int:
        fallen = int((step.latency_ms or 0.0) / 100.0 + rng.uniform(0.0, 1.5))
        rating = max(1, 7 - lower - fallen)
        return 8 - rating if item in AGAINST else rating

    about: dict[str, float | str] = {
        "age": float(rng.integers(19, 45)),
        "height_cm": float(rng.integers(155, 195)),
        "weight_kg": float(rng.integers(50, 95)),
        "sex": str(rng.choice(["female", "male"])),
        "handedness": str(rng.choice(["left", "right"], p=[0.25, 0.75])),
        "footedness": str(rng.choice(["left", "right", "both"])),
        "motion_sickness": float(rng.random() < 0.4),
    }
    code = {"people": "P", "simulated": "SIM"}[kind]
    return SessionSpec(f"{code}-{at:04d}", kind=kind, likert=rated, about=about)


def _sessions(database: Database) -> str:
    """Store the completed sessions; return the id of one with a phase that can be replayed."""
    with database.writing() as db:
        for at in range(SESSIONS):
            for kind in ("people", "simulated"):
                session = build_session(db, _person(kind, at))
                if at > 0 or kind == "people":
                    continue
                replayed = session
                phases = db.scalars(
                    select(Phase).where(Phase.session_id == session.id).order_by(Phase.phase_id)
                ).all()
                for phase in phases:
                    achieved_s = phase.latency_ms / 1000.0 + 0.02 if phase.limb else None
                    db.add(measured(phase, achieved_s))
                moved = next(phase for phase in phases if phase.limb == "hand")
                moved.active_s = REPLAYED_S
                clock_s = (moved.client_started_s or 0.0) - HISTORY_S
                latency_s = moved.latency_ms / 1000.0
                store_movement(db, moved, latency_s, duration_s=REPLAYED_S, clock_s=clock_s)
        return replayed.id


def _movement(admin: httpx2.Client) -> dict[str, str]:
    """Upload a capture and a body; make walks, and a model of them."""
    capture = _sent(admin, "/api/captures", "a-walk.bvh", walk_bvh(CAPTURE_FRAMES))
    body = _sent(admin, "/api/humanoids", "Worn once.glb", humanoid_file())
    _post(admin, "/api/walking/scenes", {"text": FLOOR})
    origin = {"kind": "population", "population": "students", "people": 2, "repetitions": 2}
    walks = _post(
        admin, "/api/walking/walk-sets", {"title": "Made up", "origin": origin | {"scene": "floor"}}
    )
    order = {"title": "Small", "walk_set_id": walks["id"], "options": SMALL}
    model = _post(admin, "/api/walking/models", order)
    return {"capture": capture["id"], "body": body["content_hash"], "model": model["id"]}


def _session(admin: httpx2.Client) -> str:
    made = _post(admin, f"/api/studies/{STUDY}/sessions", {"kind": "simulated"})
    return str(made["id"])


def _command(admin: httpx2.Client, session: str, type_: str) -> None:
    version = admin.get(f"/api/sessions/{session}").raise_for_status().json()["version"]
    command = {"command_id": str(uuid.uuid4()), "expected_version": version, "type": type_}
    _post(admin, f"/api/sessions/{session}/commands", command)


def _tablet(server: LiveServer, admin: httpx2.Client, session: str) -> str:
    code = _post(admin, f"/api/sessions/{session}/pairings", {"device": "tablet"})["code"]
    with server.client() as tablet:
        _post(tablet, "/api/devices/pair", {"code": code})
        return _header(tablet)


def _header(client: httpx2.Client) -> str:
    return "; ".join(f"{name}={value}" for name, value in client.cookies.items())


def _post(client: httpx2.Client, path: str, body: dict[str, Any]) -> Any:
    return _answer(path, client.post(path, json=body, timeout=PATIENCE_S))


def _sent(client: httpx2.Client, path: str, name: str, content: bytes) -> Any:
    query = {"name": name}
    return _answer(path, client.post(path, params=query, content=content, timeout=PATIENCE_S))


def _answer(path: str, response: httpx2.Response) -> Any:
    if response.is_error:
        raise RuntimeError(f"POST {path}: {response.status_code} {response.text[:500]}")
    return response.json()
