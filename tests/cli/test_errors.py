"""How a command says that it cannot go on."""

import pytest

from app.cli.errors import UNUSABLE, reported
from app.errors import NotFound


def _said(capsys: pytest.CaptureFixture[str], error: Exception, *, with_valid: bool = False) -> str:
    with pytest.raises(SystemExit) as left, reported(OSError, with_valid=with_valid):
        raise error
    assert left.value.code == UNUSABLE
    out, said = capsys.readouterr()
    assert out == ""
    return said


def test_an_error_of_the_product_is_told_with_its_remedy(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """On standard error, with the exit code for what cannot be used."""
    error = NotFound("there is no study 'x'", valid=["a", "b"], remedy="Name another.")
    assert _said(capsys, error) == "reembody: there is no study 'x'. Name another.\n"


def test_what_is_valid_is_listed_where_a_command_wants_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The list stands between what happened and what to do."""
    error = NotFound("there is no avatar 'x'", valid=["a", "b"], remedy="Name another.")
    assert _said(capsys, error, with_valid=True) == (
        "reembody: there is no avatar 'x'; valid: a, b. Name another.\n"
    )


def test_an_error_without_a_remedy_ends_with_its_message(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """No blank is left where the remedy would stand."""
    assert _said(capsys, NotFound("it is gone")) == "reembody: it is gone.\n"


@pytest.mark.parametrize("end", ["", ".", "!", "?"])
def test_a_message_and_its_remedy_have_one_stop_each(
    capsys: pytest.CaptureFixture[str], end: str
) -> None:
    """Whether or not whoever wrote them put one."""
    said = _said(capsys, NotFound(f"it is gone{end}", remedy="Bring it back"))
    assert said == f"reembody: it is gone{end or '.'} Bring it back.\n"


def test_an_expected_error_is_told_in_its_own_words(capsys: pytest.CaptureFixture[str]) -> None:
    """As the operating system puts it."""
    assert _said(capsys, FileNotFoundError("no such file")) == "reembody: no such file\n"


def test_a_fault_of_the_program_keeps_its_trace() -> None:
    """What nobody expected is no input's fault, and is not hidden."""
    with pytest.raises(KeyError), reported(OSError):
        raise KeyError("a")
