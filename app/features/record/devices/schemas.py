"""Pairing over HTTP."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

DeviceKind = Literal["tablet", "headset"]


class NewPairing(BaseModel):
    """A wish to pair a device."""

    model_config = ConfigDict(extra="forbid")

    device: DeviceKind


class PairingView(BaseModel):
    """A code that works once, until `expires_at`; `url` and `qr_svg` open the page with it.

    A headset's client is given the address of the server and types the code; it has no page to
    scan, so its `qr_svg` is null. `help_url` is the page on which a device that comes for the first
    time gets the lab's certificate; null where there is nothing to install.
    """

    device: DeviceKind
    code: str
    url: str
    qr_svg: str | None
    help_url: str | None
    help_qr_svg: str | None
    expires_at: datetime


class PairRequest(BaseModel):
    """A code, typed or scanned."""

    model_config = ConfigDict(extra="forbid")

    code: str = Field(min_length=4, max_length=20)
    name: str = Field(default="", max_length=80)


class PairedView(BaseModel):
    """A paired device. Only headsets see their token; a tablet holds it in a cookie."""

    device: DeviceKind
    session_id: str
    token: str | None
