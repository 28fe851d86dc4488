"""Tests of titles and codes that people read: no character that hides or turns writing."""

import pytest
from pydantic import TypeAdapter, ValidationError

from app.features.design.studies.schemas import DuplicateRequest
from app.features.movement.avatar.schemas import AvatarTitle, Note
from app.features.movement.captures.schemas import Title as CaptureTitle
from app.features.movement.humanoids.schemas import BodyTitle
from app.features.movement.walking.schemas import Title as WalkTitle
from app.features.record.calibrations.service import NewCalibration
from app.features.record.devices.endpoints import PairRequest
from app.features.record.self_tests.schemas import DeviceName
from app.plain_titles import not_plain
from app.protocol import ConfigError, load_instrument
from tests.features.design.instruments.test_library import OWN
from tests.protocol.helpers import edited, problems

TURNING = "\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"


@pytest.mark.parametrize("title", [AvatarTitle, BodyTitle, CaptureTitle, WalkTitle])
def test_every_title_refuses_characters_that_turn_writing(title: type[str]) -> None:
    """All titles refuse all twelve characters and say where; right-to-left letters are titles."""
    adapter: TypeAdapter[str] = TypeAdapter(title)
    for mark in TURNING:
        with pytest.raises(ValidationError, match=rf"Character 3 is U\+{ord(mark):04X}"):
            adapter.validate_python(f"ab{mark}cd")
    with pytest.raises(ValidationError, match="a control character"):
        adapter.validate_python("ab\x1bcd")
    for text in ("\u0634\u062e\u0635", "\u05d2\u05d5\u05e3 175 cm", "K\u00f6rper 2"):
        assert adapter.validate_python(text) == text
        assert not_plain(text) is None


def test_notes_of_avatars_may_have_lines_but_nothing_that_hides() -> None:
    """A note has lines, tabs and any script; what turns writing or is invisible is refused."""
    adapter: TypeAdapter[str] = TypeAdapter(Note)
    for mark in (*TURNING, "\u200b", "\u2060", "\ufeff", "\u00ad", "\x1b", "\x85", "\u2028"):
        with pytest.raises(ValidationError, match=rf"Character 3 is U\+{ord(mark):04X}"):
            adapter.validate_python(f"ab{mark}cd")
    letters = ("\u0645\u06cc\u200c\u062e\u0648", "\U0001f469\u200d\U0001f52c")
    for text in ("", "two\r\nlines\tand a tab", *letters):
        assert adapter.validate_python(text) == text


def test_names_of_devices_are_plain_too() -> None:
    """A device's name is refused where it is typed, and made plain in the report of a self-test."""
    with pytest.raises(ValidationError, match=r"Character 5 is U\+202E"):
        PairRequest(code="ABCDEF", name="iPad\u202e3")
    measured = {"motion_to_photon_ms": 41.0, "sd_ms": 3.0, "samples": 40, "method": "camera"}
    with pytest.raises(ValidationError, match=r"Character 5 is U\+2066"):
        NewCalibration.model_validate(
            {"equipment": "Vive\u2066", "measured_on": "2026-03-02"} | measured
        )
    adapter: TypeAdapter[str] = TypeAdapter(DeviceName)
    assert adapter.validate_python(f" Quest{TURNING} 3\x1b ") == "Quest 3"
    with pytest.raises(ValidationError, match="at least 1"):
        adapter.validate_python(TURNING)


def test_titles_of_studies_refuse_them_too() -> None:
    """A study's file and the title of a copy are refused with the position."""
    with pytest.raises(ValidationError, match=r"Character 1 is U\+202E"):
        DuplicateRequest(key="copy", title={"en": "\u202ecopy"})
    turned = edited(("en: Acting through", 'en: "\\u202eActing through')).replace(
        "another body\n", 'another body"\n', 1
    )
    (problem,) = problems(turned)
    assert problem.path == "title"
    assert "The title (en) is not plain text. Character 1 is U+202E" in problem.message


def test_titles_of_instruments_refuse_them_too() -> None:
    """A file whose title turns writing is refused at its line, with every other problem."""
    for mark in TURNING:
        turned = OWN.replace("{en: Calm,", f'{{en: "Ca\\u{ord(mark):04x}lm",')
        with pytest.raises(ConfigError) as refused:
            load_instrument(turned.replace("(calm - tense)", "(calm - tens)"))
        title, formula = refused.value.problems
        assert (title.path, title.line) == ("title.en", 4)
        assert f"Character 3 is U+{ord(mark):04X}" in title.message
        assert formula.path == "scores[0].formula"
    with pytest.raises(ConfigError, match="not a mapping of settings"):
        load_instrument("- title: a list")
    assert load_instrument(OWN.replace("en: Calm", "en: \u0634\u062e\u0635"))
