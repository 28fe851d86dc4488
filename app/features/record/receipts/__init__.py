"""The receipt: what of a session is there, proven from what is stored."""

from app.features.record.receipts.service import receipt_of, receipt_text

__all__ = [
    "receipt_of",
    "receipt_text",
]
