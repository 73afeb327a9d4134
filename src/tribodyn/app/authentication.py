"""Authentication of requests: a token opens a session, which only this page may use."""

from __future__ import annotations

import hmac
import ipaddress
import secrets
import socket
import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

from tribodyn.app.session import TabSession

#: Sessions of a server, and tabs of a session.
SESSIONS, DESKS = 24, 12
#: Characters of a request.
LARGEST = 10**6

_LOOPBACK = ("127.0.0.1", "localhost", "::1")


class RefusalError(Exception):
    """Raised to refuse a request, with its HTTP status."""

    def __init__(self, status: int, text: str) -> None:
        super().__init__(text)
        self.status, self.text = status, text


class BrowserSession:
    """Session of one browser, with the state of each of its tabs."""

    def __init__(self) -> None:
        self.desks: OrderedDict[str, TabSession] = OrderedDict()


class Authenticator:
    """Check of requests for host, origin, token and session."""

    def __init__(self, host: str, port: int) -> None:
        self.token = secrets.token_urlsafe(24)
        self.cookie = f"tribodyn-{port}"
        self._lock = threading.Lock()
        self._sessions: OrderedDict[str, BrowserSession] = OrderedDict()
        self._any = host in ("0.0.0.0", "::", "")
        host_names = {host, socket.gethostname()} if host not in _LOOPBACK else set()
        self._hosts = {*_LOOPBACK, *(name.lower() for name in host_names if name)}

    def check(self, request: Any) -> None:
        """Refuse requests of other sites, under foreign host names, or too large ones."""
        name = _host_name(request.headers.get("Host", ""))
        if name not in self._hosts and not (self._any and _is_address(name)):
            raise RefusalError(421, "This page is not served under that name.")
        # Browsers mark requests that come from another site.
        site = request.headers.get("Sec-Fetch-Site", "none")
        origin = request.headers.get("Origin")
        foreign = origin is not None and origin != f"http://{request.headers['Host']}"
        opened = request.method == "GET" and self.opens(request.args.get("token", ""))
        if foreign or (site not in ("same-origin", "none") and not opened):
            raise RefusalError(403, "Requests from other sites are not allowed.")
        if request.method not in ("GET", "HEAD") and not request.is_json:
            raise RefusalError(415, "This page accepts JSON only.")
        if (request.content_length or 0) > LARGEST:
            raise RefusalError(413, f"The request exceeds {LARGEST} characters.")

    def opens(self, token: str) -> bool:
        """Whether a token is that of this server."""
        return hmac.compare_digest(token.encode(), self.token.encode())

    def session(self, request: Any) -> BrowserSession:
        """The session of a request."""
        with self._lock:
            browser_session = self._sessions.get(request.cookies.get(self.cookie, ""))
        if browser_session is None:
            message = "Open the address that tribodyn app printed: it contains the token."
            raise RefusalError(403, message)
        return browser_session

    def __contains__(self, cookie: str) -> bool:
        """Whether a cookie names a session."""
        return cookie in self._sessions

    def begin(self) -> str:
        """Begin a session; beyond the limit the least recently used one ends."""
        name = secrets.token_urlsafe(32)
        with self._lock:
            self._sessions[name] = BrowserSession()
            expired = (
                [self._sessions.popitem(last=False)[1]] if len(self._sessions) > SESSIONS else []
            )
        for session in expired:
            for desk in session.desks.values():
                desk.close()
        return name

    def new_desk(self, session: BrowserSession, make: Callable[[], TabSession]) -> str:
        """Create the state of a new tab; beyond the limit the least recently used one closes."""
        name, desk = secrets.token_urlsafe(9), make()
        with self._lock:
            session.desks[name] = desk
            expired = session.desks.popitem(last=False)[1] if len(session.desks) > DESKS else None
        if expired is not None:
            expired.close()
        return name

    def desk(self, session: BrowserSession, name: str) -> TabSession:
        """Return the state of a tab of this session."""
        with self._lock:
            if name in session.desks:
                session.desks.move_to_end(name)
                return session.desks[name]
        raise RefusalError(404, "This tab is no longer open. Reload the page at its first address.")


def _host_name(header: str) -> str:
    """Name of a host without its port; empty where the header is none."""
    try:
        return (urlsplit(f"//{header}").hostname or "").lower()
    except ValueError:  # a bracket that is not closed, or no address within
        return ""


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def headers(hashes: list[str]) -> dict[str, str]:
    """Security headers of every response; allowed inline scripts have these hashes."""
    scripts = " ".join(["'self'", "'unsafe-eval'", *hashes])  # drawings in space compile shaders
    policy = (
        f"default-src 'self'; script-src {scripts}; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; worker-src 'self' blob:; frame-ancestors 'none'; "
        "form-action 'self'; base-uri 'none'; object-src 'none'"
    )
    return {
        "Content-Security-Policy": policy,
        "X-Content-Type-Options": "nosniff",
        "X-Frame-Options": "DENY",
        "Referrer-Policy": "same-origin",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
    }
