# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs packages of the system through apt where we may, and names them where we may not."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Sequence

from project import Command, ToolError, output_of, run, say

# Names on Debian 12 and later and on Ubuntu 22.04 and later.
BUILD_PACKAGES = (
    "ccache",  # the core is compiled alike for each Python
    "libgtest-dev",
    "libimath-dev",
    "libopenexr-dev",
    "libstb-dev",
    "libtinyobjloader-dev",
    "nlohmann-json3-dev",
)
# What the `bpy` wheels link to and do not carry.
BLENDER_PACKAGES = (
    "libegl1",
    "libgl1",
    "libgl1-mesa-dri",
    "libgomp1",
    "libsm6",
    "libxfixes3",
    "libxi6",
    "libxkbcommon0",
    "libxrender1",
    "libxxf86vm1",
)


def is_debian() -> bool:
    """Whether this is Debian, Ubuntu or a system of their kind."""
    return bool(shutil.which("dpkg-query") and shutil.which("apt-get"))


def is_offered(package: str) -> bool:
    """Whether apt could install the package."""
    return output_of(["apt-cache", "show", package]) is not None


def missing_packages(names: Sequence[str]) -> list[str]:
    """The packages among `names` that are not installed."""
    result = subprocess.run(
        ["dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n", *names],
        capture_output=True,
        text=True,
        check=False,
    )
    lines = [line.split() for line in result.stdout.splitlines()]
    installed = {line[0] for line in lines if line[1:] == ["installed"]}
    return [name for name in names if name not in installed]


def apt_prefix() -> list[str] | None:
    """How to call apt-get with the right to install, or None when we have no such right."""
    if os.geteuid() == 0:
        return []
    if shutil.which("sudo") and output_of(["sudo", "-n", "true"]) is not None:
        return ["sudo", "-n"]
    return None


def install_packages(names: Sequence[str]) -> bool:
    """Install those that are missing, or stop and say which they are; whether any were installed."""
    if not is_debian():
        say(f"not Debian or Ubuntu: see that you have what these hold: {' '.join(names)}")
        return False
    missing = missing_packages(names)
    if not missing:
        return False
    prefix = apt_prefix()
    if prefix is None:
        raise ToolError(
            "Some system packages are missing, and installing them needs root. Run\n\n"
            f"    sudo apt-get install --no-install-recommends {' '.join(missing)}\n\n"
            "and then this command again."
        )
    say(f"installing system packages: {' '.join(missing)}")
    apt: Command = [*prefix, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-qq"]
    wait = ["-o", "DPkg::Lock::Timeout=300"]
    run([*apt, *wait, "update"], quiet=True)
    run([*apt, *wait, "install", "-y", "--no-install-recommends", *missing], quiet=True)
    return True
