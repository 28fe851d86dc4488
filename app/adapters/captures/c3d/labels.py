"""Name the points of a C3D file.

Labels of older systems have four characters, so "RKNE" may be the label of two markers with
different descriptions. Vicon writes `Subject:` before each label, and lists computed values
(angles, forces) among the points; separate lists say which these are.
"""

from collections import Counter

from app.adapters.captures.c3d.parameters import Parameters

_COMPUTED = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS", "MODELED_MARKERS")


def names_and_places(
    parameters: Parameters, points: int
) -> tuple[tuple[str, ...], list[int], tuple[str, ...]]:
    """Return the markers' names, the index of each marker's point, and notes."""
    labels = parameters.texts("POINT", "LABELS")[:points]
    notes: list[str] = []
    if len(labels) < points:
        notes.append(f"{points - len(labels)} points have no label and are called Marker N.")
        labels += [""] * (points - len(labels))
    computed = {
        label for kind in _COMPUTED[:5] for label in parameters.texts("POINT", kind) if label
    }
    kept = [place for place, label in enumerate(labels) if label not in computed]
    if len(kept) < points:
        notes.append(
            f"{points - len(kept)} points that the file lists as computed (angles, forces) are"
            " left out."
        )
    names = [labels[place] for place in kept]
    if _repeat(names):
        described = parameters.texts("POINT", "DESCRIPTIONS")[:points]
        descriptions = [described[place] if place < len(described) else "" for place in kept]
        if all(descriptions) and not _repeat(descriptions):
            names = descriptions
            notes.append("Labels repeat, so the markers are named by their descriptions.")
    names, prefixed = _without_prefix(names)
    if prefixed:
        notes.append(prefixed)
    return (
        _unlike([n or f"Marker {p + 1}" for n, p in zip(names, kept, strict=True)]),
        kept,
        (*notes,),
    )


def _without_prefix(names: list[str]) -> tuple[list[str], str]:
    subjects = {name.split(":", 1)[0] for name in names if ":" in name}
    bare = [name.split(":", 1)[-1] for name in names]
    if not subjects:
        return names, ""
    if len(subjects) > 1 and _repeat(bare):
        listed = ", ".join(sorted(subjects)[:5])
        return names, f"The file has several subjects ({listed}), so markers keep their prefixes."
    return bare, ""


def _repeat(names: list[str]) -> bool:
    named = [name for name in names if name]
    return len(set(named)) < len(named)


def _unlike(names: list[str]) -> tuple[str, ...]:
    """Number duplicate names: "RKNE", "RKNE (2)"."""
    counts: Counter[str] = Counter()
    used = set(names)
    out: list[str] = []
    for name in names:
        counts[name] += 1
        own = name
        while counts[name] > 1 and (own in used or own in out):
            own = f"{name} ({counts[name]})"
            if own not in used:
                break
            counts[name] += 1
        out.append(own)
    return tuple(out)
