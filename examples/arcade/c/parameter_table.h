/* Values that `configuration` keeps: tables of their names and defaults, and reading them from messages. */
#ifndef PARAMETER_TABLE_H
#define PARAMETER_TABLE_H

#include "arcade.pb-c.h"

#include <stddef.h>

typedef struct parameter {
    const char *name;
    size_t offset;        /* of a double in the struct that holds the values */
    double default_value; /* as in configuration.py, so that the program works without that daemon */
} parameter;

void parameter_table_set_defaults(const parameter *table, size_t count, void *values);

/* Takes over the values that the table names. A value that is not a number is ignored. */
void parameter_table_read(const parameter *table, size_t count, const Arcade__Parameters *message, void *values);

#endif
