"""Format the results of `reembody avatar` for people."""

import shlex
from collections.abc import Iterable, Iterator
from typing import Any

from app.cli.avatar.run import Done, Shown
from app.cli.avatar.saving import Saved, change_json, changes_by_group
from app.protocol.avatar_editing import operation_models

_MOST_CHANGES = 40
_IN_HEAD = ("saved", "format", "version")
_HEAD = (
    f"{'axis':<26}{'kp':>12}{'kd':>12}{'torque':>9}{'low':>9}{'high':>9}\n"
    f"{'':<26}{'N m/rad':>12}{'N m s/rad':>12}{'N m':>9}{'deg':>9}{'deg':>9}"
)


def list_text(avatars: list[dict[str, Any]]) -> str:
    """Format the avatars of the lab, one version a line."""
    lines: list[str] = []
    for avatar in avatars:
        lines.append(f"{avatar['key']}  {avatar['title']}")
        lines += [
            f"  {one['version']:>3}  {one['content_hash'][:12]}  {one['origin']:<8}"
            f"  {one['at'][:16]}  {one['by']}  {one['note']}".rstrip()
            for one in avatar["versions"]
        ]
    return "\n".join(lines)


def table(shown: Shown) -> str:
    """Format a configuration: its values for the whole body, then one axis or joint a line."""
    content, source = shown.as_json, shown.source
    rows = content.pop("joints" if shown.single else "axes")
    lines = [source.name, f"file format: {source.form}, version {source.form_version}"]
    lines += [f"{key}: {_value(one)}" for key, one in content.items() if key not in _IN_HEAD]
    lines += ["", _HEAD]
    if shown.single:
        for part, joint in rows.items():
            lines += _joint_rows(part, joint)
    else:
        lines += [_row(name, one, one["low_deg"], one["high_deg"]) for name, one in rows.items()]
    return "\n".join(lines)


def edit_text(done: Done) -> str:
    """Format what an edit changed and lost, and where the result is."""
    lines = list(_changes(change_json(one) for one in done.edited.changed))
    if done.edited.lost:
        lines.append(f"{len(done.edited.lost)} of these values cannot be kept:")
        reasons = dict.fromkeys(one.reason for one in done.edited.lost)
        lines += [f"  {reason}" for reason in reasons]
    lines.append(f"Content hash: {done.content_hash}")
    if done.out is not None:
        lines.append(f"Written: {done.out}")
    if done.saved is not None:
        lines.append(saved_text(done.saved))
    if done.out is None and done.saved is None:
        lines.append("Nothing was written: give --out or --save to keep the result.")
    return "\n".join(lines)


def difference_text(found: dict[str, Any]) -> str:
    """Format how two configurations differ."""
    if found["same"]:
        return "They are the same."
    lines = list(_changes(found["changed"]))
    lines.append("By body group:")
    lines += [
        f"  {one['group']}: {one['values']} of {', '.join(one['parts']) or 'the whole group'}"
        for one in found["groups"]
    ]
    return "\n".join(lines)


def saved_text(saved: Saved) -> str:
    """Format where a configuration was stored, and how it differs from the version before."""
    row = saved.row
    name = f"{row['key']}, version {row['version']} ({row['content_hash'][:12]})"
    if saved.before is None:
        return f"Stored: {name}"
    if saved.before == row["version"]:
        return f"Stored already, unchanged: {name}"
    return "\n".join(
        [f"Stored: {name}; from version {saved.before} differ:", *changes_by_group(saved.changes)]
    )


def loaded_text(found: dict[str, Any]) -> str:
    """Format where a configuration was written, and how an edit of it can be saved."""
    written = f"Written: {found['written']} ({found['content_hash'][:12]})"
    if found["saved"] is None:
        return written
    key, version = found["saved"]["key"], found["saved"]["version"]
    return (
        f"{written}: {key}, version {version}\n"
        f"To save it after an edit: reembody avatar save {shlex.quote(found['written'])} {key}"
        f" --based-on {version}"
    )


def operations_text() -> str:
    """Format every operation with its keys."""
    lines: list[str] = []
    for name, model in operation_models().items():
        about = (model.__doc__ or "").strip().split("\n")[0]
        keys = ", ".join(
            key if field.is_required() else f"[{key}]"
            for key, field in model.model_fields.items()
            if key != "operation"
        )
        lines += [f"{name}: {about}", f"    {keys}"]
    return "\n".join(lines)


def _changes(changes: Iterable[dict[str, Any]]) -> Iterator[str]:
    listed = list(changes)
    yield f"{len(listed)} value{'' if len(listed) == 1 else 's'} differ{'s' * (len(listed) == 1)}."
    for one in listed[:_MOST_CHANGES]:
        unit = f" {one['unit']}" if one["unit"] else ""
        yield f"  {one['path']}: {_value(one['old'])} -> {_value(one['new'])}{unit}"
    if len(listed) > _MOST_CHANGES:
        yield f"  and {len(listed) - _MOST_CHANGES} more; --json has all of them"


def _joint_rows(part: str, joint: dict[str, Any]) -> Iterator[str]:
    yield _row(part, joint["drive"], joint["low_deg"], joint["high_deg"])
    for axis, limit in joint["limits_deg"].items():
        yield _row(f"  {axis}", joint["shared_drive"], -limit, limit)


def _row(name: str, drive: dict[str, float], low_deg: float, high_deg: float) -> str:
    gains = f"{drive['kp_nm_per_rad']:>12.6g}{drive['kd_nm_s_per_rad']:>12.6g}"
    return f"{name:<26}{gains}{drive['max_torque_nm']:>9.6g}{low_deg:>9.4g}{high_deg:>9.4g}"


def _value(value: Any) -> str:
    if value is None:
        return "none"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, dict):
        return ", ".join(f"{key} {_value(one)}" for key, one in value.items()) or "none"
    if isinstance(value, list):
        return ", ".join(_value(one) for one in value) or "none"
    return str(value)
