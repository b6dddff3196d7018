# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: basicrt render, merge, compare, info and self-test.

Exit status: 0 done; 1 failed, or pictures differ by more than the threshold; 2 wrong usage; 130 interrupted.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import platform
import sys
import time
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

import basicrt

from .compare import compare
from .denoising import DENOISING_PASSES, denoised
from .files import check_writable
from .images import Picture, read_combined
from .merging import RANGE_KEY, merge
from .rendering import render_with_sums


class CommandError(Exception):
    """What the user should read instead of a traceback."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return its exit status."""
    options = _make_parser().parse_args(arguments)
    _show_scene_warnings()
    try:
        status: int = options.command(options)
    except (
        CommandError,
        basicrt.SceneError,
        basicrt.SceneWarning,  # of --strict
        basicrt.DenoiserError,
        OSError,
    ) as error:
        print(f"basicrt: {error}", file=sys.stderr)
        return 1
    except MemoryError:
        print("basicrt: out of memory", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("basicrt: interrupted", file=sys.stderr)
        return 130
    return status


def _make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="basicrt", description="BasicRT, a ray tracer.")
    parser.add_argument("--version", action="version", version=basicrt.__version__)
    commands = parser.add_subparsers(required=True, metavar="command")

    render = commands.add_parser("render", help="make a picture of a scene file or a .blend file")
    render.set_defaults(command=_render)
    render.add_argument("scene", type=Path, help="scene.json or scene.blend")
    render.add_argument(
        "-o",
        "--output",
        type=Path,
        help="an .exr or .png file (default: <scene>.exr in this folder)",
    )
    render.add_argument("-f", "--frame", type=int, help="the frame of a .blend (default: its own)")
    render.add_argument("--spp", type=int, help="samples per pixel, instead of the scene's")
    for name, what in (("from", "leave out the samples before"), ("to", "and from")):
        render.add_argument(
            f"--samples-{name}",
            type=int,
            help=f"{what} this one, a multiple of 64; of a scene.json for `basicrt merge`",
        )
    render.add_argument("--seed", type=int, help="another seed, other noise")
    render.add_argument("--threads", type=int, default=0, help="default: one per processor")
    render.add_argument(
        "--denoise",
        action="store_true",
        help="with Open Image Denoise; an .exr keeps the noisy picture as Noisy Image",
    )
    render.add_argument(
        "--strict",
        action="store_true",
        help="make no picture where something would not be as the scene says",
    )
    render.add_argument("--override", help="JSON merged into a scene.json (RFC 7386)")
    render.add_argument("-q", "--quiet", action="store_true", help="show no progress")

    merging = commands.add_parser(
        "merge", help="make one picture of files with different samples of it"
    )
    merging.set_defaults(command=_merge)
    merging.add_argument("pictures", type=Path, nargs="+", help="by `render --samples-from …`")
    merging.add_argument("-o", "--output", type=Path, required=True, help="an .exr file")

    comparison = commands.add_parser("compare", help="say how much two OpenEXR pictures differ")
    comparison.set_defaults(command=_compare)
    comparison.add_argument("picture", type=Path)
    comparison.add_argument("reference", type=Path)
    comparison.add_argument(
        "--metric",
        choices=["mse", "relmse", "flip"],
        default="mse",
        help="which one the threshold is for (default: %(default)s)",
    )
    comparison.add_argument(
        "--threshold", type=float, help="exit with 1 where the metric is over this"
    )

    test = commands.add_parser(
        "self-test", help="render what is known, and say whether all is as it should be"
    )
    test.set_defaults(command=_self_test)
    test.add_argument("--threads", type=int, default=0, help="default: one per processor")

    info = commands.add_parser("info", help="describe this installation, or a scene file")
    info.set_defaults(command=_info)
    info.add_argument("scene", type=Path, nargs="?", help="scene.json")
    return parser


def _show_scene_warnings() -> None:
    def show(message: Warning | str, *_: object, **__: object) -> None:
        print(f"basicrt: warning: {message}", file=sys.stderr)

    warnings.simplefilter("always", basicrt.SceneWarning)
    warnings.showwarning = show


def _render(options: argparse.Namespace) -> int:
    output: Path = options.output or Path(f"{options.scene.stem}.exr")
    if output.suffix.lower() not in (".exr", ".png"):
        raise CommandError(f"{output}: the name must end in .exr or .png")
    if options.spp is not None and options.spp < 1:
        raise CommandError(f"--spp: must be at least 1, is {options.spp}")
    _check_threads(options)
    if options.denoise:
        basicrt.check_denoiser()
    check_writable(output)
    begin = time.perf_counter()
    if options.scene.suffix.lower() == ".blend":
        _render_blend(options, output)
    else:
        _render_json(options, output)
    if not options.quiet:
        print(f"{output}: rendered in {time.perf_counter() - begin:.1f} s", file=sys.stderr)
    return 0


def _render_json(options: argparse.Namespace, output: Path) -> None:
    if options.frame is not None:
        raise CommandError("-f: only a .blend has frames")
    if options.strict:
        warnings.simplefilter("error", basicrt.SceneWarning)
    scene = basicrt.load_scene(options.scene, override=options.override)
    if options.spp is not None:
        scene.settings.samples = options.spp
    if options.seed is not None:
        scene.settings.seed = options.seed
    if options.samples_from is not None:
        scene.settings.samples_from = options.samples_from
    if options.samples_to is not None:
        scene.settings.samples_to = options.samples_to
    is_range = scene.settings.samples_from > 0 or scene.settings.samples_to > 0
    if is_range and output.suffix.lower() != ".exr":
        raise CommandError(f"{output}: a range of the samples needs an .exr file")
    if is_range and options.denoise:
        raise CommandError("--denoise: not of a range of the samples, but of all of them")
    asked = list(scene.settings.passes)
    if options.denoise:
        scene.settings.passes = list(dict.fromkeys(("Combined", *asked, *DENOISING_PASSES)))
    line = None if options.quiet else _ProgressLine()
    try:
        pictures, sums = render_with_sums(scene, threads=options.threads, progress=line)
    finally:
        if line:
            line.end()
    if options.denoise:
        pictures = _denoised(scene.settings, asked, pictures, options.threads)
    if output.suffix.lower() == ".png":
        if "Combined" not in pictures:
            raise CommandError(f"{output}: a PNG needs the pass Combined")
        basicrt.write_png(output, pictures["Combined"])
    else:
        metadata = {
            "software": f"BasicRT {basicrt.__version__}",
            "samples": str(scene.settings.samples),
            "seed": str(scene.settings.seed),
            **scene.matte_metadata(),
        }
        if is_range:
            metadata[RANGE_KEY] = scene.range_metadata()
        basicrt.write_exr(output, pictures, metadata, sums)


def _denoised(
    settings: basicrt.RenderSettings,
    asked: Sequence[str],
    pictures: Mapping[str, Picture],
    threads: int,
) -> dict[str, Picture]:
    """The passes that were asked for, and the noisy picture beside the one without noise."""
    border = settings.border_x, settings.border_width, settings.border_y, settings.border_height
    left, width, lower, height = border
    return {
        **{name: picture for name, picture in pictures.items() if name in asked},
        **denoised(
            pictures,
            rows=slice(lower, lower + height if height else None),
            columns=slice(left, left + width if width else None),
            threads=threads,
        ),
    }


def _render_blend(options: argparse.Namespace, output: Path) -> None:
    from .blender import BlenderError, render_blend

    if options.override is not None:
        raise CommandError("--override: only for scene.json")
    try:
        render_blend(
            options.scene,
            output,
            frame=options.frame,
            samples=options.spp,
            seed=options.seed,
            threads=options.threads,
            samples_from=options.samples_from,
            samples_to=options.samples_to,
            use_denoising=options.denoise,
            is_strict=options.strict,
        )
    except BlenderError as error:
        raise CommandError(str(error)) from error


class _ProgressLine:
    """One line on standard error that is written over, only where that is a terminal."""

    def __init__(self) -> None:
        self._is_terminal = sys.stderr.isatty()
        self._next_time = 0.0

    def __call__(self, progress: basicrt.Progress) -> None:
        if not self._is_terminal or time.monotonic() < self._next_time:
            return
        self._next_time = time.monotonic() + 0.1
        text = (
            f"{100 * progress.fraction:5.1f} %  {progress.samples_per_second / 1e6:.2f} M samples/s  "
            f"{progress.remaining_seconds:.0f} s left"
        )
        print(f"\r{text}\x1b[K", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        """Clear the line."""
        if self._is_terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def _merge(options: argparse.Namespace) -> int:
    output: Path = options.output
    if output.suffix.lower() != ".exr":
        raise CommandError(f"{output}: the name must end in .exr")
    check_writable(output)
    merge(options.pictures, output)
    return 0


def _compare(options: argparse.Namespace) -> int:
    difference = compare(read_combined(options.picture), read_combined(options.reference))
    flip = "needs flip-evaluator" if difference.flip is None else f"{difference.flip:.6g}"
    print(f"MSE    {difference.mse:.6g}")
    print(f"relMSE {difference.relmse:.6g}")
    print(f"FLIP   {flip}")
    if options.threshold is None:
        return 0
    value: float | None = getattr(difference, options.metric)
    if value is None:
        raise CommandError("--metric flip: pip install basicrt[flip]")
    if value <= options.threshold:
        return 0
    print(
        f"{options.metric} {value:.6g} is over the threshold {options.threshold:g}", file=sys.stderr
    )
    return 1  # also for NaN


def _self_test(options: argparse.Namespace) -> int:
    _check_threads(options)
    result = basicrt.self_test(options.threads)
    print(result.machine)
    for check in result.checks:
        print(f"{'ok    ' if check.is_ok else 'FAILED'} {check.name}: {check.detail}")
    print("OK" if result.is_ok else "FAILED")
    return 0 if result.is_ok else 1


def _check_threads(options: argparse.Namespace) -> None:
    if options.threads < 0:
        raise CommandError(f"--threads: must be at least 0, is {options.threads}")


def _info(options: argparse.Namespace) -> int:
    if options.scene is not None:
        _describe_scene(basicrt.load_scene(options.scene))
        return 0
    print(f"basicrt {basicrt.__version__} (native module {basicrt.native_version()})")
    print(
        f"Python {platform.python_version()}, numpy {np.__version__}, {os.cpu_count()} processors"
    )
    print(f"instructions: {basicrt.chosen_kernel()} (of {', '.join(basicrt.kernels())})")
    print("passes: " + ", ".join(f"{info.name} ({info.channels})" for info in basicrt.passes()))
    for module, purpose in (
        ("OpenEXR", "reads and writes .exr"),
        ("PIL", "writes .png"),
        ("flip_evaluator", "FLIP in basicrt compare"),
        ("pyoidn", "denoises"),
        ("bpy", "renders .blend"),
    ):
        found = "found" if importlib.util.find_spec(module) else "not installed"
        print(f"{module}: {found} ({purpose})")
    return 0


def _describe_scene(scene: basicrt.Scene) -> None:
    settings = scene.settings
    triangles = sum(
        len(shape.triangles) for shape in scene.shapes if isinstance(shape, basicrt.Mesh)
    )
    camera = type(scene.camera).__name__ if scene.camera else "none"
    print(f"picture    {settings.width} x {settings.height}, {settings.samples} samples per pixel")
    print(f"integrator {settings.integrator}")
    print(f"passes     {', '.join(settings.passes)}")
    print(f"camera     {camera}")
    print(f"shapes     {len(scene.shapes)} ({triangles} triangles)")
    print(f"instances  {len(scene.instances)}")
    print(f"materials  {len(scene.materials)}")
    print(f"textures   {len(scene.textures)}")
    print(f"lights     {len(scene.lights)}")
