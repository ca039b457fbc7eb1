/* Compares a generated supervisor with the predictions of its model for each event, and prints the first difference.
 *
 *     explorer REFERENCE STATES STEPS WALK
 *
 * REFERENCE is the file with the decision diagrams. The program explores all states breadth first. If there are more
 * than STATES states, or more than STEPS events in them with all values of their inputs, it walks WALK random steps
 * instead.
 *
 * A value is printed as its code: its distance from the least value, or the position of a location or literal.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Declarations for the model. The header includes that of the supervisor and has
 *
 *     CELLS, INPUTS, EVENTS        the numbers of cells (locations and variables), inputs and events of the model
 *     EVENT_NAMES                  the initializers of the events' names
 *     FOR_CELLS(DO), FOR_INPUTS(DO)  DO(number, member of the struct, least value) for all of them
 *     ENGINE(name), ENGINE_EVENTS  `name` with the supervisor's prefix; the number of events of the supervisor
 *     FOR_DURATIONS(DO)            DO(number, member of the settings) for the durations that are set on the robot
 *     TIMES                        if the model has timers, so that functions of the supervisor take the time
 *     ASSUMPTIONS                  the number of assumptions, if there are any
 *     STEPWISE                     if the supervisor has no control loop
 */
#include "model.h"

#ifdef TIMES
static uint32_t now;
#define NOW , now
#else
#define NOW
#endif

enum { RESTART = 1000 }; /* Steps of a walk before a restart. */

/* A finite domain: the levels of its bits in the decision diagrams, the least significant first, and its place in a
 * state. */
typedef struct domain {
    uint64_t last;
    unsigned bits, *level, word, shift;
} domain;

typedef struct effect {
    unsigned cell, *bit;
} effect;

typedef struct event {
    ENGINE(event) number;
    unsigned enabled, allowed, inputs, *input, effects;
    effect *effect;
#ifdef ASSUMPTIONS
    unsigned violated[ASSUMPTIONS];
#endif
} event;

static const char *const names[EVENTS + 1] = { EVENT_NAMES "" };

static domain domains[CELLS + INPUTS + 1];
static event events[EVENTS + 1];
static uint64_t initial[CELLS + 1], chosen[INPUTS + 1], expected[CELLS + 1];
static struct node { unsigned level, high, low; } *nodes;
static bool *truth;
static ENGINE(supervisor) robot, placed;

/* ---- The engine ---- */

#define PUT_CELL(number, member, least) robot.state.member = (int64_t)(code[number] + UINT64_C(least));
#define GET_CELL(number, member, least) code[number] = (uint64_t)(int64_t)robot.state.member - UINT64_C(least);
#define PUT_INPUT(number, member, least) robot.inputs.member = (int64_t)(chosen[number] + UINT64_C(least));

/* Puts the robot into a state. `placed` keeps a copy. */
static void put(const uint64_t *code)
{
    (void)code;
    FOR_CELLS(PUT_CELL)
    memcpy(&placed, &robot, sizeof placed);
}

static void put_inputs(void)
{
    FOR_INPUTS(PUT_INPUT)
}

static void get(uint64_t *code)
{
    (void)code;
    FOR_CELLS(GET_CELL)
}

/* ---- The model ---- */

static bool holds(unsigned node)
{
    while (node > 1U) {
        node = truth[nodes[node].level] ? nodes[node].high : nodes[node].low;
    }
    return node == 1U;
}

static void assume(const domain *one, uint64_t code)
{
    for (unsigned bit = 0U; bit < one->bits; ++bit) {
        truth[one->level[bit]] = code >> bit & 1U;
    }
}

/* Puts robot and model into a state. */
static void enter(const uint64_t *code)
{
    put(code);
    for (unsigned cell = 0U; cell < CELLS; ++cell) {
        assume(&domains[cell], code[cell]);
    }
}

/* ---- Differences ---- */

static void tell(const uint64_t *code, unsigned count)
{
    for (unsigned index = 0U; index < count; ++index) {
        printf(" %" PRIu64, code[index]);
    }
}

static void differ(const event *one, const uint64_t *state, bool possible, bool enabled, bool allowed, bool performed,
                   const uint64_t *after)
{
    printf("differs %u %d %d %d %d", (unsigned)(one - events), possible, enabled, allowed, performed);
    tell(state, CELLS);
    tell(chosen, INPUTS);
    tell(after, CELLS);
    tell(expected, CELLS);
    exit(0);
}

#ifdef ASSUMPTIONS
/* Compares the assumptions that the event violates in the current state of robot and model. */
static void violate(const event *one, const uint64_t *state)
{
    for (unsigned assumption = 0U; assumption < ASSUMPTIONS; ++assumption) {
        const bool violated = ENGINE(violates)(&robot, one->number, assumption);
        if (violated != holds(one->violated[assumption])) {
            printf("violates %u %u %d", (unsigned)(one - events), assumption, violated);
            tell(state, CELLS);
            exit(0);
        }
    }
}
#endif

/* Whether the event is possible in the current state of robot and model. If it is not, it must change nothing. */
static bool asked(const event *one, const uint64_t *state)
{
#ifdef ASSUMPTIONS
    violate(one, state);
#endif
    const bool possible = holds(one->enabled);
    const bool enabled = ENGINE(enabled)(&robot, one->number);
    const bool performed = !enabled && ENGINE(perform)(&robot, one->number NOW);
    if (enabled != possible || performed || (!enabled && memcmp(&robot.state, &placed.state, sizeof robot.state) != 0)) {
        uint64_t after[CELLS + 1];
        get(after);
        memcpy(expected, state, CELLS * sizeof *expected);
        differ(one, state, possible, enabled, possible, performed, after);
    }
    return possible;
}

/* Computes the state after a possible event with the chosen inputs, which is the same state if they are not allowed.
 * Restores the robot. */
static void perform(const event *one, const uint64_t *state, uint64_t *after)
{
    for (unsigned position = 0U; position < one->inputs; ++position) {
        assume(&domains[CELLS + one->input[position]], chosen[one->input[position]]);
    }
    memcpy(expected, state, CELLS * sizeof *expected);
    const bool allowed = holds(one->allowed);
    for (unsigned position = 0U; allowed && position < one->effects; ++position) {
        const effect *change = &one->effect[position];
        uint64_t code = 0U;
        for (unsigned bit = 0U; bit < domains[change->cell].bits; ++bit) {
            code |= (uint64_t)holds(change->bit[bit]) << bit;
        }
        expected[change->cell] = code;
    }
    put_inputs();
    const bool performed = ENGINE(perform)(&robot, one->number NOW);
    get(after);
    if (performed != allowed || memcmp(after, expected, CELLS * sizeof *after) != 0) {
        differ(one, state, true, true, allowed, performed, after);
    }
    memcpy(&robot, &placed, sizeof robot);
}

/* ---- All states, breadth first ---- */

static uint64_t *states;
static size_t words = 1U, count, room, places;
static uint32_t *table; /* One more than the index of a state; 0 marks a free place. */

static void *enough(void *memory)
{
    if (memory == NULL) {
        fputs("out of memory\n", stderr);
        exit(1);
    }
    return memory;
}

static size_t place_of(const uint64_t *state)
{
    uint64_t hash = 0U;
    for (size_t word = 0U; word < words; ++word) {
        hash = (hash ^ state[word]) * UINT64_C(0x9E3779B97F4A7C15);
        hash ^= hash >> 29;
    }
    size_t place = (size_t)hash & (places - 1U);
    while (table[place] != 0U && memcmp(&states[(table[place] - 1U) * words], state, words * sizeof *state) != 0) {
        place = (place + 1U) & (places - 1U);
    }
    return place;
}

static void grow(void)
{
    room = room == 0U ? 1024U : 2U * room;
    places = 4U * room;
    states = enough(realloc(states, (room + 1U) * words * sizeof *states));
    free(table);
    table = enough(calloc(places, sizeof *table));
    for (size_t index = 0U; index < count; ++index) {
        table[place_of(&states[index * words])] = (uint32_t)index + 1U;
    }
}

static void add(const uint64_t *code)
{
    if (count == room) {
        grow();
    }
    uint64_t *state = &states[count * words];
    memset(state, 0, words * sizeof *state);
    for (unsigned cell = 0U; cell < CELLS; ++cell) {
        if (domains[cell].bits > 0U) {
            state[domains[cell].word] |= code[cell] << domains[cell].shift;
        }
    }
    const size_t place = place_of(state);
    if (table[place] == 0U) {
        table[place] = (uint32_t)++count;
    }
}

static void unpack(size_t index, uint64_t *code)
{
    for (unsigned cell = 0U; cell < CELLS; ++cell) {
        const domain *one = &domains[cell];
        const uint64_t mask = one->bits == 64U ? UINT64_MAX : (UINT64_C(1) << one->bits) - 1U;
        code[cell] = one->bits == 0U ? 0U : states[index * words + one->word] >> one->shift & mask;
    }
}

static bool next_choice(const event *one)
{
    for (unsigned position = 0U; position < one->inputs; ++position) {
        const unsigned input = one->input[position];
        if (chosen[input] < domains[CELLS + input].last) {
            ++chosen[input];
            return true;
        }
        chosen[input] = 0U;
    }
    return false;
}

/* Explores all states. Returns false if a limit was reached. */
static bool explore(uint64_t most_states, uint64_t most_steps)
{
    uint64_t steps = 0U, now[CELLS + 1], after[CELLS + 1];
    add(initial);
    for (size_t index = 0U; index < count; ++index) {
        unpack(index, now);
        enter(now);
        for (const event *one = events; one < events + EVENTS; ++one) {
            if (asked(one, now)) {
                memset(chosen, 0, sizeof chosen);
                do {
                    if (count > most_states || steps == most_steps) {
                        return false;
                    }
                    perform(one, now, after);
                    add(after);
                    ++steps;
                } while (next_choice(one));
            }
        }
    }
    printf("explored %zu %" PRIu64, count, steps);
    return true;
}

/* ---- A random walk ---- */

/* xorshift64* (Vigna: An experimental exploration of Marsaglia's xorshift generators, scrambled, TOMS 2016). */
static uint64_t random_number(void)
{
    static uint64_t state = 1U;
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return state * UINT64_C(0x2545F4914F6CDD1D) >> 11;
}

/* A random code. Half of the codes are close to an end of the range. */
static uint64_t random_code(uint64_t last)
{
    const uint64_t number = random_number() << 11 | random_number();
    const uint64_t near = last < 4U ? last : 3U;
    switch (random_number() % 4U) {
    case 0U:
        return number % (near + 1U);
    case 1U:
        return last - number % (near + 1U);
    default:
        return last == UINT64_MAX ? number : number % (last + 1U);
    }
}

static void walk(uint64_t steps)
{
    uint64_t now[CELLS + 1], after[CELLS + 1];
    for (uint64_t step = 0U, length = 0U; step < steps; ++step, --length) {
        const event *possible[EVENTS + 1];
        unsigned number = 0U;
        if (length == 0U) {
            memcpy(now, initial, CELLS * sizeof *now);
            length = RESTART;
        }
        enter(now);
        for (const event *one = events; one < events + EVENTS; ++one) {
            if (asked(one, now)) {
                possible[number++] = one;
            }
        }
        if (number == 0U) {
            length = 1U;
            continue;
        }
        const event *one = possible[random_number() % number];
        for (unsigned position = 0U; position < one->inputs; ++position) {
            chosen[one->input[position]] = random_code(domains[CELLS + one->input[position]].last);
        }
        perform(one, now, after);
        memcpy(now, after, CELLS * sizeof *now);
    }
    printf("walked %" PRIu64, steps);
}

/* ---- The reference ---- */

static FILE *reference;

static uint64_t number(void)
{
    uint64_t value;
    if (fscanf(reference, "%" SCNu64, &value) != 1) {
        fputs("the reference is incomplete\n", stderr);
        exit(1);
    }
    return value;
}

static unsigned *numbers(unsigned length)
{
    unsigned *values = enough(calloc(length + 1U, sizeof *values));
    for (unsigned position = 0U; position < length; ++position) {
        values[position] = (unsigned)number();
    }
    return values;
}

/* Reads the levels and nodes, the last code and levels of each domain, the initial state, and the events. Each event
 * has the condition that it is enabled, the condition that it is allowed with its inputs, its inputs, the bits of its
 * effects, and for each assumption the condition that it violates it. */
static void load(void)
{
    truth = enough(calloc((size_t)number() + 1U, sizeof *truth));
    const size_t last = (size_t)number();
    nodes = enough(calloc(last + 2U, sizeof *nodes));
    for (size_t node = 2U; node < last + 2U; ++node) {
        nodes[node].level = (unsigned)number();
        nodes[node].high = (unsigned)number();
        nodes[node].low = (unsigned)number();
    }
    unsigned used = 0U;
    for (domain *one = domains; one < domains + CELLS + INPUTS; ++one) {
        one->last = number();
        one->bits = (unsigned)number();
        one->level = numbers(one->bits);
        if (one < domains + CELLS) {
            if (used + one->bits > 64U) {
                ++words;
                used = 0U;
            }
            one->word = (unsigned)words - 1U;
            one->shift = used;
            used += one->bits;
        }
    }
    for (unsigned cell = 0U; cell < CELLS; ++cell) {
        initial[cell] = number();
    }
    for (event *one = events; one < events + EVENTS; ++one) {
        one->enabled = (unsigned)number();
        one->allowed = (unsigned)number();
        one->inputs = (unsigned)number();
        one->input = numbers(one->inputs);
        one->effects = (unsigned)number();
        one->effect = enough(calloc(one->effects + 1U, sizeof *one->effect));
        for (unsigned position = 0U; position < one->effects; ++position) {
            one->effect[position].cell = (unsigned)number();
            one->effect[position].bit = numbers(domains[one->effect[position].cell].bits);
        }
#ifdef ASSUMPTIONS
        for (unsigned assumption = 0U; assumption < ASSUMPTIONS; ++assumption) {
            one->violated[assumption] = (unsigned)number();
        }
#endif
    }
}

/* Finds each event of the model by its name and compares the initial states. */
static bool begin(void)
{
    uint64_t code[CELLS + 1];
#ifdef STEPWISE
    ENGINE(init)(&robot);
#else
    ENGINE(init)(&robot, NULL, NULL NOW);
#endif
    get(code);
    if (memcmp(code, initial, CELLS * sizeof *code) != 0) {
        printf("initial");
        tell(code, CELLS);
        return false;
    }
    for (unsigned position = 0U; position < EVENTS; ++position) {
        unsigned found = 0U;
        while (found < ENGINE_EVENTS && strcmp(ENGINE(event_name)((ENGINE(event))found), names[position]) != 0) {
            ++found;
        }
        if (found == ENGINE_EVENTS) {
            printf("missing %u", position);
            return false;
        }
        events[position].number = (ENGINE(event))found;
    }
    return true;
}

int main(int arguments, char **argument)
{
    if (arguments != 5 || (reference = fopen(argument[1], "r")) == NULL) {
        fputs("explorer REFERENCE STATES STEPS WALK\n", stderr);
        return 1;
    }
    load();
    if (begin() && !explore(strtoull(argument[2], NULL, 10), strtoull(argument[3], NULL, 10))) {
        walk(strtoull(argument[4], NULL, 10));
    }
    return 0;
}
