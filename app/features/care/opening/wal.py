"""Detect committed transactions that SQLite's write-ahead log has lost.

SQLite reads the log up to the first frame whose checksum does not match, and assumes that the power
failed there. If the disk damaged a frame further back, everything after it is dropped in the same
way, without an error. The difference can be detected: a commit ends with a flush before the
next one begins, so a power failure leaves at most one unfinished transaction after that place.
Damage leaves all the others. Only a frame whose checksum follows from that of the frame before it
counts there: a file may have grown over sectors that were never written and contain anything.

A log that lost its end is detected if its index is left (`-shm`, after a killed process): SQLite
notes there how many frames were committed, and with synchronous FULL only after they were flushed.

Format: https://www.sqlite.org/fileformat2.html, section 4, "The Write-Ahead Log".
"""

import struct
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

HEADER, FRAME_HEADER = 32, 24
MAGICS = (0x377F0682, 0x377F0683)
FRAMES_PER_READ = 512
_INDEX_HEADER = 48
"""Size of `WalIndexHdr`, which the index has twice; `nBackfill` follows."""
Words = NDArray[np.uint32]


@dataclass(frozen=True)
class LogReport:
    """A log's state; `usable`: frames of complete transactions before the first invalid one.

    `commits_after_invalid`: transactions of this log that ended after the first invalid frame.
    """

    header_valid: bool
    usable: int
    commits_after_invalid: int

    @property
    def damaged(self) -> bool:
        """Return whether transactions are lost that a power failure alone would not have lost."""
        return not self.header_valid or self.commits_after_invalid > 1


def inspect_log(path: Path) -> LogReport:
    """Inspect a log without SQLite; a missing or empty log is valid."""
    if not path.is_file() or path.stat().st_size <= HEADER:
        return LogReport(header_valid=True, usable=0, commits_after_invalid=0)
    with path.open("rb") as file:
        head = file.read(HEADER)
        magic, _, page_size, _, *salt_and_sum = struct.unpack(">8I", head)
        order = ">" if magic & 1 else "<"
        state = _Checksum(3).each(_words(head[:24], order)[None], np.zeros((1, 2), np.uint32))[0]
        if magic not in MAGICS or list(state) != salt_and_sum[2:] or not _possible(page_size):
            return LogReport(header_valid=False, usable=0, commits_after_invalid=0)
        return _frames(file, page_size, order, tuple(salt_and_sum[:2]), state)


def frames_noted(log: Path, index: Path) -> int:
    """Return how many frames of this log its index lists as committed but not yet copied.

    0 if the index is missing, torn or another log's. A log that is too short to be identified
    counts as the index's own.
    """
    if not (log.is_file() and index.is_file()):
        return 0
    with index.open("rb") as file:
        start = file.read(2 * _INDEX_HEADER + 4)
    first, second = start[:_INDEX_HEADER], start[_INDEX_HEADER : 2 * _INDEX_HEADER]
    if len(start) < 2 * _INDEX_HEADER + 4 or first != second:
        return 0
    covered, summed = first[:-8], struct.unpack("=2I", first[-8:])
    order = "<" if sys.byteorder == "little" else ">"
    pairs = _words(covered, order)[None]
    state = _Checksum(len(covered) // 8).each(pairs, np.zeros((1, 2), np.uint32))[0]
    with log.open("rb") as file:
        salts = file.read(HEADER)[16:24]
    if tuple(state) != summed or (len(salts) == len(first[32:40]) and salts != first[32:40]):
        return 0
    (noted,), (copied,) = struct.unpack("=I", first[16:20]), struct.unpack("=I", start[-4:])
    return int(noted) if noted > copied else 0


def _possible(page_size: int) -> bool:
    return 512 <= page_size <= 65536 and page_size.bit_count() == 1


def _frames(
    file: BinaryIO, page_size: int, order: str, salts: tuple[int, ...], state: Words
) -> LogReport:
    length = FRAME_HEADER + page_size
    checksum = _Checksum((8 + page_size) // 8)
    usable, after_invalid, previous, all_valid = 0, 0, 0, True
    last_sum = np.array([state], np.uint32)
    while block := file.read(length * FRAMES_PER_READ):
        frames = np.frombuffer(block, np.uint8)
        frames = frames[: len(block) // length * length].reshape(-1, length)
        heads = np.ascontiguousarray(frames[:, :FRAME_HEADER]).view(">u4").astype(np.uint32)
        own = (heads[:, 2] == salts[0]) & (heads[:, 3] == salts[1])
        # Compute each checksum from the stored one of the frame before, valid or not: as long
        # as all are valid, that is the running checksum of SQLite.
        sums_before = np.concatenate([last_sum, heads[:, 4:6]])
        covered = np.concatenate([frames[:, :8], frames[:, FRAME_HEADER:]], axis=1)
        sums = checksum.each(_words(covered.tobytes(), order, len(frames)), sums_before[:-1])
        valid, last_sum = own & (sums == heads[:, 4:6]).all(axis=1), sums_before[-1:]
        ends, valid_count = valid & (heads[:, 1] > 0), 0
        if all_valid:
            valid_count = len(valid) if valid.all() else int(np.argmin(valid))
            all_valid = valid_count == len(valid)
        if ends[:valid_count].any():
            usable = previous + int(np.flatnonzero(ends[:valid_count])[-1]) + 1
        after_invalid += int(ends[valid_count:].sum())
        previous += len(frames)
    return LogReport(header_valid=True, usable=usable, commits_after_invalid=after_invalid)


def _words(data: bytes, order: str, frames: int = 0) -> Words:
    words = np.frombuffer(data, f"{order}u4").astype(np.uint32).reshape(-1, 2)
    return words.reshape(frames, -1, 2) if frames else words


class _Checksum:
    """The log's running checksum over blocks of `pairs` pairs of 32-bit words.

    Pair after pair, s0 += x0 + s1 and s1 += x1 + s0, modulo 2^32. That is linear: the state after a
    block is M^n times the state before plus a weighted sum of the words, which is one product.
    """

    def __init__(self, pairs: int) -> None:
        step = ((1, 1), (1, 2))
        power = ((1, 0), (0, 1))
        weights = []
        for _ in range(pairs):
            # The weights of a pair followed by k pairs: M^k times ((1, 0), (1, 1)).
            weights.append(_times(power, ((1, 0), (1, 1))))
            power = _times(power, step)
        self._power: Words = np.array(power, dtype=np.uint32)
        self._weights: Words = np.array(weights[::-1], dtype=np.uint32)

    def each(self, blocks: Words, previous: Words) -> Words:
        """Return the states (n, 2) after n blocks (n, pairs, 2), given those before them."""
        added = np.einsum("npx,psx->ns", blocks, self._weights)
        return np.asarray(previous @ self._power.T + added, np.uint32)


_Matrix = tuple[tuple[int, int], tuple[int, int]]


def _times(a: _Matrix, b: _Matrix) -> _Matrix:
    rows = [[sum(a[i][k] * b[k][j] for k in range(2)) % 2**32 for j in range(2)] for i in range(2)]
    return ((rows[0][0], rows[0][1]), (rows[1][0], rows[1][1]))
