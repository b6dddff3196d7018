# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's meshes arrive whole: corners, normals, uvs, material slots, modifiers."""

import math

import bpy
import numpy as np
import pytest

import basicrt
from support.blender import add_camera, add_mesh, add_plane, export, export_in_render, new_scene

CUBE_VERTICES = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
CUBE_FACES = [
    (0, 2, 3, 1),
    (4, 5, 7, 6),
    (0, 1, 5, 4),
    (2, 6, 7, 3),
    (0, 4, 6, 2),
    (1, 3, 7, 5),
]


@pytest.fixture(autouse=True)
def scene() -> None:
    new_scene()
    add_camera()


def only_mesh() -> basicrt.Mesh:
    exported = export()
    assert len(exported.shapes) == len(exported.instances) == 1
    mesh = exported.shapes[0]
    assert isinstance(mesh, basicrt.Mesh)
    return mesh


def area_of(mesh: basicrt.Mesh) -> float:
    a, b, c = (mesh.positions[mesh.triangles[:, i]].astype(float) for i in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def geometric_normals(mesh: basicrt.Mesh) -> np.ndarray:
    a, b, c = (mesh.positions[mesh.triangles[:, i]].astype(float) for i in range(3))
    normals = np.cross(b - a, c - a)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def test_cube_has_its_vertices_and_two_triangles_for_each_face() -> None:
    add_mesh(CUBE_VERTICES, CUBE_FACES)
    mesh = only_mesh()
    np.testing.assert_array_equal(mesh.positions, np.array(CUBE_VERTICES, np.float32))
    assert mesh.triangles.shape == (12, 3)
    assert area_of(mesh) == pytest.approx(24)
    centers = mesh.positions[mesh.triangles].mean(axis=1)
    assert (np.einsum("ij,ij->i", geometric_normals(mesh), centers) > 0).all(), "faces inwards"


def test_flat_mesh_carries_no_normals() -> None:
    add_mesh(CUBE_VERTICES, CUBE_FACES)
    assert only_mesh().corner_normals is None


def test_concave_polygon_keeps_its_area() -> None:
    # An L of three unit squares.
    outline = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]
    add_mesh(outline, [range(6)])
    mesh = only_mesh()
    assert len(mesh.triangles) == 4
    assert area_of(mesh) == pytest.approx(3)


def test_smooth_sphere_has_radial_corner_normals() -> None:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=1)
    bpy.context.object.data.shade_smooth()
    mesh = only_mesh()
    corners = mesh.positions[mesh.triangles]
    assert mesh.corner_normals.shape == corners.shape
    cosines = (mesh.corner_normals * corners).sum(axis=2)
    assert cosines.min() > 0.999


def test_sharp_edges_split_normals() -> None:
    made = add_mesh(CUBE_VERTICES, CUBE_FACES)
    made.data.shade_smooth()
    sharp = made.data.attributes.new("sharp_edge", "BOOLEAN", "EDGE")
    # Around the top and the bottom face only.
    for edge in made.data.edges:
        low, high = (CUBE_VERTICES[v][2] for v in edge.vertices)
        sharp.data[edge.index].value = low == high
    mesh = only_mesh()
    normals, flat = mesh.corner_normals, geometric_normals(mesh)
    for triangle in range(12):
        is_lid = abs(flat[triangle, 2]) > 0.5
        expected_z = flat[triangle, 2] if is_lid else 0.0
        np.testing.assert_allclose(normals[triangle, :, 2], expected_z, atol=1e-5)
        if not is_lid:  # smooth around: the mean of two walls
            np.testing.assert_allclose(np.abs(normals[triangle, :, :2]), math.sqrt(0.5), atol=1e-5)


def test_custom_normals_arrive() -> None:
    made = add_plane(2)
    tilted = np.array((0.6, 0.0, 0.8))
    made.data.normals_split_custom_set([tuple(tilted)] * 4)
    normals = only_mesh().corner_normals
    # Blender keeps custom normals in 16 bits.
    np.testing.assert_allclose(normals, np.broadcast_to(tilted, normals.shape), atol=1e-3)


def test_uvs_are_those_of_the_layer_active_for_rendering() -> None:
    made = add_plane(2)
    first, second = (made.data.uv_layers.new(name=name) for name in ("First", "Second"))
    for layer, offset in ((first, 0.0), (second, 10.0)):
        for loop in made.data.loops:
            x, y, _ = made.data.vertices[loop.vertex_index].co
            layer.uv[loop.index].vector = (x + offset, y)
    second.active_render = True
    made.data.uv_layers.active = first
    mesh = only_mesh()
    expected = mesh.positions[mesh.triangles][:, :, :2] + (10, 0)
    np.testing.assert_array_equal(mesh.uvs, expected.astype(np.float32))


def test_mesh_without_uvs_has_none() -> None:
    add_plane(2)
    assert only_mesh().uvs is None


def test_faces_keep_their_material_slots() -> None:
    made = add_mesh(CUBE_VERTICES, CUBE_FACES)
    for polygon in made.data.polygons:
        polygon.material_index = polygon.index % 3
    for index in range(3):
        made.data.materials.append(bpy.data.materials.new(f"Slot {index}"))
    mesh = only_mesh()
    faces = np.repeat(np.arange(6), 2)
    axis_of = [np.abs(np.cross(*edges(face))).argmax() for face in CUBE_FACES]
    assert sorted(mesh.material_slots) == sorted(faces % 3)
    # Each triangle lies in a face of its slot: faces 0 and 3, 1 and 4, 2 and 5 share one.
    for triangle, slot in enumerate(mesh.material_slots):
        axis = np.abs(geometric_normals(mesh)[triangle]).argmax()
        assert axis in {axis_of[slot], axis_of[slot + 3]}


def edges(face: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    a, b, c = (np.array(CUBE_VERTICES[i], float) for i in face[:3])
    return b - a, c - b


def test_modifiers_are_applied() -> None:
    made = add_mesh(CUBE_VERTICES, CUBE_FACES)
    made.modifiers.new("Subdivide", "SUBSURF").levels = 2
    assert len(only_mesh().triangles) == 6 * 4**2 * 2
    assert len(made.data.polygons) == 6, "the user's mesh was changed"


def test_mesh_in_edit_mode_arrives(monkeypatch: pytest.MonkeyPatch) -> None:
    made = add_mesh(CUBE_VERTICES, CUBE_FACES)
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.mode_set(mode="EDIT")
    exported = export_in_render(monkeypatch)
    assert made.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(exported.shapes[0].triangles) == 12


def test_modifiers_are_those_of_the_render(monkeypatch: pytest.MonkeyPatch) -> None:
    made = add_mesh(CUBE_VERTICES, CUBE_FACES)
    modifier = made.modifiers.new("Subdivide", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 1
    exported = export_in_render(monkeypatch)
    assert len(exported.shapes[0].triangles) == 6 * 4 * 2


def test_mesh_without_faces_is_left_out() -> None:
    add_mesh([(0, 0, 0), (1, 0, 0)], [])
    exported = export()
    assert len(exported.shapes) == len(exported.instances) == 0


def test_negative_material_index_counts_as_the_first() -> None:
    made = add_plane(2)
    made.data.attributes.new("material_index", "INT", "FACE").data[0].value = -1
    assert set(only_mesh().material_slots) == {0}


@pytest.mark.parametrize("kind", ["curve", "text", "surface", "metaball"])
def test_what_blender_turns_into_meshes_is_exported_once(kind: str) -> None:
    if kind == "curve":
        bpy.ops.curve.primitive_bezier_circle_add()
        bpy.context.object.data.bevel_depth = 0.1
    elif kind == "text":
        bpy.ops.object.text_add()
    elif kind == "surface":
        bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    else:
        bpy.ops.object.metaball_add()
    assert area_of(only_mesh()) > 0.1
