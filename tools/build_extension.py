# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the installable Blender extension: a copy of addon/ with the wheels in it, zipped into dist/.

One zip serves every Blender whose Python has a wheel in it. The wheels are those for the Pythons of
this machine; `--headers ROOT` adds one for another system's Python (see build_wheel.py). Where Blender's
own validator is installed, the zip is checked with it.
"""

from __future__ import annotations

import argparse
import platform
import re
import shutil
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path

import bootstrap
import pythons
from build_wheel import build_foreign_wheel, build_wheel
from project import DIST, ROOT, ToolError, relative, run, say, version

PLATFORMS = {
    ("Linux", "x86_64"): "linux-x64",
    ("Linux", "aarch64"): "linux-arm64",
    ("Darwin", "arm64"): "macos-arm64",
    ("Darwin", "x86_64"): "macos-x64",
    ("Windows", "AMD64"): "windows-x64",
}


def platform_name() -> str:
    """This machine in Blender's words, as in the manifest's `platforms`."""
    key = (platform.system(), platform.machine())
    if key not in PLATFORMS:
        raise ToolError(f"Blender has no extension platform for {key}")
    return PLATFORMS[key]


def with_wheels(manifest: str, wheels: Sequence[str], blender_platform: str) -> str:
    """The manifest with `version`, `platforms` and `wheels` set.

    They are top-level keys, so they go before the first table.
    """
    for key in ("wheels", "platforms"):
        manifest = re.sub(rf"(?ms)^{key}\s*=\s*\[.*?\]\n?", "", manifest)
    manifest = re.sub(r'(?m)^version\s*=\s*".*"$', f'version = "{version()}"', manifest)
    lines = "".join(f'  "./wheels/{name}",\n' for name in wheels)
    added = f'platforms = ["{blender_platform}"]\nwheels = [\n{lines}]\n'
    table = re.search(r"(?m)^\[", manifest)
    at = table.start() if table else len(manifest)
    return f"{manifest[:at].rstrip()}\n\n{added}\n{manifest[at:]}".rstrip() + "\n"


def zip_folder(folder: Path, target: Path) -> None:
    """Zip the contents of a folder, reproducibly."""
    partial = target.with_suffix(".part")
    with zipfile.ZipFile(partial, "w") as archive:
        for path in sorted(p for p in folder.rglob("*") if p.is_file()):
            entry = zipfile.ZipInfo(
                path.relative_to(folder).as_posix(), date_time=(2026, 1, 1, 0, 0, 0)
            )
            entry.external_attr = 0o644 << 16
            stored = path.suffix == ".whl"  # compressed already
            entry.compress_type = zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED
            archive.writestr(entry, path.read_bytes())
    partial.replace(target)


def find_validators() -> list[tuple[Path, Path]]:
    """(Python, Blender's blender_ext.py) of each Blender module that is installed here."""
    pattern = "lib/python3.*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
    return [
        (bootstrap.python_of(f"bpy-{blender}"), script)
        for blender in bootstrap.BLENDERS
        for script in (ROOT / ".venv" / f"bpy-{blender}").glob(pattern)
    ]


def build_extension(wheels: Sequence[Path]) -> Path:
    """Zip addon/ with these wheels and let every Blender here validate it."""
    staging = ROOT / "build" / "extension"
    shutil.rmtree(staging, ignore_errors=True)
    shutil.copytree(ROOT / "addon", staging, ignore=shutil.ignore_patterns("__pycache__", "*.pyc"))
    (staging / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy2(wheel, staging / "wheels")
    manifest = staging / "blender_manifest.toml"
    text = manifest.read_text(encoding="utf-8")
    names = [wheel.name for wheel in wheels]
    manifest.write_text(with_wheels(text, names, platform_name()), encoding="utf-8")
    shutil.copy2(ROOT / "LICENSE", staging)

    target = DIST / f"basicrt-{version()}-{platform_name()}.zip"
    DIST.mkdir(exist_ok=True)
    zip_folder(staging, target)
    validators = find_validators()
    for python, script in validators:
        run([python, script, "validate", target], quiet=True)
    if not validators:
        say("not validated: no Blender Python module is installed (make setup installs them)")
    return target


def build_repository(extension: Path) -> Path | None:
    """A folder that any web server can offer as a repository of extensions; None without Blender's own tool."""
    validators = find_validators()
    if not validators:
        return None
    folder = DIST / "repository"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy2(extension, folder)
    python, script = validators[-1]
    run([python, script, "server-generate", "--repo-dir", folder, "--html"], quiet=True)
    return folder


def main() -> int:
    """Build the wheels, the zip and the repository."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--headers", action="append", type=Path, default=[], metavar="ROOT")
    arguments = parser.parse_args()
    try:
        wheels = [build_wheel(wanted) for wanted in pythons.available_pythons()]
        wheels += [build_foreign_wheel(root.resolve()) for root in arguments.headers]
        extension = build_extension(wheels)
        say(f"made {relative(extension)}")
        if repository := build_repository(extension):
            say(f"made {relative(repository)}")
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
