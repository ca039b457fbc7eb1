"""Options and arguments that several commands share."""

import click

#: A file that must be there.
FILE = click.Path(exists=True, dir_okay=False, readable=True)

model = click.argument("model", type=FILE)

library_path = click.option(
    "-I",
    "--library-path",
    "library_paths",
    multiple=True,
    type=click.Path(exists=True, file_okay=False),
    help="A folder with libraries, searched after the model's own; may be repeated. Then come those in ROBOSC_PATH.",
)

interface_path = click.option(
    "--interface-path",
    "interface_paths",
    multiple=True,
    type=click.Path(exists=True, file_okay=False),
    help="A folder with ROS packages below it, searched for .msg, .srv and .action files; may be repeated."
    " Then come those in ROBOSC_INTERFACE_PATH.",
)

findings_format = click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json", "sarif"]),
    default="text",
    show_default=True,
    help="How findings are shown.",
)

memory = click.option(
    "--memory",
    "megabytes",
    type=click.IntRange(min=1),
    metavar="MB",
    default=4096,
    show_default=True,
    help="The most memory for synthesis and generating, in megabytes of 2^20 bytes.",
)
