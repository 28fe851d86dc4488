"""Parse the parameter section of a C3D file: named values in named groups.

Source: C3D file format user guide, www.c3d.org. Each record is: length of the name (negative when
locked), group id (negative when the record is the group itself), name, offset to the next record,
then for parameters the type, the dimensions, the values and a description.

Such files were written on three families of processors. Intel writes the lowest byte first and MIPS
the highest. A DEC VAX writes the two halves of a 4-byte number in the opposite order to Intel, and
its exponent has a bias of 128 with the mantissa in [0.5, 1), so that the same bits mean a quarter
of their value in IEEE 754.
"""

import math
import struct
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError

BLOCK = 512
_MOST_RECORDS = 20_000
_SIZES = {-1: 1, 1: 1, 2: 2, 4: 4}


@dataclass(frozen=True)
class Processor:
    """A binary number format: `order` as a numpy byte order, `vax` for DEC's real numbers."""

    name: str
    order: str
    vax: bool = False

    @property
    def integer(self) -> np.dtype[np.int16]:
        """The numpy type of a signed 16-bit integer."""
        return np.dtype(f"{self.order}i2")

    def reals(self, data: bytes) -> npt.NDArray[np.float32]:
        """Decode consecutive 4-byte real numbers."""
        if not self.vax:
            return np.frombuffer(data, f"{self.order}f4").astype(np.float32)
        return vax_reals(np.frombuffer(data, "<u2").reshape(-1, 2))

    def integers(self, data: bytes) -> npt.NDArray[np.int16]:
        """Decode consecutive signed 16-bit integers."""
        return np.frombuffer(data, self.integer)


def vax_reals(halves: npt.NDArray[np.uint16]) -> npt.NDArray[np.float32]:
    """Decode pairs of 16-bit halves (..., 2), the high one first, as numbers (...)."""
    bits = halves[..., 0].astype(np.uint32) << 16 | halves[..., 1].astype(np.uint32)
    with np.errstate(invalid="ignore"):
        quarter: npt.NDArray[np.float32] = bits.view(np.float32) * np.float32(0.25)
    return quarter


INTEL, DEC, MIPS = (
    Processor("Intel", "<"),
    Processor("DEC", "<", vax=True),
    Processor("MIPS", ">"),
)
_BY_CODE = {84: INTEL, 85: DEC, 86: MIPS}


def processor_of(code: int) -> Processor:
    """Return the processor with this code; raise CaptureError for an unknown code."""
    if code not in _BY_CODE:
        raise CaptureError(
            f"the parameter section names processor {code}: 84 (Intel), 85 (DEC) and 86 (MIPS)"
            " are valid, so the file is damaged or no C3D."
        )
    return _BY_CODE[code]


@dataclass(frozen=True)
class Parameter:
    """One parameter, with its raw bytes.

    Types are -1 text, 1 byte, 2 integer, 4 real; the first of the dimensions varies fastest.
    """

    type: int
    sizes: tuple[int, ...]
    data: bytes
    processor: Processor

    def numbers(self) -> list[float]:
        """Return all values in order; an empty list for text."""
        if self.type == 4:
            return [float(value) for value in self.processor.reals(self.data)]
        if self.type == 2:
            return [float(value) for value in self.processor.integers(self.data)]
        return [float(value) for value in self.data] if self.type == 1 else []

    def texts(self) -> list[str]:
        """Return the texts without padding; an empty list for numbers."""
        if self.type != -1:
            return []
        width = self.sizes[0] if self.sizes else len(self.data)
        if width == 0:
            return []
        return [_text(self.data[at : at + width]) for at in range(0, len(self.data), width)]


@dataclass(frozen=True)
class Parameters:
    """The parameters of a file by (group, name), both in capitals."""

    processor: Processor
    values: dict[tuple[str, str], Parameter]

    def number(self, group: str, name: str) -> float | None:
        """Return the first value; None if there is none or it is not a finite number."""
        numbers = self.numbers(group, name)
        return numbers[0] if numbers and math.isfinite(numbers[0]) else None

    def numbers(self, group: str, name: str) -> list[float]:
        """Return all values; an empty list if the parameter is missing."""
        found = self.values.get((group, name))
        return found.numbers() if found else []

    def text(self, group: str, name: str) -> str | None:
        """Return the first text; None if there is none."""
        texts = self.texts(group, name)
        return texts[0] if texts else None

    def texts(self, group: str, name: str) -> list[str]:
        """Return all texts, including those beyond the first 255, in NAME2, NAME3, ..."""
        texts: list[str] = []
        for number in range(1, 100):
            found = self.values.get((group, name if number == 1 else f"{name}{number}"))
            if found is None:
                break
            texts += found.texts()
        return texts


def read_parameters(data: bytes) -> Parameters:
    """Parse the section that the header's first byte points to.

    Raises:
        CaptureError: it is outside the file, or a record extends past its end.
    """
    start = (data[0] - 1) * BLOCK
    if start < BLOCK or start + 4 > len(data):
        raise CaptureError(
            f"the header places the parameters at byte {start} of {len(data)}: the file is"
            " damaged or cut off."
        )
    processor = processor_of(data[start + 3])
    groups: dict[int, str] = {}
    found: list[tuple[int, str, Parameter]] = []
    at = start + 4
    for _ in range(_MOST_RECORDS):
        length, identity = struct.unpack_from("bb", _need(data, at, 2))
        name_end = at + 2 + abs(length)
        if length == 0 or identity == 0:
            break
        name = _text(_need(data, at + 2, abs(length))).upper()
        offset = struct.unpack(f"{processor.order}H", _need(data, name_end, 2))[0]
        if identity < 0:
            groups[-identity] = name
        else:
            found.append((identity, name, _value(data, name_end + 2, processor)))
        if offset == 0:
            break
        at = name_end + offset
        if offset < 2:
            raise CaptureError(f"parameter {name!r} points back into itself: the file is damaged.")
    else:
        raise CaptureError(f"more than {_MOST_RECORDS} parameters: the file is damaged.")
    return Parameters(processor, {(groups.get(g, ""), name): value for g, name, value in found})


def _value(data: bytes, at: int, processor: Processor) -> Parameter:
    kind, count = struct.unpack("bB", _need(data, at, 2))
    if kind not in _SIZES or count > 7:
        raise CaptureError(f"the parameter at byte {at} has type {kind} and {count} dimensions.")
    sizes = tuple(_need(data, at + 2, count))
    return Parameter(
        kind, sizes, _need(data, at + 2 + count, math.prod(sizes) * _SIZES[kind]), processor
    )


def _need(data: bytes, at: int, size: int) -> bytes:
    if at + size > len(data):
        raise CaptureError(
            f"the parameters reach to byte {at + size}, but the file ends at {len(data)}: it is"
            " damaged or cut off."
        )
    return data[at : at + size]


def _text(data: bytes) -> str:
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.strip("\x00 \t\r\n")
