"""The receipt: what of a session is there, proven from what is stored."""

from app.features.record.receipts.service import SessionReceipt, receipt_of, receipt_text

__all__ = [
    "SessionReceipt",
    "receipt_of",
    "receipt_text",
]
