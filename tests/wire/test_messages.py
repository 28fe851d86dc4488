"""Tests of the JSON messages, which are sent in addition to the batches."""

import contextlib
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from app.wire.messages import CLIENT_MESSAGE, SERVER_MESSAGE, Ack, Report, StreamPosition
from tests.wire.samples import CONTACT_REPORT

CONTACT: dict[str, Any] = {**CONTACT_REPORT, "phase_id": 1}
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=8,
)


def report(**body: Any) -> dict[str, Any]:
    """Return a report with this body."""
    return {"type": "report", "epoch": 1, "seq": 0, "body": body}


def test_a_report_is_read_by_its_kind() -> None:
    """The kind of a report's body decides which fields it must have."""
    message = CLIENT_MESSAGE.validate_python(report(**CONTACT))
    assert isinstance(message, Report)
    assert message.body.kind == "contact"


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("phase_id", -1),
        ("phase_id", 2**31),
        ("box", 2**70),
        ("begin_s", float("nan")),
        ("end_s", -1.0),
        ("surface_kind", "ceiling"),
        ("surface", "x" * 41),
        ("body_part", "Right\x00Hand"),
        ("surprise", 1),
    ],
)
def test_a_value_out_of_range_is_rejected(field: str, value: object) -> None:
    """Numbers, names and times out of range are rejected before they reach the database."""
    with pytest.raises(ValidationError) as refused:
        CLIENT_MESSAGE.validate_python(report(**{**CONTACT, field: value}))
    assert field in str(refused.value)


@given(text=st.text(max_size=60))
@settings(max_examples=200)
def test_arbitrary_text_is_rejected(text: str) -> None:
    """A text that is no message raises ValidationError, never another error."""
    with pytest.raises(ValidationError):
        CLIENT_MESSAGE.validate_json(text.encode("utf-8", "surrogatepass"))


@given(
    kind=st.sampled_from(["hello", "report", "probe", "probed"]),
    rest=st.dictionaries(
        st.sampled_from(["protocol", "client", "epoch", "seq", "body", "client_sent_s"]), JSON
    ),
)
@settings(max_examples=200)
def test_partly_valid_messages_are_rejected_or_read(kind: str, rest: dict[str, Any]) -> None:
    """A message of known fields with any values is read or raises ValidationError."""
    with contextlib.suppress(ValidationError):
        assert CLIENT_MESSAGE.validate_python({"type": kind, **rest}).type == kind


def test_a_server_message_survives_serialisation() -> None:
    """A client reads exactly what the server sent."""
    ack = Ack(positions=(StreamPosition(stream="target", epoch=1, next_seq=90),))
    assert SERVER_MESSAGE.validate_json(ack.model_dump_json()) == ack
