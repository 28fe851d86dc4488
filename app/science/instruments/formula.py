"""The language of score formulas: arithmetic on answers.

    formula = term (("+" | "-") term)*
    term    = factor (("*" | "/") factor)*
    factor  = "-" factor | number | name | function "(" formula ("," formula)* ")" | "(" formula ")"

Functions: mean, sum, min, max. Names: item keys and the keys of earlier scores. A formula is parsed
into a frozen tree; no part of it is ever executed as Python. Length and nesting are limited, so a
formula from an untrusted file is cheap to reject.
"""

import difflib
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from app.science.instruments.errors import FormulaError
from app.science.instruments.tokens import FUNCTIONS, Token, tokenize

MAX_DEPTH = 32


@dataclass(frozen=True)
class Number:
    """A constant in a formula."""

    value: float


@dataclass(frozen=True)
class Name:
    """A reference to the value of an item (after recoding) or of an earlier score."""

    key: str


@dataclass(frozen=True)
class Negative:
    """The negation of an operand."""

    operand: "Node"


@dataclass(frozen=True)
class Binary:
    """Two operands joined by one of + - * /."""

    operator: str
    left: "Node"
    right: "Node"


@dataclass(frozen=True)
class Call:
    """A call of one of `FUNCTIONS` with at least one argument."""

    function: str
    arguments: tuple["Node", ...]


Node = Number | Name | Negative | Binary | Call


def parse_formula(text: str, names: AbstractSet[str]) -> Node:
    """Parse a formula in which only the given `names` may occur.

    Raises FormulaError with the character position of the first error.
    """
    parser = _Parser(text, tokenize(text), names)
    tree = parser.formula(0)
    parser.expect_end()
    return tree


def names_in(node: Node) -> frozenset[str]:
    """Return the keys of all items and scores that the formula uses."""
    match node:
        case Name(key):
            return frozenset({key})
        case Negative(operand):
            return names_in(operand)
        case Binary(_, left, right):
            return names_in(left) | names_in(right)
        case Call(_, arguments):
            return frozenset().union(*map(names_in, arguments))
        case _:
            return frozenset()


class _Parser:
    """Recursive-descent parser of formulas.

    `depth` counts open parentheses and signs; the length of a sum does not increase it.
    """

    def __init__(self, text: str, tokens: tuple[Token, ...], names: AbstractSet[str]) -> None:
        self._text = text
        self._tokens = tokens
        self._names = names
        self._at = 0

    def formula(self, depth: int) -> Node:
        """Parse a sum of terms, left-associative."""
        left = self._term(depth)
        while self._next.text in ("+", "-"):
            operator = self._take().text
            left = Binary(operator, left, self._term(depth))
        return left

    def expect_end(self) -> None:
        """Raise FormulaError if tokens remain."""
        if self._next.kind != "end":
            raise self._error(
                f"{self._next.text!r} cannot follow here",
                "Join two values with + - * or /, and close each parenthesis once.",
            )

    def _term(self, depth: int) -> Node:
        left = self._factor(depth)
        while self._next.text in ("*", "/"):
            operator = self._take().text
            left = Binary(operator, left, self._factor(depth))
        return left

    def _factor(self, depth: int) -> Node:
        if depth > MAX_DEPTH:
            raise self._error(
                f"The formula is nested more than {MAX_DEPTH} deep", "Split it into several scores."
            )
        token = self._take()
        match token.kind:
            case "number":
                return Number(float(token.text))
            case "name" if token.text in FUNCTIONS:
                return self._call(token, depth)
            case "name":
                return self._name(token)
        if token.text == "-":
            return Negative(self._factor(depth + 1))
        if token.text == "(":
            inner = self.formula(depth + 1)
            self._close(token)
            return inner
        self._at -= 1
        found = "the formula ends" if token.kind == "end" else f"there is {token.text!r}"
        raise self._error(
            f"A value is missing: {found}",
            "Write a number, an item, an earlier score or a parenthesis here.",
        )

    def _call(self, function: Token, depth: int) -> Node:
        if self._next.text != "(":
            raise self._error(
                f"{function.text} needs its values in parentheses",
                f"Write it like {function.text}(q1, q2).",
            )
        opening = self._take()
        arguments = [self.formula(depth + 1)]
        while self._next.text == ",":
            self._take()
            arguments.append(self.formula(depth + 1))
        self._close(opening)
        return Call(function.text, tuple(arguments))

    def _name(self, token: Token) -> Node:
        if token.text in self._names:
            return Name(token.text)
        close = difflib.get_close_matches(token.text, sorted(self._names), n=1)
        hint = f"Did you mean {close[0]}? " if close else ""
        valid = ", ".join(sorted(self._names, key=lambda name: (len(name), name))) or "none"
        raise FormulaError(
            self._text,
            token.position,
            f"The name {token.text!r} is unknown",
            f"{hint}Valid names: {valid}; functions: {', '.join(FUNCTIONS)}.",
        )

    def _close(self, opening: Token) -> None:
        if self._next.text != ")":
            raise self._error(
                f"The parenthesis opened at character {opening.position + 1} is not closed here",
                "Add a ')', or an operator between two values.",
            )
        self._take()

    @property
    def _next(self) -> Token:
        return self._tokens[self._at]

    def _take(self) -> Token:
        token = self._tokens[self._at]
        self._at += 1
        return token

    def _error(self, message: str, remedy: str) -> FormulaError:
        return FormulaError(self._text, self._next.position, message, remedy)
