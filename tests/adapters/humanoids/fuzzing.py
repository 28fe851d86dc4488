"""Damage models in many ways: each must be read, or refused with an error about the model.

    python -m tests.adapters.humanoids.fuzzing           200 damaged models
    python -m tests.adapters.humanoids.fuzzing --long    3,000

They are read in a worker process with the limits that the server's has: 60 s for each, and 3 GiB.
The command prints how many of each kind were read and refused, the slowest, and the greatest memory
that the process had; it fails at the first model with another outcome. Number n is always damaged
in the same way, so `--only n` repeats one.

The models are made by code, plain and compressed by meshopt or Draco; where the folder of shared
data is present, one in six is a published one.
"""

import argparse
import copy
import json
import struct
import sys
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import TimeoutError as TooLong
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random
from typing import Any, Literal

from app.adapters.humanoids import HumanoidFileError, Limits, read_humanoid
from app.features.movement.captures.capture_queue import limit_memory
from app.features.movement.humanoids.uploading import WITHIN_S
from app.platform.workers import Worker
from app.science.avatar.body import HumanoidError, figure_of
from tests.support.compressed_files import draco_file, meshopt_file
from tests.support.humanoid_files import glb, humanoid_file
from tests.support.humanoid_model import Model, without
from tests.support.shared_data import shared_data_folder

Json = dict[str, Any]
Path_ = tuple[str | int, ...]
_PUBLISHED_EVERY = 6
"""One in so many is a published model, which takes ten times as long to read."""
_ODD: list[Any] = [
    *(0, -1, 1, 2, 255, 2**16, 2**31, 2**32 - 1, 2**39, 2**63, 1e308, 1e-320, -0.0, 0.5, 5121),
    *(5123, 5126, None, True, "", "x", "NaN", [], {}, [0], [[]], [1, 2, 3], {"node": 0}),
]
_SIZES = (
    "count",
    "byteLength",
    "byteOffset",
    "byteStride",
    "componentType",
    "bufferView",
    "buffer",
)
Outcome = Literal["read", "refused"]


@dataclass(frozen=True)
class Damaged:
    """A damaged model: what it was, how it was damaged, and its bytes."""

    seed: str
    kind: str
    data: bytes


@dataclass(frozen=True)
class Attempt:
    """What reading a damaged model led to, and the greatest memory of the process so far."""

    outcome: Outcome
    reason: str
    duration_s: float
    peak_bytes: int


@cache
def made_seeds() -> dict[str, bytes]:
    """Return models made by code, by name."""
    few = without("Index", "Ring", "Little")
    plain = {
        "names": Model(parts=few, arms_down_rad=0.7),
        "VRM 0": Model(parts=few, vrm=0),
        "VRM 1": Model(parts=few, vrm=1, hair=True),
    }
    files = {name: humanoid_file(model) for name, model in plain.items()}
    return {
        **files,
        "meshopt": meshopt_file(files["VRM 1"]),
        "Draco": draco_file(files["names"]),
        "JSON": humanoid_file(Model(parts=few, binary=False)),
    }


@cache
def published_seeds() -> dict[str, bytes]:
    """Return the published models, by name; none where the folder of shared data is absent."""
    folder = shared_data_folder() / "models"
    files = sorted([*folder.glob("*/*.glb"), *folder.glob("*/*.vrm")])
    return {path.name: path.read_bytes() for path in files}


def damaged(number: int, *, published: bool = True) -> Damaged:
    """Return the damaged model of this number, the same each time."""
    rng = Random(number)  # noqa: S311 - reproducible, not secret
    seeds = made_seeds()
    if published and number % _PUBLISHED_EVERY == 0 and published_seeds():
        seeds = published_seeds()
    name = rng.choice(sorted(seeds))
    kind = rng.choice(sorted(_KINDS))
    return Damaged(name, kind, _KINDS[kind](rng, seeds[name]))


def _opened(data: bytes) -> tuple[Json, bytes | None]:
    if data[:4] != b"glTF":
        return json.loads(data), None
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def _closed(document: Any, binary: bytes | None) -> bytes:
    return json.dumps(document).encode() if binary is None else glb(document, binary)


def _places(tree: Any, path: Path_ = ()) -> Iterator[Path_]:
    if path:
        yield path
    if isinstance(tree, dict | list):
        for step, child in tree.items() if isinstance(tree, dict) else enumerate(tree):
            yield from _places(child, (*path, step))


@cache
def _all_places(text: bytes) -> tuple[Path_, ...]:
    # Of a long table, such as a thousand matrices, the beginning is as good as all of it.
    return tuple(path for path in _places(json.loads(text)) if all(_early(step) for step in path))


def _early(step: str | int) -> bool:
    return isinstance(step, str) or step < 70


def _holder(document: Any, path: Path_) -> Any:
    for step in path[:-1]:
        document = document[step]
    return document


def _edited(
    rng: Random, data: bytes, edit: Callable[[Random, Any, str | int], None], names: Any = None
) -> bytes:
    document, binary = _opened(data)
    paths = _all_places(json.dumps(document).encode())
    if names is not None:
        paths = tuple(path for path in paths if path[-1] in names)
    for _ in range(rng.randint(1, 3)):
        path = rng.choice(paths)
        try:
            edit(rng, _holder(document, path), path[-1])
        except (KeyError, IndexError, TypeError, AttributeError):
            continue  # an earlier edit removed this path
    return _closed(document, binary)


def _replace(rng: Random, holder: Any, step: str | int) -> None:
    holder[step] = rng.choice(_ODD)


def _lie(rng: Random, holder: Any, step: str | int) -> None:
    value = holder[step]
    holder[step] = rng.choice(
        (value - 1, value + 1, value * 2, value * 1000, 0, 1, rng.randrange(70), 2**31, 2**39)
    )


def _restructure(rng: Random, holder: Any, step: str | int) -> None:
    action = rng.choice(("delete", "repeat", "exchange", "nest", "number"))
    if action == "delete":
        del holder[step]
    elif action == "repeat" and isinstance(holder, list):
        holder.extend(copy.deepcopy(holder[int(step)]) for _ in range(rng.choice((1, 50))))
    elif action == "exchange":
        other: Any = rng.choice(list(holder if isinstance(holder, dict) else range(len(holder))))
        holder[step], holder[other] = holder[other], holder[step]
    elif action == "nest":
        for _ in range(rng.choice((1, 100))):
            holder[step] = [holder[step]]
    elif isinstance(holder[step], int):
        holder[step] = rng.randrange(70)


def _bytes(rng: Random, data: bytes) -> bytes:
    changed = bytearray(data)
    for _ in range(rng.randint(1, 30)):
        changed[rng.randrange(len(changed))] = rng.randrange(256)
    return bytes(changed)


def _cut(rng: Random, data: bytes) -> bytes:
    cut = bytearray(data[: rng.randrange(len(data))])
    if len(cut) >= 12 and cut[:4] == b"glTF" and rng.random() < 0.5:
        struct.pack_into("<I", cut, 8, len(cut))  # as if it had always been as short
    return bytes(cut)


def _headers(rng: Random, data: bytes) -> bytes:
    changed = bytearray(data)
    for _ in range(rng.randint(1, 2)):
        at = rng.choice((4, 8, 12, 16)) if data[:4] == b"glTF" else rng.randrange(40)
        struct.pack_into("<I", changed, at, rng.choice((0, 1, 2, 20, 2**31, 2**32 - 1, len(data))))
    return bytes(changed)


def _stream(rng: Random, data: bytes) -> bytes:
    """Change bytes only where the tables are, compressed or not; also a whole run of them."""
    document, binary = _opened(data)
    if not binary:
        return _bytes(rng, data)
    changed = bytearray(binary)
    views = [one for one in document.get("bufferViews", []) if one.get("byteLength")]
    for _ in range(rng.randint(1, 6)):
        view = rng.choice(views)
        packed = view.get("extensions", {}).get("EXT_meshopt_compression", view)
        start = packed.get("byteOffset", 0)
        length = min(packed["byteLength"], len(changed) - start)
        if length < 1:
            continue
        # The beginning of a stream is its header, where most can go wrong.
        at = start + (
            rng.randrange(min(40, length)) if rng.random() < 0.5 else rng.randrange(length)
        )
        if rng.random() < 0.2:
            end = min(at + rng.randrange(200), start + length)
            changed[at:end] = bytes([rng.choice((0, 255, 128))]) * (end - at)
        else:
            changed[at] = rng.randrange(256)
    return _closed(document, bytes(changed))


_KINDS: dict[str, Callable[[Random, bytes], bytes]] = {
    "values replaced": lambda rng, data: _edited(rng, data, _replace),
    "sizes lying": lambda rng, data: _edited(rng, data, _lie, _SIZES),
    "structure changed": lambda rng, data: _edited(rng, data, _restructure),
    "bytes changed": _bytes,
    "cut off": _cut,
    "headers changed": _headers,
    "tables and streams changed": _stream,
}


def attempt(data: bytes, limits: Limits | None = None) -> Attempt:
    """Read and measure a model as the server does; raise any error that is not a refusal."""
    start = time.perf_counter()
    outcome: Outcome = "read"
    reason = ""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            figure_of(read_humanoid(data, limits).humanoid)
    except (HumanoidFileError, HumanoidError) as error:
        outcome, reason = "refused", str(error)
    return Attempt(outcome, reason, time.perf_counter() - start, _peak_bytes())


def _peak_bytes() -> int:
    if sys.platform == "win32":
        return 0
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024


def _say(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main() -> int:
    """Read damaged models and print the outcomes; return 1 if one failed in any other way."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--long", action="store_true", help="3,000 models instead of 200")
    parser.add_argument("--only", type=int, help="the number of a single model")
    parser.add_argument("--write", type=Path, help="where to write the model that failed")
    chosen = parser.parse_args()
    numbers = range(3_000 if chosen.long else 200)
    if chosen.only is not None:
        numbers = range(chosen.only, chosen.only + 1)
    outcomes: Counter[tuple[str, Outcome]] = Counter()
    from_published, slowest, peak = 0, 0.0, 0
    worker = Worker(limit_memory)
    try:
        for number in numbers:
            model = damaged(number)
            try:
                found = worker.submit(attempt, model.data).result(WITHIN_S)
            except (TooLong, Exception) as error:  # noqa: BLE001 - whatever it is, it is reported
                _say(f"number {number}, {model.seed}, {model.kind}: {type(error).__name__} {error}")
                if chosen.write is not None:
                    chosen.write.write_bytes(model.data)
                return 1
            outcomes[model.kind, found.outcome] += 1
            from_published += model.seed in published_seeds()
            slowest, peak = max(slowest, found.duration_s), max(peak, found.peak_bytes)
            if chosen.only is not None:
                _say(f"{model.seed}, {model.kind}: {found.outcome} {found.reason}")
    finally:
        worker.end()
    for kind in _KINDS:
        read, refused = outcomes[kind, "read"], outcomes[kind, "refused"]
        _say(f"{kind:28} {read:5} read {refused:5} refused")
    _say(
        f"{sum(outcomes.values())} models, {from_published} of them published;"
        f" the slowest took {slowest:.1f} s; peak memory {peak / 2**20:.0f} MiB"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
