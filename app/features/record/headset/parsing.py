"""Reading what a headset says in JSON."""

from pydantic import ValidationError

from app.errors import InvalidInput
from app.wire.messages import CLIENT_MESSAGE, ClientMessages


def parse_message(text: str) -> ClientMessages:
    """The client's message; raises InvalidInput with the first thing that does not fit."""
    try:
        return CLIENT_MESSAGE.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        raise InvalidInput(
            f"message not understood: {first['msg']} at {'.'.join(map(str, first['loc']))}",
            value=text[:200],
            remedy="See docs/protocol.md for the messages.",
        ) from error
