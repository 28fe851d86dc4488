"""Read the numbers of a column whatever its decimal sign, and refuse those that mean two things.

Spreadsheets separate columns with semicolons where decimals have a comma. There, 1.164 is often a
thousand, and 1,164 is one in a file from elsewhere: as a decimal it is a thousand times too small,
and reverses an effect. A number of three digits after its only sign is refused where the other
cells of its column say that the sign may separate thousands.
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from app.science.statistics import UnusableTable

_NUMBER = re.compile(r"[+-]?(?:\d*([.,])\d+|\d+)", re.ASCII)
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}[.,]\d{3}")
"""A number that may be thousands: 1 to 3 digits, a sign, exactly 3 digits."""
_FAR = 30.0
"""Ratio of medians from which decimals are doubted among the other numbers of a column."""
_NAMES = {".": "point", ",": "comma"}


@dataclass(frozen=True)
class ReadNumbers:
    """A column with decimal points only, the sentence that says how it was read, and doubts."""

    cells: list[str]
    read_as: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Signed:
    """A number: its line, its text, its decimal sign if it has one, if it may be thousands."""

    line: int
    text: str
    sign: str
    grouped: bool

    @property
    def number(self) -> float:
        return abs(float(self.text.replace(",", ".")))

    @property
    def where(self) -> str:
        return f"{self.text} in line {self.line}"


def read_numbers(
    name: str, cells: Sequence[str], lines: Sequence[int], separator: str
) -> ReadNumbers:
    """Return a column with decimal points; commas are decimal signs in tables with semicolons.

    Raises UnusableTable if a sign may separate thousands, since both readings cannot be right.
    """
    signs = ".," if separator == ";" else "."
    numbers = [
        _Signed(line, cell, found[1] or "", _GROUPED.fullmatch(cell) is not None)
        for line, cell in zip(lines, cells, strict=True)
        if (found := _NUMBER.fullmatch(cell)) and (found[1] or ".") in signs
    ]
    by_sign = {sign: [one for one in numbers if one.sign == sign] for sign in (",", ".", "")}
    for sign, other in ((",", "."), (".", ",")):
        own = by_sign[sign]
        if own and all(one.grouped for one in own):
            _require_decimals(name, own, by_sign[other], by_sign[""])
    commas, points = by_sign[","], by_sign["."]
    pointed = {one.text: one.text.replace(",", ".") for one in commas}
    return ReadNumbers(
        [pointed.get(cell, cell) for cell in cells],
        _said(name, commas),
        tuple(_doubts(name, commas, points, separator)),
    )


def _require_decimals(
    name: str, own: list[_Signed], others: list[_Signed], whole: list[_Signed]
) -> None:
    """Raise UnusableTable if numbers that may be thousands do not fit the others as decimals.

    `own` all have one sign, `others` the other one, `whole` none.
    """
    rest = [one for one in (*others, *whole) if one.number > 0.0]
    if not rest:
        return
    usual, decimal = (median(one.number for one in ones) for ones in (rest, own))
    apart = abs(math.log(usual / decimal))
    nearer_as_thousands = abs(math.log(usual / (1000.0 * decimal))) < apart
    far = apart > math.log(_FAR) and nearer_as_thousands
    if not far and all(one.grouped for one in others):
        return
    first = own[0]
    plain = first.text.replace(first.sign, "")
    raise UnusableTable(
        f"Column {name!r} has {first.where} beside {rest[0].where}: {first.text} can mean {plain}"
        f" or {first.text.replace(',', '.')}, and {len(own)} of its cells are written so. Write"
        f" {plain} if the {_NAMES[first.sign]} separates thousands, or {first.text}0 if it is a"
        " decimal sign."
    )


def _said(name: str, commas: list[_Signed]) -> tuple[str, ...]:
    if not commas:
        return ()
    first, rows = commas[0], "row" if len(commas) == 1 else "rows"
    said = (
        f"{name} has decimal commas in {len(commas)} {rows}: {first.where} was read as"
        f" {first.text.replace(',', '.')}"
    )
    return (said,)


def _doubts(name: str, commas: list[_Signed], points: list[_Signed], separator: str) -> list[str]:
    signed = commas or points
    if commas and points:
        doubt = (
            f"{name} has decimal commas ({len(commas)}, such as {commas[0].where}) and decimal"
            f" points ({len(points)}, such as {points[0].where}); both were read as decimals. If"
            " one of them separates thousands, write those numbers without it"
        )
        return [doubt]
    # In a table with semicolons the point is seldom the decimal sign.
    if not signed or separator != ";" or not all(one.grouped for one in signed):
        return []
    first = signed[0]
    doubt = (
        f"{name} has exactly three digits after every {_NAMES[first.sign]}, such as"
        f" {first.where}: read as decimals. If {first.text.replace(first.sign, '')} is meant,"
        " write it without that sign"
    )
    return [doubt]
