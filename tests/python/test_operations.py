# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials with operations, made in Python and read from files, without Blender."""

import contextlib
from typing import Any

import numpy as np
import pytest

import basicrt
from basicrt import OperationRef, SceneError

OPERATIONS = [made for name, made in vars(basicrt).items() if name.endswith("Operation")]
SIZE = 16


def fed(made: type, source: OperationRef) -> Any:
    """An operation with another one's value in each field that takes one."""
    operation = made()
    for name, value in vars(made).items():
        if isinstance(value, property):
            with contextlib.suppress(TypeError, ValueError):
                setattr(operation, name, source)
    if isinstance(operation, basicrt.TextureOperation):
        operation.texture = 0
    return operation


def scene_with(material: basicrt.Material) -> basicrt.Scene:
    """A square from (0, 0) to (1, 1) that fills the picture, seen from above."""
    scene = basicrt.Scene()
    scene.textures.append(basicrt.CheckerboardTexture())
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
    square = scene.shapes.append(basicrt.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]])))
    scene.instances.append(basicrt.Instance(square, materials=[scene.materials.append(material)]))
    pose = np.eye(4)
    pose[:3, 3] = (0.5, 0.5, 1)
    scene.camera = basicrt.OrthographicCamera(
        transform=pose, window_min=(-0.5, -0.5), window_max=(0.5, 0.5)
    )
    scene.settings = basicrt.RenderSettings(width=SIZE, height=SIZE, samples=1)
    return scene


def shown(material: basicrt.Material, value: OperationRef) -> np.ndarray:
    """The picture of a value, red, green and blue."""
    material.surface = material.add(basicrt.EmissionShader(radiance=value))
    return np.asarray(basicrt.render(scene_with(material))["Combined"])[..., :3]


def test_a_graph_shows_what_it_computes() -> None:
    material = basicrt.Material()
    place = material.add_operation(basicrt.SurfaceOperation(value="position"))
    x = material.add_operation(basicrt.ComponentOperation(value=place, component="x"))
    wave = material.add_operation(basicrt.MathOperation(operation="sine", a=x))
    picture = shown(material, wave)
    # Each pixel is a sample somewhere within it.
    edges = np.sin(np.arange(SIZE + 1) / SIZE)
    assert np.all(picture[..., 0] >= edges[:-1] - 1e-6)
    assert np.all(picture[..., 0] <= edges[1:] + 1e-6)
    assert np.array_equal(picture[..., 0], picture[..., 2])


@pytest.mark.parametrize("made", OPERATIONS)
def test_every_operation_survives_a_file(made: type, tmp_path) -> None:
    material = basicrt.Material(name="graph")
    first = material.add_operation(basicrt.SurfaceOperation(value="position"))
    last = material.add_operation(fed(made, first))
    material.surface = material.add(basicrt.DiffuseShader(color=last))
    path = tmp_path / "scene.json"
    path.write_text(scene_with(material).to_json())
    (again,) = basicrt.load_scene(path).materials
    assert [repr(entry) for entry in again.operations] == [
        repr(entry) for entry in material.operations
    ]
    assert again.nodes[0].color == last


@pytest.mark.parametrize("made", OPERATIONS)
def test_every_operation_runs(made: type) -> None:
    material = basicrt.Material()
    first = material.add_operation(basicrt.SurfaceOperation(value="position"))
    assert np.isfinite(shown(material, material.add_operation(fed(made, first)))).all()


def test_operations_refer_only_to_those_before_them() -> None:
    material = basicrt.Material()
    material.add_operation(basicrt.MathOperation(a=OperationRef(0)))
    material.surface = material.add(basicrt.EmissionShader())
    with pytest.raises(SceneError, match=r"operations.*0"):
        basicrt.render(scene_with(material))


def test_shaders_refer_only_to_operations_that_there_are() -> None:
    material = basicrt.Material()
    material.surface = material.add(basicrt.DiffuseShader(color=OperationRef(3)))
    with pytest.raises(SceneError, match=r"color.*3"):
        basicrt.render(scene_with(material))


def test_folding_changes_no_pixel() -> None:
    def graph(is_constant: bool) -> np.ndarray:
        material = basicrt.Material()
        half: Any = 0.5
        if not is_constant:
            place = material.add_operation(basicrt.SurfaceOperation(value="position"))
            zero = material.add_operation(basicrt.MathOperation("multiply", place, 0.0))
            half = material.add_operation(basicrt.MathOperation("add", zero, 0.5))
        power = material.add_operation(basicrt.MathOperation("power", half, 3.0))
        return shown(material, power)

    assert np.array_equal(graph(True), graph(False))
