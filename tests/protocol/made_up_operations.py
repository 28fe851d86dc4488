"""Made-up operations on avatar configurations: every kind, on what a configuration has."""

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np

from app.protocol.avatar import content_of
from app.science.avatar.body import PART_NAMES, SWITCHABLE_LAYERS
from app.science.avatar.configuration import COMPLIANT_GROUPS, GROUPS, LIMBS, PART_OF, Configuration

T = TypeVar("T")
Json = dict[str, Any]
EVERYTHING = ["gains", "limits", "colliders", "casts", "delays", "compliance"]


def made_up_operations(configuration: Configuration, seed: int, count: int = 4) -> list[Json]:
    """Return operations on a configuration, some of which may contradict it, by their number."""
    rng = np.random.default_rng([seed, count])

    def one_of(names: Sequence[T]) -> T:
        return names[int(rng.integers(len(names)))]

    def number(low: float, high: float) -> float:
        return one_of((round(float(rng.uniform(low, high)), 3), float(rng.uniform(low, high)), low))

    axes = sorted(configuration.axes)
    parts = sorted({PART_OF[name] for name in axes})
    present = [group for group, names in GROUPS.items() if set(names).intersection(parts)]
    axis, part, group = one_of(axes), one_of(parts), one_of(present)
    target = one_of((axis, part, group))
    low, high = sorted((number(-180.0, 0.0), number(-180.0, 180.0)))
    gains = {"kp_nm_per_rad": number(0, 1e4), "kd_nm_s_per_rad": number(0, 100)}
    kinds: dict[str, Callable[[], Json]] = {
        "set_gains": lambda: {"targets": [target], **gains, "max_torque_factor": number(0, 5)},
        "set_limits": lambda: {"targets": [axis], "low_deg": low, "high_deg": high},
        "set_motion": lambda: {
            "targets": [target],
            "motion": one_of(("locked", "limited", "free")),
        },
        "set_axes": lambda: {
            "axes": {axis: {**gains, "max_torque_nm": 7, "low_deg": low, "high_deg": high}}
        },
        "edit_joint": lambda: {
            "targets": [part],
            "drive": {"kp_nm_per_rad": number(0, 1e4)},
            "high_deg": high,
        },
        "convert": lambda: {"to": one_of(("single", "multiple")), "targets": [group]},
        "mirror": lambda: {
            "direction": one_of(("left_to_right", "right_to_left", "swap")),
            "what": EVERYTHING[: int(rng.integers(1, 7))],
        },
        "set_masses": lambda: one_of(
            (
                {"total_mass_kg": number(1, 500), "population": "female"},
                {"percent": {one_of(PART_NAMES): number(1, 3)}},
                {"distribution": one_of(("population", "equal"))},
            )
        ),
        "set_body": lambda: one_of(
            ({"gravity": False}, {"hips": "welded"}, {"target_space": "world"})
        ),
        "set_colliders": lambda: {
            "targets": [one_of((part, group))],
            "kind": one_of(("simple", "none")),
        },
        "set_layers": lambda: {
            "layers": sorted(one_of(sorted(SWITCHABLE_LAYERS, key=sorted))),
            "collide": one_of((True, False)),
        },
        "set_delays": lambda: {"targets": [part], "delay_ms": number(0, 1000)},
        "set_compliance": lambda: one_of(
            (
                {"targets": [one_of(COMPLIANT_GROUPS)], "stiffness_percent": number(1, 100)},
                {"targets": [one_of(sorted(LIMBS))], "limb_targets": "world"},
            )
        ),
        "lock": lambda: {"group": part},
        "unlock": lambda: {"group": one_of(("all", part))},
        "remove_parts": lambda: {"targets": [part]},
        "load": lambda: {"configuration": content_of(configuration), "targets": [group]},
    }
    return [{"operation": kind, **kinds[kind]()} for kind in rng.permutation(list(kinds))[:count]]
