"""A lab with a blinded study and accounts in several roles, for browser tests."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import httpx2
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS
from tests.features.lab import ok
from tests.support.server import ADMIN_PASSWORD, LiveServer

STUDY = "reembodiment-latency"
PASSWORD = "three wet umbrellas"


@dataclass(frozen=True)
class BlindedLab:
    """A server whose shipped study is blinded, and its admin's own client."""

    server: LiveServer
    admin: httpx2.Client

    def invitation(self, role: str) -> str:
        """Return the link of a new invitation to all studies."""
        url = ok(self.admin.post("/api/invitations", json={"role": role}))["url"]
        assert isinstance(url, str)
        return url

    def session(self, code: str) -> str:
        """Return the URL of a new session's cockpit."""
        wish = {"participant_code": code}
        made = ok(self.admin.post(f"/api/studies/{STUDY}/sessions", json=wish))
        return f"{self.server.url}/#/sessions/{made['id']}"


@contextmanager
def blinded_lab(server: LiveServer) -> Iterator[BlindedLab]:
    """Return a lab whose shipped study is blinded by a new version."""
    with server.client() as admin:
        ok(admin.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        yaml = ok(admin.get(f"/api/studies/{STUDY}"))["yaml"]
        blinded = yaml.replace("operator: false", "operator: true")
        assert blinded != yaml
        ok(admin.post(f"/api/studies/{STUDY}/versions", json={"yaml": blinded}))
        yield BlindedLab(server, admin)


def make_account(page: Page, link: str, name: str) -> None:
    """Follow an invitation's link, and choose a name and a password."""
    page.goto(link)
    page.get_by_label("User name").fill(name)
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.get_by_label("Repeat password").fill(PASSWORD)
    page.get_by_role("button", name="Create account").click()
    expect(page.get_by_role("heading", name="Studies")).to_be_visible(timeout=PATIENCE_MS)


def invite_in(page: Page, role: str, note: str) -> str:
    """Invite someone on the console's People page and return the link."""
    page.get_by_role("button", name="Invite someone").click()
    page.get_by_role("radio", name=role).click()
    page.get_by_label("Who is it for?").fill(note)
    page.get_by_role("button", name="Create link").click()
    link = page.get_by_label("Link", exact=True)
    expect(link).to_have_value(re.compile(r"/#/join/.{40,}"))
    url = link.input_value()
    page.get_by_role("button", name="Done").click()
    return url


Pages = Callable[..., Page]
