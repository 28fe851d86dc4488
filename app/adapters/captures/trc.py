"""Read TRC, the tab-separated marker table of Motion Analysis that OpenSim also writes.

    PathFileType  4  (X/Y/Z)  walk.trc
    DataRate  CameraRate  NumFrames  NumMarkers  Units  ...
    150.00    150.00      184        28          mm     ...
    Frame#  Time  R.ASIS          L.ASIS  ...
                  X1  Y1  Z1  X2  Y2  Z2  ...
    1  0.000  516.54  966.88  -306.10  ...

Its header is often wrong: tools cut frames without updating NumFrames, or list computed markers
that the rows do not contain. So the rows take precedence, and a contradicting header causes a note.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.adapters.captures.capture import (
    Capture,
    CaptureError,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.text import text_lines
from app.adapters.captures.units import checked_rate, unit_of_markers
from app.adapters.captures.upright import upright
from app.science.rig import MarkerMotion
from app.science.rotations import FloatArray

_KEY_LINE, _VALUE_LINE, _NAME_LINE, _FIRST_ROW = 2, 3, 4, 6


@dataclass(frozen=True)
class _Header:
    rate_hz: float
    frames: int
    markers: int
    unit: str | None
    names: tuple[str, ...]


def read_trc(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read a table of markers; an empty cell means that a marker was not visible.

    Raises:
        CaptureError: the header or a row cannot be read; the error names the line.
    """
    if len(data) > limits.bytes:
        raise CaptureError(f"{name} has {len(data)} bytes: up to {limits.bytes} are read.")
    lines = enumerate(text_lines(data), 1)
    header = _read_header(lines, limits)
    places = _read_rows(lines, header, limits)
    names, places, notes = _markers_with_values(header, places)
    metres, length = unit_of_markers(header.unit, reading.metres_per_unit, line=_VALUE_LINE)
    if not np.isfinite(places).all(axis=-1).any():
        raise CaptureError(f"none of the {len(names)} markers is seen in any frame.")
    with np.errstate(over="ignore"):
        positions, axes, guesses = upright(
            places * metres, declared=None, chosen=reading.up, usual="y"
        )
    return Capture(
        format="trc",
        motion=MarkerMotion(names, header.rate_hz, positions),
        conventions=Conventions(
            length=length,
            axes=axes,
            rotations=Convention("none", "format"),
            rate=Convention(f"{header.rate_hz:g} Hz", "file"),
        ),
        notes=(*notes, *guesses),
    )


def _read_header(lines: Iterator[tuple[int, str]], limits: Limits) -> _Header:
    head = [line for _, line in zip(range(_NAME_LINE), (text for _, text in lines), strict=False)]
    if len(head) < _NAME_LINE or not head[0].lower().startswith("pathfiletype"):
        raise CaptureError(
            "a TRC file begins with 'PathFileType' and four lines of header.", line=1
        )
    keys = [key.strip().lower() for key in head[_KEY_LINE - 1].split("\t")]
    values = [value.strip() for value in head[_VALUE_LINE - 1].split("\t")]
    by_key = dict(zip(keys, values, strict=False))
    rate = checked_rate(_number(by_key.get("datarate", ""), "DataRate"), line=_VALUE_LINE)
    frames, markers = (
        int(_number(by_key.get(k.lower(), ""), k)) for k in ("NumFrames", "NumMarkers")
    )
    names = [cell.strip() for cell in head[_NAME_LINE - 1].split("\t")[2::3]]
    while names and not names[-1]:
        names.pop()
    if not names or len(names) < markers:
        raise CaptureError(
            f"the header declares {markers} markers, this line names {len(names)}.", line=_NAME_LINE
        )
    if len(names) > limits.tracks:
        raise CaptureError(f"more than {limits.tracks} markers.", line=_NAME_LINE)
    return _Header(rate, frames, markers, by_key.get("units"), _own_names(names))


def _own_names(names: list[str]) -> tuple[str, ...]:
    out: list[str] = []
    seen: set[str] = set()
    for number, name in enumerate(names, 1):
        bare = name.split(":", 1)[-1] or f"Marker {number}"
        own = bare if bare not in seen else f"{bare} ({number})"
        seen.add(own)
        out.append(own)
    return tuple(out)


def _number(word: str, what: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not np.isfinite(value) or abs(value) > 1e12:
        raise CaptureError(f"{what} is {word[:40]!r}: a number is expected.", line=_VALUE_LINE)
    return value


def _read_rows(lines: Iterator[tuple[int, str]], header: _Header, limits: Limits) -> FloatArray:
    """Return positions (N, M, 3) in the file's unit; missing frame numbers become NaN frames."""
    width = 3 * len(header.names)
    most = limits.values // width
    rows: list[FloatArray] = []
    numbers: list[int] = []
    for line, text in lines:
        cells = text.split("\t")
        if line < _FIRST_ROW or not text.strip():
            continue
        numbers.append(_frame_number(cells[0], numbers, line))
        if numbers[-1] - numbers[0] >= most:
            raise CaptureError(f"more than {most} frames of {width} values.", line=line)
        rows.append(_row(cells[2:], width, line))
    if not rows:
        raise CaptureError("there is no row of markers after the header.", line=_FIRST_ROW)
    places = np.full((numbers[-1] - numbers[0] + 1, width), np.nan)
    places[np.array(numbers) - numbers[0]] = rows
    return places.reshape(len(places), -1, 3)


def _frame_number(cell: str, before: list[int], line: int) -> int:
    try:
        number = int(float(cell))
    except (ValueError, OverflowError):
        raise CaptureError(f"expected a frame number, got {cell[:40]!r}.", line=line) from None
    if before and number <= before[-1]:
        raise CaptureError(f"frame {number} follows frame {before[-1]}: they must rise.", line=line)
    return number


def _row(cells: list[str], width: int, line: int) -> FloatArray:
    if any(cell.strip() for cell in cells[width:]):
        raise CaptureError(f"the row has more values than its {width // 3} markers.", line=line)
    coordinates = cells[:width]
    row = np.full(width, np.nan)
    try:
        row[: len(coordinates)] = [float(cell) if cell.strip() else np.nan for cell in coordinates]
    except ValueError:
        wrong = next(cell for cell in coordinates if cell.strip() and not _is_number(cell))
        raise CaptureError(f"expected a coordinate, got {wrong[:40]!r}.", line=line) from None
    row[~np.isfinite(row)] = np.nan
    return row


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _markers_with_values(
    header: _Header, places: FloatArray
) -> tuple[tuple[str, ...], FloatArray, tuple[str, ...]]:
    """Leave out markers beyond NumMarkers that have no values, and return notes on differences."""
    notes: list[str] = []
    visible = np.any(np.isfinite(places).all(axis=-1), axis=0)
    kept = [m for m in range(len(header.names)) if m < header.markers or visible[m]]
    left_out = len(header.names) - len(kept)
    if left_out:
        notes.append(
            f"{left_out} further names in the header have no values in any row and are left out."
        )
    elif len(kept) != header.markers:
        notes.append(f"The header declares {header.markers} markers, the rows contain {len(kept)}.")
    if header.frames != len(places):
        notes.append(f"The header declares {header.frames} frames, the rows have {len(places)}.")
    missing = 1.0 - float(np.isfinite(places[:, kept]).all(axis=-1).mean())
    if missing > 0.0:
        notes.append(f"{100 * missing:.2g} % of the marker positions were not seen.")
    return tuple(header.names[m] for m in kept), places[:, kept], tuple(notes)
