"""Scoring a table from the command line."""

from pathlib import Path

from app.protocol import load_instrument
from app.resources import study_configs_dir
from app.science.instruments.table import score_csv


def score_file(answers: Path, instrument_key: str) -> str:
    """The scored table as CSV; raises ValueError or OSError with what is wrong with the input."""
    folder = study_configs_dir() / "instruments"
    known = {path.stem: path for path in sorted(folder.glob("*.yaml"))}
    if instrument_key not in known:
        raise ValueError(
            f"there is no instrument {instrument_key!r}; there are: {', '.join(known)}"
        )
    loaded = load_instrument(known[instrument_key].read_text(encoding="utf-8"))
    try:
        text = answers.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{answers} is not UTF-8 text; save it as CSV UTF-8") from error
    return score_csv(loaded.instrument, text)
