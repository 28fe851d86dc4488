"""The JSON messages beside the batches."""

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
    """A report with this body."""
    return {"type": "report", "epoch": 1, "seq": 0, "body": body}


def test_a_report_is_read_by_its_kind() -> None:
    """The body's kind decides what it must hold."""
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
def test_a_value_that_no_table_could_hold_is_refused(field: str, value: object) -> None:
    """Numbers, names and times outside of their range never reach the database."""
    with pytest.raises(ValidationError) as refused:
        CLIENT_MESSAGE.validate_python(report(**{**CONTACT, field: value}))
    assert field in str(refused.value)


@given(text=st.text(max_size=60))
@settings(max_examples=200)
def test_noise_is_refused(text: str) -> None:
    """A text that is no message raises ValidationError and nothing else."""
    with pytest.raises(ValidationError):
        CLIENT_MESSAGE.validate_json(text.encode("utf-8", "surrogatepass"))


@given(
    kind=st.sampled_from(["hello", "report", "probe", "probed"]),
    rest=st.dictionaries(
        st.sampled_from(["protocol", "client", "epoch", "seq", "body", "client_sent_s"]), JSON
    ),
)
@settings(max_examples=200)
def test_half_right_messages_are_refused_or_read(kind: str, rest: dict[str, Any]) -> None:
    """Known fields with any values give a message or ValidationError."""
    with contextlib.suppress(ValidationError):
        assert CLIENT_MESSAGE.validate_python({"type": kind, **rest}).type == kind


def test_a_server_message_survives_the_way() -> None:
    """What the server sends is what a client reads."""
    ack = Ack(positions=(StreamPosition(stream="target", epoch=1, next_seq=90),))
    assert SERVER_MESSAGE.validate_json(ack.model_dump_json()) == ack
