"""Convert the cells of a file to forms, and find every problem before anything is stored.

A cell becomes an answer in three steps: a word that was assigned a number becomes that number; a
number x becomes multiply * x + add; an item that the file has already reverse-scored is reversed
back. The result must be a possible answer to the item, or the cell is a problem.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import date, datetime

from app.features.results.imports.schemas import CellProblem, ColumnSet, Mapping
from app.features.results.imports.sheet import Sheet, SheetRow
from app.plain_titles import not_plain
from app.science.instruments import Instrument, Item, fits, score_answers, valid_answers

MISSING = frozenset({"", "na", "n/a", "nan", "null", ".", "-99"})
"""Words for a missing answer; "none" is not among them, as it is an answer on many scales."""
_YES_NO = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
_DATES = {
    "iso": ("%Y-%m-%d", "%Y/%m/%d"),
    "day_first": ("%d.%m.%Y", "%d/%m/%Y", "%d-%m-%Y"),
    "month_first": ("%m/%d/%Y", "%m-%d-%Y"),
}
_SHOWN = 60
MAX_CODE = 80
Value = float | str | bool | None


@dataclass(frozen=True)
class Form:
    """One completed form of the file."""

    line: int
    participant_code: str
    condition: str
    in_study: bool
    answered_on: date | None
    answers: dict[str, Value]
    scores: dict[str, float | None]


@dataclass
class Applied:
    """The forms and problems of a file; `unknown_words` are answers in words without a number.

    `missing`: number of empty cells in forms. `numbers`: the numbers of each item, before
    conversion.
    """

    forms: list[Form] = field(default_factory=list)
    problems: list[CellProblem] = field(default_factory=list)
    unknown_words: dict[str, None] = field(default_factory=dict)
    numbers: dict[str, list[float]] = field(default_factory=dict)
    skipped_rows: int = 0
    missing: int = 0


def apply_mapping(
    sheet: Sheet, mapping: Mapping, instrument: Instrument, study_conditions: frozenset[str]
) -> Applied:
    """Return every form of the file; raise InvalidInput if a mapped column does not exist."""
    return _Run(sheet, mapping, instrument, study_conditions).forms()


class _Run:
    def __init__(
        self,
        sheet: Sheet,
        mapping: Mapping,
        instrument: Instrument,
        study_conditions: frozenset[str],
    ) -> None:
        self._sheet, self._mapping, self._instrument = sheet, mapping, instrument
        self._study = study_conditions
        self._words = {word.casefold(): number for word, number in mapping.words.items()}
        self._turned = frozenset(mapping.turned)
        self._out = Applied()
        names = [mapping.participant, mapping.condition, mapping.date]
        names += [column for one in mapping.sets for column in one.items.values()]
        self._at = {name: sheet.column(name) for name in names if name is not None}

    def forms(self) -> Applied:
        for row in self._sheet.rows:
            found = [form for one in self._mapping.sets for form in self._form(row, one)]
            self._out.skipped_rows += not found
            self._out.forms += found
        self._find_duplicates()
        return self._out

    def _form(self, row: SheetRow, columns: ColumnSet) -> Iterator[Form]:
        cells = {item: self._cell(row, name) for item, name in columns.items.items()}
        if all(self._is_missing(cell) for cell in cells.values()):
            return
        answers: dict[str, Value] = dict.fromkeys(self._instrument.by_key)
        before = len(self._out.problems)
        for item, cell in cells.items():
            answers[item] = self._answer(row, columns.items[item], item, cell)
        condition = self._condition(row, columns)
        code = self._code(row)
        day = self._day(row)
        fit = len(self._out.problems) == before
        yield Form(
            line=row.line,
            participant_code=code,
            condition=condition,
            in_study=condition in self._study,
            answered_on=day,
            answers=answers,
            scores=score_answers(self._instrument, answers) if fit else {},
        )

    def _answer(self, row: SheetRow, column: str, key: str, cell: str) -> Value:
        if self._is_missing(cell):
            self._out.missing += 1
            return None
        item = self._instrument.by_key[key]
        value = self._value(item, cell)
        if value is None:
            self._out.unknown_words[cell[:_SHOWN]] = None
            self._report(
                row, column, "These words have no number yet.", "Assign a number to the word above."
            )
        elif not fits(self._instrument, item, value):
            became = f" (becomes {value:g})" if isinstance(value, float) else ""
            valid = valid_answers(self._instrument, item)
            self._report(
                row,
                column,
                f"{key}: not a possible answer{became}; it must be {valid}.",
                "Correct it in the file, or change how numbers are read.",
            )
            return None
        return value

    def _value(self, item: Item, cell: str) -> Value:
        """Return the answer in a cell, or None for words without a number."""
        if item.type == "text":
            return cell
        if item.type == "choice":
            labels = {
                text.casefold(): one.key for one in item.choices for text in one.label.values()
            }
            return labels.get(cell.casefold(), cell)
        if item.type == "boolean":
            return _YES_NO.get(cell.casefold())
        number = self._words.get(cell.casefold(), self._labels(item).get(cell.casefold()))
        if number is None:
            number = self._number(cell)
            if number is None:
                return None
            self._out.numbers.setdefault(item.key, []).append(number)
            number = self._mapping.multiply * number + self._mapping.add
        return self._reverse_back(item, number)

    def _is_missing(self, cell: str) -> bool:
        word = cell.casefold()
        return word in MISSING and word not in self._words

    def _labels(self, item: Item) -> dict[str, float]:
        """Return the numbers of the scale's own labels, if every step has one."""
        scale = self._instrument.scale_of(item)
        if scale is None or len(scale.labels) != len(scale.steps):
            return {}
        return {
            text.strip().casefold(): float(step)
            for step, label in zip(scale.steps, scale.labels, strict=True)
            for text in label.values()
        }

    def _number(self, cell: str) -> float | None:
        text = cell.replace(",", ".") if self._sheet.separator != "," else cell
        if not text.isascii() or "_" in text or not any(letter.isdigit() for letter in text):
            return None
        try:
            number = float(text)
        except ValueError:
            return None
        return number if math.isfinite(number) else None

    def _reverse_back(self, item: Item, number: float) -> float:
        scale = self._instrument.scale_of(item)
        if item.key not in self._turned or scale is None:
            return number
        return scale.minimum + scale.maximum - number

    def _condition(self, row: SheetRow, columns: ColumnSet) -> str:
        name = self._mapping.condition
        word = columns.condition or "" if name is None else self._cell(row, name)
        if name is not None and not word:
            self._report(row, name, "The condition is missing.", "Fill it in, or remove the row.")
        if len(word) > MAX_CODE and name is not None:
            self._report(row, name, "The condition is too long.", f"At most {MAX_CODE} characters.")
        return self._mapping.conditions.get(word, word)[:MAX_CODE]

    def _code(self, row: SheetRow) -> str:
        name = self._mapping.participant
        code = self._cell(row, name)
        if not code:
            self._report(row, name, "The participant is missing.", "Fill it in, or remove the row.")
        elif (problem := not_plain(code)) is not None:
            self._report(row, name, problem, "Remove the character in the file.")
        elif "@" in code:
            self._report(
                row,
                name,
                "An e-mail address is not a pseudonym.",
                "Replace e-mail addresses with codes first.",
            )
        elif len(code) > MAX_CODE:
            self._report(row, name, "The code is too long.", f"At most {MAX_CODE} characters.")
        return code

    def _day(self, row: SheetRow) -> date | None:
        name = self._mapping.date
        cell = "" if name is None else self._cell(row, name)
        if name is None or not cell:
            return None
        for pattern in _DATES[self._mapping.date_order]:
            try:
                return datetime.strptime(cell.split("T")[0].split(" ")[0], pattern).date()  # noqa: DTZ007 - a day has no zone
            except ValueError:
                continue
        self._report(
            row, name, "This is not a date in the chosen order.", "Choose another date format."
        )
        return None

    def _find_duplicates(self) -> None:
        first: dict[tuple[str, str], int] = {}
        for form in self._out.forms:
            key = (form.participant_code, form.condition)
            if key in first and form.participant_code:
                in_condition = f" in {form.condition!r}" if form.condition else ""
                self._out.problems.append(
                    CellProblem(
                        line=form.line,
                        column=self._mapping.participant,
                        value=form.participant_code[:_SHOWN],
                        message=f"Answered{in_condition} before, in line {first[key]}.",
                        remedy="Choose the column that distinguishes them as the condition.",
                    )
                )
            first.setdefault(key, form.line)

    def _cell(self, row: SheetRow, name: str) -> str:
        return row.cells[self._at[name]].strip()

    def _report(self, row: SheetRow, column: str, message: str, remedy: str) -> None:
        self._out.problems.append(
            CellProblem(
                line=row.line,
                column=column,
                value=self._cell(row, column)[:_SHOWN],
                message=message,
                remedy=remedy,
            )
        )
