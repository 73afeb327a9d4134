"""Checks of all written text: no machine paths, no strange hosts."""

from __future__ import annotations

import re

__all__ = ["HOSTS", "machine_paths", "strange_hosts"]

_FOLDERS = "|".join(("home", "work", "tmp", "root", "opt", "Users", "mnt", "workspace"))
_PATH = re.compile(rf"(?<![\w.$}}~\]/-])/(?:{_FOLDERS})/\w")
_DRIVE = re.compile(r"(?<![\w])[A-Z]:\\{1,2}\w")
_URL = re.compile(r"https?://([\w.-]+)(:\d+)?")

#: Hosts that text may name: literature, standards of writing, licences, namespaces, examples.
HOSTS = {
    "doi.org",
    "github.com",  # where hooks of pre-commit come from
    "www.contributor-covenant.org",
    "keepachangelog.com",
    "semver.org",
    "toml.io",
    "citation-file-format.github.io",
    "www.w3.org",
    "www.apache.org",
    "plotly.com",
    "docs.python.org",
    "example.org",
    "evil.example",  # reserved for examples, as the loopback address is for the machine itself
    "127.0.0.1",
    "jobqueue.dask.org",
    "kubernetes.dask.org",
}


def machine_paths(name: str, text: str) -> list[str]:
    """No file names a folder of the machine on which it was written."""
    return [
        f"{name}:{number}: {line.strip()[:80]}"
        for number, line in enumerate(text.splitlines(), 1)
        if _PATH.search(line) or _DRIVE.search(line)
    ]


def strange_hosts(name: str, text: str) -> list[str]:
    """Only known public addresses are named, none with a port."""
    return [
        f"{name}: {match.group()}"
        for match in _URL.finditer(text)
        if match.group(2) or match.group(1) not in HOSTS
    ]
