"""The commands by name; each is loaded only when it is called."""

from __future__ import annotations

from keyword import iskeyword
from typing import Annotated, Any, NamedTuple

from cyclopts import App, Parameter

import tribodyn
from tribodyn.scope import statement
from tribodyn.study.studies.needs import help_line

WELCOME = """\
tribodyn: from gear and lubricant data to tooth contact, friction and vibration.

  tribodyn new my.toml      write a case file to start from, and fill in your gears
  tribodyn check my.toml    see the geometry, and every error at once
  tribodyn run my.toml      compute it, and write the report

tribodyn --help shows all commands."""


class Command(NamedTuple):
    """A command and its module within ``commands``."""

    name: str
    module: str
    help: str  #: one line
    example: str = ""  #: what to write after it


COMMANDS = (
    Command("cases", "case_commands", "List the built-in cases."),
    Command("app", "run_command", "Serve a page in the browser for the whole job.",
            "fzg-roughness"),
    Command("run", "run_command", "Compute a case and write its report.", "fzg-roughness"),
    Command("sweep", "sweep_commands", "Compute a case at many values of its keys.",
            'fzg-roughness "operation.speed=400..3500 rpm:60"'),
    Command("ensemble", "sweep_commands",
            "Compute many variants of a case with spread inputs, and draw bands.",
            'fzg-roughness --set "operation.torque=150 N*m +- 2 %"'),
    Command("bifurcation", "nonlinear_commands", "Follow the motion of a case over one value.",
            'fzg-roughness "operation.speed=400..3500 rpm:300"'),
    Command("continuation", "nonlinear_commands",
            "Follow the periodic motion of a case over one value, stable or not.",
            'fzg-roughness "operation.speed=400..3500 rpm"'),
    Command("basins", "nonlinear_commands",
            "Find which motion of a case a disturbed start comes to.", "fzg-roughness"),
    Command("lyapunov", "nonlinear_commands",
            "Find the Lyapunov exponents of a case: whether it is chaos.", "fzg-roughness"),
    Command("sobol", "sweep_commands",
            "Find which tolerance of a case the spread of its figures comes from.",
            'fzg-roughness peak_mesh_force --set "operation.torque=150 N*m +- 2 %"'),
    Command("study", "sweep_commands",
            "Compute many runs of a case into a store, here or on a cluster.", "study.toml"),
    Command("rate", "study_commands",
            "Rate the gears of a case by ISO 6336: pitting, bending, scuffing, micropitting.",
            "rated.toml"),
    Command("frequencies", "case_commands",
            "List the frequencies of shafts, meshes, bearings and planets.", "two-stage-spur"),
    Command("modes", "study_commands", "Find natural frequencies and critical speeds of a case.",
            "fzg-roughness"),
    Command("harris", "study_commands", "Find the static transmission error over the torque.",
            "fzg-roughness"),
    Command("relief", "study_commands", "Find the best tip relief of a case.", "fzg-roughness"),
    Command("lead", "study_commands", "Find the best crowning and lead slope of a case.",
            "helical-pair"),
    Command("run-up", "study_commands", "Integrate a case in time while its speed rises.",
            'fzg-roughness "400..3500 rpm"'),
    Command("losses", "study_commands",
            "Find losses and efficiency of a case over torque and speed.", "fzg-roughness"),
    Command("friction-from-loss", "study_commands",
            "Find friction coefficients from measured torque losses.",
            "losses.csv --case fzg-roughness"),
    Command("experiment", "experiment_command",
            "Judge published claims on one gear pair: friction.", "friction"),
    Command("surrogate", "surrogate_command",
            "Learn the steady response of a case, and predict it at once.", "train fzg-roughness"),
    Command("paper", "experiment_command",
            "Compare the printed tables of a source with computed figures."),
    Command("compare", "recording_commands", "Show what differs between two results.",
            "first second"),
    Command("recording", "recording_commands",
            "Record what a sensor sees of a case with faults, or a labelled set.",
            "fzg-roughness --sensor pinion_y --out rig.mat"),
    Command("signal", "signal_command",
            "List the channels of a recording, or analyse one: spectra, orders, indicators.",
            "rig.csv --channel acc --tacho pulses --pulses 60 --teeth 29"),
    Command("check", "case_commands", "Check a case and show its geometry.", "fzg-roughness"),
    Command("import", "exchange_commands",
            "List a gearbox model of another program (REXS), and make a case of it.",
            "gearbox.rexs --out my.toml"),
    Command("export", "exchange_commands",
            "Write a case for other gear programs (REXS), or the tables of a result.",
            "fzg-roughness --rexs gearbox.rexs"),
    Command("new", "case_commands", "Write a commented case file to start from.", "my.toml"),
    Command("cookbook", "explain_commands",
            "Print a short script for a common task, or list all of them."),
    Command("explain", "explain_commands", "Explain a symbol, key, model or warning.",
            "epsilon_alpha"),
    Command("units", "explain_commands", "List the units and their spellings."),
    Command("warm-up", "run_command", "Compile what runs need, ahead of the first one.",
            "fzg-roughness"),
    Command("cite", "explain_commands", "Print the papers behind a result.", "fzg-roughness"),
)  # fmt: skip


def _welcome(*, json: Annotated[bool, Parameter(negative="")] = False) -> None:
    """Show three next steps.

    Parameters
    ----------
    json : bool
        Write one JSON object to stdout.
    """
    from tribodyn.cli.console import say, say_json

    steps = [line.split("  ")[1].strip() for line in WELCOME.splitlines() if line[:2] == "  "]
    if json:
        say_json({"next_steps": steps})
    else:
        say(WELCOME)


class _Help:
    """Help as cyclopts draws it, with the lines of a docstring joined and wrapped by the screen."""

    def __call__(self, console: Any, options: Any, panel: Any) -> None:
        from cyclopts.help import DefaultFormatter
        from rich.text import Text

        for entry in panel.entries:
            description = getattr(entry.description, "primary_renderable", None)
            if isinstance(description, Text):
                entry.description.primary_renderable = Text(" ".join(description.plain.split()))
        DefaultFormatter()(console, options, panel)

    def render_usage(self, console: Any, options: Any, usage: Any) -> None:
        """Draw the line of usage."""
        from cyclopts.help import DefaultFormatter

        DefaultFormatter().render_usage(console, options, usage)

    def render_description(self, console: Any, options: Any, description: Any) -> None:
        """Draw what a command is for."""
        from cyclopts.help import DefaultFormatter

        DefaultFormatter().render_description(console, options, description)


def make_app() -> App:
    """Build the command line; nothing heavy is imported."""
    app = App(
        name="tribodyn",
        help=f"Gear tribo-dynamics: {statement('summary')}. Gears: {statement('gears')}.",
        version=tribodyn.__version__,
        version_flags=["--version"],
        suppress_keyboard_interrupt=False,
        result_action="return_value",
        help_format="plaintext",
        help_formatter=_Help(),
    )
    app.default(_welcome)
    app.register_install_completion_command(
        help="Let the shell complete commands and options: bash, zsh or fish."
    )
    for each in COMMANDS:
        text = each.help + help_line(each.name)
        function = each.name.replace("-", "_") + "_" * iskeyword(each.name)
        place = f"tribodyn.cli.commands.{each.module}:{function}"
        app.command(place, name=each.name, help=text)
    return app
