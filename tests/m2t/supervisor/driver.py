"""A program around a generated engine that executes a script and says after each line what came of it."""

import subprocess
from collections.abc import Sequence
from pathlib import Path
from unittest.mock import patch

from robosc.language.configuration import ControlLoop
from robosc.m2m import sct_to_engine
from robosc.m2t.c import engine
from robosc.m2t.c.names import CNames
from robosc.model import expression as ex
from robosc.model import sct

FLAGS = ("-O0", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
#: What a user of the engine is promised to draw no warning.
STRICT = ("-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Wpedantic", "-Werror")

_PROGRAM = """\
#include "%(p)s_supervisor.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool withheld[%(u)s_EVENT_COUNT + 1];

static bool before(void *context, %(p)s_event event)
{
    (void)context;
    return !withheld[event];
}

static void after(void *context, %(p)s_event event)
{
    (void)context;
    printf(" %%s", %(p)s_event_name(event));
}

static void livelock(void *context)
{
    printf(" livelock%%s", (const char *)context);
}

static %(p)s_event event(void)
{
    char name[200];
    int number = 0;
    if (scanf(" %%199s", name) != 1) abort();
    while (strcmp(name, %(p)s_event_name((%(p)s_event)number)) != 0) {
        if (number++ == %(u)s_EVENT_COUNT) abort();
    }
    return (%(p)s_event)number;
}

static void set(%(p)s_supervisor *robot)
{
    unsigned value;
    int number;
    if (scanf(" %%d %%u", &number, &value) != 2) abort();
    switch (number) {
%(settings_set)s
    default: (void)robot; abort();
    }
}

static void input(%(p)s_supervisor *robot)
{
    long long value;
    int number;
    if (scanf(" %%d %%lld", &number, &value) != 2) abort();
    switch (number) {
%(inputs)s
    default: abort();
    }
}

int main(int arguments, char **argument)
{
    %(p)s_supervisor robot;
    unsigned now = arguments > 1 ? (unsigned)strtoul(argument[1], NULL, 10) : 0U;
    %(p)s_hooks hooks = { "!", before, after, livelock };
    char command[20];
    int result = 0;
    %(settings)s
    %(p)s_init(&robot, %(chosen)s, &hooks%(now)s);
    while (scanf(" %%19s", command) == 1) {
        if (strcmp(command, "input") == 0) { input(&robot); continue; }
        if (strcmp(command, "set") == 0) { set(&robot); continue; }
        if (strcmp(command, "withhold") == 0) { %(p)s_event e = event(); withheld[e] = !withheld[e]; continue; }
        if (strcmp(command, "now") == 0) { if (scanf(" %%u", &now) != 1) abort(); continue; }
        printf("%%s:", command);
        result = 0;
        if (strcmp(command, "perform") == 0) result = %(p)s_perform(&robot, event()%(now)s);
        else if (strcmp(command, "begin") == 0) %(p)s_begin(&robot%(now)s);
        else if (strcmp(command, "end") == 0) %(p)s_end(&robot%(now)s);
        else if (strcmp(command, "tick") == 0) %(p)s_tick(&robot%(now)s);
        else if (strcmp(command, "settle") == 0) %(p)s_settle(&robot%(now)s);
%(expire)s        else abort();
        printf(" = %%d;%(waits)s", result%(wait)s);
%(state)s
        printf(";");
        for (int e = 0; e < %(u)s_EVENT_COUNT; ++e) {
            if (%(p)s_enabled(&robot, (%(p)s_event)e)) printf(" %%s", %(p)s_event_name((%(p)s_event)e));
        }
        printf("\\n");
    }
    return 0;
}
"""


def program(model: sct.SupervisoryControlModel) -> str:
    """The source of the program."""
    names = CNames(model)
    values = []
    for plant in model.plants:
        if len(plant.locations) > 1:
            values.append(f'printf(" %s", {names.lookup(plant)}(robot.state.{names.member(plant)}));')
        for variable in plant.variables:
            member = f"robot.state.{names.member(variable)}"
            if isinstance(variable.type, ex.EnumerationType):
                values.append(f'printf(" %s", {names.lookup(variable.type.enumeration)}({member}));')
            else:
                values.append(f'printf(" %lld", (long long){member});')
    inputs = [f"robot->inputs.{names.member(input_)}" for plant in model.plants for input_ in plant.inputs]
    timed = any(event.timer for plant in model.plants for event in plant.events)
    supervisor = names.prefix
    return _PROGRAM % {
        "now": ", now" if timed else "",
        "settings": f"{supervisor}_settings chosen = {supervisor}_default_settings; chosen.resolution_ms = 0;" * timed
        or "(void)now;",
        "chosen": "&chosen" if timed else "NULL",
        "expire": f'        else if (strcmp(command, "expire") == 0) result = {supervisor}_expire(&robot, now);\n'
        * timed,
        "waits": " %%u;".replace("%%", "%") * timed,
        "wait": f", {supervisor}_wait(&robot, now)" * timed,
        "p": names.prefix,
        "u": names.macro,
        "state": "\n".join(f"        {value}" for value in values),
        "settings_set": "\n".join(
            f"    case {number}: robot->settings.{names.setting(duration)} = value; break;"
            for number, duration in enumerate(model.durations)
        ),
        "inputs": "\n".join(
            f"    case {number}: {member} = (__typeof__({member}))value; break;" for number, member in enumerate(inputs)
        ),
    }


def write(
    model: sct.SupervisoryControlModel,
    folder: Path,
    settings: ControlLoop | None = None,
    *,
    small: int = sct_to_engine.POLLED,
) -> Path:
    """Writes header and source; returns the source. With `small=0` the control loop is that of a large robot."""
    with patch.object(sct_to_engine, "POLLED", small):
        files = engine.generate(sct_to_engine.transform(model), settings or ControlLoop())
    for name, text in files.items():
        (folder / name).write_text(text)
    return folder / f"{CNames(model).prefix}_supervisor.c"


def build(
    model: sct.SupervisoryControlModel,
    folder: Path,
    settings: ControlLoop | None = None,
    *,
    small: int = sct_to_engine.POLLED,
) -> Path:
    """Compiles engine and program, the engine without a warning."""
    source, main, built = write(model, folder, settings, small=small), folder / "main.c", folder / "main"
    main.write_text(program(model))
    compiled = folder / "engine.o"
    for arguments in (
        [*STRICT, "-c", str(source), "-o", str(compiled)],
        ["-std=gnu99", str(main), str(compiled), "-o", str(built)],
    ):
        done = subprocess.run(["gcc", *FLAGS, *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    return built


def run(built: Path, script: Sequence[str], *arguments: str) -> list[str]:
    """What the program says, a line for each operation of the script."""
    command = [built, *arguments]
    done = subprocess.run(command, input="\n".join(script), capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()
