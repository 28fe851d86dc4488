"""The shape of the help page's words.

`*bold*` is what a person looks for on the device's screen, `` `code` `` what they type.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Device:
    """How one kind of device takes the certificate; `marks` stand in its browser's user agent."""

    key: str
    name: str
    steps: tuple[str, ...]
    marks: tuple[str, ...] = ()


@dataclass(frozen=True)
class HelpTexts:
    """Every word of the page in one language."""

    language: str
    other_name: str
    title: str
    lead: str
    download: str
    certificate: str
    profile: str
    pem: str
    compare: str
    compare_how: str
    compare_stop: str
    install: str
    go_on: str
    go_on_how: str
    tablet: str
    console: str
    elsewhere: str
    limits: str
    until: str
    devices: tuple[Device, ...]
