"""What all JSON messages have in common: the protocol's names, and the ranges of its numbers."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

PROTOCOL_VERSION = 1
SUBPROTOCOL = "reembody.v1"
REPORT_STREAM = "reports"
MAX_SEQ = 2**53

Seconds = Annotated[float, Field(allow_inf_nan=False, ge=0.0, le=1e9)]
Seq = Annotated[int, Field(ge=0, lt=MAX_SEQ)]
Epoch = Annotated[int, Field(ge=1, lt=2**31)]
Count = Annotated[int, Field(ge=0, lt=2**31)]
Nanoseconds = Annotated[int, Field(ge=0, lt=2**63)]
# Not every database takes a NUL in a text.
Name = Annotated[str, Field(pattern=r"^[^\x00]*$")]


class Message(BaseModel):
    """Base of all messages: frozen, nothing unknown."""

    model_config = ConfigDict(extra="forbid", frozen=True)
