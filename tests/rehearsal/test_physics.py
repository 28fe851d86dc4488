"""Tests of rehearsals with a physics avatar: real contacts and real joint errors."""

import asyncio
import re
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from httpx2 import AsyncClient
from sqlalchemy import select

from app.adapters.humanoids import read_humanoid
from app.client.http import ServerRefusedError, call
from app.client.telemetry import TelemetryClient
from app.database import open_database
from app.models import JointErrorRow
from app.rehearsal.cast import Cast, perform
from app.rehearsal.frame_clock import FrameClock
from app.rehearsal.headset import Headset
from app.rehearsal.rehearse import (
    RehearsalPlan,
    RehearsalReport,
    assembled,
    physics_variant,
    report_of,
)
from app.science.avatar.body import FINGER_PARTS, Figure, figure_of
from app.science.avatar.mjcf import avatar_model, default_configuration, scene_of
from app.science.rotations import identity
from app.science.skeleton import Pose, build_skeleton
from app.simulated_people.avatars import PhysicsBody
from app.simulated_people.body import make_person
from app.wire.messages import CompletionReport, ContactReport
from tests.features.lab import Json, ok
from tests.protocol.helpers import edited, study
from tests.rehearsal.orders import InstantServer, order
from tests.rehearsal.test_headset import AS_FAST_AS_IT_GOES
from tests.support.humanoid_files import humanoid_file
from tests.support.server import ADMIN_PASSWORD, LiveServer

KEY = "short-study"
SPEED = 5.0
FEET = "      - limb: foot\n"
CAST = "        avatar_changes: {casts: [{group: left_arm}]}\n"
SUMMARIES_WITHIN_S = 60.0


def short() -> str:
    """Return the shipped study with short phases."""
    text = edited(("key: reembodiment-latency", f"key: {KEY}"))
    text = text.replace("duration_s: 120", "duration_s: 1")
    text = text.replace("duration_s: 60", "duration_s: 3")
    return re.sub(r"(preparation_s|freeze_s): 5", r"\1: 0.5", text)


def shaped(*, width: float, arms: float) -> Figure:
    """Return the figure of the synthetic model with narrower shoulders and shorter arms."""
    figure = figure_of(read_humanoid(humanoid_file()).humanoid)
    places = {}
    for part, (x, y, z) in figure.places_m.items():
        side = 1.0 if x > 0.0 else -1.0
        root = abs(figure.places_m["LeftUpperArm"][0])
        beyond = abs(x) - root
        own = part.endswith(("UpperArm", "LowerArm", "Hand")) or part in FINGER_PARTS
        places[part] = (side * (width * root + arms * beyond), y, z) if own else (x, y, z)
    return replace(figure, places_m=places)


@dataclass(frozen=True)
class BuiltHere:
    """A connection that builds the avatar in this process, with the shipped study's boxes."""

    figure: Figure | None = None

    async def request_avatar(self, stature_m: float, body: str | None = None) -> PhysicsBody:
        """Return the avatar as the server would build it."""
        assert body is None
        tasks = study().tasks
        configuration = default_configuration()
        if self.figure is not None:
            configuration = replace(configuration, humanoid="0" * 64)
        scene = scene_of(tuple(tasks.layouts().values()))
        built = avatar_model(configuration, stature_m, figure=self.figure, scene=scene)
        scale = built.body.parts["Hips"].joint_m[1] / build_skeleton(stature_m).standing_hips_m
        hips_scale = 1.0 if self.figure is None else scale
        return PhysicsBody(built.mjcf, configuration, hips_scale)


def play(
    limb: str, duration_s: float, latency_ms: float = 0.0, figure: Figure | None = None
) -> tuple[InstantServer, Headset]:
    """Run a whole phase with a physics avatar, with the product's own body or this figure."""
    server = InstantServer(
        order(limb=limb, kind="task", duration_s=duration_s, latency_ms=latency_ms)
    )
    person = make_person(np.random.default_rng(3), None)
    client = cast("TelemetryClient", server)
    clock = FrameClock(AS_FAST_AS_IT_GOES)
    headset = Headset(client, person, study().tasks, clock, BuiltHere(figure))
    asyncio.run(headset.run())
    return server, headset


@pytest.mark.parametrize("limb", ["hand", "foot"])
def test_a_physics_avatar_completes_tasks_by_real_contacts(limb: str) -> None:
    """A physics avatar completes tasks by real contacts of the right limb."""
    server, headset = play(limb, 20.0)
    contacts = [one for one in server.reports if isinstance(one, ContactReport)]
    completions = [one for one in server.reports if isinstance(one, CompletionReport)]
    assert completions
    green = {one.body_part for one in contacts if one.effect in ("green", "completed")}
    ends = {"RightHand"} if limb == "hand" else {"LeftFoot", "LeftToes", "RightFoot", "RightToes"}
    assert green
    assert green <= ends | {"LeftHand"}
    assert {one.surface.split("/")[0] for one in contacts} == {limb}
    assert headset.completions == len(completions)


def test_a_body_with_other_arms_completes_tasks_by_sight() -> None:
    """Worn with arms 15 % shorter and narrow shoulders, hands reach the boxes they are seen at."""
    figure = shaped(width=0.6, arms=0.85)
    server, headset = play("hand", 30.0, figure=figure)
    assert [one for one in server.reports if isinstance(one, CompletionReport)]
    person = headset._person
    off = person.participant.learned_m(f"{person.handedness.capitalize()}Hand")
    assert 0.08 < np.linalg.norm(off) < 0.3


def test_an_avatar_with_longer_legs_stands_on_the_same_floor() -> None:
    """An avatar with longer legs stands on the same floor, with proportionally higher hips."""
    built = avatar_model(default_configuration(), 1.8)
    person = build_skeleton(1.6)
    scale = built.body.parts["Hips"].joint_m[1] / person.standing_hips_m
    body = PhysicsBody(built.mjcf, default_configuration(), scale)
    for t_s, share in ((1.0, 1.0), (1.1, 0.9)):
        height_m = share * person.standing_hips_m
        shown = body.frame(t_s, Pose(np.array([0.1, height_m, 0.2]), identity(22)))
        assert shown.root_position_m == pytest.approx([0.1, scale * height_m, 0.2])


def test_a_whole_session_is_rehearsed_in_a_physics_avatar(tmp_path: Path) -> None:
    """A session with a physics avatar completes and records configuration and joint errors.

    Its study puts the left arm in a cast in every phase of the feet, and the operator switches
    gravity off: the headset reports when each change took effect, and when it ended.
    """
    with LiveServer(tmp_path) as server, server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        ok(api.post("/api/studies", json={"yaml": short()}))
        assert again(server, KEY) == again(server, f"{KEY}-physics") == f"{KEY}-physics"
        (version,) = ok(api.get(f"/api/studies/{KEY}-physics"))["versions"]
        assert version["number"] == 1
        yaml = ok(api.get(f"/api/studies/{KEY}-physics"))["yaml"].replace(FEET, FEET + CAST)
        ok(api.post(f"/api/studies/{KEY}-physics/versions", json={"yaml": yaml}))
        plan = RehearsalPlan(
            url=server.url,
            study=f"{KEY}-physics",
            speed=SPEED,
            seed=3,
            password=ADMIN_PASSWORD,
            physics=True,
        )
        report: RehearsalReport = asyncio.run(rehearsed_with_a_change(plan))
        session = f"/api/sessions/{report.session_id}"
        view, events = ok(api.get(session)), ok(api.get(f"{session}/events"))
        feet = [one["phase_id"] for one in report.phases if one["limb"] == "foot"]
        replay = ok(api.get(f"{session}/phases/{feet[0]}/replay"))
        standard: Json = ok(api.get("/api/avatars/standard"))
        errors = summarised(f"sqlite:///{server.data_dir / 'reembody.sqlite'}", report)
    assert (view["status"], view["avatar"], report.avatar) == ("completed", "physics", "physics")
    assert view["avatar_configuration_hash"] == standard["newest"]["content_hash"]
    (built,) = (one["data"] for one in events if one["type"] == "avatar_built")
    assert built["configuration_hash"] == view["avatar_configuration_hash"]
    assert report.frames_sent == report.frames_stored
    assert report.contacts > 0
    # The delayed command is followed to a few degrees if nothing is in the way.
    assert 0.0 < np.median(errors["command"]) < np.radians(5.0)
    assert np.median(errors["present"]) >= np.median(errors["command"])
    changed = [one for one in events if one["type"] == "avatar_changed"]
    by_study = [one["data"]["phase_id"] for one in changed if one["data"]["by"] == "study"]
    assert by_study == feet
    arm = ["LeftUpperArm", "LeftLowerArm", "LeftHand"]
    (settings,) = replay["avatar_settings"]
    assert settings == {"t_s": 0.0, "held_parts": arm, "passing_parts": []}
    assert [one["data"]["changes"] for one in changed if one["data"]["by"] == "operator"] == [
        {"gravity": False}
    ]
    ends = [one["seq"] for one in events if one["type"] == "phase_ended"]
    revisions = {one["seq"] for one in changed} | {
        next(end for end in ends if end > one["seq"])
        for one in changed
        if one["data"]["by"] == "study"
    }
    reported = [one["data"] for one in events if one["type"] == "avatar_change_reported"]
    assert all(one["applied"] for one in reported)
    # The last phase ends the session's movement soon after, perhaps before the headset has reacted.
    assert revisions - {one["revision"] for one in reported} <= {max(revisions)}
    times_s = [one["client_t_s"] for one in reported]
    assert times_s == sorted(times_s)


async def rehearsed_with_a_change(plan: RehearsalPlan) -> RehearsalReport:
    """Rehearse a session, in which the operator switches gravity off once the body appears."""
    async with assembled(plan) as cast:
        async with asyncio.TaskGroup() as group:
            group.create_task(perform(cast))
            group.create_task(switch_gravity_off(cast))
        return await report_of(cast, plan, 0.0)


async def switch_gravity_off(cast: Cast) -> None:
    """Change the avatar as soon as the session allows it, whatever else changes meanwhile."""
    while True:
        view = await cast.operator.view()
        if "change_avatar" in view["allowed"]:
            try:
                await cast.operator.command(
                    view, "change_avatar", avatar_changes={"gravity": False}
                )
                return
            except ServerRefusedError as error:
                if error.code != "stale":
                    raise
        await asyncio.sleep(0.05)


def again(server: LiveServer, study_key: str) -> str:
    """Return the study as another rehearsal would use it."""

    async def ask() -> str:
        async with AsyncClient(base_url=server.url) as http:
            credentials = {"username": "admin", "password": ADMIN_PASSWORD}
            await call(http, "POST", "/api/login", credentials)
            return await physics_variant(http, study_key)

    return asyncio.run(ask())


def summarised(url: str, report: RehearsalReport) -> dict[str, list[float]]:
    """Wait for the summaries; return the mean angles of each joint and phase by reference."""
    database, give_up_s = open_database(url), time.monotonic() + SUMMARIES_WITHIN_S
    query = select(JointErrorRow.phase_id, JointErrorRow.reference, JointErrorRow.mean_rad).where(
        JointErrorRow.session_id == report.session_id, JointErrorRow.axis == "angle"
    )
    try:
        while time.monotonic() < give_up_s:
            with database.reading() as db:
                rows = db.execute(query).all()
            if len({phase_id for phase_id, _, _ in rows}) == len(report.phases):
                return {
                    reference: [mean or 0.0 for _, of, mean in rows if of == reference]
                    for reference in ("present", "command")
                }
            time.sleep(0.1)
    finally:
        database.close()
    raise AssertionError(f"no joint errors of all phases within {SUMMARIES_WITHIN_S:g} s")
