/* Values that `configuration` keeps: tables of their names and defaults, and reading them from messages. */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include "arcade.pb-c.h"

#include <stddef.h>

typedef struct parameter {
    const char *name;
    size_t offset;        /* of a double in the struct that holds the values */
    double default_value; /* as in configuration.py, so that the program works without that daemon */
} parameter;

void parameters_set_defaults(const parameter *table, size_t count, void *values);

/* Takes over the values that the table names, and leaves the others as they are. */
void parameters_read(const parameter *table, size_t count, const Arcade__Parameters *message, void *values);

#endif
