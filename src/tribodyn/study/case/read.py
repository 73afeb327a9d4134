"""Read a case file: parse TOML text into a checked case, with the line of every problem."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Self

from tribodyn import units
from tribodyn.errors import InputError, Problem
from tribodyn.study.case.section import named_rows
from tribodyn.study.case.user_input import Note, Source
from tribodyn.types import Tree
from tribodyn.validated_files import read_bytes

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

_SPACE = " \t\r"
#: A string with its quotes, also one without an end; part of a key; text of a value without marks.
_STRING = re.compile(
    r'''"""(?:[^"\\]+|\\.|"(?!""))*(?:""")?|"(?:[^"\\\n]+|\\.)*"?'''
    r"|'''(?:[^']+|'(?!''))*(?:''')?|'[^'\n]*'?",
    re.DOTALL,
)
_NAME, _PLAIN = re.compile(r"[\w-]+"), re.compile(r"""[^"'#{\[\],}\n]+""")


class _Scanner:
    """Scanner of TOML text: numbers of the lines, and what is written about each dotted key."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.line, self.counted = 1, 0  #: line number, and position up to which lines are counted
        self.lines: dict[str, list[int]] = {}
        self.notes: dict[str, Note] = {}
        self._end = 0  #: position behind the line of the last key
        self._rows: dict[tuple[str, ...], int] = {}  #: tables of each list of tables
        self._table: tuple[str, ...] = ()  #: key of the table, and in a list its number

    def run(self) -> Self:
        """Scan the text."""
        table: tuple[str, ...] = ()
        while self.at < len(self.text):
            self._skip(_SPACE + "\n")
            if self._peek() == "#":
                self._to_line_end()
            elif self._peek() == "[":
                start = self.at
                self._skip("[")
                table = self._table = self._key("]")
                if self.text.startswith("[[", start):
                    self._rows[table] = self._rows.get(table, 0) + 1
                    self._table = (*table, str(self._rows[table]))
                self._note(table, start)
                self._skip("]")
                self._finish(self._table, start)
            elif self.at < len(self.text):
                self._pair(table, "\n")
        self.notes[""] = Note(self.text[self._end :])
        return self

    def _peek(self) -> str:
        return self.text[self.at : self.at + 1]

    def _skip(self, characters: str) -> None:
        while self._peek() and self._peek() in characters:
            self.at += 1

    def _to_line_end(self) -> None:
        end = self.text.find("\n", self.at)
        self.at = len(self.text) if end < 0 else end

    def _finish(self, place: tuple[str, ...], start: int, value: str = "") -> None:
        """Keep what is above a key and behind it, and go to the next line."""
        at = self.at
        self._to_line_end()
        above, behind = self.text[self._end : start], self.text[at : self.at].rstrip()
        self.notes[".".join(place)] = Note(above, behind, value)
        self._end = self.at = self.at + 1

    def _note(self, key: tuple[str, ...], position: int) -> None:
        self.line += self.text.count("\n", self.counted, position)
        self.counted = max(position, self.counted)
        self.lines.setdefault(".".join(key), []).append(self.line)

    def _key(self, end: str) -> tuple[str, ...]:
        """Read a dotted key, quoted parts included, up to and with the character ``end``."""
        parts, part = [], ""
        while self._peek() not in ("", "\n", end):
            character = self._peek()
            if name := _NAME.match(self.text, self.at) or _STRING.match(self.text, self.at):
                part += name[0][1:-1] if character in "\"'" else name[0]
                self.at = name.end()
                continue
            if character == ".":
                parts.append(part)
                part = ""
            elif character not in _SPACE:
                part += character
            self.at += 1
        if self._peek() == end:
            self.at += 1
        return (*parts, part)

    def _pair(self, table: tuple[str, ...], ends: str) -> None:
        """Read ``key = value`` and note the key; the value ends at a character of ``ends``."""
        start = self.at
        names = self._key("=")
        sign = self.text[start : self.at]
        first = self.at - len(sign) + len(sign.rstrip("= \t"))
        self._note((*table, *names), start)
        self._value((*table, *names), ends)
        if ends == "\n":
            for end in range(1, len(names)):
                of_dots = ".".join((*self._table, *names[:end]))
                self.notes.setdefault(of_dots, Note("", dotted=True))
            value = self.text[first : self.at].rstrip()
            self.at = first + len(value)
            self._finish((*self._table, *names), start, value)

    def _value(self, key: tuple[str, ...], ends: str) -> None:
        """Skip a value, recording the keys of its inline tables."""
        depth = 0
        while self.at < len(self.text):
            character = self._peek()
            if depth == 0 and character in ends:
                return
            if skipped := _STRING.match(self.text, self.at) or _PLAIN.match(self.text, self.at):
                self.at = skipped.end()
                continue
            if character == "#" and not depth:
                return
            if character == "#":
                self._to_line_end()
                continue
            if character == "{":
                self._inline(key)
                continue
            depth += {"[": 1, "]": -1}.get(character, 0)
            self.at += 1

    def _inline(self, key: tuple[str, ...]) -> None:
        """Read the inline table that begins at the current position."""
        self.at += 1
        while self.at < len(self.text):
            self._skip(_SPACE + "\n,")
            if self._peek() == "}":
                self.at += 1
                return
            self._pair(key, ",}\n")


def key_lines(text: str) -> dict[str, list[int]]:
    r"""Map every dotted key and table of TOML text to its line numbers."""
    return _Scanner(text).run().lines


def key_notes(text: str) -> dict[str, Note]:
    """What is written above, behind and for each dotted key; rows of a list have numbers."""
    return _Scanner(text.replace("\r\n", "\n")).run().notes


#: A number followed by a unit, without quotes.
_BARE_UNIT = re.compile(r"=\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[A-Za-zµ°%][^\"'#]*?)\s*(?:#.*)?$")
_UNQUOTED = re.compile(r"=\s*([^\"'#\[{]*'?[^\"'#\[{]*?)\s*(?:#.*)?$")
#: Quotes of word processors.
_CURLY = re.compile("[“”„‟″‘‚«»]")
_BARE_WORD = re.compile(r"=\s*([A-Za-z][\w-]*)\s*(?:#.*)?$")

#: A key with so many parts that parsing it would take very long.
_CHAIN = re.compile(r"""(?<![\w"'-])(?:[\w"'-]+[ \t]*\.[ \t]*){50}""")

#: Characters of an invalid line that a message repeats, and that are examined.
_MAX_EXCERPT, _MAX_LINE = 80, 200


def read_text(path: Path) -> str:
    """Read a text file in UTF-8."""
    try:
        return read_bytes(path, "case").decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        what = f"byte 0x{error.object[error.start]:02x} is not UTF-8"
        why = "A case file is text in UTF-8"
        raise InputError(what, f"{path}:{line}", why, "Save it as UTF-8") from None
    except OSError as error:
        reason = error.strerror or str(error)
        what, why = f"the file cannot be read: {reason}", "A case is a text file in UTF-8"
        raise InputError(what, str(path), why, "Give the path of a case file") from None


def source_of(text: str, name: str) -> Source:
    """Where the values of the text of a case file come from."""
    return Source(name or "case", partial(_lines_by_row, text), notes=partial(key_notes, text))


def _lines_by_row(text: str) -> dict[str, list[int]]:
    """Line numbers of all keys, of lists of tables also by the names of their rows."""
    lines = key_lines(text)
    for table, value in tomllib.loads(text).items():
        if not (rows := named_rows(value)):
            continue
        heads = lines.get(table, [])
        inner = [(key, at) for key, at in lines.items() if key.startswith(f"{table}.")]
        for (row, _), head, end in zip(rows, heads, [*heads[1:], sys.maxsize], strict=False):
            lines[f"{table}.{row}"] = [head]
            for key, at in inner:
                if inside := [line for line in at if head < line < end]:
                    lines[f"{table}.{row}.{key.removeprefix(f'{table}.')}"] = inside
    return lines


@contextmanager
def unchanged_files(case: Case) -> Iterator[None]:
    """Raise if a file that the case names changes while the block runs."""
    files = case._named_files()
    before = {key: _state(path) for key, path in files.items()}
    yield
    why = "Parts of the results may come from the old file and parts from the new file"
    problems = [
        Problem(f"{path} changed while the case was computed", key, why, "Run it again")
        for key, path in files.items()
        if _state(path) != before[key]
    ]
    if problems:
        raise InputError(problems)


def _state(path: Path) -> tuple[int, int, int] | None:
    with suppress(OSError):
        status = path.stat()
        return status.st_mtime_ns, status.st_size, status.st_ino
    return None


def parse_toml(text: str, name: str) -> Tree:
    """Parse TOML; raise InputError with line and remedy if it is invalid."""
    if chain := _CHAIN.search(text):
        line = text.count("\n", 0, chain.start()) + 1
        what = "a key has more parts than any key of a case"
        raise InputError(what, f"{name}:{line}", f"It begins with {chain[0][:40]}", "Correct it")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(_syntax(text, name, str(error))) from None
    except RecursionError:
        what, where = "brackets are nested too deeply", f"{name}:{_deepest_line(text)}"
        raise InputError(what, where, "", "This is not a case file") from None
    except (ValueError, OverflowError):
        long = re.search(r"[0-9_]{4300}", text)
        where = f"{name}:{text.count(chr(10), 0, long.start()) + 1}" if long else name
        raise InputError("a number is too long to be read", where, "", "Correct it") from None


def _deepest_line(text: str) -> int:
    """Return the line with the most open brackets."""
    open_, most, line, at = 0, 0, 1, 1
    for mark in re.findall(r"[\[\]{}\n]", text):
        line += mark == "\n"
        open_ += {"[": 1, "{": 1, "]": -1, "}": -1}.get(mark, 0)
        if open_ > most:
            most, at = open_, line
    return at


def _syntax(text: str, name: str, message: str) -> Problem:
    """Return the problem of a TOML syntax error, with the probable remedy."""
    location = re.search(r"\(at line (\d+), column \d+\)", message)
    lines = text.splitlines()
    number = int(location.group(1)) if location else len(lines)
    reason = re.sub(r"\s*\(at .*\)$", "", message)
    if repeated := _repeated(text, reason, number):
        key, first, second = repeated
        why = f"It appears in lines {first} and {second}"
        return Problem(f"{key} is given twice", f"{name}:{second}: {key}", why, "Remove one")
    content = lines[number - 1].strip()[:_MAX_LINE] if 0 < number <= len(lines) else ""
    excerpt = content if len(content) <= _MAX_EXCERPT else f"{content[:_MAX_EXCERPT]}..."
    what = f'this is not TOML: "{excerpt}"' if content else "this is not TOML"
    return Problem(what, f"{name}:{number}", reason, _remedy(content))


def _repeated(text: str, reason: str, number: int) -> tuple[str, int, int] | None:
    """Find the key that appears twice, if the TOML parser reports a duplicate."""
    if not re.search(r"overwrite|twice|duplicate|namespace", reason, re.IGNORECASE):
        return None
    twice = [(key, at) for key, at in key_lines(text).items() if len(at) > 1]
    matches = [(key, at) for key, at in twice if number in at] or twice
    return (matches[0][0], matches[0][1][0], matches[0][1][1]) if matches else None


def _with_quotes(number: str) -> str:
    """Format a number as TOML, with quotes if it has a unit."""
    return f'"{number}"' if " " in number else number


def _remedy(content: str) -> str:
    key = content.split("=")[0].strip()
    if _CURLY.search(content):
        straight = _CURLY.sub('"', content.partition("#")[0]).strip()
        return f"Write straight quotes, as a text editor does: {straight}"
    readings = units.readings(match.group(1)) if (match := _UNQUOTED.search(content)) else []
    if readings:
        examples = " or ".join(f"{key} = {_with_quotes(text)}" for text in readings)
        return f"Write {examples}: {units.NUMBERS}"
    if match := _BARE_UNIT.search(content):
        return f'Put the value in quotes: {key} = "{match.group(1)}"'
    if match := _BARE_WORD.search(content):
        return f'Put the word in quotes: {key} = "{match.group(1)}"'
    if content.count('"') % 2:
        return "Close the quotes"
    if content.startswith("[") and "]" not in content:
        return "Close the bracket"
    return 'A line has the form key = "value unit"' if "=" not in content else "Correct the line"
