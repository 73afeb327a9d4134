"""Where a key stands in TOML text, so that a message can name the line.

The standard TOML reader forgets positions. This scanner walks the text once and notes the line
of every table header and key, inside inline tables too. It understands strings, comments and
brackets well enough to skip values, and leaves all judgement about the text to the TOML reader.
"""

from __future__ import annotations

_SPACE = " \t\r"


class _Scanner:
    """One pass over the text; ``lines`` maps dotted keys to the lines on which they stand."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.lines: dict[str, list[int]] = {}

    def run(self) -> dict[str, list[int]]:
        """Scan the whole text."""
        table: tuple[str, ...] = ()
        while self.at < len(self.text):
            self._skip(_SPACE + "\n")
            if self._peek() == "#":
                self._to_line_end()
            elif self._peek() == "[":
                self._skip("[")
                start = self.at
                table = self._key("]")
                self._note(table, start)
                self._to_line_end()
            elif self.at < len(self.text):
                self._pair(table, "\n")
        return self.lines

    def _peek(self) -> str:
        return self.text[self.at : self.at + 1]

    def _skip(self, characters: str) -> None:
        while self._peek() and self._peek() in characters:
            self.at += 1

    def _to_line_end(self) -> None:
        end = self.text.find("\n", self.at)
        self.at = len(self.text) if end < 0 else end

    def _note(self, key: tuple[str, ...], position: int) -> None:
        line = self.text.count("\n", 0, position) + 1
        self.lines.setdefault(".".join(key), []).append(line)

    def _key(self, end: str) -> tuple[str, ...]:
        """Read a dotted key, quoted parts included, up to and with the character ``end``."""
        parts, part = [], ""
        while self._peek() not in ("", "\n", end):
            character = self._peek()
            if character in "\"'":
                start = self.at + 1
                self._string(character)
                part += self.text[start : self.at - 1]
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
        key = (*table, *self._key("="))
        self._note(key, start)
        self._value(key, ends)

    def _string(self, quote: str) -> None:
        """Step behind the string that begins here."""
        long = self.text.startswith(quote * 3, self.at)
        close = quote * 3 if long else quote
        self.at += len(close)
        while self.at < len(self.text) and not self.text.startswith(close, self.at):
            if not long and self._peek() == "\n":
                return
            self.at += 2 if quote == '"' and self._peek() == "\\" else 1
        self.at += len(close)

    def _value(self, key: tuple[str, ...], ends: str) -> None:
        """Step to the end of a value, noting the keys of inline tables inside it."""
        depth = 0
        while self.at < len(self.text):
            character = self._peek()
            if depth == 0 and character in ends:
                return
            if character in "\"'":
                self._string(character)
                continue
            if character == "#":
                self._to_line_end()
                continue
            if character == "{":
                self._inline(key)
                continue
            depth += {"[": 1, "]": -1}.get(character, 0)
            self.at += 1

    def _inline(self, key: tuple[str, ...]) -> None:
        """Read the inline table that begins here, up to and with its closing brace."""
        self.at += 1
        while self.at < len(self.text):
            self._skip(_SPACE + "\n,")
            if self._peek() == "}":
                self.at += 1
                return
            self._pair(key, ",}\n")


def key_lines(text: str) -> dict[str, list[int]]:
    r"""Map every dotted key and table of TOML text to the lines on which it stands."""
    return _Scanner(text).run()
