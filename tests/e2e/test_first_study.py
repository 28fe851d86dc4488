"""Browser test of a whole first study: console, tablet and headset on the real server."""

import csv
import io
import re
import zipfile
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN, Experimenter, Participant
from tests.e2e.wearer import Wearer
from tests.protocol.helpers import STUDY as FILE
from tests.support.browser import PageWatch
from tests.support.server import ADMIN_PASSWORD, LiveServer

STUDY = "short-study"
# The expert's answers of Karas (2020), table 7.2 (hand phase, 0 ms), and any for the two unscored.
EXPERT = {
    f"q{number}": str(value)
    for number, value in enumerate((2, 1, 1, 5, 1, 7, 7, 2, 1, 6, 1, 3, 4, 7), start=1)
}
DEMOGRAPHICS = {
    "age": "31",
    "sex": "not_stated",
    "height_cm": "172",
    "occupation": "student",
    "handedness": "right",
    "footedness": "right",
    "vision": "yes",
    "colour_blind": "no",
    "stereo_vision": "yes",
    "motion_sickness": "no",
    "hand_eye_coordination": "4",
    "foot_eye_coordination": "3",
    "vr_familiarity": "2",
}


def short_study(task_s: float = 4) -> str:
    """Return the shipped study with short durations, so that a whole session fits into a test."""
    text = FILE.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
    text = text.replace("duration_s: 120", f"duration_s: {task_s / 2}")
    text = re.sub(r"duration_s: 60", f"duration_s: {task_s}", text)
    return re.sub(r"(preparation_s|freeze_s): 5", r"\1: 0.5", text)


@pytest.fixture
def pages(
    live_server: LiveServer, page_factory: Callable[..., Page], page_watch: PageWatch
) -> tuple[Experimenter, Participant]:
    """Provide an experimenter at a console and a participant at a tablet."""
    # An unpaired tablet requests its state once and gets 401.
    page_watch.allow(r"status of 401")
    console, tablet = page_factory((1280, 800)), page_factory((1180, 820))
    return Experimenter(console, live_server.url), Participant(tablet, live_server.url)


@pytest.mark.parametrize(
    ("task_s", "watched"), [(1.5, False), pytest.param(4.0, True, marks=pytest.mark.long)]
)
def test_a_whole_session_from_login_to_csv(
    pages: tuple[Experimenter, Participant],
    live_server: LiveServer,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    task_s: float,
    watched: bool,  # noqa: FBT001 - by parameter
) -> None:
    """After a whole session run through the pages, the dashboard and the CSV contain its score."""
    experimenter, participant = pages
    if not watched:
        experimenter.page.add_init_script(PICTURE_HIDDEN)
    with live_server.client() as api:
        api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        assert api.post("/api/studies", json={"yaml": short_study(task_s)}).status_code == 201
    experimenter.log_in()
    experimenter.open_tab(STUDY)
    experimenter.create_session()
    participant.pair(experimenter.code_for("tablet"))
    with Wearer(live_server.url, experimenter.code_for("headset")) as wearer:
        experimenter.start()
        participant.agree()
        participant.fill_in(DEMOGRAPHICS)
        participant.have_read()
        experimenter.sees_step("Height")
        experimenter.match_height("172", "171.5")
        experimenter.press("Begin free movement")
        for _ in range(3):
            for limb in ("hand", "foot"):
                experimenter.press(f"Begin {limb} task")
                participant.page.locator('[data-name^="q"]').first.wait_for(timeout=PATIENCE_MS)
                participant.fill_in(EXPERT)
                participant.waits()
        assert axe(experimenter.page) == []
        screenshot(experimenter.page, "session-debriefing")
        experimenter.press("Finish session")
        experimenter.sees_step("Session completed")
    assert wearer.error is None
    screenshot(experimenter.page, "session-completed")
    experimenter.open_tab(STUDY, "dashboard")
    expect(experimenter.page.get_by_text("from 1 valid session")).to_be_visible(timeout=PATIENCE_MS)
    figure = experimenter.page.locator(".js-plotly-plot").first
    expect(figure).to_be_visible(timeout=PATIENCE_MS)
    assert axe(experimenter.page) == []
    screenshot(experimenter.page, "dashboard-one-session")
    experimenter.open_tab(STUDY, "export")
    with experimenter.page.expect_download(timeout=PATIENCE_MS) as download:
        experimenter.press("Download (zip")
    archive = zipfile.ZipFile(download.value.path())
    scores = _table(archive, "scores.csv")
    embodiment = [float(row["value"]) for row in scores if row["score"] == "soe_thesis"]
    assert embodiment == pytest.approx([1.0407407407] * 6)
    assert {row["simulated"] for row in scores} == {"false"}


def _table(archive: zipfile.ZipFile, name: str) -> list[dict[str, str]]:
    [path] = [path for path in archive.namelist() if path.endswith(name)]
    return list(csv.DictReader(io.StringIO(archive.read(path).decode())))
