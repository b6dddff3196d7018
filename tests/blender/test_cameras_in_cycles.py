# SPDX-License-Identifier: GPL-3.0-or-later
"""What each pixel of each camera sees, and how lenses blur: as in Cycles."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import (
    add_camera,
    add_mesh,
    add_plane,
    new_material,
    new_scene,
    render,
    render_passes,
)

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0"),
]

# Other versions of Cycles are compared by the demo scenes (test_cycles.py).
pytestmark = pytest.mark.skipif(
    bpy.app.version[:2] != (5, 0), reason="compared with the Cycles of Blender 5.0"
)

SENSOR = {"sensor_width": 30, "sensor_height": 20}
POLYNOMIAL = {
    f"fisheye_polynomial_k{i}": k for i, k in enumerate((-0.02, -0.07, 1e-3, -1e-4, 2e-6))
}
CYLINDER = {
    "central_cylindrical_range_u_min": -2,
    "central_cylindrical_range_u_max": 1.5,
    "central_cylindrical_range_v_min": -1.2,
    "central_cylindrical_range_v_max": 0.7,
    "central_cylindrical_radius": 0.5,
}
RANGE = {"latitude_min": -0.5, "latitude_max": 1.2, "longitude_min": -2, "longitude_max": 2.5}
# Not the mirror ball: at its rim a pixel's fraction turns the view by any angle.
PANORAMAS: dict[str, dict[str, Any]] = {
    "EQUIRECTANGULAR": RANGE,
    "EQUIANGULAR_CUBEMAP_FACE": {},
    "FISHEYE_EQUIDISTANT": {"fisheye_fov": 2.5},
    "FISHEYE_EQUISOLID": {"fisheye_fov": 2.5, "fisheye_lens": 10.5, **SENSOR},
    "FISHEYE_LENS_POLYNOMIAL": {"fisheye_fov": 2.5, **POLYNOMIAL, **SENSOR},
    "CENTRAL_CYLINDRICAL": CYLINDER,
}


def use_engine(scene: Any, engine: str, samples: int, filter_width: float) -> None:
    """One of both engines, with nothing between a sample and its pixel."""
    own, cycles = scene.basicrt, scene.cycles
    scene.render.engine = engine
    own.samples = cycles.samples = samples
    own.filter_type = cycles.pixel_filter_type = "GAUSSIAN" if filter_width < 1 else "BOX"
    own.filter_width = cycles.filter_width = filter_width
    cycles.use_adaptive_sampling = cycles.use_denoising = False


@pytest.mark.parametrize("size", [(22, 14), (14, 22)])
@pytest.mark.parametrize("kind", PANORAMAS)
def test_pixels_of_a_panorama_see_what_they_see_in_cycles(
    kind: str, size: tuple[int, int], tmp_path: Path
) -> None:
    scene = new_scene(*size)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=10)
    bpy.ops.object.shade_smooth()
    shift = {"shift_x": 0.01, "shift_y": 0.02}
    made = add_camera((0.3, -0.2, 0.5), (0.4, 0.3, -0.6), kind="PANO", panorama_type=kind, **shift)
    for name, value in PANORAMAS[kind].items():
        setattr(made.data, name, value)
    view_layer = bpy.context.view_layer
    view_layer.use_pass_z = view_layer.use_pass_normal = True
    passes = {}
    for engine in ("BASICRT", "CYCLES"):
        # Cycles' first sample is in the pixel's middle; a narrow filter leaves ours within 1/64 pixel.
        use_engine(scene, engine, 1, 0.01)
        passes[engine] = render_passes(tmp_path)
    name = view_layer.name
    ours, theirs = (passes[engine][f"{name}.Depth"][..., 0] for engine in ("BASICRT", "CYCLES"))
    np.testing.assert_array_equal(ours < 1e9, theirs < 1e9)
    np.testing.assert_allclose(ours, theirs, rtol=5e-4)
    ours, theirs = (passes[engine][f"{name}.Normal"] for engine in ("BASICRT", "CYCLES"))
    np.testing.assert_allclose(ours, theirs, atol=6e-3)
    # Where nothing is seen, ours is transparent.
    alpha = passes["BASICRT"][f"{name}.Combined"][..., 3]
    np.testing.assert_array_equal(alpha > 0.5, passes["BASICRT"][f"{name}.Depth"][..., 0] < 1e9)


def blurred_lights(kind: str, **dof: Any) -> Any:
    """Small bright squares at several depths, and a half of a grey plane far behind."""
    scene = new_scene(24, 24)
    shine = new_material("ShaderNodeEmission", Color=(1, 0.7, 0.4), Strength=20.0)
    for x, y, z in ((-0.8, 0.6, 1), (0.7, 0.7, 2.5), (0.1, -0.5, 0), (0.9, -0.8, -2)):
        h = 0.06
        corners = [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)]
        add_mesh(corners, [(0, 1, 2, 3)], shine, "Square", (x, y, z))
    glow = new_material("ShaderNodeEmission", Color=(0.3, 0.4, 0.5), Strength=0.2)
    add_plane(8, -4, glow).location.x = 4
    lens: dict[str, Any] = {"ortho_scale": 3, "lens": 70, "panorama_type": "FISHEYE_EQUIDISTANT"}
    made = add_camera((0, 0, 5), (0, 0, 0.3), kind=kind, fisheye_fov=0.6, **lens)
    made.data.dof.use_dof = True
    for name, value in dof.items():
        setattr(made.data.dof, name, value)
    return scene


@pytest.mark.parametrize(
    ("kind", "dof"),
    [
        ("PERSP", {"focus_distance": 4, "aperture_fstop": 0.1}),
        ("PERSP", {"focus_distance": 3, "aperture_fstop": 0.1, "aperture_blades": 3}),
        (
            "PERSP",
            {
                "focus_distance": 7,
                "aperture_fstop": 0.1,
                "aperture_blades": 5,
                "aperture_rotation": 0.4,
                "aperture_ratio": 2,
            },
        ),
        ("ORTHO", {"focus_distance": 5, "aperture_fstop": 2, "aperture_blades": 4}),
        ("PANO", {"focus_distance": 3, "aperture_fstop": 0.1}),
    ],
)
def test_blur_is_as_in_cycles(kind: str, dof: dict[str, Any], tmp_path: Path) -> None:
    scene = blurred_lights(kind, **dof)
    pictures = {}
    for engine in ("BASICRT", "CYCLES"):
        use_engine(scene, engine, 1024, 1.0)
        seeds = []
        for seed in range(4):
            scene.basicrt.seed = scene.cycles.seed = seed
            seeds.append(render(tmp_path)[..., :3].astype(float))
        pictures[engine] = np.array(seeds)
    ours, theirs = pictures["BASICRT"], pictures["CYCLES"]
    difference = ours.mean(axis=0) - theirs.mean(axis=0)

    # By blocks of 4 x 4 pixels, whose scatter over the seeds says what is noise.
    def blocks(picture: np.ndarray) -> np.ndarray:
        return picture.reshape(*picture.shape[:-3], 6, 4, 6, 4, 3).mean(axis=(-4, -2))

    variance = blocks(ours).var(axis=0, ddof=1) + blocks(theirs).var(axis=0, ddof=1)
    error = np.sqrt(np.maximum(variance, variance.mean() / 16) / 4)
    mean = theirs.mean()
    worst = np.abs(blocks(difference)) / (5 * error + 0.01 * mean)
    print(f"{kind} {dof}: whole picture {difference.mean() / mean:+.3%}, worst {worst.max():.2f}")
    assert worst.max() < 1
    # Few samples meet the bright squares: the seeds' own scatter can be more than half a percent.
    scatter = sum(p.mean(axis=(1, 2, 3)).var(ddof=1) for p in (ours, theirs))
    assert abs(difference.mean()) < 0.003 * mean + 4 * np.sqrt(scatter / 4)
