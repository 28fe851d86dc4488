"""Tests of the body as a setting of a condition."""

import json
from dataclasses import replace

import pytest

from app.protocol import ConfigError, compile_plan, load_study
from app.science.avatar.mjcf import default_configuration
from tests.protocol.helpers import edited, instruments, loaded, problems

BODIES = {"female": "f" * 64, "male": "a" * 64}


def with_bodies(*bodies: str, physics: bool = True) -> str:
    """Return the study whose first two conditions add 0 ms and wear these bodies, "" for none."""
    first, second = (f"    body: {one}\n" if one else "" for one in bodies)
    text = edited(
        ("key: latency_0\n", f"key: latency_0\n{first}"),
        (
            "key: latency_125\n    latency_ms: 125\n",
            f"key: latency_125\n    latency_ms: 0\n{second}",
        ),
    )
    moved = "avatar: physics\navatar_configuration: {key: standard, version: 1}"
    return text.replace("avatar: delayed_copy", moved, 1) if physics else text


def test_conditions_of_one_latency_may_differ_in_their_bodies() -> None:
    """Two conditions may add the same latency if their bodies differ, and are part of the design.

    The body stands in the steps of its blocks and in no other step.
    """
    study = loaded(with_bodies("female", "male")).protocol
    assert [one.body for one in study.conditions] == ["female", "male", None]
    assert (study.bodies, study.has_latencies_apart) == ((*BODIES,), False)
    assert study.levels == {one.key: one.key for one in study.conditions}
    other = loaded(with_bodies("female", "")).protocol
    assert other.design_hash != study.design_hash
    plan = compile_plan(study, [one.key for one in study.conditions])
    worn = {step.block: step.body for step in plan if step.kind == "task"}
    assert worn == {1: "female", 2: "male", 3: None}
    assert {step.body for step in plan if step.block is None} == {None}


def test_conditions_of_one_latency_and_one_body_are_refused() -> None:
    """Conditions with the same latency and body cannot be told apart."""
    (problem,) = problems(with_bodies("female", "female"))
    assert problem.path == "conditions[1].latency_ms"
    assert "different bodies" in problem.remedy
    assert problem.line > 0


def test_the_configurations_body_by_its_name_is_no_other_body() -> None:
    """A condition may not name the body that another one of its latency wears without a name."""
    own = replace(default_configuration(), humanoid=BODIES["female"])

    def load(text: str) -> None:
        load_study(text, instruments=instruments(), bodies=BODIES, configured=lambda *_: own)

    with pytest.raises(ConfigError) as caught:
        load(with_bodies("female", ""))
    (problem,) = caught.value.problems
    assert (problem.path, problem.value) == ("conditions[0].body", "female")
    assert "tell them apart" in problem.message
    load(with_bodies("male", ""))


def test_a_condition_without_a_body_keeps_its_hashes() -> None:
    """A study without bodies has the content and the design that it had before there were any."""
    study = loaded()
    assert all("body" not in one for one in json.loads(study.canonical_json)["conditions"])
    before = "43499524481e89a8e5e670e3f6f3c867896555ee84930f79324a2a44b970b2f2"
    assert study.protocol.design_hash == before


def test_an_unknown_body_is_refused_with_those_that_exist() -> None:
    """A body that nobody has named is refused; the error names those that exist."""
    text = with_bodies("femal", "male")
    with pytest.raises(ConfigError) as caught:
        load_study(text, instruments=instruments(), bodies=BODIES)
    (problem,) = caught.value.problems
    assert (problem.path, problem.value) == ("conditions[0].body", "femal")
    assert problem.valid == ["female", "male"]
    assert "female, male" in problem.remedy
    assert load_study(with_bodies("female", "male"), instruments=instruments(), bodies=BODIES)


def test_a_delayed_copy_wears_no_body() -> None:
    """A body in a study with a delayed copy is refused, since it would not be worn."""
    found = problems(with_bodies("female", "male", physics=False))
    assert [one.path for one in found] == ["conditions[0].body", "conditions[1].body"]
    assert "physics" in found[0].remedy
