"""Stored study and instrument files that are not what they were."""

import json

import pytest

from app.errors import NotDurable
from app.platform.config_problems import unpacking
from app.protocol import sha256_of

STORED, DAMAGED = '{"key":"pilot"}', '{"key":"pil~t'


def test_a_text_that_was_damaged_is_reported_as_a_damaged_database() -> None:
    """With the way out; a text that cannot be read although nobody touched it is our fault."""
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
