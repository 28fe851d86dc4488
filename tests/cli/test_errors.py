"""Tests of how commands report errors."""

import pytest

from app.cli.errors import UNUSABLE, reported
from app.errors import NotFound


def _said(capsys: pytest.CaptureFixture[str], error: Exception, *, with_valid: bool = False) -> str:
    with pytest.raises(SystemExit) as left, reported(OSError, with_valid=with_valid):
        raise error
    assert left.value.code == UNUSABLE
    out, output = capsys.readouterr()
    assert out == ""
    return output


def test_an_error_is_reported_with_its_remedy(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """An error is reported on standard error with its remedy and an exit code."""
    error = NotFound("there is no study 'x'", valid=["a", "b"], remedy="Name another.")
    assert _said(capsys, error) == "reembody: there is no study 'x'. Name another.\n"


def test_valid_values_are_listed_on_request(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Valid values are listed between message and remedy if the command requests it."""
    error = NotFound("there is no avatar 'x'", valid=["a", "b"], remedy="Name another.")
    assert _said(capsys, error, with_valid=True) == (
        "reembody: there is no avatar 'x'; valid: a, b. Name another.\n"
    )


def test_an_error_without_a_remedy_ends_with_its_message(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """An error without a remedy ends after its message."""
    assert _said(capsys, NotFound("it is gone")) == "reembody: it is gone.\n"


@pytest.mark.parametrize("end", ["", ".", "!", "?"])
def test_message_and_remedy_each_end_with_one_full_stop(
    capsys: pytest.CaptureFixture[str], end: str
) -> None:
    """Message and remedy each end with one full stop, whether or not they were written with one."""
    output = _said(capsys, NotFound(f"it is gone{end}", remedy="Bring it back"))
    assert output == f"reembody: it is gone{end or '.'} Bring it back.\n"


def test_an_expected_error_is_reported_by_its_message(capsys: pytest.CaptureFixture[str]) -> None:
    """An expected error of the operating system is reported by its own message."""
    assert _said(capsys, FileNotFoundError("no such file")) == "reembody: no such file\n"


def test_an_unexpected_error_keeps_its_traceback() -> None:
    """An unexpected error is not caught, so that its traceback is shown."""
    with pytest.raises(KeyError), reported(OSError):
        raise KeyError("a")
