"""Who may ask: a token opens a session, and only this page in the browser may speak for it."""

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

from tribodyn.app.session import Desk

#: Sessions of a server, and tabs of a session.
SESSIONS, DESKS = 24, 12
#: Characters of a request.
LARGEST = 10**6

_LOOPBACK = ("127.0.0.1", "localhost", "::1")


class RefusalError(Exception):
    """A request that is not answered, with its status."""

    def __init__(self, status: int, text: str) -> None:
        super().__init__(text)
        self.status, self.text = status, text


class Session:
    """One browser, with a desk for each of its tabs."""

    def __init__(self) -> None:
        self.desks: OrderedDict[str, Desk] = OrderedDict()


class Guard:
    """Tells which requests are answered, and for which session."""

    def __init__(self, host: str, port: int) -> None:
        self.token = secrets.token_urlsafe(24)
        self.cookie = f"tribodyn-{port}"
        self._lock = threading.Lock()
        self._sessions: OrderedDict[str, Session] = OrderedDict()
        self._any = host in ("0.0.0.0", "::", "")
        own = {host, socket.gethostname()} if host not in _LOOPBACK else set()
        self._hosts = {*_LOOPBACK, *(name.lower() for name in own if name)}

    def check(self, request: Any) -> None:
        """Refuse what another site asks through the browser, or another name of this machine."""
        name = (urlsplit(f"//{request.headers.get('Host', '')}").hostname or "").lower()
        if name not in self._hosts and not (self._any and _is_address(name)):
            raise RefusalError(421, "This page is not served under that name.")
        # A browser says so itself where another site asks.
        site = request.headers.get("Sec-Fetch-Site", "none")
        origin = request.headers.get("Origin")
        foreign = origin is not None and origin != f"http://{request.headers['Host']}"
        opened = request.method == "GET" and self.opens(request.args.get("token", ""))
        if foreign or (site not in ("same-origin", "none") and not opened):
            raise RefusalError(403, "Other sites may not ask for this page.")
        if request.method not in ("GET", "HEAD") and not request.is_json:
            raise RefusalError(415, "This page takes JSON alone.")
        if (request.content_length or 0) > LARGEST:
            raise RefusalError(413, "That is more than a case file may hold.")

    def opens(self, token: str) -> bool:
        """Whether a token is that of this server."""
        return hmac.compare_digest(token.encode(), self.token.encode())

    def session(self, request: Any) -> Session:
        """The session of a request."""
        with self._lock:
            found = self._sessions.get(request.cookies.get(self.cookie, ""))
        if found is None:
            raise RefusalError(403, "Open the address that tribodyn app wrote: it holds the token.")
        return found

    def __contains__(self, cookie: str) -> bool:
        """Whether a cookie names a session."""
        return cookie in self._sessions

    def begin(self) -> str:
        """Begin a session; the longest unused one ends where there are too many."""
        name = secrets.token_urlsafe(32)
        with self._lock:
            self._sessions[name] = Session()
            gone = [self._sessions.popitem(last=False)[1]] if len(self._sessions) > SESSIONS else []
        for session in gone:
            for desk in session.desks.values():
                desk.close()
        return name

    def new_desk(self, session: Session, make: Callable[[], Desk]) -> str:
        """A desk for a new tab; the longest unused one goes where there are too many."""
        name, desk = secrets.token_urlsafe(9), make()
        with self._lock:
            session.desks[name] = desk
            gone = session.desks.popitem(last=False)[1] if len(session.desks) > DESKS else None
        if gone is not None:
            gone.close()
        return name

    def desk(self, session: Session, name: str) -> Desk:
        """A desk of this very session."""
        with self._lock:
            if name in session.desks:
                session.desks.move_to_end(name)
                return session.desks[name]
        raise RefusalError(404, "There is no such desk. Open the page anew.")


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


#: What a browser is told with every answer; scripts are those of the page, by their hashes.
def headers(hashes: list[str]) -> dict[str, str]:
    """Headers of every answer."""
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
