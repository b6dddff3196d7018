# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene, its tables and materials; what validate() finds; saving and loading."""

import json
import math

import numpy as np
import pytest

import basicrt
from basicrt import SceneError
from support.scenes import add, aim, quad, still_life


def test_tables_append_read_and_assign() -> None:
    lights = basicrt.Scene().lights
    assert len(lights) == 0
    assert lights.append(basicrt.PointLight(radius=1)) == 0
    assert lights.append(basicrt.SunLight()) == 1
    lights[0] = basicrt.SpotLight(radius=2)
    assert isinstance(lights[0], basicrt.SpotLight)
    assert isinstance(lights[-1], basicrt.SunLight)
    assert [type(light) for light in lights] == [basicrt.SpotLight, basicrt.SunLight]


def test_table_entries_are_copies() -> None:
    scene = basicrt.Scene()
    light = basicrt.PointLight(radius=1)
    scene.lights.append(light)
    light.radius = 2
    entry = scene.lights[0]
    assert isinstance(entry, basicrt.PointLight)
    assert entry.radius == 1
    entry.radius = 3
    assert "radius=1.0" in repr(scene.lights[0])


@pytest.mark.parametrize("index", [1, -2, 1 << 40])
def test_an_index_that_is_not_there_is_an_index_error(index: int) -> None:
    scene = basicrt.Scene()
    scene.shapes.append(basicrt.Sphere())
    with pytest.raises(IndexError, match=f"index {index}, but there are 1 entries"):
        scene.shapes[index]
    with pytest.raises(IndexError):
        scene.shapes[index] = basicrt.Sphere()


def test_a_table_takes_its_own_kinds_only() -> None:
    scene = basicrt.Scene()
    with pytest.raises(TypeError, match="Mesh"):
        scene.shapes.append(basicrt.PointLight())  # type: ignore[arg-type]


def test_tables_keep_their_scene_alive() -> None:
    lights = basicrt.Scene().lights
    lights.append(basicrt.PointLight())
    assert len(lights) == 1


def test_settings_and_environment_are_the_scenes_own() -> None:
    scene = basicrt.Scene()
    scene.settings.samples = 3
    scene.environment.radiance = (1, 2, 3)
    assert scene.settings.samples == 3
    assert scene.environment.radiance == (1, 2, 3)
    scene.settings = basicrt.RenderSettings(samples=5)
    scene.environment = basicrt.Environment((4, 5, 6))
    assert scene.settings.samples == 5
    assert scene.environment.radiance == (4, 5, 6)


def test_the_camera_is_assigned_whole() -> None:
    scene = basicrt.Scene()
    assert scene.camera is None
    scene.camera = basicrt.OrthographicCamera(clip_near=2)
    assert isinstance(scene.camera, basicrt.OrthographicCamera)
    assert scene.camera.clip_near == 2
    scene.camera = None
    assert scene.camera is None


def test_materials_are_graphs_of_nodes() -> None:
    material = basicrt.Material("paint")
    first = material.add(basicrt.DiffuseShader())
    mix = material.add(basicrt.MixShader(0.3, first, None))
    material.surface = mix
    assert (material.name, material.surface) == ("paint", 1)
    assert [type(node) for node in material.nodes] == [basicrt.DiffuseShader, basicrt.MixShader]
    mixed = material.nodes[mix]
    assert isinstance(mixed, basicrt.MixShader)
    assert (mixed.first, mixed.second) == (0, None)
    material.surface = None
    assert material.surface is None
    material.volume = material.add(basicrt.VolumeShader(scattering=(1, 2, 3), phase="rayleigh"))
    assert material.volume == 2


def test_the_world_is_filled_by_a_material() -> None:
    scene = still_life()
    assert scene.world_volume is None
    scene.world_volume = 7
    with pytest.raises(basicrt.SceneError, match="world_volume: id 7, but the scene has"):
        scene.validate()
    scene.world_volume = 0
    scene.validate()
    scene.world_volume = None


def broken(change) -> basicrt.Scene:
    scene = still_life()
    change(scene)
    return scene


def set_material(scene: basicrt.Scene, node: object) -> None:
    material = basicrt.Material()
    material.surface = material.add(node)  # type: ignore[arg-type]
    scene.materials[0] = material


def flat(axis: int) -> np.ndarray:
    matrix = np.eye(4)
    matrix[axis, axis] = 0
    return matrix


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda s: setattr(s, "camera", None), "camera"),
        (
            lambda s: s.instances.append(basicrt.Instance(7)),
            r"instances\[3\].shape: id 7, but the scene has 3 shapes",
        ),
        (lambda s: s.instances.append(basicrt.Instance()), r"instances\[3\].shape: id none"),
        (
            lambda s: s.instances.append(basicrt.Instance(0, materials=[None, 9])),
            r"instances\[3\].material.*9.*3 materials",
        ),
        (
            lambda s: s.instances.append(basicrt.Instance(0, flat(1))),
            r"instances\[3\].transform: is singular",
        ),
        (
            lambda s: set_material(s, basicrt.DiffuseShader(basicrt.TextureRef(5))),
            r"materials\[0\].*color.*5.*1 textures",
        ),
        (
            lambda s: set_material(s, basicrt.MixShader(0.5, 0, None)),
            r"materials\[0\].*first: node 0 does not come before node 0",
        ),
        (lambda s: setattr(s.settings, "border_width", 1000), "border"),
        (lambda s: setattr(s.settings, "passes", []), "passes"),
        (
            lambda s: setattr(s, "camera", basicrt.PerspectiveCamera(window_max=(-1, -1))),
            "camera.*window",
        ),
    ],
)
def test_validate_names_the_item_the_rule_and_the_value(change, message: str) -> None:
    scene = broken(change)
    with pytest.raises(SceneError, match=message):
        scene.validate()
    with pytest.raises(SceneError, match=message):
        basicrt.render(scene)


def test_a_good_scene_is_valid() -> None:
    still_life().validate()


def test_an_empty_scene_shows_its_environment() -> None:
    scene = basicrt.Scene()
    scene.environment.radiance = (0.25, 0.5, 1)
    aim(scene, (0, 0, 3), (0, 0, 0), size=(8, 4), samples=1)
    picture = basicrt.render(scene)["Combined"]
    assert np.array_equal(picture, np.broadcast_to(np.float32([0.25, 0.5, 1, 1]), (4, 8, 4)))


def test_meshes_without_area_are_left_out_with_a_warning() -> None:
    scene = basicrt.Scene()
    add(scene, basicrt.Mesh([], []), basicrt.DiffuseShader())
    add(scene, basicrt.Mesh([[0, 0, 0]] * 3, [[0, 1, 2]]), basicrt.DiffuseShader())
    aim(scene, (0, 0, 3), (0, 0, 0), size=(4, 4), samples=1)
    with pytest.warns(basicrt.SceneWarning) as warnings:
        picture = basicrt.render(scene)["Combined"]
    messages = [str(warning.message) for warning in warnings]
    assert any("shapes[0]" in message for message in messages), messages
    assert any("shapes[1]" in message for message in messages), messages
    assert not picture[..., :3].any()


@pytest.mark.filterwarnings("error")
def test_warnings_can_be_made_errors() -> None:
    scene = basicrt.Scene()
    add(scene, basicrt.Mesh([], []), basicrt.DiffuseShader())
    aim(scene, (0, 0, 3), (0, 0, 0), size=(4, 4), samples=1)
    with pytest.raises(basicrt.SceneWarning, match=r"shapes\[0\]"):
        basicrt.render(scene)


def everything() -> basicrt.Scene:
    """Every kind of thing that a scene can hold."""
    scene = still_life(size=(24, 16), samples=4)
    scene.settings.filter_type, scene.settings.filter_radius = "gaussian", 1.25
    scene.settings.seed = -(1 << 40)
    image = np.random.default_rng(5).random((3, 4, 3)).astype(np.float32)
    texture = basicrt.TextureRef(scene.textures.append(basicrt.ImageTexture(image)))
    scene.textures.append(basicrt.ConstantTexture((0.1, 0.2, 0.3)))
    material = basicrt.Material('odd "name"\n')
    nodes = [
        material.add(node)
        for node in (
            basicrt.DiffuseShader(texture),
            basicrt.GlossyShader((0.1, 0.2, 0.3), 0.4),
            basicrt.ConductorShader(alpha_x=0.2, alpha_y=0.3, ggx=True),
            basicrt.RefractionShader(eta=1.2),
            basicrt.TransparentShader((0.9, 0.8, 0.7)),
            basicrt.EmissionShader((0.1, 0.1, 0.1)),
            basicrt.PrincipledShader(metallic=0.5),
            basicrt.VolumeShader(absorption=(0.01, 0.02, 0.03), phase="mie", diameter=7),
        )
    ]
    mixed = nodes[0]
    for node in nodes[1:4]:
        mixed = material.add(basicrt.MixShader(1 / 3, mixed, node))
    material.surface = material.add(basicrt.AddShader(mixed, nodes[5]))
    material.volume = nodes[7]
    index = scene.world_volume = scene.materials.append(material)
    turn = np.eye(4)
    turn[:2, :2] = [[math.cos(0.3), -math.sin(0.3)], [math.sin(0.3), math.cos(0.3)]]
    turn[:3, 3] = (0.1, 0.2, 0.3)
    mesh = quad()
    normals = np.tile(np.float32([0, 0, 1]), (2, 3, 1))
    full = basicrt.Mesh(
        mesh.positions,
        mesh.triangles,
        corner_normals=normals,
        uvs=mesh.uvs,
        material_slots=[0, 1],
    )
    scene.instances.append(
        basicrt.Instance(
            scene.shapes.append(full),
            turn,
            [index, None],
            "quad",
            basicrt.RayKind.CAMERA | basicrt.RayKind.DIFFUSE,
        )
    )
    above = np.eye(4)
    above[2, 3] = 4
    scene.lights.append(basicrt.SpotLight(above, (3, 3, 3), blend=0.3))
    scene.lights.append(basicrt.SunLight((0.1, 0.2, -1), angle=0.1))
    scene.lights.append(basicrt.AreaLight(above, ellipse=True, spread=2))
    return scene


def test_a_saved_scene_renders_the_same_bytes(tmp_path) -> None:
    scene = everything()
    scene.save(tmp_path / "scene.json")
    again = basicrt.load_scene(tmp_path / "scene.json")
    first, second = basicrt.render(scene), basicrt.render(again)
    assert first.keys() == second.keys()
    for name, picture in first.items():
        assert picture.tobytes() == second[name].tobytes(), name
    assert again.to_json() == scene.to_json()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["scene.json"]


def test_the_bits_of_ray_kinds_have_the_names_of_the_files() -> None:
    for kind in basicrt.RayKind:
        if kind is basicrt.RayKind.ALL:
            continue
        scene = basicrt.Scene()
        add(scene, quad(), basicrt.DiffuseShader())
        scene.instances[0] = basicrt.Instance(0, materials=[0], visibility=kind)
        assert kind.name
        assert json.dumps(kind.name.lower()) in scene.to_json()


def test_a_scene_that_can_not_be_saved_leaves_no_file(tmp_path) -> None:
    scene = still_life()
    with pytest.raises(SceneError, match="no_such_folder"):
        scene.save(tmp_path / "no_such_folder" / "scene.json")
    scene.instances.append(basicrt.Instance(7))
    with pytest.raises(SceneError, match="shapes"):
        scene.save(tmp_path / "scene.json")
    assert list(tmp_path.iterdir()) == []


def test_instances_have_properties_by_name() -> None:
    instance = basicrt.Instance(properties={"age": (1, 2, 3)})
    assert instance.properties == {"age": (1, 2, 3)}
    instance.properties = {}
    assert instance.properties == {}
    with pytest.raises(TypeError, match=r"Instance\.properties: must be a dictionary"):
        instance.properties = 3  # type: ignore[assignment]
    with pytest.raises(TypeError, match=r"Instance\.properties\[age\]"):
        instance.properties = {"age": "old"}


def test_lamps_take_the_materials_of_the_scene() -> None:
    scene = basicrt.Scene()
    scene.camera = basicrt.PerspectiveCamera()
    scene.lights.append(basicrt.SunLight(material=0))
    with pytest.raises(SceneError, match=r"lights\[0\]\.material: id 0, but the scene has 0"):
        basicrt.render(scene)
    assert basicrt.SunLight().material is None
