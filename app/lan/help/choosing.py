"""Which language and which device's steps a browser is shown first."""

from app.lan.help.english import ENGLISH
from app.lan.help.german import GERMAN
from app.lan.help.texts import HelpTexts


def texts_for(accept_language: str, chosen: str) -> HelpTexts:
    """The language that was chosen, else the browser's first of ours, else English."""
    offered = {"en": ENGLISH, "de": GERMAN}
    wanted = [part.partition(";")[0].strip()[:2].lower() for part in accept_language.split(",")]
    return next((offered[one] for one in (chosen, *wanted) if one in offered), ENGLISH)


def device_of(user_agent: str, texts: HelpTexts) -> str:
    """The key of the section that most likely fits a browser; empty if none does.

    An iPad calls itself a Macintosh; a Mac's owner finds the next section easily enough.
    """
    order = ("quest", "android", "ios", "firefox", "windows", "linux")
    by_key = {device.key: device for device in texts.devices}
    return next((key for key in order if any(mark in user_agent for mark in by_key[key].marks)), "")
