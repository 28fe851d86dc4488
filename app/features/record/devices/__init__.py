"""Tablets and headsets that are paired with sessions."""

from app.features.record.devices.service import TABLET_SILENT_AFTER_S, devices_of_session, revoke

__all__ = [
    "TABLET_SILENT_AFTER_S",
    "devices_of_session",
    "revoke",
]
