"""How three families of computers wrote their numbers, as a C3D file may have been.

Intel writes the lowest byte first and MIPS the highest. A DEC VAX writes the two halves of a
4-byte number in the other order than Intel, and its exponent counts from 128 with the mantissa in
[0.5, 1), so that the same bits mean a quarter of what IEEE 754 reads.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError


@dataclass(frozen=True)
class Processor:
    """One way to write numbers: `order` as numpy spells it, `vax` for DEC's real numbers."""

    name: str
    order: str
    vax: bool = False

    @property
    def integer(self) -> np.dtype[np.int16]:
        """The type of a signed 16-bit integer."""
        return np.dtype(f"{self.order}i2")

    def reals(self, data: bytes) -> npt.NDArray[np.float32]:
        """Read consecutive 4-byte numbers."""
        if not self.vax:
            return np.frombuffer(data, f"{self.order}f4").astype(np.float32)
        return vax_reals(np.frombuffer(data, "<u2").reshape(-1, 2))

    def integers(self, data: bytes) -> npt.NDArray[np.int16]:
        """Read consecutive signed 16-bit integers."""
        return np.frombuffer(data, self.integer)


def vax_reals(halves: npt.NDArray[np.uint16]) -> npt.NDArray[np.float32]:
    """Turn pairs of 16-bit halves (..., 2), the high one first, into numbers (...)."""
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
    """Return the processor a parameter section names; raises CaptureError for any other code."""
    if code not in _BY_CODE:
        raise CaptureError(
            f"the parameter section names processor {code}: 84 (Intel), 85 (DEC) and 86 (MIPS)"
            " are valid, so the file is damaged or no C3D."
        )
    return _BY_CODE[code]
