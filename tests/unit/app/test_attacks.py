"""What the page refuses: other sites, other names, other users, other folders, too much."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("dash", reason="the page needs Dash")

from tribodyn.app.server import Page
from tribodyn.cases.load import load_case
from tribodyn.errors import InputError


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    home = tmp_path_factory.mktemp("outside") / "home"
    home.mkdir()
    (home.parent / "secret.toml").write_text('title = "secret"\n')
    return home


@pytest.fixture(scope="module")
def page(home: Path) -> Iterator[Page]:
    page = Page(home, "fzg-roughness")
    yield page
    page.close()


class Browser:
    """A browser of one user, without the browser."""

    def __init__(self, page: Page, token: str | None = None) -> None:
        self.client = page.server.app.test_client()
        self.base = f"http://127.0.0.1:{page.port}"
        self.number = 0
        token = page.address.rpartition("=")[2] if token is None else token
        self.first = self.client.get(f"/?token={token}", base_url=self.base)

    def get(self, path: str, **headers: str) -> Any:
        return self.client.get(path, base_url=self.base, headers=headers)

    def desk(self) -> str:
        return str(self.get("/").headers["Location"]).split("/")[-2]

    @cached_property
    def listed(self) -> Any:
        """What the page may ask."""
        answers = self.get("/_dash-dependencies").json
        return next(each for each in answers if "form.data" in each["output"])

    def ask(self, desk: str, do: str = "", of: str = "", edit: Any = None, **more: Any) -> Any:
        """What the page asks when something is pressed or typed."""
        self.number += 1
        listed = self.listed
        act = {"do": do, "of": of, "number": self.number, **more.pop("act", {})}
        edits = [{"form": "case", "number": self.number, **edit}] if edit else None
        values = {"url": f"/desk/{desk}/", "edit": edits, "act": act if do else None}
        names = listed["output"].strip(".").split("...")
        body = {
            "output": listed["output"],
            "outputs": [dict(zip(("id", "property"), n.split("."), strict=True)) for n in names],
            "inputs": [{**each, "value": values.get(each["id"])} for each in listed["inputs"]],
            "changedPropIds": ["act.data" if do else "edit.data"],
            "state": [{**each, "value": None} for each in listed["state"]],
        }
        headers = more.pop("headers", {})
        path = "/_dash-update-component"
        return self.client.post(path, json=body, base_url=self.base, headers=headers, **more)


@pytest.fixture(scope="module")
def user(page: Page) -> Browser:
    return Browser(page)


@pytest.fixture(scope="module")
def desk(user: Browser) -> str:
    return user.desk()


def message_of(answer: Any) -> str:
    assert answer.status_code == 200, answer.text
    return str(answer.json["response"]["notice"]["children"])


def test_the_token_opens_the_page_once_and_stays_out_of_the_address(user: Browser) -> None:
    assert user.first.status_code == 303
    assert user.first.headers["Location"] == "/"
    cookie = user.first.headers["Set-Cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie


@pytest.mark.parametrize("path", ["/", "/desk/x/", "/_dash-layout", "/assets/form.js"])
def test_nothing_is_answered_without_the_token(page: Page, path: str) -> None:
    for token in ("", "wrong"):
        stranger = Browser(page, token)
        assert stranger.first.status_code == 403
        assert stranger.get(path).status_code == 403


def test_another_user_does_not_reach_a_desk(page: Page, user: Browser, desk: str) -> None:
    other = Browser(page)
    assert other.get(f"/desk/{desk}/").status_code == 404
    assert other.get(f"/desk/{desk}/report/1").status_code == 404
    assert other.ask(desk, "view", "files").status_code == 404
    assert user.get(f"/desk/{desk}/").status_code == 200


def test_a_token_of_another_start_is_refused(page: Page, home: Path) -> None:
    again = Page(home, "fzg-roughness")
    try:
        assert Browser(again, page.address.rpartition("=")[2]).first.status_code == 403
    finally:
        again.close()


@pytest.mark.parametrize(
    "host",
    ["evil.example", "127.0.0.1.evil.example", "", "localhost.evil", "[", "[::1", "[x]:1", "a]b"],
)
def test_another_host_name_is_refused(user: Browser, host: str) -> None:
    assert user.get("/", Host=host).status_code == 421


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
    ],
)
def test_requests_of_another_site_are_refused(
    user: Browser, desk: str, headers: dict[str, str]
) -> None:
    assert user.ask(desk, "view", "files", headers=headers).status_code == 403
    assert user.get("/", **headers).status_code == 403


def test_a_form_of_another_site_cannot_be_sent_here(user: Browser) -> None:
    path = "/_dash-update-component"
    sent = user.client.post(path, data={"a": "b"}, base_url=user.base)
    assert sent.status_code == 415


def test_the_page_cannot_be_framed_and_loads_no_external_files(user: Browser) -> None:
    policy = user.get("/").headers["Content-Security-Policy"]
    assert "frame-ancestors 'none'" in policy
    assert "default-src 'self'" in policy
    assert "'unsafe-inline'" not in policy.partition("script-src")[2].partition(";")[0]


ESCAPES = [
    "../secret.toml",
    "/etc/passwd",
    "a/../../secret.toml",
    "..",
    ".hidden.toml",
    f"C:{chr(92)}x.toml",
    "a\\..\\b.toml",
    "x\0.toml",
    "",
    "nul:.toml",
    "~root/x.toml",
    "link.toml",
    "a" * 300,
]


@pytest.mark.parametrize("name", ESCAPES)
def test_no_path_leaves_the_folder(user: Browser, desk: str, home: Path, name: str) -> None:
    link = home / "link.toml"
    if not link.is_symlink():
        link.symlink_to(home.parent / "secret.toml")
    before = sorted(home.parent.rglob("*"))
    assert "bad" in message_of(user.ask(desk, "open", f"file:{name}"))
    for act in ("save", "replace", "save-job"):
        assert "bad" in message_of(user.ask(desk, act, "1", act={"text": name}))
    assert sorted(home.parent.rglob("*")) == before
    assert (home.parent / "secret.toml").read_text() == 'title = "secret"\n'


def test_a_case_cannot_name_a_file_outside(user: Browser, desk: str, home: Path) -> None:
    text = load_case("fzg-roughness").to_toml().replace("[gears]", '[gears]\ntable = "../s.csv"')
    (home / "reaching.toml").write_text(text)
    assert "outside of the folder" in message_of(user.ask(desk, "open", "file:reaching.toml"))
    edit = {"key": "gears.pinion.modification.profile_map", "value": "../../etc/passwd"}
    answer = user.ask(desk, edit=edit).json["response"]["form"]["data"]
    assert "is no name of a file here" in answer["case"]["faults"][0]["text"]
    user.ask(desk, edit={**edit, "value": ""})


BOMBS = {
    "deep": "a = " + "[" * 100_000,
    "chain": "a" + ".b" * 50_000 + " = 1",
    "wide": "\n".join(f"k{n} = 1" for n in range(20_000)),
    "long": "a = " + "9" * 100_000,
    "text": f'title = "{"x" * 900_000}"',
    "large": "#" * 2_000_000,
    "bytes": "\x00\x01",
}


@pytest.mark.parametrize("bomb", BOMBS)
def test_a_bomb_is_refused_with_a_message(user: Browser, desk: str, home: Path, bomb: str) -> None:
    (home / "bomb.toml").write_text(BOMBS[bomb])
    message = message_of(user.ask(desk, "open", "file:bomb.toml"))
    assert "bad" in message
    assert len(message) < 40_000
    assert "Traceback" not in message
    (home / "bomb.toml").unlink()


def test_a_large_request_is_not_read(user: Browser, desk: str) -> None:
    assert user.ask(desk, "save", act={"text": "x" * 2_000_000}).status_code == 413


def test_values_are_not_run(user: Browser, desk: str, home: Path) -> None:
    for value in ("__import__('os').system('touch owned')", "${HOME}", "{{7*7}}"):
        edit = {"key": "operation.torque", "value": value}
        faults = user.ask(desk, edit=edit).json["response"]["form"]["data"]["case"]["faults"]
        assert [fault["key"] for fault in faults] == ["operation.torque"]
    user.ask(desk, edit={"key": "operation.torque", "value": "90"})
    assert not (home / "owned").exists()


def test_nonsense_is_passed_over(user: Browser, desk: str) -> None:
    for do, of in (
        ("no-such", ""),
        ("stop", "x"),
        ("remove", "-1"),
        ("study", "no"),
        ("view", "x"),
    ):
        assert user.ask(desk, do, of).status_code == 200
    answer = user.ask(desk, edit={"key": "no.such.key", "value": "1"})
    assert answer.json["response"]["form"]["data"]["case"]["faults"] == []


@pytest.mark.parametrize(
    "typed",
    [
        {"number": "x"}, {"number": None}, {"number": [1]}, {"number": 1e300}, {"key": 3},
        {"key": ["operation.torque"]}, {"key": None, "value": "1"}, {"value": 5}, {"value": None},
        {"value": ["90"]}, {"value": {"a": 1}}, {"unit": "nonsense"}, {"unit": 3}, {"unit": []},
        {"form": 7}, {"form": "study", "value": 3}, {"form": None},
    ],
)  # fmt: skip
def test_edits_of_a_wrong_type_are_answered(user: Browser, desk: str, typed: Any) -> None:
    event = {"key": "operation.torque", "value": "90"} | typed
    for edit in (event, {key: event[key] for key in event if key != "value"} | {"unit": "x"}):
        assert user.ask(desk, edit=edit).status_code == 200
    answer = user.ask(desk, edit={"key": "operation.torque", "value": "90", "unit": "N*m"})
    assert answer.json["response"]["form"]["data"]["case"]["faults"] == []


@pytest.mark.parametrize("number", ["x", None, [], {}, 1e300])
def test_acts_of_a_wrong_type_are_answered(user: Browser, desk: str, number: Any) -> None:
    for do in ("view", "stop"):
        assert user.ask(desk, do, "files", act={"number": number}).status_code == 200


def test_a_case_beyond_the_folder_is_not_begun_with(home: Path) -> None:
    with pytest.raises(InputError, match="outside of the folder"):
        Page(home, str(home.parent / "secret.toml"))
