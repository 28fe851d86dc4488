"""A visit with a canary text in all data that a participant leaves, and a search for it."""

import hashlib
import io
import zipfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import (
    JSON,
    Column,
    ColumnElement,
    Engine,
    LargeBinary,
    MetaData,
    String,
    Table,
    case,
    cast,
    func,
    literal,
    select,
)

from app.wire import BODY_STREAMS
from tests.features.lab import STUDY, Json, key, ok
from tests.features.record.headset.site import Site
from tests.wire.samples import message, standing

CANARY = "CANARY-7f3a91c2"
FRAMES = 180
SHEET = {"place": "Folder A, sheet 12", "reason": "No tablet in this test"}


@dataclass(frozen=True)
class Visit:
    """A participant's visit, whose texts contain the code and whose frames contain `height_m`."""

    session_id: str
    participant_id: str
    code: str
    headset_token: str = ""

    @property
    def needles(self) -> tuple[bytes, bytes]:
        """Return what to search for: the code, and its `height_m` twice in single precision."""
        return self.code.encode(), np.float32(height_m(self.code)).tobytes() * 2


def height_m(code: str) -> float:
    """Return an impossible hip height (m) that marks the frames of a participant's code."""
    return 1000.0 + int(hashlib.sha256(code.encode()).hexdigest()[:6], 16) / 7919


def make_visit(site: Site, code: str = CANARY) -> Visit:
    """Run part of a session whose notes, answers, devices, contacts and movement carry a code."""
    session_id = site.join(kind="people", participant_code=code)
    _pair_tablet(site, session_id, name=code)
    site.command(session_id, "start")
    site.command(session_id, "complete_step", paper_consent=SHEET)
    submit(site, session_id, occupation=code, sex_self_description=code)
    _refused_form(site, session_id, code)
    site.command(session_id, "note", text=f"They said {code}.")
    view = site.view(session_id)
    while view["steps"][view["current"]["index"]]["kind"] != "questionnaire":
        view = site.command(session_id, "skip", reason=f"because {code}")
    submit(site, session_id, problems=code)
    token = site.token(session_id)
    with site.headset(token) as headset:
        for first in range(0, FRAMES, 9):
            for stream in BODY_STREAMS:
                headset.say(message(_frames(code), stream=stream, seq_first=first))
        headset.acknowledged("actual", FRAMES)
        headset.reported(kind="materialised", t_s=1.0)
    return Visit(session_id, participant_of(site, session_id)["id"], code, token)


def participant_of(site: Site, session_id: str) -> Json:
    """Return the participant of a session, as the participants page lists them."""
    listed: list[Json] = ok(site.operator.get(f"/api/studies/{STUDY}/participants"))
    return next(one for one in listed if session_id in [own["id"] for own in one["sessions"]])


def submit(site: Site, session_id: str, **given: object) -> Json:
    """Submit the form that is due; items that are not given get their lowest answer."""
    due = ok(site.operator.get(f"/api/sessions/{session_id}/administration"))
    body = _filled(due, given)
    receipt: Json = ok(site.operator.post(f"/api/sessions/{session_id}/submissions", json=body))
    return {**receipt, "body": body, "instrument": due["instrument"]}


def erase(site: Site, visit: Visit, reason_code: str = "requested") -> Json:
    """Erase the participant of a visit."""
    path = f"/api/studies/{STUDY}/participants/{visit.participant_id}/erasure"
    answer = site.operator.post(path, json={"confirm": visit.code, "reason_code": reason_code})
    erased: Json = ok(answer)
    return erased


def _pair_tablet(site: Site, session_id: str, name: str) -> None:
    path = f"/api/sessions/{session_id}/pairings"
    code = ok(site.operator.post(path, json={"device": "tablet"}))["code"]
    with site.server.client() as device:
        ok(device.post("/api/devices/pair", json={"code": code, "name": name}))


def _refused_form(site: Site, session_id: str, code: str) -> None:
    """Submit other answers to a form that is already stored; they are kept as a refused form."""
    forms = ok(site.operator.get(f"/api/sessions/{session_id}/answers"))
    body = {
        "idempotency_key": key(),
        "administration": forms[0]["administration"],
        "answers": {**forms[0]["answers"], "occupation": f"no, {code}"},
        "shown_order": forms[0]["shown_order"],
        "seed": 1,
        "language": "en",
    }
    answer = site.operator.post(f"/api/sessions/{session_id}/submissions", json=body)
    assert answer.status_code == 409, answer.text


def _filled(due: Json, given: dict[str, object]) -> Json:
    answers: Json = {}
    for item in due["instrument"]["items"]:
        scale = item.get("scale") or due["instrument"].get("scale") or {}
        match item["type"]:
            case "likert":
                answers[item["key"]] = scale["minimum"]
            case "choice":
                answers[item["key"]] = item["choices"][0]["key"]
            case "boolean":
                answers[item["key"]] = False
            case "text":
                answers[item["key"]] = "words"
            case _:
                answers[item["key"]] = item["minimum"]
    return {
        "idempotency_key": key(),
        "administration": due["key"],
        "answers": {**answers, **given},
        "shown_order": due["item_order"],
        "seed": due["seed"],
        "language": "en",
        "timings": dict.fromkeys(due["item_order"], 1.5),
    }


def _frames(code: str) -> "np.ndarray[tuple[int, int], np.dtype[np.float32]]":
    frames = standing(9)
    frames[:, 1:3] = height_m(code)
    return frames


def in_files(visit: Visit, paths: Iterable[Path]) -> dict[str, int]:
    """Return how often a visit's data occur in each file; files without them are left out."""
    found = {}
    for path in paths:
        if path.is_file():
            count = in_bytes(visit, path.read_bytes())
            if count:
                found[str(path)] = count
    return found


def in_bytes(visit: Visit, data: bytes) -> int:
    """Return how often a visit's data occur in a byte string, including inside ZIP archives."""
    count = sum(data.count(needle) for needle in visit.needles)
    if data[:4] == b"PK\x03\x04":
        printed = f"{height_m(visit.code):.2f}".encode()
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for name in archive.namelist():
                member = archive.read(name)
                count += in_bytes(visit, member) + in_bytes(visit, name.encode())
                count += member.count(printed)
    return count


def in_tables(visit: Visit, engine: Engine) -> dict[str, int]:
    """Count the rows in which a visit's data occur, by table and text, JSON or byte column."""
    found: dict[str, int] = {}
    with engine.connect() as connection:
        for table in _tables(engine):
            places = [
                (f"{table.name}.{column.name}", place)
                for column in table.columns
                for place in _places(visit, column, engine.dialect.name)
            ]
            if not places:
                continue
            counts = [func.count(case((place > 0, 1))) for _, place in places]
            counted = connection.execute(select(*counts).select_from(table)).one()
            found |= {name: rows for (name, _), rows in zip(places, counted, strict=True) if rows}
    return found


def _tables(engine: Engine) -> list[Table]:
    """Return the tables of the database, cached because tests never change the schema."""
    url = str(engine.url)
    if url not in _REFLECTED:
        metadata = MetaData()
        metadata.reflect(engine)
        _REFLECTED[url] = metadata.sorted_tables
    return _REFLECTED[url]


_REFLECTED: dict[str, list[Table]] = {}


def _places(visit: Visit, column: Column[Any], dialect: str) -> Iterator[ColumnElement[int]]:
    """Yield the 1-based position of each needle in a column; nothing for numeric columns."""
    if isinstance(column.type, LargeBinary):
        find = func.instr if dialect == "sqlite" else func.position
        for needle in visit.needles:
            expected = literal(needle)
            yield find(column, expected) if dialect == "sqlite" else find(expected.op("IN")(column))
    elif isinstance(column.type, String | JSON):
        as_text = cast(column, String)
        find = func.instr if dialect == "sqlite" else func.strpos
        yield find(as_text, literal(visit.code))
