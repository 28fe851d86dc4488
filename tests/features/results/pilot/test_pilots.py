"""Tests of pilots over HTTP: the same bytes as the command, stopping, waiting, refusals."""

import hashlib
import threading
from pathlib import Path

import pytest
from sqlalchemy import delete, func, select

from app.cli.pilot.inputs import read_study
from app.features.results.pilot import PilotQueue
from app.features.results.pilot.folder import PilotFolder, StageProgress
from app.features.results.pilot.order import CannotSimulate, PilotOrder
from app.features.results.pilot.pilot_queue import is_in_session
from app.features.results.pilot.simulation import (
    CohortOrder,
    PilotStudy,
    Progress,
    simulate_cohort,
)
from app.features.results.pilot.worker_tasks import _Course, run_pilot
from app.models import Participant, PilotRow, StudySession
from tests.features.lab import STUDY, Lab, error, ok
from tests.features.results.pilot.pilots import KEY, PATH, ordered, settled, short_study

_PEOPLE = 2
_POWER = f"/api/studies/{STUDY}/pilots"


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[PilotStudy, bytes]:
    """Return the short study, and the record that the command writes of it."""
    folder = tmp_path_factory.mktemp("command")
    (folder / "study.yaml").write_text(short_study(), encoding="utf-8")
    study = read_study(str(folder / "study.yaml"))
    record = folder / "cohort.jsonl"
    simulate_cohort(study, CohortOrder(_PEOPLE, 5), lambda _: None, record=record)
    return study, record.read_bytes()


def _assumptions(lab: Lab) -> str:
    defaults = ok(lab.operator.get(f"/api/studies/{STUDY}/pilot-defaults"))
    assert defaults["numbers"] == [6, 9, 12, 18, 24]
    assert defaults["most_participants"] is None
    # Six minutes of tasks, about 24 s of processor time for one person with physics.
    assert defaults["person_s"]["physics"] == pytest.approx(24.0)
    return str(defaults["assumptions"])


def test_a_cohort_has_the_bytes_of_the_command(
    study: Lab, written: tuple[PilotStudy, bytes]
) -> None:
    """The page's cohort has the record of the command, adds nobody, and is deleted as one."""
    begun = ordered(study, kind="cohort", participants=_PEOPLE, seed=5)
    assert begun["simulated"] is True
    assert begun["avatar"] == "delayed_copy"
    pilot = settled(study, begun["id"])
    assert (pilot["state"], pilot["trouble"], pilot["progress"]) == ("ready", None, None)
    record = study.operator.get(f"{PATH}/{pilot['id']}/record").content
    assert record == written[1]
    figures = pilot["figures"]
    assert figures["sha256"] == hashlib.sha256(record).hexdigest()
    assert (figures["failures"], figures["unfinished"]) == (0, 0)
    assert {one["stature_m"] for one in figures["reach"]} == {1.518, 1.869}
    assert {one["latency_ms"] for one in figures["phases"]} == {0.0, 200.0}
    for one in figures["phases"]:
        # In phases of 3 s nobody completes a task, so there are no shares.
        assert {one["share_of_lowest"], one["share_low"], one["share_high"]} == {None}
    idle = [(one["without"], one["people"], one["is_many"]) for one in figures["without_task"]]
    assert idle == [(_PEOPLE, _PEOPLE, True)] * 2
    assert f"{_PEOPLE} simulated people (seed 5)" in figures["ethics"]["en"]
    assert "Ein Termin der Studie „Zwei Verzögerungen, Handaufgabe“" in figures["ethics"]["de"]
    assert pilot["power"] is None
    assert "nothing is assumed yet" in pilot["preregistration"]["en"]
    (listed,) = ok(study.operator.get(PATH))
    assert listed["session_min"] == figures["session_min"]
    with study.database.reading() as db:
        assert db.scalar(select(func.count()).select_from(StudySession)) == 0
        assert db.scalar(select(func.count()).select_from(Participant)) == 0
    refused = error(
        study.operator.post(PATH, json={"kind": "cohort", "participants": _PEOPLE, "seed": 5}),
        409,
        "conflict",
    )
    assert "this very pilot already, and it is ready" in refused["message"]
    ok(study.operator.delete(f"{PATH}/{pilot['id']}"))
    assert ok(study.operator.get(PATH)) == []
    with study.database.reading() as db:
        assert db.scalar(select(func.count()).select_from(PilotRow)) == 0


@pytest.mark.one_engine
def test_a_killed_cohort_resumes(study: Lab, written: tuple[PilotStudy, bytes]) -> None:
    """A pilot that was stopped with half a line in its record ends with the same bytes."""
    released = threading.Event()
    queue = study.context.part(PilotQueue)
    queue._maker.submit(released.wait)
    begun = ordered(study, kind="cohort", participants=_PEOPLE, seed=5)
    path = f"{PATH}/{begun['id']}"
    assert begun["progress"]["waiting"]
    stopped = ok(study.operator.post(f"{path}/stop"))
    released.set()
    assert stopped["state"] == "stopped"
    error(study.operator.post(f"{path}/stop"), 409, "not_now")
    error(study.operator.get(f"{path}/record"), 409, "not_now")
    lines = written[1].splitlines(keepends=True)
    files = queue.files(begun["id"])
    files.cohort.write_bytes(lines[0] + lines[1] + lines[2][:50])
    ok(study.operator.post(f"{path}/resume"))
    assert settled(study, begun["id"])["state"] == "ready"
    assert study.operator.get(f"{path}/record").content == written[1]
    assert not files.folder.exists()
    ok(study.operator.delete(path))


@pytest.mark.one_engine
def test_a_pilot_waits_while_somebody_is_in_a_session(study: Lab) -> None:
    """Nobody is simulated while a session is active; afterwards the pilot goes on by itself."""
    view = study.command(study.join(), "start")
    begun = ordered(study, kind="cohort", participants=1, seed=6)
    queue = study.context.part(PilotQueue)
    for _ in range(200):
        at = ok(study.operator.get(f"{PATH}/{begun['id']}"))["progress"]
        if at["held"]:
            break
        threading.Event().wait(0.05)
    assert (at["held"], at["waiting"], at["done"]) == (True, False, 0)
    queue.look()
    assert queue.files(begun["id"]).is_held
    study.command(view, "abort", reason="The test needs the processor.")
    assert settled(study, begun["id"])["state"] == "ready"


@pytest.mark.one_engine
def test_a_simulated_participant_holds_no_pilot(study: Lab) -> None:
    """The demo lab and rehearsals need no pause: nobody is in their sessions."""
    study.command(study.join(kind="simulated"), "start")
    with study.database.reading() as db:
        assert not is_in_session(db)


@pytest.mark.one_engine
def test_a_pilot_ends_with_its_deleted_study(study: Lab) -> None:
    """A pilot whose row was deleted with its study neither goes on nor keeps its folder."""
    view = study.command(study.join(), "start")
    first, second = (
        ordered(study, kind="cohort", participants=1, seed=seed)["id"] for seed in (21, 22)
    )
    with study.database.writing() as db:
        db.execute(delete(PilotRow).where(PilotRow.id.in_([first, second])))
    queue = study.context.part(PilotQueue)
    queue.look()
    assert [queue.place_of(one) for one in (first, second)] == [None, None]
    assert not any(queue.files(one).folder.exists() for one in (first, second))
    study.command(view, "abort", reason="The test needs the processor.")


@pytest.mark.one_engine
def test_a_faulty_file_of_assumptions_holds_up_no_writer(study: Lab) -> None:
    """A file of assumptions is checked before the order takes its turn to write."""
    order = {"kind": "cohort", "participants": 1, "assumptions": "nonsense: 1\n"}
    with study.database.write_turn():
        error(study.operator.post(PATH, json=order), 422, "invalid_config")


@pytest.mark.one_engine
def test_the_power_of_a_study_is_simulated(study: Lab) -> None:
    """A power run gives the curve with its bands, levels and assumptions, and the paragraph."""
    begun = ordered(
        study,
        _POWER,
        kind="power",
        participants=[12, 6],
        seed=5,
        sets=60,
        assumptions=_assumptions(study),
    )
    assert begun["participants"] == [6, 12]
    pilot = settled(study, begun["id"], _POWER)
    assert pilot["figures"] is None
    power = pilot["power"]
    assert [one["n"] for one in power["power"]] == [6, 12]
    assert all(one["low"] <= one["power"] <= one["high"] for one in power["power"])
    assert not power["preregistered"]
    assert {one["source"] for one in power["assumptions"]} >= {"assumed"}
    names = power["names"]
    assert (power["test"]["instrument"], power["test"]["score"]) == ("karas2020", "agency")
    for language, words in (
        ("en", "Page’s trend test: score"),
        ("de", "Trendtest nach Page: Wert"),
    ):
        said = pilot["preregistration"][language]
        assert words in said
        assert names["score"][language] in said
        assert not {"page_trend", "karas2020"} & set(said.split())
        assert names["instrument"][language] in said


@pytest.mark.one_engine
def test_what_cannot_be_simulated_is_refused(study: Lab) -> None:
    """Unknown studies and pilots, too many people and faulty assumptions are refused in words."""
    cohort = {"kind": "cohort", "participants": 2}
    error(study.operator.post("/api/studies/nowhere/pilots", json=cohort), 404, "not_found")
    error(study.operator.get(f"{PATH}/nothing"), 404, "not_found")
    power = {"kind": "power", "participants": [6, 13], "assumptions": _assumptions(study)}
    refused = error(study.operator.post(PATH, json=power), 422, "invalid_input")
    assert "13 participants: the study's ledger has 12 slots" in refused["message"]
    wrong = power | {"participants": [6], "assumptions": "study: another\n"}
    refused = error(study.operator.post(_POWER, json=wrong), 422, "invalid_config")
    assert "assumptions file has" in refused["message"]
    assert refused["details"]
    defaults = ok(study.operator.get(f"/api/studies/{KEY}/pilot-defaults"))
    assert (defaults["assumptions"], defaults["numbers"]) == (None, [6, 9, 12])
    assert f"study: {KEY}" in defaults["example"]
    unfit = power | {"participants": [6]}
    error(study.operator.post(PATH, json=unfit), 422, "invalid_config")


@pytest.mark.one_engine
def test_the_end_of_the_server_stops_a_pilot(study: Lab) -> None:
    """A pilot that the server's end interrupted is stopped, and folders of no pilot are removed."""
    released = threading.Event()
    queue = study.context.part(PilotQueue)
    queue._maker.submit(released.wait)
    begun = ordered(study, kind="cohort", participants=3, seed=7)
    queue.files("of-no-pilot").hold()
    queue.halt(begun["id"])
    queue.start()
    released.set()
    assert ok(study.operator.get(f"{PATH}/{begun['id']}"))["state"] == "stopped"
    assert [one.name for one in queue.folder.iterdir()] == [begun["id"]]
    ok(study.operator.delete(f"{PATH}/{begun['id']}"))
    assert list(queue.folder.iterdir()) == []


def test_a_full_disk_is_said(written: tuple[PilotStudy, bytes], tmp_path: Path) -> None:
    """A disk that takes no more bytes ends a pilot with what to do, and keeps what is finished."""
    study, record = written
    files = PilotFolder(tmp_path)
    files.cohort.write_bytes(record)
    # Whatever is written to this device fails as on a full disk.
    (tmp_path / "progress.part").symlink_to("/dev/full")
    options = {"participants": _PEOPLE, "seed": 5, "avatar": None}
    order = PilotOrder("cohort", study.study, study.instruments, options, None)
    with pytest.raises(CannotSimulate, match="data folder is full"):
        run_pilot(order, files)
    assert files.cohort.read_bytes() == record


def test_waiting_is_no_part_of_the_estimate(tmp_path: Path) -> None:
    """Four people in 10 s each leave 60 s for six, however long the pilot was held meanwhile."""
    now = [0.0]

    def sleep(seconds: float) -> None:
        now[0] += 100.0 * seconds
        files.let_go()

    files = PilotFolder(tmp_path)
    course = _Course(files, monotonic_s=lambda: now[0], sleep=sleep)
    course.tell(Progress("people", 0, 10))
    for done in range(1, 5):
        now[0] += 10.0
        if done == 2:
            files.hold()
            course.pause()
            assert not files.is_held
        course.tell(Progress("people", done, 10))
    assert files.progress() == StageProgress("people", 4, 10, 60.0)
