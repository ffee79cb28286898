#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Write the recipes of a release: fill.py URL ARCHIVE FOLDER (packaging/README.md)."""
import hashlib
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
RECIPES = ("conan/conanfile.py", "vcpkg/vcpkg.json", "vcpkg/portfile.cmake", "homebrew/se3d.rb", "conda/meta.yaml")


def read_version():
    text = (HERE.parent / "include/se3d/base.h").read_text()
    parts = [re.search(rf"#define SE3D_VERSION_{part} (\d+)", text) for part in ("MAJOR", "MINOR", "PATCH")]
    return ".".join(part.group(1) for part in parts)


def main(words):
    if len(words) != 4:
        sys.exit("use: fill.py URL ARCHIVE FOLDER")
    url, archive, folder = words[1], pathlib.Path(words[2]), pathlib.Path(words[3])
    if not re.fullmatch(r"(https|file)://[\w./~%+@:-]+", url):
        sys.exit(f"fill.py: the address is {url!r}, must be https://... without spaces or quotes")
    try:
        data = archive.read_bytes()
    except OSError as error:
        sys.exit(f"fill.py: {archive}: {error.strerror}")
    values = {"VERSION": read_version(), "URL": url, "SHA256": hashlib.sha256(data).hexdigest(),
              "SHA512": hashlib.sha512(data).hexdigest()}
    for name in RECIPES:
        text = re.sub(r"@([A-Z0-9]+)@", lambda match: values[match.group(1)], (HERE / name).read_text())
        target = folder / "vcpkg/se3d" / name.split("/")[1] if name.startswith("vcpkg/") else folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)
        print(f"wrote {target}")


if __name__ == "__main__":
    main(sys.argv)
