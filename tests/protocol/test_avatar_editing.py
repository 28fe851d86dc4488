"""Laws of the operations on avatar configurations, and the thesis's functions as operations.

Karas (2020), sections 4.2.3, 6.1, 6.3 and 6.4.
"""

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from math import degrees
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter

from app.protocol.avatar import avatar_text, content_of, load_avatar, loaded, single_text
from app.protocol.avatar_editing import (
    Edited,
    Operation,
    differences,
    edited,
    fits_single_template,
    operation_models,
    sums_by_group,
)
from app.science.avatar.body import mirrored_name
from app.science.avatar.configuration import (
    ASPECTS,
    COMPLIANT_GROUPS,
    LIMBS,
    PART_OF,
    AvatarProblem,
    AvatarSettingsError,
    Compliance,
    Configuration,
    degrees_of,
    parts_of,
    primary_axis,
    with_colliders,
    with_global,
)
from app.science.avatar.mjcf import default_configuration
from tests.protocol.edit_vectors import CALLS, FILE, make
from tests.science.avatar.configurations import made_up

STANDARD = default_configuration()
STIFF = Compliance()
EDITED = replace(
    with_colliders(with_global(STANDARD, group="left_leg", kp=9.0), ["LeftHand"], "none"),
    total_mass_kg=61.5,
    population="male",
)
DOCS = Path(__file__).parents[2] / "docs"
_OPERATIONS: TypeAdapter[Sequence[Any]] = TypeAdapter(list[Operation])
A_THOUSAND = settings(
    max_examples=1_000, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
any_configuration = st.integers(0, 2**32).map(made_up)
Json = dict[str, Any]


def shipped(key: str, number: int | None) -> Configuration:
    """Return the only version that is known here; raise AvatarSettingsError for others."""
    if key == "standard" and number in (None, 1):
        return STANDARD
    raise AvatarSettingsError((AvatarProblem("key", "There is no such version.", key),))


def result(configuration: Configuration, *operations: Json) -> Edited:
    """Return what operations make of a configuration, as they are read from JSON."""
    parsed = _OPERATIONS.validate_json(json.dumps(operations))
    return edited(configuration, parsed, shipped)


def after(configuration: Configuration, *operations: Json) -> Configuration:
    """Return the edited configuration; the operations must be possible."""
    done = result(configuration, *operations)
    assert done.problems == ()
    return done.configuration


def functions_of_the_thesis() -> list[tuple[str, Json]]:
    """Return the rows of the table in the docs: function and operation."""
    text = (DOCS / "avatar-editor.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([^|]+) \| [^|]+ \| `(\{.*\})` \| [^|]+ \|$", text, re.M)
    return [(function, json.loads(operation)) for function, operation in rows]


@pytest.mark.parametrize(("function", "operation"), functions_of_the_thesis())
def test_every_function_of_the_thesis_is_an_operation(function: str, operation: Json) -> None:
    """Each row of the table in the docs is an operation that can be made, and it takes effect."""
    done = result(EDITED, operation)
    assert done.problems == (), function
    loses_nothing_and_changes_nothing = operation.get("to") == "multiple"
    assert bool(done.changed) != loses_nothing_and_changes_nothing, function
    assert loaded(load_avatar(avatar_text(done.configuration)).configuration) == loaded(
        done.configuration
    )


def test_the_docs_list_every_operation_with_its_keys() -> None:
    """Every operation has a row with all of its keys, and one that the thesis's table makes."""
    rows = functions_of_the_thesis()
    assert len(rows) == 27
    text = (DOCS / "avatar-configuration.md").read_text(encoding="utf-8")
    for name, model in operation_models().items():
        (row,) = (line for line in text.splitlines() if re.match(rf"\| (`\w+`, )?`{name}`", line))
        for key in set(model.model_fields) - {"operation"}:
            assert f"`{key}`" in row, (name, key)


@A_THOUSAND
@given(any_configuration)
def test_mirroring_twice_changes_nothing(configuration: Configuration) -> None:
    """Exchanging the sides twice restores the bytes; copying a side twice is copying it once."""
    everything = ["gains", "limits", "colliders", "delays", "compliance"]
    swap = {"operation": "mirror", "direction": "swap", "what": everything}
    # Without held angles, which stay, and which the limits of the other side may exclude.
    configuration = replace(configuration, held_rad={})
    once = after(configuration, swap)
    for name in once.axes:
        other = mirrored_name(name)
        if other in configuration.axes:
            assert once.axes[name] == configuration.axes[other]
    assert once.compliance == {
        other_side(group): one for group, one in configuration.compliance.items()
    }
    assert avatar_text(after(once, swap)) == avatar_text(canonical(configuration))
    copy = {"operation": "mirror", "direction": "left_to_right", "what": everything}
    copied = after(configuration, copy)
    assert copied == after(copied, copy)
    for group in COMPLIANT_GROUPS:
        own = other_side(group) if group.startswith("right") else group
        assert copied.compliance.get(group) == configuration.compliance.get(own), group
    assert all(
        copied.axes[name] == configuration.axes[mirrored_name(name)]
        for name in copied.axes
        if name.startswith("Right") and mirrored_name(name) in configuration.axes
    )
    assert all(
        copied.axes[name] == configuration.axes[name]
        for name in copied.axes
        if not name.startswith("Right")
    )


def other_side(group: str) -> str:
    """Return the group on the other side of the body; the trunk and the head are their own."""
    side, _, rest = group.partition("_")
    return f"{'right' if side == 'left' else 'left'}_{rest}" if rest else group


def canonical(configuration: Configuration) -> Configuration:
    """Return the configuration without exceptions that say what holds for the whole body."""
    kind = configuration.colliders
    exceptions = {part: one for part, one in configuration.part_colliders.items() if one != kind}
    return Configuration(**{**vars(configuration), "part_colliders": exceptions})


@settings(A_THOUSAND, max_examples=300)
@given(any_configuration, any_configuration, st.sampled_from(COMPLIANT_GROUPS))
def test_a_reset_gives_back_what_the_source_has(
    configuration: Configuration, source: Configuration, group: str
) -> None:
    """A whole body gets all compliance of the source, a group its own; a second reset is idle.

    A part of a limb alone leaves the limb as soft as it was.
    """
    configuration, source = (replace(one, held_rad={}) for one in (configuration, source))
    load = {"operation": "load", "configuration": content_of(source), "what": list(ASPECTS)}
    whole = after(configuration, load | {"targets": ["all"]})
    assert (whole.compliance, whole.delays_s) == (source.compliance, source.delays_s)
    assert after(whole, load | {"targets": ["all"]}) == whole
    one = after(configuration, load | {"targets": [group]})
    assert one.compliance.get(group) == source.compliance.get(group)
    others = {key: value for key, value in one.compliance.items() if key != group}
    assert others == {k: v for k, v in configuration.compliance.items() if k != group}
    foot = load | {"targets": ["left_foot"], "what": ["gains", "compliance"]}
    assert after(configuration, foot).compliance == configuration.compliance


@A_THOUSAND
@given(any_configuration)
def test_conversions_keep_the_rules_of_the_thesis(configuration: Configuration) -> None:
    """To one joint the larger side counts; back, L becomes [-L, L]; every pose stays possible."""
    done = result(configuration, {"operation": "convert", "to": "single"})
    single = done.configuration
    assert fits_single_template(single)
    for name, before in configuration.axes.items():
        settings_after = single.axes[name]
        if name == primary_axis(PART_OF[name]):
            assert settings_after == before
            continue
        limit = max(abs(before.low_rad), abs(before.high_rad))
        assert (settings_after.low_rad, settings_after.high_rad) == (-limit, limit)
    lost = {one.change.path for one in done.lost}
    assert lost == {one.path for one in done.changed}
    assert (not lost) == fits_single_template(configuration)
    again = result(single, {"operation": "convert", "to": "single"})
    assert (again.lost, again.configuration) == ((), single)
    multiple = after(single, {"operation": "convert", "to": "multiple"})
    assert multiple == single


@settings(max_examples=50, deadline=None)
@given(any_configuration)
def test_a_file_in_the_single_template_holds_the_converted_configuration(
    configuration: Configuration,
) -> None:
    """Writing one joint per part and reading it gives what the conversion gives."""
    single = after(configuration, {"operation": "convert", "to": "single"})
    assert load_avatar(single_text(configuration)).configuration == single


@A_THOUSAND
@given(any_configuration, st.data())
def test_an_edit_of_a_symmetric_limit_goes_to_the_greater_side(
    configuration: Configuration, data: st.DataObject
) -> None:
    """In the single template a new limit replaces the side that it was taken from."""
    names = [name for name in configuration.axes if name != primary_axis(PART_OF[name])]
    assume(names)
    name = data.draw(st.sampled_from(names))
    before = configuration.axes[name]
    low, high = degrees_of(before.low_rad), degrees_of(before.high_rad)
    greater = max(abs(low), abs(high))
    limit = data.draw(st.floats(min(abs(low), abs(high)), 180.0).map(lambda one: round(one, 6)))
    assume(limit not in (greater, 0.0))
    assume(configuration.held_rad.get(name) is None)
    operation = {
        "operation": "edit_joint",
        "targets": [PART_OF[name]],
        "limits_deg": {name[-1]: limit},
    }
    found = after(configuration, operation).axes[name]
    edited_deg = (degrees_of(found.low_rad), degrees_of(found.high_rad))
    if low == -high:
        assert edited_deg == (-limit, limit)
    elif abs(low) > abs(high):
        assert edited_deg == (-limit, max(high, -limit))
    else:
        assert edited_deg == (min(low, limit), limit)


@st.composite
def reversible(draw: st.DrawFn) -> tuple[Configuration, Json, Json]:
    """Draw a configuration, an operation, and the operation that takes it back."""
    found = canonical(draw(any_configuration))
    name = draw(st.sampled_from(sorted(found.axes)))
    part, axis = PART_OF[name], content_of(found)["axes"][name]
    number = st.floats(0.0, 1e6)
    choices: list[tuple[Json, Json]] = []

    def change(operation: str, new: Json, old: Json, **where: Any) -> None:
        head = {"operation": operation, **where}
        choices.append(({**head, **new}, {**head, **old}))

    gains = ("kp_nm_per_rad", "kd_nm_s_per_rad", "max_torque_nm")
    change(
        "set_gains",
        {key: draw(number) for key in gains},
        {key: axis[key] for key in gains},
        targets=[name],
    )
    if name not in found.held_rad:
        low, high = sorted((draw(st.floats(-180, 180)), draw(st.floats(-180, 180))))
        limits = {key: axis[key] for key in ("low_deg", "high_deg")}
        change("set_limits", {"low_deg": low, "high_deg": high}, limits, targets=[name])
        change("set_motion", {"motion": "free"}, {}, targets=[name])
        choices[-1] = (choices[-1][0], choices[-2][1])
    change("set_body", {"gravity": not found.gravity}, {"gravity": found.gravity})
    change("set_body", {"hips": "welded"}, {"hips": found.hips})
    change("set_body", {"target_space": "world"}, {"target_space": found.target_space})
    masses = {"total_mass_kg": found.total_mass_kg, "population": found.population}
    change("set_masses", {"total_mass_kg": 80.5, "population": "male"}, masses)
    share = found.relative_masses.get("Hips")
    change("set_masses", {"percent": {"Hips": 5.0}}, {"percent": {"Hips": share}})
    change("set_colliders", {"kind": "none"}, {"kind": found.collider_of(part)}, targets=[part])
    pair = frozenset(("left_hand", "torso"))
    collides = pair in found.colliding
    change("set_layers", {"collide": not collides}, {"collide": collides}, layers=sorted(pair))
    own_ms = content_of(found).get("delays_ms", {}).get(part, 0.0)
    change("set_delays", {"delay_ms": 12.5}, {"delay_ms": own_ms}, targets=[part])
    if any(found.compliance.get(limb, STIFF).targets == "world" for limb in LIMBS):
        choices.pop()
    soft = found.compliance.get("head", STIFF).stiffness
    percent = {"stiffness_percent": draw(st.floats(1.0, 100.0))}
    change("set_compliance", percent, {"stiffness_percent": 100.0 * soft}, targets=["head"])
    leg = found.compliance.get("left_leg", STIFF)
    if not set(found.delays_s).intersection(parts_of("left_leg")):
        change(
            "set_compliance",
            {"stiffness_percent": 10.0, "limb_targets": "world"},
            {"stiffness_percent": 100.0 * leg.stiffness, "limb_targets": leg.targets},
            targets=["left_leg"],
        )
    if "Hips" not in found.locked_groups:
        choices.append(
            ({"operation": "lock", "group": "Hips"}, {"operation": "unlock", "group": "Hips"})
        )
    whole = {"operation": "load", "configuration": content_of(found)}
    choices += [
        ({"operation": "convert", "to": "single"}, whole),
        ({"operation": "set_motion", "targets": [name], "motion": "limited"}, whole)
        if name not in found.held_rad
        else ({"operation": "unlock", "group": "all"}, whole),
        ({"operation": "load", "key": "standard"}, whole),
    ]
    there, back = draw(st.sampled_from(choices))
    return found, there, back


@A_THOUSAND
@given(reversible())
def test_an_operation_that_is_taken_back_restores_the_bytes(
    drawn: tuple[Configuration, Json, Json],
) -> None:
    """Every reversible operation and its inverse give the same file, byte for byte."""
    before, there, back = drawn
    done = result(before, there, back)
    assert done.problems == ()
    assert (done.changed, avatar_text(done.configuration)) == ((), avatar_text(before))
    assert loaded(done.configuration).content_hash == loaded(before).content_hash


@A_THOUSAND
@given(any_configuration, any_configuration)
def test_differences_name_every_value_and_nothing_else(
    old: Configuration, new: Configuration
) -> None:
    """Writing the new values of a difference into the old content gives the new content."""
    changes = differences(old, new)
    tree = content_of(old)
    for change in changes:
        node = tree
        *above, last = change.path.split(".")
        for step in above:
            node = node.setdefault(step, {})
        if change.new is None:
            node.pop(last)
        else:
            node[last] = change.new
    wanted = content_of(new)
    assert without_empty(tree) == without_empty(wanted)
    assert differences(new, new) == ()
    swapped = {(one.path, json.dumps(one.old), json.dumps(one.new)) for one in changes}
    assert swapped == {
        (one.path, json.dumps(one.new), json.dumps(one.old)) for one in differences(new, old)
    }


def without_empty(tree: Json) -> Json:
    """Return content without empty mappings, which are as if they were left out."""
    kept = {key: without_empty(one) if isinstance(one, dict) else one for key, one in tree.items()}
    return {key: one for key, one in kept.items() if one != {}}


def test_operations_are_made_in_order_and_all_or_none() -> None:
    """A later operation sees what earlier ones did, and one that fails takes all back."""
    soft = {"operation": "set_gains", "targets": ["head"], "kp_nm_per_rad": 10.0}
    twice = {"operation": "set_gains", "targets": ["head"], "kp_factor": 2.0}
    assert after(STANDARD, soft, twice).axes["HeadX"].kp == 20.0
    wrong = {"operation": "lock", "group": "LeftHand", "held_deg": {"LeftHandZ": 170.0}}
    done = result(STANDARD, soft, wrong)
    assert done.configuration is STANDARD
    (problem,) = done.problems
    assert (problem.operation, problem.problem.path) == (1, "held_deg.LeftHandZ")
    mesh = result(STANDARD, {"operation": "set_colliders", "targets": ["all"], "kind": "mesh"})
    (problem,) = mesh.problems
    assert (problem.operation, problem.problem.path) == (None, "colliders")


def test_groups_are_softened_together() -> None:
    """`all` is every group that can be compliant; parts, and world targets of a trunk, are not."""
    soft = {"operation": "set_compliance", "targets": ["all"], "stiffness_percent": 25}
    softened = after(STANDARD, soft)
    assert dict(softened.compliance) == dict.fromkeys(COMPLIANT_GROUPS, Compliance(0.25))
    assert {one.groups for one in differences(STANDARD, softened)} == {
        (group,) for group in COMPLIANT_GROUPS
    }
    sums = sums_by_group(differences(STANDARD, softened))
    assert sums == dict.fromkeys(sums, ((), 2))
    assert set(sums) == set(COMPLIANT_GROUPS)
    stiff = {"stiffness_percent": 100, "limb_targets": "joint"}
    again = after(softened, soft | stiff)
    assert avatar_text(again) == avatar_text(STANDARD)
    for targets, path in (
        (["LeftHand"], "compliance.LeftHand"),
        (["trunk_head"], "compliance.trunk.targets"),
    ):
        wrong = {"operation": "set_compliance", "targets": targets, "limb_targets": "world"}
        done = result(STANDARD, wrong)
        assert done.problems[0].problem.path == path
        assert done.problems[0].problem.remedy


def test_casts_are_mirrored_with_their_angles() -> None:
    """A cast and its angles go to the other side, if they are asked for."""
    cast = {"operation": "lock", "group": "left_arm", "held_deg": {"LeftLowerArmY": 90.0}}
    mirror = {"operation": "mirror", "direction": "left_to_right", "what": ["casts"]}
    both = after(STANDARD, cast, mirror)
    assert both.locked_groups == ("left_arm", "right_arm")
    assert {name: round(degrees(angle)) for name, angle in both.held_rad.items()} == {
        "LeftLowerArmY": 90,
        "RightLowerArmY": 90,
    }
    swap = {"operation": "mirror", "direction": "swap", "what": ["casts"]}
    moved = after(STANDARD, cast, swap)
    assert moved.locked_groups == ("right_arm",)
    assert after(moved, swap) == after(STANDARD, cast)


def test_the_pages_vectors_are_still_what_python_does() -> None:
    """Each case has the same result, and each call of the page makes an edit of the avatar."""
    assert FILE.read_text() == make()
    for name, _, operation in CALLS:
        done = result(EDITED, operation)
        assert (done.problems, bool(done.changed)) == ((), True), name
