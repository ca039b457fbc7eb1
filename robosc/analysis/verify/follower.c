/* Executes the operations in its input with a generated control loop, and prints the results.
 *
 * A result consists of the letter of the operation, the events that happened, whether the requested event happened, the
 * time of the next expiry in models with timers, and the state after the operation. `k` ends the line:
 *
 *     n EVENTS REACTIONS REACT RESOLUTION NOW   starts again with these settings
 *     p EVENT   b   e   t   s   x   r   performs; begins, ends a batch; ticks; settles; expires, restarts timers
 *     i INPUT CODE   w EVENT   d DURATION MILLISECONDS   c NOW   sets values that hold from now on
 *     v COMMAND INPUT CODE   sets an input that the hook `before` sets right before the command, from now on
 *     k   saves the loop and prints its number, and the number of the first equal one
 *     g NUMBER   restores that loop
 *
 * Two loops are equal if all their bytes are, with times relative to now. A value is printed as its code: its distance
 * from the least value, or the position of a location or literal.
 */
#ifndef _WIN32
#define _POSIX_C_SOURCE 200809L
#include <unistd.h>
#endif
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h" /* Declarations for the model, as in `explorer.c`. */

#ifdef TIMES
static uint32_t now;
#define NOW , now
#else
#define NOW
#endif

#ifndef PATIENCE
#define PATIENCE 120 /* Maximum duration of an operation in seconds; a longer one counts as an endless loop. */
#endif

typedef struct moment {
    ENGINE(supervisor) loop;
    uint32_t now;
} moment;

static const char *const names[EVENTS + 1] = { EVENT_NAMES "" };
static ENGINE(event) events[EVENTS + 1];
static uint64_t chosen[INPUTS + 1], sent[INPUTS + 1];
static unsigned command[INPUTS + 1]; /* One more than the command whose hook sets the input; 0 for none. */
static bool withheld[ENGINE_EVENTS + 1];
static ENGINE(supervisor) robot;
static moment *moments;
static size_t count, room, places;
static size_t *table; /* One more than the number of a moment; 0 marks a free place. */

#define GET_CELL(place, member, least) printf(" %" PRIu64, (uint64_t)(int64_t)robot.state.member - UINT64_C(least));
#define SET_DURATION(place, member) if (duration == (place)) robot.settings.member = milliseconds;
#define PUT_INPUT(place, member, least) robot.inputs.member = (int64_t)(chosen[place] + UINT64_C(least));

static void put_inputs(void)
{
    FOR_INPUTS(PUT_INPUT)
}

static uint64_t number(void)
{
    uint64_t value;
    if (scanf("%" SCNu64, &value) != 1) {
        exit(1);
    }
    return value;
}

static bool before(void *context, ENGINE(event) event)
{
    (void)context;
    if (withheld[event]) {
        return false;
    }
    bool has_data = false;
    for (unsigned input = 0U; input < INPUTS; ++input) {
        if (command[input] == (unsigned)event + 1U) {
            chosen[input] = sent[input];
            has_data = true;
        }
    }
    if (has_data) {
        put_inputs();
    }
    return true;
}

static void after(void *context, ENGINE(event) event)
{
    (void)context;
    unsigned happened = 0U;
    while (happened < EVENTS && events[happened] != event) {
        ++happened;
    }
    printf(" %u", happened);
}

static void livelock(void *context)
{
    (void)context;
    printf(" !");
}

/* ---- Saved loops ---- */

/* A loop in the form for comparison: at the time 0. */
static void compared(const moment *one, ENGINE(supervisor) *loop)
{
    memcpy(loop, &one->loop, sizeof *loop);
#ifdef TIMES
    memset(loop->up, 0, sizeof loop->up);
    memset(loop->running, 0, sizeof loop->running);
    for (unsigned place = 0U; place < loop->runs; ++place) {
        const unsigned timer = loop->running[place] = one->loop.running[place];
        loop->up[timer] = one->loop.up[timer] - one->now;
    }
    loop->now -= one->now;
#endif
}

static size_t place_of(const moment *wanted)
{
    static ENGINE(supervisor) loop, other;
    uint64_t hash = UINT64_C(0xCBF29CE484222325); /* FNV-1a */
    compared(wanted, &loop);
    for (size_t byte = 0U; byte < sizeof loop; ++byte) {
        hash = (hash ^ ((const unsigned char *)&loop)[byte]) * UINT64_C(0x100000001B3);
    }
    size_t place = (size_t)(hash ^ hash >> 32) & (places - 1U);
    while (table[place] != 0U) {
        compared(&moments[table[place] - 1U], &other);
        if (memcmp(&loop, &other, sizeof loop) == 0) {
            break;
        }
        place = (place + 1U) & (places - 1U);
    }
    return place;
}

static void *enough(void *memory)
{
    if (memory == NULL) {
        fputs("out of memory\n", stderr);
        exit(1);
    }
    return memory;
}

static void keep(void)
{
    memset(chosen, 0, sizeof chosen);
    put_inputs();
    if (count == room) {
        room = room == 0U ? 256U : 2U * room;
        places = 4U * room;
        moments = enough(realloc(moments, room * sizeof *moments));
        free(table);
        table = enough(calloc(places, sizeof *table));
        for (size_t index = 0U; index < count; ++index) {
            const size_t place = place_of(&moments[index]);
            table[place] = table[place] == 0U ? index + 1U : table[place];
        }
    }
    moment *one = &moments[count];
    memset(one, 0, sizeof *one);
    memcpy(&one->loop, &robot, sizeof robot);
#ifdef TIMES
    one->now = now;
#endif
    const size_t place = place_of(one);
    if (table[place] == 0U) {
        table[place] = count + 1U;
    }
    printf(" %zu %zu\n", count, table[place] - 1U);
    ++count;
    fflush(stdout);
}

/* ---- Operations ---- */

static void begin(void)
{
    const ENGINE(hooks) hooks = { NULL, before, after, livelock };
    ENGINE(settings) settings = ENGINE(default_settings);
    settings.events_per_tick = (uint16_t)number();
    settings.reactions_per_tick = (uint16_t)number();
    settings.react_immediately = number() != 0U;
    const uint64_t resolution = number(), start = number();
    (void)resolution;
    (void)start;
#ifdef TIMES
    settings.resolution_ms = (uint8_t)resolution;
    now = (uint32_t)start;
#endif
    memset(&robot, 0, sizeof robot);
    memset(withheld, 0, sizeof withheld);
    ENGINE(init)(&robot, &settings, &hooks NOW);
}

static void go_back(void)
{
    const moment *one = &moments[number()];
    memcpy(&robot, &one->loop, sizeof robot);
#ifdef TIMES
    now = one->now;
#endif
}

static void operate(char operation)
{
    bool result = false;
    printf("%c", operation);
    switch (operation) {
    case 'p':
        result = ENGINE(perform)(&robot, events[number()] NOW);
        break;
    case 'b':
        ENGINE(begin)(&robot NOW);
        break;
    case 'e':
        ENGINE(end)(&robot NOW);
        break;
    case 't':
        ENGINE(tick)(&robot NOW);
        break;
#ifdef TIMES
    case 'x':
        result = ENGINE(expire)(&robot, now);
        break;
    case 'r':
        ENGINE(restart)(&robot, now);
        break;
#endif
    default:
        ENGINE(settle)(&robot NOW);
        break;
    }
    printf(" = %d", result);
#ifdef TIMES
    printf(" %lu", (unsigned long)ENGINE(wait)(&robot, now));
#endif
    FOR_CELLS(GET_CELL)
    printf(";");
}

static void follow(char operation)
{
    uint64_t input;
    ENGINE(event) event;
    switch (operation) {
    case 'n':
        begin();
        break;
    case 'i':
        input = number();
        chosen[input] = number();
        put_inputs();
        break;
    case 'v':
        event = events[number()];
        input = number();
        command[input] = (unsigned)event + 1U;
        sent[input] = number();
        break;
    case 'w':
        event = events[number()];
        withheld[event] = !withheld[event];
        break;
#ifdef TIMES
    case 'c':
        now = (uint32_t)number();
        break;
    case 'd': {
        const uint64_t duration = number();
        const uint32_t milliseconds = (uint32_t)number();
        (void)duration;
        (void)milliseconds;
        FOR_DURATIONS(SET_DURATION)
        break;
    }
#endif
    case 'k':
        keep();
        break;
    case 'g':
        go_back();
        break;
    default:
        operate(operation);
        break;
    }
}

int main(void)
{
    char operation;
    for (unsigned position = 0U; position < EVENTS; ++position) {
        unsigned found = 0U;
        while (found < ENGINE_EVENTS && strcmp(ENGINE(event_name)((ENGINE(event))found), names[position]) != 0) {
            ++found;
        }
        events[position] = (ENGINE(event))found; /* For a missing event, none of the events that can be performed. */
    }
    while (scanf(" %c", &operation) == 1) {
#ifndef _WIN32
        (void)alarm(PATIENCE);
#endif
        follow(operation);
#ifndef _WIN32
        (void)alarm(0U);
#endif
    }
    return 0;
}
