# SPDX-License-Identifier: GPL-3.0-or-later
"""BasicRT, a ray tracer: describe a scene with numpy arrays and plain values, render it, get arrays back.

    import basicrt

    scene = basicrt.load_scene("scene.json")
    pictures = basicrt.render(scene)  # {"Combined": (height, width, 4) float32, ...}
    basicrt.write_exr("out.exr", pictures)

World space is right-handed, lengths are metres, colours scene-linear Rec.709. Transforms are (4, 4) or (3, 4) matrices
that take column vectors. Pictures have their row 0 at the bottom. What can't be rendered raises SceneError, what is
left out or changed warns with SceneWarning.
"""

from ._native import (
    AddShader,
    AreaLight,
    CheckerboardTexture,
    ConductorShader,
    ConstantTexture,
    CubemapFaceCamera,
    CylindricalCamera,
    DiffuseShader,
    EmissionShader,
    Environment,
    EnvironmentLayer,
    EquirectangularCamera,
    FisheyeEquidistantCamera,
    FisheyeEquisolidCamera,
    FisheyePolynomialCamera,
    GlassShader,
    GlossyShader,
    HoldoutShader,
    Image,
    ImageTexture,
    Instance,
    Material,
    Mesh,
    MetallicShader,
    MixShader,
    MultipleScatteringSky,
    OrthographicCamera,
    PassInfo,
    PerspectiveCamera,
    PointLight,
    PreethamSky,
    PrincipledShader,
    Progress,
    RefractionShader,
    RenderSettings,
    Scene,
    SceneError,
    SceneWarning,
    Session,
    SheenShader,
    SingleScatteringSky,
    Sphere,
    SpotLight,
    SunLight,
    TextureRef,
    Tile,
    ToonShader,
    TranslucentShader,
    TransparentShader,
    VolumeShader,
    look_at_camera,
    merge_sums,
    native_version,
    passes,
)
from .images import read_exr, write_exr, write_png
from .merging import merge
from .ray_kinds import RayKind
from .rendering import render
from .scene_files import load_scene

__version__ = "0.1.0"

__all__ = [
    "AddShader",
    "AreaLight",
    "CheckerboardTexture",
    "ConductorShader",
    "ConstantTexture",
    "CubemapFaceCamera",
    "CylindricalCamera",
    "DiffuseShader",
    "EmissionShader",
    "Environment",
    "EnvironmentLayer",
    "EquirectangularCamera",
    "FisheyeEquidistantCamera",
    "FisheyeEquisolidCamera",
    "FisheyePolynomialCamera",
    "GlassShader",
    "GlossyShader",
    "HoldoutShader",
    "Image",
    "ImageTexture",
    "Instance",
    "Material",
    "Mesh",
    "MetallicShader",
    "MixShader",
    "MultipleScatteringSky",
    "OrthographicCamera",
    "PassInfo",
    "PerspectiveCamera",
    "PointLight",
    "PreethamSky",
    "PrincipledShader",
    "Progress",
    "RayKind",
    "RefractionShader",
    "RenderSettings",
    "Scene",
    "SceneError",
    "SceneWarning",
    "Session",
    "SheenShader",
    "SingleScatteringSky",
    "Sphere",
    "SpotLight",
    "SunLight",
    "TextureRef",
    "Tile",
    "ToonShader",
    "TranslucentShader",
    "TransparentShader",
    "VolumeShader",
    "__version__",
    "load_scene",
    "look_at_camera",
    "merge",
    "merge_sums",
    "native_version",
    "passes",
    "read_exr",
    "render",
    "write_exr",
    "write_png",
]

if native_version() != __version__:
    raise ImportError(
        f"basicrt {__version__} was installed over a native module of version {native_version()}: install it again"
    )
