# SPDX-License-Identifier: GPL-3.0-or-later
"""Every class that is bound from a list of fields: constructor, attributes, repr, docs and what they refuse."""

import math

import numpy as np
import pytest

import basicrt
from basicrt import RayKind, SceneError, TextureRef

CLASSES = [
    basicrt.AddShader,
    basicrt.AreaLight,
    basicrt.CheckerboardTexture,
    basicrt.ConductorShader,
    basicrt.ConstantTexture,
    basicrt.CubemapFaceCamera,
    basicrt.CylindricalCamera,
    basicrt.DiffuseShader,
    basicrt.EmissionShader,
    basicrt.Environment,
    basicrt.EquirectangularCamera,
    basicrt.FisheyeEquidistantCamera,
    basicrt.FisheyeEquisolidCamera,
    basicrt.FisheyePolynomialCamera,
    basicrt.GlassShader,
    basicrt.GlossyShader,
    basicrt.Instance,
    basicrt.MixShader,
    basicrt.OrthographicCamera,
    basicrt.PerspectiveCamera,
    basicrt.PointLight,
    basicrt.PrincipledShader,
    basicrt.RefractionShader,
    basicrt.RenderSettings,
    basicrt.Sphere,
    basicrt.SpotLight,
    basicrt.SunLight,
    basicrt.TransparentShader,
    *(bound for name, bound in vars(basicrt).items() if name.endswith("Operation")),
]


def fields(bound: type) -> list[str]:
    """The names of a class's attributes."""
    return [name for name, value in vars(bound).items() if isinstance(value, property)]


def equal(a: object, b: object) -> bool:
    return np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b


@pytest.mark.parametrize("bound", CLASSES)
def test_every_attribute_goes_through_the_constructor_and_assignment(bound: type) -> None:
    default = bound()
    values = {name: getattr(default, name) for name in fields(bound)}
    assert values, "no attributes"
    copy = bound(**values)
    for name, value in values.items():
        assert equal(getattr(copy, name), value), name
        setattr(copy, name, value)
        assert equal(getattr(copy, name), value), name


@pytest.mark.parametrize("bound", CLASSES)
def test_docs_and_repr_name_every_attribute(bound: type) -> None:
    for name in fields(bound):
        assert f"\n{name}: " in str(bound.__doc__)
        assert f"{name}=" in repr(bound())
        assert vars(bound)[name].__doc__


@pytest.mark.parametrize("bound", CLASSES)
def test_unknown_keywords_are_refused_with_the_nearest_name(bound: type) -> None:
    name = fields(bound)[0]
    with pytest.raises(TypeError, match=rf'"{name}x".*{name}'):
        bound(**{f"{name}x": 1})


@pytest.mark.parametrize("bound", CLASSES)
def test_unknown_attributes_can_not_be_assigned(bound: type) -> None:
    with pytest.raises(AttributeError):
        bound().no_such_attribute = 1  # type: ignore[attr-defined]


def test_values_may_go_by_position_in_the_order_of_the_docs() -> None:
    light = basicrt.PointLight((1, 2, 3), (4, 5, 6), 0.5, True)
    assert (light.position, light.intensity) == ((1, 2, 3), (4, 5, 6))
    assert (light.radius, light.soft) == (0.5, True)
    with pytest.raises(TypeError, match="at most 2 arguments, 3 were given"):
        basicrt.Sphere((1, 2, 3), 1, 2)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"position.*twice"):
        basicrt.PointLight((1, 2, 3), position=(1, 2, 3))  # type: ignore[misc]


def test_the_repr_of_plain_values_makes_an_equal_object() -> None:
    volume = basicrt.VolumeShader((0.1, 2, 3e-8), (4, 5, 1e20), anisotropy=-1 / 3)
    again = eval(repr(volume), vars(basicrt))
    for name in fields(basicrt.VolumeShader):
        assert getattr(again, name) == getattr(volume, name)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: basicrt.PointLight(radius=-1), "PointLight.radius: must be at least 0, is -1"),
        (lambda: basicrt.GlassShader(roughness=1.5), r"GlassShader.roughness: must be in \[0, 1\]"),
        (lambda: basicrt.GlassShader(eta=0), "GlassShader.eta: must be "),
        (lambda: basicrt.DiffuseShader((0, 0, 2)), "DiffuseShader.color: .*2"),
        (lambda: basicrt.SunLight(angle=math.nan), "SunLight.angle: must be a finite number"),
        (
            lambda: basicrt.PointLight((0, math.inf, 0)),
            "PointLight.position: must be a finite number",
        ),
        (lambda: basicrt.PointLight((0, 1)), "PointLight.position: must be three numbers"),
        (lambda: basicrt.RenderSettings(width=0), r"RenderSettings.width: must be in \[1, "),
        (lambda: basicrt.RenderSettings(samples=2**40), "RenderSettings.samples: must fit"),
        (lambda: basicrt.RenderSettings(filter_radius=0), "RenderSettings.filter_radius: must be"),
        (lambda: basicrt.RenderSettings(integrator="pth"), 'integrator: .*"pth": .*"path"'),
        (lambda: basicrt.RenderSettings(passes=["Depht"]), 'passes: .*"Depht": .*"Depth"'),
        (lambda: basicrt.Instance(0, materials=[0, -2]), r"Instance.materials\[1\]: must be in"),
        (lambda: basicrt.Instance(0, visibility=-1), "Instance.visibility: must be RayKind bits"),
        (
            lambda: basicrt.Instance(0, motion_transforms=[np.eye(4), np.eye(3)]),
            r"Instance.motion_transforms\[1\]: must have the shape",
        ),
        (
            lambda: basicrt.PerspectiveCamera(motion_transforms=[np.ones((4, 4))]),
            r"PerspectiveCamera.motion_transforms\[0\]: must have the last row 0 0 0 1",
        ),
        (
            lambda: basicrt.RenderSettings(shutter_curve=[1, -1]),
            "RenderSettings.shutter_curve: must be at least 0, is -1",
        ),
        (lambda: basicrt.MixShader(first=-1), "MixShader.first: must be in"),
        (lambda: basicrt.MixShader(1.5), r"MixShader.factor: must be in \[0, 1\]"),
        (
            lambda: basicrt.ImageTexture(np.zeros((1, 1, 1)), "bicubic"),
            'interpolation: .*"bicubic"',
        ),
    ],
)
def test_values_out_of_range_are_refused_by_name(make, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        make()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: basicrt.PointLight(radius="wide"), "PointLight.radius: must be a number"),
        (lambda: basicrt.PointLight(position=3), "PointLight.position: must be three numbers"),
        (lambda: basicrt.PointLight(position="abc"), "PointLight.position: must be three numbers"),
        (lambda: basicrt.PointLight(soft="yes"), "PointLight.soft: must be True or False"),
        (
            lambda: basicrt.DiffuseShader("red"),
            "must be three numbers, a TextureRef or an OperationRef",
        ),
        (lambda: basicrt.RenderSettings(samples=1.5), "samples: must be an integer, is 1.5"),
        (lambda: basicrt.RenderSettings(integrator=3), "integrator: must be a string, is 3"),
        (lambda: basicrt.RenderSettings(passes="Depth"), "passes: must be a list"),
        (lambda: basicrt.Instance(0, materials=3), "materials: must be a list, is 3"),
        (lambda: basicrt.Instance("first"), "Instance.shape: must be an index"),
        (lambda: basicrt.Instance(0, name=3), "Instance.name: must be a string"),
        (
            lambda: basicrt.MixShader("half"),
            "MixShader.factor: must be a number, a TextureRef or an OperationRef",
        ),
        (lambda: basicrt.EnvironmentLayer(image=3), "EnvironmentLayer.image: must be an Image"),
        (lambda: basicrt.EnvironmentLayer(sky=3), "EnvironmentLayer.sky: must be a sky"),
        (lambda: basicrt.Environment(layers=3), "Environment.layers: must be a list"),
        (lambda: basicrt.Environment(layers=[3]), r"layers\[0\]: must be an EnvironmentLayer"),
    ],
)
def test_values_of_another_type_are_type_errors(make, message: str) -> None:
    with pytest.raises(TypeError, match=message):
        make()


def test_what_a_number_raises_itself_is_not_hidden() -> None:
    class Broken:
        def __float__(self) -> float:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        basicrt.PointLight(radius=Broken())
    with pytest.raises(KeyboardInterrupt):
        basicrt.PointLight((0, 0, Broken()))


def test_a_refused_value_leaves_the_old_one() -> None:
    light = basicrt.PointLight(radius=0.5)
    with pytest.raises(SceneError):
        light.radius = -1
    assert light.radius == 0.5


def test_numpy_scalars_and_arrays_are_numbers() -> None:
    light = basicrt.PointLight(np.array([1, 2, 3]), radius=np.float64(0.5), soft=np.True_)
    assert (light.position, light.radius, light.soft) == ((1, 2, 3), 0.5, True)
    assert basicrt.RenderSettings(samples=np.int32(3)).samples == 3


def test_a_color_is_three_numbers_or_a_texture() -> None:
    shader = basicrt.DiffuseShader(TextureRef(3))
    assert shader.color == TextureRef(3) != TextureRef(4)
    assert hash(TextureRef(3)) == hash(TextureRef(3))
    shader.color = (0.25, 0.5, 1)
    assert shader.color == (0.25, 0.5, 1)


def test_a_share_is_a_number_or_a_texture() -> None:
    shader = basicrt.MixShader(TextureRef(3, alpha=True))
    assert shader.factor == TextureRef(3, alpha=True) != TextureRef(3)
    shader.factor = 0.25
    assert shader.factor == 0.25


def test_transforms_are_matrices_of_three_or_four_rows() -> None:
    matrix = np.arange(16.0).reshape(4, 4)
    matrix[3] = (0, 0, 0, 1)
    for given in (matrix, matrix[:3], matrix.tolist(), np.asfortranarray(matrix)):
        stored = basicrt.Instance(0, given).transform
        assert stored.dtype == np.float32
        assert np.array_equal(stored, matrix)


@pytest.mark.parametrize(
    ("matrix", "message"),
    [
        (np.ones((4, 4)), "last row 0 0 0 1"),
        (np.ones((3, 3)), r"shape \(4, 4\) or \(3, 4\), is \(3, 3\)"),
        ([], r"shape \(4, 4\) or \(3, 4\)"),
        (np.full((3, 4), np.nan), r"transform\[0, 0\]: must be a finite number"),
        ([["a"] * 4] * 4, "must hold real numbers"),
    ],
)
def test_other_matrices_are_refused(matrix, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        basicrt.AreaLight(transform=matrix)


def test_passes_come_in_the_order_of_the_table() -> None:
    settings = basicrt.RenderSettings(passes=["Normal", "Combined"])
    assert settings.passes == ["Combined", "Normal"]
    table = {info.name: info.channels for info in basicrt.passes()}
    assert table.items() >= {"Combined": "RGBA", "Depth": "Z", "Normal": "XYZ"}.items()


def test_visibility_takes_flags() -> None:
    hidden = basicrt.Instance(0, visibility=RayKind.ALL & ~RayKind.CAMERA).visibility
    assert not hidden & RayKind.CAMERA
    assert hidden & RayKind.SHADOW


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((0, 0, 0), (0, 0, 0), (0, 1, 0), 1, 1), "position and look_at"),
        (((0, 0, 0), (0, 1, 0), (0, 1, 0), 1, 1), "up"),
        (((0, 0, 0), (0, 0, 1), (0, 1, 0), 4, 1), r"fov: must be in \(0, pi\)"),
        (((0, 0, 0), (0, 0, 1), (0, 1, 0), 1, 0), "aspect: must be above 0"),
        (((0, 0, math.nan), (0, 0, 1), (0, 1, 0), 1, 1), "must be finite"),
    ],
)
def test_a_camera_needs_a_direction_and_an_angle(arguments, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        basicrt.look_at_camera(*arguments)


def test_a_look_at_camera_has_the_field_of_view_that_was_asked_for() -> None:
    camera = basicrt.look_at_camera((1, 2, 3), (1, 2, -7), (0, 1, 0), math.radians(90), 2)
    assert np.allclose(camera.window_max, (2, 1))
    assert np.allclose(camera.window_min, (-2, -1))
    matrix = camera.transform
    assert np.allclose(matrix[:3, 3], (1, 2, 3))
    assert np.allclose(matrix[:3, :3], np.eye(3), atol=1e-6)
