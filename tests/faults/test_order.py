"""Tests that duplicate, reordered and overlapping batches give the same stored record."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest

from app.features.record.receipts import receipt_of
from tests.faults.figures import note
from tests.features.lab import Json
from tests.features.movement_builders import moving_values
from tests.features.record.headset.site import Headset, Site, open_site
from tests.support.server import LiveServer
from tests.wire.samples import message

FRAMES, SESSIONS = 300, 6
VALUES = moving_values(FRAMES, 5)


def batch(first: int, end: int) -> bytes:
    """Return a batch with frames `first` to `end` - 1."""
    return message(VALUES[first:end], seq_first=first)


def deliver(headset: Headset, batches: Sequence[tuple[int, int]]) -> None:
    """Send the batches and answer every resend request until all frames are stored."""
    for first, end in batches:
        headset.say(batch(first, end))
    asked = 0
    while True:
        heard = headset.hear_any(("ack", "resend"))
        stored = _stored(heard)
        if stored == FRAMES:
            return
        if heard["type"] == "resend" or stored >= asked:
            asked = stored
            for first in range(stored, FRAMES, 50):
                headset.say(batch(first, min(first + 50, FRAMES)))


def _stored(heard: Json) -> int:
    positions = heard.get("positions") or [heard]
    return max(int(one["next_seq"]) for one in positions if one["stream"] == "target")


def shuffled(rng: np.random.Generator) -> list[tuple[int, int]]:
    """Cut the frames into batches at random; duplicate, overlap and reorder the batches."""
    cuts = sorted({0, FRAMES, *rng.integers(1, FRAMES, 20).tolist()})
    pieces = list(pairwise(cuts))
    again = [pieces[at] for at in rng.integers(0, len(pieces), 10)]
    overlapping = [(max(0, first - 5), end) for first, end in pieces[::3]]
    everything = pieces + again + overlapping
    return [everything[at] for at in rng.permutation(len(everything))]


@pytest.mark.timeout(120)
def test_any_order_gives_the_same_record(live_server: LiveServer) -> None:
    """The digests of stored streams are equal for any order, overlap and repetition of batches."""
    rng = np.random.default_rng(18)
    in_order = [(first, min(first + 50, FRAMES)) for first in range(0, FRAMES, 50)]
    digests, missing = [], 0
    with open_site(live_server) as site:
        for sent in (in_order, *(shuffled(rng) for _ in range(SESSIONS))):
            session_id = site.join()
            with site.headset(site.token(session_id)) as headset:
                deliver(headset, sent)
            digest, lost = _target(site, session_id)
            digests.append(digest)
            missing += lost
    note(18, "out of order, twice, overlapping", "records that differ", len(set(digests)) - 1)
    note(18, "out of order, twice, overlapping", "frames missing", missing)
    assert len(set(digests)) == 1
    assert missing == 0


def _target(site: Site, session_id: str) -> tuple[str, int]:
    with site.database.reading() as db:
        streams = receipt_of(db, session_id).streams
    (found,) = [one for one in streams if one.stream == "target"]
    assert found.sha256 is not None
    return found.sha256, found.missing
