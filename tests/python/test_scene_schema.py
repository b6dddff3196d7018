# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene files' JSON Schema against scenes, good and bad.

tests/native/io/scene_schema_test.cpp holds the schema against the reader.
"""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

ROOT = Path(__file__).resolve().parents[2]
ASSIGNMENT = ROOT / "../shared/seed"
SCENES = sorted((ROOT / "scenes").glob("*/scene.json"))


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    """Checks documents against the schema, which is itself checked first."""
    schema = json.loads((ROOT / "docs/scene.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.parent.name)
def test_our_scenes_follow_the_schema(
    validator: jsonschema.Draft202012Validator, path: Path
) -> None:
    validator.validate(json.loads(path.read_text(encoding="utf-8")))


def test_there_are_scenes_to_check() -> None:
    assert len(SCENES) >= 3


def test_the_assignments_scenes_follow_the_schema(
    validator: jsonschema.Draft202012Validator,
) -> None:
    paths = sorted(ASSIGNMENT.glob("*.json"))
    if not paths:
        pytest.skip("the assignment's scenes are not here")
    for path in paths:
        validator.validate(json.loads(path.read_text(encoding="utf-8")))


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (["flim"], {}),
        (["film", "resolution"], [0, 100]),
        (["film", "resolution"], [100]),
        (["integrator", "spp"], "many"),
        (["camera", "fov"], 180),
        (["materials", "grey", "type"], "difuse"),
        (["materials", "grey", "color"], [0.5, 0.5, 1.5]),
        (["materials", "glass", "etta"], 2),
        (["objects", 0, "light", "radiance"], [1, -1, 1]),
        (["objects", 1, "positions"], []),
        (["objects", 6, "radius"], 1),
        (["shapes", "ball", "radius"], 0),
    ],
)
def test_a_mistake_is_found(
    validator: jsonschema.Draft202012Validator, place: list[Any], value: object
) -> None:
    scene = json.loads((ROOT / "scenes/cbox_path/scene.json").read_text(encoding="utf-8"))
    validator.validate(scene)
    broken = copy.deepcopy(scene)
    target = broken
    for key in place[:-1]:
        target = target[key]
    target[place[-1]] = value
    assert not validator.is_valid(broken)
