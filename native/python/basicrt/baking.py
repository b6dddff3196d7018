# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking: pictures of what leaves a mesh, to be laid onto it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ._native import BakeSettings, BakeTarget, Progress, Scene, SceneError, Session
from .rendering import PictureBuffer

Picture = npt.NDArray[np.float32]

# Of the kinds that are one pass alone.
_PASSES = {
    "ao": "Ambient Occlusion",
    "emit": "Emission",
    "environment": "Environment",
    "normal": "Normal",
    "position": "Position",
    "roughness": "Roughness",
    "shadow": "Shadow Catcher",
    "uv": "UV",
}
# Ways of scattering, as passes call them.
_SCATTERING = {"diffuse": "Diffuse", "glossy": "Glossy", "transmission": "Transmission"}

BAKE_KINDS = ("combined", *_SCATTERING, *_PASSES)


@dataclass(frozen=True)
class BakePlan:
    """What has to be rendered for a bake, and what is made of it.

    kind: one of BAKE_KINDS, as Blender calls them. direct, indirect: light that comes from its source at once, and by
    way of other surfaces; for combined, diffuse, glossy and transmission. color: those three times the mesh's own
    colour, which alone is left where there is neither. diffuse, glossy, transmission, emission: what counts of the mesh
    itself for combined. from_camera: it is seen from the scene's camera; otherwise along its normals.
    """

    kind: str = "combined"
    direct: bool = True
    indirect: bool = True
    color: bool = True
    diffuse: bool = True
    glossy: bool = True
    transmission: bool = True
    emission: bool = True
    from_camera: bool = False

    def __post_init__(self) -> None:
        """Raises SceneError for what there is no picture of."""
        if self.kind not in BAKE_KINDS:
            known = ", ".join(BAKE_KINDS)
            raise SceneError(f'bake.kind: must be one of {known}, is "{self.kind}"')
        if self.kind in _SCATTERING and not (self.direct or self.indirect or self.color):
            raise SceneError(f"bake.kind: {self.kind} needs direct, indirect or color")

    @property
    def settings(self) -> BakeSettings:
        """What is asked of the core."""
        is_combined = self.kind == "combined"
        ways = {
            name: getattr(self, name) if is_combined else self.kind == name for name in _SCATTERING
        }
        if self.kind in _PASSES:
            ways = dict.fromkeys(_SCATTERING, True)
        return BakeSettings(
            **ways,
            emission=self.emission or not is_combined,
            indirect_light=self._has_indirect_light,
            environment=self.kind == "environment",
            from_camera=self.from_camera,
            passes=sorted(self._passes),
        )

    @property
    def _has_indirect_light(self) -> bool:
        if self.kind == "shadow":
            return True
        return self.indirect and self.kind not in _PASSES

    @property
    def _is_whole(self) -> bool:
        """Whether the picture is all that is seen, as it is: the mesh without indirect light too."""
        return self.kind == "combined" and self.direct

    @property
    def _passes(self) -> set[str]:
        passes = {"Combined"}  # for its alpha
        if self.kind in _PASSES:
            return passes | {_PASSES[self.kind]}
        if self._is_whole:
            return passes
        if self.kind == "combined":
            passes.add("Emission")
        for heading, light in self._lights:
            passes |= {f"{heading} {part}" for part in (*light, "Color")}
        return passes

    @property
    def _lights(self) -> Iterator[tuple[str, list[str]]]:
        """For each way of scattering its heading, and which light of it is wanted."""
        light = [name for name in ("Direct", "Indirect") if getattr(self, name.lower())]
        for name, heading in _SCATTERING.items():
            if self.kind == name or (self.kind == "combined" and getattr(self, name)):
                yield heading, light

    def picture(self, passes: Mapping[str, Picture]) -> Picture:
        """(height, width, 4) float32, of passes by name; alpha is 0 where nothing was baked.

        One number is there thrice.
        """
        combined = passes["Combined"]
        if self._is_whole:
            return combined
        picture = combined.copy()
        picture[..., :3] = self._color(passes)
        return picture

    def _color(self, passes: Mapping[str, Picture]) -> Picture:
        if self.kind in _PASSES:
            return passes[_PASSES[self.kind]]
        total = np.zeros_like(passes["Combined"][..., :3])
        if self.kind == "combined":
            total += passes["Emission"]
        for heading, light in self._lights:
            color = passes[f"{heading} Color"]
            if not light:
                total += color if self.kind != "combined" else 0
                continue
            sum_of_light = np.sum([passes[f"{heading} {name}"] for name in light], axis=0)
            has_color = self.color or self.kind == "combined"
            total += sum_of_light * color if has_color else sum_of_light
        return total


@contextmanager
def _catching_shadows(scene: Scene, target: BakeTarget, is_wanted: bool) -> Iterator[None]:
    """The mesh is a shadow catcher meanwhile."""
    if not is_wanted or target.instance >= len(scene.instances):
        yield
        return
    before = scene.instances[target.instance]
    changed = scene.instances[target.instance]
    changed.shadow_catcher = True
    scene.instances[target.instance] = changed
    try:
        yield
    finally:
        scene.instances[target.instance] = before


def bake_session(
    scene: Scene,
    target: BakeTarget,
    plan: BakePlan,
    *,
    threads: int = 0,
    tile_size: int = 64,
    preparing: Callable[[float], None] | None = None,
) -> Session:
    """A session that renders what a plan needs; its tiles' passes make plan.picture().

    As any session it can be stopped at any time. Raises SceneError.
    """
    with _catching_shadows(scene, target, plan.kind == "shadow"):
        return Session(
            scene,
            threads=threads,
            tile_size=tile_size,
            preparing=preparing,
            bake_target=target,
            bake_settings=plan.settings,
        )


def bake(
    scene: Scene,
    target: BakeTarget,
    plan: BakePlan | str = "combined",
    *,
    threads: int = 0,
    tile_size: int = 64,
    progress: Callable[[Progress], None] | None = None,
) -> Picture:
    """What leaves a mesh at the places of a target: (height, width, 4) float32, row 0 at the bottom.

    `plan` may be one of BAKE_KINDS. How many samples there are, bounces and all that say the scene's settings, but for
    size, border and passes; a camera is not needed. Normals and places are in world space. `threads` 0 is one for each
    processor; the values depend on neither `threads` nor `tile_size`. `progress` is called after each tile, and ten
    times a second between tiles. Raises SceneError, MemoryError, and what `progress` raises, which ends the baking.
    """
    made = BakePlan(plan) if isinstance(plan, str) else plan
    buffer = PictureBuffer(made.settings.passes, target.width, target.height)
    with bake_session(scene, target, made, threads=threads, tile_size=tile_size) as session:
        for tile in session.tiles():
            if tile is not None:
                buffer.add(tile)
            if progress is not None:
                progress(session.progress)
    return made.picture(buffer.pictures)
