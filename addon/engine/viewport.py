# SPDX-License-Identifier: GPL-3.0-or-later
"""A rendered 3D viewport: what Blender's two callbacks, of changes and of drawing, do for one."""

from __future__ import annotations

import logging
import weakref
from typing import Any

import bpy

import basicrt

from ..export import denoising, studio_light, view
from ..preferences import use_isa
from ..properties import settings_of
from ..report import ExportError, Report, message_of, show_warnings
from ..sync.scene_sync import SceneSync
from ..sync.shown import Filter
from . import command_line
from .denoise import warn_noisy
from .machine import check_memory, thread_count
from .starting import tell_memory
from .view_denoiser import ViewDenoiser
from .view_texture import ViewTexture

# How often a picture that is being refined is looked for.
POLL_SECONDS = 0.02
# What is seen only so long, while a view turns, is not denoised.
STILL_SECONDS = 0.1


class Viewport:
    """Keeps a native scene like Blender's, and shows what the session makes of it.

    The session works on threads of its own; nothing here waits for it. While it prepares a scene that
    can't be changed: what changes in Blender meanwhile is remembered, and read afterwards.
    """

    def __init__(self, engine: bpy.types.RenderEngine) -> None:
        self._engine = weakref.ref(engine)
        self._session: basicrt.ViewSession | None = None
        self._threads = 0
        self._report = Report()
        self._sync = SceneSync(self._report)
        self._studio_light = studio_light.StudioLight()
        self._texture = ViewTexture()
        self._denoiser = ViewDenoiser()
        self._shown: Any = None  # what the session was told to show
        self._visible: Any = None  # what the viewport showed of the scene when it was read
        self._is_out_of_date = False  # something changed that was not read yet
        self._is_polling = False
        self._message = ""
        self._is_measured = False  # the memory of what the session prepared last was looked at
        self._failure = ""  # why there is no picture of what is to be seen now

    def close(self) -> None:
        """Stop working."""
        self._denoiser.forget()
        if self._session is not None:
            self._session.close()
            self._session = None

    def update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Something in the scene has changed, or this is the first time."""
        self._sync.note(depsgraph)
        self._is_out_of_date = True
        self._read_changes(context, depsgraph)

    def draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Show the newest picture, and look where Blender looks now."""
        if _visible(_region(context)) != self._visible:
            self._sync.rescan()
            self._is_out_of_date = True
        if self._is_out_of_date:
            self._read_changes(context, depsgraph)
        self._look(context, depsgraph)
        if self._session is not None:
            self._take_pictures(self._session, depsgraph)
        region: Any = context.region
        b_scene: Any = depsgraph.scene
        self._texture.draw(self._engine(), b_scene, region.width, region.height)
        self._show_status()
        self._poll_later()

    def _take_pictures(self, session: basicrt.ViewSession, depsgraph: bpy.types.Depsgraph) -> None:
        """The newest one; a noisy one only until there is a denoised one of the same view."""
        picture = session.take_picture()
        if picture is not None:
            self._denoiser.add(picture)
            if self._denoiser.samples_shown(picture.revision) == 0:
                self._texture.set(picture)
        denoised = self._denoiser.take(session.revision)
        if denoised is not None:
            self._texture.set(denoised)
        error = self._denoiser.take_error()
        if error is not None:
            b_scene: Any = depsgraph.scene
            warn_noisy(b_scene, error, self._report)
            show_warnings(self._report)

    def _read_changes(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """From Blender's data to the session's scene, unless that is busy with it."""
        if self._session is None:
            use_isa()
            b_scene: Any = depsgraph.scene
            self._threads = thread_count(b_scene, command_line.overrides())
            self._session = basicrt.ViewSession(self._threads)
            self._shown = None
        if self._session.status.is_preparing:
            self._poll_later()
            return
        self._is_out_of_date, self._failure = False, ""
        region = _region(context)
        self._visible = _visible(region)
        camera = view.convert_camera(region, depsgraph, self._report)
        shading = region.b_space.shading
        is_lit = not shading.use_scene_world_render
        environment = self._studio_light.environment(shading) if is_lit else None
        self._sync.update(depsgraph, camera, _filter(region), environment)
        show_warnings(self._report)
        self._is_measured = False
        if self._is_within_memory(self._sync.exported.scene.memory(), is_built=False):
            self._session.set_scene(self._sync.exported.scene)

    def _is_within_memory(self, memory: basicrt.SceneMemory, *, is_built: bool) -> bool:
        """Whether the scene may be rendered; else nothing is kept of what shows it."""
        try:
            check_memory(memory, command_line.overrides(), is_built=is_built)
        except ExportError as error:
            self._failure = message_of(error)
            self.close()
            return False
        return True

    def _look(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Tell the session of another camera, size, border, pass or setting."""
        if self._session is None:
            return
        region = _region(context)
        camera = view.convert_camera(region, depsgraph, self._report)
        settings = view.convert_settings(region, depsgraph, self._report)
        pass_name = view.shown_pass(region)
        b_scene: Any = depsgraph.scene
        options = denoising.convert_view(b_scene, pass_name)
        shown = (repr(camera), repr(settings), pass_name, options)
        if shown != self._shown:
            self._shown, self._failure = shown, ""
            self._denoiser.set_options(options)
            further = list(options.how.passes) if options is not None else []
            self._session.set_view(camera, settings, pass_name, further)
        self._session.set_paused(settings_of(b_scene).preview_pause)

    def _show_status(self) -> None:
        """The text in the corner of the viewport."""
        engine, session = self._engine(), self._session
        if engine is None:
            return
        if session is None:
            engine.update_stats("", self._failure)
            return
        for warning in session.take_warnings():
            self._report.add(self._sync.exported.in_users_words(warning))
            show_warnings(self._report)
        denoised = self._denoiser.samples_shown(session.revision)
        try:
            status = session.status
        except basicrt.SceneError as error:
            self._tell(error)
        else:
            self._measure(session, status)
            if status.is_preparing:
                self._message = f"Building trees | {status.prepared_fraction:.0%}"
            elif status.samples > 0 or not status.is_done:
                self._message = f"Sample {status.samples}/{status.samples_end}"
        note = f" | Denoised at {denoised}" if denoised > 0 else ""
        engine.update_stats("", self._failure or f"{self._message}{note}")

    def _measure(self, session: basicrt.ViewSession, status: basicrt.ViewStatus) -> None:
        """Once for each time that something was prepared: how much memory it takes."""
        memory = session.memory
        if self._is_measured or status.is_preparing or memory is None:
            return
        self._is_measured = True
        tell_memory(memory, logging.DEBUG)
        self._is_within_memory(memory, is_built=True)

    def _poll_later(self) -> None:
        """Have a look for pictures in a moment: Blender asks only when something happens to it."""
        if not self._is_polling:
            self._is_polling = True
            bpy.app.timers.register(self._poll, first_interval=POLL_SECONDS)

    def _poll(self) -> float | None:
        """Blender's timer: has the viewport drawn where there is something new."""
        self._is_polling = self._has_more()
        return POLL_SECONDS if self._is_polling else None

    def _has_more(self) -> bool:
        """Whether there is still something to wait for."""
        engine, session = self._engine(), self._session
        if engine is None or session is None:
            return False
        try:
            status = session.status
            is_turning = status.elapsed_seconds < STILL_SECONDS
            if not is_turning:
                # At rest, with nothing to take: what was taken last is the last.
                is_at_rest = status.is_done and not session.has_picture
                self._denoiser.work(session.revision, self._threads, is_at_rest=is_at_rest)
            is_news = session.has_picture or self._denoiser.is_ready
            if is_news or (self._is_out_of_date and not status.is_preparing):
                engine.tag_redraw()
        except ReferenceError:  # Blender has done away with the engine
            self.close()
            return False
        except basicrt.SceneError as error:
            self._tell(error)
            engine.tag_redraw()
            return False
        is_awaited = session.has_picture or self._denoiser.is_busy or is_turning
        return not status.is_done or is_awaited or self._is_out_of_date

    def _tell(self, error: basicrt.SceneError) -> None:
        """Why there is no picture, in the corner of the viewport from the next drawing on."""
        self._failure = message_of(ExportError(self._sync.exported.in_users_words(str(error))))


def _region(context: Any) -> view.Region:
    return view.Region(context.region, context.space_data, context.region_data)


def _filter(region: view.Region) -> Filter:
    """What of the scene the viewport shows."""
    return Filter(region.b_space, has_lights=region.b_space.shading.use_scene_lights_render)


def _visible(region: view.Region) -> Any:
    """All that decides on what the viewport hides."""
    b_space = region.b_space
    shading = b_space.shading
    kinds = [name for name in dir(b_space) if name.startswith("show_object_viewport_")]
    return (
        b_space.local_view is not None,
        b_space.use_local_collections,
        shading.use_scene_lights_render,
        studio_light.key(shading),
        [getattr(b_space, name) for name in kinds],
    )
