"""The archive of a version for a data repository: the committed tree, checksums, and its metadata."""

from __future__ import annotations

import hashlib
import io
import json
import os
import re
import subprocess
import tarfile
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path

from weakforms.errors import EnvironmentLackError, InputError

NEEDED = ("CITATION.cff", "LICENSE", "CHANGELOG.md", "README.md", "reference_data/LICENSE")
"""Files without which an archive cannot be cited or used."""

SUMS = "SHA256SUMS"
METADATA = ".zenodo.json"


def write_archive(tree: Path, out: Path) -> str:
    """Write the tree as it is committed, so that the same commit gives the same bytes.

    Args:
        tree: A git tree without changes.
        out: The zip file; it appears only when complete.

    Returns:
        The SHA-256 checksum of the file.

    Raises:
        InputError: If the tree has changes, lacks a file that is needed, or the file cannot be written.
        EnvironmentLackError: Without git.
    """
    if out.suffix != ".zip":
        raise InputError(f"--out {out}: the name must end in .zip")
    if _git(tree, "status", "--porcelain").strip():
        raise InputError(f"{tree} has changes that are not committed; an archive is of a commit")
    files = _committed(tree)
    missing = [name for name in NEEDED if name not in files]
    if missing:
        raise InputError(f"{tree} has no {missing[0]}, which an archive needs")
    when = _git(tree, "log", "-1", "--format=%cs").decode().strip()
    files[METADATA] = json.dumps(_metadata(files["CITATION.cff"].decode(), when), indent=1).encode() + b"\n"
    sums = (f"{hashlib.sha256(data).hexdigest()}  {name}\n" for name, data in sorted(files.items()))
    files[SUMS] = "".join(sums).encode()
    data = _zipped(files, tuple(int(part) for part in when.split("-")))
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=out.parent, prefix=f".{out.name}.") as scratch:
            whole = Path(scratch) / out.name
            whole.write_bytes(data)
            os.replace(whole, out)
    except OSError as error:
        raise InputError(f"cannot write {out}: {error.strerror or error}") from error
    return hashlib.sha256(data).hexdigest()


def _git(tree: Path, *words: str) -> bytes:
    try:
        done = subprocess.run(["git", "-C", tree, *words], capture_output=True, check=False)
    except FileNotFoundError:
        raise EnvironmentLackError("git is not installed here: apt install git") from None
    if done.returncode:
        raise InputError(f"{tree} is no git tree with a commit, of which an archive is made")
    return done.stdout


def _committed(tree: Path) -> dict[str, bytes]:
    """Names and contents of the files of the last commit."""
    with tarfile.open(fileobj=io.BytesIO(_git(tree, "archive", "--format=tar", "HEAD"))) as tar:
        members = [member for member in tar.getmembers() if member.isfile()]
        return {member.name: tar.extractfile(member).read() for member in members}  # type: ignore[union-attr]


def _metadata(citation: str, date: str) -> dict[str, object]:
    """What a data repository asks for, from ``CITATION.cff``."""

    def entry(name: str) -> str:
        found = re.search(rf'^{name}: *"?(.*?)"?$', citation, re.MULTILINE)
        return found[1] if found else ""

    keywords = re.search(r"^keywords:\n((?:  - .*\n?)+)", citation, re.MULTILINE)
    names = re.findall(r'^  - (?:name: *)?"?(.+?)"?$', citation.partition("authors:")[2], re.MULTILINE)
    authors = names[: len(names) - len(keywords[1].splitlines())] if keywords else names
    abstract = re.search(r"^abstract: >-\n((?:  .*\n)+)", citation, re.MULTILINE)
    return {
        "title": entry("title"),
        "version": entry("version"),
        "publication_date": date,
        "upload_type": "software",
        "description": " ".join(abstract[1].split()) if abstract else entry("title"),
        "creators": [{"name": name} for name in authors],
        "license": entry("license"),
        "notes": "Tables in reference_data are data under CC BY 4.0 (reference_data/LICENSE).",
        "keywords": [line.strip(" -") for line in keywords[1].splitlines()] if keywords else [],
    }


def _zipped(files: Mapping[str, bytes], date: tuple[int, ...]) -> bytes:
    """A zip file with the date of the commit in place of that of today."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, data in sorted(files.items()):
            info = zipfile.ZipInfo(f"weakforms/{name}", (date[0], date[1], date[2], 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o755 if data.startswith(b"#!") else 0o644) << 16
            archive.writestr(info, data)
    return buffer.getvalue()
