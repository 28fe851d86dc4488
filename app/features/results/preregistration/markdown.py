"""Write the preregistration's report as Markdown, with participants numbered instead of coded."""

from app.features.results.preregistration.schemas import DeviationView, PreregistrationView


def without_codes(view: PreregistrationView) -> PreregistrationView:
    """Return a copy of the view with participants numbered, because the report is published.

    Texts that name participants are replaced by texts that do not.
    """
    codes = list(dict.fromkeys(one.participant_code for one in view.excluded))
    number = {code: f"excluded {at}" for at, code in enumerate(codes, start=1)}
    return view.model_copy(
        update={
            "excluded": [
                one.model_copy(update={"participant_code": number[one.participant_code]})
                for one in view.excluded
            ],
            "deviations": [_unnamed(one) for one in view.deviations],
        }
    )


def as_markdown(view: PreregistrationView) -> str:
    """Return the report as Markdown; remove the participants' codes first (`without_codes`)."""
    lines = [
        f"# Preregistration and deviations: {view.study_key}",
        "",
        f"As of {view.as_of:%Y-%m-%d %H:%M} UTC. Sessions: {view.kind}.",
    ]
    if view.simulated:
        lines += ["", "**SIMULATED DATA: made by a simulation, not by people.**"]
    one = view.declaration
    if one is None:
        return "\n".join([*lines, "", "Not preregistered."]) + "\n"
    frozen = "not frozen yet" if one.frozen_at is None else f"{one.frozen_at:%Y-%m-%d %H:%M} UTC"
    lines += [
        "",
        "## Declared",
        "",
        f"- Study version {one.version}, SHA-256 `{one.content_hash}`",
        f"- Made {one.created_at:%Y-%m-%d %H:%M} UTC; frozen by its first session: {frozen}",
        f"- Registration: {one.registration or 'none named'}",
        f"- Primary test: {one.primary_words}",
        f"- α = {one.alpha:g}; planned n = {one.planned_n}",
        *[f"- Left out: {rule}" for rule in one.rules or ["nobody"]],
        "",
        "## Done",
        "",
        f"- {view.sessions} sessions have ended; {view.included} participants are in the test",
        *[f"- {out.participant_code}: {out.rule}: {out.reason}" for out in view.excluded],
        f"- {view.result.sentence}" if view.result else f"- No result: {view.why_no_result}",
    ]
    if view.result is not None:
        compared = "is at most" if view.result.holds else "exceeds"
        lines += [f"- {view.result.method} p {compared} α.", "", *_table(view)]
    lines += ["", "## Deviations", ""]
    found = [f"- {deviation.text}" for deviation in view.deviations if not deviation.is_note]
    lines += found or ["- None."]
    lines += [
        "",
        "## Notes",
        "",
        *[f"- {deviation.text}" for deviation in view.deviations if deviation.is_note],
    ]
    return "\n".join(lines) + "\n"


def _table(view: PreregistrationView) -> list[str]:
    assert view.result is not None  # noqa: S101 - asked only where there is one
    head = view.result.columns
    rows = [head, ["---"] * len(head), *view.result.rows]
    return [f"| {' | '.join(row)} |" for row in rows]


def _unnamed(one: DeviationView) -> DeviationView:
    texts = {
        "missing_values": "Participants were excluded for a missing value in a condition, not by "
        "a declared rule.",
        "not_judged": "A declared rule could not be applied to some participants, because "
        "nothing was measured. It did not exclude them.",
        "left_out_by_hand": "Sessions that ended early were excluded, although no declared rule "
        "says so.",
    }
    return one.model_copy(update={"text": texts.get(one.code, one.text)})
