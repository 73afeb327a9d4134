"""The commands by name; each is loaded only when it is called."""

from __future__ import annotations

from typing import Annotated, Any

from cyclopts import App, Parameter

import tribodyn

WELCOME = """\
tribodyn: from gear and lubricant data to tooth contact, friction and vibration.

  tribodyn new my.toml      write a case file to start from, and fill in your gears
  tribodyn check my.toml    see the geometry, and every error at once
  tribodyn run my.toml      compute it, and write the report

tribodyn --help shows all commands."""

#: Command, its function within ``commands``, and one line of help.
COMMANDS = (
    ("cases", "case_commands:cases", "List the built-in cases."),
    ("app", "app_command:app", "Serve a page in the browser for the whole job."),
    ("run", "run_command:run", "Compute a case and write its report."),
    ("sweep", "sweep_command:sweep", "Compute a case at many values of its keys."),
    (
        "ensemble",
        "ensemble_command:ensemble",
        "Compute many variants of a case with spread inputs, and draw bands.",
    ),
    (
        "bifurcation",
        "nonlinear_commands:bifurcation",
        "Follow the motion of a case over one value.",
    ),
    (
        "continuation",
        "nonlinear_commands:continuation",
        "Follow the periodic motion of a case over one value, stable or not.",
    ),
    (
        "basins",
        "nonlinear_commands:basins",
        "Find which motion of a case a disturbed start comes to.",
    ),
    (
        "lyapunov",
        "nonlinear_commands:lyapunov",
        "Find the Lyapunov exponents of a case: whether it is chaos.",
    ),
    (
        "sobol",
        "ensemble_command:sobol",
        "Find which tolerance of a case the spread of its figures comes from.",
    ),
    (
        "study",
        "study_command:study",
        "Compute many runs of a case into a store, here or on a cluster.",
    ),
    ("modes", "study_commands:modes", "Find natural frequencies and critical speeds of a case."),
    ("harris", "study_commands:harris", "Find the static transmission error over the torque."),
    ("relief", "study_commands:relief", "Find the best tip relief of a case."),
    ("run-up", "study_commands:run_up", "Integrate a case in time while its speed rises."),
    (
        "losses",
        "losses_commands:losses",
        "Find losses and efficiency of a case over torque and speed.",
    ),
    (
        "friction-from-loss",
        "losses_commands:friction_from_loss",
        "Find friction coefficients from measured torque losses.",
    ),
    (
        "experiment",
        "experiment_command:experiment",
        "Judge published claims on one gear pair: friction.",
    ),
    (
        "surrogate",
        "surrogate_command:surrogate",
        "Learn the steady response of a case, and predict it at once.",
    ),
    (
        "paper",
        "experiment_command:paper",
        "Compare the printed tables of a source with computed figures.",
    ),
    ("compare", "compare_command:compare", "Show what differs between two results."),
    (
        "recording",
        "recordings.recording_command:recording",
        "Record what a sensor sees of a case with faults, or a labelled set.",
    ),
    (
        "signal",
        "signal_command:signal",
        "List the channels of a recording, or analyse one: spectra, orders, indicators.",
    ),
    ("check", "case_commands:check", "Check a case and show its geometry."),
    (
        "import",
        "exchange_commands:import_",
        "List a gearbox model of another program (REXS), and make a case of it.",
    ),
    (
        "export",
        "exchange_commands:export",
        "Write a case for other gear programs (REXS), or the tables of a result.",
    ),
    ("new", "case_commands:new", "Write a commented case file to start from."),
    (
        "cookbook",
        "explain_commands:cookbook",
        "Print a short script for a common task, or list all of them.",
    ),
    ("explain", "explain_commands:explain", "Explain a symbol, key, model or warning."),
    ("units", "explain_commands:units", "List the units and their spellings."),
    ("warm-up", "run_command:warm_up", "Compile what runs need, ahead of the first one."),
    ("cite", "explain_commands:cite", "Print the papers behind a result."),
)


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
        help="Gear tribo-dynamics: tooth contact, friction, stiffness and vibration.",
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
    for name, place, help_text in COMMANDS:
        app.command(f"tribodyn.cli.commands.{place}", name=name, help=help_text)
    return app
