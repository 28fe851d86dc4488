"""How answers that are not JSON are described in the interface's document."""

from typing import Any

from app.features.movement.captures.schemas import ExportFormat

BYTES = "application/octet-stream"
MEDIA_TYPES: dict[ExportFormat, str] = {"bvh": "text/plain", "csv": "text/csv"}
BINARY: dict[str, Any] = {"schema": {"type": "string", "format": "binary"}}


def binary(description: str) -> dict[str, Any]:
    """An answer of bytes."""
    return {"content": {BYTES: BINARY}, "description": description}
