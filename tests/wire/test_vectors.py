"""Tests that this implementation agrees with the wire format's shared vectors."""

import json
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from app.wire import MalformedBatchError, StreamName, decode_batch, encode_batch
from app.wire.messages import CLIENT_MESSAGE, SERVER_MESSAGE
from tests.wire.samples import bits
from tests.wire.vector_files import FOLDER, as_text, make_all

VECTORS: dict[str, dict[str, Any]] = {
    path.stem: json.loads(path.read_text()) for path in sorted(FOLDER.glob("*.json"))
}
FIELD_WORDS = {
    "length": "length|bytes",
    "n": "frame count|frames need",
    "w": "values per frame",
    "crc": "checksum",
}


def entries(name: str, key: str) -> list[Any]:
    """Return the entries of one list as parameters with their names."""
    return [pytest.param(entry, id=entry["name"]) for entry in VECTORS[name][key]]


def test_the_files_are_what_the_script_makes() -> None:
    """The vector files are exactly those that the script makes, without leftovers."""
    made = {name: as_text(vector) for name, vector in make_all().items()}
    assert {path.stem: path.read_text() for path in FOLDER.glob("*.json")} == made


@pytest.mark.parametrize("vector", entries("batches", "batches"))
def test_a_batch_is_encoded_and_decoded(vector: dict[str, Any]) -> None:
    """Each batch of the vectors is encoded and decoded bit by bit."""
    message = bytes.fromhex(vector["message_hex"])
    times_s = np.frombuffer(bytes.fromhex(vector["times_hex"]), "<f8")
    values = np.frombuffer(bytes.fromhex(vector["values_hex"]), "<f4").reshape(
        -1, StreamName(vector["stream"]).values_per_frame
    )
    batch = decode_batch(message)
    assert batch.times_s.tobytes() == times_s.tobytes()
    assert batch.flags.tolist() == vector["flags"]
    assert np.array_equal(bits(batch.values), bits(values))
    for field in ("stream", "epoch", "phase_id", "seq_first", "frame_count", "crc32"):
        assert getattr(batch.header, field) == vector[field]
    reencoded = encode_batch(
        StreamName(vector["stream"]),
        epoch=vector["epoch"],
        phase_id=vector["phase_id"],
        seq_first=vector["seq_first"],
        times_s=times_s,
        flags=np.array(vector["flags"], np.uint8),
        values=values,
        active_s=vector["active_s"],
        closed_at_s=vector["closed_at_s"],
    )
    assert reencoded == message


@pytest.mark.parametrize("vector", entries("refused_batches", "batches"))
def test_an_invalid_batch_is_rejected_by_field(vector: dict[str, Any]) -> None:
    """Each invalid batch raises an error that names the field that the vector names."""
    words = FIELD_WORDS.get(vector["field"], vector["field"])
    with pytest.raises(MalformedBatchError, match=words):
        decode_batch(bytes.fromhex(vector["message_hex"]))


@pytest.mark.parametrize("vector", entries("messages_from_client", "messages"))
def test_client_messages_are_read(vector: dict[str, Any]) -> None:
    """Reading a client's message and writing it again gives the same text."""
    message = CLIENT_MESSAGE.validate_json(vector["text"])
    assert message.model_dump(mode="json", exclude_unset=True) == vector["message"]


@pytest.mark.parametrize("vector", entries("messages_from_server", "messages"))
def test_server_messages_are_read(vector: dict[str, Any]) -> None:
    """Reading a server's message and writing it again gives the same text."""
    message = SERVER_MESSAGE.validate_json(vector["text"])
    assert message.model_dump(mode="json") == vector["message"]


@pytest.mark.parametrize("vector", entries("refused_messages", "from_client"))
def test_invalid_client_messages_are_rejected(vector: dict[str, Any]) -> None:
    """Every invalid client message of the vectors is rejected."""
    with pytest.raises(ValidationError):
        CLIENT_MESSAGE.validate_python(vector["message"])


@pytest.mark.parametrize("vector", entries("refused_messages", "from_server"))
def test_invalid_server_messages_are_rejected(vector: dict[str, Any]) -> None:
    """Every invalid server message of the vectors is rejected."""
    with pytest.raises(ValidationError):
        SERVER_MESSAGE.validate_python(vector["message"])


def test_every_kind_of_message_has_a_vector() -> None:
    """The vectors contain every kind of message of the protocol."""
    for name, adapter in (
        ("messages_from_client", CLIENT_MESSAGE),
        ("messages_from_server", SERVER_MESSAGE),
    ):
        kinds = set(adapter.json_schema()["discriminator"]["mapping"])
        assert {vector["message"]["type"] for vector in VECTORS[name]["messages"]} == kinds
