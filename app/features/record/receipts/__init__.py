"""Receipts: what was made, stored and is missing of a session, computed from the record."""

from app.features.record.receipts.service import SessionReceipt, receipt_of, receipt_text

__all__ = [
    "SessionReceipt",
    "receipt_of",
    "receipt_text",
]
