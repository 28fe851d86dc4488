"""Browser tests of accounts: invitation, blinding and ended logins."""

import time
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, Route, expect

from tests.e2e.lab_people import (
    PASSWORD,
    STUDY,
    BlindedLab,
    Pages,
    blinded_lab,
    invite_in,
    make_account,
)
from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.faults.figures import note
from tests.support.browser import ColorScheme, PageWatch
from tests.support.server import LiveServer

Axe = Callable[[Page], list[str]]
Screenshot = Callable[[Page, str], object]


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[BlindedLab]:
    """Provide one server for the tests of this file."""
    folder = tmp_path_factory.mktemp("people")
    with LiveServer(folder) as server, blinded_lab(server) as lab:
        yield lab


@pytest.fixture
def admin(lab: BlindedLab, page_factory: Pages) -> Page:
    """Provide the admin's browser, signed in."""
    console = Experimenter(page_factory(), lab.server.url)
    console.log_in()
    return console.page


def test_an_invited_operator_never_sees_the_condition(
    lab: BlindedLab, admin: Page, page_factory: Pages
) -> None:
    """An invited operator's new account can run sessions and never shows the condition."""
    admin.goto(f"{lab.server.url}/#/people")
    link = invite_in(admin, "Operator", "Weekend sessions")
    operator = page_factory()
    make_account(operator, link, "weekend")
    assert "join" not in operator.url
    operator.goto(f"{lab.server.url}/#/studies/{STUDY}")
    expect(operator.get_by_text("This study is blinded for you")).to_be_visible()
    expect(operator.get_by_role("link", name="Ledger")).to_be_visible()
    for tab in ("Dashboard", "Export", "Protocol", "Versions"):
        expect(operator.get_by_role("link", name=tab)).to_have_count(0)
    console = Experimenter(operator, lab.server.url)
    console.create_session()
    expect(operator.get_by_text("Order hidden (blinded)")).to_be_visible()
    expect(operator.get_by_text("latency hidden").first).to_be_visible()
    expect(operator.get_by_role("button", name="Show condition")).to_have_count(0)
    admin.get_by_role("tab", name="Invitations").click()
    expect(admin.get_by_text("by weekend")).to_be_visible()


def test_ending_a_login_asks_its_open_page_to_sign_in(
    lab: BlindedLab, admin: Page, page_factory: Pages, page_watch: PageWatch
) -> None:
    """When a login is ended, its open cockpit asks to sign in again and keeps the entered text."""
    page_watch.allow(r"status of 401")
    operator = page_factory()
    make_account(operator, lab.invitation("operator"), "lost-laptop")
    operator.goto(lab.session("P-LOST"))
    operator.get_by_label("New note").fill("half a sentence")
    expect(operator.get_by_text("Live", exact=True)).to_be_visible(timeout=PATIENCE_MS)
    admin.goto(f"{lab.server.url}/#/people")
    admin.get_by_role("button", name="Edit lost-laptop").click()
    admin.get_by_role("button", name="End sign-ins").click()
    ended_s = time.monotonic()
    expect(operator.get_by_text("You have been signed out")).to_be_visible(timeout=PATIENCE_MS)
    shut_s = time.monotonic() - ended_s
    note(31, "a login is ended", "seconds until its open page asks again", shut_s)
    expect(operator.get_by_text("P-LOST")).not_to_be_visible()
    expect(operator.get_by_label("User name")).to_have_value("lost-laptop")
    operator.get_by_label("Password", exact=True).fill(PASSWORD)
    operator.keyboard.press("Enter")
    expect(operator.get_by_label("New note")).to_have_value("half a sentence")
    expect(operator.get_by_text("Live", exact=True)).to_be_visible(timeout=PATIENCE_MS)


def test_another_account_in_a_second_tab_leaves_nothing_in_the_first(
    lab: BlindedLab, page_factory: Pages, page_watch: PageWatch
) -> None:
    """When another account signs in in a second tab, the first one shows that account at once.

    What it was not told of, it learns by its next request.
    """
    page_watch.allow(r"status of (401|409)")
    operator = page_factory()
    make_account(operator, lab.invitation("operator"), "first-tab")
    operator.goto(f"{lab.server.url}/#/studies/{STUDY}")
    expect(operator.get_by_text("This study is blinded for you")).to_be_visible()
    admin = operator.context.new_page()
    admin.goto(lab.server.url)
    admin.get_by_role("button", name="first-tab", exact=True).click()
    admin.get_by_role("menuitem", name="Sign out").click()
    expect(operator.get_by_label("User name")).to_be_visible()
    Experimenter(admin, lab.server.url).log_in()
    expect(operator.get_by_role("button", name="admin", exact=True)).to_be_visible()
    expect(operator.get_by_role("link", name="Dashboard")).to_be_visible()
    # As if the first tab had slept.
    wish = {"username": "first-tab", "password": PASSWORD}
    assert operator.context.request.post(f"{lab.server.url}/api/login", data=wish).ok
    operator.get_by_role("link", name="Ledger").click()
    expect(operator.get_by_role("button", name="first-tab", exact=True)).to_be_visible()
    expect(operator.get_by_role("link", name="Dashboard")).to_have_count(0)


def test_showing_a_condition_needs_a_reason_and_is_logged(lab: BlindedLab, admin: Page) -> None:
    """An admin sees a blinded order only after giving a reason, which the event log records."""
    admin.goto(lab.session("P-SHOWN"))
    admin.get_by_role("button", name="Show condition").click()
    dialog = admin.get_by_role("dialog")
    expect(dialog.get_by_role("button", name="Show condition")).to_be_disabled()
    dialog.get_by_text("Adverse event").click()
    dialog.get_by_role("button", name="Show condition").click()
    expect(admin.get_by_text("Order of latencies:")).to_be_attached()
    expect(admin.get_by_text("Order hidden (blinded)")).to_have_count(0)
    admin.get_by_role("button", name="Log").click()
    expect(admin.get_by_text("condition shown to the lab")).to_be_visible()


def test_two_clicks_or_a_lost_answer_make_one_session_and_one_link(
    lab: BlindedLab, admin: Page, page_watch: PageWatch
) -> None:
    """A form that is sent twice before the page is drawn, or again after a lost answer, acts once.

    So there is one session, and one invitation.
    """
    page_watch.allow(r"Failed to load resource")
    twice = "(button) => { button.click(); button.click(); }"
    sessions = f"/api/studies/{STUDY}/sessions"
    before = len(lab.admin.get(sessions).json())
    admin.goto(f"{lab.server.url}/#/studies/{STUDY}")
    answers: list[int] = []

    def lose_the_first(route: Route) -> None:
        if route.request.method != "POST" or answers:
            route.fallback()
            return
        answers.append(route.fetch().status)
        route.abort()

    admin.route(f"**{sessions}", lose_the_first)
    admin.get_by_role("button", name="New session").first.click()
    create = admin.get_by_role("button", name="Create session")
    create.evaluate(twice)
    expect(admin.get_by_text("Nothing on the server is lost")).to_be_visible()
    assert answers == [201]
    create.evaluate(twice)
    expect(admin.get_by_role("heading", name="Before the start")).to_be_visible()
    assert len(lab.admin.get(sessions).json()) == before + 1
    links = len(lab.admin.get("/api/invitations").json())
    admin.goto(f"{lab.server.url}/#/people")
    admin.get_by_role("button", name="Invite someone").click()
    admin.get_by_role("button", name="Create link").evaluate(twice)
    expect(admin.get_by_label("Link", exact=True)).to_be_visible()
    assert len(lab.admin.get("/api/invitations").json()) == links + 1


def test_an_invalid_invitation_link_says_why(
    lab: BlindedLab, admin: Page, page_factory: Pages, page_watch: PageWatch
) -> None:
    """A used, revoked or unknown invitation link explains why it fails, also if signed in."""
    page_watch.allow(r"status of (404|410|422)")
    link = lab.invitation("analyst")
    guest = page_factory()
    make_account(guest, link, "analyst")
    taken = lab.admin.get("/api/invitations").json()
    revoked = lab.invitation("analyst")
    fresh = {row["id"] for row in lab.admin.get("/api/invitations").json()}
    (id_,) = fresh - {row["id"] for row in taken}
    lab.admin.delete(f"/api/invitations/{id_}")
    admin.goto(link)
    expect(admin.get_by_text("You are signed in as admin")).to_be_visible()
    stranger = page_factory()
    for url, said in (
        (link, "This link has already been used"),
        (revoked, "This invitation was revoked"),
        (link[:-3], "This invitation does not exist"),
        (link[:-40], "This invitation does not exist"),
    ):
        stranger.goto("about:blank")
        stranger.goto(url)
        expect(stranger.get_by_text(said)).to_be_visible()


def test_the_only_admin_cannot_be_closed(
    lab: BlindedLab, admin: Page, page_watch: PageWatch
) -> None:
    """Closing the only admin account is rejected in the confirmation, with the remedy."""
    page_watch.allow(r"status of 409")
    admin.goto(f"{lab.server.url}/#/people")
    admin.get_by_role("button", name="Edit admin").click()
    admin.get_by_role("button", name="Close account").click()
    admin.get_by_role("button", name="Close account").click()
    expect(admin.get_by_text("Give somebody else the role admin first")).to_be_visible()


def test_a_page_that_a_role_may_not_open_says_so(lab: BlindedLab, page_factory: Pages) -> None:
    """A page that a role may not open shows a message, and an analyst's cockpit has no controls."""
    analyst = page_factory()
    make_account(analyst, lab.invitation("analyst"), "reader")
    for address in ("people", "network", "new", f"studies/{STUDY}/edit", "instruments/new"):
        analyst.goto(f"{lab.server.url}/#/{address}")
        expect(analyst.get_by_text("Your role has no access to this page")).to_be_visible()
    expect(analyst.get_by_role("link", name="People")).to_have_count(0)
    analyst.goto(lab.session("P-READ"))
    expect(analyst.get_by_text("View only")).to_be_visible()
    expect(analyst.get_by_role("button", name="Start session")).to_have_count(0)
    expect(analyst.get_by_role("button", name="Show condition")).to_have_count(0)
    analyst.goto(f"{lab.server.url}/#/avatars/standard/1")
    expect(analyst.get_by_role("link", name="Open version 1")).to_be_visible(timeout=PATIENCE_MS)
    analyst.get_by_role("tab", name="Joints").click()
    analyst.get_by_text("Joint per part", exact=True).click()
    expect(analyst.get_by_role("row", name="left knee")).to_be_visible()
    expect(analyst.get_by_role("button", name="Save", exact=True)).to_have_count(0)
    # What the page still asks for would be refused once it is signed out.
    expect(analyst.locator("[data-drawn=skin]")).to_be_visible(timeout=PATIENCE_MS)
    # It has no live feed that ends, and asks all the same.
    analyst.context.clear_cookies()
    expect(analyst.get_by_text("You have been signed out")).to_be_visible(timeout=PATIENCE_MS)


@pytest.mark.parametrize("scheme", ["light", pytest.param("dark", marks=pytest.mark.long)])
def test_the_account_pages_are_accessible(
    lab: BlindedLab, page_factory: Pages, axe: Axe, screenshot: Screenshot, scheme: ColorScheme
) -> None:
    """The pages and dialogs of accounts and invitations have no serious violation."""
    guest = page_factory((1180, 820), scheme)
    guest.goto(lab.invitation("experimenter"))
    expect(guest.get_by_text("Your role will be")).to_be_visible()
    assert axe(guest) == []
    screenshot(guest, f"join-{scheme}")
    console = Experimenter(page_factory((1280, 800), scheme), lab.server.url)
    console.log_in()
    page = console.page
    for address, shown in (
        ("people", "Last sign-in"),
        ("people/invitations", "Valid until"),
        ("people/audit", "signed in from"),
    ):
        page.goto(f"{lab.server.url}/#/{address}")
        expect(page.get_by_text(shown).first).to_be_visible()
        assert axe(page) == [], address
        screenshot(page, f"console-{address.replace('/', '-')}-{scheme}")
    page.get_by_role("button", name="Invite someone").click()
    expect(page.get_by_text("Who is it for?")).to_be_visible()
    assert axe(page) == []
    page.keyboard.press("Escape")
    page.get_by_role("button", name="admin", exact=True).click()
    expect(page.get_by_role("menuitem", name="Change password")).to_be_visible()
    assert axe(page) == []
    page.get_by_role("menuitem", name="Change password").click()
    expect(page.get_by_label("Current password")).to_be_visible()
    assert axe(page) == []
