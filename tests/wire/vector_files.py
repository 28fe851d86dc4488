"""Make the vectors of the wire format: `python -m tests.wire.vector_files` writes them.

`tests/vectors/wire/README.md` describes the files. They record what `app/wire` does today: a change
of the format rewrites them, and every other implementation is tested against them.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.wire import HEADER_BYTES, StreamName, decode_batch, encode_batch
from app.wire.batch import HEADER, MAX_TIME_S
from tests.wire.message_vectors import FROM_CLIENT, FROM_SERVER, REFUSED_CLIENT, REFUSED_SERVER
from tests.wire.samples import every_odd_float, resting_fingers, standing, without_left_hand

FOLDER = Path(__file__).parents[1] / "vectors" / "wire"
Json = dict[str, Any]
FIELDS = ("magic", "length", "stream", "reserved", "epoch", "phase_id", "seq", "n", "w", "crc")


def make_all() -> dict[str, Json]:
    """Return every vector file by its name."""
    return {
        "batches": {
            "kind": "batches",
            "fact": "Encoding the fields gives the message, decoding the message gives the fields.",
            "batches": [_batch(name, **given) for name, given in _batches().items()],
        },
        "refused_batches": {
            "kind": "refused_batches",
            "fact": "These batches are invalid; an implementation names the invalid field.",
            "batches": [
                {"name": name, "field": field, "message_hex": message.hex()}
                for name, field, message in _invalid_batches()
            ],
        },
        "messages_from_client": {
            "kind": "messages_from_client",
            "fact": "A client may send these: the server reads each text as the given message.",
            "messages": [_message(*one) for one in FROM_CLIENT],
        },
        "messages_from_server": {
            "kind": "messages_from_server",
            "fact": "The server sends these: a client reads each text as the given message.",
            "messages": [_message(*one) for one in FROM_SERVER],
        },
        "refused_messages": {
            "kind": "refused_messages",
            "fact": "Both sides reject these messages.",
            "from_client": [{"name": name, "message": content} for name, content in REFUSED_CLIENT],
            "from_server": [{"name": name, "message": content} for name, content in REFUSED_SERVER],
        },
    }


def _batches() -> dict[str, Json]:
    """Return arguments of `encode_batch` by name."""
    moving = standing(6)
    moving[:, 0] = np.float32(0.1) * np.arange(6, dtype=np.float32)
    broken_s = np.array([1.0, np.nan, np.inf, -np.inf, -0.0, 5e-324, 2.0, 0.1, 1e300, -1.0, 3.5])
    most = 2**53 - 1
    return {
        "six_frames": _given(moving, phase_id=3, seq_first=90, active=True, active_s=1.0 / 3.0),
        "one_frame_of_the_actual_stream": _given(standing(1), stream=StreamName.ACTUAL),
        "eight_frames_need_no_padding": _given(standing(8)),
        "nine_frames_need_seven_bytes_of_padding": _given(standing(9), active=True),
        "two_frames_of_the_target_fingers": _given(
            resting_fingers(2), stream=StreamName.TARGET_FINGERS, phase_id=3
        ),
        "fingers_of_which_the_left_hand_is_not_tracked": _given(
            without_left_hand(resting_fingers(3)), stream=StreamName.ACTUAL_FINGERS
        ),
        "every_odd_float": _given(every_odd_float(), times_s=broken_s),
        "largest_numbers": _given(
            standing(2),
            epoch=2**31 - 1,
            phase_id=2**31 - 1,
            seq_first=most - 2,
            active_s=MAX_TIME_S,
            closed_at_s=MAX_TIME_S,
        ),
    }


def _given(
    values: NDArray[np.float32],
    *,
    stream: StreamName = StreamName.TARGET,
    times_s: NDArray[np.float64] | None = None,
    active: bool = False,
    **fields: Any,
) -> Json:
    count = len(values)
    return {
        "stream": stream,
        "epoch": 1,
        "phase_id": 0,
        "seq_first": 0,
        "active_s": 0.0,
        "closed_at_s": 12.5,
        "times_s": 12.0 + np.arange(count) / 90.0 if times_s is None else times_s,
        "flags": np.full(count, active, np.uint8),
        "values": values,
        **fields,
    }


def _batch(name: str, **given: Any) -> Json:
    message = encode_batch(**given)
    header = decode_batch(message).header
    return {
        "name": name,
        "stream": str(header.stream),
        "epoch": header.epoch,
        "phase_id": header.phase_id,
        "seq_first": header.seq_first,
        "frame_count": header.frame_count,
        "crc32": header.crc32,
        "active_s": header.active_s,
        "closed_at_s": header.closed_at_s,
        "times_hex": given["times_s"].astype("<f8").tobytes().hex(),
        "flags": given["flags"].tolist(),
        "values_hex": given["values"].astype("<f4").tobytes().hex(),
        "message_hex": message.hex(),
    }


def _invalid_batches() -> list[tuple[str, str, bytes]]:
    """Return name, faulty field and bytes of each invalid batch."""
    good = encode_batch(**_given(standing(2)))
    changes: list[tuple[str, str, Any]] = [
        ("another_magic", "magic", b"RMB2"),
        ("another_header_length", "length", 128),
        ("unknown_stream", "stream", 5),
        ("no_frames", "n", 0),
        ("too_many_frames", "n", 1025),
        ("fewer_frames_than_it_says", "n", 3),
        ("another_width", "w", 92),
        ("seq_out_of_range", "seq", 2**62),
        ("phase_id_out_of_range", "phase_id", 2**31),
        ("another_checksum", "crc", 1),
        ("active_time_is_not_a_number", "active_s", float("nan")),
        ("active_time_is_negative", "active_s", -0.5),
        ("closing_time_is_infinite", "closed_at_s", float("inf")),
    ]
    flipped = bytearray(good)
    flipped[-1] ^= 1
    return [
        *((name, field, _changed(good, field, value)) for name, field, value in changes),
        ("flipped_bit", "crc", bytes(flipped)),
        ("cut_in_the_header", "length", good[: HEADER_BYTES - 1]),
        ("cut_in_a_frame", "length", good[:-4]),
        ("with_a_tail", "length", good + b"\0"),
        ("nothing", "length", b""),
    ]


def _changed(good: bytes, field: str, value: object) -> bytes:
    parts = dict(zip((*FIELDS, "active_s", "closed_at_s"), HEADER.unpack_from(good), strict=True))
    return HEADER.pack(*{**parts, field: value}.values()) + good[HEADER_BYTES:]


def _message(name: str, content: Json) -> Json:
    return {"name": name, "text": json.dumps(content), "message": content}


def as_text(vector: Json) -> str:
    """Return a vector as JSON with one line for each entry of its lists."""
    lines = []
    for key, value in vector.items():
        if isinstance(value, list):
            entries = ",\n".join(f"    {json.dumps(entry)}" for entry in value)
            lines.append(f"  {json.dumps(key)}: [\n{entries}\n  ]")
        else:
            lines.append(f"  {json.dumps(key)}: {json.dumps(value)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, vector in make_all().items():
        (FOLDER / f"{name}.json").write_text(as_text(vector))
