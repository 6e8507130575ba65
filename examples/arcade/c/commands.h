/* Which commands are accepted, and in words why others are not. */
#ifndef COMMANDS_H
#define COMMANDS_H

#include "parameters.h"
#include "readings.h"

/* What a command is judged by. */
typedef struct situation {
    Arcade__Mode mode;
    double height; /* above home, m */
    bool position_valid;
} situation;

enum { COMMANDS_REASON_SIZE = 100 };

/* Returns whether a command can be carried out now. If not, `reason` says why not. */
bool commands_check(const command *command, situation situation, const parameters *parameters,
                    char reason[COMMANDS_REASON_SIZE]);

#endif
