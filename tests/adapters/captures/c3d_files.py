"""C3D files written for tests, in the formats of each of the three processor types."""

import struct
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

INTEL, DEC, MIPS = 84, 85, 86
BLOCK = 512


@dataclass(frozen=True)
class C3dFile:
    """A C3D file to write; positions (N, M, 3) in millimetres, NaN for an unseen marker."""

    places_mm: npt.NDArray[np.float64]
    labels: tuple[str, ...]
    processor: int = INTEL
    real: bool = True
    scale: float = 0.05
    rate_hz: float = 100.0
    analogue: int = 0
    descriptions: tuple[str, ...] = ()
    texts: dict[str, str] = field(
        default_factory=lambda: {"UNITS": "mm", "X_SCREEN": "+X", "Y_SCREEN": "+Z"}
    )
    lists: dict[str, tuple[str, ...]] = field(default_factory=dict)
    long: bool = False
    stated_frames: int | None = None

    def to_bytes(self) -> bytes:
        """Return the bytes of the whole C3D file."""
        frames = len(self.places_mm)
        parameters = self._parameters(frames % 65536)
        data_block = 2 + len(parameters) // BLOCK
        return self._header(frames, data_block) + parameters + self._frames()

    def _header(self, frames: int, data_block: int) -> bytes:
        last = min(frames, 65535) if self.stated_frames is None else self.stated_frames
        words = (len(self.labels), self.analogue, 1, last, 0)
        out = b"\x02\x50" + b"".join(self._word(word) for word in words)
        out += self._number(-self.scale if self.real else self.scale)
        out += self._word(data_block) + self._word(0) + self._number(self.rate_hz)
        return out.ljust(BLOCK, b"\x00")

    def _parameters(self, frames: int) -> bytes:
        frames = frames if self.stated_frames is None else self.stated_frames
        records = [_group(1, "POINT"), _group(2, "TRIAL")]
        records += [self._text(1, name, (text,)) for name, text in self.texts.items()]
        labels = {"LABELS": self.labels, **self.lists}
        for name, texts in labels.items():
            for start in range(0, len(texts), 255):
                number = "" if start == 0 else str(start // 255 + 1)
                records.append(self._text(1, f"{name}{number}", texts[start : start + 255]))
        if self.descriptions:
            records.append(self._text(1, "DESCRIPTIONS", self.descriptions))
        records.append(_record(1, "RATE", 4, (), self._number(self.rate_hz)))
        records.append(_record(1, "FRAMES", 2, (), self._word(frames)))
        if self.long:
            first, last = (1, 0), divmod(len(self.places_mm), 65536)[::-1]
            for name, halves in (("ACTUAL_START_FIELD", first), ("ACTUAL_END_FIELD", last)):
                records.append(_record(2, name, 2, (2,), b"".join(map(self._word, halves))))
        body = b"".join(self._placed(record) for record in records) + b"\x00\x00"
        blocks = -(-(len(body) + 4) // BLOCK)
        return (bytes((1, 0x50, blocks, self.processor)) + body).ljust(blocks * BLOCK, b"\x00")

    def _frames(self) -> bytes:
        seen = np.all(np.isfinite(self.places_mm), axis=-1)
        places = np.where(seen[..., None], self.places_mm, 0.0)
        fourth = np.where(seen, 0.0, -1.0)[..., None]
        if not self.real:
            places = np.round(places / self.scale)
        rows = np.concatenate((places, fourth), -1).reshape(len(places), -1)
        rows = np.concatenate((rows, np.full((len(rows), self.analogue), 7.0)), axis=1)
        if not self.real:
            return rows.astype(">i2" if self.processor == MIPS else "<i2").tobytes()
        if self.processor == DEC:
            return vax_bytes(rows)
        return rows.astype(">f4" if self.processor == MIPS else "<f4").tobytes()

    def _text(self, group: int, name: str, texts: tuple[str, ...]) -> bytes:
        width = max((len(text.encode()) for text in texts), default=0)
        sizes = (width, len(texts)) if len(texts) != 1 else (width,)
        return _record(group, name, -1, sizes, b"".join(t.encode().ljust(width) for t in texts))

    def _placed(self, record: bytes) -> bytes:
        """Insert the offset to the next record in the processor's byte order."""
        name_end = 2 + abs(struct.unpack_from("b", record)[0])
        return record[:name_end] + self._word(len(record) - name_end) + record[name_end + 2 :]

    def _word(self, value: int) -> bytes:
        return struct.pack(">H" if self.processor == MIPS else "<H", value)

    def _number(self, value: float) -> bytes:
        if self.processor == DEC:
            return vax_bytes(np.array([value]))
        return struct.pack(">f" if self.processor == MIPS else "<f", value)


def vax_bytes(values: npt.NDArray[np.float64]) -> bytes:
    """Return numbers in the VAX F format: the half with sign and exponent comes first."""
    bits = (values.astype(np.float32) * np.float32(4.0)).view(np.uint32)
    halves = np.stack((bits >> 16, bits & 0xFFFF), axis=-1)
    return halves.astype("<u2").tobytes()


def _group(identity: int, name: str) -> bytes:
    return struct.pack("bb", len(name), -identity) + name.encode() + b"\x00\x00" + b"\x00"


def _record(group: int, name: str, kind: int, sizes: tuple[int, ...], data: bytes) -> bytes:
    head = struct.pack("bb", len(name), group) + name.encode() + b"\x00\x00"
    return head + struct.pack("bB", kind, len(sizes)) + bytes(sizes) + data + b"\x00"
