"""Read the tables of docs/claims.md, and measure again the claims for which this is quick."""

import hashlib
import json
import re
import struct
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from app.features.movement.humanoids import SHIPPED_BODIES
from app.features.record.telemetry.encodings import f32_predicted
from app.features.record.telemetry.encodings.columns import Columns
from app.features.results.imports import offer, read_columns
from app.lan.serving.leaf import LASTS
from app.protocol.orders import ledger_block
from app.resources import bodies_dir
from app.science.avatar.body import AXIS_NAMES, PART_NAMES
from app.science.avatar.mjcf import avatar_model, default_configuration
from app.science.avatar.simulation import MAX_SPEED_RAD_S
from app.science.latency import latency_of_runs
from app.science.retargeting import check_table1
from app.science.simulation import Aspect, agreement
from app.science.statistics import friedman, signed_rank
from tests.benchmarks.codecs import Codec, bits_of, own_codecs
from tests.docs.markdown import DOCS
from tests.features.record.telemetry.followed_movement import (
    CHUNK_FRAMES,
    OWN_NOISE_DEG,
    RATE_HZ,
    TRACKING_NOISE_DEG,
    followed,
)
from tests.features.record.telemetry.followed_movement import made_movement as made_streams
from tests.features.results.imports.test_imports import QUALTRICS
from tests.protocol.helpers import SHIPPED, instruments, loaded
from tests.science.avatar.tuning.known_wheel import torque_shares
from tests.science.moving_bodies import Flaws, made_movement, record
from tests.science.statistics.published import WINE

PAGE: Final = DOCS / "claims.md"
COLUMNS: Final = ("id", "claim", "shown by", "conditions", "figure", "limit")
OPEN_COLUMNS: Final = ("id", "claim that is open", "what closes it", "figure")
NUMBER: Final = re.compile(r"(?<![\w.,])\.?\d[\d,]*(?:\.\d+)?(?:e-?\d+)?")
_MADE_S = 4.0


@dataclass(frozen=True)
class Claim:
    """One row of the page.

    Attributes:
        key: its id.
        text: the claim, with the link to the page that makes it.
        shown_by: the command, as the row gives it.
        conditions: under which the figure was seen.
        figure: as it is printed.
        limit: `exactly`, `at most` or `at least` and a number, or `none`.
        short: whether it is measured again here.
    """

    key: str
    text: str
    shown_by: str
    conditions: str
    figure: str
    limit: str
    short: bool

    @property
    def value(self) -> float | None:
        """Return the figure's first number; None if it has none."""
        found = NUMBER.search(self.figure)
        return None if found is None else as_value(found[0])

    @property
    def half_unit(self) -> float:
        """Return half a unit of the last digit that the figure prints."""
        found = NUMBER.search(self.figure)
        decimals = found[0].partition(".")[2] if found else ""
        return 0.5 * 10.0 ** -len(decimals)

    @property
    def page(self) -> Path:
        """Return the file that makes the claim."""
        target = re.search(r"\]\(([^)#]+)", self.text)
        assert target is not None, f"{self.key}: the claim has no link to its page"
        return (DOCS / target[1]).resolve()

    def keeps_its_limit(self, value: float) -> bool:
        """Return whether a value keeps the limit."""
        word, _, number = self.limit.rpartition(" ")
        if self.limit == "none":
            return True
        limit = as_value(number)
        return {"exactly": value == limit, "at most": value <= limit, "at least": value >= limit}[
            word
        ]

    def still_holds(self, measured: float) -> bool:
        """Return whether a value measured now is what the figure says, as it is rounded."""
        assert self.value is not None, f"{self.key}: the figure has no number"
        off = measured - self.value
        if self.limit.startswith("at most"):
            return off <= self.half_unit
        return abs(off) <= (0.0 if self.limit.startswith("exactly") else self.half_unit)


def as_value(number: str) -> float:
    """Return a printed number, such as 11,376 or .3870."""
    return float(number.replace(",", ""))


def rows_of(columns: tuple[str, ...], text: str) -> Iterator[list[str]]:
    """Yield the rows of every table with these columns."""
    within = False
    for line in text.splitlines():
        if not line.startswith("|"):
            within = False
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if tuple(cells) == columns:
            within = True
        elif within and not set(line) <= set("|- "):
            yield cells


def claims() -> list[Claim]:
    """Return every claim of the page that has a command."""
    found = []
    for key, text, shown_by, conditions, figure, limit in rows_of(COLUMNS, PAGE.read_text("utf-8")):
        short = key.endswith("*")
        name = key.rstrip("* ")
        found.append(Claim(name, text, shown_by, conditions, figure, limit, short))
    return found


def _codec() -> Codec:
    name = f"{f32_predicted.NAME}, zstd {f32_predicted.LEVEL}"
    return next(one for one in own_codecs() if one.name == name)


def _chunks(duration_s: float) -> list[Columns]:
    rng = np.random.default_rng(0)
    streams = followed(
        made_streams(duration_s, rng, noise_deg=TRACKING_NOISE_DEG), rng, noise_deg=OWN_NOISE_DEG
    )
    return [one for pair in streams.chunks(CHUNK_FRAMES) for one in pair]


def _different_chunks() -> float:
    codec, different = _codec(), 0
    for chunk in _chunks(_MADE_S):
        frames, width = chunk.values.shape
        back = codec.decode(codec.encode(chunk), frames, width)
        different += not np.array_equal(bits_of(back), bits_of(chunk))
    return float(different)


def _session_minute_mb() -> float:
    sizes = [len(_codec().encode(chunk)) for chunk in _chunks(20.0)]
    return sum(sizes) * 60.0 / (len(sizes) / 2 * CHUNK_FRAMES / RATE_HZ) / 1e6


def _latency_error_ms() -> float:
    errors = []
    for latency_s in (0.0073, 0.35):
        rng = np.random.default_rng((0, round(1e6 * latency_s)))
        run = record(made_movement(rng), latency_s, rng, Flaws(0.1), duration_s=20.0)
        found = latency_of_runs([run]).latency_s
        assert found is not None
        errors.append(1e3 * abs(found - latency_s))
    return max(errors)


def _changes_flagged() -> float:
    movement = made_movement(np.random.default_rng(5))
    before, after = (
        record(movement, latency_s, np.random.default_rng(8)) for latency_s in (0.1, 0.2)
    )
    later = before.actual_times_s > 0.5 * before.actual_times_s[-1]
    both = np.where(later[:, None, None], after.actual_rotations, before.actual_rotations)
    return float(latency_of_runs([replace(before, actual_rotations=both)]).changed)


def _model_hashes() -> float:
    made = [avatar_model(default_configuration(), 1.7).mjcf for _ in range(2)]
    return float(len({hashlib.sha256(text.encode()).hexdigest() for text in made}))


def _triangles() -> float:
    counts = set()
    for name in SHIPPED_BODIES:
        content = (bodies_dir() / f"{name}.glb").read_bytes()
        (length,) = struct.unpack_from("<I", content, 12)
        tree = json.loads(content[20 : 20 + length])
        counts.add(
            sum(
                tree["accessors"][one["indices"]]["count"] // 3
                for mesh in tree["meshes"]
                for one in mesh["primitives"]
            )
        )
    (count,) = counts
    return float(count)


def _slots() -> float:
    protocol = loaded(SHIPPED).protocol
    rows = [ledger_block(protocol, block) for block in range(protocol.orders.replicates)]
    orders = Counter(row.sequence for block in rows for row in block)
    assert len(set(orders.values())) == 1, "an order is there more often than another"
    return float(orders.total())


def _offered_items() -> float:
    known = instruments()
    seen = read_columns(QUALTRICS, known)
    offered, _ = offer(seen.sheet, seen.used, known)
    return 0.0 if offered is None else float(len(offered.items))


MEASURED: Final = MappingProxyType[str, Callable[[], float]](
    {
        "record-lossless": _different_chunks,
        "record-size": _session_minute_mb,
        "orders-balance": _slots,
        "lan-certificate": lambda: float(LASTS.days),
        "latency-error": _latency_error_ms,
        "latency-change": _changes_flagged,
        "retarget-table1": lambda: float(sum(row.agrees for row in check_table1())),
        "body-parts": lambda: float(len(PART_NAMES)),
        "body-axes": lambda: float(len(AXIS_NAMES)),
        "body-bytes": _model_hashes,
        "body-triangles": _triangles,
        "follow-speed": lambda: MAX_SPEED_RAD_S,
        "tune-torque": lambda: max(torque_shares()),
        "stats-friedman": lambda: friedman(WINE).p,
        "stats-wilcoxon": lambda: signed_rank(np.arange(1.0, 6.0), np.zeros(5)).p,
        "import-unknown": _offered_items,
        "rehearsal-curve": lambda: 100.0 * agreement(Aspect.SIMULTANEITY, 305.0),
    }
)
"""How each short claim is measured again, by id."""
