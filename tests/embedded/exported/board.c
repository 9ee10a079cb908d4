/* What run.c needs on a board: a character out and an end, by semihosting. */
#include "board.h"

static void ask(unsigned int operation, const void *argument)
{
    __asm__ volatile("mov r0, %0\n\tmov r1, %1\n\tbkpt 0xab"
                     :
                     : "r"(operation), "r"(argument)
                     : "r0", "r1", "memory");
}

void put(char character)
{
    ask(0x03U, &character);
}

void leave(void)
{
    for (;;) {
        ask(0x18U, (const void *)0x20026U);
    }
}
