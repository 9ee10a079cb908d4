/*
 * Exported C on the host and on a microcontroller: a hash of what each law answers to the motion of
 * firmware/src/lib.rs. laws.h is written by exported.py.
 */
#include <stdint.h>
#include <string.h>

#include "laws.h"

#define PERIOD ((number)0.00025)

typedef struct {
    uint32_t seed;
    uint32_t left;
    number velocity;
    number acceleration;
} motion;

static uint32_t next_random(motion *m)
{
    m->seed ^= m->seed << 13;
    m->seed ^= m->seed >> 17;
    m->seed ^= m->seed << 5;
    return m->seed;
}

static number spread(motion *m)
{
    const uint32_t whole = next_random(m) >> 8;
    const int32_t centred = (whole < 0x800000U) ? (int32_t)whole : ((int32_t)whole - 0x1000000);
    const number uniform = (number)centred * (number)(1.0 / 8388608.0);
    return uniform * uniform * uniform;
}

static reading next_reading(motion *m)
{
    reading r;
    number next;
    if (m->left == 0U) {
        m->left = 1U + (next_random(m) % 256U);
        m->acceleration = (number)40.0 * spread(m) * PERIOD;
        if ((next_random(m) % 8U) == 0U) {
            m->velocity = (number)0.0;
            m->acceleration = (number)0.0;
        }
    }
    m->left--;
    next = m->velocity + m->acceleration;
    if ((next > (number)3.0) || (next < (number)-3.0)) {
        m->acceleration = -m->acceleration;
    } else {
        m->velocity = next;
    }
    r.velocity = m->velocity;
    r.temperature = (number)40.0 + ((number)15.0 * spread(m));
    r.load_torque = (number)10.0 * spread(m);
    return r;
}

static uint64_t hash_of(number (*torque)(const reading *r, number dt))
{
    motion m = {0x9e3779b9U, 0U, (number)0.0, (number)0.0};
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (uint32_t i = 0U; i < STEPS; i++) {
        const reading r = next_reading(&m);
        const number t = torque(&r, PERIOD);
        bits word;
        (void)memcpy(&word, &t, sizeof word);
        hash = (hash ^ word) * UINT64_C(0x100000001b3);
    }
    return hash;
}

static void say(const char *name, uint64_t hash)
{
    while (*name != '\0') {
        put(*name);
        name++;
    }
    put(' ');
    for (int digit = 15; digit >= 0; digit--) {
        put("0123456789abcdef"[(hash >> (4 * digit)) & 15U]);
    }
    put('\n');
}

void run(void)
{
    for (uint32_t i = 0U; i < (sizeof laws / sizeof laws[0]); i++) {
        say(laws[i].name, hash_of(laws[i].torque));
    }
    leave();
}
