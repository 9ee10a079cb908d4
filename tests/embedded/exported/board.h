#ifndef BOARD_H
#define BOARD_H

void put(char character);
void leave(void);
void run(void);

#endif
