# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendering a .blend file with Blender as a Python module and the add-on that this package carries."""

from __future__ import annotations

import importlib
import os
import signal
import sys
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

from .files import replacing

ENGINE = "BASICRT"


class BlenderError(Exception):
    """Blender could not make the picture; the message says why."""


def render_blend(
    blend: Path,
    output: Path,
    *,
    frame: int | None = None,
    samples: int | None = None,
    seed: int | None = None,
    threads: int = 0,
    samples_from: int | None = None,
    samples_to: int | None = None,
    use_denoising: bool = False,
    is_strict: bool = False,
) -> None:
    """Renders the file's scene as Blender would: an .exr scene-linear in 32 bits, a .png with its view transform.

    What is None (or `threads` 0, `use_denoising` False) stays as the file has it. The output appears whole or not at
    all; with `is_strict` not at all where anything would not be as in Blender. Raises BlenderError, and
    KeyboardInterrupt where that is why there is no picture.
    """
    if not blend.is_file():
        raise BlenderError(f"{blend}: no such file")
    bpy = _import_bpy()
    given = {
        "samples": samples,
        "seed": seed,
        "threads": threads or None,
        "samples_from": samples_from,
        "samples_to": samples_to,
        "fails_on_warnings": is_strict,
    }
    with _registered_add_on(given), _silent_stdout(), _interrupts_told_from_failures():
        _call(bpy.ops.wm.open_mainfile, filepath=str(blend.resolve()), load_ui=False)
        scene = bpy.context.scene
        scene.render.engine = ENGINE
        if frame is not None:
            scene.frame_set(frame)
        if use_denoising:
            scene.basicrt.use_denoising = True
        _set_file_format(bpy, scene.render.image_settings, output.suffix.lower())
        with replacing(output.resolve()) as temporary:
            scene.render.use_file_extension = False
            scene.render.filepath = str(temporary)
            _call(bpy.ops.render.render, write_still=True)
            if not temporary.is_file():
                raise BlenderError(f"{blend}: Blender wrote no picture")


def _import_bpy() -> Any:
    try:
        with _deferred_interrupts():
            bpy = importlib.import_module("bpy")
    except ImportError as error:
        raise BlenderError(
            f"a .blend needs Blender as a Python module: pip install basicrt[blender] ({error})"
        ) from error
    if not hasattr(bpy, "app"):
        raise BlenderError("the installed bpy has types only: pip install bpy")
    return bpy


def _interrupts_raise() -> bool:
    """Whether Ctrl-C is a KeyboardInterrupt in this thread: not ignored, and not handled by who called us."""
    is_main = threading.current_thread() is threading.main_thread()
    return is_main and signal.getsignal(signal.SIGINT) is signal.default_int_handler


@contextmanager
def _deferred_interrupts() -> Iterator[None]:
    """Ctrl-C waits: in the middle of its import it would crash Blender."""
    if not _interrupts_raise():
        yield
        return
    interrupts: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: interrupts.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if interrupts:
        raise KeyboardInterrupt


@contextmanager
def _interrupts_told_from_failures() -> Iterator[None]:
    """Ctrl-C in one of Blender's callbacks ends as a render that failed; here it is a KeyboardInterrupt again."""
    if not _interrupts_raise():
        yield
        return
    interrupts: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        interrupts.append(number)
        signal.default_int_handler(number, frame)

    signal.signal(signal.SIGINT, note)
    try:
        yield
    except BlenderError as error:
        if interrupts:
            raise KeyboardInterrupt from error
        raise
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def _registered_add_on(given: Mapping[str, int | bool | None]) -> Iterator[None]:
    """The engine in Blender, with the settings that are given.

    Blender 4.2 crashes and 4.5 hangs at exit where it is still registered then.
    """
    try:
        add_on = importlib.import_module("basicrt.blender_addon")
    except ModuleNotFoundError as error:
        raise BlenderError(f"this installation carries no Blender add-on ({error})") from error
    engine = importlib.import_module("basicrt.blender_addon.engine")
    add_on.register()
    engine.BasicRTRenderEngine.given_overrides = engine.Overrides(**given)
    try:
        yield
    finally:
        engine.BasicRTRenderEngine.given_overrides = None
        add_on.unregister()


@contextmanager
def _silent_stdout() -> Iterator[None]:
    """Blender writes what it does to standard output, from C; errors and the log of the add-on go elsewhere."""
    sys.stdout.flush()
    saved = os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)
    try:
        yield
    finally:
        os.dup2(saved, 1)
        os.close(saved)


def _set_file_format(bpy: Any, image_settings: Any, suffix: str) -> None:
    if bpy.app.version >= (5, 0):
        image_settings.media_type = "IMAGE"
    is_exr = suffix == ".exr"
    image_settings.file_format = "OPEN_EXR" if is_exr else "PNG"
    image_settings.color_mode = "RGBA"
    image_settings.color_depth = "32" if is_exr else "8"


def _call(operator: Any, **arguments: Any) -> None:
    """Run an operator; what it reports as an error is a BlenderError."""
    try:
        result = operator(**arguments)
    except RuntimeError as error:
        raise BlenderError(str(error).strip().removeprefix("Error: ")) from error
    if "FINISHED" not in result:
        raise BlenderError("Blender cancelled the render")
