"""Draw joint errors by finger, for studies in which fingers were recorded.

Contact times by finger are in the figures of contacts, whose rows then name fingers (`by_finger`).
A contact can only name a finger in a phase whose headset sent fingers (`mark_fingers`): in any
other phase the same touch is one of the hand. So times of fingers are means over phases with
fingers alone, never over phases in which they are unknown.
"""

from collections.abc import Iterator

import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.drawing import Drawing, count_note, drawn, participants
from app.features.results.analysis.figures.joint_errors import HEAT, error_definition
from app.features.results.analysis.figures.theme import new_figure
from app.protocol import COUNTED_KINDS
from app.science.skeleton import FINGER_PARTS, FINGERS, finger_of
from app.wire import StreamName

KEY, TITLE = "joint_error_fingers", "Joint error by added latency and finger"
HOW = "Each value is the mean over the three joints of a finger, then over participants."
PALM = "Palm"
_SIDES = ("Left", "Right")
HAND_FINGERS: tuple[str, ...] = tuple(f"{side}{finger}" for side in _SIDES for finger in FINGERS)


def hand_finger_of(part: str) -> str | None:
    """Return the hand and finger of a finger part, such as "LeftThumb"; None for any other part."""
    finger = finger_of(part)
    if finger is None:
        return None
    return f"Left{finger}" if part.startswith("Left") else f"Right{finger}"


def mark_fingers(
    phases: pd.DataFrame, quality: pd.DataFrame, contacts: pd.DataFrame
) -> pd.DataFrame:
    """Return phases with a column `fingers`: whether the fingers were recorded in the phase.

    They were if the stream of the body's fingers has a row in the table of quality, or if a contact
    names a finger, as in phases that are not finished and have no quality yet.
    """
    streams = quality[quality["stream"] == StreamName.ACTUAL_FINGERS]
    named = contacts[contacts["body_part"].isin(FINGER_PARTS)]
    found = set(_phase_keys(streams)) | set(_phase_keys(named))
    return phases.assign(fingers=[key in found for key in _phase_keys(phases)])


def in_some_phases(tasks: pd.DataFrame) -> bool:
    """Return whether fingers were recorded in some of these phases and not in others."""
    return bool(tasks["fingers"].any() and not tasks["fingers"].all())


def by_finger(contacts: pd.DataFrame, tasks: pd.DataFrame) -> pd.DataFrame:
    """Return contacts in which the three parts of a finger have the finger's name.

    The union of their contacts is the time of the finger. If only some of the phases `tasks` have
    fingers, a hand in those is named as its palm, because the hand of the others has fingers that
    are not known apart. Contacts of other parts stay as they are.
    """
    names = {part: hand_finger_of(part) for part in FINGER_PARTS}
    own = contacts["body_part"]
    own = own.map(names).where(own.isin(list(names)), own)
    if in_some_phases(tasks):
        tracked = set(_phase_keys(tasks[tasks["fingers"]]))
        known = [key in tracked for key in _phase_keys(contacts)]
        palms = own.map({f"{side}Hand": f"{side}{PALM}" for side in _SIDES})
        own = own.where(~pd.Series(known, own.index, dtype=bool) | palms.isna(), palms)
    return contacts.assign(body_part=own)


def is_of_fingers(part: str) -> bool:
    """Return whether contacts of this part are known only where fingers were recorded."""
    return finger_of(part) is not None or PALM in part


def fingers_note(tasks: pd.DataFrame) -> str:
    """Return a sentence with the participants whose fingers were recorded; empty without any."""
    n = participants(tasks[tasks["fingers"]])
    if n == 0:
        return ""
    palm = (
        " There the hand without its fingers is the palm; the hand is that of the other phases."
        if in_some_phases(tasks)
        else ""
    )
    return f"Fingers: only phases in which they were recorded, n = {n}.{palm}"


def _phase_keys(rows: pd.DataFrame) -> list[tuple[str, int]]:
    return list(zip(rows["session_id"], rows["phase_id"], strict=True))


def joint_error_fingers_drawings(errors: pd.DataFrame) -> Iterator[Drawing]:
    """Draw a heat map of the mean angle of every finger, from valid rows of the joint errors.

    Nothing is drawn for a study without fingers.
    """
    rows = finger_angles(errors)
    if rows.empty:
        return
    keys = ["finger", "latency_ms"]
    each = rows.groupby([*keys, "participant_code"])["mean_deg"].mean()
    found = each.groupby(level=keys).agg(["mean", "count"]).reset_index()
    found = found.rename(columns={"mean": "mean_deg", "count": "n"})
    table = found.pivot(index="finger", columns="latency_ms", values="mean_deg")
    table = table.loc[[name for name in HAND_FINGERS if name in table.index]]
    figure = new_figure()
    figure.add_trace(
        go.Heatmap(
            x=[str(finger) for finger in table.index],
            y=[f"{latency:g}" for latency in table.columns],
            z=[[None if pd.isna(one) else float(one) for one in row] for row in table.T.to_numpy()],
            hovertemplate="%{x} at %{y} ms: %{z:.2f} deg<extra></extra>",
            **HEAT,
        )
    )
    figure.update_xaxes(title_text="finger", tickangle=-40)
    figure.update_yaxes(title_text="added latency (ms)", type="category", autorange="reversed")
    figure.update_layout(height=200 + 44 * len(table.columns))
    n = participants(rows)
    caption = f"{error_definition(rows)} {HOW} {count_note(n)}"
    yield drawn(KEY, TITLE, caption, n, figure, found).of_group("movement", wide=True)


def finger_angles(errors: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of finger parts in task phases with the whole angle to the present pose.

    The column `finger` names the hand and the finger.
    """
    chosen = errors["axis"].eq("angle") & errors["reference"].eq("present")
    chosen &= errors["phase_kind"].isin(COUNTED_KINDS) & errors["joint"].isin(FINGER_PARTS)
    rows = errors[chosen].dropna(subset=["mean_deg"])
    return rows.assign(finger=rows["joint"].map(hand_finger_of))
