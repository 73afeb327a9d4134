"""Damaged gearbox models: read, or refused in words, and soon."""

from __future__ import annotations

import io
import random
import zipfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from fuzz.damage import at_most, cut, flip
from tribodyn.errors import InputError
from tribodyn.exchange import case_from_rexs, read_rexs, write_rexs

Draws = Callable[[int], Iterator[random.Random]]
MODELS = Path(__file__).parents[1] / "references" / "rexs"


def swap(content: bytes, rng: random.Random) -> bytes:
    """Put one piece of the file, a number perhaps, in the place of another."""
    parts = content.replace(b">", b">\n").replace(b"<", b"\n<").split(b"\n")
    for _ in range(rng.choice((1, 2, 10))):
        odd = rng.choice((b"-1", b"nan", b"1e999", b"", b"0", b"99999999999999999999", b"true"))
        parts[rng.randrange(len(parts))] = rng.choice((odd, rng.choice(parts)))
    return b"".join(parts)


def zipped(content: bytes) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("model.rexs", content)
    return buffer.getvalue()


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_damaged_models(draws: Draws, tmp_path: Path) -> None:
    from tribodyn import load_case

    ours = tmp_path / "ours.rexs"
    write_rexs(load_case("fzg-roughness"), ours)
    intact = [(MODELS / "two_stages.rexs").read_bytes(), (MODELS / "two_stages.rexsj").read_bytes(),
              (MODELS / "planetary.rexsz").read_bytes(), ours.read_bytes()]  # fmt: skip
    read = refused = 0
    for rng in draws(60):
        content = rng.choice((flip, cut, swap))(rng.choice(intact), rng)
        path = tmp_path / "damaged.rexs"
        path.write_bytes(zipped(content) if rng.random() < 0.1 else content)
        # Anything but this error is a defect.
        with at_most(5.0), suppress(InputError):
            read += 1
            model = read_rexs(path)
            refused -= 1
            for stage in model.stages:
                case_from_rexs(model, stage.id)
        refused += 1
    assert 0 < refused < read
