"""One spelling for equal content, so that a hash names the content and not its formatting."""

import hashlib
import json


def canonical_json(value: object) -> str:
    """JSON with sorted keys, no whitespace and unescaped letters. Raises ValueError for NaN."""
    return json.dumps(
        value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
    )


def sha256_of(text: str) -> str:
    """SHA-256 of the text's UTF-8 bytes, as 64 hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()
