"""Layout of the case, results and studies on the page."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from dash import dcc, html

from tribodyn.app.script import script_of
from tribodyn.app.session import RUNS, TabSession
from tribodyn.app.studies import STUDIES, offered
from tribodyn.errors import InputError, TribodynError, collected
from tribodyn.report.figure_blocks import block_of_figure
from tribodyn.study.studies.needs import PAIRS, kind_of
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.app.jobs import Job
    from tribodyn.study.machine.case import MachineCase

#: Derived values of the geometry that are displayed as cards.
_FIRST = (
    "transverse_contact_ratio",
    "center_distance",
    "operating_pressure_angle",
    "backlash",
    "pitch_line_velocity",
    "line_load",
    "oil_viscosity",
    "gear_loss_factor",
)
#: Ends of the keys of figures of machines that are displayed as cards.
_OF_MACHINE = (
    *("machine.input_power", "machine.output_torque", "mesh_frequency"),
    *(".ratio", "planet_speed", "machine.clock_frequency", ".transverse_contact_ratio"),
)
_CONFIG = {
    "displaylogo": False,
    "responsive": True,
    "showSendToCloud": False,
    "plotlyServerURL": "",
    "modeBarButtons": [["toImage"], ["zoom2d", "pan2d"], ["resetScale2d"]],
    "toImageButtonOptions": {"format": "svg"},
}


def button(text: object, do: str, of: str = "", **more: object) -> html.Button:
    """Button with its action; ``more`` are attributes with underscores for dashes."""
    data = {name.replace("_", "-"): value for name, value in more.items() if "_" in name}
    plain = {name: value for name, value in more.items() if "_" not in name}
    return html.Button(text, type="button", **{"data-do": do, "data-of": of, **data}, **plain)


def graph(name: str, figure: Tree, title: str) -> html.Div:
    """Figure with a label for screen readers."""
    height = figure["layout"].get("height", 420)
    plot = dcc.Graph(figure=figure, config=_CONFIG, id=name, style={"height": f"{height}px"})
    return html.Div(plot, className="figure", role="group", **{"aria-label": title})


def table(head: list[str], rows: list[list[str]]) -> html.Div:
    """A table that may be wider than the page."""
    cells = [html.Tr([html.Td(cell) for cell in row]) for row in rows]
    top = html.Thead(html.Tr([html.Th(text, **{"aria-label": text or "key"}) for text in head]))
    return html.Div(html.Table([top, html.Tbody(cells)]), className="scroll", tabIndex="0")


def cards(rows: list[list[str]]) -> html.Div:
    """Key values as cards."""
    return html.Div(
        [
            html.Div(
                [html.P(label, className="name"), html.P([value, " ", html.Span(unit)])],
                className="card",
            )
            for label, value, unit in rows
        ],
        className="cards",
    )


def notice(heading: str, lines: list[str]) -> list[Any]:
    """Highlighted list of sentences; empty without any."""
    if not lines:
        return []
    items = html.Ul([html.Li(line) for line in lines])
    return [html.Div([html.H3(heading), items], className="notice")]


def rail(desk: TabSession) -> list[Any]:
    """Tabs of all views, and the list of runs."""
    name = getattr(desk.case, "kind", "Gear pair")
    views = [("pair", name), ("files", "Open and save"), ("studies", "Studies")]
    views.append(("script", "Python"))
    tabs = [_tab(desk, view, text) for view, text in views]
    for job in desk.all_jobs():
        tabs.append(_tab(desk, f"job-{job.number}", [job.title, _mark(job)]))
    parts = [html.Div(tabs, role="tablist", className="tabs", **{"aria-label": "Views"})]
    return [*parts, _runs(desk)] if desk.runs else parts


def _tab(desk: TabSession, view: str, text: object) -> html.Button:
    selected = desk.view == view
    more = {"aria_selected": str(selected).lower(), "aria_controls": "bench"}
    return button(text, "view", view, role="tab", id=f"tab-{view}", **more)


def _mark(job: Job) -> html.Span:
    return html.Span(job.state, className=f"state {job.state}")


def _runs(desk: TabSession) -> html.Div:
    """List of runs with the differences of their cases and the selection for the overlay."""
    rows = []
    for job in desk.runs:
        picked = job.number in desk.picked
        differences = ", ".join(desk.changes(job)) or (
            "as the first" if job is not desk.runs[0] else ""
        )
        more = {"aria_pressed": str(picked).lower(), "aria_label": f"Overlay {job.title}"}
        pick = button("✓" if picked else "+", "pick", str(job.number), **more, className="pick")
        rows.append(html.Li([pick, html.Strong(job.title), " ", html.Span(differences)]))
    ready = len(desk.picked) > 1
    over = button("Overlay runs", "overlay", className="plain", disabled=not ready)
    text = f"{len(desk.runs)} of at most {RUNS} runs; select two or more with +."
    return html.Div([html.Ul(rows), html.P([over, " ", html.Span(text)])], className="runs")


def pair(desk: TabSession) -> list[Any]:
    """Drawing and derived values of the current case."""
    from tribodyn.report.numbers import describe
    from tribodyn.study.pipeline.assembly import geometry
    from tribodyn.study.pipeline.cautions import case_cautions
    from tribodyn.study.pipeline.preview import operating_figures

    case: Any = desk.case
    if kind_of(case) not in PAIRS:
        return _parts(desk, case)
    with collected():
        figures = {n: float(v) for n, v in (geometry(case) | operating_figures(case)).items()}
        cautions = [str(caution) for caution in case_cautions(case)]
    numbers = [describe(name, value) for name, value in figures.items()]
    first = [describe(name, figures[name], digits=4) for name in _FIRST if name in figures]
    rows = [[n.label, f"{n.value} {n.unit}".strip(), n.meaning] for n in numbers]
    every = [html.Summary(f"All derived values ({len(rows)})")]
    every.append(table(["Quantity", "Value", "Meaning"], rows))
    parts = [
        cards([[n.label, n.value, n.unit] for n in first]),
        *notice("Warnings", cautions),
        *_drawing(case),
        html.Details(every, className="block"),
    ]
    return [*_outdated(desk), html.Div(parts, className="outdated" if desk.faults else "")]


def _parts(desk: TabSession, case: MachineCase) -> list[Any]:
    """View, speeds, torques and assumptions of the current machine."""
    from tribodyn import plot
    from tribodyn.report.numbers import describe
    from tribodyn.study.machine.first_look import kinematic_figures, warn_of_gears, warn_of_motion

    with collected() as warnings:
        machine = case.machine()
        warn_of_motion(case.solver, machine)
        warn_of_gears(case)
        values = kinematic_figures(case)
    alone = case.lone_stage is not None
    flat = (plot.planetary_stage, case) if alone else (plot.machine, machine)
    numbers = [describe(name, value) for name, value in values.items()]
    rows = [[n.label, f"{n.value} {n.unit}".strip(), n.meaning] for n in numbers]
    first = [describe(n, value, 4) for n, value in values.items() if n.endswith(_OF_MACHINE)]
    every = [html.Summary(f"All speeds, torques and powers ({len(rows)})")]
    every.append(table(["Quantity", "Value", "Meaning"], rows))
    assumed = [[a.key, a.value or "", a.reason or ""] for a in case.assumptions]
    notes = [html.Summary(f"Assumed ({len(assumed)})"), table(["Key", "Value", "Reason"], assumed)]
    parts = [
        cards([[n.label, n.value, n.unit] for n in first]),
        *notice("Warnings", [str(warning) for warning in warnings]),
        *(_sketched(*picture) for picture in (flat, (plot.machine_space, machine))),
        html.Details(every, className="block"),
        *([html.Details(notes, className="block")] if assumed else []),
    ]
    return [*_outdated(desk), html.Div(parts, className="outdated" if desk.faults else "")]


def _outdated(desk: TabSession) -> list[Any]:
    """Notice that drawing and values do not match the form while it has an invalid value."""
    if not desk.faults:
        return []
    labels = ", ".join(dict.fromkeys(fault["label"] or "Case" for fault in desk.faults))
    line = f"They belong to the last valid case. To update them, correct: {labels}."
    return notice("Drawing and figures are out of date", [line])


def _drawing(case: Any) -> list[Any]:
    from tribodyn import plot

    try:
        flanks = case.hypoid_flanks
        figure = plot.gear_pair if flanks is None else plot.hypoid_pair
        return [_sketched(figure, case.gear_pair if flanks is None else flanks)]
    except InputError as error:
        return [html.Div(html.P(error.problems[0].what), className="block")]


def _sketched(figure: Any, subject: Any) -> html.Section:
    """Block of a figure of the current case."""
    caption = figure.caption_of(subject)
    block = block_of_figure(figure.name, figure.heading, figure.sketch(subject), caption)
    return _block(block.__dict__, f"pair-{figure.name}", json.loads(block.json))


def _section(heading: str, *inner: object, of: str = "") -> html.Section:
    return html.Section([html.H3(heading), *inner], className=f"block {of}".rstrip())


def _block(block: Any, name: str, figure: Any) -> html.Section:
    inner: list[Any] = [html.H3(block["heading"])]
    if block["missing"]:
        inner.append(html.P(block["missing"], className="missing"))
    else:
        title = block["title"] or block["heading"]
        inner += [html.P(block["title"], className="answer"), graph(name, figure, title)]
        inner.append(html.P(block["caption"], className="caption"))
    return html.Section(inner, className="block", id=f"block-{name}")


def result(desk: TabSession, job: Job) -> list[Any]:
    """Progress, failure or results of a job."""
    if job.state in ("waiting", "running"):
        return [_progress(job)]
    if job.state != "done":
        lines = job.problems or ["It was stopped."]
        return notice(f"{job.title} {job.state}", lines)
    topics = _topics(job.content)
    topic = desk.topic if desk.topic in topics else next(iter(topics))
    tabs = [_topic_tab(name, topic) for name in topics]
    head = _overview(job.content) if topic == next(iter(topics)) else []
    return [
        html.Div(tabs, role="tablist", className="tabs topics", **{"aria-label": "Results"}),
        html.Div([*head, *(_part(job, each) for each in topics[topic])], role="tabpanel"),
    ]


def _topic_tab(name: str, chosen: str) -> html.Button:
    return button(name, "topic", name, role="tab", aria_selected=str(name == chosen).lower())


def _overview(content: Tree) -> list[Any]:
    """Cards, statements and warnings at the top of a result."""
    return [
        *([cards(content["cards"])] if content.get("cards") else []),
        *notice("Results", content.get("sentences", [])),
        *notice("Warnings", content.get("warnings", [])),
    ]


def _topics(content: Tree) -> dict[str, list[Any]]:
    """Overview, figures by topic, and tables of a result."""
    blocks = content.get("blocks", [])
    figures = [block for block in blocks if not block["missing"]]
    topics: dict[str, list[Any]] = {"Overview": figures}
    if "cards" in content:  # of a run: the mesh force, or the picture of the machine
        forces = [block for block in figures if block["name"] == "mesh_force"]
        topics["Overview"] = forces or figures[:1]
        for block in blocks:
            topics.setdefault(block["topic"], []).append(block)
    for topic, head, rows, *title in content.get("tables", []):
        heading = (title or [""])[0] or topic
        topics.setdefault(topic, []).append({"heading": heading, "head": head, "rows": rows})
    return topics


def _part(job: Job, part: Tree) -> html.Section:
    if "rows" in part:
        return _section(part["heading"], table(part["head"], part["rows"]))
    figure = None if part["missing"] else job.figure(part["name"])
    return _block(part, f"job-{job.number}-{part['name']}", figure)


def _progress(job: Job) -> html.Div:
    has_total = job.total is not None and job.total > 0
    text = job.task or ("Waiting for a free place" if job.state == "waiting" else "Beginning")
    count = f"{min(job.done, job.total or 0)} of {job.total}" if has_total else ""
    bar = {"value": str(job.done), "max": str(job.total)} if has_total else {}
    line = [html.Strong(text), " ", html.Span(count), " ", html.Span(f"{job.seconds} s")]
    return html.Div(
        [
            html.P(line),
            html.Progress(**bar, **{"aria-label": f"{job.title}: {text}"}),
            html.P(button("Stop", "stop", str(job.number), id="stop")),
        ],
        className="block progress",
    )


def tools(desk: TabSession) -> list[Any]:
    """Actions for the job in view."""
    job = desk.job_in_view
    if job is None or not job.ended:
        return []
    number, parts = str(job.number), []
    if job.saved:
        label = html.Label("Save the files of it as folder", htmlFor="result-name")
        field = dcc.Input(
            id="result-name", value=_folder_name(desk, job), type="text", autoComplete="off"
        )
        more = {"data_from": "result-name", "className": "plain"}
        parts += [label, field, button("Save files", "save-job", number, **more)]
        parts.append(html.A("Report", href=f"report/{number}", target="_blank"))
    elif job.state == "done" and job.kind != "overlay":
        parts.append(html.Span("The files are being written …"))
    if job.state == "done" and job.content.get("relief"):
        what = "relief" if any(".tip_relief" in key for key in job.content["relief"]) else "lead"
        text = f"Take this {what} into my case"
        parts.append(button(text, "take-relief", number, className="main"))
    if job.kind == "run":
        parts.append(button("Edit its case", "case-of", number, className="plain"))
    parts.append(button(f"Remove {job.title}", "remove", number, className="plain"))
    return [html.Div(parts, className="tools")]


def _folder_name(desk: TabSession, job: Job) -> str:
    stem = desk.name.removesuffix(".toml") or "my-gears"
    return f"{stem}-{job.title.lower().replace(' ', '-')}"


def files(desk: TabSession) -> list[Any]:
    """Cases to open, and the form to save this one."""
    from tribodyn.cases.catalogue import cases

    case_names = desk.folder.cases()
    links = [html.Li(button(name, "open", f"file:{name}", className="link")) for name in case_names]
    built = [
        html.Li([button(name, "open", f"case:{name}", className="link"), " ", html.Span(title)])
        for name, title in cases(machines=True).items()
    ]
    name = dcc.Input(id="case-name", value=desk.name or "my-gears.toml", autoComplete="off")
    write = button("Save", "save", id="save", data_from="case-name")
    over = button("Replace", "replace", data_from="case-name", className="plain")
    save = [html.Label("File", htmlFor="case-name"), " ", name, " ", write, " ", over]
    where = f"In the folder {desk.folder.root}"
    new = button("A short case to fill in", "open", "new:", className="plain")
    empty = html.P(f"There is no case file in {desk.folder.root.name} yet.", className="missing")
    return [
        _section("Save this case", html.P(save), html.P(where, className="caption"), of="tools"),
        _section("Open a case of the folder", html.Ul(links) if links else empty),
        _section("Built-in cases", html.Ul(built)),
        _section("New case", html.P(new)),
    ]


def studies(desk: TabSession) -> list[Any]:
    """Kinds of studies, and the form of the selected one."""
    kinds = [
        html.Li(
            [
                button(study.title, "study", kind, aria_pressed=str(kind == desk.study).lower()),
                html.Span(study.meaning),
            ]
        )
        for kind, study in STUDIES.items()
        if offered(kind, desk.case)
    ]
    parts: list[Any] = [_section("Studies", html.Ul(kinds), of="kinds")]
    if desk.study:
        start = button(f"Start: {STUDIES[desk.study].title}", "start", id="start", className="main")
        form = [html.Div(id="study-form"), html.P(start)]
        parts.append(html.Section(form, className="block", **{"aria-label": "Values of the study"}))
    return parts


def script(desk: TabSession) -> list[Any]:
    """What was done in this tab as a Python script."""
    text = "What was done here, as a Python script; run it in the folder "
    link = html.A("Download", href="script.py", download="tribodyn-page.py", className="link")
    head = [
        html.H3("As a Python script"),
        html.P([text, html.Code(str(desk.folder.root)), ". ", link]),
    ]
    code = html.Pre(script_of(desk), id="script", tabIndex="0")
    return [html.Section([*head, code], className="block")]


def bench(desk: TabSession) -> list[Any]:
    """The current view, or the reason why it cannot be displayed."""
    if desk.view in ("files", "studies"):
        return files(desk) if desk.view == "files" else studies(desk)
    job = desk.job_in_view
    try:
        if desk.view == "script":
            return script(desk)
        return pair(desk) if job is None else result(desk, job)
    except TribodynError as error:
        return notice("This cannot be displayed", [str(problem) for problem in error.problems])
