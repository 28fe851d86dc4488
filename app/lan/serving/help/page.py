"""The help page as HTML: no script, no external resources, all text escaped."""

import base64
import hashlib
import re
from dataclasses import dataclass
from datetime import datetime
from functools import cache
from html import escape
from importlib.resources import files
from string import Template

from app.lan.network import qr_svg
from app.lan.serving.help.texts import Device, HelpTexts, device_of

PAIRS_IN_A_GROUP = 4


@dataclass(frozen=True)
class HelpFacts:
    """The facts on the page: its own address, the https address, and the authority's certificate.

    `port` is the port that a USB cable forwards to.
    """

    here: str
    secure: str
    port: int
    fingerprint: str
    authority_ends: datetime


def help_page(facts: HelpFacts, texts: HelpTexts, user_agent: str) -> str:
    """Return the page, with the steps of the likeliest device unfolded."""
    likely = device_of(user_agent, texts)
    # Unfold one device at most; without a guess all are folded.
    ordered = sorted(texts.devices, key=lambda device: device.key != likely)
    words = {name: _rich(value) for name, value in vars(texts).items() if isinstance(value, str)}
    return Template(_read("page.html")).substitute(
        words,
        heading=words["title"],
        style=style(),
        other="de" if texts.language == "en" else "en",
        downloads=_downloads(texts, first_profile=likely == "ios"),
        fingerprint=_in_groups(facts.fingerprint),
        devices="\n".join(_section(one, facts.port, is_open=one.key == likely) for one in ordered),
        secure=escape(facts.secure, quote=True),
        here=escape(facts.here),
        qr=qr_svg(facts.here).replace("<svg", '<svg aria-hidden="true"', 1),
        until=_rich(texts.until.format(date=f"{facts.authority_ends:%Y-%m-%d}")),
    )


@cache
def style() -> str:
    """Return the page's style sheet."""
    return _read("page.css")


@cache
def style_hash() -> str:
    """Return the hash with which a content security policy allows only this style sheet."""
    digest = hashlib.sha256(style().encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def _section(device: Device, port: int, *, is_open: bool) -> str:
    steps = "".join(f"<li>{_rich(step.format(port=port))}</li>" for step in device.steps)
    unfolded = " open" if is_open else ""
    return f"<details{unfolded}><summary>{escape(device.name)}</summary><ol>{steps}</ol></details>"


def _downloads(texts: HelpTexts, *, first_profile: bool) -> str:
    """Return links to both files, the one that fits the device first and highlighted."""
    certificate = ("/reembody-ca.crt", texts.certificate)
    profile = ("/reembody.mobileconfig", texts.profile)
    first, other = (profile, certificate) if first_profile else (certificate, profile)
    return (
        f'<a class="button" href="{first[0]}">{escape(first[1])}</a>'
        f'<a class="button quiet" href="{other[0]}">{escape(other[1])}</a>'
    )


def _in_groups(fingerprint: str) -> str:
    pairs = fingerprint.split(":")
    groups = [pairs[at : at + PAIRS_IN_A_GROUP] for at in range(0, len(pairs), PAIRS_IN_A_GROUP)]
    return " ".join(f"<span>{':'.join(group)}</span>" for group in groups)


def _rich(text: str) -> str:
    """Escape a text, and format its `*bold*` and `` `code` ``."""
    bold = re.sub(r"\*(.+?)\*", r"<b>\1</b>", escape(text))
    return re.sub(r"`(.+?)`", r"<code>\1</code>", bold)


@cache
def _read(name: str) -> str:
    return (files("app.lan.serving.help") / name).read_text(encoding="utf-8")
