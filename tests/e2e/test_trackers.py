"""Browser test of the page Trackers: real senders, seen, judged, put on limbs, switched off."""

import json
import socket
from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.adapters.live.packets import bundle, vmc
from tests.e2e.lab_people import make_account
from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.features.lab import STUDY, ok
from tests.support.datagrams import HERE, free_udp_port, sending
from tests.support.server import ADMIN_PASSWORD, LiveServer

NAMES = ("Waist", "LeftFoot", "RightFoot")
BONES = ("Hips", "LeftUpperLeg", "RightUpperLeg", "LeftLowerLeg", "RightLowerLeg")


def scripted(number: int) -> bytes:
    """Return a packet of a script that loses every tenth packet and doubles none."""
    pose = {"position_m": [0.1, 0.08, -0.2], "rotation_wxyz": [1, 0, 0, 0]}
    frame = number + number // 10
    return json.dumps(
        {"source": "shoe script", "time_s": number / 50, "frame": frame, "trackers": {"shoe": pose}}
    ).encode()


def _watch_and_record(
    page: Page, axe: Callable[[Page], list[str]], screenshot: Callable[[Page, str], object]
) -> None:
    """Watch the skeleton on a body over stairs, record it, and store it as a capture."""
    page.get_by_role("button", name=f"Watch on a body: {HERE}").press("Enter")
    panel = page.get_by_role("region", name=f"{HERE} on a body")
    picture = panel.get_by_role("img", name=f"{HERE}, moving a body, live")
    expect(picture).to_have_attribute("data-drawn", "skin", timeout=PATIENCE_MS)
    expect(panel.get_by_text("ms from arrival to sending")).to_be_visible(timeout=PATIENCE_MS)
    panel.get_by_label("Ground", exact=True).select_option("steps")
    panel.get_by_role("button", name="Agree on a pose").click()
    page.get_by_role("menuitem", name="Stands on the floor now").click()
    panel.get_by_role("button", name="Record").click()
    expect(panel.get_by_role("button", name="Stop and store")).to_be_visible()
    recordings = page.get_by_role("region", name="Recordings")
    expect(recordings.get_by_text(f"Recording {HERE}")).to_be_visible()
    assert axe(page) == []
    panel.scroll_into_view_if_needed()
    screenshot(page, "performer")
    recordings.get_by_role("button", name="Stop and store").click()
    expect(recordings.get_by_text(f"{HERE} is stored as a capture")).to_be_visible(
        timeout=PATIENCE_MS
    )
    expect(recordings.get_by_role("link", name="Open the capture")).to_be_visible()
    page.get_by_role("button", name=f"Hide the body: {HERE}").click()


def test_trackers_arrive_are_judged_and_are_put_on_limbs(
    live_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """Closed at first; doors are opened, two senders arrive, fall silent, and are forgotten.

    A skeleton moves a body, and a recording of it is stored as a capture. A door whose port is
    taken says so and opens when it is free; an operator opens none. A door that a session uses is
    closed after a question, and the session's cockpit says that it is closed.
    """
    page = page_factory()
    experimenter = Experimenter(page, live_server.url)
    experimenter.log_in()
    page.goto(f"{live_server.url}/#/equipment")
    page.get_by_role("link", name="Trackers from other software").click()
    expect(page.get_by_role("heading", name="All doors are closed")).to_be_visible()
    expect(page.get_by_text("Closed", exact=True)).to_have_count(3)
    assert axe(page) == []
    screenshot(page, "trackers-empty")

    taken = page.get_by_role("region", name="Scripts")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as busy:
        busy.bind((HERE, 0))
        port = busy.getsockname()[1]
        taken.get_by_label("Port").fill(str(port))
        taken.get_by_role("button", name="Open the door Scripts").click()
        expect(taken.get_by_text(f"has port {port}")).to_be_visible()
        expect(taken.get_by_text("Cannot open")).to_be_visible()
        assert axe(page) == []
        screenshot(page, "trackers-taken")
    expect(taken.get_by_text("Open", exact=True)).to_be_visible(timeout=PATIENCE_MS)
    taken.get_by_role("button", name="Close the door Scripts").click()

    ports = {"VMC and VRChat": free_udp_port(), "Scripts": free_udp_port()}
    for name, port in ports.items():
        door = page.get_by_role("region", name=name)
        door.get_by_label("Port").fill(str(port))
        door.get_by_role("button", name=f"Open the door {name}").press("Enter")
        expect(door.get_by_text(f"{HERE}:{port}", exact=True)).to_be_visible()

    def skeleton(_: int) -> bytes:
        bones = [vmc(one, what="Bone") for one in BONES]
        return bundle(*[vmc(one) for one in NAMES], *bones)

    with sending(ports["VMC and VRChat"], skeleton), sending(ports["Scripts"], scripted):
        suit = page.get_by_role("region", name=f"{HERE} {HERE}:")
        shoe = page.get_by_role("region", name="shoe script")
        expect(suit.get_by_role("row")).to_have_count(1 + len(NAMES), timeout=PATIENCE_MS)
        expect(shoe.get_by_role("row").nth(1)).to_contain_text("0.08")
        expect(shoe.get_by_text("±")).to_be_visible(timeout=PATIENCE_MS)
        suit.get_by_label("Limb of LeftFoot").select_option("Left foot")
        expect(suit.get_by_label("Limb of LeftFoot")).to_have_value("LeftFoot")
        shoe.get_by_label("Limb of shoe").select_option("Left foot")
        expect(page.get_by_text("Two trackers are on the same limb")).to_be_visible()
        shoe.get_by_label("Limb of shoe").select_option("Right foot")
        expect(page.get_by_text("Two trackers are on the same limb")).to_be_hidden()
        suit.get_by_text("5 bones").click()
        expect(suit.get_by_role("row")).to_have_count(2 + len(NAMES) + len(BONES))
        _watch_and_record(page, axe, screenshot)
        assert axe(page) == []
        page.mouse.wheel(0, -9000)
        screenshot(page, "trackers")
    expect(page.get_by_text("Silent for")).to_have_count(2, timeout=PATIENCE_MS)

    for scheme, size, name in (("dark", (1280, 800), "dark"), ("dark", (1180, 820), "1180")):
        other = page_factory(size, color_scheme=scheme)
        Experimenter(other, live_server.url).log_in()
        other.goto(f"{live_server.url}/#/trackers")
        expect(other.get_by_text("Silent for")).to_have_count(2)
        assert axe(other) == []
        screenshot(other, f"trackers-{name}")

    operator = page_factory((1180, 820))
    with live_server.client() as admin:
        ok(admin.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        invited = ok(admin.post("/api/invitations", json={"role": "operator"}))
        wish = {"participant_code": "P07"}
        session = ok(admin.post(f"/api/studies/{STUDY}/sessions", json=wish))["id"]
        chosen = {"door": "json", "source": "shoe script"}
        ok(admin.put(f"/api/sessions/{session}/trackers", json=chosen))
    make_account(operator, invited["url"], "otto")
    operator.goto(f"{live_server.url}/#/trackers")
    expect(operator.get_by_text("opened and closed by admins")).to_be_visible()
    expect(operator.get_by_role("button", name="the door")).to_have_count(0)
    expect(operator.get_by_label("Limb of LeftFoot")).to_be_enabled()
    assert axe(operator) == []
    screenshot(operator, "trackers-operator")

    page.get_by_role("button", name="Close the door VMC and VRChat").click()
    page.get_by_role("button", name="Close the door Scripts").click()
    question = page.get_by_role("dialog", name="Close the door Scripts?")
    expect(question.get_by_role("listitem")).to_have_text(["P07: lab trackers"])
    page.wait_for_timeout(300)  # The dialog fades in; until then its colours are no colours.
    assert axe(page) == []
    screenshot(page, "trackers-closing")
    question.get_by_role("button", name="Keep open").click()
    expect(question).to_be_hidden()
    page.get_by_role("button", name="Close the door Scripts").click()
    question.get_by_role("button", name="Close anyway").click()
    expect(page.get_by_role("heading", name="All doors are closed")).to_be_visible()
    page.goto(f"{live_server.url}/#/sessions/{session}")
    lab = page.get_by_role("region", name="Lab trackers")
    expect(lab.get_by_text("The door is closed")).to_be_visible(timeout=PATIENCE_MS)
    lab.scroll_into_view_if_needed()
    screenshot(page, "trackers-closed-door")
    page.goto(f"{live_server.url}/#/people/audit")
    expect(page.get_by_text("closed the door Scripts for trackers")).to_have_count(2)
