/* What run.c needs on the host. */
#include <stdio.h>
#include <stdlib.h>

#include "board.h"

void put(char character)
{
    (void)putchar(character);
}

void leave(void)
{
    exit(0);
}

int main(void)
{
    run();
    return 0;
}
