"""The server: every request passes the guard, and every answer comes from one desk."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import dash
import flask
from dash import ClientsideFunction, Input, Output, State, dcc, html
from werkzeug.serving import BaseWSGIServer, WSGIRequestHandler, make_server

from tribodyn.app import results
from tribodyn.app.authentication import (
    LARGEST,
    Authenticator,
    BrowserSession,
    RefusalError,
    headers,
)
from tribodyn.app.jobs import Jobs
from tribodyn.app.script import script_of
from tribodyn.app.session import TabSession, initial_case, number_of
from tribodyn.app.workspace import Workspace
from tribodyn.errors import InputError, TribodynError
from tribodyn.report.html import text_of
from tribodyn.types import Tree

_PARTS = ("form", "rail", "tools", "bench", "notice", "title")
#: Content security policy of a report, which is a self-contained page without requests.
_OF_REPORT = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src data: blob:; sandbox allow-scripts allow-downloads"
)
_HEAD = """<!DOCTYPE html>
<html lang="en">
<head>{%metas%}<title>tribodyn</title><link rel="icon" href="data:,">
<style>STYLE</style>{%css%}</head>
<body>{%app_entry%}<footer>{%config%}{%scripts%}{%renderer%}</footer></body>
</html>"""


class Page:
    """A page and the server behind it."""

    def __init__(self, folder: Path, case: str = "", host: str = "127.0.0.1", port: int = 0):
        if not folder.is_dir():
            raise InputError(f"there is no folder {folder}", "--folder", "", "Create it first")
        self._folder = Workspace(folder)
        self._begin = initial_case(self._folder, case)
        self.server = _bound(host, port, _application)
        self.port = self.server.server_port
        self.host = host
        self._guard = Authenticator(host, self.port)
        self._jobs = Jobs()
        self.server.app = self._flask()

    @property
    def address(self) -> str:
        """Where the page is, with the token that opens it."""
        host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(self.host, self.host)
        host_text = f"[{host}]" if ":" in host else host
        return f"http://{host_text}:{self.port}/?token={self._guard.token}"

    def serve(self) -> None:
        """Answer requests until somebody interrupts or closes it."""
        try:
            self.server.serve_forever()
        finally:
            self.close()

    def close(self) -> None:
        """Stop every computation and let go of the address."""
        threading.Thread(target=self.server.shutdown, daemon=True).start()
        self._jobs.close()
        self.server.server_close()

    def _new_desk(self) -> TabSession:
        return TabSession(self._folder, self._jobs, *self._begin)

    def _flask(self) -> flask.Flask:
        application = flask.Flask("tribodyn.app")
        application.config["MAX_CONTENT_LENGTH"] = LARGEST
        application.before_request(self._enter)
        application.add_url_rule("/desk/<desk>/report/<int:number>", view_func=self._report)
        application.add_url_rule("/desk/<desk>/script.py", view_func=self._script)
        application.register_error_handler(RefusalError, _refused)
        style = str(text_of("report.css"))  # the page looks like the reports
        page = dash.Dash(
            "tribodyn.app",
            server=application,
            title="tribodyn",
            update_title=None,  # type: ignore[arg-type]
            assets_folder=str(Path(__file__).parent / "assets"),
            serve_locally=True,
            include_assets_files=True,
            index_string=_HEAD.replace("STYLE", style),
        )
        page.layout = _layout()
        self._connect(page)
        response_headers = headers(page.csp_hashes())

        @application.after_request
        def leave(answer: flask.Response) -> flask.Response:
            for name, value in response_headers.items():
                answer.headers.setdefault(name, value)
            if not flask.request.path.startswith(("/assets/", "/_dash-component-suites/")):
                answer.headers["Cache-Control"] = "no-store"
            return answer

        return application

    def _session(self) -> BrowserSession:
        return self._guard.session(flask.request)

    def _enter(self) -> flask.typing.ResponseReturnValue | None:
        """Check a request, begin a session, or create the state of a new tab."""
        request = flask.request
        self._guard.check(request)
        token = request.args.get("token", "")
        if request.path == "/" and token:
            if not self._guard.opens(token):
                raise RefusalError(403, "That token is not of this server.")
            answer = flask.redirect("/", 303)
            if request.cookies.get(self._guard.cookie, "") not in self._guard:
                name = self._guard.begin()
                answer.set_cookie(self._guard.cookie, name, httponly=True, samesite="Strict")
            return answer
        session = self._session()
        if request.path == "/":
            return flask.redirect(f"/desk/{self._guard.new_desk(session, self._new_desk)}/", 303)
        if request.path.startswith("/desk/"):
            self._guard.desk(session, request.path.split("/")[2])
        return None

    def _report(self, desk: str, number: int) -> flask.typing.ResponseReturnValue:
        job = self._guard.desk(self._session(), desk).job(number)
        if job is None or not job.saved:
            raise RefusalError(404, "There is no such report.")
        names = ("report.html", "bifurcation.html")
        place = next(job.result / name for name in names if (job.result / name).is_file())
        answer = flask.send_file(place)
        answer.headers["Content-Security-Policy"] = _OF_REPORT
        return answer

    def _script(self, desk: str) -> flask.typing.ResponseReturnValue:
        session = self._guard.desk(self._session(), desk)
        with session.lock:
            return flask.Response(script_of(session), mimetype="text/x-python")

    def _connect(self, page: dash.Dash) -> None:
        page.clientside_callback(ClientsideFunction("tribodyn", "render"), Input("form", "data"))
        page.clientside_callback(ClientsideFunction("tribodyn", "pulse"), Input("pulse", "data"))
        page.callback(
            Output("form", "data"),
            *(Output(name, "children") for name in _PARTS[1:]),
            Output("seen", "data"),
            Output("pulse", "data"),
            Input("url", "pathname"),
            Input("edit", "data"),
            Input("act", "data"),
            Input("tick", "data"),
            State("seen", "data"),
        )(self._answer)

    def _answer(
        self, path: str, edits: object, act: object, tick: object, client_versions: object
    ) -> list[Any]:
        """Perform the requested action and return the changed parts of the page."""
        names = [*str(path).split("/"), "", ""]
        desk = self._guard.desk(self._session(), names[2])
        with desk.lock:
            _do(desk, edits, act)
            now, parts = _versions(desk), []
            for name in _PARTS:
                same = isinstance(client_versions, dict) and client_versions.get(name) == now[name]
                parts.append(dash.no_update if same else _DRAW[name](desk))
            return [*parts, now, {"busy": desk.busy, "count": number_of(tick)}]


def _bound(host: str, port: int, application: Any) -> BaseWSGIServer:
    """Bind a server to its address, or raise with the reason."""
    try:
        return make_server(host, port, application, threaded=True, request_handler=_Quiet)
    except (OSError, SystemExit) as error:
        why = getattr(error, "strerror", "") or "It is taken, or not an address of this machine"
        remedy = "Choose another port with --port; 0 takes any that is free"
        raise InputError(f"cannot serve at {host}:{port}", "tribodyn app", why, remedy) from None


def _application(environ: object, start: Callable[..., object]) -> list[bytes]:
    """Answer of a server that is not ready yet."""
    start("503 Service Unavailable", [("Content-Type", "text/plain")])
    return [b"Not ready yet."]


class _Quiet(WSGIRequestHandler):
    """Writes nothing to the terminal: an address there would hold the token."""

    def log(self, type: str, message: str, *args: object) -> None:
        """Stay silent."""

    def version_string(self) -> str:
        """Not tell more than who it is."""
        return "tribodyn"


def _refused(error: RefusalError) -> flask.typing.ResponseReturnValue:
    return flask.Response(f"{error.text}\n", error.status, mimetype="text/plain")


def _layout() -> html.Div:
    """Layout of the page before the state of a tab fills it."""
    run = results.button("Run", "run", id="run", title="Compute the case (Ctrl+Enter)")
    return html.Div(
        [
            dcc.Location(id="url", refresh=False),
            *(dcc.Store(id=name) for name in ("form", "edit", "act", "tick", "seen", "pulse")),
            html.A("To the results", href="#bench", className="skip"),
            html.Header(
                html.Div(
                    [
                        html.Div([html.P("tribodyn", className="brand"), html.H1(id="title")]),
                        html.Div(
                            [results.button("Open or save", "view", "files"), run],
                            className="actions",
                        ),
                    ],
                    className="bar",
                )
            ),
            html.Div(id="notice", role="status", **{"aria-live": "polite"}),
            html.Main(
                [
                    html.Section(
                        html.Div(id="case-form"), className="case", **{"aria-label": "Case"}
                    ),
                    html.Section(
                        [html.Div(id="rail"), html.Div(id="tools"), html.Div(id="bench")],
                        className="work",
                        **{"aria-label": "Drawing and results"},
                    ),
                ],
                className="desk",
            ),
        ]
    )


def _do(desk: TabSession, edits: object, act: object) -> None:
    """Apply edits, then the action of a button, each once."""
    try:
        for edit in edits if isinstance(edits, list) else ():
            if isinstance(edit, Mapping):
                desk.edit(edit)
        if not isinstance(act, Mapping) or not desk.fresh(number_of(act.get("number"))):
            return
        what, of, text = (str(act.get(name, ""))[:500] for name in ("do", "of", "text"))
        if what in _ACTS:
            _ACTS[what](desk, of, text)
    except TribodynError as error:
        desk.tell(str(error), bad=True)


def _view(desk: TabSession, of: str, _: str) -> None:
    desk.view, desk.topic = of, ""


def _topic(desk: TabSession, of: str, _: str) -> None:
    desk.topic = of


def _number(of: str) -> int:
    return int(of) if of.isascii() and of.isdigit() else -1


_ACTS: dict[str, Callable[[TabSession, str, str], None]] = {
    "view": _view,
    "topic": _topic,
    "run": lambda desk, of, text: desk.run(),
    "stop": lambda desk, of, text: desk.stop(_number(of)),
    "remove": lambda desk, of, text: desk.remove(_number(of)),
    "pick": lambda desk, of, text: desk.pick(_number(of)),
    "overlay": lambda desk, of, text: desk.overlay_runs(),
    "open": lambda desk, of, text: desk.open(of),
    "save": lambda desk, of, text: desk.save(text, force=False),
    "replace": lambda desk, of, text: desk.save(text, force=True),
    "save-job": lambda desk, of, text: desk.save_job(_number(of), text),
    "case-of": lambda desk, of, text: desk.case_of(_number(of)),
    "take-relief": lambda desk, of, text: desk.take_relief(_number(of)),
    "study": lambda desk, of, text: desk.choose_study(of),
    "start": lambda desk, of, text: desk.start_study(),
}


def _versions(desk: TabSession) -> Tree:
    """Version of each part of the page, which changes with its content."""
    job = desk.job_in_view
    jobs = [[j.number, j.state] for j in desk.all_jobs()]
    moving = [job.version, job.seconds] if job is not None and not job.ended else []
    at = [job.number, job.state, *moving] if job is not None else desk.edits
    return {
        "form": [desk.edits, desk.study],
        "rail": [desk.view, desk.picked, jobs],
        "tools": [desk.view, *([job.state, job.saved] if job else [])],
        "bench": [
            desk.view,
            desk.topic,
            at,
            desk.notice_count if desk.view == "files" else 0,
            jobs if desk.view == "script" else [],
            desk.study,
        ],
        "notice": desk.notice_count,
        "title": desk.edits,
    }


def _notice(desk: TabSession) -> Any:
    """Last message; its number makes a repeated text appear again."""
    if not desk.notice:
        return ""
    kind = "bad" if desk.bad else "good"
    return html.P(desk.notice, className=kind, **{"data-number": str(desk.notice_count)})


_DRAW: dict[str, Callable[[TabSession], Any]] = {
    "form": lambda desk: desk.forms(),
    "rail": results.rail,
    "tools": results.tools,
    "bench": results.bench,
    "notice": _notice,
    "title": lambda desk: desk.case.title,
}
