# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether this installation renders what it should: small pictures whose values are known, in a second or two."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native as native
from .rendering import render

Picture = npt.NDArray[np.float32]

# How far a mean may be from its closed form: in standard errors, and relative, for what floats and the size of a patch
# leave open.
_MOST_STANDARD_ERRORS = 5.0
_ROUNDING = 1e-4


@dataclass(frozen=True)
class SelfTestCheck:
    """One thing that was tested."""

    name: str
    is_ok: bool
    detail: str  # what was found, or what went wrong


@dataclass(frozen=True)
class SelfTestResult:
    """What self_test() found."""

    version: str
    kernel: str  # what rays are traced with
    kernels: tuple[str, ...]  # what this machine could trace them with, the best first
    threads: int
    samples_per_second: float  # of a small scene; 0 where it could not be rendered
    checks: tuple[SelfTestCheck, ...]

    @property
    def is_ok(self) -> bool:
        """Whether all is as it should be."""
        return all(check.is_ok for check in self.checks)

    @property
    def machine(self) -> str:
        """One line of what rendered, and how fast."""
        return (
            f"BasicRT {self.version}, {self.kernel} (of {', '.join(self.kernels)}), threads: {self.threads}, "
            f"{self.samples_per_second / 1e6:.2f} M samples/s"
        )

    @property
    def verdict(self) -> str:
        """OK, or what failed."""
        failed = [f"{check.name} ({check.detail})" for check in self.checks if not check.is_ok]
        return f"FAILED: {'; '.join(failed)}" if failed else "OK"


def self_test(threads: int = 0) -> SelfTestResult:
    """Render what is known, and compare.

    The light of a rectangle on a diffuse floor, and light that is scattered again and again in a closed sphere, are
    compared with their closed forms, within five standard errors. A scene of a little of everything must give the same
    bytes with each instruction set that the machine has, and with one thread. `threads` 0 is one for each processor.
    What fails is told in the result. Raises SceneError for negative threads, and where the machine doesn't have what
    BASICRT_ISA names.
    """
    if threads < 0:
        raise native.SceneError(f"threads: must be at least 0, is {threads}")
    chosen, kernels = native.chosen_kernel(), tuple(native.kernels())
    everything = _Everything(threads)
    tests: list[tuple[str, Callable[[], str]]] = [
        ("light of an area lamp", partial(_test_area_lamp, threads)),
        ("light in a closed sphere", partial(_test_closed_sphere, threads)),
        ("a scene of a little of everything", everything.render),
    ]
    for name in kernels:
        if name != chosen:
            tests.append((f"the same with {name}", partial(everything.compare, name, threads)))
    tests.append(("the same with one thread", partial(everything.compare, chosen, 1)))
    try:
        checks = tuple(_run(name, test) for name, test in tests)
    finally:
        native.choose_kernel(chosen)
    return SelfTestResult(
        version=native.native_version(),
        kernel=chosen,
        kernels=kernels,
        threads=threads or native.processor_count(),
        samples_per_second=everything.samples_per_second,
        checks=checks,
    )


class _FailedError(Exception):
    """What a test found that should not be."""


def _run(name: str, test: Callable[[], str]) -> SelfTestCheck:
    try:
        return SelfTestCheck(name, True, test())
    except MemoryError:
        return SelfTestCheck(name, False, "out of memory")
    except (_FailedError, native.SceneError) as error:
        return SelfTestCheck(name, False, str(error))


def _compare_with(exact: float, picture: Picture) -> str:
    """Whether the mean of a picture of pixels that are alike but for noise is what it should be."""
    values = picture[..., :3].mean(axis=-1, dtype=np.float64)
    mean = float(values.mean())
    standard_error = float(values.std(ddof=1)) / math.sqrt(values.size)
    detail = f"{mean:.6g} +- {standard_error:.1g}, exact {exact:.6g}"
    # Written so that what is not a number fails.
    if not abs(mean - exact) <= _MOST_STANDARD_ERRORS * standard_error + _ROUNDING * exact:
        raise _FailedError(detail)
    return detail


def _add(
    scene: native.Scene,
    shape: native.Mesh | native.Sphere,
    *nodes: Any,
    at: npt.NDArray[np.float64] | None = None,
) -> None:
    """Place a shape with a material, of one node or of the sum of two."""
    material = native.Material()
    made = [material.add(node) for node in nodes]
    material.surface = made[0] if len(made) == 1 else material.add(native.AddShader(*made))
    scene.instances.append(
        native.Instance(
            shape=scene.shapes.append(shape),
            transform=np.eye(4) if at is None else at,
            materials=[scene.materials.append(material)],
        )
    )


def _square(half: float) -> native.Mesh:
    """In the plane z = 0, facing up."""
    corners = [[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]]
    return native.Mesh(
        np.array(corners, dtype=np.float32), np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
    )


def _translation(x: float, y: float, z: float) -> npt.NDArray[np.float64]:
    transform = np.eye(4)
    transform[:3, 3] = x, y, z
    return transform


def _test_area_lamp(threads: int) -> str:
    """A floor right below a corner of a rectangle that is parallel to it.

    The share of the floor's sky that the rectangle fills is that of Howell, "A Catalog of Radiation Heat Transfer
    Configuration Factors", B-3.
    """
    width, depth, height, radiance, reflectance = 1.5, 0.8, 1.2, 7.0, 0.6
    scene = native.Scene()
    _add(scene, _square(20), native.DiffuseShader(color=(reflectance,) * 3))
    lamp = _translation(width / 2, depth / 2, height) @ np.diag([width, depth, 1, 1])
    scene.lights.append(native.AreaLight(transform=lamp, radiance=(radiance,) * 3))
    patch = 1e-4
    scene.camera = native.OrthographicCamera(
        transform=_translation(0, 0, height / 2),
        window_min=(-patch, -patch),
        window_max=(patch, patch),
    )
    scene.settings.width = scene.settings.height = 32
    scene.settings.samples = 64
    a, b = width / height, depth / height
    factor = (
        a / math.hypot(1, a) * math.atan(b / math.hypot(1, a))
        + b / math.hypot(1, b) * math.atan(a / math.hypot(1, b))
    ) / (2 * math.pi)
    return _compare_with(
        reflectance * radiance * factor, render(scene, threads=threads)["Combined"]
    )


def _test_closed_sphere(threads: int) -> str:
    """Inside a diffuse sphere that shines: what it reflects of its own light adds up to a geometric series."""
    emitted, reflectance, bounces = 0.75, 0.5, 12
    scene = native.Scene()
    _add(
        scene,
        native.Sphere((0, 0, 0), 2.0),
        native.DiffuseShader(color=(reflectance,) * 3, twosided=True),
        native.EmissionShader(radiance=(emitted,) * 3, twosided=True),
    )
    scene.camera = native.look_at_camera(
        (0.7, 0.2, -0.3), (0, 1, 0), (0, 0, 1), math.radians(70), 1
    )
    settings = scene.settings
    settings.width = settings.height = 32
    settings.samples = 64
    settings.max_bounces = settings.diffuse_bounces = bounces
    exact = emitted * (1 - reflectance ** (bounces + 1)) / (1 - reflectance)
    return _compare_with(exact, render(scene, threads=threads)["Combined"])


def _hills(count: int) -> native.Mesh:
    """Waves over [-1, 1]^2 of 2 count^2 triangles."""
    axis = np.linspace(-1, 1, count + 1)
    x, y = np.meshgrid(axis, axis)
    positions = np.stack([x, y, 0.1 * np.sin(7 * x) * np.cos(9 * y)], axis=-1).reshape(-1, 3)
    first = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).reshape(-1, 1, 1)
    across = np.array([[0, 1, count + 2], [0, count + 2, count + 1]])
    triangles = (first + across).reshape(-1, 3)
    return native.Mesh(positions.astype(np.float32), triangles.astype(np.uint32))


class _Everything:
    """A picture that must not depend on what renders it."""

    def __init__(self, threads: int) -> None:
        self.samples_per_second = 0.0
        self._threads = threads
        self._picture: Picture | None = None
        self._scene = scene = native.Scene()
        _add(
            scene,
            _hills(64),
            native.DiffuseShader(color=(0.6, 0.55, 0.5)),
            at=np.diag([3, 3, 3, 1]),
        )
        _add(scene, native.Sphere((-0.9, 0, 0.9), 0.7), native.GlassShader(eta=1.5))
        _add(
            scene, native.Sphere((0.8, 0.4, 0.8), 0.6), native.DiffuseShader(color=(0.8, 0.3, 0.2))
        )
        turned = _translation(0.3, -1.2, 0.7) @ np.diag([0.4, 0.4, 0.4, 1])
        turned[:2, :2] = 0.4 * np.array([[0.8, -0.6], [0.6, 0.8]])
        _add(scene, _hills(16), native.GlossyShader(roughness=0.2), at=turned)
        scene.lights.append(native.PointLight((2, -2, 4), (30, 30, 30), radius=0.3))
        scene.environment.radiance = (0.2, 0.25, 0.3)
        scene.camera = native.look_at_camera(
            (0, -5, 2.5), (0, 0, 0.5), (0, 0, 1), math.radians(40), 1.5
        )
        scene.settings.width, scene.settings.height, scene.settings.samples = 96, 64, 16

    def render(self) -> str:
        """The picture that others are compared with."""
        last: list[native.Progress] = []
        picture = self._render(self._threads, last.append)
        if not np.isfinite(picture).all() or picture[..., :3].max() <= 0:
            raise _FailedError("the picture is black or has values that are no numbers")
        self._picture = picture
        self.samples_per_second = last[-1].samples_per_second
        return f"{last[-1].elapsed_seconds:.2f} s"

    def compare(self, kernel: str, threads: int) -> str:
        """Render it otherwise: no byte may differ."""
        if self._picture is None:
            raise _FailedError("there is no picture to compare with")
        native.choose_kernel(kernel)
        picture = self._render(threads)
        differing = int(
            (picture.view(np.uint32) != self._picture.view(np.uint32)).any(axis=-1).sum()
        )
        if differing:
            raise _FailedError(
                f"{differing} of {picture.shape[0] * picture.shape[1]} pixels differ"
            )
        return "no byte differs"

    def _render(
        self, threads: int, progress: Callable[[native.Progress], None] | None = None
    ) -> Picture:
        return render(self._scene, threads=threads, tile_size=16, progress=progress)["Combined"]
