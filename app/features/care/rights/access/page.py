"""A participant's page as plain HTML that any browser shows, without scripts or a network."""

from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from html import escape

from app.features.care.rights.access.summary import Visit, Written
from app.features.care.rights.access.words import in_language, words_of
from app.features.record.questionnaires import CorrectionView, StoredAnswers
from app.science.instruments import Instrument, Item

_STYLE = """
:root { color-scheme: light dark; }
body { font: 1rem/1.5 system-ui, sans-serif; max-width: 46rem; margin: 2rem auto; padding: 0 1rem; }
h2 { margin-top: 2.5rem; border-top: 1px solid; padding-top: 1rem; }
dl { display: grid; grid-template-columns: minmax(10rem, 60%) 1fr; gap: .4rem 1rem; }
dd { margin: 0; }
blockquote { white-space: pre-line; }
small { display: block; }
"""
Words = Mapping[str, str]


def answer_text(
    instrument: Instrument,
    item: Item,
    value: object,
    language: str,
    words: Mapping[str, str],
) -> str:
    """Return the answer in words, with its number if it has one."""
    if value is None:
        return words["left_out"]
    if item.type == "choice":
        labels = {choice.key: in_language(choice.label, language) for choice in item.choices}
        return labels.get(str(value), str(value))
    if isinstance(value, str):
        return value
    number = float(str(value))
    if item.type == "boolean":
        return words["yes"] if number else words["no"]
    label = _scale_label(instrument, item, number, language)
    unit = f" {item.unit}" if item.unit else ""
    return f"{number:g}{unit}" + (f" ({label})" if label else "")


def _scale_label(instrument: Instrument, item: Item, number: float, language: str) -> str:
    """Return the label of this step of a scale, if the scale labels every step or its ends."""
    scale = instrument.scale_of(item)
    if scale is None or not scale.labels:
        return ""
    steps = list(scale.steps)
    if len(scale.labels) == len(steps):
        named = dict(zip(steps, scale.labels, strict=True))
    else:
        named = {steps[0]: scale.labels[0], steps[-1]: scale.labels[-1]}
    found = named.get(int(number)) if number == int(number) else None
    return "" if found is None else in_language(found, language)


def page_of(code: str, visits: Iterable[Visit], now: datetime) -> str:
    """Return the page; all texts from people are escaped."""
    shown = list(visits)
    language = shown[-1].session.language if shown else "en"
    words = words_of(language)
    body = [
        f"<h1>{escape(words['title'])}</h1>",
        _paragraph(words["lead"].format(date=_day(now))),
        _pairs([(words["code"], code)]),
        *(part for visit in shown for part in _visit(visit)),
        f"<h2>{escape(words['data'])}</h2>",
        _paragraph(words["data_text"]),
    ]
    return (
        f'<!doctype html>\n<html lang="{escape(language)}">\n<head><meta charset="utf-8">'
        f"<title>{escape(words['title'])}: {escape(code)}</title><style>{_STYLE}</style></head>\n"
        f"<body>\n{chr(10).join(body)}\n</body>\n</html>\n"
    )


def _visit(visit: Visit) -> list[str]:
    session, words = visit.session, words_of(visit.session.language)
    amount = words["contacts"].format(count=visit.contacts, completions=visit.completions)
    facts = [
        (words["study"], visit.study_title),
        (words["status"], words.get(session.status, session.status)),
        (words["language"], session.language),
        (words["kept"], words["frames"].format(count=visit.frames)),
        ("", amount),
        *((words["height"], words["height_text"].format(**_height(one))) for one in visit.heights),
    ]
    heading = words["visit"].format(date=_day(session.started_at or session.created_at))
    return [
        f"<h2>{escape(heading)}</h2>",
        _pairs(facts),
        *_consents(visit, words),
        f"<h3>{escape(words['answers'])}</h3>",
        *([] if visit.forms else [_paragraph(words["no_answers"])]),
        *(part for one in visit.forms for part in _form(*one)),
        f"<h3>{escape(words['notes'])}</h3>",
        *([] if visit.written else [_paragraph(words["no_notes"])]),
        *(_words(one, words) for one in visit.written),
    ]


def _height(body: Mapping[str, object]) -> dict[str, object]:
    return {"stated": body.get("stated", "–"), "matched": body.get("matched", "–")}


def _consents(visit: Visit, words: Words) -> list[str]:
    parts = [f"<h3>{escape(words['consent'])}</h3>"]
    if not visit.consents:
        parts.append(_paragraph(words["consent_none"]))
    for one in visit.consents:
        parts.append(f"<blockquote>{escape(one.text)}</blockquote>")
        given = None if one.at is None else words["consent_given"].format(date=_minute(one.at))
        parts.append(_paragraph(given or words["consent_none"]))
    return parts


def _form(instrument: Instrument, form: StoredAnswers) -> list[str]:
    words, language = words_of(form.language), form.language
    stem = "" if instrument.stem is None else f"{in_language(instrument.stem, language)} "
    rows = []
    for key, value in form.answers.items():
        item = instrument.by_key[key]
        question = (stem if item.type == "likert" else "") + in_language(item.text, language)
        shown = escape(answer_text(instrument, item, value, language, words))
        own = [one for one in form.corrections if one.item == key]
        notes = "".join(_correction(instrument, one, language, words) for one in own)
        rows.append(f"<dt>{escape(question)}</dt><dd>{shown}{notes}</dd>")
    heading = f"{in_language(instrument.title, language)}, {_minute(form.submitted_at)}"
    return [
        f"<h4>{escape(heading)}</h4>",
        f"<dl>{''.join(rows)}</dl>",
        *_scores(instrument, form, words),
    ]


def _correction(instrument: Instrument, one: CorrectionView, language: str, words: Words) -> str:
    item = instrument.by_key[one.item]
    previous = answer_text(instrument, item, one.previous, language, words)
    text = words["was"].format(date=_day(one.at), previous=previous, reason=one.reason)
    return f"<small>{escape(text)}</small>"


def _scores(instrument: Instrument, form: StoredAnswers, words: Words) -> list[str]:
    if not instrument.scores:
        return []
    pairs = []
    for score in instrument.scores:
        value = form.scores.get(score.key)
        shown_score = words["no_score"] if value is None else f"{value:g}"
        if value is not None and score.minimum is not None and score.maximum is not None:
            limits = {"minimum": f"{score.minimum:g}", "maximum": f"{score.maximum:g}"}
            shown_score += f" ({words['range'].format(**limits)})"
        pairs.append((in_language(score.label, form.language), shown_score))
    return [f"<h5>{escape(words['scores'])}</h5>", _pairs(pairs)]


def _words(one: Written, words: Words) -> str:
    head = f"{words[one.kind]}, {_minute(one.at)}"
    return f"<p><b>{escape(head)}</b></p><blockquote>{escape(one.text)}</blockquote>"


def _pairs(pairs: Iterable[tuple[str, str]]) -> str:
    return "<dl>" + "".join(f"<dt>{escape(a)}</dt><dd>{escape(b)}</dd>" for a, b in pairs) + "</dl>"


def _paragraph(text: str) -> str:
    return f"<p>{escape(text)}</p>"


def _day(moment: datetime) -> str:
    return f"{moment.astimezone(UTC):%Y-%m-%d}"


def _minute(moment: datetime) -> str:
    return f"{moment.astimezone(UTC):%Y-%m-%d %H:%M} UTC"
