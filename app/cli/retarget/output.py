"""Format the results of `reembody retarget`: JSON for scripts, a table for people."""

from dataclasses import asdict

from app.cli.retarget.run import Done
from app.science.retargeting import TOLERANCE_DEG, Table1Row, Walk, Walks

_NONE = "-"


def as_json(done: Done) -> dict[str, object]:
    """Return the result for scripts; stride i is the same stride of source and avatar."""
    result, walks = done.result, done.result.walks
    source = walks.source.strides if walks else ()
    avatar = walks.avatar.strides if walks else ()
    return {
        "frames": result.motion.frame_count,
        "fps": result.motion.rate_hz,
        "leg_ratio": result.leg_ratio,
        "stride_lengths_m": {
            "source": [stride.length_m for stride in source],
            "avatar": [stride.length_m for stride in avatar],
        },
        "step_lengths_m": {
            "source": list(walks.source.step_lengths_m) if walks else [],
            "avatar": list(walks.avatar.step_lengths_m) if walks else [],
        },
        "step_heights_m": {
            "source": [stride.height_m for stride in source],
            "avatar": [stride.height_m for stride in avatar],
        },
        "foot_slide_m_s": walks.slide_m_s if walks else None,
        "unmapped_joints": list(result.unmapped_avatar_joints),
        "floor": asdict(result.floor),
        "notices": [asdict(notice) for notice in done.notices],
        "conventions": asdict(done.clip.capture.conventions),
    }


def as_text(done: Done) -> str:
    """Format the result for people, with units."""
    motion, conventions = done.result.motion, done.clip.capture.conventions
    rows = [
        (name, f"{convention.value} ({convention.origin})")
        for name, convention in (
            ("unit", conventions.length),
            ("axes", conventions.axes),
            ("rotations", conventions.rotations),
            ("rate", conventions.rate),
        )
    ]
    notes = done.clip.notes
    title = (
        f"{done.order.clip.name} onto {done.order.to}: {motion.frame_count} frames at"
        f" {motion.rate_hz:.6g} fps, {motion.duration_s:.2f} s"
    )
    lines = [
        title,
        *(f"  {name:<20}{value}" for name, value in rows),
        *(f"  noted: {note}" for note in notes),
        *(f"  {one.action}: {one.sentence}" for one in done.notices if one.sentence not in notes),
        "",
        *_figures(done),
        f"  {'under the floor':<20}{_floor(done)}",
        f"  {'unmapped, avatar':<20}{_names(done.result.unmapped_avatar_joints)}",
        f"  {'unmapped, clip':<20}{_names(done.result.unmapped_source_joints)}",
    ]
    if done.order.out is not None:
        lines += ["", f"written: {done.order.out}"]
    return "\n".join(lines)


def table1_json(rows: tuple[Table1Row, ...]) -> dict[str, object]:
    """Return the table's roll, pitch and yaw in degrees: printed, computed, and the difference."""
    return {
        "rows": [
            {
                "joint": row.joint,
                "printed": list(row.printed),
                "computed": list(row.computed),
                "difference_deg": row.difference_deg,
            }
            for row in rows
        ]
    }


def table1_text(rows: tuple[Table1Row, ...]) -> str:
    """Format printed and computed angles as a table that marks the source's own inconsistency."""
    lines = [f"{'joint':<12}{'printed (roll, pitch, yaw)':<30}{'computed':<30}{'apart':>7}  deg"]
    for row in rows:
        mark = "  the source contradicts itself here" if row.inconsistent_in_source else ""
        lines.append(
            f"{row.joint:<12}{_angles(row.printed):<30}{_angles(row.computed):<30}"
            f"{row.difference_deg:>7.3f}{mark}"
        )
    agreeing = sum(row.agrees for row in rows)
    lines.append(f"{agreeing} of {len(rows)} rows agree within {TOLERANCE_DEG} deg")
    return "\n".join(lines)


def _figures(done: Done) -> list[str]:
    walks, result = done.result.walks, done.result
    if walks is None:
        return [
            f"  {'scale':<20}{result.scale:.4f} (by {result.scaled_by}; no legs, so no strides)"
        ]
    source, avatar = walks.source, walks.avatar
    return [
        f"  {'':<20}{'clip':>10}{'avatar':>10}{'ratio':>10}",
        _row("leg length", source.leg_length_m, avatar.leg_length_m, "m"),
        _row("thigh share of leg", source.thigh_share, avatar.thigh_share, "", ratio=False),
        _row("stride length, mean", source.mean_stride_length_m, avatar.mean_stride_length_m, "m"),
        _row("step length, mean", source.mean_step_length_m, avatar.mean_step_length_m, "m"),
        _row("step height, mean", source.mean_step_height_m, avatar.mean_step_height_m, "m"),
        *_slide(walks),
        "",
        *_strides(source, avatar),
        "",
    ]


def _slide(walks: Walks) -> list[str]:
    before = _row("foot slide, mean", walks.source.slide_m_s, walks.slide_before_m_s, "m/s")
    if walks.locked is None:
        return [before]
    after = _row("  with feet held", None, walks.slide_m_s, "m/s")
    lowered = f"  hips lowered by at most {walks.locked.lowered_m * 100.0:.1f} cm"
    if walks.locked.out_of_reach:
        lowered += f"; {walks.locked.out_of_reach} frame(s) with a foot out of reach"
    return [before, after, lowered]


def _floor(done: Done) -> str:
    """Say how deep the feet are, and what keeping them above the floor costs."""
    floor = done.result.floor
    left = f"{100.0 * floor.left_m:.1f} cm at most"
    if floor.lifted_m > 0.0:
        return (
            f"{left}; {100.0 * floor.sunk_m:.1f} cm before feet were locked, and single feet"
            f" lifted by at most {100.0 * floor.lifted_m:.1f} cm"
        )
    if floor.raised_m == 0.0:
        return left
    return (
        f"{left}; {100.0 * floor.sunk_m:.1f} cm before the body was raised, by at most"
        f" {100.0 * floor.raised_m:.1f} cm and {100.0 * floor.mean_raised_m:.1f} cm on average"
    )


def _strides(source: Walk, avatar: Walk) -> list[str]:
    if not source.strides:
        return ["  no whole stride"]
    lines = [
        f"  {'stride':<8}{'lift s':>8}{'down s':>8}{'length m':>20}{'height m':>20}",
        f"  {'':<8}{'':>8}{'':>8}{'clip':>10}{'avatar':>10}{'clip':>10}{'avatar':>10}",
    ]
    lines += [
        f"  {a.side:<8}{a.lift_s:>8.2f}{a.contact_s:>8.2f}{a.length_m:>10.3f}{b.length_m:>10.3f}"
        f"{a.height_m:>10.3f}{b.height_m:>10.3f}"
        for a, b in zip(source.strides, avatar.strides, strict=True)
    ]
    return lines


def _row(
    name: str, source: float | None, avatar: float | None, unit: str, *, ratio: bool = True
) -> str:
    shown = _NONE
    if ratio and source and avatar is not None:
        shown = f"{avatar / source:.3f}"
    return f"  {name:<20}{_number(source):>10}{_number(avatar):>10}{shown:>10}  {unit}".rstrip()


def _number(value: float | None) -> str:
    return _NONE if value is None else f"{value:.3f}"


def _angles(angles: tuple[float, float, float]) -> str:
    return "".join(f"{round(angle, 2) + 0.0:>9.2f}" for angle in angles)


def _names(names: tuple[str, ...]) -> str:
    return ", ".join(names) if names else "none"
