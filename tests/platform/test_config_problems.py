"""A test of stored study and instrument files that were damaged."""

import json

import pytest

from app.errors import NotDurable
from app.platform.config_problems import unpacking
from app.protocol import sha256_of

STORED, DAMAGED = '{"key":"pilot"}', '{"key":"pil~t'


def test_a_stored_text_with_a_wrong_hash_is_reported_as_damage() -> None:
    """An unreadable stored text is reported as database damage if it does not match its hash."""
    with unpacking(STORED, sha256_of(STORED)):
        json.loads(STORED)
    with (
        pytest.raises(NotDurable, match="the database is damaged") as refused,
        unpacking(DAMAGED, sha256_of(STORED)),
    ):
        json.loads(DAMAGED)
    assert "restore the newest backup" in refused.value.remedy
    with pytest.raises(json.JSONDecodeError), unpacking(DAMAGED, sha256_of(DAMAGED)):
        json.loads(DAMAGED)
